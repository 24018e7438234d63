"""The bench in use: a script from beginning to end, as fast as it goes, into files; or behind real wire formats."""

from __future__ import annotations

import bisect
import csv
import json
import threading
import time
from collections import deque
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from operator import itemgetter
from typing import TYPE_CHECKING, Self, TextIO

import numpy as np

from contactbench.pipeline.devices.emulate import Emulator, emulator
from contactbench.pipeline.durable import scratch_beside
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.recording.messages import FLANGE_TOPIC, WRENCH_TOPIC
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.simulation.virtual.commands import (
    LONGEST_S,
    Batch,
    Done,
    ScriptError,
    Slip,
    command_fields,
)
from contactbench.pipeline.simulation.virtual.world import Pacer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path
    from types import TracebackType

    from contactbench.pipeline.devices.faults import Six
    from contactbench.pipeline.mesh.arrays import Floats
    from contactbench.pipeline.simulation.scenes.physics import SceneMoment
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench

# The devices tell what was there so long ago: the bench, which may be late, has been there then.
DELAY_S = 0.03
_KEPT_S = 2.0
# The bench has no calendar: a fixed day, so that the same run gives the same bytes.
STARTED_NS = 946_684_800 * 10**9  # 2000-01-01
_SLICE_S = 0.25
_AFTERWARDS_S = 1.0


@dataclass(frozen=True)
class Ran:
    """What a run gave."""

    seconds: float  # of the bench's clock
    # wrenches, flanges, commands: how many there are in the recording and the truth
    wrenches: int
    flanges: int
    commands: int
    slips: tuple[Slip, ...] = ()  # touches that pressed nothing


def run_script(bench: VirtualBench, out: Path, truth: Path | None = None, address: str = "") -> Ran:
    """
    Run the bench until its script ends it, or for a second after the last command is over.

    The recording holds wrenches, flanges, the commands as events `bench`, but for those that happen behind
    everybody's back, and as events `slipped` the touches that press nothing; the table of the truth holds all commands.
    Both files come to their names when all is done: what is there after an error is not half a run.

    Parameters
    ----------
    bench : VirtualBench
        With a script; as new.
    out : Path
        Recording to write, which must not exist.
    truth : Path, optional
        CSV to write, which must not exist either; see `TruthTable`.
    address : str
        Of the devices, for the recording.

    Raises
    ------
    RecordingError, ScriptError, InputError
        A file cannot be written, or a command cannot be done.
    """
    if not bench.scripted:
        raise InputError("virtual bench: no script was given.")
    _refuse_taken(out, truth)
    devices = [
        DeviceInfo("wrench", WRENCH_TOPIC, address, message("virtual bench"), rate=bench.rate),
        DeviceInfo("flange", FLANGE_TOPIC, address, message("virtual bench"), rate=bench.pose_rate),
    ]
    about = RecordingInfo(STARTED_NS, 0.0, tuple(devices))
    with ExitStack() as unfinished:
        recorded = _scratch(unfinished, out)
        told = None if truth is None else _scratch(unfinished, truth)
        wrenches, flanges = _go(bench, about, recorded, told)
        # The truth first: a recording that is there has its truth beside it.
        for scratch, file in ((told, truth), (recorded, out)):
            if scratch is not None and file is not None:
                _put(scratch, file)
    return Ran(bench.time, wrenches, flanges, len(bench.log), bench.slips)


def _refuse_taken(out: Path, truth: Path | None) -> None:
    if truth is not None and truth.resolve() == out.resolve():
        raise InputError(f"{arg(out)}: recording and truth need different files: give them two names.")
    for file in (out, truth):
        if file is not None and not file.parent.is_dir():
            raise InputError(
                f"{arg(file)}: there is no folder {arg(file.parent)}: create it, or choose another location."
            )
        if file is not None and file.exists():
            raise InputError(
                f"{arg(file)}: this file exists and is never overwritten: choose another name or delete it."
            )


def _scratch(unfinished: ExitStack, file: Path) -> Path:
    scratch = scratch_beside(file)
    unfinished.callback(scratch.unlink, missing_ok=True)
    return scratch


def _put(scratch: Path, file: Path) -> None:
    try:
        scratch.rename(file)
    except OSError as error:
        raise InputError(
            f"{arg(file)}: it cannot be written ({arg(error)}): choose another location."
        ) from error


def _go(bench: VirtualBench, about: RecordingInfo, out: Path, truth: Path | None) -> tuple[int, int]:
    """Run, and return how many wrenches and flanges there were."""
    wrenches = flanges = 0
    with ExitStack() as files:
        # Chunks by the bench's clock: by the host's, two runs would differ in their bytes.
        writer = files.enter_context(RecordingWriter(out, about, clock=lambda: bench.time))
        table = None
        if truth is not None:
            try:
                file = files.enter_context(truth.open("x", newline="", encoding="utf-8"))
            except OSError as error:
                raise InputError(
                    f"{arg(truth)}: it cannot be written ({arg(error)}): choose another location."
                ) from error
            table = TruthTable(file)
        while _goes_on(bench):
            batch = bench.advance(_SLICE_S)
            _write(writer, batch)
            wrenches, flanges = wrenches + len(batch.wrenches), flanges + len(batch.flanges)
            if table is not None:
                table.add(batch)
    return wrenches, flanges


