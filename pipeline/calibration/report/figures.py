"""
The pictures of a calibration report, see `contactbench.pipeline.page.figures`.

They carry numbers of poses, never names: nothing from a file gets in here. Importing this module imports Matplotlib,
which takes a while: import it when a report is made.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactbench.pipeline.calibration.calibrate import Calibration
from contactbench.pipeline.calibration.model import prediction_jacobian
from contactbench.pipeline.calibration.model import upright as turn_upright
from contactbench.pipeline.calibration.nuisance import REZERO, taken_off
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.suggest import (
    contact_sensitivity,
    force_directions,
    largest_eigenvalue,
)
from contactbench.pipeline.calibration.verdict import FEWEST, Limits, limit
from contactbench.pipeline.page.figures import FAINT, GRID, INK, PAPER, WIDTH, page_style, to_svg
from contactbench.pipeline.page.palette import BLUE, VERMILION

EMPTY = 45.0  # degrees: an area further than this from every pose is shown as empty
STEEPEST = 75.0  # degrees between force and normal, on the map of contact errors

_TURN = np.linspace(0, 2 * np.pi, 73)
_ROOMY = 20  # poses that can have all their numbers
CROWDED = 60  # poses: with more, only those that were left out have a number
_DISPLAYED = np.repeat([1.0, 1e3], 3)  # N and N·m as the pictures have them: N and mN·m
_SIGNS = ((1, "+"), (-1, "\N{MINUS SIGN}"))


@dataclass(frozen=True)
class CalibrationFigures:
    """Pictures as SVG elements."""

    signed: str  # What each channel read beside bias and weight, over time
    residuals: str  # How far each pose is from the others
    # Where gravity pulled in the sensor, and the probe pointed in the world
    gravity: str
    probe: str
    contact: str  # The predicted error over force directions; empty when it was not asked for


def draw(calibration: Calibration, sigmas: NDArray[np.float64] | None, noise: str) -> CalibrationFigures:
    """Draw all pictures of a report; the same calibration gives the same text.

    Parameters
    ----------
    sigmas : (6,) or None
        Noise to add to the calibration's share on the map, N and N·m; None: no map.
    noise : str
        What noise that is, for the map's title.
    """
    R_WS, kept = upright(calibration), calibration.kept
    halves = ("sensor's +z half", "sensor's \N{MINUS SIGN}z half")
    ways = ("upper half: probe points up", "lower half: probe points down")
    with page_style():
        gravity = _coverage(-R_WS[:, 2], kept, halves)
        probe = _coverage(R_WS @ calibration.task.normal, kept, ways, lower_first=True)
        contact = None if sigmas is None else _contact(calibration, sigmas, noise)
        return CalibrationFigures(
            to_svg(_signed(calibration), "s", "Signed residuals of every channel over time"),
            to_svg(_residuals(calibration), "r", "Deviates of force and torque of every pose"),
            to_svg(gravity, "g", "Direction of gravity in the sensor frame in every pose"),
            to_svg(probe, "p", "Direction of the probe in the world in every pose"),
            "" if contact is None else to_svg(contact, "c", "Predicted contact error by force direction"),
        )


def upright(calibration: Calibration) -> NDArray[np.float64]:
    """Return the orientations (n, 3, 3) of the poses in a world that is turned until gravity points along -z."""
    turned: NDArray[np.float64] = turn_upright(calibration.down_W) @ np.array(
        [pose.R_WS for pose in calibration.poses]
    )
    return turned


# ---- residuals ---------------------------------------------------------------------------------

_CHANNELS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")


def in_time(calibration: Calibration) -> tuple[NDArray[np.float64], str]:
    """Return when each pose was taken (n,), and in what unit: minutes from the first one, or its number."""
    times = [pose.time for pose in calibration.poses]
    known = np.array([time for time in times if time is not None])
    if len(known) == len(times) and np.ptp(known) > 0:
        return (known - known.min()) / 60, "minutes from the first pose"
    return np.arange(1.0, len(times) + 1), "pose"


def _signed(calibration: Calibration) -> Figure:
    """Plot what each channel read beside bias and weight, with the drift or the jumps that were found as a line."""
    when, unit = in_time(calibration)
    R_SW = np.array([pose.R_WS.T for pose in calibration.poses])
    V = calibration.noise.covariances(R_SW, calibration.model.vector)
    band = np.sqrt(np.diagonal(V.mean(axis=0))) * _DISPLAYED
    lines = calibration.offsets * _DISPLAYED
    points = lines + calibration.residuals * _DISPLAYED
    figure = Figure(figsize=(WIDTH, 3.5))
    figure.subplots_adjust(left=0.105, right=0.99, bottom=0.125, top=0.93, hspace=0.26, wspace=0.08)
    rows = figure.subplots(2, 3, sharex=True, sharey="row")
    for part, row, unit_of in ((slice(3), rows[0], "N"), (slice(3, 6), rows[1], "mN·m")):
        top = 1.15 * max(float(np.abs(points[calibration.kept, part]).max()), 2 * float(band[part].max()))
        row[0].set(ylim=(-top, top), ylabel=unit_of)
    for channel, axes in enumerate(rows.flat):
        _band(axes, calibration, when, lines[:, channel], float(band[channel]))
        _points(axes, calibration.kept, when, points[:, channel], torque=channel >= 3)
        axes.set_title(_CHANNELS[channel], fontsize=9, pad=3)
        axes.grid(axis="y")
    rows[1][1].set_xlabel(unit)
    figure.align_ylabels(rows[:, 0])
    return figure


def _band(
    axes: Axes, calibration: Calibration, when: NDArray[np.float64], line: NDArray[np.float64], half: float
) -> None:
    """Draw where one channel's poses should lie: a line, and the noise on both sides of it."""
    order = np.argsort(when, kind="stable")
    x, y = when[order], line[order]
    jumps = taken_off(calibration.offsets) == REZERO
    axes.fill_between(
        x, y - half, y + half, step="mid" if jumps else None, color=GRID, alpha=0.55, linewidth=0
    )
    axes.plot(x, y, color=INK, linewidth=1, drawstyle="steps-mid" if jumps else "default")


