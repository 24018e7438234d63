"""Is the convention check ever confidently wrong? Known single mistakes, mistakes that it does not know, clean sets."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, PoseNoise, PoseSample
from contactbench.pipeline.calibration.diagnosis.diagnose import Diagnosis, diagnose
from contactbench.pipeline.calibration.diagnosis.explain import NONE
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.calibration.orientation import Convention, Kind, rotations
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import draw_load, weigh
from contactbench.pipeline.study.report import Figure, StudyReport

_MASS, _POSES = (0.3, 5.0), (8, 15)  # kg; how many, both included
_FORCE, _TORQUE = (0.03, 0.05), (0.001, 0.002)  # N and N·m, noise of a pose's mean
_ORIENTATION = np.radians(0.05)
_SURE = 0.75  # odds of 3 to 1
_LBF = 0.45359237 * STANDARD_GRAVITY
_EULER, _VECTOR = Kind.EULER, Kind.ROTATION_VECTOR


@dataclass(frozen=True, eq=False)
class Recorded:
    """Poses with a mistake in them."""

    R_WS: NDArray[np.float64]  # (n, 3, 3)
    wrenches: NDArray[np.float64]  # (n, 6)
    raw: RawOrientations | None = None  # The numbers behind the orientations, where an option is wrong


Mistake = tuple[tuple[str, ...], "Callable[[Recorded, np.random.Generator], Recorded]"]


def _euler(turn: Rotation, order: str) -> NDArray[np.float64]:
    """Return Euler angles (n, 3), rad; the order is a plain string, as options are."""
    angles: NDArray[np.float64] = getattr(turn, "as_euler")(order)  # noqa: B009 - its stub knows only literals
    return angles


def _read(meant: Convention, read: Convention) -> Callable[[Recorded, np.random.Generator], Recorded]:
    """Return what takes numbers that mean one thing for another."""

    def mistaken(truth: Recorded, _: np.random.Generator) -> Recorded:
        turn = Rotation.from_matrix(truth.R_WS.transpose(0, 2, 1) if meant.inverse else truth.R_WS)
        if meant.kind is Kind.QUATERNION:
            numbers = turn.as_quat()[:, [3, 0, 1, 2]]
        else:
            numbers = _euler(turn, meant.order) if meant.kind is _EULER else turn.as_rotvec()
            numbers = np.degrees(numbers) if meant.degrees else numbers
        return Recorded(rotations(numbers, read), truth.wrenches, RawOrientations(numbers, read))

    return mistaken


def _converted(
    meant: str, read: str, columns: slice = slice(None)
) -> Callable[[Recorded, np.random.Generator], Recorded]:
    """Return an earlier program's conversion of angles, scipy's orders or "" for rotation vectors."""

    def mistaken(truth: Recorded, _: np.random.Generator) -> Recorded:
        turn = Rotation.from_matrix(truth.R_WS)
        numbers = _euler(turn, meant) if meant else turn.as_rotvec()
        return replace(truth, R_WS=Rotation.from_euler(read, numbers[:, columns]).as_matrix())

    return mistaken


def _channels(order: tuple[int, ...], *factors: float) -> Callable[[Recorded, np.random.Generator], Recorded]:
    def mistaken(truth: Recorded, _: np.random.Generator) -> Recorded:
        return replace(truth, wrenches=truth.wrenches[:, order] * np.array(factors or (1.0,)))

    return mistaken


def _scaled(force: float, torque: float) -> Callable[[Recorded, np.random.Generator], Recorded]:
    return _channels((0, 1, 2, 3, 4, 5), *np.repeat([1 / force, 1 / torque], 3))


def _negated(*channels: int) -> Callable[[Recorded, np.random.Generator], Recorded]:
    return _channels((0, 1, 2, 3, 4, 5), *np.where(np.isin(np.arange(6), channels), -1.0, 1.0))


def _quaternion(columns: list[int]) -> Callable[[Recorded, np.random.Generator], Recorded]:
    def mistaken(truth: Recorded, _: np.random.Generator) -> Recorded:
        numbers = Rotation.from_matrix(truth.R_WS).as_quat()[:, [3, 0, 1, 2]][:, columns]
        return Recorded(
            rotations(numbers, Convention()), truth.wrenches, RawOrientations(numbers, Convention())
        )

    return mistaken


def _yawed(low: float, high: float) -> Callable[[Recorded, np.random.Generator], Recorded]:
    def mistaken(truth: Recorded, rng: np.random.Generator) -> Recorded:
        turn = Rotation.from_euler("z", rng.uniform(low, high), degrees=True)
        return replace(truth, R_WS=truth.R_WS @ turn.as_matrix())

    return mistaken


def _mounted(truth: Recorded, rng: np.random.Generator) -> Recorded:
    return replace(truth, R_WS=truth.R_WS @ _turn(rng, np.radians(5), np.pi))


def _turn(rng: np.random.Generator, low: float, high: float) -> NDArray[np.float64]:
    """Draw a turn (3, 3) about any axis, by an angle between two, rad."""
    axis = rng.standard_normal(3)
    return Rotation.from_rotvec(rng.uniform(low, high) * axis / np.linalg.norm(axis)).as_matrix()


def _other_world(truth: Recorded, rng: np.random.Generator) -> Recorded:
    angle, heading = rng.uniform(np.radians(35), np.radians(150)), rng.uniform(0, 2 * np.pi)
    axis = np.array([np.cos(heading), np.sin(heading), 0.0])
    return replace(truth, R_WS=Rotation.from_rotvec(angle * axis).as_matrix() @ truth.R_WS)


def _ceiling(truth: Recorded, _: np.random.Generator) -> Recorded:
    return replace(truth, R_WS=np.diag([1.0, -1.0, -1.0]) @ truth.R_WS)


def _y_up(truth: Recorded, _: np.random.Generator) -> Recorded:
    return replace(truth, R_WS=Rotation.from_euler("x", -90, degrees=True).as_matrix() @ truth.R_WS)


def _shifted(step: int) -> Callable[[Recorded, np.random.Generator], Recorded]:
    """Return orientations that come a row early or late; the row at the end repeats its neighbour's or wraps."""

    def mistaken(truth: Recorded, rng: np.random.Generator) -> Recorded:
        moved = np.roll(truth.R_WS, step, axis=0)
        if rng.random() < 0.5:
            moved[0 if step > 0 else -1] = _turn(rng, 0.2, 1.0) @ truth.R_WS[0 if step > 0 else -1]
        return replace(truth, R_WS=moved)

    return mistaken


