"""What a calibration's uncertainty does at the contact: against the contact equation, the kernel and chance."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PARAMETERS, ContactTask, GravityModel
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    STANDARD_GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
    prediction_jacobian,
)
from contactbench.pipeline.calibration.suggest import (
    contact_sensitivity,
    force_directions,
    largest_eigenvalue,
    usual_task,
    worst_sigma,
)
from contactbench.pipeline.contact import ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe

SENSOR = np.repeat([0.05, 0.0014], 3)


def solve(wrench: np.ndarray, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Where a wrench meets the plane through `point`: p x F + k n = M and n.p = n.point, by a general solver."""
    fx, fy, fz = wrench[:3]
    system = np.zeros((4, 4))
    system[:3, :3] = [[0, fz, -fy], [-fz, 0, fx], [fy, -fx, 0]]
    system[:3, 3] = system[3, :3] = normal
    return np.linalg.solve(system, [*wrench[3:], normal @ point])[:3]


def wrench_at(point: np.ndarray, force: np.ndarray) -> np.ndarray:
    return np.concatenate([force, np.cross(point, force)])


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


# ---- how the point moves with the wrench -------------------------------------------------------


def test_sensitivity_is_the_slope_of_the_contact_equation(rng):
    for _ in range(20):
        point, normal = rng.uniform(-0.2, 0.2, 3), unit(rng.standard_normal(3))
        forces = 8 * force_directions(normal, rng.uniform(0, 1.3, 4), rng.uniform(0, 6, 4))
        for force, slope in zip(forces, contact_sensitivity(point, normal, forces), strict=True):
            wrench = wrench_at(point, force)
            assert np.allclose(solve(wrench, point, normal), point, atol=1e-12)
            for channel in range(6):
                step = np.zeros(6)
                step[channel] = 1e-5
                moved = solve(wrench + step, point, normal) - solve(wrench - step, point, normal)
                assert np.allclose(slope[:, channel], moved / 2e-5, rtol=1e-5, atol=1e-7)


def test_sensitivity_is_that_of_the_kernel(rng):
    """The covariance that the solver states on a plate, for the same uncertain wrench."""
    turn, shift = Rotation.random(None, rng).as_matrix(), np.array([0.02, -0.01, 0.03])
    corners = np.array([[0.05, 0, 0.1], [-0.03, 0.05, 0.1], [-0.03, -0.05, 0.1], [0, 0, 0.02]])
    plate = Probe.from_arrays(
        corners @ turn.T + shift, np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
    )
    normal, point = turn[:, 2], turn @ [0.005, 0.002, 0.1] + shift
    mixed = rng.standard_normal((6, 6)) * SENSOR[:, None]
    extra = mixed @ mixed.T
    forces = 10 * force_directions(normal, np.array([0.0, 0.3, 0.6, 1.0]), np.arange(4.0))
    # The sensitivity is that of noise alone, for any torsion on an exact surface.
    noise = WrenchNoise(0.05, 0.0014, extra=extra)
    exact = TouchModel(torsion_arm=1_000.0, model_error=WrenchNoise(0.0, 0.0), mesh_curved=False)
    solver = ContactSolver(plate, noise, model=exact)
    total = extra + np.diag(SENSOR**2)
    for force, slope in zip(forces, contact_sensitivity(point, normal, forces), strict=True):
        contact = solver.locate(wrench_at(point, force))
        assert contact.reason in {Reason.OK, Reason.AMBIGUOUS}
        assert np.allclose(contact.point, point, atol=1e-9)
        expected = slope @ total @ slope.T
        assert np.allclose(contact.covariance, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("force", "degrees", "millimetres"),
    [(10, 0, 0.74), (10, 30, 0.85), (10, 60, 1.5), (10, 75, 2.8), (10, 85, 8.4)]
    + [(1, 0, 7.5), (2, 0, 3.7), (5, 0, 1.5), (20, 0, 0.37)],
)
def test_reference_values(force, degrees, millimetres):
    """Root mean square of the shift, lever 100 mm; the direction of friction moves it by some per cent."""
    normal = np.array([0.0, 0.0, 1.0])
    forces = force * force_directions(normal, np.radians([degrees]), np.zeros(1))
    slope = contact_sensitivity(np.array([0.0, 0.0, 0.1]), normal, forces)[0]
    assert 1e3 * np.sqrt(np.trace(slope @ np.diag(SENSOR**2) @ slope.T)) == pytest.approx(
        millimetres, rel=0.06
    )


