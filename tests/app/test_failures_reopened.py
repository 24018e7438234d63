"""Opened again, also after a kill: the window is where it was, and what was done can be undone."""

import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
from PySide6.QtCore import Qt
from workbench.gravity_bench import batches, record
from workbench.probe_files import egg

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.gravity_fit import finish
from contactbench.widgets.scene.scene import Pick
from contactbench.widgets.scene.views import SceneLook, turned

from .failures import whole
from .test_failures_results import (
    close,
    force,
    leave_out,
    pick,
    plain,
    repeats,
    same,
    spread,
    tilt,
    use_devices,
)


def test_undone_and_done_again_by_the_menu_and_after_the_session_was_opened_again(
    qtbot, calibrated, tmp_path
):
    folder = shutil.copytree(calibrated, tmp_path / "s")
    with Session.open(folder) as session:
        session.set_parameter("config.rate", 200.0)
        record(session, "gravity-1.mcap", batches())
        finish(session, "gravity-1.mcap")
    with whole(qtbot, tmp_path) as made:
        bench = made.open(folder)
        made.idle()
        assert not made.window.menus.undo.isEnabled()
        states, texts = [plain(bench)], []
        for what in (leave_out, use_devices, tilt, spread, pick, repeats, force):
            what(made)
            made.idle()
            before, after = states[-1], plain(bench)
            assert after != before
            states.append(after)
            texts.append(bench.undo.undoText())
            for menu, then in ((made.window.menus.undo, before), (made.window.menus.redo, after)):
                menu.trigger()
                made.idle()
                made.wait(lambda then=then: same(plain(bench), then))
        close(made)
    with whole(qtbot, tmp_path) as made:
        bench, menus = made.open(folder), made.window.menus
        made.idle()
        assert same(plain(bench), states[-1])  # to have it there again changes nothing
        walk(made, menus.undo, bench.undo.undoText, zip(reversed(texts), reversed(states[:-1]), strict=True))
    with whole(qtbot, tmp_path) as made:  # what was taken back can be done again
        bench, menus = made.open(folder), made.window.menus
        made.idle()
        assert not menus.undo.isEnabled()
        walk(made, menus.redo, bench.undo.redoText, zip(texts, states[1:], strict=True))
    assert not check(folder).problems


def walk(made, action, text_now, ways):
    """Undo or redo step by step, and close."""
    for text, then in ways:
        assert text_now() == text
        action.trigger()
        made.idle()
        made.wait(lambda then=then: same(plain(made.window.bench), then))
    assert not made.unexpected
    close(made)


def paint(made, *faces):
    """Draw a stroke over facets of the newest region."""
    page, scene = made.window.pages.current, made.window.scene
    probe = page.work.probe
    picks = [Pick(face, probe.vertices[probe.faces[face]].mean(axis=0)) for face in faces]
    scene.brush_began.emit(picks[0], Qt.KeyboardModifier.NoModifier)
    for each in picks[1:]:
        scene.brush_moved.emit(each)
    scene.brush_ended.emit()


def labels(made):
    return made.window.pages.current.work.model.labels.copy()


@pytest.mark.parametrize("elsewhere", [False, True])
def test_strokes_are_taken_back_one_by_one_after_the_session_was_opened_again(
    qtbot, to_paint, tmp_path, elsewhere
):
    folder = shutil.copytree(to_paint, tmp_path / "s")
    with whole(qtbot, tmp_path) as made:
        made.open(folder)
        page = made.page(Step.REGIONS)
        made.wait(lambda: page.work is not None)
        page.panel.regions.add_button.click()
        painted = [labels(made)]
        for faces in ((0, 1), (200, 201), (400, 401)):
            paint(made, *faces)
            painted.append(labels(made))
        made.window.menus.undo.trigger()  # the last one is taken back before the window is closed
        assert len({each.tobytes() for each in painted}) == 4
        if elsewhere:
            made.page(Step.DEVICES)
        close(made)
    with whole(qtbot, tmp_path) as made:
        bench, menus = made.open(folder), made.window.menus
        made.idle()
        assert bench.undo.undoText() == "paint Region 1"
        menus.undo.trigger()
        menus.undo.trigger()  # at once: the surface may still be being prepared
        assert made.window.pages.step is Step.REGIONS
        page = made.window.pages.current
        made.wait(lambda: page.work is not None and np.array_equal(labels(made), painted[0]))
        for expected in painted[1:]:
            menus.redo.trigger()
            assert np.array_equal(labels(made), expected)
        assert not menus.redo.isEnabled()
        for expected in reversed(painted[:-1]):
            menus.undo.trigger()
            assert np.array_equal(labels(made), expected)
        menus.undo.trigger()  # the region itself
        assert page.work.model.regions == ()
        assert not made.unexpected
        close(made)
    assert not check(folder).problems