def _rows_swapped(truth: Recorded, rng: np.random.Generator) -> Recorded:
    i, j = rng.choice(len(truth.R_WS), 2, replace=False)
    moved = truth.R_WS.copy()
    moved[[i, j]] = moved[[j, i]]
    return replace(truth, R_WS=moved)


def _rezeroed(truth: Recorded, rng: np.random.Generator) -> Recorded:
    change = int(rng.integers(2, len(truth.R_WS) - 1))
    jump = np.concatenate(
        [rng.uniform(1, 5) * _turn(rng, 0, np.pi)[0], rng.uniform(0.02, 0.1) * _turn(rng, 0, np.pi)[0]]
    )
    wrenches = truth.wrenches.copy()
    wrenches[change:] += jump
    return replace(truth, wrenches=wrenches)


def _gain(truth: Recorded, rng: np.random.Generator) -> Recorded:
    factor = np.ones(6)
    factor[rng.integers(3)] = 1.2
    return replace(truth, wrenches=truth.wrenches * factor)


_XYZ, _ZYX = Convention(_EULER, "xyz"), Convention(_EULER, "ZYX")
_DEGREES, _RADIANS = Convention(_VECTOR), Convention(_VECTOR, degrees=False)

_CHANNELS = ("fx", "fy", "fz", "mx", "my", "mz")

