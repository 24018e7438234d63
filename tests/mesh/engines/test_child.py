"""Crashes, kills, cancels and threads: the parent goes on, and no child is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from waiting import until

from contactbench.pipeline.mesh import engines
from contactbench.pipeline.mesh.engines import child as child_module
from contactbench.pipeline.mesh.engines.child import Child, Watch
from contactbench.pipeline.mesh.engines.wire import Message

Ball = tuple[np.ndarray, np.ndarray]

# Wraps a ball in far too many facets: takes minutes.
ENDLESS = (0.05, 0.05)


def _gone(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    status = Path(f"/proc/{pid}/stat")
    # A killed process whose new parent does not reap it is gone as well.
    return status.exists() and status.read_text(encoding="utf-8").rsplit(")", 1)[1].split()[0] == "Z"


def _crash(ball: Ball) -> None:
    """A vertex index far out of range, past the functions that would refuse it: the library segfaults."""
    arrays = {"vertices": ball[0], "faces": ball[1] + np.int32(10**8)}
    engines.run(engines.Operation.CUT, arrays, {})


def test_the_second_call_finds_the_engine_warm(ball: Ball) -> None:
    first = engines.orient_facets(*ball)
    pid = engines.engine_pid(engines.Library.MESHLAB)
    second = engines.orient_facets(*ball)
    assert pid is not None
    assert engines.engine_pid(engines.Library.MESHLAB) == pid
    np.testing.assert_array_equal(first[0], second[0])


@pytest.mark.skipif(sys.platform == "win32", reason="names a signal")
def test_a_crash_is_an_error_that_names_the_engine_and_the_next_call_works(ball: Ball) -> None:
    expected = engines.cut_along_crossings(*ball)
    with pytest.raises(engines.EngineError, match=r"cgal died \(SIG.*1280 facets.*repair"):
        _crash(ball)
    assert engines.engine_pid(engines.Library.CGAL) is None
    np.testing.assert_array_equal(engines.cut_along_crossings(*ball)[0], expected[0])


def test_duplicate_and_degenerate_facets_do_not_take_the_parent_with_them(ball: Ball) -> None:
    faces = np.vstack([ball[1], ball[1], ball[1][:, [0, 0, 1]]])
    try:
        engines.self_intersections(ball[0], faces)
    except engines.EngineError as error:
        assert "meshlab" in str(error)  # noqa: PT017 -- whether it crashes is the library's affair
    assert len(engines.orient_facets(*ball)[1]) == len(ball[1])


@pytest.mark.parametrize("wait", [True, False])
def test_an_engine_killed_while_idle_is_replaced_silently(ball: Ball, wait: bool) -> None:
    engines.orient_facets(*ball)
    pid = engines.engine_pid(engines.Library.MESHLAB)
    assert pid is not None
    os.kill(pid, signal.SIGTERM)
    # Without the wait the child still looks alive, and is gone before it answers.
    if wait:
        until(lambda: _gone(pid))
    assert len(engines.orient_facets(*ball)[1]) == len(ball[1])


@pytest.mark.skipif(sys.platform == "win32", reason="names a signal")
def test_an_engine_killed_at_work_is_an_error(ball: Ball) -> None:
    def kill_at_work(fraction: float) -> None:
        pid = engines.engine_pid(engines.Library.MESHLAB)
        if fraction > 0 and pid is not None:
            os.kill(pid, signal.SIGKILL)

    with pytest.raises(engines.EngineError, match=r"meshlab died \(SIGKILL, perhaps for want of memory\)"):
        engines.alpha_wrap(*ball, *ENDLESS, progress=kill_at_work)


def test_cancel_kills_the_child_and_the_next_call_starts_another(ball: Ball) -> None:
    pids: set[int | None] = set()
    told: list[float] = []

    def cancelled() -> bool:
        pids.add(engines.engine_pid(engines.Library.MESHLAB))
        return told.count(0.1) > 3

    with pytest.raises(engines.Cancelled, match="meshlab"):
        engines.alpha_wrap(*ball, *ENDLESS, progress=told.append, cancelled=cancelled)
    pids.discard(None)
    assert pids
    until(lambda: all(_gone(pid) for pid in pids if pid is not None))
    assert told == sorted(told)
    assert len(engines.orient_facets(*ball)[1]) == len(ball[1])


def test_cancelled_before_it_began_starts_nothing(ball: Ball) -> None:
    engines.stop_engines()
    with pytest.raises(engines.Cancelled):
        engines.orient_facets(*ball, cancelled=lambda: True)
    assert engines.engine_pid(engines.Library.MESHLAB) is None


def test_a_timeout_is_an_error_that_says_how_long(ball: Ball) -> None:
    engines.orient_facets(*ball)
    with pytest.raises(engines.EngineError, match=r"longer than 0\.2 s for 'alpha wrap'"):
        engines.alpha_wrap(*ball, *ENDLESS, timeout_s=0.2)


def test_progress_rises_to_one_and_what_it_raises_reaches_the_caller(ball: Ball) -> None:
    told: list[float] = []
    engines.orient_facets(*ball, progress=told.append)
    assert told[0] == 0
    assert told[-1] == 1
    assert told == sorted(told)

    def fail(_fraction: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        engines.orient_facets(*ball, progress=fail)
    assert len(engines.orient_facets(*ball)[1]) == len(ball[1])


def test_threads_get_their_own_results(ball: Ball) -> None:
    sizes = [10.0, 15.0, 20.0, 25.0]
    alone = [engines.alpha_wrap(*ball, size, 1.0) for size in sizes]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda size: engines.alpha_wrap(*ball, size, 1.0), sizes * 3))
    for index, (vertices, faces) in enumerate(together):
        np.testing.assert_array_equal(vertices, alone[index % len(sizes)][0])
        np.testing.assert_array_equal(faces, alone[index % len(sizes)][1])


def test_one_library_works_while_the_other_does(ball: Ball) -> None:
    finished = threading.Event()

    def wrap() -> None:
        with pytest.raises(engines.Cancelled):
            engines.alpha_wrap(*ball, *ENDLESS, cancelled=finished.is_set)

    with ThreadPoolExecutor(1) as pool:
        wrapping = pool.submit(wrap)
        try:
            assert len(engines.cut_along_crossings(*ball)[1]) == len(ball[1])
            assert not wrapping.done()
        finally:
            finished.set()
        wrapping.result()


def test_a_waiting_thread_can_cancel(ball: Ball) -> None:
    started, finished = threading.Event(), threading.Event()

    def wrap() -> None:
        with pytest.raises(engines.Cancelled):
            engines.alpha_wrap(*ball, *ENDLESS, progress=lambda _: started.set(), cancelled=finished.is_set)

    with ThreadPoolExecutor(1) as pool:
        wrapping = pool.submit(wrap)
        started.wait(10)
        calls = iter([False, False, True])
        try:
            with pytest.raises(engines.Cancelled):
                engines.orient_facets(*ball, cancelled=lambda: next(calls))
            assert not wrapping.done()
        finally:
            finished.set()
        wrapping.result()


def _with_command(monkeypatch: pytest.MonkeyPatch, code: str) -> Child:
    command = [sys.executable, "-c", textwrap.dedent(code)]
    monkeypatch.setattr(child_module, "_command", lambda _library: command)
    return Child(engines.Library.MESHLAB)


def test_a_missing_library_is_told_with_the_command_that_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    child = _with_command(
        monkeypatch,
        """
        import sys
        sys.modules["pymeshlab"] = None
        from contactbench.pipeline.mesh.engines.worker import main
        main("meshlab")
        """,
    )
    with pytest.raises(engines.EngineError, match=r"pip install 'contactbench\[meshlab\]'"):
        child.call(Message("orient facets"), Watch())


def test_what_a_library_prints_does_not_reach_the_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    child = _with_command(
        monkeypatch,
        """
        import os, sys
        from contactbench.pipeline.mesh.engines import worker
        perform = worker.perform
        def noisy(*args):
            os.write(1, b"simplified 1 %\\n" * 1000)
            print("done", flush=True)
            return perform(*args)
        worker.perform = noisy
        worker.main("meshlab")
        """,
    )
    arrays = {"vertices": np.eye(3), "faces": np.array([[0, 1, 2]], dtype=np.int32)}
    try:
        assert child.call(Message("self-intersections", {}, arrays), Watch()).kind == "done"
    finally:
        child.stop()


@pytest.mark.parametrize("code", ["print('Hello' * 99)", "import sys; sys.exit('no licence')", ""])
def test_a_child_that_makes_no_sense_is_an_error(monkeypatch: pytest.MonkeyPatch, code: str) -> None:
    child = _with_command(monkeypatch, code)
    with pytest.raises(engines.EngineError, match=r"meshlab (died|gave)") as raised:
        child.call(Message("orient facets"), Watch())
    assert child.pid is None
    assert ("Its last words: no licence" in str(raised.value)) == ("licence" in code)


def test_python_that_cannot_be_started_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(child_module, "_command", lambda _library: ["/nowhere/python"])
    with pytest.raises(engines.EngineError, match="cannot be started"):
        Child(engines.Library.MESHLAB).call(Message("orient facets"), Watch())


def test_a_bundled_application_is_its_own_engine(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, ball: Ball
) -> None:
    app = tmp_path / "app"
    app.write_text(
        f"#!{sys.executable}\n"
        "import sys\n"
        "from contactbench.pipeline.mesh.engines.worker import serve_if_asked\n"
        "serve_if_asked(sys.argv)\n"
        "print('the window opens')\n",
        encoding="utf-8",
    )
    app.chmod(0o755)
    assert subprocess.run([app], capture_output=True, text=True, check=True).stdout == "the window opens\n"
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(sys, "executable", str(app))
    child = Child(engines.Library.MESHLAB)
    arrays = {"vertices": ball[0], "faces": ball[1]}
    try:
        assert len(child.call(Message("orient facets", {}, arrays), Watch()).arrays["faces"]) == len(ball[1])
    finally:
        child.stop()


_PARENT = """
import sys, threading
import numpy as np
from contactbench.pipeline.mesh import engines
corners = np.array([[0, 0, 0], [99, 0, 0], [0, 99, 0], [0, 0, 99]])
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
engines.orient_facets(corners, faces)
print(engines.engine_pid(engines.Library.MESHLAB), flush=True)
if "busy" in sys.argv:
    engines.alpha_wrap(corners, faces, 0.02, 0.02, progress=lambda f: print(f, flush=True))
