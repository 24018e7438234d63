import numpy as np
import pytest
from PySide6.QtCore import QPointF
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.suggest import by_hand
from contactbench.pipeline.workbench.gravity_fit import PoseRow, PoseState
from contactbench.widgets.coverage import Coverage, place
from contactbench.widgets.theme import colours

DOWN = Rotation.from_euler("x", 180, degrees=True).as_matrix()


def row(R_WS, state=PoseState.TAKEN, name="pose 1"):
    return PoseRow(name, 1.0, R_WS, "0°, +z down", state)


@pytest.fixture
def shown(seen):
    return seen(Coverage(), 330, 186)


def test_directions_that_are_spread_evenly_are_spread_evenly_on_the_discs():
    spots = [place(-R[2]) for R in by_hand(4000).R_WS]
    front = [spot for spot in spots if spot.front]
    assert len(front) == pytest.approx(2000, abs=2)
    inner = sum(spot.x**2 + spot.y**2 < 0.5 for spot in front)
    assert inner == pytest.approx(1000, abs=5)
    assert max(np.hypot(spot.x, spot.y) for spot in spots) <= 1 + 1e-9


def test_the_middle_is_z_and_the_rim_is_across():
    assert place(np.array([0.0, 0.0, 1.0])) == (True, 0.0, 0.0)
    assert place(np.array([0.0, 0.0, -1.0])) == (False, 0.0, 0.0)
    assert place(np.array([0.0, 1.0, 0.0])) == (True, 0.0, 1.0)


def _colour(widget, at):
    image = widget.grab().toImage()
    return image.pixelColor(round(at.x()), round(at.y())).name()


def test_each_state_looks_different(shown):
    side = Rotation.from_euler("x", 140, degrees=True).as_matrix()
    seen = {}
    for state in PoseState:
        pose = row(side, state)
        shown.show_poses((pose,), None)
        at = shown.spot_of(pose)
        seen[state] = tuple(_colour(shown, at + QPointF(dx, dy)) for dx, dy in ((0, 0), (6, 0), (3, 3)))
    assert seen[PoseState.TAKEN][0] == colours(dark=False).good
    assert len(set(seen.values())) == 3
    assert shown.accessibleDescription() == "Poses: 0 captured, 0 left out, 1 rejected"


def test_what_cannot_be_reached_is_hatched(shown):
    shown.show_poses((), None, 180.0)
    free = shown.grab().toImage()
    shown.show_poses((), None, 60.0)
    limited = shown.grab().toImage()
    assert free != limited
    middle = shown.spot_of(row(DOWN))
    assert free.pixel(round(middle.x()) + 9, round(middle.y()) + 9) == limited.pixel(
        round(middle.x()) + 9, round(middle.y()) + 9
    )  # straight down can be reached


def test_the_next_pose_pulses_and_the_present_one_moves(shown):
    shown.show_poses((), DOWN)
    pictures = []
    for _ in range(15):
        shown.show_now(None)
    pictures.append(shown.grab().toImage())
    for _ in range(8):
        shown.show_now(None)
    pictures.append(shown.grab().toImage())
    assert pictures[0] != pictures[1]
    shown.show_poses((), None)
    shown.show_now(DOWN)
    there = shown.grab().toImage()
    shown.show_now(Rotation.from_euler("x", 150, degrees=True).as_matrix())
    assert shown.grab().toImage() != there


def test_a_tool_tip_names_the_pose(shown):
    pose = row(DOWN)
    shown.show_poses((pose, PoseRow("at 3 s", 3.0, None, "bumped", PoseState.REJECTED)), None)
    assert shown._under(shown.spot_of(pose)).startswith("pose 1: 0°, +z down")
    assert "Filled: captured" in shown._under(QPointF(0, 0))