# The keys of the convention check that tell each mistake.
KNOWN: dict[str, Mistake] = {
    "transposed": (("transposed",), lambda truth, _: replace(truth, R_WS=truth.R_WS.transpose(0, 2, 1))),
    "quaternion xyzw": (("quaternion_xyzw",), _quaternion([1, 2, 3, 0])),
    "quaternion wxyz": (("quaternion_wxyz",), _quaternion([3, 0, 1, 2])),
    "Euler zyx for xyz": (("euler_zyx",), _read(replace(_XYZ, order="zyx"), _XYZ)),
    "Euler XYZ for ZYX": (("euler_XYZ",), _read(replace(_ZYX, order="XYZ"), _ZYX)),
    "rotation vector for Euler": (("rotation_vector",), _read(_DEGREES, _XYZ)),
    "Euler for rotation vector": (("euler_ZYX",), _read(_ZYX, _DEGREES)),
    "degrees for radians": (("degrees",), _read(_XYZ, replace(_XYZ, degrees=False))),
    "radians for degrees": (("radians",), _read(replace(_XYZ, degrees=False), _XYZ)),
    "converted zyx as xyz": (("euler_zyx_read_as_euler_xyz",), _converted("zyx", "xyz", slice(None, None, -1))),
    "converted vectors as xyz": (("rotation_vector_read_as_euler_xyz",), _converted("", "xyz")),
    "N·mm": (("torque_Nmm",), _scaled(1, 1e-3)),
    "1000 too small": (("torque_1000_too_small",), _scaled(1, 1e3)),
    "kgf": (("force_kgf",), _scaled(STANDARD_GRAVITY, 1)),
    "kgf, N·mm": (("force_kgf_torque_Nmm",), _scaled(STANDARD_GRAVITY, 1e-3)),
    "kgf, kgf·m": (("force_kgf_torque_kgfm",), _scaled(STANDARD_GRAVITY, STANDARD_GRAVITY)),
    "wrench negated": (("wrench_negated",), _negated(0, 1, 2, 3, 4, 5)),
    "torques negated": (("torque_negated",), _negated(3, 4, 5)),
    "forces negated": (("force_negated",), _negated(0, 1, 2)),
    **{f"{'xyz'[k]} reversed": ((f"axis_{'xyz'[k]}_reversed",), _negated(k, k + 3)) for k in range(3)},
    **{f"yaw {angle}": ((f"yaw_{angle}", "mount"), _yawed(-angle, -angle)) for angle in (90, 180, 270)},
    "re-zero": (("rezero",), _rezeroed),
    "a gain of 20 % on one axis": (("channel",), _gain),
    "N·cm": (("torque_Ncm",), _scaled(1, 1e-2)),
    "lbf·in": (("torque_lbfin", "torque_kgfcm"), _scaled(1, _LBF * 0.0254)),
    "lbf": (("force_lbf", "force_lbf_torque_lbfft"), _scaled(_LBF, 1)),
    "lbf, lbf·in": (("force_lbf_torque_lbfin",), _scaled(_LBF, _LBF * 0.0254)),
    "lbf, lbf·ft": (("force_lbf_torque_lbfft", "force_lbf"), _scaled(_LBF, _LBF * 0.3048)),
    **{f"{name} negated": ((f"{name}_negated",), _negated(k)) for k, name in enumerate(_CHANNELS)},
    "fx, fy swapped": (("fx_fy_swapped",), _channels((1, 0, 2, 3, 4, 5))),
    "fx, fy and mx, my swapped": (("fx_fy_mx_my_swapped",), _channels((1, 0, 2, 4, 3, 5))),
    "mx, my swapped": (("mx_my_swapped",), _channels((0, 1, 2, 4, 3, 5))),
    "fy, fz and my, mz swapped": (("fy_fz_my_mz_swapped",), _channels((0, 2, 1, 3, 5, 4))),
    "fx, fz swapped": (("fx_fz_swapped",), _channels((2, 1, 0, 3, 4, 5))),
    "forces, torques swapped": (("force_torque_swapped",), _channels((3, 4, 5, 0, 1, 2))),
    "yaw, any angle": (("mount",), _yawed(5, 85)),
    "mount, any turn": (("mount",), _mounted),
    "Euler ZYZ for ZYX": (("euler_ZYZ",), _read(replace(_ZYX, order="ZYZ"), _ZYX)),
    "converted ZYX as xyz": (("columns_ZYX_read_as_xyz",), _converted("ZYX", "xyz")),
    "vectors in radians for Euler": (("rotation_vector_radians",), _read(_RADIANS, _XYZ)),
    "vectors in degrees for radians": (("degrees",), _read(_DEGREES, _RADIANS)),
    "shifted to the next row": (("rows_shifted_by_-1",), _shifted(-1)),
    "shifted to the previous row": (("rows_shifted_by_1",), _shifted(1)),
    "two rows swapped": (("rows",), _rows_swapped),
    "another world": (("world_turned", "gravity_along"), _other_world),
    "y up": (("gravity_along_-y", "world_turned"), _y_up),
    "ceiling": (("gravity_along_+z", "world_turned"), _ceiling),
}  # fmt: skip


