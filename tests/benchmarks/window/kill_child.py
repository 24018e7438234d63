"""A child process of the study of ends without warning: the real application, which does something at one page.

Started as ``python -m benchmarks.window.kill_child act|look FOLDER STEP MESH``; each line that it writes is JSON.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.window.brush import send_mouse
from benchmarks.window.driver import rest, until
from PySide6.QtCore import QEvent, QPointF, QTimer

import contactbench.app.application
from contactbench.app.settings import WindowSettings
from contactbench.app.undo import SetParameters
from contactbench.app.window import MainWindow
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.files import unfinished
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.probe import DRAFT

if TYPE_CHECKING:
    from contactbench.app.bench import Bench
    from contactbench.pipeline.session import State


def digest(state: State) -> str:
    """Return what tells one content of a session from another."""
    content = {
        "settings": {key: setting.value for key, setting in state.settings.items()},
        "inputs": {" ".join(key): each.content for key, each in state.current_inputs.items()},
        "results": {" ".join(key): each.content for key, each in state.current_results.items()},
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()


def act(window: MainWindow, bench: Bench, step: Step, mesh: Path) -> None:
    """Do at a page what one does there, and wait until it is on the disk, or under way."""
    window.show_step(step)
    page: Any = window.pages.current
    before = bench.desk.state.count
    if step is Step.GRAVITY:
        until(lambda: bench.live.ring.count > 0, "samples to come")
        page.run.start()
        until(lambda: bool(unfinished(bench.desk.folder)), "a recording to be made")
        rest(1.5)
    elif step is Step.PROBE:
        until(lambda: not page.stages.worker.busy, "the probe to be read")
        page.stages.take(mesh)
        until(lambda: page.stages.mesh is not None, "the mesh to be read")
        until(lambda: bench.desk.state.setting(DRAFT) is not None, "the mesh to be kept")
    elif step is Step.REGIONS:
        until(lambda: page.work is not None, "the surface to be there")
        page.panel.regions.add_button.click()
        _stroke(window)
        until(lambda: bool(page.work.model.labels.any()), "paint to be on the probe")
        until(lambda: not page.keeper.dirty and bench.desk.state.count > before, "the regions to be kept")
    elif step is Step.VERIFY:
        until(
            lambda: page.work.tool is not None and page.panel_markers.spread.isEnabled(), "the markers' table"
        )
        page.panel_markers.count.setValue(3)
        page.panel_markers.spread.click()
        until(lambda: bench.desk.state.count > before, "the markers to be kept")
    else:
        bench.undo.push(SetParameters(bench, {f"study.{step.value}": 1.0}, "set a number"))
        until(lambda: bench.desk.state.count > before, "the setting to be kept")
    folder = bench.desk.folder
    until(lambda: WindowSettings().recent_of(folder).page == step.value, "the page to be remembered")


def look(window: MainWindow, bench: Bench) -> dict[str, Any]:
    """Return what the window shows."""
    step = window.pages.step
    return {"step": "" if step is None else step.value, "digest": digest(bench.desk.state)}


def main(mode: str, folder: str, step: str, mesh: str) -> None:
    """Run the application with a session; when its page is there, act, or look and end."""

    class Driven(MainWindow):
        """The window, with a hand of its own."""

        def showEvent(self, event: Any) -> None:
            super().showEvent(event)
            self.shown.connect(lambda bench: QTimer.singleShot(0, lambda: driven(self, bench)))
            self._asked = QTimer(self, interval=50)
            self._asked.timeout.connect(lambda: asked(self))
            self._asked.start()

    question: list[str] = []

    def asked(window: MainWindow) -> None:
        """Answer as the accented button offers."""
        answers = window.start.question.answers()
        if window.start.question.sentence and answers and not question:
            question.append(window.start.question.sentence)
            answers[0].click()

    def driven(window: MainWindow, bench: Bench) -> None:
        if mode == "act":
            try:
                act(window, bench, Step(step), Path(mesh))
            except (InputError, AttributeError, TypeError) as error:
                sys.stderr.write(f"{error}\n")
                os._exit(1)
            found = look(window, bench)
            # What the next start must find; then wait for the end.
            sys.stdout.write(json.dumps(found) + "\n")
            sys.stdout.flush()
        else:
            until(lambda: window.pages.made, "the pages to be made")
            sys.stdout.write(json.dumps({**look(window, bench), "question": "".join(question)}) + "\n")
            sys.stdout.flush()
            bench.close()
            os._exit(0)

    vars(contactbench.app.application)["MainWindow"] = Driven
    contactbench.app.application.run(Path(folder))


def _stroke(window: MainWindow) -> None:
    scene = window.scene
    assert scene is not None
    middle = QPointF(scene.view.rect().center())
    until(
        lambda: scene.mouse.tool == "brush" and scene.pick_at(middle) is not None,
        "the brush to be on the probe",
    )
    rest(0.5)
    send_mouse(scene.view, QEvent.Type.MouseButtonPress, middle)
    for number in range(10):
        send_mouse(scene.view, QEvent.Type.MouseMove, middle + QPointF(3.0 * number, number))
        rest(0.03)
    send_mouse(scene.view, QEvent.Type.MouseButtonRelease, middle)


if __name__ == "__main__":
    main(*sys.argv[1:])
