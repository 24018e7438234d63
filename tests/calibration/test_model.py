"""The gravity model against the physics it stands for, its derivatives, and chance."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PARAMETERS, GravityModel
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    STANDARD_GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
    prediction_jacobian,
)
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import InputError

MODEL = GravityModel([0.3, -0.2, -6.0], [5.0, -3.0, 400.0], [0.01, -0.02, 0.06], [0.1, -0.2, 0.3])


def some_covariance(rng: np.random.Generator) -> np.ndarray:
    """Of correlated parameters, of the size that a calibration leaves."""
    mixed = rng.standard_normal((12, 12)) * np.repeat([0.02, 0.02, 5e-4, 1e-3], 3)[:, None] / np.sqrt(12)
    return mixed @ mixed.T


# ---- readings ----------------------------------------------------------------------------------


def test_a_kilogram_on_its_side():
    """The sensor's x axis points to the ground; the load hangs 100 mm along its z axis."""
    R_WS = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    model = GravityModel([0, 0, -STANDARD_GRAVITY], np.zeros(3), [0, 0, 0.1], np.zeros(3))
    assert np.allclose(model.predict(R_WS), [9.80665, 0, 0, 0, 0.980665, 0], atol=1e-15)
    assert model.mass == pytest.approx(1.0)


def test_readings_follow_the_equations(rng):
    rotations = Rotation.random(20, rng).as_matrix()
    many = MODEL.predict(rotations)
    for R_WS, reading in zip(rotations, many, strict=True):
        weight_S = R_WS.T @ MODEL.gravity_W
        torque = np.cross(MODEL.centre_of_mass_S, weight_S) + MODEL.torque_bias
        assert np.allclose(reading, [*(weight_S + MODEL.force_bias), *torque], rtol=0, atol=1e-12)
        assert np.allclose(MODEL.predict(R_WS), reading, rtol=0, atol=1e-12)
    assert MODEL.predict(np.zeros((0, 3, 3))).shape == (0, 6)


def test_the_jacobian_is_the_slope_of_the_readings(rng):
    rotations = Rotation.random(5, rng).as_matrix()
    J = prediction_jacobian(rotations.swapaxes(1, 2), MODEL.vector)
    for column in range(12):
        step = np.zeros(12)
        step[column] = 1e-3
        up, down = (
            GravityModel.from_vector(MODEL.vector + sign * step, np.zeros((12, 12))).predict(rotations)
            for sign in (1, -1)
        )
        assert np.allclose(J[:, :, column], (up - down) / 2e-3, atol=1e-9), PARAMETERS[column]


def test_compensation_leaves_what_the_tissue_does(rng):
    rotations = Rotation.random(7, rng).as_matrix()
    touch = rng.standard_normal((7, 6))
    assert np.allclose(MODEL.compensate(rotations, MODEL.predict(rotations) + touch), touch, atol=1e-12)
    assert np.allclose(
        MODEL.compensate(rotations[0], MODEL.predict(rotations[0]) + touch[0]), touch[0], atol=1e-12
    )
    still = MODEL.compensate(rotations[0].tolist(), MODEL.predict(rotations[0]) + touch)
    assert np.allclose(still, touch, atol=1e-12)
    assert MODEL.compensate(np.zeros((0, 3, 3)), np.zeros((0, 6))).shape == (0, 6)


@pytest.mark.parametrize(
    ("R", "wrench"),
    [
        ((3, 3), (5,)),
        ((3, 3), ()),
        ((2, 3, 3), (6,)),
        ((2, 3, 3), (3, 6)),
        ((1, 3, 3), (3, 6)),
        ((4, 4), (6,)),
        ((3,), (6,)),
        ((6, 3, 3), (6, 3)),
    ],
)
def test_shapes_that_do_not_fit_are_refused(R, wrench):
    with pytest.raises(InputError, match="do not fit"):
        MODEL.compensate(np.zeros(R), np.zeros(wrench))


# ---- uncertainty -------------------------------------------------------------------------------


