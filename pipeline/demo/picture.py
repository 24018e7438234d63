"""The picture: every probe from its face side, with what was located, how surely, and how wrongly.

The bodies are cast by rays as those of heatmaps are; all that is told on them is drawn by Matplotlib at the same
projection, so that lines and letters are sharp at any size.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from io import BytesIO
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench import assets
from contactbench.pipeline.contact import Batch, Contact
from contactbench.pipeline.demo.compare import errors_mm
from contactbench.pipeline.heatmap.picture import PictureLook, SurfaceView
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats

_FACETS, _DRAWN_FACETS = 2_000, 20_000
_BODY, _REGION = (0.98, 0.98, 0.98), (0.71, 0.93, 0.86)  # light grey; Okabe-Ito's bluish green, pale
_SHOWN = 25
_SPACING_MM = 3.0  # contacts shown are at least this far apart
_FACING = 0.3  # cosine between a shown contact's normal and the look at it
_TRIED = 2_000

# End of the colours: for single readings, and where a filter made them quieter.
_LARGEST_MM, _LARGEST_FILTERED_MM = 2.0, 0.5
_95_PERCENT = sqrt(5.991)  # standard deviations, two dimensions
_MM_PER_N = 1.3
_DISC_MM = 0.85  # radius

# Azimuth and elevation: the face well open, and two sides of the head.
_ANGLES = (np.radians(24.0), np.radians(44.0))
_CLOSE_MM = {"linear": 88.0, "convex": 101.0, "t-shape": 117.0}
_WHOLE_MM = 96.0
_AXIS_MM = 42.0

# Inches of paper.
_PANEL, _BODY_HEIGHT, _FOOT, _HEIGHT = 6.0, 6.1, 1.0, 8.0
_INSET, _INSET_SHAPE = 1.9, 1.45
# Where the handle fades out, mm below the tip.
_FADE_MM = (62.0, 88.0)

_INK, _FORCE, _FAINT = "#222222", "#0072b2", "#6b6b6b"
_AXES = (("x", "#d55e00"), ("y", "#009e73"), ("z", "#0072b2"))


@dataclass(frozen=True, eq=False)
class LocatedProbe:
    """What to draw on one probe."""

    probe: str  # one of assets.PROBE_NAMES
    batch: Batch  # answers, S, m
    points: Floats  # (n, 3) True points, S, m
    mean_mm: float | None  # mean error for the title


def draw(located: Sequence[LocatedProbe], pixels_per_inch: int = 100) -> bytes:
    """Draw the probes side by side.

    Parameters
    ----------
    located : sequence of LocatedProbe
        From left to right.
    pixels_per_inch : int
        A probe is 6 inches wide, the picture 8 inches high.

    Returns
    -------
    bytes
        A PNG image.
    """
    width = _PANEL * max(len(located), 2)  # the legend needs the room of two
    figure = import_module("matplotlib.figure").Figure(figsize=(width, _HEIGHT), dpi=pixels_per_inch)
    colours = import_module("matplotlib").colormaps["cividis"]
    left = (width - _PANEL * len(located)) / 2
    largest = _end_of_colours(located)
    for i, one in enumerate(located):
        x, close, whole = left + _PANEL * i, _close(one.probe), _whole(one.probe)
        panel = _axes(figure, x, _FOOT, _PANEL, _BODY_HEIGHT)
        image = _body(one.probe, close, round(_PANEL * pixels_per_inch))
        _draw_close(panel, close, image, one, colours, largest)
        inset = _axes(figure, x + 0.15, _FOOT + 0.15, _INSET, _INSET * _INSET_SHAPE)
        _draw_whole(inset, whole, _body(one.probe, whole, round(_INSET * pixels_per_inch)))
        _title(figure, x + _PANEL / 2, one)
    _draw_legend(figure, width, colours, largest)
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()


def _body(name: str, look: PictureLook, pixels: int) -> NDArray[np.uint8]:
    """Return a bundled probe on white, its contact region tinted."""
    vertices, faces = assets.make(name, _DRAWN_FACETS)
    region = assets.contact_region(name, vertices, faces)
    view = SurfaceView(Probe.from_arrays(vertices, faces), look, pixels)
    return view.by_facet(np.array([_BODY, _REGION])[region])


# ---- what to show ------------------------------------------------------------------------------


def _end_of_colours(located: Sequence[LocatedProbe]) -> float:
    """Return the error, mm, with the last colour: small ones should not all look the same."""
    means = [one.mean_mm for one in located if one.mean_mm is not None]
    return _LARGEST_FILTERED_MM if means and max(means) < _LARGEST_FILTERED_MM else _LARGEST_MM


def _close(probe: str) -> PictureLook:
    """Look at the head: near, with room for the arrows around it and for the inset on the left."""
    width = 1e-3 * _CLOSE_MM[probe]
    look = PictureLook(np.zeros(3), *_ANGLES, width, _BODY_HEIGHT / _PANEL)
    top = float(look.project(assets.make(probe, _FACETS)[0])[:, 1].max())
    middle = (top + 0.015 - look.high * width / 2) * look.up - 0.07 * width * look.right
    return replace(look, middle=middle)


def _whole(probe: str) -> PictureLook:
    return PictureLook(np.array([0.0, 0.0, 0.48 * _tip(probe)]), *_ANGLES, 1e-3 * _WHOLE_MM, _INSET_SHAPE)


def _mm(look: PictureLook, points: ArrayLike) -> Floats:
    """Return where points (..., 3) of S, m, lie on paper: (..., 2), mm from the middle."""
    return 1e3 * look.project(points)


def _tip(probe: str) -> float:
    return float(assets.make(probe, _FACETS)[0][:, 2].max())


def _choose(one: LocatedProbe) -> list[int]:
    """Rows of settled contacts that the camera sees, spread out: each the farthest from those before it."""
    look = _close(one.probe)
    probe = Probe.from_arrays(*assets.make(one.probe, _FACETS))
    rows = np.flatnonzero(one.batch.accepted)
    rows = rows[:: 1 + len(rows) // _TRIED]
    facing = one.batch.normals[rows] @ look.toward > _FACING
    rows = rows[facing & look.unhidden(one.batch.points[rows], probe)]
    if not len(rows):
        return []
    at = _mm(look, one.batch.points[rows])
    chosen = [int(np.argmin(np.linalg.norm(at, axis=1)))]
    gap = np.linalg.norm(at - at[chosen[0]], axis=1)
    while len(chosen) < min(_SHOWN, len(rows)) and gap.max() > _SPACING_MM:
        chosen.append(int(np.argmax(gap)))
        gap = np.minimum(gap, np.linalg.norm(at - at[chosen[-1]], axis=1))
    return [int(row) for row in rows[chosen]]


# ---- drawing -----------------------------------------------------------------------------------


def _axes(figure: Any, x: float, y: float, width: float, height: float) -> Any:
    """Return axes without a frame; inches from the lower left corner."""
    whole_width, whole_height = figure.get_size_inches()
    axes = figure.add_axes((x / whole_width, y / whole_height, width / whole_width, height / whole_height))
    axes.set_axis_off()
    return axes


def _show(
    axes: Any, look: PictureLook, image: NDArray[np.uint8], fade: tuple[float, float] | None = None
) -> None:
    """Lay an image on the paper; white is clear, and below `fade` (from, to; mm on paper) all is."""
    half = (500 * look.width, 500 * look.high * look.width)
    opaque = (255.0 - image.min(axis=2)).clip(0, 24) / 24
    if fade is not None:
        y = np.linspace(half[1], -half[1], len(image))
        opaque *= np.interp(y, fade, (0.0, 1.0))[:, None]
    pixels = np.dstack([image, np.rint(255 * opaque).astype(np.uint8)])
    axes.imshow(pixels, extent=(-half[0], half[0], -half[1], half[1]), interpolation="antialiased", zorder=0)
    axes.set(xlim=(-half[0], half[0]), ylim=(-half[1], half[1]))


def _draw_close(
    axes: Any, look: PictureLook, image: NDArray[np.uint8], one: LocatedProbe, colours: Any, largest: float
) -> None:
    begin, end = (float(_mm(look, [0.0, 0.0, _tip(one.probe) - 1e-3 * mm])[1]) for mm in _FADE_MM)
    _show(axes, look, image, (end, begin))
    error = errors_mm(one.batch, one.points)
    for row in _choose(one):
        contact = one.batch[row]
        _draw_contact(axes, look, contact, colours(min(error[row] / largest, 1.0)))
        axes.plot(*_mm(look, one.points[row]), "o", color="black", markersize=2.6, mew=0, zorder=6)
    wide = 1e3 * look.width
    x, y = 0.45 * wide, -0.43 * look.high * wide
    axes.plot([x - 20, x], [y, y], color=_FAINT, linewidth=2, solid_capstyle="butt")
    axes.text(x - 10, y + 0.012 * wide, "20 mm", ha="center", va="bottom", color=_FAINT, fontsize=11)


def _draw_contact(axes: Any, look: PictureLook, contact: Contact, colour: Any) -> None:
    point, normal, ellipse = contact.point, contact.normal, contact.ellipse
    if point is None or normal is None or ellipse is None:
        return
    tail, tip = _mm(look, [point - 1e-3 * _MM_PER_N * contact.wrench[:3], point])
    _arrow(axes, tail, tip, _FORCE, width=1.0)
    outline = _mm(look, point + _ring(_95_PERCENT * ellipse))
    axes.fill(*outline.T, facecolor=(1, 1, 1, 0.45), edgecolor=_INK, linewidth=0.9, zorder=4)
    across = np.cross(normal, look.right)
    across /= np.linalg.norm(across)
    disc = _mm(look, point + _ring(1e-3 * _DISC_MM * np.array([np.cross(across, normal), across])))
    axes.fill(*disc.T, facecolor=colour, edgecolor=_INK, linewidth=0.4, zorder=5)


def _ring(half_axes: Floats) -> Floats:
    """Points (n, 3) around an ellipse of half axes (2, 3)."""
    turn = np.linspace(0, 2 * np.pi, 49)
    return np.column_stack([np.cos(turn), np.sin(turn)]) @ half_axes


def _arrow(axes: Any, tail: Any, tip: Any, colour: str, width: float) -> None:
    style = {"arrowstyle": "-|>,head_width=0.16,head_length=0.4", "color": colour, "linewidth": width}
    style |= {"shrinkA": 0, "shrinkB": 0, "mutation_scale": 12, "joinstyle": "miter"}
    axes.annotate("", tip, tail, arrowprops=style, zorder=3, annotation_clip=False)


def _draw_whole(axes: Any, look: PictureLook, image: NDArray[np.uint8]) -> None:
    """Draw the whole probe, small, with the axes of S at its flange."""
    _show(axes, look, image)
    origin = _mm(look, [0.0, 0.0, 0.0])
    for i, (letter, colour) in enumerate(_AXES):
        along = _mm(look, 1e-3 * _AXIS_MM * np.eye(3)[i])
        _arrow(axes, origin, along, colour, width=1.4)
        place = origin + (along - origin) * 1.16
        axes.text(*place, letter, color=colour, fontsize=13, weight="bold", ha="center", va="center")


def _title(figure: Any, x: float, one: LocatedProbe) -> None:
    width, height = figure.get_size_inches()
    place = {"ha": "center", "color": _INK}
    figure.text(x / width, 1 - 0.42 / height, one.probe, fontsize=20, weight="bold", **place)
    mean = "nothing located" if one.mean_mm is None else f"mean error {one.mean_mm:.2f} mm"
    figure.text(x / width, 1 - 0.74 / height, mean, fontsize=15, **place)


def _draw_legend(figure: Any, width: float, colours: Any, largest: float) -> None:
    """Explain the marks in one line at the foot, with the scale of colours at its right end."""
    long = 11.6
    axes = _axes(figure, (width - long) / 2, 0.2, long, 0.6)
    axes.set(xlim=(0, long), ylim=(0, 0.6))
    text = {"va": "center", "fontsize": 13, "color": _INK}
    _arrow(axes, (0.0, 0.3), (0.45, 0.3), _FORCE, width=1.2)
    axes.text(0.58, 0.3, "force on the probe", **text)
    turn = np.linspace(0, 2 * np.pi, 49)
    axes.fill(2.72 + 0.19 * np.cos(turn), 0.3 + 0.12 * np.sin(turn), fc="white", ec=_INK, lw=0.9)
    axes.text(3.03, 0.3, "95 % uncertainty", **text)
    axes.plot([5.05], [0.3], "o", color="black", markersize=3.4, mew=0)
    axes.text(5.19, 0.3, "true point", **text)
    axes.fill(6.62 + 0.09 * np.cos(turn), 0.3 + 0.09 * np.sin(turn), fc=colours(0.4), ec=_INK, lw=0.5)
    axes.text(6.82, 0.3, "located, by error", **text)
    ramp = np.linspace(0, 1, 256)[None]
    axes.imshow(ramp, cmap=colours, extent=(8.85, 11.15, 0.3, 0.46), aspect="auto")
    for share in (0.0, 0.5, 1.0):
        place = 8.85 + 2.3 * share
        label = f"{'≥ ' if share == 1 else ''}{share * largest:g}{' mm' if share == 1 else ''}"
        axes.text(place, 0.13, label, ha="center", va="center", fontsize=12, color=_INK)
    axes.set(xlim=(0, long), ylim=(0, 0.6))
