"""What is drawn is seen where it should be."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.widgets.theme import colours

RED, GREEN = np.array([[220, 20, 20]], np.uint8), np.array([[20, 200, 20]], np.uint8)
# The front of the box: facets 4 and 5, y = -0.015.
LOWER, UPPER = [0.01, -0.015, 0.02], [-0.01, -0.015, 0.045]


def reddish(colour):
    return colour[0] > 100 and colour[0] > 2 * colour[1] and colour[0] > 2 * colour[2]


def greyish(colour):
    return colour.min() > 90 and np.ptp(colour) < 25


def test_a_probe_without_colours_is_light_grey(bench):
    assert greyish(bench.colour(LOWER))
    assert greyish(bench.colour(UPPER))


def test_a_painted_facet_has_its_colour_and_its_neighbour_keeps_it(bench):
    bench.scene.paint(np.array([4], np.int32), RED)
    bench.settle()
    assert reddish(bench.colour(LOWER))
    assert greyish(bench.colour(UPPER))
    bench.scene.paint(np.array([5], np.int32), GREEN)
    bench.settle()
    assert reddish(bench.colour(LOWER))
    green = bench.colour(UPPER)
    assert green[1] > 2 * green[0]


def test_paint_survives_a_turn_of_the_camera(bench):
    bench.scene.paint(np.array([4], np.int32), RED)
    bench.scene.look("side")
    bench.settle()
    bench.scene.look("front")
    bench.settle()
    assert reddish(bench.colour(LOWER))


def test_painting_all_replaces_all(bench):
    bench.scene.paint(np.array([4], np.int32), RED)
    bench.scene.paint(None, np.full((12, 3), 200, np.uint8))
    bench.settle()
    assert greyish(bench.colour(LOWER))


def test_the_kept_picture_is_the_drawn_one(bench):
    bench.scene.paint(np.array([4], np.int32), RED)
    bench.settle()
    kept = bench.scene.picture().astype(int)
    bench.scene._still.forget()
    bench.settle()
    assert np.abs(kept - bench.scene.picture()).max() <= 2


def test_a_painted_facet_lies_before_the_far_side_and_behind_the_near_one(bench):
    bench.scene.paint(np.array([8, 9], np.int32), RED)  # the back
    bench.settle()
    assert greyish(bench.colour(LOWER))


def test_what_is_painted_under_a_field_is_seen_after_it(bench):
    bench.scene.show_field(np.full(8, np.nan), "Nothing")
    bench.scene.paint(np.array([4], np.int32), RED)
    bench.settle()
    assert greyish(bench.colour(LOWER))
    bench.scene.show_field(None)
    bench.settle()
    assert reddish(bench.colour(LOWER))


def test_a_field_has_the_colours_of_its_ends_and_a_bar(bench):
    values = bench.scene.probe_layer.probe.vertices[:, 2] * 1e3
    bench.scene.show_field(values, "Height, mm")
    bench.settle()
    low, high = bench.colour([0.01, -0.015, 0.002]), bench.colour([0.01, -0.015, 0.058])
    assert greyish(low)  # zero is the surface itself
    assert high.max() < 0.5 * low.max()  # dark violet
    assert high[0] > 1.5 * high[1]
    assert bench.scene.colour_bar.isVisible()
    assert bench.scene.colour_bar.scale == ColourScale(60.0)
    bench.scene.show_field(None)
    bench.settle()
    assert greyish(bench.colour(LOWER))
    assert not bench.scene.colour_bar.isVisible()


def test_unknown_values_of_a_field_stay_plain(bench):
    bench.scene.show_field(np.full(8, np.nan), "Nothing")
    bench.settle()
    assert greyish(bench.colour(LOWER))


def test_invented_facets_are_hatched(bench):
    probe = bench.scene.probe_layer.probe
    before = bench.scene.picture().astype(int)
    bench.scene.show_probe(probe.with_invented(np.arange(12) == 4))
    bench.settle()
    bench.settle()
    ratio = bench.scene.stage.ratio
    a, b = bench.place([0.0185, -0.015, 0.003]) * ratio, bench.place([0.0, -0.015, 0.02]) * ratio
    darker = before.sum(axis=2) - bench.scene.picture().astype(int).sum(axis=2) > 100
    part = darker[int(b.y()) : int(a.y()), int(b.x()) : int(a.x())]
    assert 0.05 < part.mean() < 0.7


def dark_share(bench, before, low, high):
    """Return the share of a part of the front that has become darker."""
    ratio = bench.scene.stage.ratio
    a, b = bench.place(low) * ratio, bench.place(high) * ratio
    darker = before.sum(axis=2) - bench.scene.picture().astype(int).sum(axis=2) > 100
    return darker[int(b.y()) : int(a.y()), int(a.x()) : int(b.x())].mean()


def test_untouchable_facets_are_crossed_out(bench):
    probe = bench.scene.probe_layer.probe
    before = bench.scene.picture().astype(int)
    front = [-0.015, -0.015, 0.005], [0.015, -0.015, 0.055]
    region = np.where(np.isin(np.arange(12), (4, 5)), 2, 1)
    plain = np.full((12, 3), 200, np.uint8)
    bench.scene.show_probe(probe.with_region(region, untouchable=(2,)), plain)
    bench.settle()
    bench.settle()
    crossed = dark_share(bench, before, *front)
    assert 0.05 < crossed < 0.8
    bench.scene.show_untouchable(np.array([4], np.int32))  # half of it
    bench.settle()
    assert dark_share(bench, before, *front) == pytest.approx(crossed / 2, rel=0.25)
    bench.scene.show_untouchable(np.array([], np.int32))
    bench.settle()
    assert dark_share(bench, before, *front) < 0.01


def test_edges_are_smooth_once_all_is_at_rest(bench):
    if not bench.scene.view.software:
        pytest.skip("a graphics card smooths the edges of every frame")
    bench.scene.look("oblique")
    bench.frame()
    moving = bench.scene.picture().astype(int)
    bench.settle()
    changed = np.abs(bench.scene.picture().astype(int) - moving).max(axis=2) > 8
    assert 50 < changed.sum() < 0.05 * changed.size  # edges, and nothing else


def test_where_it_could_be_as_well_is_a_hollow_ring_with_words(bench):
    scene = bench.scene
    point, rival = np.array([0.01, -0.015, 0.03]), np.array([-0.012, -0.015, 0.045])
    scene.show_contact(point, np.eye(3) * 1e-8, np.array([0.0, -1.0, 0.0]))
    bench.settle()
    before = scene.picture().astype(int)
    scene.show_contact(
        point, np.eye(3) * 1e-8, np.array([0.0, -1.0, 0.0]), rival[None], ("here too", "behind")
    )
    bench.settle()
    changed = np.abs(scene.picture().astype(int) - before).sum(axis=2) > 100
    place = bench.place(rival) * scene.stage.ratio
    x, y = int(place.x()), int(place.y())
    assert not changed[y - 1 : y + 2, x - 1 : x + 2].any()  # hollow
    assert changed[y, x - 40 : x].any()
    assert changed[y - 40 : y, x + 14 :].sum() > 200  # the words
    assert scene._contact._caption._drawn[0] == "here too"
    scene.show_contact(point, None, None, rival[None] * [1, -1, 1], ("here too", "behind"))
    bench.settle()
    assert scene._contact._caption._drawn[0] == "behind"
    scene.show_contact(None)
    bench.settle()
    assert not scene._contact._caption.actor.GetVisibility()


def test_the_contact_is_as_large_as_its_doubt(bench):
    scene = bench.scene
    point = np.array([0.0, -0.015, 0.03])
    covariance = np.diag([0.003**2, 1e-12, 0.0015**2])
    before = scene.picture().astype(int)
    scene.show_contact(point, covariance, np.array([0.0, -1.0, 0.0]))
    bench.settle()
    changed = np.abs(scene.picture().astype(int) - before).sum(axis=2) > 40
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    per_pixel = scene.projection().metres_per_pixel
    assert np.ptp(columns) * per_pixel == pytest.approx(
        2 * 0.003 * np.sqrt(5.991), abs=4 * per_pixel * scene.stage.ratio
    )
    assert np.ptp(rows) * per_pixel == pytest.approx(
        2 * 0.0015 * np.sqrt(5.991), abs=4 * per_pixel * scene.stage.ratio
    )
    scene.show_contact(None)
    bench.settle()
    assert np.abs(scene.picture().astype(int) - before).max() <= 2


def test_the_force_is_five_millimetres_a_newton_and_ends_at_its_point(bench):
    scene = bench.scene
    before = scene.picture().astype(int)
    scene.show_force(np.array([-3.0, 0.0, 0.0]), np.array([0.02, 0.0, 0.03]))
    bench.settle()
    changed = np.abs(scene.picture().astype(int) - before).sum(axis=2) > 40
    columns = np.flatnonzero(changed.any(axis=0))
    per_pixel = scene.projection().metres_per_pixel
    assert np.ptp(columns) * per_pixel == pytest.approx(0.015, abs=3 * per_pixel * scene.stage.ratio)
    tip = bench.place([0.02, 0.0, 0.03]).x() * scene.stage.ratio
    assert columns[0] == pytest.approx(tip, abs=3 * scene.stage.ratio)
    scene.show_force(None)
    bench.settle()
    assert np.abs(scene.picture().astype(int) - before).max() <= 2


def test_the_tool_turns_with_its_orientation_and_so_does_what_is_picked(bench):
    scene = bench.scene
    scene.paint(np.array([6, 7], np.int32), RED)  # the side, x = 0.02
    scene.show_orientation(Rotation.from_euler("z", -90, degrees=True).as_matrix())
    scene.look("fit")
    bench.settle()
    assert reddish(bench.colour([0.02, 0.004, 0.02]))
    pick = scene.pick_at(bench.place([0.02, 0.004, 0.02]))
    assert pick.face in (6, 7)
    np.testing.assert_allclose(pick.point, [0.02, 0.004, 0.02], atol=1e-6)
    scene.show_orientation(None)
    scene.look("front")
    bench.settle()
    assert greyish(bench.colour(LOWER))


def test_a_ghost_and_a_phantom_are_seen_through(bench):
    scene = bench.scene
    before = bench.colour(LOWER)
    scene.show_phantom(np.array([0.0, -0.02, 0.03]), np.array([0.0, -1.0, 0.0]))
    bench.settle()
    with_plane = bench.colour(LOWER)
    assert 10 < np.abs(with_plane - before).max() < 150
    scene.show_phantom(None)
    scene.show_ghost(Rotation.from_euler("y", 90, degrees=True).as_matrix())
    bench.settle()
    outside = bench.colour([0.045, 0.0, 0.003])
    assert np.abs(outside - [0xF1, 0xF3, 0xF5]).max() > 10
    scene.show_ghost(None)
    bench.settle()
    np.testing.assert_allclose(bench.colour(LOWER), before, atol=2)


def test_a_marker_is_seen_named_and_signed(bench):
    scene = bench.scene
    points = np.array([LOWER, UPPER, [0.0, 0.015, 0.03]])
    scene.show_markers(points, ["A", "B", "C"], ["done", "open", "failed"], 1)
    bench.settle()
    assert not greyish(bench.colour(LOWER))
    layer = scene._markers
    assert [label._drawn[0] for label in layer._labels] == ["A ✓", "▸ B", "C ✗"]
    shown = [bool(label.actor.GetVisibility()) for label in layer._labels]
    assert shown == [True, True, False]  # C is on the far side
    scene.show_markers(np.zeros((0, 3)))
    bench.settle()
    assert greyish(bench.colour(LOWER))


def test_the_next_marker_pulses_only_while_there_is_one_and_it_is_seen(bench):
    scene = bench.scene
    scene.show_markers(np.array([LOWER]), ["A"], ["open"], 0)
    assert scene._pacing._pulse.isActive()
    scene.hide()
    assert not scene._pacing._pulse.isActive()
    scene.show()
    assert scene._pacing._pulse.isActive()
    scene.show_markers(np.array([LOWER]), ["A"], ["done"], None)
    assert not scene._pacing._pulse.isActive()


def test_an_overlay_is_seen_through(bench):
    probe = bench.scene.probe_layer.probe
    from contactbench.pipeline.mesh import Probe

    bench.scene.show_overlay(Probe.from_arrays(probe.vertices * 1.2, probe.faces))
    bench.settle()
    outside = bench.colour([0.022, 0.0, 0.03])
    assert np.abs(outside - [0xF1, 0xF3, 0xF5]).max() > 10
    bench.scene.show_overlay(None)
    bench.settle()
    np.testing.assert_allclose(bench.colour([0.022, 0.0, 0.03]), [0xF1, 0xF3, 0xF5], atol=3)


@pytest.mark.parametrize("dark", [False, True])
def test_the_ground_has_the_theme_s_colour(bench, dark):
    bench.scene.set_dark(dark)
    bench.settle()
    wanted = colours(dark).background
    corner = bench.scene.picture()[5, 5]
    assert corner.tolist() == [int(wanted[i : i + 2], 16) for i in (1, 3, 5)]
