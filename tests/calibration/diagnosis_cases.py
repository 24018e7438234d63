"""Poses with known mistakes in them, and what to expect of a diagnosis."""

from dataclasses import replace
from itertools import permutations
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, PoseNoise, PoseSample
from contactbench.pipeline.calibration.diagnosis.diagnose import Diagnosis, diagnose
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations
from contactbench.pipeline.calibration.orientation import Convention, Kind, rotations
from contactbench.pipeline.simulation.loads import weigh

NOISE = PoseNoise(0.05, 0.002)
LOAD = GravityModel([0.1, -0.1, -7.0], [5.0, -3.0, 2.0], [0.004, -0.003, 0.07], [0.1, 0.2, 0.3])
FIXED = ["".join(axes) for axes in permutations("xyz")]
XYZ = Convention(Kind.EULER, "xyz")
STRAIGHT = np.eye(3)
KGF = 9.80665
FACTORS = {
    "torque_Nmm": (1, 1e-3),
    "torque_1000_too_small": (1, 1e3),
    "force_kgf": (KGF, 1),
    "force_kgf_torque_Nmm": (KGF, 1e-3),
    "force_kgf_torque_kgfm": (KGF, KGF),
    "wrench_negated": (-1, -1),
    "torque_negated": (1, -1),
    "force_negated": (-1, 1),
}


def turned(count: int = 9, seed: int = 0) -> np.ndarray:
    return Rotation.random(count, np.random.default_rng([seed, 41])).as_matrix()


def held(
    R_WS: np.ndarray, load: GravityModel = LOAD, noise: PoseNoise = NOISE, seed: int = 0
) -> list[PoseSample]:
    return list(weigh(load, R_WS, noise, np.random.default_rng([seed, 42])).poses)


def scaled(poses: list[PoseSample], force: Any, torque: Any) -> list[PoseSample]:
    return [replace(pose, force=pose.force * force, torque=pose.torque * torque) for pose in poses]


def oriented(poses: list[PoseSample], R_WS: Any) -> list[PoseSample]:
    return [replace(pose, R_WS=R) for pose, R in zip(poses, R_WS, strict=True)]


def transposed(poses: list[PoseSample]) -> list[PoseSample]:
    return oriented(poses, [pose.R_WS.T for pose in poses])


def pushed(poses: list[PoseSample], *which: int, force: Any = (1, -2, 0.5)) -> list[PoseSample]:
    torque = np.cross([0, 0, 0.1], force)
    return [
        replace(pose, force=pose.force + force, torque=pose.torque + torque) if index in which else pose
        for index, pose in enumerate(poses)
    ]


def written(R: np.ndarray, convention: Convention) -> np.ndarray:
    """The numbers that mean R."""
    turn = Rotation.from_matrix(R.transpose(0, 2, 1) if convention.inverse else R)
    if convention.kind is Kind.QUATERNION:
        return turn.as_quat()[:, [3, 0, 1, 2]]
    numbers = turn.as_euler(convention.order) if convention.kind is Kind.EULER else turn.as_rotvec()
    return np.degrees(numbers) if convention.degrees else numbers


def misread(
    truth: list[PoseSample], meant: Convention, read: Convention, R_ES: Any = STRAIGHT
) -> tuple[list[PoseSample], RawOrientations]:
    """Poses whose numbers are written as `meant`, but were read as `read`."""
    numbers = written(np.array([pose.R_WS for pose in truth]) @ R_ES.T, meant)
    return oriented(truth, rotations(numbers, read) @ R_ES), RawOrientations(numbers, read)


def assert_same(poses: Any, truth: list[PoseSample], tolerance: float = 1e-9) -> None:
    for pose, true in zip(poses, truth, strict=True):
        np.testing.assert_allclose(pose.R_WS, true.R_WS, atol=tolerance)
        np.testing.assert_allclose(pose.force, true.force, atol=tolerance)
        np.testing.assert_allclose(pose.torque, true.torque, atol=tolerance)


# No data tell a reversed sign from a frame that is not where it is assumed to be, or from a payload that is already
# taken off: all are said.
TWINS = {"wrench_negated": ("payload_subtracted", "gravity_along_+z"), "torque_negated": ("tool_behind",)}


def assert_named(found: Diagnosis, key: str, truth: list[PoseSample], tolerance: float = 1e-9) -> None:
    """The mistake is found, alone but for its twin, and mending it gives the truth back."""
    assert {found.best.hypothesis, *found.tied} == {key, *TWINS.get(key, ())}
    assert found.odds[key] > (0.3 if key in TWINS else 0.7)
    assert found.explained
    assert not found.consistent
    assert found.best.margin > 2
    assert found.best.left_out == ()
    mended = found.corrected(key)
    assert_same(mended, truth, tolerance)
    assert diagnose(mended, NOISE).consistent


def angles(turn: Rotation, way: str) -> np.ndarray:
    """Angles about x, y and z, in this order of columns, or a rotation vector."""
    if way == "vector":
        return turn.as_rotvec()
    numbers = np.empty((len(turn), 3))
    numbers[:, ["xyz".index(axis) for axis in way]] = turn.as_euler(way)
    return numbers


def meaning(numbers: np.ndarray, way: str) -> np.ndarray:
    if way == "vector":
        return Rotation.from_rotvec(numbers).as_matrix()
    x, y, z = (Rotation.from_euler(axis, numbers[:, [index]]) for index, axis in enumerate("xyz"))
    first, second, third = ({"x": x, "y": y, "z": z}[axis] for axis in way)
    return (third * second * first).as_matrix()