# ---- the task ----------------------------------------------------------------------------------


@pytest.mark.parametrize("tilt", [0.0, 0.3, np.pi / 3, np.pi])
def test_orientations_tilt_the_normal_from_straight_down(rng, tilt):
    for normal in (np.array([0.0, 0.0, 1.0]), np.array([-1.0, 0.0, 0.0]), rng.standard_normal(3)):
        task = ContactTask(normal=normal, tilt=tilt)
        R_SW = task.orientations
        assert np.allclose(R_SW @ R_SW.swapaxes(1, 2), np.eye(3), atol=1e-14)
        assert np.allclose(np.linalg.det(R_SW), 1)
        normal_W = task.normal @ R_SW  # R_SW^T n
        angles = np.arccos(np.clip(-normal_W[:, 2], -1, 1))
        assert np.isclose(angles, 0, atol=1e-7).any()
        assert angles.max() == pytest.approx(tilt, abs=1e-7)
        # In all directions: nothing is left out around the vertical.
        assert np.abs(normal_W[angles > 0.9 * tilt][:, :2].sum(axis=0)).max() < 1e-9


def test_forces_push_on_the_surface_within_friction(rng):
    task = ContactTask(normal=rng.standard_normal(3), force=7.0, friction=0.4)
    assert np.allclose(np.linalg.norm(task.forces, axis=1), 7)
    angles = np.arccos(np.clip(-task.forces @ task.normal / 7, -1, 1))
    assert angles.min() == pytest.approx(0, abs=1e-7)
    assert angles.max() == pytest.approx(0.4)
    assert np.linalg.matrix_rank(task.forces[1:] - task.forces[1]) == 2


def test_a_normal_of_any_length_is_a_direction():
    assert ContactTask(point=[0, 0.02, 0.1], normal=[0, 0, 30]).normal.tolist() == [0, 0, 1]
    assert usual_task() is usual_task()
    assert np.array_equal(usual_task().point, ContactTask().point)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"point": [1, 2]}, "ContactTask.point"),
        ({"point": [1, 2, np.nan]}, "ContactTask.point"),
        ({"normal": [0, 0, 0]}, "ContactTask.normal"),
        ({"normal": [1, 0]}, "ContactTask.normal"),
        ({"normal": [np.inf, 0, 0]}, "ContactTask.normal"),
        ({"force": 0.0}, "ContactTask.force"),
        ({"force": -1.0}, "ContactTask.force"),
        ({"force": np.nan}, "ContactTask.force"),
        ({"tilt": 3.2}, "ContactTask.tilt"),
        ({"tilt": np.nan}, "ContactTask.tilt"),
        ({"friction": np.pi / 2}, "ContactTask.friction"),
    ],
)
def test_a_task_that_is_none_is_refused(wrong, said):
    with pytest.raises(InputError, match=said.replace(".", r"\.")):
        ContactTask(**wrong)


# ---- errors ------------------------------------------------------------------------------------


def test_the_sensors_share_is_the_textbook_formula():
    """Along the normal: sqrt(sigma_M^2 + (l sigma_F)^2) / |F| on each axis."""
    task = ContactTask(point=[0, 0, 0.15], force=5.0, friction=0.0)
    expected = np.hypot(0.0014, 0.15 * 0.05) / 5
    assert task.sensor_error(SENSOR) == pytest.approx(expected, rel=1e-9)
    assert replace(task, friction=np.radians(45)).sensor_error(SENSOR) > 1.2 * expected


