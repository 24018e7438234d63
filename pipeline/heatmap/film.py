"""
A heatmap through time as a film: MP4, or an animated GIF.

Drawn without a screen, like the PNG, from the same two sides and on one scale of colours. The rays are cast once, so
that a frame is only its colours. The same contacts give the same bytes with the same libraries.
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.heatmap import picture
from contactbench.pipeline.heatmap.heatmap import Heatmap, HeatmapError
from contactbench.pipeline.heatmap.selection import Playback, Selection, empty_words
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.mesh.engines import NOBODY, Monitor

SUFFIXES = (".mp4", ".gif")
SLOWEST, FASTEST = 0.1, 50.0  # times the real speed
_RATES = {".mp4": 25, ".gif": 10}  # frames a second; a GIF counts in hundredths
_MOST_FRAMES = 15_000  # ten minutes of MP4
_HEAD, _FOOT = 0.17, 0.28  # of a look's width: above and below the looks
_INK, _TRACK, _BAR = (34, 34, 34), (222, 224, 228), (0, 90, 156)


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
    largest = playback.top(selection, settings.window)
    views = [picture.SurfaceView(whole.probe, look, settings.pixels) for look in picture.looks(whole)]
    page = _Page(playback, whole, settings, largest)
    first, last = parts[0].end or 0.0, parts[-1].end or 0.0
    for number, part in enumerate(parts):
        at = part.end or 0.0
        made = playback.heatmap(part)
        looks = [view.drawn(made, largest) for view in views]
        yield (
            (number + 1) / len(parts),
            page.drawn(looks, at, (at - first) / max(last - first, 1e-9), made.contacts),
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

    def __init__(self, playback: Playback, whole: Heatmap, settings: FilmSettings, largest: float) -> None:
        pixels = settings.pixels
        self._head = 2 * round(_HEAD * pixels / 2)
        self._high = round(picture.HIGH * pixels)
        foot = round(_FOOT * pixels)
        height = self._head + self._high + foot
        self._page = _background(whole, largest, pixels, (2 * pixels, height + height % 2))
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


def _background(whole: Heatmap, largest: float, pixels: int, size: tuple[int, int]) -> NDArray[np.uint8]:
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
        figure.text(0.5, 1 - 0.17 / high, words, ha="center", va="center", fontsize=13, color=picture._INK)
        picture._scale(figure, replace(whole, values=_ending(whole.values, largest)), (2 * side, high))
        figure.text(0.5, 0.13 / high, picture._note(whole), ha="center", color=picture._FAINT, fontsize=9)
        data = BytesIO()
        figure.savefig(data, format="png", facecolor="white")
    image = Image.open(data).convert("RGB")
    return np.asarray(image.resize(size) if image.size != size else image, dtype=np.uint8).copy()


def _ending(values: NDArray[np.float64], largest: float) -> NDArray[np.float64]:
    """Return values whose colours end at `largest`: the scale is that of the whole film."""
    return np.where(np.isfinite(values), largest, np.nan)