def _points(
    axes: Axes, kept: NDArray[np.bool_], when: NDArray[np.float64], y: NDArray[np.float64], *, torque: bool
) -> None:
    """Draw one channel's poses, hollow if left out; what lies off the plot is a triangle at its edge."""
    colour, shape = (VERMILION, "D") if torque else (BLUE, "o")
    style: dict[str, Any] = {"color": colour, "linestyle": "none", "clip_on": False, "zorder": 3}
    top = axes.get_ylim()[1]
    for used, fill in ((kept, colour), (~kept, PAPER)):
        shown = used & (np.abs(y) <= top)
        axes.plot(when[shown], y[shown], marker=shape, mfc=fill, markersize=3.6, **style)
    for beyond, edge, mark in ((y > top, 0.94 * top, "^"), (y < -top, -0.94 * top, "v")):
        axes.plot(when[beyond], np.full(beyond.sum(), edge), marker=mark, mfc=PAPER, markersize=5, **style)


def _residuals(calibration: Calibration) -> Figure:
    """Plot deviates by pose; what lies beyond the plot stands at its upper edge, with its number."""
    far, kept = calibration.deviates, calibration.kept
    n, allowed = len(far), limit(len(far))
    top = min(max(1.3 * allowed, 1.1 * float(far.max())), 2 * allowed)
    figure = Figure(figsize=(WIDTH, 2.6))
    axes = figure.add_axes((0.06, 0.16, 0.92, 0.58 if (far > top).any() else 0.71))
    number = np.arange(1.0, n + 1)
    halves = (0, "force", BLUE, "o", 5.5), (1, "torque", VERMILION, "D", 4.8)
    for column, name, colour, shape, size in halves:
        x, y = number + (0.16 if column else -0.16), far[:, column]
        style: dict[str, Any] = {"color": colour, "linestyle": "none", "clip_on": False, "zorder": 3}
        for used, fill, words in ((kept, colour, name), (~kept, PAPER, None)):
            shown = used & (y <= top)
            axes.plot(x[shown], y[shown], marker=shape, mfc=fill, markersize=size, label=words, **style)
        beyond = y > top
        axes.plot(x[beyond], 0.96 * np.full(beyond.sum(), top), marker="^", mfc=PAPER, markersize=6, **style)
        if n > _ROOMY:  # two numbers side by side would touch: the larger one stands for both
            x, beyond = number, beyond & (y == far.max(axis=1))
        for pose in np.flatnonzero(beyond) if n <= CROWDED else ():
            axes.text(x[pose], 1.03 * top, f"{y[pose]:.0f}", rotation=90, ha="center", va="bottom")
    if n >= FEWEST:  # fewer are not checked against one another
        axes.axhline(
            allowed, color=INK, linewidth=1, linestyle=(0, (5, 3)), label=f"limit {allowed:.1f} sigma"
        )
    for rank, pose in enumerate(number[~kept]):
        words = None if rank else "pose left out (hollow marks)"
        axes.axvspan(pose - 0.5, pose + 0.5, color=GRID, alpha=0.45, linewidth=0, label=words)
    axes.set(xlim=(0.4, n + 0.6), ylim=(0, top), ylabel="deviate (sigma)", xlabel="pose")
    every = 1 if n <= _ROOMY else 5 if n <= 100 else 20 * (n // 200 + 1)
    axes.set_xticks(sorted({1, *range(every, n + 1, every)}))
    axes.grid(axis="y")
    place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.045, 1.03), "ncols": 4}
    figure.legend(frameon=False, handletextpad=0.5, columnspacing=1.6, **place)
    return figure


