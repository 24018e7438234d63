import threading
import warnings
from concurrent.futures import Future

import pytest
from PySide6.QtCore import QObject

from contactbench.app.jobs import Jobs


@pytest.fixture
def jobs(qapp):  # noqa: ARG001 - for what it does
    made = Jobs()
    yield made
    assert made.wait(10)


def test_work_is_done_elsewhere_and_its_end_told_here(qtbot, jobs):
    got = []
    jobs.start(
        "Work",
        lambda _p, _c: threading.current_thread(),
        lambda thread: got.append((thread, threading.current_thread())),
    )
    qtbot.waitUntil(lambda: bool(got) and not jobs.running, timeout=10_000)
    assert got[0][0] is not threading.main_thread()
    assert got[0][1] is threading.main_thread()


def test_progress_and_cancel(qtbot, jobs):
    shares, ends = [], []

    def work(progress, cancelled):
        progress(0.25)
        while not cancelled():
            threading.Event().wait(0.005)
        return "stopped"

    job = jobs.start("Work", work, ends.append)
    job.progressed.connect(shares.append)
    qtbot.waitUntil(lambda: job.share == 0.25, timeout=10_000)
    job.cancel()
    qtbot.waitUntil(lambda: ends == ["stopped"], timeout=10_000)


@pytest.mark.parametrize("error", [ValueError("no"), RuntimeError("no"), OSError("no")])
def test_what_it_raises_is_told(qtbot, jobs, error):
    def work(_progress, _cancelled):
        raise error

    got = []
    jobs.start("Work", work, None, got.append)
    qtbot.waitUntil(lambda: got == [error], timeout=10_000)
    jobs.failed.connect(lambda job, what: got.append((job.title, what)))
    jobs.start("Other work", work)
    qtbot.waitUntil(lambda: got[1:] == [("Other work", error)], timeout=10_000)
    qtbot.waitUntil(lambda: not jobs.running, timeout=10_000)


def test_more_work_than_processors_goes_on_at_once(qtbot, jobs):
    together = threading.Barrier(8)
    got = []
    for _ in range(8):
        jobs.start("Work", lambda _p, _c: together.wait(10), got.append)
    qtbot.waitUntil(lambda: len(got) == 8, timeout=15_000)


def test_warnings_of_others_are_left_alone(qtbot, jobs):
    before, shower = list(warnings.filters), warnings.showwarning
    first, second = threading.Event(), threading.Event()
    jobs.start("One", lambda _p, _c: first.wait(10))
    jobs.start("Two", lambda _p, _c: second.wait(10))
    first.set()
    second.set()
    qtbot.waitUntil(lambda: not jobs.running, timeout=10_000)
    assert (list(warnings.filters), warnings.showwarning) == (before, shower)


def test_what_is_done_elsewhere_is_followed(qtbot, jobs):
    future, got = Future(), []
    job = jobs.follow("Writing", future, got.append)
    assert jobs.running == (job,)
    assert not job.stoppable
    threading.Thread(target=future.set_result, args=(7,)).start()
    qtbot.waitUntil(lambda: got == [7] and not jobs.running, timeout=10_000)


def test_a_future_that_ends_after_the_window_is_no_fault(qapp):  # noqa: ARG001
    from shiboken6 import delete

    jobs, future = Jobs(), Future()
    jobs.follow("Writing", future)
    delete(jobs)
    future.set_result(1)


def test_nothing_of_qt_that_lives_in_a_thread_is_freed_with_a_worker(qtbot, jobs):
    begun, go_on = threading.Event(), threading.Event()
    jobs.start("Work", lambda _p, _c: begun.set() or go_on.wait(5))
    assert begun.wait(5)
    (worker,) = jobs._running.values()
    assert not [
        held for held in vars(worker).values() if isinstance(held, QObject) and held is not worker._job
    ]
    del worker
    go_on.set()
    qtbot.waitUntil(lambda: not jobs.running, timeout=10_000)


def test_what_ends_after_all_was_let_go_is_told_to_nobody(qtbot, jobs):
    """Its page pushes what came to a session that is closed: an error at every quick leave."""
    go_on, got = threading.Event(), []

    def fail(_progress, _cancelled):
        go_on.wait(10)
        raise ValueError("late")

    jobs.failed.connect(lambda *_: got.append("failed"))
    job = jobs.start("Work", lambda _p, _c: go_on.wait(10), got.append)
    jobs.start("Other work", fail)
    jobs.let_go()
    assert job.cancelled()
    go_on.set()
    qtbot.waitUntil(lambda: not jobs.running, timeout=10_000)
    assert got == []
