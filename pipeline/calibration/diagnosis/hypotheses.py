"""Conventions that people get wrong: what each would make of the same recorded poses."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED, Hypothesis
from contactbench.pipeline.calibration.diagnosis.prior import Prior, angle_between
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations, Rereadings
from contactbench.pipeline.calibration.diagnosis.side_by_side import Evidence
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.calibration.poses import Stack
from contactbench.pipeline.errors import arg, join, message


def hypotheses(
    poses: Stack, raw: RawOrientations | None, prior: Prior | None = None
) -> tuple[tuple[Hypothesis, ...], tuple[str, ...]]:
    """Return every way to read poses, as declared first, and in sentences what these data do not test.

    Mistakes come in families; each family is as probable as any other beforehand, so that many variants of one
    mistake do not add up.

    Parameters
    ----------
    poses : Stack
        As declared.
    raw : RawOrientations or None
        The numbers behind the orientations.
    prior : Prior, optional
        What is known of the load.

    Raises
    ------
    InputError
        `raw` are not the numbers behind the poses.
    """
    R_WS = poses.R_SW.transpose(0, 2, 1)
    rereadings = Rereadings(R_WS, raw)
    found = [
        Hypothesis(
            AS_DECLARED,
            message("as declared"),
            message("The data are as declared"),
            message("the unchanged data"),
            "",
            R_WS,
        )
    ]
    for family in (
        rereadings,
        units(R_WS),
        signs(R_WS),
        swaps(R_WS),
        mounts(R_WS),
        directions(R_WS, prior or Prior()),
        orders(R_WS, poses),
        axes(R_WS),
    ):
        members = list(family)
        total = sum(member.share / member.variants for member in members)
        found += [replace(member, share=member.share / total) for member in members]
    return tuple(found), tuple(rereadings.not_testable)


_KGF, _LBF, _SMALL = STANDARD_GRAVITY, 0.45359237 * STANDARD_GRAVITY, "1000_too_small"
_UNITS = {
    "": 1.0, "kgf": _KGF, "kN": 1e3, "lbf": _LBF, "N·mm": 1e-3, "N·cm": 1e-2, _SMALL: 1e3,
    "lbf·in": 0.0254 * _LBF, "lbf·ft": 0.3048 * _LBF, "kgf·cm": _KGF / 100, "kgf·m": _KGF,
}  # fmt: skip
_NAMES = ("fx", "fy", "fz", "mx", "my", "mz")
_OFTEN, _MOSTLY = 5.0, 20.0  # as often as the rarest variants


def units(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield other units of the readings.

    Parameters
    ----------
    R_WS : (n, 3, 3)
        Orientations as declared.
    """
    for F, M, share in (
        ("", "N·mm", _OFTEN), ("", "N·cm", 1.0), ("", _SMALL, 1.0), ("", "lbf·in", 1.0), ("", "kgf·cm", 0.5),
        ("kgf", "", 1.0), ("kgf", "N·mm", 1.0), ("kgf", "N·cm", 0.5), ("kgf", "kgf·cm", 1.0), ("kgf", "kgf·m", 1.0),
        ("kN", "", 0.5), ("lbf", "", 1.0), ("lbf", "lbf·in", 2.0), ("lbf", "lbf·ft", 2.0),
    ):  # fmt: skip
        force, torque = _UNITS[F], _UNITS[M]
        key = "_".join(
            f"{name}_{unit.replace('·', '')}" for name, unit in (("force", F), ("torque", M)) if unit
        )
        if M == _SMALL:
            title = message("torques 1000 times too small")
            fact = message(
                "Torques are 1000 times too small, as if N·m had been taken for N·mm and divided once too often"
            )
        elif F and M:
            title = message(f"forces in {arg(F)} with torques in {arg(M)}")
            fact = message(f"Forces are in {arg(F)} and torques in {arg(M)}")
        else:
            title = message(f"forces in {arg(F)}") if F else message(f"torques in {arg(M)}")
            fact = message(f"Forces are in {arg(F)}") if F else message(f"Torques are in {arg(M)}")
        halves = (message("forces"), force), (message("torques"), torque)
        scaled = (message(f"{arg(name)} by {arg(value):.6g}") for name, value in halves if value != 1)
        what = join(message(" and "), scaled)
        yield Hypothesis(
            key,
            title,
            fact,
            message("the units corrected"),
            message(f"Multiply {arg(what)}."),
            R_WS,
            np.repeat([force, torque], 3).astype(np.float64),
            share=share,
        )


