"""Touches that spin and areas that slide are drawn as they are said to be, and every figure of them is measured."""

import numpy as np
import pytest
from benchmarks import torsion


def test_every_figure_is_measured():
    report = torsion.run(probes=("linear",), streams=1, seeds=1)
    assert len(report.figures) == 4 * 9 + 6 * 2 + 2 * 5
    assert all(np.isfinite(figure.measured) for figure in report.figures)


@pytest.mark.parametrize("torque", [0.0, 0.032])
def test_a_spin_is_a_torque_about_the_normal(torque):
    point, wrenches = torsion.spinning("convex", torque, 1500, np.random.default_rng(0))
    forces, moments = wrenches[60:, :3], wrenches[60:, 3:]
    assert np.linalg.norm(forces, axis=1).max() < 10.1
    left = moments - np.cross(point, forces)
    assert np.sqrt(np.mean(np.sum(left**2, axis=1))) == pytest.approx(torque, rel=0.25, abs=0.006)


def test_pressure_of_an_area_acts_at_its_centre_and_friction_beside_it():
    off = []
    for friction in (0.0, 0.6):
        centre, wrenches = torsion.sliding("convex", 0.015, friction, 0.0, 400, np.random.default_rng(0))
        forces = wrenches[100:, :3]
        rest = wrenches[100:, 3:] - np.cross(centre, forces)
        off.append(np.linalg.norm(np.cross(forces, rest), axis=1) / (forces**2).sum(axis=1))
        slope = np.linalg.norm(forces[:, :2], axis=1) / -forces[:, 2]
        assert (np.median(slope) > 0.3) == (friction > 0)
    assert np.median(off[0]) < 0.003
    assert off[1].max() < 0.006