def test_uncertainty_of_a_wrench_is_that_of_drawn_models(rng):
    covariance = some_covariance(rng)
    model = GravityModel.from_vector(MODEL.vector, covariance)
    R_WS = Rotation.random(2, rng).as_matrix()
    drawn = rng.multivariate_normal(MODEL.vector, covariance, 40_000)
    weights = np.einsum("nji,kj->nki", R_WS, drawn[:, GRAVITY])
    forces = weights + drawn[:, FORCE_BIAS]
    torques = np.cross(drawn[:, CENTRE_OF_MASS], weights) + drawn[:, TORQUE_BIAS]
    readings = np.concatenate([forces, torques], axis=2)
    for one, stated in zip(readings, model.wrench_covariance(R_WS), strict=True):
        sigmas = np.sqrt(np.diag(stated))
        assert np.abs((np.cov(one.T) - stated) / np.outer(sigmas, sigmas)).max() < 0.04


def test_uncertainty_of_one_and_of_many_agree_and_a_solver_takes_it(rng):
    model = GravityModel.from_vector(MODEL.vector, some_covariance(rng))
    rotations = Rotation.random(4, rng).as_matrix()
    many = model.wrench_covariance(rotations)
    assert many.shape == (4, 6, 6)
    for R_WS, one in zip(rotations, many, strict=True):
        assert np.allclose(model.wrench_covariance(R_WS), one, rtol=1e-12)
        assert np.array_equal(one, one.T)
        noise = WrenchNoise(0.05, 0.002, extra=one)
        assert np.allclose(noise.covariance - np.diag(np.repeat([0.05, 0.002], 3) ** 2), one)
    assert MODEL.wrench_covariance(np.eye(3)).max() == 0


@pytest.mark.parametrize("gravity", [[0.0, 0.0, -6.0], [3.0, -1.0, -5.0]])
def test_uncertainty_of_the_mass_is_that_of_drawn_weights(rng, gravity):
    covariance = some_covariance(rng)
    model = GravityModel(gravity, np.zeros(3), np.zeros(3), np.zeros(3), covariance)
    drawn = rng.multivariate_normal(gravity, covariance[GRAVITY, GRAVITY], 200_000)
    masses = np.linalg.norm(drawn, axis=1) / STANDARD_GRAVITY
    assert model.mass_sigma == pytest.approx(masses.std(), rel=0.02)
    assert model.mass == pytest.approx(masses.mean(), abs=1e-4)


def test_without_weight_the_worst_direction_counts():
    covariance = np.zeros((12, 12))
    covariance[GRAVITY, GRAVITY] = np.diag([0.01, 0.09, 0.04])
    model = GravityModel(*np.zeros((4, 3)), covariance)
    assert model.mass == 0
    assert model.mass_sigma == pytest.approx(0.3 / STANDARD_GRAVITY)


# ---- values ------------------------------------------------------------------------------------


def test_the_vector_holds_the_parameters_in_their_order(rng):
    covariance = some_covariance(rng)
    theta = np.arange(1.0, 13.0)
    model = GravityModel.from_vector(theta, covariance)
    assert np.array_equal(model.vector, theta)
    assert np.array_equal(model.covariance, covariance)
    for name, part in (
        ("gravity_W", GRAVITY),
        ("force_bias", FORCE_BIAS),
        ("centre_of_mass_S", CENTRE_OF_MASS),
        ("torque_bias", TORQUE_BIAS),
    ):
        assert np.array_equal(getattr(model, name), theta[part])
        assert [parameter.rsplit("_", 1) for parameter in PARAMETERS[part]] == [
            [name, axis] for axis in "xyz"
        ]


@pytest.mark.parametrize(
    "field", ["gravity_W", "force_bias", "centre_of_mass_S", "torque_bias", "covariance"]
)
@pytest.mark.parametrize("bad", [[1.0, 2.0], [1.0, np.nan, 0.0], np.full((12, 12), np.inf), 3.0])
def test_values_that_are_no_model_are_refused(field, bad):
    values = dict.fromkeys(("gravity_W", "force_bias", "centre_of_mass_S", "torque_bias"), np.zeros(3))
    with pytest.raises(InputError, match=f"GravityModel.{field}"):
        GravityModel(**(values | {field: bad}))


def test_a_model_keeps_its_own_values():
    weight = np.array([0.0, 0.0, -5.0])
    model = GravityModel(weight, *np.zeros((3, 3)))
    weight[2] = 0
    assert model.gravity_W[2] == -5
    for name in ("gravity_W", "force_bias", "centre_of_mass_S", "torque_bias", "covariance"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(model, name)[0] = 1


def test_the_cross_matrix_crosses(rng):
    a, b = rng.standard_normal((2, 4, 5, 3))
    assert np.allclose((cross_matrix(a) @ b[..., None])[..., 0], np.cross(a, b), atol=1e-15)