# ---- coverage ----------------------------------------------------------------------------------

_TOUCHING = 0.06  # of a disc's radius: poses nearer than this share one label
_RADIUS = 105.0  # of a disc on paper, points


class _Box(NamedTuple):
    """A place on a disc that is taken: its middle, and half its sizes."""

    x: float
    y: float
    half_x: float
    half_y: float

    def overlap(self, other: _Box) -> float:
        wide = self.half_x + other.half_x - abs(self.x - other.x)
        high = self.half_y + other.half_y - abs(self.y - other.y)
        return max(wide, 0.0) * max(high, 0.0)


def _coverage(
    directions: NDArray[np.float64],
    kept: NDArray[np.bool_],
    titles: tuple[str, str],
    *,
    lower_first: bool = False,
) -> Figure:
    """Plot unit vectors (n, 3) on two discs of equal area; both are seen along -z, the lower one through the upper."""
    figure = Figure(figsize=(WIDTH, 3.5))
    at, upper = lambert(directions), directions[:, 2] >= 0
    letters = 8.0 if len(directions) <= _ROOMY else 6.5
    halves = [(upper, 1.0, titles[0]), (~upper, -1.0, titles[1])]
    for column, (here, sign, name) in enumerate(halves[::-1] if lower_first else halves):
        axes = figure.add_axes((0.5 * column, 0.0, 0.5, 0.93))
        figure.text(0.5 * column + 0.25, 0.955, name, ha="center")
        taken = _globe(axes, directions[kept], sign)
        for used, colour, shape in ((kept, BLUE, "o"), (~kept, VERMILION, "X")):
            axes.plot(
                *at[here & used].T, color=colour, marker=shape, markersize=6, linestyle="none", zorder=3
            )
        taken += [_Box(float(x), float(y), 0.03, 0.03) for x, y in at[here]]
        for used in (kept, ~kept) if len(at) <= CROWDED else (~kept,):
            for group in _groups(at, np.flatnonzero(here & used)):
                _label(axes, at[group].mean(axis=0), numbers(group), taken, letters)
    return figure


