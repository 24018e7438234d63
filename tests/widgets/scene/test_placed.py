"""A tool that stands somewhere in the world is seen, and picked, there."""

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from scipy.spatial.transform import Rotation

TOP = np.array([0.005, -0.004, 0.06])  # of the box, S


@pytest.mark.parametrize("perspective", [False, True])
def test_it_is_picked_where_it_is(bench, perspective):
    R_WS = Rotation.from_euler("xyz", [0.2, -0.3, 0.4]).as_matrix()
    p_WS_W = np.array([0.012, -0.009, 0.015])
    bench.scene.set_perspective(perspective)
    bench.scene.show_orientation(R_WS, p_WS_W)
    bench.settle()
    x, y, _ = bench.scene.projection().project(R_WS @ TOP + p_WS_W)[0]
    ratio = bench.scene.view.devicePixelRatioF()
    found = bench.scene.pick_at(QPointF(x / ratio, y / ratio))
    assert found is not None
    assert found.point == pytest.approx(TOP, abs=1e-4)
    # At rest it is not there.
    bench.scene.show_orientation(None)
    bench.settle()
    other = bench.scene.pick_at(QPointF(x / ratio, y / ratio))
    assert other is None or np.linalg.norm(other.point - TOP) > 1e-3


def test_a_handle_is_moved_by_its_ball_and_turned_by_its_arrows_alone(bench):
    scene, moved, camera = bench.scene, [], bench.scene.camera()
    scene.handle_moved.connect(moved.append)
    scene.handle_dropped.connect(lambda: moved.append(None))
    at = np.array([0.0, 0.0, 0.03])
    scene.show_handle(np.eye(3), at)
    bench.settle()
    to = at + [0.012, 0.0, 0.009]  # seen from the front: x to the right, z up
    bench.drag(bench.place(at), bench.place(to))
    assert moved.pop() is None
    assert moved[-1][:3, 3] == pytest.approx(to, abs=6e-4)  # a pixel
    assert moved[-1][:3, :3] == pytest.approx(np.eye(3))
    assert scene.camera() == camera
    axes, hits = scene.handle._axes, []
    for step in np.linspace(0.005, 0.05, 46):
        scene.handle.grab(bench.place(to + [0, 0, step]))
        hits += [step] * (axes.GetInteractionState() == axes.RotatingZVector)
    scene.handle.drop()
    axes.SetLockedAxis(-1)  # a pale tip was under it, too
    tip = hits[len(hits) // 2]
    bench.drag(bench.place(to + [0, 0, tip]), bench.place(to + [tip, 0, tip]))
    R = moved[-2][:3, :3]
    assert moved[-2][:3, 3] == pytest.approx(to, abs=6e-4)
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-9)
    assert R[2, 2] == pytest.approx(1.0, abs=1e-4)  # rolled to the right
    assert R[1, 0] > 0.3
    scene.show_handle(None)
    bench.drag(bench.place(to), bench.place(at))
    assert scene.camera() != camera