def test_a_wrong_parameter_moves_the_contact_as_predicted():
    task = ContactTask(point=[0.01, 0.02, 0.12], normal=[0.1, 0.2, 1], force=8.0)
    truth = GravityModel([0.1, 0.2, -6], [1, 2, 3], [0.01, 0, 0.06], [0.1, 0.2, 0.3])
    A = task.parameter_sensitivity(truth.vector)
    assert A.shape == (len(task.orientations) * len(task.forces), 2, 12)
    for column in range(12):
        error = np.zeros(12)
        error[column] = 1e-6
        wrong = GravityModel.from_vector(truth.vector + error, np.zeros((12, 12)))
        moved = [
            solve(
                wrong.compensate(R_SW.T, truth.predict(R_SW.T) + wrench_at(task.point, force)),
                task.point,
                task.normal,
            )
            - task.point
            for R_SW in task.orientations
            for force in task.forces
        ]
        predicted = np.linalg.norm(A @ error, axis=1)
        assert np.allclose(np.linalg.norm(moved, axis=1), predicted, rtol=1e-3, atol=1e-10)


def test_the_calibrations_share_is_the_worst_of_many_drawn(rng):
    task = ContactTask()
    theta = np.array([0, 0, -6, 1, 2, 3, 0.01, 0, 0.06, 0.1, 0.2, 0.3])
    mixed = rng.standard_normal((12, 12)) * np.repeat([0.02, 0.02, 5e-4, 1e-3], 3)[:, None]
    covariance = mixed @ mixed.T
    A = task.parameter_sensitivity(theta)
    shifts = np.einsum("kij,nj->nki", A, rng.multivariate_normal(np.zeros(12), covariance, 5_000))
    worst = max(
        np.sqrt(np.linalg.eigvalsh(np.cov(shifts[:, touch].T))[-1]) for touch in range(shifts.shape[1])
    )
    assert task.calibration_error(theta, covariance) == pytest.approx(worst, rel=0.05)
    assert task.calibration_error(theta, 4 * covariance) == pytest.approx(
        2 * task.calibration_error(theta, covariance)
    )


def test_the_closed_form_is_the_largest_eigenvalue(rng):
    A = rng.standard_normal((50, 2, 12))
    mixed = rng.standard_normal((12, 5))  # of deficient rank, as for poses that do not show everything
    covariance = mixed @ mixed.T
    carried = A @ covariance @ A.swapaxes(1, 2)
    assert np.allclose(largest_eigenvalue(carried), np.linalg.eigvalsh(carried)[:, -1], rtol=1e-12)
    assert worst_sigma(A, covariance) == pytest.approx(np.sqrt(np.linalg.eigvalsh(carried).max()), rel=1e-12)
    assert largest_eigenvalue(np.zeros((2, 2))) == 0
    assert largest_eigenvalue(np.diag([-1e-20, -1e-20])) == 0


def test_a_wider_task_is_harder():
    theta = np.array([0, 0, -6, 1, 2, 3, 0.01, 0, 0.06, 0.1, 0.2, 0.3])
    covariance = np.diag(np.repeat([0.02, 0.02, 5e-4, 1e-3], 3) ** 2)
    usual = ContactTask()
    error = usual.calibration_error(theta, covariance)
    assert replace(usual, force=5.0).calibration_error(theta, covariance) == pytest.approx(2 * error)
    assert replace(usual, friction=1.0).calibration_error(theta, covariance) > error
    assert replace(usual, point=np.array([0, 0, 0.3])).calibration_error(theta, covariance) > error
    # Nothing but the bias: the way the probe is held makes no difference.
    bias_only = np.diag(np.repeat([0.0, 0.02, 0.0, 1e-3], 3) ** 2)
    assert replace(usual, tilt=1.5).calibration_error(theta, bias_only) == pytest.approx(
        usual.calibration_error(theta, bias_only)
    )


# ---- the gravity model against the physics it stands for, its derivatives, and chance ------------


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
