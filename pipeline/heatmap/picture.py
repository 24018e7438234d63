"""
A heatmap as a PNG: the touched part of the probe from two sides, with a scale in the quantity's unit; or as a film.

The surface is drawn by casting a ray through every pixel: that needs no graphics driver and gives the same bytes
on every machine with the same libraries. For a film, MP4 or an animated GIF, the rays are cast once, so that a frame is
only its colours.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.heatmap.heatmap import NO_DATA, Heatmap, HeatmapError, colours, vertex_normals
from contactbench.pipeline.heatmap.selection import Playback, Selection, empty_words
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.engines import NOBODY, Monitor

SUFFIXES = (".mp4", ".gif")
SLOWEST, FASTEST = 0.1, 50.0  # times the real speed
_RATES = {".mp4": 25, ".gif": 10}  # frames a second; a GIF counts in hundredths
_MOST_FRAMES = 15_000  # ten minutes of MP4
_HEAD, _FOOT = 0.17, 0.28  # of a look's width: above and below the looks
_TRACK, _BAR = (222, 224, 228), (0, 90, 156)
_ELEVATION = 32.0  # degrees above the flange plane: both the tip and the sides are seen
_MARGIN = 1.25  # of the touched part's size
_LEAST_M = 0.03  # shown, at least
_HIDDEN_M = 5e-4  # behind the surface by more than this, a point is on the other side
_LONG = 1.3  # a touched part this much longer than wide is shown lengthwise
HIGH = 0.78  # of the width
_SMOOTHING = 2  # rays per pixel and axis
_LIGHT = (-0.35, 0.55, 0.76)  # right, up, toward the eye
_INK, _FAINT = "#222222", "#595959"
_ONE = {"contacts": "contact", "samples": "sample", "touches": "touch"}
_NICE = np.array([1.0, 2.0, 5.0])


@dataclass(frozen=True, eq=False)
class PictureLook:
    """An orthographic look with +z of S upwards: its middle (S, m), where the eye is (rad), and its width (m)."""

    middle: NDArray[np.float64]
    azimuth: float  # of the eye, from -y towards +x
    elevation: float  # above the flange plane
    width: float
    high: float = HIGH  # of the width

    @property
    def right(self) -> NDArray[np.float64]:
        """Unit vector (3,) of S."""
        return np.array([np.cos(self.azimuth), np.sin(self.azimuth), 0.0])

    @property
    def up(self) -> NDArray[np.float64]:
        """Unit vector (3,) of S."""
        return np.cross(self.toward, self.right)

    @property
    def toward(self) -> NDArray[np.float64]:
        """Unit vector (3,) of S to the eye."""
        a, e = self.azimuth, self.elevation
        return np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Return where points (..., 3) of S, m, lie on the picture: (..., 2), m from the middle."""
        offset = np.asarray(points, dtype=np.float64) - self.middle
        return np.asarray(offset @ np.column_stack([self.right, self.up]))

    def unhidden(
        self, points: NDArray[np.float64], probe: Probe, index: SurfaceIndex | None = None
    ) -> NDArray[np.bool_]:
        """Tell which points (n, 3) on a probe no facet of it hides, (n,)."""
        index = index or SurfaceIndex(probe.vertices, probe.faces)
        far = 4.0 * probe.size
        directions = np.ascontiguousarray(np.broadcast_to(-self.toward, points.shape))
        t, faces = index.first_hit(points + far * self.toward, directions)
        return np.asarray((faces < 0) | (t > far - _HIDDEN_M))