def _drifting(truth: Recorded, rng: np.random.Generator) -> Recorded:
    drift = np.concatenate([0.5 * _turn(rng, 0, np.pi)[0], 0.01 * _turn(rng, 0, np.pi)[0]])
    return replace(truth, wrenches=truth.wrenches + np.linspace(0, 1, len(truth.R_WS))[:, None] * drift)


def _half_transposed(truth: Recorded, _: np.random.Generator) -> Recorded:
    moved = truth.R_WS.copy()
    moved[::2] = moved[::2].transpose(0, 2, 1)
    return replace(truth, R_WS=moved)


def _mirrored(truth: Recorded, _: np.random.Generator) -> Recorded:
    mirror = np.diag([1.0, 1.0, -1.0])
    return replace(truth, R_WS=mirror @ truth.R_WS @ mirror)


def _random(truth: Recorded, rng: np.random.Generator) -> Recorded:
    size = truth.wrenches.std(axis=0)
    return replace(truth, wrenches=rng.standard_normal(truth.wrenches.shape) * size)


def _two(first: str, second: str) -> Callable[[Recorded, np.random.Generator], Recorded]:
    def mistaken(truth: Recorded, rng: np.random.Generator) -> Recorded:
        return replace(KNOWN[second][1](KNOWN[first][1](truth, rng), rng), raw=None)

    return mistaken


def _cable(truth: Recorded, rng: np.random.Generator) -> Recorded:
    """Pull with a spring along the sensor's axes, as a cable that follows the wrist does."""
    pull = np.concatenate([rng.uniform(0.3, 1.0, 3), rng.uniform(0.01, 0.05, 3)])
    angle = np.linalg.norm(Rotation.from_matrix(truth.R_WS).as_rotvec(), axis=1, keepdims=True)
    return replace(truth, wrenches=truth.wrenches + angle * pull)


# Mistakes that the check does not know, and the readings that are part of the truth.
UNKNOWN: dict[str, Mistake] = {
    "drift of 0.5 N": (("drift", "settling"), _drifting),
    "half of the rows transposed": ((), _half_transposed),
    "mirrored": (("yaw_180", "mount"), _mirrored),
    "random readings": ((), _random),
    "a cable": (("crosstalk", "cable"), _cable),
    "transposed and yawed": (("transposed", "yaw_90", "mount"), _two("transposed", "yaw 90")),
    "kgf and transposed": (("force_kgf", "transposed"), _two("kgf", "transposed")),
    "swapped and shifted": (
        ("fx_fy_swapped", "rows_shifted_by_1"),
        _two("fx, fy swapped", "shifted to the previous row"),
    ),
    "turned twice": (("mount",), _two("mount, any turn", "yaw, any angle")),
}  # fmt: skip


@dataclass(frozen=True)
class Count:
    """What came of the sets of one mistake."""

    sets: int
    first: int  # The true cause was the most probable, or named as one that is as good
    wrong: int  # Another one was said with odds above 3 to 1
    consistent: int
    instead: Counter[str]  # Keys that came first instead