def signs(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield readings with reversed signs: of all channels, of forces or torques, of an axis, of one channel."""
    every = np.arange(6)
    for key, what, wrong, why, share in (
        ("wrench_negated", message("forces and torques"), every < 6,
         message(", as with a sensor that reports the reaction"), _MOSTLY),
        ("torque_negated", message("torques"), every >= 3, "", _MOSTLY),
        ("force_negated", message("forces"), every < 3, "", _OFTEN),
    ):  # fmt: skip
        yield Hypothesis(
            key,
            message(f"{arg(what)} with the wrong sign"),
            message(f"The {arg(what)} have the wrong sign{arg(why)}"),
            message(f"{arg(what)} negated"),
            _reversed(what),
            R_WS,
            np.where(wrong, -1.0, 1.0),
            share=share,
        )
    for axis, name in enumerate("xyz"):
        yield Hypothesis(
            f"axis_{name}_reversed",
            message(f"{arg(name)} axis reversed"),
            message(f"The sensor's {arg(name)} axis is reversed"),
            message(f"f{arg(name)} and m{arg(name)} negated"),
            _reversed(message(f"f{arg(name)} and m{arg(name)}")),
            R_WS,
            np.where(every % 3 == axis, -1.0, 1.0),
        )
    for channel, name in enumerate(_NAMES):
        yield Hypothesis(
            f"{name}_negated",
            message(f"{arg(name)} with the wrong sign"),
            message(f"The channel {arg(name)} has the wrong sign"),
            message(f"{arg(name)} negated"),
            _reversed(name),
            R_WS,
            np.where(every == channel, -1.0, 1.0),
        )


def _reversed(what: str) -> str:
    return message(f"Multiply {arg(what)} by -1, or set the sign in the driver.")


def swaps(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield readings whose channels are in another order."""
    for a, b in ((0, 1), (1, 2), (0, 2)):
        for pairs in (((a, b), (a + 3, b + 3)), ((a, b),), ((a + 3, b + 3),)):
            channels = np.arange(6)
            for one, other in pairs:
                channels[[one, other]] = other, one
            words = [message(f"{arg(_NAMES[one])} with {arg(_NAMES[other])}") for one, other in pairs]
            key = "_".join(f"{_NAMES[one]}_{_NAMES[other]}" for one, other in pairs) + "_swapped"
            yield _swapped(R_WS, key, join(message(" and "), words), channels)
    yield _swapped(R_WS, "force_torque_swapped", message("forces with torques"), np.roll(np.arange(6), 3))


def _swapped(R_WS: NDArray[np.float64], key: str, what: str, channels: NDArray[np.intp]) -> Hypothesis:
    return Hypothesis(
        key,
        message(f"{arg(what)} swapped"),
        message(f"Channels are swapped: {arg(what)}"),
        message("the channels swapped back"),
        message(f"Swap {arg(what)} in the column names or in the driver."),
        R_WS,
        channels=channels,
    )


WORLD, TOOL_BEHIND, YAW = "world_turned", "tool_behind", "yaw_"
SUBTRACTED = "payload_subtracted"
_YAWS = (90, 180, 270)
_SIDEWAYS = 3.0  # standard deviations of an axis that is not z
_APART = np.radians(30)  # gravity along an axis this far from down is another hypothesis


def mounts(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield sensors that are turned on the flange by right angles."""
    for angle in _YAWS:
        turn = Rotation.from_euler("z", angle, degrees=True).as_matrix()
        yield Hypothesis(f"{YAW}{angle}", *_about_z(angle), R_WS @ turn)


def directions(R_WS: NDArray[np.float64], prior: Prior) -> Iterator[Hypothesis]:
    """Yield other directions of gravity in the world, and of the tool from the sensor: the data stay as they are."""
    down = np.array(prior.down_W)
    for axis in np.concatenate([np.eye(3), -np.eye(3)]):
        if angle_between(axis, down) > _APART:
            name = f"{'-' if axis.sum() < 0 else '+'}{'xyz'[int(np.argmax(np.abs(axis)))]}"
            often = 8.0 if axis @ down < -0.9 else 1.0  # a ceiling is more common than a wall
            there = replace(prior, down_W=tuple(axis))
            yield Hypothesis(f"gravity_along_{name}", *_gravity(axis, name), R_WS, share=often, prior=there)
    yield Hypothesis(
        SUBTRACTED,
        message("a payload that the controller subtracts already"),
        message("The controller already subtracts a payload that is heavier than the tool"),
        message("a payload that is taken off"),
        message("Set the payload in the controller to 0, and zero no tool, then retake the poses."),
        R_WS,
        share=25.0,
        prior=replace(prior, down_W=tuple(-down)),
    )
    yield Hypothesis(WORLD, "", "", "", "", R_WS, share=4.0, prior=prior)
    behind = replace(prior, tool_axis_S=tuple(-np.array(prior.tool_axis_S)))
    yield Hypothesis(
        TOOL_BEHIND,
        message("tool on the other side of the sensor"),
        message("The sensor's z axis points away from the tool"),
        message("the tool on the other side of the sensor"),
        message("If the sensor is mounted that way, the data are correct as they are."),
        R_WS,
        share=8.0,
        prior=behind,
    )


def settled(hypothesis: Hypothesis, evidence: Evidence, prior: Prior) -> Hypothesis:
    """Return a hypothesis with the direction of gravity that was found, and its words."""
    if hypothesis.key != WORLD:
        return hypothesis
    g = evidence.gravity_W
    down = g / max(float(np.linalg.norm(g)), 1e-12)
    words = ", ".join(f"{value:.2f}" for value in down + 0.0)
    title, fact, reading, remedy = _gravity(down, message(f"({arg(words)})"))
    found = replace(prior, down_W=tuple(down)) if g.any() else prior
    return replace(hypothesis, title=title, fact=fact, reading=reading, remedy=remedy, prior=found)


def turned(turn: NDArray[np.float64], sigma: float) -> tuple[str, str, str, str]:
    """Return title, fact, reading and remedy of a sensor that is turned (3, 3); `sigma` (rad) about each axis."""
    vector = Rotation.from_matrix(turn).as_rotvec()
    if np.linalg.norm(vector[:2]) < _SIDEWAYS * sigma:
        return _about_z(float(np.degrees(vector[2])))
    axis = vector / max(float(np.linalg.norm(vector)), 1e-12)
    words = ", ".join(f"{value:.2f}" for value in axis + 0.0)
    angle = f"{np.degrees(np.linalg.norm(vector)):.1f}°"
    return (
        message(f"sensor turned by {arg(angle)} on the flange"),
        message(f"The sensor is turned by {arg(angle)} about its axis ({arg(words)}) on the flange"),
        message("that rotation"),
        message("Run calibrate --estimate-mount, or correct the sensor's mounting."),
    )


def right_angle(turn: NDArray[np.float64], sigma: float) -> bool:
    """Tell whether a turn (3, 3) that is known to `sigma`, rad, about each axis is one by right angles about z."""
    off = [Rotation.from_euler("z", angle, degrees=True).inv().as_matrix() @ turn for angle in _YAWS]
    return any(Rotation.from_matrix(each).magnitude() < _SIDEWAYS * np.sqrt(3) * sigma for each in off)


def _about_z(degrees: float) -> tuple[str, str, str, str]:
    """Return title, fact, reading and remedy of a sensor that is turned about its z axis."""
    angle = f"{180 - (180 - degrees) % 360:.4g}°"
    return (
        message(f"sensor turned by {arg(angle)} about z on the flange"),
        message(f"The sensor is turned by {arg(angle)} about its z axis on the flange"),
        message(f"the orientations turned by {arg(angle)} about the sensor's z axis"),
        message(f"Correct the sensor's mounting: R_WS becomes R_WS · Rz({arg(angle)})."),
    )


def _gravity(down_W: NDArray[np.float64], name: str) -> tuple[str, str, str, str]:
    """Return title, fact, reading and remedy of gravity in another direction."""
    option = ",".join(f"{value:.3g}" for value in down_W + 0.0)
    remedy = message(
        "If the robot hangs from a ceiling or a wall, or the orientations are those of another frame,"
        f" pass --down {arg(option)}."
    )
    return (
        message(f"gravity along {arg(name)} of the world"),
        message(f"Gravity points along {arg(name)} of the world frame"),
        message("gravity in that direction"),
        remedy,
    )


SHIFTED = "rows_shifted_by_"
_SWAPS = 3  # pairs that are worth a fit


def orders(R_WS: NDArray[np.float64], poses: Stack) -> Iterator[Hypothesis]:
    """Yield poses whose orientations belong to the next or previous row, or to each other's."""
    for step, whose in ((1, message("next")), (-1, message("previous"))):
        yield Hypothesis(
            f"{SHIFTED}{step}",
            message(f"orientations shifted by one row to the {arg(whose)}"),
            message(
                f"Orientations and readings are shifted by one row: each reading belongs to the {arg(whose)}"
                " row's orientation"
            ),
            message("the rows shifted back"),
            message("Shift the orientations by one row, and remove the row that is left without one."),
            np.roll(R_WS, -step, axis=0),
        )
    pairs, count = _likely_swaps(poses)
    for first, second in pairs:
        again = R_WS.copy()
        again[[first, second]] = R_WS[[second, first]]
        yield Hypothesis(
            f"rows_{first + 1}_and_{second + 1}_swapped",
            message(f"orientations of poses {arg(first + 1)} and {arg(second + 1)} swapped"),
            message(f"The orientations of poses {arg(first + 1)} and {arg(second + 1)} are swapped"),
            message("the channels swapped back"),
            message("Swap the two orientations, or retake the two poses."),
            again,
            variants=count,
        )


def _likely_swaps(poses: Stack) -> tuple[NDArray[np.intp], int]:
    """Return the pairs of poses (m, 2) whose swap explains the forces best, and how many pairs there are.

    What orientations add to the normal equations of gravity and force bias does not depend on their order; a
    swap changes but the right-hand side, by (R_j - R_i)^T (F_i - F_j).
    """
    R, F, n = poses.R_SW, poses.F, len(poses)
    i, j = np.triu_indices(n, 1)
    mean = R.mean(axis=0)
    normal = n * (np.eye(3) - mean.T @ mean) + 1e-9 * np.eye(3)
    right = np.einsum("nab,na->b", R - mean, F) + np.einsum("pab,pa->pb", R[j] - R[i], F[i] - F[j])
    explained = np.einsum("pa,pa->p", right, np.linalg.solve(normal, right.T).T)
    best = np.argsort(-explained)[:_SWAPS]
    return np.stack([i[best], j[best]], axis=1), len(i)


def axes(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    """Yield readings along the axes of the robot's base instead of the sensor's: both halves, or the forces alone."""
    for key, what, in_world, share in (
        ("wrench_in_base", message("forces and torques"), (True, True), 3.0),
        ("force_in_base", message("forces"), (True, False), 1.0),
    ):
        yield Hypothesis(
            key,
            message(f"{arg(what)} along the base's axes"),
            message(f"The {arg(what)} are along the axes of the robot's base, not of the sensor"),
            message(f"the {arg(what)} turned into the sensor"),
            message("Record the wrench in the sensor's frame, or turn it by the transpose of R_WS."),
            R_WS,
            in_world=in_world,
            share=share,
        )