def encode_png(
    heatmap: Heatmap, *, pixels: int = 520, legend: bool = True, limit: float | None = None
) -> bytes:
    """
    Return a heatmap as a PNG image.

    Parameters
    ----------
    pixels : int
        Width of each of the two looks.
    legend : bool
        With a heading.
    limit : float, optional
        Where the colours end, in the heatmap's unit, such as the largest error that is allowed: then a colour means the
        same on every picture. Left out: `Heatmap.scale`.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    scale = heatmap.scale if limit is None else ColourScale(limit)
    first, second = looks(heatmap)
    side, low, high = 4.0, 1.15, 0.55 if legend else 0.25
    size = (2 * side, HIGH * side + low + high)
    style: dict[Any, Any] = {"font.family": ["DejaVu Sans"], "font.size": 11.0, "text.parse_math": False}
    with mpl.rc_context(style), warnings.catch_warnings():
        # A name in letters that the font lacks is drawn as boxes; that is no matter for a warning by Python.
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        figure = Figure(figsize=size, dpi=pixels / side)
        for column, look in enumerate((first, second)):
            axes = figure.add_axes(
                (column * side / size[0], low / size[1], side / size[0], HIGH * side / size[1])
            )
            axes.imshow(
                SurfaceView(heatmap.probe, look, pixels).drawn(heatmap, scale),
                extent=(-0.5, 0.5, -HIGH / 2, HIGH / 2),
            )
            axes.set_axis_off()
            axes.set(xlim=(-0.5, 0.5), ylim=(-HIGH / 2, HIGH / 2))
            add_triad(axes, look)
        if legend:
            words = f"{heatmap.title} on {heatmap.probe.name}"
            figure.text(0.5, 1 - 0.33 / size[1], words, ha="center", va="center", fontsize=14, color=_INK)
        _scale(figure, heatmap, scale, size)
        _ruler(figure, first, size, side)
        figure.text(0.5, 0.13 / size[1], _note(heatmap), ha="center", color=_FAINT, fontsize=9)
        data = BytesIO()
        figure.savefig(data, format="png", metadata={"Software": None}, facecolor="white")
    return data.getvalue()


def looks(heatmap: Heatmap) -> tuple[PictureLook, PictureLook]:
    """Return two looks at the part with data, from the side that has most of it and from the opposite one."""
    probe, known = heatmap.probe, heatmap.known
    touched = probe.vertices[known]
    middle = 0.5 * (touched.min(axis=0) + touched.max(axis=0))
    normal = np.nan_to_num(heatmap.values)[known] @ vertex_normals(probe)[known]
    return _two_looks(touched, middle, normal)


def _two_looks(
    touched: NDArray[np.float64], middle: NDArray[np.float64], normal: NDArray[np.float64]
) -> tuple[PictureLook, PictureLook]:
    """Return a look from the side that `normal` shows to, and one from the opposite side."""
    longest, ratio = _longest((touched - middle)[:, :2])
    # What is long lies across the picture, whichever way it is touched.
    y, x = (longest[1], longest[0]) if ratio > _LONG else (normal[0], -normal[1])
    azimuth = float(np.arctan2(y, x)) + np.radians(20.0)  # not head-on: depth shows
    low = -1.0 if normal[2] < -0.3 * np.linalg.norm(normal) else 1.0
    first, second = (_look(touched, middle, azimuth + turn, low) for turn in (0.0, np.pi))
    width = max(first.width, second.width)
    return replace(first, width=width), replace(second, width=width)


def looks_at(probe: Probe, points: NDArray[np.float64]) -> tuple[PictureLook, PictureLook]:
    """Return two looks at a probe with points (n, 3) on it, S, m: at all of it where there are none."""
    if len(points) < 3:
        points = probe.vertices
    index = SurfaceIndex(probe.vertices, probe.faces)
    normal = probe.normals[np.asarray(index.closest(np.ascontiguousarray(points))[1])].mean(axis=0)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return _two_looks(points, middle, normal)


def _longest(flat: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return the direction (2,) in which points (n, 2) are spread most, and how much more than across it."""
    values, vectors = np.linalg.eigh(np.cov(flat.T) if len(flat) > 2 else np.eye(2))
    longest = vectors[:, 1] * (1.0 if vectors[np.argmax(np.abs(vectors[:, 1])), 1] > 0 else -1.0)
    return longest, float(np.sqrt(values[1] / max(values[0], 1e-12 * values[1]))) if values[1] > 0 else 1.0


