"""What a verification found is seen: how far touches were off, whose, and nothing covers anything."""

import numpy as np
import pytest
from PySide6.QtGui import QGuiApplication

from contactbench.pipeline.colour_ramp import ColourScale, colour_ramp
from contactbench.pipeline.mesh.regions.region import Region
from contactbench.widgets.scene import TouchErrors
from contactbench.widgets.scene.contact_layer import magnification
from contactbench.widgets.scene.label_board import BESIDE, Word, label_places

FRONT = np.array([[-0.012, -0.015, 0.015], [0.0, -0.015, 0.03], [0.012, -0.015, 0.045], [0.0, -0.015, 0.05]])
OFF = np.array([[1e-4, 0.0, 0.0], [0.0, 0.0, 2e-4], [-3e-4, 0.0, 0.0], [0.0, 0.0, -1e-4]])


def touches(**more):
    covariances = np.tile(np.diag([4e-10, 1e-14, 1e-10]), (4, 1, 1))
    return TouchErrors(FRONT, FRONT + OFF, covariances, **more)


# ---- where words stand ------------------------------------------------------------------------------


def overlap(one, other):
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


@pytest.mark.parametrize("seed", range(5))
def test_words_cover_no_marker_and_no_other_word(seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform([60, 60], [540, 340], (30, 2))
    words = [Word(x, y, 70.0, 22.0) for x, y in points]
    markers = np.column_stack([points - 5, points + 5])
    found = label_places(words, markers, (600, 400))
    boxes = [(left, top, left + 70, top + 22) for left, top, _ in filter(None, found)]
    assert len(boxes) > 20
    for i, box in enumerate(boxes):
        assert box[0] >= 0 and box[1] >= 0 and box[2] <= 600 and box[3] <= 400  # noqa: PT018
        assert not any(overlap(box, marker) for marker in markers)
        assert not any(overlap(box, other) for other in boxes[:i])


def test_the_first_word_has_its_place_and_one_without_any_is_left_out():
    word = Word(50.0, 50.0, 60.0, 20.0)
    found = label_places([word] * 60, np.zeros((0, 4)), (200, 100))
    assert found[0] == (60.0, 40.0, 0)  # to the right, as one reads
    assert found.count(None) > 40
    assert max(place for _, _, place in filter(None, found)) >= BESIDE


def test_a_word_stays_where_it_stood_as_long_as_it_can():
    word = Word(100.0, 100.0, 40.0, 20.0, last=5)
    assert label_places([word], np.zeros((0, 4)), (300, 300))[0][2] == 5
    letter = Word(100.0, 100.0, 40.0, 20.0, near=True)
    assert label_places([letter], np.array([[60.0, 60.0, 140.0, 140.0]]), (300, 300)) == [None]
    taken = label_places([word], np.array([[0.0, 0.0, 95.0, 300.0]]), (300, 300))
    assert taken[0][2] == 0


def test_names_in_the_view_cover_nothing(bench):
    scene = bench.scene
    scene.show_markers(
        np.tile(FRONT, (3, 1)) + np.repeat([[0, 0, 0], [3e-3, 0, 1e-3], [0, 0, 5e-3]], 4, axis=0)
    )
    bench.settle()
    radius = 0.014 * scene.stage.size / scene.projection().metres_per_pixel
    balls = scene.projection().project(scene._markers._points)[:, :2]
    boxes = []
    for label in scene._markers._labels:
        if label.actor.GetVisibility():
            left, low = label.actor.GetPosition()
            top = scene.projection().height - low - label.height
            boxes.append((left, top, left + label.width, top + label.height))
    assert len(boxes) >= 8
    for i, box in enumerate(boxes):
        assert not any(overlap(box, (*(ball - radius), *(ball + radius))) for ball in balls)
        assert not any(overlap(box, other) for other in boxes[:i])


# ---- errors -----------------------------------------------------------------------------------------


def test_errors_are_drawn_longer_by_a_round_number_and_that_is_said(bench):
    scene = bench.scene
    scene.show_errors(touches())
    times = scene._errors.times
    assert times == magnification(touches().sizes, scene.stage.size)
    assert times in {10.0, 20.0, 50.0, 100.0}
    words = [sign.words for sign in scene.key.signs]
    assert any(f"error, {times:g} times" in word for word in words)
    assert any("95 %" in word for word in words)
    assert scene.key.isVisible()
    assert scene.colour_bar.title == "error, mm"
    assert scene.colour_bar.scale.top == pytest.approx(0.3)
    before = scene.projection().project(FRONT[2:3])[0]
    bench.settle()
    picture = scene.picture()
    end = scene.projection().project(FRONT[2:3] + times * OFF[2:3])[0]
    darkest = 255 * colour_ramp()[-1]
    ratio = scene.stage.ratio
    row, columns = int(before[1]), range(int(min(before[0], end[0])) + 4, int(max(before[0], end[0])) - 4)
    line = picture[row, columns.start : columns.stop].astype(int)
    assert np.abs(line - darkest).max(axis=1).min() < 12 * ratio
    assert (np.abs(line - darkest).max(axis=1) < 60).mean() > 0.7
    scene.show_errors(None)
    assert not scene.key.isVisible()
    assert not scene.colour_bar.isVisible()


@pytest.mark.parametrize(
    ("mm", "times"), [(0.05, 200.0), (0.4, 20.0), (4.0, 2.0), (30.0, 1.0), (0.0, 1000.0)]
)
def test_the_magnification_fits_the_probe(mm, times):
    assert magnification(np.full(5, 1e-3 * mm), 0.08) == times


def test_one_wrong_touch_takes_neither_colours_nor_lengths_from_the_others():
    sizes = np.append(np.full(19, 2e-4), 5e-3)
    off = np.column_stack([sizes, np.zeros((20, 2))])
    found = TouchErrors(np.zeros((20, 3)), off)
    assert found.top == pytest.approx(2e-4)
    assert magnification(sizes, 0.1) * 5e-3 <= 0.04


def test_a_touch_without_an_error_or_a_covariance_is_drawn(bench):
    unknown = TouchErrors(FRONT, FRONT, np.full((4, 3, 3), np.nan), FRONT[:1])
    bench.scene.show_errors(unknown)
    bench.settle()
    words = [sign.words for sign in bench.scene.key.signs]
    assert not any("95 %" in word for word in words)
    assert "possible alternative" in words


@pytest.mark.parametrize(
    "point", [[0.02, 0.0, 0.03], [0.0, 0.015, 0.03], [-0.02, 0.005, 0.01], [0.0, 0.0, 0.06]]
)
def test_the_worst_marker_is_brought_into_view(bench, point):
    scene, point = bench.scene, np.array(point)
    scene.look("front")
    scene.bring_into_view(point)
    assert scene._eye.sees(point)
    assert scene._eye.look.axes[1][2] > 0  # z is up
    places = scene.projection().project(scene.probe_layer.probe.vertices)
    assert (places[:, :2] > 0).all()
    assert (places[:, :2] < [scene.projection().width, scene.projection().height]).all()


# ---- what stands beside -----------------------------------------------------------------------------


@pytest.mark.parametrize("wide", [420, 800])
def test_the_legend_covers_nothing_of_the_view(bench, wide):
    scene = bench.scene
    scene.resize(wide, 380)
    scene.show_errors(touches())
    bench.settle()
    for part in (scene.colour_bar, scene.key):
        assert part.isVisible()
        assert not part.geometry().intersects(scene.view.geometry())
        assert scene.rect().contains(part.geometry())
    assert not scene.colour_bar.geometry().intersects(scene.key.geometry())
    scene.show_errors(None)
    assert scene.view.geometry() == scene.rect()


def test_what_is_beyond_the_last_colour_is_said(bench):
    scene = bench.scene
    values = np.array([1.0, 1, 1, 1, 1, 1, 1, 14.2])
    scene.show_field(values, "peak, N", ColourScale(2.0))
    assert "14.2" in scene.colour_bar.over
    assert "14.2" in scene.colour_bar.accessibleName()
    scene.show_field(values, "peak, N", ColourScale(14.2))
    assert not scene.colour_bar.over


def test_regions_have_their_colours_and_names_on_every_page(bench, make_box):
    scene, box = bench.scene, make_box()
    probe = box.with_region(
        np.where(np.arange(12) == 4, 1, np.where(np.arange(12) == 5, 2, 0)), untouchable=(2,)
    )
    scene.show_probe(probe, regions=(Region("Tip", "#e69f00"), Region("Clamp", "#cc2222", untouchable=True)))
    bench.settle()
    seen = scene.probe_layer._colours
    assert seen[4].tolist() == [0xE6, 0x9F, 0]
    assert seen[5].tolist() == [0xCC, 0x22, 0x22]
    assert [(sign.kind, sign.words) for sign in scene.key.signs] == [
        ("area", "Tip"),
        ("area", "Clamp"),
        ("crossed", "untouchable: crossed"),
    ]
    scene.show_probe(box)
    assert scene.key.signs == ()


def test_the_picture_goes_to_the_clipboard_with_its_legend_and_without_buttons(bench):
    scene = bench.scene
    scene.resize(800, 380)
    scene.show_errors(touches())
    bench.settle()
    scene.copy_picture()
    image = QGuiApplication.clipboard().image()
    ratio = scene.devicePixelRatioF()
    assert (image.width(), image.height()) == (round(800 * ratio), round(380 * ratio))
    bar = scene.colour_bar.geometry()
    column = [image.pixelColor(round((bar.left() + 22) * ratio), y).lightness() for y in range(60, 200, 10)]
    assert max(column) - min(column) > 80  # from light to dark
    corner = scene.buttons.geometry().center()
    assert image.pixelColor(round(corner.x() * ratio), round(corner.y() * ratio)).name() == "#f1f3f5"
    assert scene.buttons.isVisible()