def lambert(directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit vectors (..., 3) on Lambert's equal-area disc of their own hemisphere (..., 2), radius 1."""
    flat: NDArray[np.float64] = directions[..., :2] / np.sqrt(1 + np.abs(directions[..., 2:]))
    return flat


def numbers(group: Sequence[int]) -> str:
    """Return the numbers, from 1, of poses by index; runs are shortened."""
    runs: list[list[int]] = []
    for pose in (index + 1 for index in sorted(group)):
        if runs and pose == runs[-1][-1] + 1:
            runs[-1].append(pose)
        else:
            runs.append([pose])
    short = ", ".join(f"{run[0]}–{run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)
    return short if len(short) <= 16 else f"{len(group)} poses"


def _globe(axes: Axes, kept: NDArray[np.float64], sign: float) -> list[_Box]:
    """Draw a disc, its net, the sides, and in grey what is far from every pose; return where letters stand."""
    axes.set(xlim=(-1.22, 1.22), ylim=(-1.16, 1.16), aspect="equal")
    axes.set_axis_off()
    away, around = np.meshgrid(np.radians(np.linspace(0, 90, 46)), _TURN, indexing="ij")
    ball = np.stack([np.sin(away) * np.cos(around), np.sin(away) * np.sin(around), sign * np.cos(away)], -1)
    distance = np.degrees(np.arccos(np.clip((ball @ kept.T).max(axis=2), -1, 1)))
    if distance.max() > EMPTY:
        x, y = np.moveaxis(lambert(ball), -1, 0)
        axes.contourf(x, y, distance, levels=[EMPTY, 181], colors=[GRID], alpha=0.55)
    rings = {angle: np.sqrt(2) * np.sin(np.radians(angle) / 2) for angle in (30, 60)}
    _rings(axes, [1.0], color=INK, linewidth=1.0)
    _rings(axes, list(rings.values()), color=FAINT, linewidth=0.4)
    axes.plot([-1, 1, np.nan, 0, 0], [0, 0, np.nan, -1, 1], color=FAINT, linewidth=0.4)
    for one, mark in _SIGNS:
        axes.text(1.1 * one, 0, f"{mark}x", ha="center", va="center")
        axes.text(0, 1.08 * one, f"{mark}y", ha="center", va="center")
    boxes = [_Box(0.07, radius + 0.045, 0.06, 0.04) for radius in rings.values()]
    for angle, box in zip(rings, boxes, strict=True):
        axes.text(box.x, box.y, f"{angle}°", color=FAINT, fontsize=7, ha="center", va="center")
    return boxes


def _rings(axes: Axes, radii: list[float], **style: Any) -> None:
    """Draw circles about the middle, as one line."""
    circle = np.append(np.exp(1j * _TURN), np.nan)
    line = np.concatenate([radius * circle for radius in radii])
    axes.plot(line.real, line.imag, **style)


def _groups(at: NDArray[np.float64], indices: NDArray[np.intp]) -> list[list[int]]:
    """Return indices of points that lie on one another, together."""
    groups: list[list[int]] = []
    for index in indices.tolist():
        near = [g for g in groups if np.linalg.norm(at[g] - at[index], axis=1).min() < _TOUCHING]
        groups = [g for g in groups if g not in near]
        groups.append(sorted([index, *(i for g in near for i in g)]))
    return groups


def _label(axes: Axes, point: NDArray[np.float64], text: str, taken: list[_Box], size: float) -> None:
    """Write beside a point, on that of eight sides where it covers least of what is there."""
    half_x, half_y = 0.31 * size * len(text) / _RADIUS, 0.42 * size / _RADIUS
    sides = [(1, 1), (1, -1), (-1, 1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1)]
    boxes = [
        _Box(
            point[0] + i * (half_x + 0.045), point[1] + j * (half_y + (0.02 if i else 0.045)), half_x, half_y
        )
        for i, j in sides
    ]
    box = min(boxes, key=lambda box: sum(box.overlap(other) for other in taken))
    taken.append(box)
    axes.text(box.x, box.y, text, fontsize=size, ha="center", va="center_baseline")


# ---- contact error -----------------------------------------------------------------------------

_FILLED = 24  # colours on the map
# Of the colours: the last one, and how many times less than good the first is.
_LIMITS, _DARKEST = Limits(), 20.0
_TICKS = [0.025, 0.05, 0.1, 0.2, 0.5, 1.0, 1.5]
_ON_FIELD = "#111111"  # lines and letters on colours that are the same in both themes
_BACKED = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.7}


def error_map(
    calibration: Calibration, sigmas: NDArray[np.float64], steepest: float = STEEPEST
) -> tuple[NDArray[np.float64], ...]:
    """Predict the contact error over force directions: worst 1 sigma over the task's orientations, m.

    Returns
    -------
    angles (26,), around (73,)
        Between force and normal; of the force's pull along the surface, from the side shown to the right, rad.
    calibration's share, with noise : (26, 73)
        The second one with noise of `sigmas` (6,) in the wrench too.
    """
    task = calibration.task
    surface, right = _surface(task.normal)
    angles = np.radians(np.linspace(0, steepest, 26))
    grid = np.meshgrid(angles, _TURN + right, indexing="ij")
    forces = task.force * force_directions(task.normal, grid[0].ravel(), grid[1].ravel())
    S = surface @ contact_sensitivity(task.point, task.normal, forces)
    J = prediction_jacobian(task.orientations, calibration.model.vector)
    wrench = J @ calibration.covariance @ J.swapaxes(1, 2)  # (k, 6, 6): what the calibration leaves
    share, total = (
        np.sqrt(largest_eigenvalue(S @ (wrench + noise)[:, None] @ S.swapaxes(1, 2)).max(axis=0))
        for noise in (np.zeros((6, 6)), np.diag(sigmas**2))
    )
    return angles, _TURN, share.reshape(grid[0].shape), total.reshape(grid[0].shape)


def _surface(normal: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return two directions in the surface (2, 3), and the angle from them of what the map shows to the right.

    That is the axis of S that lies flattest in the surface; seen from outside, as is the whole map.
    """
    surface = force_directions(normal, np.full(2, np.pi / 2), np.array([0, np.pi / 2]))
    axis = int(np.argmin(np.abs(normal)))
    return surface, float(np.arctan2(surface[1, axis], surface[0, axis]))


def _contact(calibration: Calibration, sigmas: NDArray[np.float64], noise: str) -> Figure:
    angles, around, *errors = error_map(calibration, sigmas)
    share, total = (1e3 * np.maximum(error, 1e-7) for error in errors)
    low, high = float(share.min()), max(float(total.max()), 1.01 * float(share.min()))
    # The same colour means the same error in every report: the scale ends at the limits of the verdict.
    fill = np.geomspace(1e3 * _LIMITS.good_error / _DARKEST, 1e3 * _LIMITS.usable_error, _FILLED + 1)
    lines = steps(low, high)
    norm = LogNorm(fill[0], fill[-1])
    x, y = np.degrees(angles)[:, None] * np.cos(around), np.degrees(angles)[:, None] * np.sin(around)
    figure = Figure(figsize=(WIDTH, 3.55))
    for column, (error, name) in enumerate(((share, "calibration alone"), (total, f"with {noise}"))):
        axes = figure.add_axes((0.44 * column, 0.0, 0.43, 0.88))
        filled = axes.contourf(x, y, error, levels=fill, cmap="cividis", norm=norm, extend="both")
        filled.set(edgecolor="face", linewidth=0.4)  # else the page shines through between two colours
        inside = [level for level in lines if error.min() < level < error.max()]
        if inside:
            drawn = axes.contour(x, y, error, levels=inside, colors=[_ON_FIELD], linewidths=0.6)
            for text in axes.clabel(drawn, fontsize=7, fmt="%g", inline=False, colors=[_ON_FIELD]):
                text.set_bbox(_BACKED)
        _net(axes, calibration)
        reach = f"{name}\n{plain(float(error.min()))} to {plain(float(error.max()))} mm"
        figure.text(0.44 * column + 0.215, 0.985, reach, ha="center", va="top")
    beside = figure.add_axes((0.905, 0.1, 0.022, 0.68))
    bar = figure.colorbar(filled, cax=beside, ticks=_TICKS, format="%g", spacing="proportional")
    bar.ax.tick_params(labelsize=8, length=2)
    figure.text(0.93, 0.82, "mm, 1 sigma", fontsize=8, ha="center")
    return figure


def _net(axes: Axes, calibration: Calibration) -> None:
    """Draw the angles, the axes of S, and dashed the ring of the task's friction."""
    axes.set(xlim=(-90, 90), ylim=(-88, 88), aspect="equal")
    axes.set_axis_off()
    rings = [30.0, 60.0, STEEPEST]
    _rings(axes, rings, color="#ffffff", linewidth=0.5, alpha=0.8)
    for ring in rings:
        style: dict[str, Any] = {"color": _ON_FIELD, "fontsize": 6.5, "bbox": _BACKED}
        axes.text(0.71 * ring, -0.71 * ring, f"{ring:g}°", ha="center", va="center", **style)
    friction = float(np.degrees(calibration.task.friction))
    if friction < STEEPEST:
        _rings(axes, [friction], color="#ffffff", linewidth=1.6, linestyle=(0, (4, 2)))
    surface, right = _surface(calibration.task.normal)
    for name, (x, y) in zip("xyz", surface.T, strict=True):
        if np.hypot(x, y) < 0.5:
            continue  # stands nearly straight out of the surface
        angle = np.arctan2(y, x) - right
        for sign, mark in _SIGNS:
            place = sign * 82 * np.array([np.cos(angle), np.sin(angle)])
            axes.text(place[0], place[1], f"{mark}{name}", ha="center", va="center")


def steps(low: float, high: float) -> list[float]:
    """Return round numbers between `low` and `high`: about 4 to 12 of them, down to steps of a tenth."""
    found: list[float] = []
    exponents = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    for digits in ("1", "13", "125", "12357", "123456789", [str(d / 10) for d in range(10, 100)]):
        every = [float(f"{digit}e{exponent}") for exponent in exponents for digit in digits]
        found = [value for value in every if low <= value <= high]
        if len(found) >= 4:
            break
    return found
