"""Foreign programs beside ours: plain least squares for a calibration, and an estimator for a plane."""

import numpy as np
import pytest

from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.contact import ContactSolver, TouchModel
from contactbench.pipeline.simulation.weighing import draw_weighing
from contactbench.pipeline.study.rivals.rows import OURS, TOLD

from . import calibrators, plane


def test_plain_least_squares_find_the_truth_without_noise():
    weighing = draw_weighing(
        np.random.default_rng(1), poses=(10, 10), force_noise=(1e-9, 1e-9), torque_noise=(1e-9, 1e-9)
    )
    arrays = stack(weighing.poses)
    for fit in calibrators.PLAIN.values():
        assert fit(arrays.R_SW, arrays.F, arrays.M) == pytest.approx(weighing.truth.vector, abs=1e-6)


def test_a_measured_regressor_shrinks_the_centre_of_mass_and_a_known_vertical_does_not():
    rng = np.random.default_rng(2)
    shrunk = []
    for _ in range(200):
        weighing = draw_weighing(rng, poses=(8, 12), mass=(0.1, 0.1), force_noise=(0.2, 0.2))
        arrays = stack(weighing.poses)
        true = weighing.truth.centre_of_mass_S
        shrunk.append(
            [
                fit(arrays.R_SW, arrays.F, arrays.M)[6:9] @ true / (true @ true)
                for fit in calibrators.PLAIN.values()
            ]
        )
    measured, vertical = np.mean(shrunk, axis=0)
    assert measured < 0.9
    assert vertical == pytest.approx(1.0, abs=0.05)


def test_a_bumped_pose_bends_plain_least_squares_and_a_tilted_base_the_known_vertical():
    rows = [row for row in calibrators.calibration_rows(12, 1, 0) if row["kind"] == "error"]
    mean = {(row["contender"], row["condition"]): row["mean_mm"] for row in rows}
    bumped, tilted, clean = "two of ten poses bumped", "base tilted by 1°", "clean, 8 to 12 poses"
    for name in calibrators.PLAIN:
        assert mean[name, bumped] > 3 * mean[OURS, bumped]
    # What is told of the noise alone does not move a calibration much.
    assert mean[TOLD, clean] == pytest.approx(mean[OURS, clean], rel=0.3)
    # All but the one that takes the vertical for known do not see the tilt.
    assert mean[OURS, tilted] == pytest.approx(mean[OURS, clean], rel=0.01)
    assert mean[calibrators.VERTICAL, tilted] != pytest.approx(mean[calibrators.VERTICAL, clean], rel=0.01)


def test_the_flat_face_is_the_top_of_a_closed_block():
    block = plane._block()
    assert block.health.watertight
    points, normals = plane.FlatFace().sample(20, np.random.default_rng(0))
    assert (points[:, 2] == block.vertices[:, 2].max()).all()
    forces = np.broadcast_to([1.0, 2.0, -10.0], points.shape)
    wrenches = np.hstack([forces, np.cross(points, forces) + 0.01 * normals])
    any_torsion = ContactSolver(block, model=TouchModel(torsion_arm=1_000.0))
    assert any_torsion.locate_batch(wrenches).points == pytest.approx(points, abs=1e-9)


def test_bota_finds_contacts_on_a_plane_if_it_is_there():
    pytest.importorskip("bota_tactile_sensing_utils")
    points, normals = plane.FlatFace().sample(20, np.random.default_rng(0))
    forces = np.broadcast_to([1.0, 2.0, -10.0], points.shape)
    wrenches = np.hstack([forces, np.cross(points, forces) + 0.01 * normals])
    assert plane.BotaPlane(0.1).locate_batch(wrenches) == pytest.approx(points, abs=1e-9)