def _look(
    touched: NDArray[np.float64], middle: NDArray[np.float64], azimuth: float, low: float
) -> PictureLook:
    look = PictureLook(middle, azimuth, np.radians(low * _ELEVATION), 0.0)
    flat = look.project(touched)
    width = max(_LEAST_M, _MARGIN * float((np.ptp(flat, axis=0) / [1.0, HIGH]).max()))
    centre = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
    return replace(look, middle=middle + centre[0] * look.right + centre[1] * look.up, width=width)


class SurfaceView:
    """A look at a probe: which facet lies under each pixel, and how it is lit, found once; `pixels` wide."""

    def __init__(self, probe: Probe, look: PictureLook, pixels: int) -> None:
        rows = round(look.high * pixels)
        step = look.width / (_SMOOTHING * pixels)
        across, down = (np.arange(_SMOOTHING * n) + 0.5 - 0.5 * _SMOOTHING * n for n in (pixels, rows))
        x, y = np.meshgrid(step * across, -step * down)
        eye = look.middle + 4.0 * probe.size * look.toward
        origins = eye + x.reshape(-1, 1) * look.right + y.reshape(-1, 1) * look.up
        directions = np.ascontiguousarray(np.broadcast_to(-look.toward, origins.shape))
        t, faces = SurfaceIndex(probe.vertices, probe.faces).first_hit(origins, directions)
        self._hit = faces >= 0
        self._shape = (rows, _SMOOTHING, pixels, _SMOOTHING, 3)
        self._facets = faces[self._hit]
        self._corners = probe.faces[self._facets]
        points = origins[self._hit] - t[self._hit, None] * look.toward
        a, b, c = np.moveaxis(probe.vertices[self._corners], 1, 0)
        normal = np.cross(b - a, c - a)
        double = np.einsum("ij,ij->i", normal, normal)
        v = np.einsum("ij,ij->i", np.cross(a - c, points - c), normal) / double
        w = np.einsum("ij,ij->i", np.cross(b - a, points - a), normal) / double
        self._shares = np.column_stack([1 - v - w, v, w])[..., None]
        lit = (self._shares * vertex_normals(probe)[self._corners]).sum(axis=1)
        lit /= np.maximum(np.linalg.norm(lit, axis=1, keepdims=True), 1e-12)
        light = np.asarray(_LIGHT) @ np.stack([look.right, look.up, look.toward])
        self._bright = np.clip(lit @ light, 0.0, 1.0)

    def drawn(self, heatmap: Heatmap, scale: ColourScale | None = None) -> NDArray[np.uint8]:
        """Return the surface on white as one sees it, (height, pixels, 3), by its own scale of colours or another."""
        known = (self._shares[..., 0] * heatmap.known[self._corners]).sum(axis=1)
        # Data keep their colours, so that they can be read off the scale; the form of the rest shows by shade.
        return self._lit((self._shares * colours(heatmap, scale)[self._corners]).sum(axis=1), known)

    def plain(self, colour: tuple[float, float, float]) -> NDArray[np.uint8]:
        """Return the surface in one colour, sRGB, 0 to 1; see `drawn`."""
        return self._lit(np.array([colour]), np.zeros(1))

    def by_facet(self, colours: NDArray[np.float64]) -> NDArray[np.uint8]:
        """Return the surface with a colour for each facet (m, 3), sRGB, 0 to 1; see `drawn`."""
        return self._lit(colours[self._facets], np.zeros(1))

    def _lit(self, base: NDArray[np.float64], known: NDArray[np.float64]) -> NDArray[np.uint8]:
        bright = self._bright
        shade = (0.62 + 0.38 * bright) * (1 - known) + (0.86 + 0.14 * bright) * known
        image = np.ones((len(self._hit), 3))
        image[self._hit] = np.clip(base * shade[:, None], 0.0, 1.0)
        blocks = image.reshape(self._shape).mean(axis=(1, 3))
        return np.asarray(np.rint(255 * blocks), dtype=np.uint8)


