"""What the poses can tell apart, and in words what they cannot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.model import BLIND, cross_matrix
from contactbench.pipeline.errors import arg, message

# An axis this near to the vertical, as a cosine, is called vertical: 10 degrees.
_UPRIGHT = 0.985
# Condition beyond which poses are said to be too much alike; the faces of a cube have 2.2 and 1.2.
WEAK = 10.0
# Poses that differ by less than this are one pose, and by less than that are too much alike, degrees.
_SAME_TILT, _CLOSE = 0.2, 30.0
_HARDLY = 0.1  # as a singular value: poses about six degrees from being blind
_DOWN_W = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class Observability:
    """What a set of poses shows."""

    rank: int  # Of the twelve parameters, how many combinations the poses determine
    # Of the six of (gravity, force bias), and of the six of (centre of mass, torque bias)
    force_rank: int
    torque_rank: int
    # Ratio of the best to the worst determined combination, for a load of 1 N; infinite below full rank
    force_condition: float
    torque_condition: float
    null_directions: tuple[str, ...]  # What cannot be told apart, why, and which poses would show it
    weighs: bool  # Whether the weight of the load is felt
    weak: str  # The same for what is only badly determined; empty when all is well

    @property
    def condition(self) -> float:
        """The worse of the two conditions."""
        return max(self.force_condition, self.torque_condition)


def observe_weightless(R_SW: NDArray[np.float64], down_W: NDArray[np.float64] = _DOWN_W) -> Observability:
    """Tell what poses at orientations R_SW (n, 3, 3) determine of a load whose weight is lost in the noise.

    Poses that differ a little, as a hand's do, are not exactly blind. If they are hardly better, they hide
    the weight; if they are good, there is none.
    """
    hidden = observe(R_SW, down_W, blind=_HARDLY)
    return hidden if hidden.null_directions or hidden.weak else observe(R_SW, down_W, weighs=False)


def observe(
    R_SW: NDArray[np.float64], gravity_W: NDArray[np.float64], *, weighs: bool = True, blind: float = BLIND
) -> Observability:
    """Tell what poses at orientations R_SW (n, 3, 3) determine.

    Parameters
    ----------
    R_SW : (n, 3, 3)
    gravity_W : (3,)
        Only its direction counts: the noise of its estimate must not pass for a tilt.
    weighs : bool
        Whether the load's weight is felt at all; without it no pose shows the centre of mass.
    blind : float
        Singular values below this, per pose and for a load of 1 N, count as zero.
    """
    size = float(np.linalg.norm(gravity_W))
    down_W = gravity_W / size if size else _DOWN_W
    down_S = R_SW @ down_W
    force_rank, force_condition, alike_W = _forces(R_SW, blind)
    torque_rank, torque_condition = _torques(down_S, blind) if weighs else (3, np.inf)
    words, weak = [], ""
    if max(force_condition, torque_condition) > WEAK and weighs:
        weak = _close_words(R_SW)
    if not weak and force_rank < 6:
        words.append(_force_words(alike_W))
    if not weighs:
        light = message(
            "The sensor feels no weight, so no pose shows the centre of mass. If a tool is"
            " mounted, check the unit of the forces and that the sensor does not re-zero itself."
        )
        words.append(light)
    elif not weak and torque_rank < 6:
        words.append(_torque_words(down_S))
    if weak and force_rank + torque_rank < 12:
        words, weak = [weak], ""
    return Observability(
        force_rank + torque_rank,
        force_rank,
        torque_rank,
        force_condition,
        torque_condition,
        tuple(words),
        weighs,
        weak,
    )


def _forces(R_SW: NDArray[np.float64], blind: float) -> tuple[int, float, NDArray[np.float64]]:
    """Return rank and condition of the equations R_i g + F0, and what they cannot tell from bias (k, 3), W.

    Their normal matrix, per pose, is [[1, R'], [R, 1]] with R the mean of the rotations: its eigenvalues are
    1 plus and minus the singular values of R. A direction that every pose turns alike has singular value 1.
    """
    _, values, vectors = np.linalg.svd(R_SW.mean(axis=0))
    alike = 1 - values < blind**2
    if alike.any():
        return 6 - int(alike.sum()), np.inf, vectors[alike]
    return 6, float(np.sqrt((1 + values[0]) / (1 - values[0]))), vectors[:0]


def _torques(down_S: NDArray[np.float64], blind: float) -> tuple[int, float]:
    """Return rank and condition of the equations L x down_i + M0, for a load of 1 N."""
    normal, mean = np.eye(6), cross_matrix(down_S.mean(axis=0))
    normal[:3, :3] -= down_S.T @ down_S / len(down_S)
    normal[:3, 3:], normal[3:, :3] = mean, -mean
    squares = np.linalg.eigvalsh(normal)  # of the singular values, per pose
    rank = int((squares >= blind**2).sum())
    return rank, float(np.sqrt(squares.max() / squares.min())) if rank == len(squares) else np.inf


def _force_words(alike_W: NDArray[np.float64]) -> str:
    """Say which part of gravity (k, 3), W, looks the same as bias in every pose."""
    if len(alike_W) > 1:
        return message(
            "Every pose has the same orientation, so bias and weight cannot be separated. Turn"
            " the wrist between poses, about two axes, by 60° or more."
        )
    axis = alike_W[0]
    if abs(axis[2]) > _UPRIGHT:
        return message(
            "Every pose has the same tilt (they differ only by a turn about the vertical), so"
            " gravity always has the same direction in the sensor, and weight and bias cannot be"
            " separated. Turn the wrist about a horizontal axis."
        )
    if abs(axis[2]) < 1 - _UPRIGHT:
        bearing = np.degrees(np.arctan2(axis[1], axis[0])) % 180
        return message(
            f"All poses turn about one horizontal axis (bearing {arg(bearing):.0f}° from the world's"
            " x), so a tilt of the base along that axis and the bias along it cannot be"
            " separated. Tilt the wrist about another axis too."
        )
    return message(
        f"All poses turn about one axis ({arg(axis[0]):.2f}, {arg(axis[1]):.2f}, {arg(axis[2]):.2f} in the"
        " world), so gravity and bias along it cannot be separated. Tilt the wrist about another"
        " axis too."
    )


def _torque_words(down_S: NDArray[np.float64]) -> str:
    """Say what the directions of gravity in the sensor (n, 3) do not show of the centre of mass."""
    if np.abs(down_S - down_S.mean(axis=0)).max() < 2 * BLIND:
        return message(
            "Gravity has the same direction in the sensor in every pose, so the centre of mass"
            " and the torque bias cannot be separated. Tilt the wrist about a horizontal axis."
        )
    return message(
        "Gravity has only two directions in the sensor, so the centre of mass along the line"
        " between them and the torque bias cannot be separated. Add a pose with a third tilt."
    )


def _close_words(R_SW: NDArray[np.float64]) -> str:
    """Say that poses are too much alike, if that is what is wrong with them; else nothing."""
    spread = _spread(R_SW)
    if not _SAME_TILT < spread < _CLOSE:
        return ""
    return message(
        f"All poses lie within about {arg(np.ceil(spread)):.0f}° of one another, so bias and weight are"
        " poorly separated. Tilt the wrist further, up to 90° and beyond, about two axes."
    )


def _spread(R_SW: NDArray[np.float64]) -> float:
    """Return the largest angle between two of the poses, degrees."""
    rows = R_SW.reshape(-1, 9)
    return float(np.degrees(np.arccos(np.clip(((rows @ rows.T).min() - 1) / 2, -1, 1))))
