"""Probes of many facets, screens of many pixels: nothing is drawn anew that need not be."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.window.balls import ball, measure

from contactbench.pipeline.colour_ramp import ColourScale, round_length
from contactbench.widgets.scene import Scene
from contactbench.widgets.scene.smooth import hatch_segments
from contactbench.widgets.scene.stage import thinned


@pytest.mark.alone
def test_the_benchmark_says_that_painting_in_place_is_cheaper(qtbot):  # noqa: ARG001 - an application
    paint_share, pick_ms = measure(40_000, times=3)
    assert paint_share < 0.8
    assert pick_ms < 5.0


def test_a_likeness_stands_in_while_the_camera_moves_and_no_longer(qtbot):
    scene = Scene()
    scene.resize(300, 260)
    scene.show()
    scene.show_probe(ball(40_000))
    layer = scene.probe_layer
    qtbot.waitUntil(lambda: not scene._pacing.waiting and not scene.ahead.busy, timeout=20_000)
    if not scene.view.software:
        pytest.skip("a graphics card draws all facets at any time")
    scene.look("front")
    assert layer.coarse
    assert not layer.surface.shown
    copied: list[object] = []
    copy = scene._still._copy
    scene._still._copy = lambda *what: (copied.append(what), copy(*what))  # type: ignore[method-assign]
    frames: list[float] = []
    scene.drawn.connect(frames.append)
    qtbot.waitUntil(lambda: bool(frames), timeout=20_000)
    assert layer.coarse
    assert not copied, "no picture is kept of what the next frame shows from elsewhere"
    scene.show_probe(ball(50_000))
    assert layer.coarse, "another probe's likeness is not waited for while all moves"
    qtbot.waitUntil(lambda: layer.surface.shown, timeout=20_000)
    assert not layer.coarse
    qtbot.waitUntil(lambda: bool(copied), timeout=20_000)
    scene.close_scene()
    scene.close()
    scene.deleteLater()


def test_a_likeness_has_few_facets_near_the_surface():
    probe = ball(60_000)
    vertices, faces, kept = thinned(probe.vertices, probe.faces)
    assert 2_000 < len(faces) < 40_000
    assert len(kept) == len(faces)
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 0.04, atol=1e-6)


def test_hatching_lies_on_its_facets_at_its_spacing():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    lines = hatch_segments(vertices, np.array([[0, 1, 2]]), 0.1)
    assert len(lines) % 2 == 0
    assert len(lines) / 2 == 7  # x + y = 0.1414 k, up to 1
    np.testing.assert_allclose(lines[:, 2], 0.0)
    total = lines.sum(axis=1)
    np.testing.assert_allclose(total[::2], total[1::2])
    assert len(hatch_segments(vertices, np.zeros((0, 3), int), 0.1)) == 0


@pytest.mark.parametrize(("low", "high"), [(0.0, 60.0), (-0.3, 0.7), (1e-4, 1.3e-4), (5.0, 5.001)])
def test_ticks_are_few_round_and_inside(low, high):
    values = ColourScale(high, low).ticks()
    assert 2 <= len(values) <= 7
    assert min(values) >= low - 1e-12
    assert max(values) <= high + 1e-12


def test_a_round_length_is_one_two_or_five():
    assert [round_length(x) for x in (0.0123, 0.02, 0.049, 7.0)] == pytest.approx([0.01, 0.02, 0.02, 5.0])


@pytest.mark.alone
def test_on_a_screen_of_twice_the_pixels_all_is_in_its_place():
    if "QT_SCALE_FACTOR" in os.environ:
        pytest.skip("this is that screen")
    here = Path(__file__).parent
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    command += ["-k", "click_picks or brush_s_circle", str(here / "test_looking.py")]
    done = subprocess.run(
        command, env=os.environ | {"QT_SCALE_FACTOR": "2"}, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout[-2000:]
    assert " passed" in done.stdout
