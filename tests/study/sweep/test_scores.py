"""What answers are worth: the bound, and who is astray."""

from types import SimpleNamespace

import numpy as np

from contactbench.pipeline.contact import ContactSolver, Gates, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.study.sweep.cell import bound_of, gates_for, judged, touches_of
from contactbench.pipeline.study.sweep.plan import FILTERS, SweepPlan, believed, deviations, mesh_of


def test_the_bound_is_what_the_solver_states_on_a_fine_mesh():
    [cell] = SweepPlan(probes=("convex",), angles=(30.0,), methods=("contactbench",), touches=300).cells()
    touches, _ = touches_of(cell)
    # Of a method that knows nothing but the sensor's noise: any torsion, the mesh as it is, no model error.
    ignorant = TouchModel(torsion_arm=1.0, model_error=WrenchNoise(0.0, 0.0), mesh_curved=False)
    solver = ContactSolver(
        mesh_of("convex", 20_000), believed("paper", "none"), Gates(depth_distance=0), ignorant
    )
    batch = solver.locate_batch(touches.wrenches)
    near = np.linalg.norm(batch.points - touches.points, axis=1) < 1e-3
    stated = np.trace(batch.covariances[near], axis1=1, axis2=2)
    ours = bound_of(touches, deviations("paper", "none"))[near]
    assert near.mean() > 0.95
    assert np.allclose(stated, ours, rtol=0.2)
    assert np.isclose(stated.mean(), ours.mean(), rtol=0.02)


def test_filters_leave_their_share_of_the_noise():
    assert np.allclose(deviations("paper", "mean-50"), deviations("paper", "none") / np.sqrt(50))
    assert 0 < FILTERS["kalman"] < FILTERS["mean-10"]
    assert (deviations("none", "none") == 0).all()


def _answers(off_mm, reasons):
    points = np.zeros((len(off_mm), 3))
    points[:, 0] = np.array(off_mm) * 1e-3
    truth = SimpleNamespace(
        points=np.zeros_like(points), wrenches=np.tile([0, 0, -9.0, 0, 0, 0], (len(points), 1))
    )
    return SimpleNamespace(points=points, reasons=np.array([r.value for r in reasons])), truth


def test_who_is_off_by_more_than_noise_explains_is_astray():
    batch, truth = _answers(
        [0.5, 60.0, 80.0, np.nan, 4.0],
        [Reason.OK, Reason.OK, Reason.AMBIGUOUS, Reason.OFF_SURFACE, Reason.VERTEX],
    )
    row = judged(batch, truth, np.full(5, 1e-6))
    assert (row["answered"], row["sure"], row["astray"], row["astray_sure"]) == (0.8, 0.6, 0.4, 0.2)
    assert row["reason_ambiguous"] == row["reason_vertex"] == 0.2
    assert np.isclose(row["rms_sure_mm"], np.sqrt((0.25 + 3600 + 16) / 3))
    assert np.isclose(row["rms_near_mm"], np.sqrt((0.25 + 16) / 2))
    assert np.isclose(row["mean_mm"], (0.5 + 60 + 80 + 4) / 4)
    assert np.isclose(row["bound_mm"], 1.0)
    # With 20 mm of noise 60 mm off is nothing: three deviations.
    assert judged(batch, truth, np.full(5, 4e-4))["astray"] == 0


def test_no_answers_give_no_figures():
    batch, truth = _answers([np.nan, np.nan], [Reason.OFF_SURFACE] * 2)
    row = judged(batch, truth, np.full(2, 1e-6))
    assert row["answered"] == 0
    assert np.isnan([row["mean_mm"], row["over_bound"], row["bound_mm"]]).all()


def test_gates_allow_for_the_steepest_touch_and_are_the_usual_ones_otherwise():
    assert gates_for(0.0) == gates_for(60.0) == Gates()
    assert gates_for(70.0) == Gates(friction_angle=85.0)
    assert gates_for(88.0).friction_angle == 89.0
