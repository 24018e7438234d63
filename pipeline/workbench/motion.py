"""
A closed loop on the virtual bench, watched while it runs.

It runs in a process of its own, which is ``contactbench bench control run BUNDLE --real-time --frames``: whatever it
costs, the window goes on, and what is seen is what the command does.
"""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.control.frames import Beginning, LoopFrame, read_line
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.installation import module_command
from contactbench.pipeline.settings import PhantomSettings

_LONGEST_S = 600.0
_KEPT = 6_000  # frames: two minutes
_PACE_FRAMES = 100
_PATIENCE_S = 5.0
_LAST_WORDS = 2_000


class MotionChoice(PhantomSettings):
    """What is run, as the options of ``contactbench bench control run``."""

    robot: Literal["virtual://arm", "virtual://platform"] = "virtual://arm"
    unturned: bool = False
    """The sensor sits on the flange as it is: for a bundle that does not say how it is turned."""

    def arguments(self, bundle: Path) -> list[str]:
        """Return what the command is given, after ``contactbench``."""
        chosen = [] if self.variant is None else ["--variant", self.variant]
        chosen += ["--mount", "0,0,0"] if self.unturned else []
        return [
            *("bench", "control", "run", str(bundle), "--robot", self.robot, "--motion", self.motion),
            *("--period", f"{self.period:g}", "--size", f"{self.size:g}", "--seconds", f"{_LONGEST_S:g}"),
            *(*chosen, "--unverified", "--real-time", "--frames"),
        ]


@dataclass(frozen=True)
class MotionChange:
    """A change of state: when (s), to what, and why."""

    time_s: float
    state: str
    reason: str


@dataclass(frozen=True, eq=False)
class Course:
    """What was until now."""

    times: NDArray[np.float64]  # (n,); s
    forces: NDArray[np.float64]  # (n,); N
    angles: NDArray[np.float64]  # (n, 2); In plane, out of plane, degrees


@dataclass(frozen=True, eq=False)
class MotionPlace:
    """
    Where things are, for a picture.

    W is as the base, its origin where the sensor is while the probe stands upright on the phantom at rest.
    """

    R_WS: NDArray[np.float64]  # (3, 3)
    p_WS_W: NDArray[np.float64]  # (3,); m
    # phantom_S, normal_S: (3,); The middle of the phantom's top, m, and what points out of it
    phantom_S: NDArray[np.float64]
    normal_S: NDArray[np.float64]


class MotionRun:
    """
    A closed loop that runs; any thread may ask.

    Parameters
    ----------
    bundle : Path
        Folder or zip file.
    choice : MotionChoice

    Attributes
    ----------
    beginning : Beginning or None
        None: it has not begun.
    newest : LoopFrame or None
    outcome : dict or None
        What ``contactbench bench control run --json`` says at the end.

    Raises
    ------
    InputError
        The process cannot be started.
    """

    def __init__(self, bundle: Path, choice: MotionChoice) -> None:
        self.choice = choice
        self.beginning: Beginning | None = None
        self.newest: LoopFrame | None = None
        self.outcome: dict[str, Any] | None = None
        self._frames: deque[LoopFrame] = deque(maxlen=_KEPT)
        self._arrived: deque[tuple[float, float]] = deque(maxlen=_PACE_FRAMES)
        self._changes: list[MotionChange] = []
        self.failure = ""  # Why it ended without an outcome; empty: it did not
        # A file: a pipe that nobody reads would hold the process up.
        self._said: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as the process
        try:
            self._process = subprocess.Popen(  # noqa: S603 - this Python and a command of ours
                module_command("contactbench.pipeline.cli", *choice.arguments(bundle)),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=self._said,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            self._said.close()
            raise InputError(
                f"the virtual robot cannot be started ({arg(error)}): check {arg(sys.executable)}."
            ) from error
        self._reader = threading.Thread(target=self._read, name=message("closed loop"), daemon=True)
        self._reader.start()

    # ---- what is asked -----------------------------------------------------------------------------

    @property
    def running(self) -> bool:
        """Whether anything may still come of it."""
        return self._reader.is_alive()

    @property
    def changes(self) -> tuple[MotionChange, ...]:
        """How the state has changed until now."""
        return tuple(self._changes)

    @property
    def pace(self) -> float | None:
        """How fast its time goes of late, against the clock; None: not yet known."""
        arrived = self._arrived.copy()
        if len(arrived) < _PACE_FRAMES:
            return None
        (began, first), (ended, last) = arrived[0], arrived[-1]
        return (last - first) / max(ended - began, 1e-3)

    def course(self, seconds: float) -> Course:
        """Return the last seconds."""
        kept = self._frames.copy()  # in one go: the reader goes on
        newest = kept[-1].time_s if kept else 0.0
        frames = [each for each in kept if each.time_s >= newest - seconds]
        return Course(
            np.array([each.time_s for each in frames]),
            np.array([each.force_N for each in frames]),
            np.degrees(np.array([each.angles_rad for each in frames]).reshape(-1, 2)),
        )

    # ---- what is told ------------------------------------------------------------------------------

    def stop(self) -> None:
        """Have the robot go back and end."""
        if self._process.poll() is None:
            with suppress(OSError):
                if os.name == "posix":
                    self._process.send_signal(signal.SIGINT)
                else:  # there it cannot be asked
                    self._process.terminate()

    def close(self) -> None:
        """End it at once."""
        if self._process.poll() is None:
            self._process.kill()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(_PATIENCE_S)
        self._reader.join(_PATIENCE_S)
        self._said.close()

    # ---- the process -------------------------------------------------------------------------------

    def _read(self) -> None:
        lines = cast("IO[bytes]", self._process.stdout)
        try:
            with lines:
                for line in lines:
                    self._take(read_line(line))
        except (InputError, OSError, ValueError) as error:
            self.failure = message(f"the virtual robot sent an invalid answer ({arg(error)}).")
            self._process.kill()
        code = self._process.wait()
        if self.outcome is None and not self.failure:
            self.failure = self._last_words() or message(f"the virtual robot stopped with code {arg(code)}.")

    def _take(self, told: Beginning | LoopFrame | dict[str, Any]) -> None:
        if isinstance(told, Beginning):
            self.beginning = told
        elif isinstance(told, LoopFrame):
            self._frames.append(told)
            self._arrived.append((time.monotonic(), told.time_s))
            self.newest = told
            if told.reason is not None:
                self._changes.append(MotionChange(told.time_s, told.state, told.reason))
        else:
            self.outcome = told

    def _last_words(self) -> str:
        with suppress(OSError, ValueError):
            size = self._said.seek(0, os.SEEK_END)
            self._said.seek(max(0, size - _LAST_WORDS))
            return " ".join(self._said.read().decode(errors="replace").split()).removeprefix("error: ")
        return ""


def placed(beginning: Beginning, frame: LoopFrame) -> MotionPlace:
    """Return where things are in a frame."""
    R_BS = np.array(frame.R_BS).reshape(3, 3)
    sensor = np.array(frame.sensor_B_m)
    return MotionPlace(
        R_BS,
        sensor - np.array(beginning.rest_B_m),
        R_BS.T @ (np.array(frame.phantom_B_m) - sensor),
        R_BS.T @ np.array(frame.normal_B),
    )
