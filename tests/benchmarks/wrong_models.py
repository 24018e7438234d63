"""Sessions of poses in which the gravity model is right, or wrong in one known way: written without the estimator.

Nothing here uses the calibration's own model, so a mistake there cannot hide behind the same mistake here.
A session is drawn clean by `draw`; faults are functions ``fault(session, rng) -> session`` that may be put
one after the other.

    rng = np.random.default_rng(0)
    session = rezero(draw(rng), rng, force=0.3, torque=0.01)
    calibration = calibrate(session.poses(), session.noise())
    session.contact_error(calibration.model.vector)  # m, what is really wrong at the end of the session
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PoseNoise, PoseSample

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Bools = NDArray[np.bool_]
    Range = tuple[float, float]

_GRAVITY = 9.80665  # m/s²
_DOWN = np.array([0.0, 0.0, -1.0])

# The touches behind `contact_error`: 10 N on a point 100 mm along z, from below and from the sides.
_TIP, _NORMAL, _PUSH = np.array([0.0, 0.0, 0.1]), np.array([0.0, 0.0, 1.0]), 10.0
_TILTS, _FRICTION = (0.0, 30.0, 60.0), 30.0  # degrees

Plan = Literal["cube", "random", "cone", "sweep"]
PLANS: tuple[Plan, ...] = ("cube", "random", "cone", "sweep")


@dataclass(frozen=True, eq=False)
class Session:
    """Still poses in the order in which they were taken, and the truth behind them."""

    R_WS: Floats  # (n, 3, 3). Orientations as they are written down.
    true_R_WS: Floats  # (n, 3, 3). Orientations of the sensor.
    wrenches: Floats  # (n, 6). Mean readings, S, N and N·m.
    times: Floats  # (n,). s, from the first pose.
    sigmas: Floats  # (6,). True noise of a mean reading, N and N·m.
    # Weight in W (N), force bias (N), centre of mass in S (m), torque bias (N·m), at the session's end
    truth: Floats
    R_FS: Floats  # (3, 3). How the sensor is turned in the frame whose orientation is written down.
    bumped: Bools  # (n,) bool. Poses that something touched.
    rezeroed: tuple[int, ...] = ()  # Poses, from 0, before which the zero jumped
    orientation_sigma: float = 0.0  # 1 sigma of the written orientations, rad about each axis
    # What a cable adds to the readings (6,) at R_WS (3, 3): it is still there when the probe is used
    pull: Callable[[Floats], Floats] = lambda _: np.zeros(6)
    # (6, 6). What the sensor makes of a wrench: the identity, but for wrong gains, signs and swaps.
    channels: Floats = field(default_factory=lambda: np.eye(6))
    plan: str = ""  # How the orientations were chosen

    def __len__(self) -> int:
        return len(self.times)

    @property
    def weight_S(self) -> Floats:
        """(n, 3) true weight of the tool in the sensor, N."""
        turned: Floats = np.einsum("nji,j->ni", self.true_R_WS, self.truth[:3])
        return turned

    def poses(self, *, timed: bool = True) -> list[PoseSample]:
        """Return the session as a technician hands it over."""
        return [
            PoseSample(R, w[:3], w[3:], time=float(t) if timed else None)
            for R, w, t in zip(self.R_WS, self.wrenches, self.times, strict=True)
        ]

    def noise(self, factor: float = 1.0) -> PoseNoise:
        """Return the noise of a mean reading as it is given: so many times the true one."""
        return PoseNoise(factor * self.sigmas[:3], factor * self.sigmas[3:])

    def bound(self) -> Floats:
        """Return the Cramér-Rao bound (12, 12) of the poses that nothing touched.

        Noise of the orientations counts as noise of the readings that it makes, which is exact to first order.
        """
        information = np.zeros((12, 12))
        L = self.truth[6:9]
        for R_WS, w, clean in zip(self.true_R_WS, self.weight_S, ~self.bumped, strict=True):
            if clean:
                J = np.zeros((6, 12))
                J[:3, :3], J[:3, 3:6], J[3:, 9:] = R_WS.T, np.eye(3), np.eye(3)
                J[3:, :3], J[3:, 6:9] = _skew(L) @ R_WS.T, -_skew(w)
                turned = np.vstack([_skew(w), _skew(L) @ _skew(w)])
                noise = np.diag(self.sigmas**2) + self.orientation_sigma**2 * turned @ turned.T
                information += J.T @ np.linalg.solve(noise, J)
        return np.asarray(np.linalg.inv(information), dtype=np.float64)

    def contact_error(self, theta: Floats, down_W: Floats = _DOWN) -> float:
        """
        Return the largest shift of a contact, m, when readings at the session's end are compensated by `theta`.
        """
        worst = 0.0
        for R_WS in _touching(down_W):
            untouched, taken_off = _read(R_WS, self.truth) + self.pull(R_WS), _read(R_WS @ self.R_FS.T, theta)
            for force in _pushes():
                touch = np.concatenate([force, np.cross(_TIP, force)])
                wrench = self.channels @ (touch + untouched) - taken_off
                worst = max(worst, float(np.linalg.norm(_located(wrench) - _TIP)))
        return worst


# ---- clean sessions ----------------------------------------------------------------------------


def draw(
    rng: np.random.Generator,
    *,
    poses: tuple[int, int] = (8, 20),
    mass: Range = (0.3, 5.0),
    force_noise: Range = (0.02, 0.05),
    torque_noise: Range = (0.001, 0.002),
    plan: Plan | None = None,
    orientation_deg: float = 0.0,
    down_W: Floats = _DOWN,
) -> Session:
    """Draw a tool on a sensor, poses as technicians take them, and what the sensor reads."""
    n = int(rng.integers(poses[0], poses[1] + 1))
    plan = plan or PLANS[rng.integers(len(PLANS))]
    leaning = Rotation.from_rotvec(np.radians(rng.normal(0, 0.5, 3)))
    truth = np.concatenate(
        [
            rng.uniform(*mass) * _GRAVITY * leaning.apply(down_W),
            rng.uniform(-10, 10, 3),
            [*rng.uniform(-0.02, 0.02, 2), rng.uniform(0.03, 0.12)],
            rng.uniform(-0.5, 0.5, 3),
        ]
    )
    R_WS = _turned_down(down_W) @ _orientations(plan, n, rng)
    sigmas = np.repeat([rng.uniform(*force_noise), rng.uniform(*torque_noise)], 3)
    readings = np.array([_read(R, truth) for R in R_WS]) + sigmas * rng.standard_normal((n, 6))
    session = Session(
        R_WS=R_WS,
        true_R_WS=R_WS,
        wrenches=readings,
        times=np.concatenate([[0.0], np.cumsum(rng.uniform(10, 60, n - 1))]),
        sigmas=sigmas,
        truth=truth,
        R_FS=np.eye(3),
        bumped=np.zeros(n, dtype=bool),
        plan=plan,
    )
    return misread_orientation(session, rng, deg=orientation_deg) if orientation_deg else session


def _orientations(plan: Plan, n: int, rng: np.random.Generator) -> Floats:
    """Return R_WS (n, 3, 3) whose sensor points down, z to -z of W, at first."""
    upright = Rotation.from_rotvec([np.pi, 0, 0])
    if plan == "random":
        return Rotation.random(n, rng).as_matrix()
    if plan == "cube":
        # Down, four sides, up: what a table and a spirit level give; then tilts between them.
        faces = [[0, 0, 0], [90, 0, 0], [-90, 0, 0], [0, 90, 0], [0, -90, 0], [180, 0, 0]]
        chosen = np.array([faces[i % 6] if i < 6 else rng.uniform(-70, 70, 3) for i in range(n)], float)
        chosen += rng.normal(0, 3, (n, 3))
        return (upright * Rotation.from_rotvec(np.radians(chosen))).as_matrix()
    tilt = np.radians(rng.uniform(0, 100, n))
    if plan == "sweep":
        tilt.sort()
    around, yaw = rng.uniform(0, 2 * np.pi, n), np.radians(rng.uniform(-150, 150, n))
    axes = np.column_stack([np.cos(around), np.sin(around), np.zeros(n)])
    spun = Rotation.from_rotvec(yaw[:, None] * [0, 0, 1])
    return (upright * Rotation.from_rotvec(tilt[:, None] * axes) * spun).as_matrix()


# ---- faults ------------------------------------------------------------------------------------


def drift(
    session: Session,
    rng: np.random.Generator,
    *,
    force: float = 0.3,
    torque: float = 0.01,
    warm_up: float | None = None,
) -> Session:
    """
    Let the zero creep by `force` N and `torque` N·m from the first pose to the last, each in any direction.
    """
    run = session.times / session.times[-1]
    left = 1 - run  # of the drift: none at the end
    if warm_up:
        decay = np.exp(-run / warm_up)
        left = (decay - decay[-1]) / (1 - decay[-1])
    return _added(session, -left[:, None] * _direction(rng, force, torque))


def rezero(
    session: Session,
    rng: np.random.Generator,
    *,
    force: float = 0.3,
    torque: float = 0.01,
    before: int | None = None,
) -> Session:
    """Let the zero jump by `force` N and `torque` N·m before pose `before`, from 0; left out: not near an end."""
    n = len(session)
    before = int(rng.integers(2, n - 1)) if before is None else before
    step = (np.arange(n) < before)[:, None] * _direction(rng, force, torque)
    return replace(_added(session, step), rezeroed=(*session.rezeroed, before))


def misread_orientation(session: Session, rng: np.random.Generator, *, deg: float = 0.2) -> Session:
    """Write every orientation down with an error of `deg` degrees (1 sigma) about each axis."""
    error = Rotation.from_rotvec(np.radians(rng.normal(0, deg, (len(session), 3)))).as_matrix()
    sigma = float(np.hypot(session.orientation_sigma, np.radians(deg)))
    return replace(session, R_WS=session.R_WS @ error, orientation_sigma=sigma)


def spring(session: Session, rng: np.random.Generator, *, force: float = 0.5) -> Session:
    """Let a cable pull like a spring from a point in the world at a point on the tool, `force` N on average.

    Poses are taken up to 0.2 m from the middle of the room along each axis; the probe is used in the middle.
    """
    anchor = 0.8 * _unit(rng) + [0, 0, 0.6]  # m, from the middle of the room
    held_S = np.array([*rng.uniform(-0.03, 0.03, 2), rng.uniform(0.02, 0.15)])
    places = rng.uniform(-0.2, 0.2, (len(session), 3))
    stretched = anchor - places - session.true_R_WS @ held_S
    stiffness = force / np.linalg.norm(stretched, axis=1).mean()

    def pull(R_WS: Floats, place: Floats | float = 0.0) -> Floats:
        return _pulled(R_WS, stiffness * (anchor - place - R_WS @ held_S), held_S)

    return _cabled(session, pull, places)


def side_pull(session: Session, rng: np.random.Generator, *, force: float = 0.5) -> Session:
    """Let a cable pull with `force` N in one direction of the world, at a point on the tool."""
    held_S = np.array([*rng.uniform(-0.03, 0.03, 2), rng.uniform(0.02, 0.15)])
    pull_W = force * _unit(rng)

    def pull(R_WS: Floats, place: Floats | float = 0.0) -> Floats:
        del place
        return _pulled(R_WS, pull_W, held_S)

    return _cabled(session, pull, np.zeros((len(session), 3)))


def hysteresis(session: Session, rng: np.random.Generator, *, force: float = 0.3) -> Session:
    """Let a stiff cable resist the last turn: `force` N across the axis about which the sensor turned."""
    turns = Rotation.from_matrix(session.true_R_WS[:-1]).inv() * Rotation.from_matrix(session.true_R_WS[1:])
    axes = np.vstack([_unit(rng), turns.as_rotvec()])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    held_S = np.array([0.0, 0.0, rng.uniform(0.02, 0.15)])
    pull = force * np.cross(axes, [0.0, 0.0, 1.0])
    return _added(session, np.hstack([pull, np.cross(held_S, pull)]))


def turned_mount(session: Session, rng: np.random.Generator, *, deg: float = 5.0) -> Session:
    """Turn the sensor on the flange, whose orientations are written down, by `deg` degrees about any axis."""
    turn = Rotation.from_rotvec(np.radians(deg) * _unit(rng)).as_matrix()
    return replace(session, R_WS=session.R_WS @ turn.T, R_FS=turn @ session.R_FS)


def bump(
    session: Session, rng: np.random.Generator, *, count: int = 1, force: Range = (1.0, 10.0)
) -> Session:
    """Push the tool in `count` poses, with `force` N somewhere on its first 150 mm."""
    bumped = session.bumped.copy()
    added = np.zeros((len(session), 6))
    for pose in rng.choice(len(session), count, replace=False):
        push, at = rng.uniform(*force) * _unit(rng), np.array([0, 0, rng.uniform(0.03, 0.15)])
        added[pose] = np.concatenate([push, np.cross(at, push)])
        bumped[pose] = True
    return replace(_added(session, added), bumped=bumped)


def wander(session: Session, rng: np.random.Generator, *, times: float = 2.0) -> Session:
    """Let the zero wander from pose to pose, by so many times the noise over the whole session."""
    steps = rng.standard_normal((len(session), 6)).cumsum(axis=0)
    return _added(session, times * session.sigmas * steps / np.sqrt(len(session)))


def scale(
    session: Session, rng: np.random.Generator, *, by: float = 1.02, channel: int | None = None
) -> Session:
    """Multiply what one channel reads (left out: any) by a factor: a wrong gain, or a sign for -1."""
    gains = np.ones(6)
    gains[int(rng.integers(6)) if channel is None else channel] = by
    return _misconnected(session, np.diag(gains))


def _misconnected(session: Session, channels: Floats) -> Session:
    return replace(session, wrenches=session.wrenches @ channels.T, channels=channels @ session.channels)


# ---- mechanics ---------------------------------------------------------------------------------


def _read(R_WS: Floats, theta: Floats) -> Floats:
    """Return what the sensor reads untouched (6,): weight and bias."""
    weight = R_WS.T @ theta[:3]
    return np.concatenate([weight + theta[3:6], np.cross(theta[6:9], weight) + theta[9:]])


def _added(session: Session, wrenches: Floats) -> Session:
    return replace(session, wrenches=session.wrenches + wrenches)


def _cabled(session: Session, pull: Callable[..., Floats], places: Floats) -> Session:
    """Add a cable's pull in the poses, taken at places (n, 3) in W, and keep it for the use of the probe."""
    added = [pull(R, place) for R, place in zip(session.true_R_WS, places, strict=True)]
    return replace(_added(session, np.array(added)), pull=pull)