def add_triad(axes: Any, look: PictureLook) -> None:
    """Draw the axes of S in the lower left corner."""
    origin = np.array([-0.41, 0.09 - HIGH / 2])
    for letter, axis in zip("xyz", np.eye(3), strict=True):
        along = 0.075 * np.array([axis @ look.right, axis @ look.up])
        if np.linalg.norm(along) < 0.02:
            continue
        axes.annotate(
            "",
            origin + along,
            origin,
            arrowprops={"arrowstyle": "-|>", "color": _INK, "shrinkA": 0, "shrinkB": 0, "lw": 1.1},
        )
        place = origin + along * (1 + 0.026 / np.linalg.norm(along))
        axes.text(*place, letter, ha="center", va="center", color=_INK, fontsize=10)


def _ruler(figure: Any, look: PictureLook, size: tuple[float, float], side: float) -> None:
    """Draw a length for scale beside the colours; both looks have the same."""
    length = _nice(0.15 * 1e3 * look.width)
    share = 1e-3 * length / look.width * side / size[0]
    axes = figure.add_axes((0.95 - share, 0.8 / size[1], share, 0.1 / size[1]))
    axes.set_axis_off()
    axes.plot([0, 1], [0.5, 0.5], color=_INK, lw=2, solid_capstyle="butt")
    axes.set(xlim=(0, 1), ylim=(0, 1))
    place = {"ha": "center", "va": "bottom", "color": _INK, "fontsize": 10}
    figure.text(0.95 - share / 2, 0.9 / size[1], f"{length:g} mm", **place)


def _nice(length: float) -> float:
    power = 10.0 ** np.floor(np.log10(length))
    return float(power * _NICE[_NICE * power <= length * (1 + 1e-12)].max())


def _scale(figure: Any, heatmap: Heatmap, scale: ColourScale, size: tuple[float, float]) -> None:
    """Draw the colours with numbers, and the grey of no data beside them."""
    axes = figure.add_axes((0.2, 0.84 / size[1], 0.46, 0.16 / size[1]))
    axes.imshow(scale.ramp()[None], extent=(0, 1, 0, 1), aspect="auto")
    ticks = scale.ticks()
    axes.set(
        yticks=[], xlim=(0, 1), xticks=scale.places(ticks), xticklabels=[f"{each:.4g}" for each in ticks]
    )
    axes.tick_params(colors=_INK, labelsize=10, length=3)
    over = f" (darkest above; up to {heatmap.largest:.3g})" if scale.top < heatmap.largest else ""
    axes.set_xlabel(f"{heatmap.title}, {heatmap.unit}{over}", color=_INK, fontsize=11, labelpad=2)
    key = figure.add_axes((0.68, 0.84 / size[1], 0.025, 0.16 / size[1]))
    key.set(xticks=[], yticks=[], facecolor=NO_DATA)
    figure.text(0.712, 0.92 / size[1], "no data, or 0", va="center", color=_INK, fontsize=9)


def _note(heatmap: Heatmap) -> str:
    counted = heatmap.counted if heatmap.contacts != 1 else _ONE.get(heatmap.counted, heatmap.counted)
    return (
        f"{heatmap.contacts:,} {counted}; Gaussian along the surface, bandwidth"
        f" {1e3 * heatmap.bandwidth:.3g} mm; seen from two sides; axes of the sensor frame S"
    )


@dataclass(frozen=True)
class FilmSettings:
    """How contacts are shown through time."""

    speed: float = 1.0  # seconds of the recording in a second of the film, 0.1 to 50
    window: float | None = None  # s: only the last seconds are shown; None: what was touched stays
    pixels: int = 400  # width of each of the two looks

    def check(self) -> None:
        """Refuse what makes no film; HeatmapError."""
        if not SLOWEST <= self.speed <= FASTEST:
            raise HeatmapError(
                f"a speed of {arg(self.speed):g}: choose {arg(SLOWEST):g} to {arg(FASTEST):g} times."
            )
        if self.window is not None and not 0 < self.window < np.inf:
            raise HeatmapError(f"a window of {arg(self.window):g} s: choose more than 0 s, or none.")