def test_a_stroke_that_is_not_the_next_one_any_more_is_not_taken_back(qtbot, to_paint, tmp_path):
    folder = shutil.copytree(to_paint, tmp_path / "s")
    with whole(qtbot, tmp_path) as made:
        made.open(folder)
        page = made.page(Step.REGIONS)
        made.wait(lambda: page.work is not None)
        page.panel.regions.add_button.click()
        paint(made, 0, 1)
        close(made)
    with whole(qtbot, tmp_path) as made:
        bench = made.open(folder)
        made.idle()
        page = made.page(Step.REGIONS)
        made.wait(lambda: page.work is not None)
        page.work.undo()  # as if somebody else had: the window's step is not the next one any more
        before = labels(made)
        made.window.menus.undo.trigger()
        assert np.array_equal(labels(made), before)
        assert bench.undo.undoText() != "paint Region 1"
        assert not made.unexpected


def test_the_scene_is_looked_at_as_it_was(qtbot, calibrated, tmp_path):
    folder = shutil.copytree(calibrated, tmp_path / "s")
    with whole(qtbot, tmp_path) as made:
        made.open(folder)
        made.page(Step.PROBE)
        made.idle()
        scene = made.window.scene
        scene.move_camera(turned(SceneLook.of(scene.camera(), None), 0.7, -0.3))
        left = scene.camera()
        close(made)
    with whole(qtbot, tmp_path) as made:
        bench, scene = made.open(folder), made.window.scene
        made.wait(lambda: not bench.jobs.running and scene.probe_layer.probe is not None)
        assert np.allclose(scene.camera(), left)
        made.wait(lambda: not scene._held)  # from now on a page may choose the view
        made.page(Step.GRAVITY)
        assert not np.allclose(scene.camera(), left)
        assert not made.unexpected


# ---- killed amid the preparation of a probe ------------------------------------------------------

_KILLED = """
import sys
from pathlib import Path
from contactbench.app import application
from contactbench.app.window import MainWindow
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.steps import Step
from PySide6.QtCore import QTimer

class Window(MainWindow):
    stage = 0

    def look(self):
        if self.bench is None or self.pages.step is None or self.settings.recent_of(self.bench.desk.folder).page == "":
            return
        if self.pages.step is not Step.PROBE:
            self.show_step(Step.PROBE)
            return
        stages = self.pages.current.stages
        draft = self.bench.desk.state.setting("draft.probe")
        if self.stage == 0 and not stages.worker.busy:
            self.stage = 1
            stages.take(Path(sys.argv[2]))
        elif self.stage == 1 and draft is not None:
            self.stage = 2
            stages.put(from_angles([0, 0, 35], [0, 0, 0]))
        elif self.stage == 2 and draft["alignment"] is not None and (self.bench.desk.folder / "undo.json").exists():
            print("placed", flush=True)

    def show(self):
        super().show()
        self.timer = QTimer(self, interval=100)
        self.timer.timeout.connect(self.look)
        self.timer.start()

application.MainWindow = Window
application.run(Path(sys.argv[1]))
"""


def test_killed_amid_a_probe_it_is_there_again_with_its_stage_and_its_undo(qtbot, tmp_path):
    folder = tmp_path / "s"
    Session.create(folder).close()
    command = [sys.executable, "-c", _KILLED, str(folder), str(egg(tmp_path))]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:
        try:
            assert other.stdout.readline().strip() == "placed"
        finally:
            other.send_signal(signal.SIGKILL)
    with whole(qtbot, tmp_path) as made:
        bench = made.open(folder)
        assert made.window.pages.step is Step.PROBE
        page = made.window.pages.current
        made.wait(lambda: page.stages.preview is not None)  # it goes on by itself to where it would be
        assert page.stages.mesh.file.name == "egg.stl"
        assert page.place.panel.numbers[2].value() == 35.0
        made.idle()
        assert bench.undo.undoText() == "place the mesh"
        made.window.menus.undo.trigger()
        made.wait(lambda: page.bar.primary.text() == "Align with sensor (3)")
        made.idle()
        made.window.menus.undo.trigger()
        made.wait(lambda: page.stages.mesh is None)
        assert not made.unexpected
        close(made)
    assert not check(folder).problems