def _pulled(R_WS: Floats, pull_W: Floats, at_S: Floats) -> Floats:
    """Return the wrench (6,) in S of a force (3,) in W that acts at a point of the tool."""
    pull_S = R_WS.T @ pull_W
    return np.concatenate([pull_S, np.cross(at_S, pull_S)])


def _direction(rng: np.random.Generator, force: float, torque: float) -> Floats:
    return np.concatenate([force * _unit(rng), torque * _unit(rng)])


def _unit(rng: np.random.Generator) -> Floats:
    v = rng.standard_normal(3)
    unit: Floats = v / np.linalg.norm(v)
    return unit


def _skew(v: Floats) -> Floats:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _turned_down(down_W: Floats) -> Floats:
    """Return the rotation that takes -z to `down_W`."""
    axis, cosine = np.cross(_DOWN, down_W), float(_DOWN @ down_W)
    if np.linalg.norm(axis) < 1e-12:
        axis = np.array([1.0, 0.0, 0.0])
    angle = np.arccos(np.clip(cosine, -1, 1))
    return Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()


def _touching(down_W: Floats) -> list[Floats]:
    """Return the orientations in which the probe is used: its z axis down, and tilted to six sides."""
    upright = Rotation.from_matrix(_turned_down(down_W)) * Rotation.from_rotvec([np.pi, 0, 0])
    found = []
    for tilt in _TILTS:
        for side in np.radians(np.arange(0, 360, 60)) if tilt else [0.0]:
            axis = np.array([np.cos(side), np.sin(side), 0.0])
            found.append((upright * Rotation.from_rotvec(np.radians(tilt) * axis)).as_matrix())
    return found


def _pushes() -> list[Floats]:
    sine, cosine = np.sin(np.radians(_FRICTION)), np.cos(np.radians(_FRICTION))
    sides = [(0.0, 0.0, 1.0)] + [(sine * x, sine * y, cosine) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    return [_PUSH * np.array([x, y, -z]) for x, y, z in sides]


def _located(wrench: Floats) -> Floats:
    """Return the point p of the surface z = 0.1 m and a torque k about its normal with p x F + k n = M."""
    A, b = np.zeros((4, 4)), np.zeros(4)
    A[:3, :3], A[:3, 3], A[3, :3] = -_skew(wrench[:3]), _NORMAL, _NORMAL
    b[:3], b[3] = wrench[3:], _NORMAL @ _TIP
    return np.asarray(np.linalg.solve(A, b)[:3], dtype=np.float64)
