"""The unknown mount against the Cramér-Rao bound, its own uncertainty, and poses that cannot show it."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import chdtri, fdtri

from contactbench.pipeline.calibration import (
    PARAMETERS,
    ContactTask,
    GravityModel,
    Level,
    Limits,
    PoseError,
    PoseNoise,
    PoseSample,
)
from contactbench.pipeline.calibration.model import prediction_jacobian, turn_jacobian
from contactbench.pipeline.calibration.mount import MountCalibration, estimate_mount
from contactbench.pipeline.calibration.suggest import contact_sensitivity
from contactbench.pipeline.errors import InputError

TILTED_90 = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])


@dataclass
class SetUp:
    """A load, a mount, and poses of the flange with what the sensor reads there."""

    R_WE: np.ndarray
    wrenches: np.ndarray
    model: GravityModel
    R_SE: np.ndarray
    noise: PoseNoise

    @property
    def poses(self):
        return [PoseSample(R, w[:3], w[3:]) for R, w in zip(self.R_WE, self.wrenches, strict=True)]

    def estimate(self, *, known=True, **options):
        return estimate_mount(self.poses, self.noise if known else None, **options)

    def error(self, result):
        """(15,) true minus estimated, the rotation as a vector in S."""
        turn = Rotation.from_matrix(self.R_SE @ result.R_SE.T).as_rotvec()
        return np.concatenate([self.model.vector - result.calibration.model.vector, turn])

    def bound(self):
        """Cramér-Rao bound (15, 15), from numerical derivatives."""
        J = np.empty((len(self.R_WE), 6, 15))
        for k in range(15):
            d = np.eye(15)[k] * 1e-6
            plus, minus = (
                GravityModel.from_vector(self.model.vector + d_[:12], np.eye(12)).predict(
                    self.R_WE @ (Rotation.from_rotvec(d_[12:]).as_matrix() @ self.R_SE).T
                )
                for d_ in (d, -d)
            )
            J[:, :, k] = (plus - minus) / 2e-6
        rows = (J / self.noise.sigmas[:, None]).reshape(-1, 15)
        scale = np.linalg.norm(rows, axis=0)
        return np.linalg.inv((rows / scale).T @ (rows / scale)) / np.outer(scale, scale)


def set_up(rng, R_WE=None, *, mass=None, tilt=3.0, noisy=1.0, R_SE=None):
    """Draw a set-up; mass kg, base tilt up to `tilt` degrees."""
    R_WE = Rotation.random(int(rng.integers(6, 13)), random_state=rng).as_matrix() if R_WE is None else R_WE
    mass = np.exp(rng.uniform(np.log(0.1), np.log(2.0))) if mass is None else mass
    noise = PoseNoise(*(np.exp(rng.uniform(*np.log(span))) for span in ((0.02, 0.2), (5e-4, 1e-2))))
    bearing, angle = rng.uniform(0, 2 * np.pi), np.radians(tilt) * np.sqrt(rng.uniform())
    down = Rotation.from_rotvec([angle * np.cos(bearing), angle * np.sin(bearing), 0]).apply([0, 0, -1])
    parts = (rng.normal(size=3) * scale for scale in (5, 0.05, 0.3))
    model = GravityModel(mass * 9.80665 * down, *parts)
    R_SE = Rotation.random(random_state=rng).as_matrix() if R_SE is None else R_SE
    wrenches = model.predict(R_WE @ R_SE.T) + noisy * noise.sigmas * rng.standard_normal((len(R_WE), 6))
    return SetUp(R_WE, wrenches, model, R_SE, noise)


def turned_about(axes_W, degrees, rng):
    """Orientations of a flange that starts anywhere and turns about W axes by rotation vectors."""
    home = Rotation.random(random_state=rng)
    return (Rotation.from_rotvec(np.radians(degrees)[:, None] * axes_W) * home).as_matrix()


def one_axis(rng, n=8):
    return turned_about(np.array([[0.6, 0.8, 0.0]]), np.linspace(0, 300, n), rng)


def spun(rng, n=8):
    return turned_about(np.array([[0.0, 0.0, 1.0]]), np.linspace(0, 300, n), rng)


def alike(rng, n=8, degrees=5.0):
    axes = rng.normal(size=(n, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    return turned_about(axes, degrees * rng.uniform(size=n) ** (1 / 3), rng)


def square_error(error, covariance):
    return error @ np.linalg.solve(covariance, error)


def refused(result):
    return result.calibration.verdict.level is Level.REFUSE


def reasons(result):
    return result.calibration.verdict.reasons


def rotation_ellipsoid(result):
    """Return d² for 95 %; forces tell most of the rotation."""
    freedom = result.calibration.noise.freedom[0]
    return chdtri(3, 0.05) if np.isinf(freedom) else 3 * fdtri(3, freedom, 0.95)


def wrench_covariance(result, R_WE):
    """Return (n, 6, 6) of compensated wrenches, by the joint covariance."""
    R_SW, theta = result.R_SE @ R_WE.swapaxes(1, 2), result.calibration.model.vector
    J = np.concatenate([prediction_jacobian(R_SW, theta), turn_jacobian(R_SW, theta)], axis=2)
    return J @ result.joint_covariance @ J.swapaxes(1, 2)


# ---- right ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("seed", range(2))
def test_without_noise_everything_is_recovered(seed, known):
    case = set_up(np.random.default_rng(seed), noisy=0.0)
    result = case.estimate(known=known)
    error = case.error(result)
    assert np.abs(error[12:]).max() < 1e-9
    assert np.abs(error[:12]).max() < 1e-8
    assert not result.calibration.rejected


def test_errors_are_those_of_the_bound_and_of_the_covariance():
    rng = np.random.default_rng(11)
    over_bound, turn, joint, deviates, refusals = [], [], [], [], 0
    for _ in range(50):
        case = set_up(rng)
        result = case.estimate()
        error = case.error(result)
        over_bound.append(error[12:] / np.sqrt(np.diag(case.bound())[12:]))
        turn.append(square_error(error[12:], result.rotation_covariance) < rotation_ellipsoid(result))
        joint.append(square_error(error, result.joint_covariance) < chdtri(15, 0.05))
        deviates += result.calibration.deviates.ravel().tolist()
        refusals += refused(result)
    ratio = np.sqrt(np.mean(np.square(over_bound), axis=0))
    # 50 sets: 1 +- 0.1 for a ratio, 0.95 +- 0.03 for a coverage; three times that.
    assert ratio == pytest.approx(np.ones(3), abs=0.3)
    assert 0.86 < np.mean(turn) <= 1
    assert 0.86 < np.mean(joint) <= 1
    assert np.mean(np.square(deviates)) == pytest.approx(1, abs=0.1)  # each pose as if it were left out
    assert refusals < 8  # light loads and much noise: more than 1.5 mm at the contact


def test_noise_that_is_estimated_covers_too():
    rng = np.random.default_rng(12)
    turn, joint = [], []
    for _ in range(25):
        # So few that the noise is uncertain by a fifth and more.
        case = set_up(rng, Rotation.random(int(rng.integers(5, 8)), random_state=rng).as_matrix())
        result = case.estimate(known=False)
        error = case.error(result)
        turn.append(square_error(error[12:], result.rotation_covariance) < rotation_ellipsoid(result))
        joint.append(square_error(error, result.joint_covariance) < result.calibration.ellipsoid() * 15 / 12)
    assert 0.87 < np.mean(turn) <= 1
    assert 0.87 < np.mean(joint) <= 1


def test_noise_that_was_given_too_small_costs_no_poses_but_widens():
    rng = np.random.default_rng(13)
    turn = []
    for _ in range(8):
        case = set_up(rng, noisy=4.0, mass=2.0)
        result = case.estimate()
        assert not result.calibration.plausible
        assert len(result.calibration.rejected) <= 1
        turn.append(square_error(case.error(result)[12:], result.rotation_covariance) < 7.81)
    assert np.mean(turn) > 0.8


def test_narrow_valleys_are_followed_to_the_end():
    rng = np.random.default_rng(16)
    for _ in range(4):
        axes = np.append(rng.normal(size=(8, 2)), np.zeros((8, 1)), axis=1)
        case = set_up(rng, turned_about(axes, np.full(8, 4.0), rng), mass=2.0)
        calibration = case.estimate().calibration
        assert calibration.plausible
        assert len(calibration.rejected) <= 1


@pytest.mark.parametrize("degrees", [45, 90, 120])
def test_the_base_may_hang_on_a_wall(degrees):
    case = set_up(np.random.default_rng(14), mass=1.0)
    turn = Rotation.from_euler("x", degrees, degrees=True).as_matrix()
    moved = SetUp(turn @ case.R_WE, case.wrenches, case.model, case.R_SE, case.noise)
    result = moved.estimate(down_W=turn @ [0, 0, -1.0])
    assert square_error(case.error(result)[12:], result.rotation_covariance) < 16
    assert result.calibration.gravity_W == pytest.approx(turn @ case.model.gravity_W, abs=0.5)
    assert not refused(result)
    unsaid = moved.estimate()
    assert refused(unsaid) == (degrees > 60)
    assert not refused(unsaid) or "--down" in reasons(unsaid)[0]


def test_the_same_poses_give_the_same_answer():
    case = set_up(np.random.default_rng(15))
    first, second = case.estimate(known=False), case.estimate(known=False)
    assert np.array_equal(first.R_SE, second.R_SE)
    assert np.array_equal(first.joint_covariance, second.joint_covariance)


# ---- what the poses cannot show --------------------------------------------------------------------


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize(
    ("poses", "word"),
    [(one_axis, "about one axis"), (spun, "same direction in the flange"), (alike, "too similar")],
)
def test_poses_that_cannot_show_the_mount_are_refused(poses, word, known):
    rng = np.random.default_rng(21)
    for _ in range(3):
        tilt = 0.0 if poses is spun else 3.0
        case = set_up(rng, poses(rng, int(rng.integers(5, 11))), tilt=tilt)
        result = case.estimate(known=known)
        assert refused(result)
        assert word in " ".join(reasons(result))
        assert not result.mounting
        assert result.rotation_sigma_deg > 100
        assert square_error(case.error(result)[12:], result.rotation_covariance) < chdtri(3, 0.001)


@pytest.mark.parametrize("known", [True, False])
def test_without_weight_no_rotation_is_claimed(known):
    rng = np.random.default_rng(22)
    for _ in range(4):
        case = set_up(rng, mass=1e-6)
        result = case.estimate(known=known)
        assert refused(result)
        assert "weight is too small" in reasons(result)[0]
        assert result.rotation_covariance == pytest.approx(np.eye(3) * np.pi**2 / 3)
        assert result.calibration.mass == 0
        assert square_error(case.error(result), result.joint_covariance) < 60


def test_a_weight_that_is_not_felt_is_within_its_uncertainty():
    rng = np.random.default_rng(26)
    for _ in range(4):
        case = set_up(rng, Rotation.random(8, random_state=rng).as_matrix(), mass=0.012)
        case.noise = PoseNoise(0.1, 0.002)
        clean = case.model.predict(case.R_WE @ case.R_SE.T)
        case.wrenches = clean + case.noise.sigmas * rng.standard_normal(clean.shape)
        result = case.estimate()
        assert "weight is too small" in reasons(result)[0]
        error = case.error(result)
        assert square_error(error[:3], result.joint_covariance[:3, :3]) < chdtri(3, 0.05)
        assert square_error(error, result.joint_covariance) < chdtri(15, 0.001)


def test_a_light_load_has_a_rotation_too_uncertain_to_use():
    rng = np.random.default_rng(23)
    R_WE = Rotation.random(8, random_state=rng).as_matrix()
    case = set_up(rng, R_WE, mass=0.03)
    case.noise = PoseNoise(0.08, 0.02)
    case.wrenches = case.model.predict(R_WE @ case.R_SE.T) + case.noise.sigmas * rng.standard_normal((8, 6))
    result = case.estimate()
    assert refused(result)
    assert result.rotation_sigma_deg > 10
    assert f"known only to {result.rotation_sigma_deg:.1f}°" in reasons(result)[0]


def test_the_axis_that_is_not_seen_is_named_in_the_flange():
    rng = np.random.default_rng(25)
    R_WE = Rotation.from_euler("x", np.linspace(0, 150, 7)[:, None], degrees=True).as_matrix()
    result = set_up(rng, R_WE, mass=1.0).estimate()
    assert "(1.00, 0.00, 0.00)" in reasons(result)[0]
    unseen = result.R_SE[:, 0]
    assert np.sqrt(unseen @ result.rotation_covariance @ unseen) > 1.5
    for seen in (result.R_SE[:, 1], result.R_SE[:, 2]):
        assert np.sqrt(seen @ result.rotation_covariance @ seen) < 0.2


# ---- what disagrees --------------------------------------------------------------------------------


@pytest.mark.parametrize("known", [True, False])
def test_bumped_poses_are_named_and_do_not_bend_the_answer(known):
    rng = np.random.default_rng(31)
    inside, false_alarms = [], 0
    for _ in range(8):
        n = int(rng.integers(8, 13))
        case = set_up(rng, Rotation.random(n, random_state=rng).as_matrix())
        bumped = set(rng.choice(n, 2, replace=False).tolist())
        for index in bumped:
            force = rng.normal(size=3)
            force *= rng.uniform(2, 10) / np.linalg.norm(force)
            case.wrenches[index] += np.concatenate([force, np.cross([0.02, 0.03, 0.1], force)])
        result = case.estimate(known=known)
        named = {rejection.index for rejection in result.calibration.rejected}
        assert bumped <= named
        false_alarms += len(named - bumped)
        assert np.array_equal(np.flatnonzero(~result.calibration.kept), sorted(named))
        inside.append(
            square_error(case.error(result)[12:], result.rotation_covariance) < rotation_ellipsoid(result)
        )
    assert false_alarms <= 1
    assert np.mean(inside) > 0.8


@pytest.mark.parametrize(("n", "bumped"), [(8, 3), (7, 2)])
def test_a_rotation_that_few_poses_agree_on_is_refused(n, bumped):
    rng = np.random.default_rng(34)
    case = set_up(rng, Rotation.random(n, random_state=rng).as_matrix(), mass=2.0)
    case.noise = PoseNoise(0.03, 0.001)
    case.wrenches = case.model.predict(case.R_WE @ case.R_SE.T)
    case.wrenches[:bumped] += rng.normal(size=(bumped, 6)) * [5, 5, 5, 0.5, 0.5, 0.5]
    result = case.estimate()
    assert {rejection.index for rejection in result.calibration.rejected} == set(range(bumped))
    assert refused(result)
    assert f"Only {n - bumped} of {n} poses" in reasons(result)[0]


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("sign", [(-1, 1, 1), (-1, -1, -1)])
def test_a_left_handed_frame_and_a_negated_wrench_are_refused_in_words(sign, known):
    rng = np.random.default_rng(32)
    for _ in range(2):
        case = set_up(rng, mass=1.0)
        case.wrenches *= np.tile(sign, 2)
        result = case.estimate(known=known)
        assert refused(result)
        assert "left-handed" in " ".join(reasons(result))
        assert "opposite sign" in " ".join(reasons(result))


@pytest.mark.parametrize("known", [True, False])
def test_orientations_the_wrong_way_round_are_refused(known):
    rng = np.random.default_rng(33)
    for _ in range(4):
        case = set_up(rng, mass=1.0)
        case.R_WE = case.R_WE.transpose(0, 2, 1).copy()
        assert refused(case.estimate(known=known))


# ---- what is made of it ----------------------------------------------------------------------------


def test_the_calibration_is_that_of_the_sensor():
    case = set_up(np.random.default_rng(41), mass=1.0)
    result = case.estimate()
    assert isinstance(result, MountCalibration)
    assert np.array_equal(result.calibration.covariance, result.joint_covariance[:12, :12])
    assert len(PARAMETERS) == 12
    for R_WE, pose in zip(case.R_WE, result.calibration.poses, strict=True):
        assert pytest.approx(R_WE @ result.R_SE.T, abs=1e-12) == pose.R_WS
    predicted = result.calibration.model.predict([pose.R_WS for pose in result.calibration.poses])
    assert result.calibration.residuals == pytest.approx(case.wrenches - predicted, abs=1e-12)


def test_the_joint_covariance_covers_at_orientations_that_were_not_posed():
    rng = np.random.default_rng(42)
    inside = []
    for _ in range(25):
        case = set_up(rng, mass=0.5)
        result = case.estimate()
        R_WE = Rotation.random(2, random_state=rng).as_matrix()
        read = case.model.predict(R_WE @ case.R_SE.T)
        errors = result.calibration.model.compensate(R_WE @ result.R_SE.T, read)
        covariances = wrench_covariance(result, R_WE)
        inside += [square_error(e, C) < chdtri(6, 0.05) for e, C in zip(errors, covariances, strict=True)]
    assert 0.85 < np.mean(inside) <= 1


def test_the_weight_is_known_where_the_mount_is_not():
    rng = np.random.default_rng(43)
    case = set_up(rng, one_axis(rng), mass=2.0)
    result = case.estimate()
    at_poses = wrench_covariance(result, case.R_WE)
    assert result.rotation_sigma_deg > 100
    assert np.sqrt(at_poses[:, range(6), range(6)]).max() < 2 * case.noise.sigmas.max()
    (aside,) = wrench_covariance(result, TILTED_90 @ case.R_WE[:1])
    assert np.sqrt(np.diag(aside)[:3].max()) > 1.0  # N


def test_contact_error_is_that_of_the_joint_covariance():
    case = set_up(np.random.default_rng(44), mass=1.0)
    task = ContactTask(tilt=np.radians(40))
    result = case.estimate(task=task)
    S = contact_sensitivity(task.point, task.normal, task.forces)
    worst = 0.0
    for C in wrench_covariance(result, task.orientations.swapaxes(1, 2) @ result.R_SE):
        worst = max(worst, np.linalg.eigvalsh(S @ C @ S.transpose(0, 2, 1))[:, -1].max())
    assert result.calibration.contact_error == pytest.approx(np.sqrt(worst), rel=1e-9)
    assert result.calibration.task is task


@pytest.mark.parametrize(
    ("degrees", "words"),
    [(0, "in line"), (90, "by 90°"), (-45, "by -45°"), (180, "by 180°"), (91.5, "by 90°"), (20, "")],
)
def test_a_simple_mounting_is_mentioned(degrees, words):
    rng = np.random.default_rng(45)
    R_ES = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
    R_WE = Rotation.random(12, random_state=rng).as_matrix()
    result = set_up(rng, R_WE, mass=2.0, R_SE=R_ES.T).estimate()
    assert bool(result.mounting) == bool(words)
    assert words in result.mounting
    flipped = Rotation.from_euler("x", 180, degrees=True).as_matrix()
    assert not set_up(rng, R_WE, mass=2.0, R_SE=R_ES.T @ flipped).estimate().mounting


def test_a_fair_rotation_is_usable_and_says_how_fair():
    rng = np.random.default_rng(46)
    case = set_up(rng, Rotation.random(12, random_state=rng).as_matrix(), mass=0.2)
    case.noise = PoseNoise(0.15, 0.02)
    clean = case.model.predict(case.R_WE @ case.R_SE.T)
    case.wrenches = clean + case.noise.sigmas * rng.standard_normal(clean.shape)
    result = case.estimate(limits=Limits(good_error=1.0, usable_error=1.0))
    assert 2 < result.rotation_sigma_deg < 10
    assert result.calibration.verdict.level is Level.USABLE
    assert f"known only to {result.rotation_sigma_deg:.1f}°" in reasons(result)[0]
    good = set_up(rng, case.R_WE, mass=2.0)
    good.wrenches = good.model.predict(good.R_WE @ good.R_SE.T)
    assert good.estimate().calibration.verdict.level is Level.GOOD


# ---- wrong input -----------------------------------------------------------------------------------


def test_wrong_input_is_named():
    case = set_up(np.random.default_rng(51), mass=1.0)
    with pytest.raises(PoseError, match="3 poses"):
        estimate_mount(case.poses[:3])
    for sigma in (-1.0, 0.6, np.nan, np.inf):
        with pytest.raises(InputError, match="orientation_sigma"):
            case.estimate(orientation_sigma=sigma)
    with pytest.raises(InputError, match="down_W"):
        case.estimate(down_W=(0, 0, 0))
