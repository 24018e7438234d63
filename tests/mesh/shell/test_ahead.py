"""Work that is begun ahead gives its result when it is asked for, and ends when it is not."""

from __future__ import annotations

import threading

import pytest

from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.mesh.shell.shell import begun


def nothing() -> None:
    """Tell nobody."""


def test_it_runs_beside_the_block():
    met = threading.Barrier(2, timeout=30)
    with begun(lambda _stop: met.wait() >= 0, nothing) as result:
        met.wait()
        assert result() is True


def test_what_is_not_asked_for_is_told_to_stop_and_its_error_is_nobodys():
    ended = threading.Event()
    once = threading.Event()

    def work(stop):
        once.set()
        while not stop():
            pass
        ended.set()
        raise ValueError

    with begun(work, nothing):
        once.wait(30)
    assert ended.is_set()


def test_who_waits_may_cancel():
    def work(stop):
        while not stop():
            pass

    def cancel():
        raise Cancelled("enough")

    with pytest.raises(Cancelled, match="enough"), begun(work, cancel) as result:
        result()


def test_what_it_raises_reaches_who_waits():
    def work(_stop):
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"), begun(work, nothing) as result:
        result()


def test_it_can_wait_until_it_is_asked_for():
    done = []
    with begun(done.append, nothing, at_once=False):
        pass
    assert not done
    with begun(lambda _stop: done.append(1), nothing, at_once=False) as result:
        assert not done
        result()
    assert done == [1]
