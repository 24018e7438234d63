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
