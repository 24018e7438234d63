"""How the scene is looked at, and what the mouse does."""

import time

import numpy as np
import pytest
from driving.hand import drop_files, turn_wheel
from PySide6.QtCore import QPoint, QPointF, Qt

from contactbench.widgets.scene.views import SceneLook, Screen, looking, moved, scaled, turned

FRONT = np.array([0.01, -0.015, 0.02])


def wheel(bench, place, notches, modifiers=Qt.KeyboardModifier.NoModifier):
    turn_wheel(bench.scene.view, place, notches, modifiers)


# ---- the camera as a value --------------------------------------------------------------------------


@pytest.mark.parametrize("perspective", [False, True])
def test_a_ray_goes_through_what_is_projected_onto_its_pixel(perspective):
    look = SceneLook((0.3, -0.2, 0.4), (0.01, 0.0, 0.05), (0.0, 0.1, 1.0), 0.08, perspective)
    screen = Screen(look, 640, 480)
    points = np.random.default_rng(0).uniform(-0.05, 0.05, (20, 3))
    for point, (x, y, _) in zip(points, screen.project(points), strict=True):
        begin, end = screen.ray(x, y, 1.0)
        along = (end - begin) / np.linalg.norm(end - begin)
        away = point - begin
        assert np.linalg.norm(away - (away @ along) * along) < 1e-12


def test_turning_keeps_the_distance_and_the_focal_point():
    look = looking("front", (0.0, 0.0, 0.05), 0.05)
    other = turned(look, 0.4, -0.9)
    assert other.focal == look.focal
    assert other.distance == pytest.approx(look.distance)
    assert np.linalg.det(other.axes) == pytest.approx(
        -1.0
    )  # right, up and into the screen: a left-handed triple


@pytest.mark.parametrize("view", ["front", "side", "top", "oblique"])
def test_a_turntable_keeps_z_up(view):
    look = looking(view, (0.0, 0.0, 0.05), 0.05)
    rng = np.random.default_rng(0)
    for right, down in rng.uniform(-2.0, 2.0, (200, 2)):
        look = turned(look, right, down)
        level, up, into = look.axes
        assert abs(level[2]) < 1e-9  # never rolled
        assert up[2] > -1e-9  # never upside down
        assert abs(into[2]) <= 1.0


