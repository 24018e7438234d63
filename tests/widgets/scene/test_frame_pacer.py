"""When frames come."""


def test_what_the_window_draws_beside_the_scene_delays_no_frame_of_it(bench, qtbot):
    scene, pacing = bench.scene, bench.scene._pacing
    bench.settle()
    frames = []
    scene.drawn.connect(frames.append)
    pacing._began -= 10.0  # s: nothing has moved since
    for _ in range(20):
        scene.view.frameSwapped.emit()  # as when a chart beside it is drawn
    assert frames == []
    scene.redraw()
    assert pacing._redraw.interval() == 0, (
        "in the next turn, and not after a fifth of the time that nothing moved"
    )
    qtbot.waitUntil(lambda: len(frames) == 1, timeout=20_000)
    assert frames[0] < 10_000.0


def test_a_frame_that_may_wait_lets_keys_come_first_and_paint_does_not_wait(bench, qtbot):
    pacing = bench.scene._pacing
    bench.settle()
    pacing._began -= 10.0
    pacing.redraw()
    assert pacing._redraw.isActive()
    qtbot.waitUntil(lambda: not pacing._redraw.isActive(), timeout=20_000)
    bench.settle()
    pacing.brisk = True
    pacing._began -= 10.0
    pacing.redraw()
    assert not pacing._redraw.isActive(), "the stroke of a brush is seen at once"
    pacing.brisk = False