def _goes_on(bench: VirtualBench) -> bool:
    if bench.ended:
        return False
    if bench.time > LONGEST_S + _AFTERWARDS_S:
        left = bench.pending
        if left:
            raise ScriptError(
                f"{arg(left[0].where)}: it is due after {arg(LONGEST_S):,.0f} s, the longest run: split the script."
            )
        return False
    return bench.scripted or bench.time < bench.idle_from + _AFTERWARDS_S


def _write(writer: RecordingWriter, batch: Batch) -> None:
    """Write a batch in the order of time; at one time the commands first, then slips, the wrench, the flange."""
    rows: list[tuple[float, int, Callable[[], None]]] = []
    for done in batch.done:
        if not done.secret:
            fields = command_fields(done.command)
            rows.append((done.time, 0, partial(writer.event, "bench", fields, done.time)))
    for slip in batch.slips:
        fields = {"touched_at": slip.touch.time, **command_fields(slip.touch.command)}
        rows.append((slip.time, 1, partial(writer.event, "slipped", fields, slip.time)))
    rows += [(sample.time, 2, partial(writer.wrench, sample)) for sample in batch.wrenches]
    rows += [(sample.time, 3, partial(writer.flange, sample)) for sample in batch.flanges]
    for _, _, write in sorted(rows, key=itemgetter(0, 1)):
        write()


# ---- the truth beside every wrench, as a table ---------------------------------------------------