if "idle" in sys.argv:
    threading.Event().wait()
"""


def _parent(how: str) -> tuple[subprocess.Popen[str], int]:
    parent = subprocess.Popen([sys.executable, "-c", _PARENT, how], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    pid = int(parent.stdout.readline())
    if how == "busy":
        # The library is at work from the second sign of life at 0.1 on.
        while parent.stdout.readline().strip() != "0.1":
            pass
        parent.stdout.readline()
    return parent, pid


@pytest.mark.skipif(not hasattr(os, "O_ASYNC"), reason="the kernel cannot tell a busy process")
@pytest.mark.parametrize("how", ["idle", "busy"])
def test_the_child_goes_when_the_parent_is_killed(how: str) -> None:
    parent, pid = _parent(how)
    with parent:
        parent.kill()
    until(lambda: _gone(pid))


def test_the_child_goes_when_the_parent_exits() -> None:
    parent, pid = _parent("exit")
    with parent:
        assert parent.wait(10) == 0
    until(lambda: _gone(pid))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_forked_process_starts_its_own_engine_and_leaves_its_parents_alone() -> None:
    code = """
import os
import numpy as np
from contactbench.pipeline.mesh import engines
corners = np.array([[0, 0, 0], [99, 0, 0], [0, 99, 0], [0, 0, 99]])
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
engines.orient_facets(corners, faces)
pid = engines.engine_pid(engines.Library.MESHLAB)
fork = os.fork()
if fork == 0:
    assert engines.engine_pid(engines.Library.MESHLAB) is None
    engines.orient_facets(corners, faces)
    assert engines.engine_pid(engines.Library.MESHLAB) != pid
    engines.stop_engines()
    os._exit(0)
assert os.waitstatus_to_exitcode(os.waitpid(fork, 0)[1]) == 0
engines.orient_facets(corners, faces)
assert engines.engine_pid(engines.Library.MESHLAB) == pid
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