def moments(playback: Playback, selection: Selection, settings: FilmSettings, rate: int) -> list[Selection]:
    """Return what each frame of a film shows; HeatmapError: there is nothing, or it would be too long."""
    settings.check()
    start = selection.start or 0.0
    end = min(playback.duration, np.inf if selection.end is None else selection.end)
    if not playback.frame(selection).contacts:
        raise HeatmapError(empty_words(playback.contacts, selection))
    if not end > start:
        raise HeatmapError(
            f"a film of {arg(max(end - start, 0.0)):g} s shows no motion: widen the time window, or"
            " save a picture."
        )
    count = int(np.ceil((end - start) / settings.speed * rate)) + 1
    if count > _MOST_FRAMES:
        raise HeatmapError(
            f"a film of {arg(count / rate / 60):.0f} minutes is too long: choose a higher speed, or a"
            " shorter time window."
        )
    ends = np.minimum(start + np.arange(count) * settings.speed / rate, end)
    begins = np.full(count, start) if settings.window is None else np.maximum(ends - settings.window, start)
    return [
        replace(selection, start=float(begin), end=float(until))
        for begin, until in zip(begins, ends, strict=True)
    ]


def frames(
    playback: Playback, selection: Selection, settings: FilmSettings, rate: int = 25
) -> Iterator[tuple[float, NDArray[np.uint8]]]:
    """Yield how much of a film is done, 0 to 1, and its frames (h, w, 3); both sides are even numbers."""
    parts = moments(playback, selection, settings, rate)
    whole = playback.heatmap(selection)
    scale = playback.scale(selection, settings.window)
    views = [SurfaceView(whole.probe, look, settings.pixels) for look in looks(whole)]
    page = _Page(playback, whole, settings, scale)
    first, last = parts[0].end or 0.0, parts[-1].end or 0.0
    for number, part in enumerate(parts):
        at = part.end or 0.0
        made = playback.heatmap(part)
        sides = [view.drawn(made, scale) for view in views]
        yield (
            (number + 1) / len(parts),
            page.drawn(sides, at, (at - first) / max(last - first, 1e-9), made.contacts),
        )


def write_film(
    file: Path,
    playback: Playback,
    selection: Selection,
    settings: FilmSettings | None = None,
    *,
    monitor: Monitor = NOBODY,
) -> int:
    """
    Write a film; nothing is left of one that was not finished.

    Parameters
    ----------
    file : Path
        Ends in .mp4 or .gif.
    selection : Selection
        Its time window is what the film runs through.
    monitor : Monitor

    Returns
    -------
    int
        How many frames it has.

    Raises
    ------
    InputError
        There is nothing to show, the program for MP4 is missing, or the file cannot be written.
    Cancelled
        The caller cancelled.
    """
    kind = file.suffix.lower()
    if kind not in SUFFIXES:
        raise HeatmapError(f"{arg(file)}: the name of a film must end in .mp4 or .gif.")
    settings = settings or FilmSettings()
    rate, shown = _RATES[kind], 0

    def followed() -> Iterator[NDArray[np.uint8]]:
        nonlocal shown
        for share, image in frames(playback, selection, settings, rate):
            monitor.check()
            shown += 1
            yield image
            monitor.tell(share)

    scratch = scratch_beside(file).with_suffix(kind)
    try:
        (_write_mp4 if kind == ".mp4" else _write_gif)(scratch, followed(), rate)
        scratch.replace(file)
        sync_folder(file.parent)
    except OSError as error:
        raise InputError(
            f"{arg(file)}: the film cannot be written ({arg(error)}): choose a folder that exists and has space."
        ) from error
    finally:
        scratch.unlink(missing_ok=True)
    return shown


def _write_mp4(file: Path, images: Iterator[NDArray[np.uint8]], rate: int) -> None:
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise HeatmapError(
            f"a film as .mp4 needs ffmpeg: {arg(remedy('video'))}, or name a file that ends in .gif."
        ) from error
    file.touch()  # ffmpeg's own words about a folder that is not there are long
    first = next(images)
    # one thread and no date or version in the file: the same frames give the same bytes
    exact = ["-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"]
    writer = imageio_ffmpeg.write_frames(
        str(file),
        (first.shape[1], first.shape[0]),
        fps=rate,
        codec="libx264",
        quality=None,
        macro_block_size=2,
        ffmpeg_log_level="error",
        output_params=["-crf", "20", "-preset", "medium", "-movflags", "+faststart", *exact],
    )
    writer.send(None)
    try:
        writer.send(np.ascontiguousarray(first))
        for image in images:
            writer.send(np.ascontiguousarray(image))
    finally:
        writer.close()


