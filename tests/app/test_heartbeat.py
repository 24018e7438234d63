import time

from waiting import be_slow

from contactbench.app.heartbeat import Heartbeat


def test_a_stall_is_measured_and_told(qtbot):
    heart = Heartbeat()
    heart.start()
    qtbot.waitUntil(lambda: heart.stalls().beats > 3, timeout=10_000)
    heart.restart()
    with qtbot.waitSignal(heart.stalled, timeout=10_000) as stalled:
        be_slow(0.25)
    assert stalled.args[0] >= 0.2
    assert heart.stalls().longest >= 0.2
    assert heart.stalls().worked < 0.2, "asleep is not at work"
    spent = time.thread_time()
    while time.thread_time() < spent + 0.15:
        pass
    qtbot.waitUntil(lambda: heart.stalls().worked >= 0.14, timeout=10_000)
    heart.stop()


def test_nothing_measured_is_no_stall(qapp):  # noqa: ARG001
    assert Heartbeat().stalls().longest == 0.0
