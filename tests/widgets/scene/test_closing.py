"""A closed scene leaves nothing behind; two at a time do not disturb each other."""

import gc
import weakref

import numpy as np
import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QApplication

from contactbench.widgets.scene import Scene


def fill(scene, probe):
    scene.show_probe(probe)
    scene.show_contact(probe.vertices[0], np.eye(3) * 1e-6)
    scene.show_force(np.array([0.0, 0.0, 3.0]), probe.vertices[0])
    scene.show_markers(probe.vertices[:3], ["A", "B", "C"], [], 0)
    scene.show_orientation(np.eye(3))
    scene.show_ghost(np.eye(3))


def frame(scene, qtbot):
    frames = []
    scene.drawn.connect(frames.append)
    scene.view.update()
    qtbot.waitUntil(lambda: len(frames) > 0, timeout=20_000)


def test_opened_and_closed_twenty_times_nothing_stays(qtbot, make_box):
    # what another test has closed goes first
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    windows = len(QApplication.topLevelWidgets())
    left = []
    for _ in range(20):
        scene = Scene()
        scene.resize(200, 160)
        scene.show()
        fill(scene, make_box())
        frame(scene, qtbot)
        left += [weakref.ref(scene), weakref.ref(scene.view), weakref.ref(scene._live)]
        left += [weakref.ref(scene.view.ren_win), weakref.ref(scene.probe_layer.surface.actor)]
        scene.close_scene()
        scene.close_scene()
        scene.close()
        scene.deleteLater()
        del scene
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()
    assert [reference() for reference in left if reference() is not None] == []
    assert len(QApplication.topLevelWidgets()) <= windows


def test_what_qt_frees_is_forgotten_even_where_the_view_is_held(qtbot):
    scene = Scene()
    scene.show()
    frame(scene, qtbot)
    view = scene.view
    assert view._surface is not None
    scene.close_scene()
    scene.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert view._surface is None


@pytest.mark.usefixtures("qtbot")
def test_a_scene_that_was_never_shown_closes(make_box):
    scene = Scene()
    fill(scene, make_box())
    scene.close_scene()
    fill(scene, make_box())  # what comes late does no harm
    scene.look("top")
    scene.redraw()
    scene.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def test_two_scenes_look_with_one_camera(qtbot, make_box):
    scenes = [Scene(), Scene()]
    for scene in scenes:
        scene.resize(240, 200)
        scene.show()
        scene.show_probe(make_box())
    one, other = scenes
    one.camera_moved.connect(lambda: other.set_camera(one.camera()))
    other.camera_moved.connect(lambda: one.set_camera(other.camera()))
    other.look("top")
    assert one.camera() == other.camera()
    qtbot.mouseClick(one.buttons.buttons["perspective"], Qt.MouseButton.LeftButton)
    assert other.camera() == one.camera()
    frame(one, qtbot)
    frame(other, qtbot)
    difference = np.abs(one.picture().astype(int) - other.picture())[:120]
    assert difference.max() <= 2
    one.close_scene()
    frame(other, qtbot)
    assert np.ptp(other.picture()[:120]) > 50
    other.close_scene()
    for scene in scenes:
        scene.close()
        scene.deleteLater()