def _write_gif(file: Path, images: Iterator[NDArray[np.uint8]], rate: int) -> None:
    from PIL import Image

    def pages() -> Iterator[Any]:
        for image in images:
            yield Image.fromarray(image).quantize(
                255, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE
            )

    shown = pages()
    first = next(shown)
    with file.open("wb") as stream:
        first.save(
            stream,
            format="GIF",
            save_all=True,
            append_images=shown,
            duration=1000 // rate,
            loop=0,
            disposal=1,
        )


class _Page:
    """What is around the looks: a heading, the scale, and how late it is."""

    def __init__(
        self, playback: Playback, whole: Heatmap, settings: FilmSettings, scale: ColourScale
    ) -> None:
        pixels = settings.pixels
        self._head = 2 * round(_HEAD * pixels / 2)
        self._high = round(HIGH * pixels)
        foot = round(_FOOT * pixels)
        height = self._head + self._high + foot
        self._page = _background(whole, scale, pixels, (2 * pixels, height + height % 2))
        self._duration, self._window = playback.duration, settings.window
        self._counted, self._speed = whole.counted, settings.speed
        self._font = _font(max(10, pixels // 26))

    def drawn(
        self, looks: list[NDArray[np.uint8]], time: float, share: float, contacts: int
    ) -> NDArray[np.uint8]:
        from PIL import Image, ImageDraw

        page = self._page.copy()
        for column, look in enumerate(looks):
            left = column * look.shape[1]
            page[self._head : self._head + self._high, left : left + look.shape[1]] = look
        image = Image.fromarray(page)
        pen, wide = ImageDraw.Draw(image), page.shape[1]
        last = "" if self._window is None else f", last {self._window:g} s"
        pen.text((12, self._head * 0.48), f"{time:.1f} of {self._duration:.1f} s{last}", _INK, self._font)
        said = f"{contacts:,} {self._counted}, {self._speed:g}x"
        pen.text((wide - 12, self._head * 0.48), said, _INK, self._font, anchor="ra")
        bottom = self._head - 6
        pen.rectangle((12, bottom, wide - 13, bottom + 3), _TRACK)
        pen.rectangle((12, bottom, 12 + round(share * (wide - 25)), bottom + 3), _BAR)
        return np.asarray(image, dtype=np.uint8)


def _font(size: int) -> Any:
    import matplotlib as mpl
    from PIL import ImageFont

    return ImageFont.truetype(str(Path(mpl.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"), size)


def _background(whole: Heatmap, scale: ColourScale, pixels: int, size: tuple[int, int]) -> NDArray[np.uint8]:
    """Return heading and scale on white, (h, w, 3); `size` is width and height."""
    import matplotlib as mpl
    from matplotlib.figure import Figure
    from PIL import Image

    side = 4.0  # inches of a look, as in the PNG
    high = size[1] * side / pixels
    style: dict[Any, Any] = {"font.family": ["DejaVu Sans"], "font.size": 11.0, "text.parse_math": False}
    with mpl.rc_context(style), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        figure = Figure(figsize=(2 * side, high), dpi=pixels / side)
        words = f"{whole.title} on {whole.probe.name}"
        figure.text(0.5, 1 - 0.17 / high, words, ha="center", va="center", fontsize=13, color=_INK)
        # its largest value may be in no frame: the scale is that of the film, and says nothing of what is beyond
        _scale(figure, replace(whole, values=np.full(1, scale.top)), scale, (2 * side, high))
        figure.text(0.5, 0.13 / high, _note(whole), ha="center", color=_FAINT, fontsize=9)
        data = BytesIO()
        figure.savefig(data, format="png", facecolor="white")
    image = Image.open(data).convert("RGB")
    return np.asarray(image.resize(size) if image.size != size else image, dtype=np.uint8).copy()
