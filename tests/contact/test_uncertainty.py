"""The covariance against sampled touches, and against the closed form's first-order figures."""

import numpy as np
import pytest
from contact_cases import bundled

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Gates, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise, draw_touches

# A flat face 100 mm from the sensor origin, large enough that no sample leaves it.
_PLATE = Probe.from_arrays(
    np.array([[x, y, z] for z in (0.1, -0.1) for y in (-0.9, 0.9) for x in (-0.9, 0.9)], dtype=float),
    np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
        + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    ),
)
_NOISE = WrenchNoise(force=0.05, torque=0.0014)


def press(force: float, degrees: float, point=(0.01, -0.005, 0.1), torque: float = 5e-4) -> np.ndarray:
    angle = np.radians(degrees)
    pushing = force * np.array([np.sin(angle), 0.0, -np.cos(angle)])
    return np.hstack([pushing, np.cross(point, pushing) + [0, 0, torque]])


def press_solver(torsion_arm: float = 1000.0, friction_angle: float = 89.9) -> ContactSolver:
    """The plate with the sensor's noise and nothing else; a large torsion arm leaves the torsion free."""
    model = TouchModel(torsion_arm, WrenchNoise(0.0, 0.0), mesh_curved=False)
    # What misses the plate is not what is measured here.
    return ContactSolver(_PLATE, _NOISE, Gates(friction_angle=friction_angle, first_odds=1e9), model)


@pytest.mark.parametrize(
    ("force", "degrees", "rms_mm"),
    [
        (10, 0, 0.74), (10, 30, 0.85), (10, 60, 1.5), (10, 75, 2.8), (10, 85, 8.4), (10, 89, 42),
        (1, 0, 7.5), (2, 0, 3.7), (5, 0, 1.5), (20, 0, 0.37),
    ],
)  # fmt: skip
def test_reference_values(force, degrees, rms_mm):
    """With the torsion free it is the closed form's: first-order figures from the sensor's noise alone."""
    batch = press_solver().foreign_batch(
        press(force, degrees, point=(0, 0, 0.1))[None],
        np.array([[0.0, 0, 0.1]]),
        np.zeros(1, np.int32),
        np.zeros(1),
    )
    assert 1e3 * np.sqrt(np.trace(batch.covariances[0])) == pytest.approx(rms_mm, rel=0.03)


@pytest.mark.parametrize("force", [2, 5, 10, 20])
@pytest.mark.parametrize("degrees", [0, 30, 60, 75])
@pytest.mark.parametrize("torsion_arm", [0.0, 0.001, 1000.0])
def test_predicted_equals_sampled(force, degrees, torsion_arm):
    """Torsion as the model says, noise as the sensor's: the covariance is that of the error."""
    solver = press_solver(torsion_arm)
    point, rng = np.array([0.01, -0.005, 0.1]), np.random.default_rng(force * 100 + degrees)
    arm = min(torsion_arm, 0.001)
    wrenches = np.tile(press(force, degrees, tuple(point), torque=0.0), (20_000, 1))
    wrenches[:, 5] += arm * force * rng.standard_normal(20_000)
    batch = solver.locate_batch(add_noise(wrenches, _NOISE, rng))
    found = batch.reasons <= Reason.AMBIGUOUS
    assert found.mean() > 0.98  # what is implausible by chance
    predicted = solver.locate(press(force, degrees, tuple(point), torque=0.0)).covariance
    off = batch.points[found] - point
    sampled = np.sqrt(np.mean(np.sum(off**2, axis=1)))
    # First order: a force whose direction is known to a tenth bends it by some per cent.
    bent = 0.05 / (force * np.cos(np.radians(degrees)))
    assert sampled / np.sqrt(np.trace(predicted)) == pytest.approx(1, abs=0.06 + 4 * bent**2)


def test_predicted_equals_sampled_on_a_probe():
    """The 95 % ellipse holds 95 % of the touches: noise and torsion as the model says, on a curved surface."""
    surface = assets.surface("convex")
    model = TouchModel(model_error=WrenchNoise(0.0, 0.0))
    rng = np.random.default_rng(3)
    touches = draw_touches(surface, 6_000, rng, above=0.02, torsion_arm=0.001)
    wrenches = add_noise(touches.wrenches, _NOISE, rng)
    solver = ContactSolver(bundled("convex", 20_000), _NOISE, model=model)
    held = []
    for point, contact in zip(touches.points, map(solver.locate, wrenches), strict=True):
        if not contact.accepted or contact.vertex is not None:
            continue
        off, axes = point - contact.point, contact.ellipse
        held.append(sum((off @ axis / (axis @ axis)) ** 2 for axis in axes) <= 5.991)
    assert len(held) > 5_000
    assert np.mean(held) == pytest.approx(0.95, abs=0.03)


def test_the_model_error_and_the_mesh_widen_the_ellipse():
    wrench = press(10, 20)

    def sigma(**changed) -> float:
        model = TouchModel(model_error=changed.pop("model_error", WrenchNoise(0.0, 0.0)), **changed)
        return ContactSolver(_PLATE, _NOISE, model=model).locate(wrench).sigma_max

    assert sigma(model_error=WrenchNoise(0.05, 0.001)) > 1.2 * sigma()
    assert sigma(mesh_deviation=0.001) > 1.1 * sigma()
    assert sigma(torsion_arm=0.005) > sigma()
    # The floor is added to the noise, channel by channel.
    whole = ContactSolver(_PLATE, _NOISE, model=TouchModel(model_error=WrenchNoise(0.3, 0.02))).covariance
    assert np.allclose(np.diag(whole), [0.05**2 + 0.3**2] * 3 + [0.0014**2 + 0.02**2] * 3)


def test_ellipse_matches_the_covariance():
    contact = ContactSolver(_PLATE, _NOISE).locate(press(10, 40))
    axes = contact.ellipse
    assert np.allclose(axes.T @ axes, contact.covariance, atol=1e-15)
    assert np.linalg.norm(axes[0]) == pytest.approx(contact.sigma_max)
    assert np.abs(axes @ contact.normal).max() < 1e-12


def test_batch_covariances_equal_single_ones():
    solver = ContactSolver(_PLATE, WrenchNoise(force=(0.05, 0.02, 0.1), torque=0.002, extra=1e-6 * np.eye(6)))
    wrenches = np.array([press(5, 10), press(9, 50), np.zeros(6)])
    batch = solver.locate_batch(wrenches)
    for row in range(2):
        assert np.array_equal(batch.covariances[row], solver.locate(wrenches[row]).covariance)
        assert np.array_equal(batch[row].covariance, batch.covariances[row])
    assert np.isnan(batch.covariances[2]).all()
    assert np.isnan(batch.sigma_max[2])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"force": -1.0}, "WrenchNoise.force"),
        ({"torque": float("nan")}, "WrenchNoise.torque"),
        ({"force": [1, 2]}, "one number or three"),
        ({"extra": np.eye(3)}, r"\(6, 6\)"),
        ({"extra": np.triu(np.ones((6, 6)))}, "symmetric"),
        ({"extra": -np.eye(6)}, "negative eigenvalue"),
    ],
)
def test_impossible_noise_is_refused(arguments, said):
    with pytest.raises(InputError, match=said):
        WrenchNoise(**arguments)
