"""Whether anything is lost when the application is ended without warning, at any page."""

import json
import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from benchmarks.window.brush import make_session
from benchmarks.window.driver import load, loaded, own_home
from workbench.touch_session import weighed

from contactbench.app.opening import VIRTUAL_BENCH
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.steps import Step
from contactbench.pipeline.study.report import Figure, StudyReport

_PATIENCE_S = 120.0
_FACETS = 2_000


def run(
    steps: Sequence[Step] = tuple(Step), *, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """Start the application, do something at a page, end it with SIGKILL, start it again, and compare."""
    from contactbench.pipeline.calibration.files.calibration_file import save_calibration
    from contactbench.pipeline.session import Session

    if unknown := set(steps) - set(Step):
        raise InputError(f"steps {', '.join(sorted(unknown))}: choose from {', '.join(Step)}.")
    steps = [Step(each) for each in steps]
    before = load()
    figures: list[Figure] = []
    notes: list[str] = []
    with own_home() as home:
        session, mesh = home / "session", home / "ball.ply"
        progress("making a session on a virtual bench, with a probe and a calibration")
        make_session(session, _FACETS)
        save_calibration(weighed(), home / "calibration.json")
        with Session.open(session) as opened:
            for key in ("devices.sensor", "devices.poses"):
                opened.set_parameter(key, VIRTUAL_BENCH)
            content = {"calibration.json": (home / "calibration.json").read_bytes()}
            opened.add_result("calibration", "calibration.json", content, {}, {})
        for step in steps:
            progress(f"ending the application at the page {step.value}")
            left = _child("act", session, step, mesh)
            found = _child("look", session, step, mesh)
            figures += _figures(step, left, found)
            if found["question"]:
                notes.append(f"{step.value}: asked: {found['question']}")
    return StudyReport(
        "Ended by kill -9", {"pages": len(figures) // 3}, tuple(figures), (*notes, loaded(before))
    )


def _figures(step: Step, left: dict[str, Any], found: dict[str, Any]) -> tuple[Figure, ...]:
    asked = bool(found["question"])
    wanted = step is Step.GRAVITY  # a recording was being made
    # What was taken in by the answer is more than what was there.
    same = found["digest"] == left["digest"] or (asked and wanted)
    return (
        Figure(step.value, "the same page is shown (1: yes)", float(found["step"] == left["step"]), least=1),
        Figure(step.value, "the session holds what it held (1: yes)", float(same), least=1),
        Figure(
            step.value,
            "asked about a recording only if there is one (1: yes)",
            float(asked == wanted),
            least=1,
        ),
    )


def _child(mode: str, session: Path, step: Step, mesh: Path) -> dict[str, Any]:
    """Run the application until it has said something, and end it at once."""
    command = [
        sys.executable,
        "-m",
        "benchmarks.window.kill_child",
        mode,
        str(session),
        step.value,
        str(mesh),
    ]
    environment = os.environ | {"CONTACTBENCH_HOME": str(session.with_name("home"))}
    log = session.with_name(f"{mode}-{step.value}.txt")
    with (
        log.open("wb") as errors,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, env=environment, text=True) as child,
    ):
        try:
            line = _line(child)
        finally:
            child.send_signal(signal.SIGKILL)
    if not line:
        words = log.read_text(errors="replace").strip()[-600:]
        raise InputError(f"the application did not get far at the page {step.value}: {words or 'it hung'}")
    said: dict[str, Any] = json.loads(line)
    return said


def _line(child: subprocess.Popen[str]) -> str:
    """Return the first line that a child writes; empty: it ended, or was too slow."""
    lines: queue.Queue[str] = queue.Queue()
    assert child.stdout is not None
    threading.Thread(target=lambda: lines.put(child.stdout.readline()), daemon=True).start()  # type: ignore[union-attr]
    try:
        return lines.get(timeout=_PATIENCE_S)
    except queue.Empty:
        return ""
