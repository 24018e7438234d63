"""The brush: from what the scene tells of the mouse to strokes."""

import numpy as np
import pytest
from PySide6.QtCore import QObject, Qt, Signal
from workbench.region_sessions import CENTRE, RADIUS, ball_shell

from contactbench.pipeline.workbench.regions import RegionsWork
from contactbench.widgets.region_brush import LARGEST, SMALLEST, USUAL, RegionBrush
from contactbench.widgets.scene.scene import Pick

NO_KEY, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier


class Told(QObject):
    """The signals of a scene, and what it is asked for."""

    brush_began = Signal(object, object)
    brush_moved = Signal(object)
    brush_ended = Signal()
    brush_scaled = Signal(int)

    def __init__(self):
        super().__init__()
        self.tools = []

    def set_tool(self, tool, brush_radius=0.0):
        self.tools.append((tool, brush_radius))


@pytest.fixture
def scene(qapp):  # noqa: ARG001 - signals need one
    return Told()


@pytest.fixture
def work():
    made = RegionsWork(ball_shell())
    made.step(lambda model: model.add("Lens"))
    made.step(lambda model: model.add("Side"))
    return made


@pytest.fixture
def brush(scene, work):
    made = RegionBrush(scene)
    made.rank = 1
    made.take(work)
    made.resize(0.01)
    return made


def pick(work, degrees):
    angle = np.radians(degrees)
    faces, points = work.graph.pick(CENTRE + RADIUS * np.array([np.sin(angle), 0, np.cos(angle)]))
    return Pick(int(faces[0]), points[0])


def draw(scene, work, *places, keys=NO_KEY):
    scene.brush_began.emit(pick(work, places[0]), keys)
    for place in places[1:]:
        scene.brush_moved.emit(None if place is None else pick(work, place))
    scene.brush_ended.emit()


def test_a_drag_is_one_step_without_gaps(scene, work, brush, qtbot):
    with qtbot.waitSignal(brush.drawn) as drawn:
        draw(scene, work, 0, 60)
    assert drawn.args == ["paint Lens"]
    assert work.model.labels[pick(work, 30).face] == 1, "what lies between two events is painted, too"
    assert work.undo()
    assert not work.model.labels.any()


def test_where_the_pointer_left_the_probe_nothing_is_painted(scene, work, brush):  # noqa: ARG001
    draw(scene, work, 0, None, 60)
    labels = work.model.labels
    assert [labels[pick(work, at).face] for at in (0, 30, 60)] == [1, 0, 1]


def test_shift_and_the_eraser_erase(scene, work, brush):
    draw(scene, work, 0)
    draw(scene, work, 0, keys=SHIFT)
    assert not work.model.labels.any()
    brush.erase = True
    draw(scene, work, 0, keys=SHIFT)
    assert work.model.labels.any()
    draw(scene, work, 0)
    assert not work.model.labels.any()


def test_other_regions_are_protected_if_asked(scene, work, brush):
    draw(scene, work, 0)
    brush.rank, brush.protect = 2, True
    draw(scene, work, 0)
    assert work.model.labels[pick(work, 0).face] == 1
    brush.protect = False
    draw(scene, work, 0)
    assert work.model.labels[pick(work, 0).face] == 2


def test_without_a_chosen_region_it_says_so(scene, work, brush, qtbot):
    brush.rank = 0
    with qtbot.waitSignal(brush.refused) as refused:
        draw(scene, work, 0)
    assert "region" in refused.args[0]
    assert not work.model.labels.any()


def test_the_radius_has_limits_and_reaches_the_scene(scene, brush, qtbot):
    with qtbot.waitSignal(brush.resized):
        scene.brush_scaled.emit(1)
    assert scene.tools[-1] == ("brush", pytest.approx(0.012))
    for turns, end in ((100, LARGEST), (-100, SMALLEST)):
        scene.brush_scaled.emit(turns)
        assert brush.radius == end
        assert scene.tools[-1][1] == end
    with qtbot.assertNotEmitted(brush.resized):
        scene.brush_scaled.emit(-1)
    assert USUAL == 0.003


def test_released_it_does_nothing(scene, work, brush):
    scene.brush_began.emit(pick(work, 0), NO_KEY)
    brush.release()
    assert not work.model.labels.any()
    draw(scene, work, 0)
    assert not work.model.labels.any()
