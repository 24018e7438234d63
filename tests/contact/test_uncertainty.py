"""The covariance against sampled noise, and against the closed form for a force along the normal."""

import numpy as np
import pytest
from contact_cases import bundled

import assets
from pipeline.contact import ContactSolver, Gates, Reason, WrenchNoise
from pipeline.errors import InputError
from pipeline.mesh import Probe
from pipeline.simulation import add_noise

# A flat face 100 mm from the sensor origin, large enough that no sample leaves it.
_PLATE = Probe.from_arrays(
    np.array([[x, y, z] for z in (0.1, -0.1) for y in (-0.9, 0.9) for x in (-0.9, 0.9)], dtype=float),
    np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
        + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    ),
)
_NOISE = WrenchNoise(force=0.05, torque=0.0014)


def press(force: float, degrees: float, point=(0.01, -0.005, 0.1)) -> np.ndarray:
    angle = np.radians(degrees)
    pushing = force * np.array([np.sin(angle), 0.0, -np.cos(angle)])
    return np.hstack([pushing, np.cross(point, pushing) + [0, 0, 5e-4]])


@pytest.mark.parametrize(
    ("force", "degrees", "rms_mm"),
    [
        (10, 0, 0.74), (10, 30, 0.85), (10, 60, 1.5), (10, 75, 2.8), (10, 85, 8.4), (10, 89, 42),
        (1, 0, 7.5), (2, 0, 3.7), (5, 0, 1.5), (20, 0, 0.37),
    ],
)  # fmt: skip
# At 89 degrees the first-order figure is 0.73 / cos(89 deg) = 42; sampled errors exceed it, and `linear` says so.
def test_reference_values(force, degrees, rms_mm):
    solver = ContactSolver(_PLATE, _NOISE, Gates(friction_angle=89.9))
    contact = solver.locate(press(force, degrees, point=(0, 0, 0.1)))
    assert 1e3 * np.sqrt(np.trace(contact.covariance)) == pytest.approx(rms_mm, rel=0.03)


@pytest.mark.parametrize("force", [1, 2, 5, 10, 20])
@pytest.mark.parametrize("degrees", [0, 30, 60, 75])
def test_predicted_equals_sampled_where_linear(force, degrees):
    solver = ContactSolver(_PLATE, _NOISE, Gates(friction_angle=89.9, rival_sigmas=0.0))
    contact = solver.locate(press(force, degrees))
    rng = np.random.default_rng(force * 100 + degrees)
    wrenches = add_noise(np.tile(press(force, degrees), (20_000, 1)), _NOISE, rng)
    points = solver.locate_batch(wrenches).points
    sampled = np.cov(points[np.isfinite(points).all(axis=1)].T)
    agrees = np.sqrt(np.trace(sampled) / np.trace(contact.covariance)) == pytest.approx(1, abs=0.1)
    assert agrees or not contact.linear
    # On a plate only the force's direction bends the answer: sigma_F / (n . F) over 0.1.
    assert contact.linear == (0.05 / (force * np.cos(np.radians(degrees))) <= 0.1)


def test_predicted_equals_sampled_on_a_probe():
    probe = bundled("convex", 20_000)
    solver = ContactSolver(probe, _NOISE)
    surface = assets.surface("convex")
    rng = np.random.default_rng(3)
    points, normals, *_ = surface.sample(400, rng, where=lambda p, n: (p[:, 2] > 0.12) & (n[:, 2] > 0.8))
    checked = 0
    for point, normal in zip(points[:40], normals[:40], strict=True):
        wrench = np.hstack([-10 * normal, np.cross(point, -10 * normal)])
        contact = solver.locate(wrench)
        if contact.reason != Reason.OK or not contact.linear:
            continue
        batch = solver.locate_batch(add_noise(np.tile(wrench, (4_000, 1)), _NOISE, rng))
        spread = np.cov(batch.points[batch.reasons <= Reason.VERTEX].T)
        assert np.sqrt(np.trace(spread) / np.trace(contact.covariance)) == pytest.approx(1, abs=0.1)
        checked += 1
    assert checked >= 10


def test_an_edge_is_not_linear():
    probe = bundled("linear", 2000)
    solver = ContactSolver(probe, _NOISE)
    # On the rim of the 8 mm face one side of the ellipse hangs over.
    tip = probe.vertices[:, 2].max()
    wrench = np.hstack([[0, 0, -2.0], np.cross([0, 0.0042, tip], [0, 0, -2.0])])
    contact = solver.locate(wrench)
    assert contact.point is not None
    assert not contact.linear


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