COLUMNS = (
    "time_s",
    "sequence",
    *(f"true_{part}" for part in ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")),
    *(f"contact_{part}" for part in ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")),
    "contacts",
    *(f"centroid_{axis}_m" for axis in "xyz"),
    *(f"point_{axis}_m" for axis in "xyz"),
    *(f"normal_{axis}" for axis in "xyz"),
    "torsion_Nm",
    *(f"R_WS_{row}{column}" for row in range(3) for column in range(3)),
    "command",
)


class TruthTable:
    """
    Writes the truth as it comes; everything in S, what is not there is empty.

    A command is in the first row from its time on, as JSON: also the ones that nobody else is told.

    Parameters
    ----------
    file : text file
        Opened with ``newline=""``.
    """

    def __init__(self, file: TextIO) -> None:
        self._rows = csv.writer(file, lineterminator="\n")
        self._rows.writerow(COLUMNS)
        self._waiting: list[Done] = []

    def add(self, batch: Batch) -> None:
        """Write what is true of each wrench of a batch."""
        self._waiting += batch.done
        for sample, truth in zip(batch.wrenches, batch.truths, strict=True):
            now = [done for done in self._waiting if done.time <= truth.time + 1e-9]
            self._waiting = self._waiting[len(now) :]
            commands = [{"at": done.time} | command_fields(done.command) for done in now]
            self._rows.writerow(
                [
                    f"{truth.time:.6f}",
                    sample.sequence,
                    *_numbers(truth),
                    json.dumps(commands) if commands else "",
                ]
            )


def _numbers(truth: SceneMoment) -> list[str]:
    if truth.contacts == 0:
        contact: list[str] = [""] * 10
    else:
        places = [*truth.centroid_S, *truth.point_S, *truth.normal_S, truth.torsion]
        contact = _written(places)
    return [
        *_written(truth.reading.tolist()),
        *_written(truth.contact.tolist()),
        str(truth.contacts),
        *contact,
        *_written(truth.R_WS.ravel().tolist()),
    ]


def _written(values: Sequence[float]) -> list[str]:
    return [f"{value:.9g}" for value in values]


class ServedBench:
    """
    A bench in real time with a sensor and a robot on real lines.

    Use it in a ``with`` statement. The sensor answers as an SRI box, the robot as an Elfin whose wrist turns as the
    bench's does; where its flange is belongs to the arm, how it stands to the bench.

    Parameters
    ----------
    pty : bool
        The sensor on a pseudo-terminal, not on TCP.
    sensor_port, robot_port : int
        Of the loopback interface; 0: any free one.
    on_batch : callable, optional
        Gets everything that the bench gives, the truth with it.

    Raises
    ------
    InputError
        A port is taken, or MuJoCo is missing.
    """

    def __init__(
        self,
        bench: VirtualBench,
        *,
        pty: bool = False,
        sensor_port: int = 0,
        robot_port: int = 0,
        on_batch: Callable[[Batch], None] = lambda _: None,
    ) -> None:
        self.bench = bench
        self.error: InputError | None = None
        self.over = threading.Event()
        self._on_batch = on_batch
        self._kept: deque[tuple[float, Six, Floats]] = deque(maxlen=int(_KEPT_S * bench.rate) + 2)
        self._lock = threading.Lock()
        self._arm = WristArm()
        self._pacer = Pacer(bench, self._keep, self._end)
        self._first: float | None = None
        self._told = 0.0
        self._keep(bench.advance(1.5 / bench.rate), 0.0)  # there is something to tell from the beginning
        carrier = "serial" if pty else "tcp"
        self.sensor: Emulator = emulator(
            "sri", carrier, port=sensor_port, rate=bench.rate, signal=self._wrench
        )
        try:
            self.robot: Emulator = emulator("elfin", "tcp", port=robot_port, signal=self._joints)
        except BaseException:
            self.sensor.close()
            raise

    def __enter__(self) -> Self:
        self._pacer.start()
        self.sensor.start()
        self.robot.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pacer.stop()
        self.bench.close()
        try:
            self.sensor.close()
        finally:
            self.robot.close()

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong, in sentences."""
        return self._pacer.findings()

    def _keep(self, batch: Batch, origin: float) -> None:  # noqa: ARG002 - the pacer says it
        with self._lock:
            for sample, truth in zip(batch.wrenches, batch.truths, strict=True):
                self._kept.append(
                    (sample.time, (*sample.force, *sample.torque), truth.R_WS @ self.bench.R_SE)
                )
        self._on_batch(batch)

    def _end(self, error: InputError | None) -> None:
        self.error = error
        self.over.set()

    # ---- in the devices' threads ---------------------------------------------------------------

    def _wrench(self, due: float) -> Six:
        """Return what is measured at a time of the sensor's clock: every frame the next sample."""
        now = time.monotonic() - self._pacer.origin
        # Its clock begins with its first frame, and has leapt where the bench let time slip.
        if self._first is None or abs(self._first + due - now) > DELAY_S:
            self._first = now - due
        # A bench that is late is told once more as it was, never as it was before that.
        self._told = max(self._told, self._first + due - DELAY_S)
        moment, wrench, _ = self._at(self._told)
        self._told = min(self._told, moment + 1 / self.bench.rate)
        return wrench

    def _joints(self, _: float) -> Six:
        q = self._arm.joints(self._at(time.monotonic() - self._pacer.origin - DELAY_S)[2]).tolist()
        return (q[0], q[1], q[2], q[3], q[4], q[5])

    def _at(self, moment: float) -> tuple[float, Six, Floats]:
        """Return the sample that is the newest at a time of the bench's clock."""
        with self._lock:
            # Half a period to the side: rounding does not decide between two samples.
            place = bisect.bisect_right(self._kept, moment + 1e-6, key=lambda kept: kept[0])
            return self._kept[max(0, place - 1)]


# ---- joint angles with which an arm's flange stands as the bench's wrist does --------------------


# The forearm level to the front, to both sides, and rising: what one cannot reach, behind its own wrist or at the end
# of a joint, another can.
_ARMS = ((0.0, 0.0, np.pi / 2), (np.pi / 2, 0.0, np.pi / 2), (-np.pi / 2, 0.0, np.pi / 2), (0.4, -0.3, 0.6))


class WristArm:
    """
    An Elfin3 whose first three joints stay as long as its wrist reaches what is asked for.

    Its last three axes meet in a point and are z, y, z of a turn, so the angles follow without a search.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """

    def __init__(self) -> None:
        self._robot = Robot.named("elfin3")
        straight = np.array([[*arm, 0.0, 0.0, 0.0] for arm in _ARMS])
        self._forearms = self._robot.flange_rotations(straight)
        self._arm = 0
        self._joints = straight[0]

    def joints(self, R_BE: Floats) -> Floats:
        """
        Return the six joint angles, rad, near the ones before.

        Raises
        ------
        InputError
            No posture reaches the orientation.
        """
        for arm in [self._arm, *range(len(_ARMS))]:
            found = [q for q in self._wrists(arm, R_BE) if self._robot.within_limits(q)]
            if found:
                self._arm = arm
                self._joints = min(found, key=lambda q: float(np.abs(q - self._joints).sum()))
                return np.array(self._joints)
        raise InputError("the arm's wrist does not reach that orientation: turn the bench another way.")

    def _wrists(self, arm: int, R_BE: Floats) -> list[Floats]:
        """Return both ways to stand so."""
        R = self._forearms[arm].T @ R_BE
        # In line with the forearm any first angle will do: the present one, so that nothing leaps.
        in_line = np.hypot(R[0, 2], R[1, 2]) < 1e-9
        first = self._joints[3] if in_line else np.arctan2(R[1, 2], R[0, 2])
        ways = []
        for q4 in (first, first - np.copysign(np.pi, first)):
            c, s = np.cos(q4), np.sin(q4)
            rest = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ R
            q5, q6 = np.arctan2(rest[0, 2], rest[2, 2]), np.arctan2(rest[1, 0], rest[1, 1])
            ways.append(np.array([*_ARMS[arm], q4, q5, q6]))
        return ways