def test_a_turntable_turns_as_it_is_dragged():
    look = looking("front", (0.0, 0.0, 0.0), 0.05)
    left = turned(look, 0.3, 0.0)  # what is seen goes to the right, so the camera to the left
    assert left.position[0] < -0.01
    assert left.position[2] == pytest.approx(0.0, abs=1e-12)
    down = turned(look, 0.0, 0.3)
    assert down.position[2] == pytest.approx(look.distance * np.sin(0.3))
    steep = turned(look, 0.0, 5.0)
    np.testing.assert_allclose(steep.axes[2], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(steep.axes[0], [1, 0, 0], atol=1e-12)
    quarter = turned(steep, np.pi / 2, 0.0)  # seen from above it turns about z as well
    np.testing.assert_allclose(quarter.axes[0], [0, -1, 0], atol=1e-12)


def test_what_is_dragged_follows_the_pointer():
    look = looking("front", (0.0, 0.0, 0.05), 0.05)
    screen, after = Screen(look, 600, 400), Screen(moved(look, 0.01, 0.02), 600, 400)
    step = after.project(np.zeros(3))[0] - screen.project(np.zeros(3))[0]
    np.testing.assert_allclose(step[:2] * screen.metres_per_pixel, [0.01, 0.02], atol=1e-12)


@pytest.mark.parametrize("perspective", [False, True])
def test_scaling_keeps_what_is_under_the_pointer(perspective):
    look = looking("oblique", (0.0, 0.0, 0.05), 0.05, perspective)
    screen = Screen(look, 600, 400)
    begin, end = screen.ray(450, 120, 1.0)
    along = (end - begin) / np.linalg.norm(end - begin)
    into = look.axes[2]
    point = begin + along * ((np.asarray(look.focal) - begin) @ into) / (along @ into)
    right, up = (450 - 300) * screen.metres_per_pixel, (200 - 120) * screen.metres_per_pixel
    after = Screen(scaled(look, 2.0, right, up), 600, 400)
    np.testing.assert_allclose(after.project(point)[0, :2], [450, 120], atol=1e-6)
    assert after.look.scale == pytest.approx(look.scale / 2)


# ---- the scene --------------------------------------------------------------------------------------


def test_the_camera_comes_back_exactly(bench):
    bench.drag(QPointF(100, 100), QPointF(151, 133))
    camera = bench.scene.camera()
    bench.scene.look("top")
    assert bench.scene.camera() != camera
    bench.scene.set_camera(camera)
    assert bench.scene.camera() == camera
    bench.settle()
    assert bench.scene.camera() == camera


def test_the_view_stays_with_another_probe(bench, make_box):
    camera = bench.scene.camera()
    bench.scene.show_probe(make_box())
    bench.scene.show_probe(None)
    bench.scene.show_probe(make_box())
    assert bench.scene.camera() == camera


@pytest.mark.parametrize("size", [0.02, 0.5])
@pytest.mark.parametrize("perspective", [False, True])
def test_small_and_large_probes_are_wholly_seen(bench, make_box, size, perspective):
    scene = bench.scene
    scene.set_perspective(perspective)
    scene.show_probe(make_box(size))
    for view in ("front", "side", "top", "oblique", "fit"):
        scene.look(view)
        bench.settle()
        corners = scene.probe_layer.probe.vertices
        places = scene.projection().project(corners)
        assert places[:, :2].min() > 0
        assert (places[:, :2] < [scene.projection().width, scene.projection().height]).all()
        seen = np.abs(scene.picture().astype(int) - [0xF1, 0xF3, 0xF5]).max(axis=2) > 40
        x, y = places[:, :2].mean(axis=0).astype(int)
        assert seen[y - 12 : y + 13, x - 12 : x + 13].mean() > 0.5  # a letter with its rim may be there


def test_the_scale_bar_is_as_long_as_it_says(bench):
    scene = bench.scene
    for factor in (1.0, 1.7, 6.3):
        x, y, z = scene.camera()[:3]
        scene.set_camera((x, y, z, (0.05 / factor, 0.0, 0.0)))
        bench.settle()
        bar = scene.scale_bar
        places = scene.projection().project(np.array([[0, 0, 0], [bar.length, 0, 0]]))
        assert bar.pixels * scene.view.devicePixelRatioF() == pytest.approx(places[1, 0] - places[0, 0])
        assert bar.pixels <= bar.width() - 10
        assert bar.text == f"{bar.length * 1e3:g} mm"
    scene.set_perspective(True)
    bench.settle()
    assert not bar.isVisible()


def test_the_buttons_look(bench):
    scene = bench.scene
    with bench.qtbot.waitSignal(scene.camera_moved):
        bench.qtbot.mouseClick(scene.buttons.buttons["top"], Qt.MouseButton.LeftButton)
    into = np.subtract(scene.camera()[1], scene.camera()[0])
    np.testing.assert_allclose(into / np.linalg.norm(into), [0, 0, -1], atol=1e-12)
    assert scene.buttons.geometry().bottom() < scene.height()
    with pytest.raises(ValueError, match="no view 'below'"):
        scene.look("below")


def test_a_click_picks_and_a_drag_does_not(bench):
    scene = bench.scene
    picks = []
    scene.picked.connect(picks.append)
    bench.click(bench.place(FRONT))
    assert [pick.face for pick in picks] == [4]
    np.testing.assert_allclose(picks[0].point, FRONT, atol=2e-4)
    bench.click(QPointF(3, 3))
    bench.drag(bench.place(FRONT), bench.place(FRONT) + QPointF(60, 10))
    assert len(picks) == 1


def test_a_left_drag_turns_and_a_middle_drag_moves(bench):
    scene = bench.scene
    before, moves = scene.camera(), []
    scene.camera_moved.connect(lambda: moves.append(scene.camera()))
    bench.drag(QPointF(200, 200), QPointF(260, 200))
    after = scene.camera()
    assert after[1] == before[1]
    assert after[0] != before[0]
    assert moves[-1] == after
    place = bench.place(FRONT)
    bench.drag(QPointF(200, 200), QPointF(230, 215), Qt.MouseButton.MiddleButton)
    step = bench.place(FRONT) - place
    assert (step.x(), step.y()) == pytest.approx((30, 15), abs=0.5)


def test_moves_of_a_drag_are_taken_together_until_a_frame(bench):
    scene = bench.scene
    moves = []
    scene.camera_moved.connect(lambda: moves.append(1))
    bench.qtbot.mousePress(scene.view, Qt.MouseButton.LeftButton, pos=QPoint(100, 100))
    for i in range(200):
        bench.move(QPointF(100 + i, 100), Qt.MouseButton.LeftButton)
    assert len(moves) == 0
    bench.frame()
    assert len(moves) == 1
    bench.qtbot.mouseRelease(scene.view, Qt.MouseButton.LeftButton, pos=QPoint(299, 100))


def test_the_wheel_scales_about_the_pointer(bench):
    place = bench.place(FRONT)
    scale = bench.scene.camera()[3][0]
    wheel(bench, place, 2)
    assert bench.scene.camera()[3][0] < scale
    after = bench.place(FRONT)
    assert (after.x(), after.y()) == pytest.approx((place.x(), place.y()), abs=0.01)


def test_hovering_tells_the_facet_at_most_so_often(bench):
    hovers = []
    bench.scene.hovered.connect(hovers.append)
    for i in range(50):
        bench.move(bench.place(FRONT) + QPointF(0.1 * i, 0))
    bench.qtbot.waitUntil(lambda: len(hovers) > 0)
    assert len(hovers) <= 3
    assert hovers[-1].face == 4
    bench.move(QPointF(2, 2))
    bench.qtbot.waitUntil(lambda: hovers[-1] is None)


def test_the_brush_paints_with_the_left_button_and_turns_with_the_right(bench):
    scene = bench.scene
    scene.set_tool("brush", 0.005)
    told = []
    scene.brush_began.connect(lambda pick, keys: told.append(("began", pick.face, keys)))
    scene.brush_moved.connect(lambda pick: told.append(("moved", pick and pick.face)))
    scene.brush_ended.connect(lambda: told.append(("ended",)))
    scene.picked.connect(lambda _pick: told.append(("picked",)))
    camera = scene.camera()
    bench.drag(bench.place(FRONT), QPointF(3, 3), steps=30)
    assert told[0] == ("began", 4, Qt.KeyboardModifier.NoModifier)
    assert len([one for one in told if one[0] == "moved"]) == 30  # each of them: a stroke has no gaps
    assert told[-2:] == [("moved", None), ("ended",)]
    assert scene.camera() == camera
    bench.drag(QPointF(3, 3), QPointF(5, 9))
    assert told[-1] == ("ended",)
    assert told.count(("ended",)) == 1  # a stroke beside the probe is none
    bench.drag(bench.place(FRONT), bench.place(FRONT) + QPointF(40, 0), Qt.MouseButton.RightButton)
    assert scene.camera() != camera
    assert len([one for one in told if one[0] == "began"]) == 1


def test_the_brush_s_circle_has_its_radius_on_the_surface(bench):
    scene = bench.scene
    scene.set_tool("brush", 0.006)
    before = scene.picture().astype(int)
    bench.move(bench.place([0.0, -0.015, 0.03]))
    bench.qtbot.waitUntil(lambda: scene._brush._rings[0].shown)
    bench.settle()
    changed = np.abs(scene.picture().astype(int) - before).sum(axis=2) > 100
    columns = np.flatnonzero(changed.any(axis=0))
    per_pixel = scene.projection().metres_per_pixel
    assert np.ptp(columns) * per_pixel == pytest.approx(
        0.012, abs=6 * per_pixel * scene.view.devicePixelRatioF()
    )
    scene.set_tool("turn")
    bench.settle()
    assert np.abs(scene.picture().astype(int) - before).max() <= 2


def test_control_and_the_wheel_scale_the_brush(bench):
    scene = bench.scene
    steps, camera = [], scene.camera()
    scene.brush_scaled.connect(steps.append)
    scene.set_tool("brush", 0.005)
    wheel(bench, QPointF(100, 100), 1, Qt.KeyboardModifier.ControlModifier)
    wheel(bench, QPointF(100, 100), -2, Qt.KeyboardModifier.ControlModifier)
    assert steps == [1, -1, -1]
    assert scene.camera() == camera


def test_a_dropped_file_is_told_and_not_shown(bench, tmp_path):
    path = tmp_path / "probe with ä space.stl"
    path.write_bytes(b"solid")
    with bench.qtbot.waitSignal(bench.scene.dropped) as told:
        drop_files(bench.scene.view, path)
    assert told.args == [path]


def test_frames_come_no_more_often_than_thirty_times_a_second(bench):
    frames = []
    bench.scene.drawn.connect(frames.append)
    begin = time.monotonic()

    def came():
        bench.scene.show_force(np.array([0.0, 0.0, 3.0]))
        return len(frames) >= 8

    bench.qtbot.waitUntil(came, timeout=20_000)
    assert len(frames) <= 2 + 31 * (time.monotonic() - begin)
