"""When frames come."""

from __future__ import annotations


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
    assert not pacing._redraw.isActive(), (
        "it is drawn at once, and not after a fifth of the time that nothing moved"
    )
    qtbot.waitUntil(lambda: len(frames) == 1, timeout=20_000)
    assert frames[0] < 10_000.0