def draw(rng: np.random.Generator) -> tuple[Recorded, GravityModel, PoseNoise]:
    """Draw poses as they should have been recorded, the load and the noise."""
    noise = PoseNoise(rng.uniform(*_FORCE), rng.uniform(*_TORQUE))
    load, count = draw_load(rng, _MASS), int(rng.integers(_POSES[0], _POSES[1] + 1))
    R_WS = Rotation.random(count, rng)
    read = weigh(load, R_WS.as_matrix(), noise, rng).poses
    shaken = R_WS * Rotation.from_rotvec(_ORIENTATION * rng.standard_normal((count, 3)))
    wrenches = np.array([np.concatenate([pose.force, pose.torque]) for pose in read])
    return Recorded(shaken.as_matrix(), wrenches), load, noise


def judge(mistake: Mistake, rng: np.random.Generator, sets: int, *, given: bool = True) -> Count:
    """Diagnose random sets with one mistake."""
    keys, make = mistake
    first = wrong = consistent = 0
    instead: Counter[str] = Counter()
    for _ in range(sets):
        truth, load, noise = draw(rng)
        found = _diagnosed(make(truth, rng), load if given else None, noise if given else None)
        named = [found.best.hypothesis, *found.tied]
        right = any(_tells(key, keys) for key in named)
        first += right
        if not right:
            instead[NONE if found.none_known else found.best.hypothesis] += 1
        wrong += any(
            share > _SURE
            for key, share in found.odds.items()
            if key not in {NONE, AS_DECLARED} and not _tells(key, keys)
        )
        consistent += found.consistent
    return Count(sets, first, wrong, consistent, instead)


def _tells(key: str, keys: tuple[str, ...]) -> bool:
    return any(
        key == each or (each in {"rezero", "rows", "gravity_along", "channel"} and key.startswith(f"{each}_"))
        for each in keys
    )


def _diagnosed(made: Recorded, load: GravityModel | None, noise: PoseNoise | None) -> Diagnosis:
    poses = [
        PoseSample(R_WS, wrench[:3], wrench[3:])
        for R_WS, wrench in zip(made.R_WS, made.wrenches, strict=True)
    ]
    prior = Prior(mass=None if load is None else load.mass)
    return diagnose(poses, noise, prior=prior, raw=made.raw)


def run(*, trials: int = 200, seed: int = 0, progress: Callable[[str], None] = lambda _: None) -> StudyReport:
    """Diagnose random sets with each mistake, and clean ones."""
    if trials < 1 or seed < 0:
        raise InputError(f"{trials} trials, seed {seed}: give at least 1 trial and a seed of at least 0")
    figures: list[Figure] = []
    notes: list[str] = []
    clean: Mistake = ((AS_DECLARED,), lambda truth, _: truth)
    for number, (name, mistake) in enumerate({"no mistake": clean, **KNOWN, **UNKNOWN}.items()):
        progress(name)
        count = judge(mistake, np.random.default_rng([seed, number]), trials)
        blind = judge(mistake, np.random.default_rng([seed, number]), -(-trials // 10), given=False)
        figures += _figures(name, count, blind)
        if count.instead:
            notes.append(f"{name}: first instead: {dict(count.instead.most_common(3))}.")
    return StudyReport("Mistakes", {"trials": trials, "seed": seed}, tuple(figures), tuple(notes))


def _figures(name: str, count: Count, blind: Count) -> list[Figure]:
    """Return what came of one mistake: with mass and noise, and without (`blind`)."""
    if name == "no mistake":
        return [
            Figure.share(name, "consistent", count.consistent, count.sets, least=98),
            Figure.share(name, "a wrong cause above 3 to 1", count.wrong, count.sets),
        ]
    return [
        Figure.share(name, "the cause first", count.first, count.sets, least=95 if name in KNOWN else None),
        Figure.share(name, "a wrong cause above 3 to 1", count.wrong, count.sets, most=0),
        Figure.share(name, "consistent", count.consistent, count.sets, most=0),
        Figure.share(name, "consistent, without mass and noise", blind.consistent, blind.sets, most=0),
    ]
