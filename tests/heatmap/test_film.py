"""Films of heatmaps."""

import importlib.util
import itertools
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image, ImageSequence

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.heatmap import HeatmapError, picture
from contactbench.pipeline.heatmap.contacts import Contacts
from contactbench.pipeline.heatmap.picture import FilmSettings, frames, moments, write_film
from contactbench.pipeline.heatmap.selection import Playback, Selection
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.engines import Cancelled, Monitor

SMALL = 120
needs_ffmpeg = pytest.mark.skipif(importlib.util.find_spec("imageio_ffmpeg") is None, reason="no ffmpeg")


@pytest.fixture(scope="module")
def playback():
    from contactbench.assets import make

    probe = Probe.from_arrays(*make("linear", 1_000), name="linear")
    centroids = probe.vertices[probe.faces].mean(axis=1)
    top = np.flatnonzero((probe.normals[:, 2] > 0.3) & (centroids[:, 2] > 0.1))
    at = centroids[top[np.argsort(centroids[top, 0])]]
    count = len(at)
    found = Contacts(at, np.full(count, 0.1), np.full(count, 1e-3), np.linspace(1, 9, count), 4.0, {})
    return Playback(probe, replace(found, times=np.linspace(0, 4, count)), 0.003)


def test_a_look_is_drawn_with_any_end_of_its_colours(playback):
    whole = playback.heatmap(Selection("force"))
    view = picture.SurfaceView(whole.probe, picture.looks(whole)[0], SMALL)
    assert np.array_equal(view.drawn(whole, whole.scale), view.drawn(whole))
    assert not np.array_equal(view.drawn(whole, ColourScale(2 * whole.scale.top)), view.drawn(whole))


def test_moments_follow_the_speed_and_the_window(playback):
    parts = moments(playback, Selection(start=1.0, end=3.0), FilmSettings(2.0, 0.5), 10)
    assert [part.end for part in parts] == pytest.approx(np.arange(1.0, 3.01, 0.2))
    assert [part.start for part in parts] == pytest.approx(np.maximum(np.arange(1.0, 3.01, 0.2) - 0.5, 1.0))
    stays = moments(playback, Selection(), FilmSettings(4.0), 10)
    assert {part.start for part in stays} == {0.0}
    assert stays[-1].end == 4.0


@pytest.mark.parametrize(
    ("selection", "settings", "words"),
    [
        (Selection(), FilmSettings(0.01), "choose 0.1 to 50"),
        (Selection(), FilmSettings(1.0, 0.0), "more than 0 s"),
        (Selection(start=50.0), FilmSettings(), "no contact from 50 s on"),
        (Selection(start=2.0, end=2.0), FilmSettings(), "no contact"),
        (Selection("error"), FilmSettings(), "touched points"),
    ],
)
def test_what_makes_no_film_is_refused(playback, tmp_path, selection, settings, words):
    with pytest.raises(HeatmapError, match=words):
        write_film(tmp_path / "a.gif", playback, selection, settings)
    assert not list(tmp_path.iterdir())


def test_a_gif_moves_and_is_the_same_twice(playback, tmp_path):
    settings, shares = FilmSettings(10.0, 0.5, SMALL), []
    for name in ("a.gif", "b.gif"):
        count = write_film(
            tmp_path / name, playback, Selection("force"), settings, monitor=Monitor(shares.append)
        )
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()
    assert shares[:count] == pytest.approx(np.arange(1, count + 1) / count)
    with Image.open(tmp_path / "a.gif") as image:
        shown = [np.asarray(each.convert("RGB")).astype(int) for each in ImageSequence.Iterator(image)]
    assert len(shown) == count == 5
    middle = slice(30, 30 + round(0.78 * SMALL))
    assert all(np.abs(a[middle] - b[middle]).max() > 50 for a, b in itertools.pairwise(shown))


@needs_ffmpeg
def test_an_mp4_is_read_back_and_is_the_same_twice(playback, tmp_path):
    import imageio_ffmpeg

    settings = FilmSettings(20.0, None, SMALL)
    for name in ("a.mp4", "b.mp4"):
        count = write_film(tmp_path / name, playback, Selection(), settings)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    first = next(image for _, image in frames(playback, Selection(), settings, 25))
    read = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(tmp_path / "a.mp4")]
    done = subprocess.run(
        [*read, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True
    )
    shown = np.frombuffer(done.stdout, np.uint8).reshape(-1, *first.shape).astype(int)
    assert len(shown) == count == 6
    assert np.abs(shown[0] - first).mean() < 3


def test_a_film_without_ffmpeg_says_what_to_do(playback, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(HeatmapError, match=r"contactbench\[video\]"):
        write_film(tmp_path / "a.mp4", playback, Selection(), FilmSettings(50.0, None, SMALL))
    assert not list(tmp_path.iterdir())


def test_a_film_that_was_stopped_leaves_what_was_there(playback, tmp_path):
    file = tmp_path / "a.gif"
    file.write_bytes(b"before")
    asked = iter([False, False, True])
    monitor = Monitor(cancelled=lambda: next(asked, True))
    with pytest.raises(Cancelled):
        write_film(file, playback, Selection(), FilmSettings(5.0, None, SMALL), monitor=monitor)
    assert file.read_bytes() == b"before"
    assert [each.name for each in tmp_path.iterdir()] == ["a.gif"]


def test_a_place_that_is_not_there_is_said(playback, tmp_path):
    for name in ("a.gif", "a.mp4"):
        if name == "a.mp4" and importlib.util.find_spec("imageio_ffmpeg") is None:
            continue
        with pytest.raises(InputError, match="choose a folder that exists"):
            write_film(tmp_path / "no" / name, playback, Selection(), FilmSettings(50.0, None, SMALL))
    with pytest.raises(HeatmapError, match=r"must end in \.mp4 or \.gif"):
        write_film(tmp_path / "a.avi", playback, Selection())
