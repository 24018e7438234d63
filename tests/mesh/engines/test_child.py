"""Crashes, kills, cancels and threads: the parent goes on, and no child is left behind."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import trimesh
from waiting import until

from contactbench.pipeline.mesh import MeshError, engines
from contactbench.pipeline.mesh.engines import child as child_module
from contactbench.pipeline.mesh.engines.child import _CHILDREN, Child, run
from contactbench.pipeline.mesh.engines.libraries import Library, Operation
from contactbench.pipeline.mesh.engines.wire import WireMessage

Ball = tuple[np.ndarray, np.ndarray]

# Wraps a ball in far too many facets: takes minutes.
ENDLESS = (0.05, 0.05)


def wrap(vertices: np.ndarray, faces: np.ndarray, **control: object) -> Ball:
    """Wrap coarsely: some milliseconds."""
    return engines.alpha_wrap(vertices, faces, 20.0, 2.0, **control)


def pid_of(library: Library) -> int | None:
    return _CHILDREN[library].pid


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
    child_module.run(Operation.CUT, {"vertices": ball[0], "faces": ball[1] + np.int32(10**8)}, {})


def test_the_second_call_finds_the_engine_warm(ball: Ball) -> None:
    first = wrap(*ball)
    pid = pid_of(Library.MESHLAB)
    second = wrap(*ball)
    assert pid is not None
    assert pid_of(Library.MESHLAB) == pid
    np.testing.assert_array_equal(first[0], second[0])


@pytest.mark.skipif(sys.platform == "win32", reason="names a signal")
def test_an_engine_started_ahead_is_the_one_that_works(ball: Ball) -> None:
    engines.stop_engines()
    engines.start_engine(Operation.ALPHA_WRAP)
    pid = pid_of(Library.MESHLAB)
    assert pid is not None
    engines.start_engine(Operation.ALPHA_WRAP)
    assert len(wrap(*ball)[1]) > 100
    assert pid_of(Library.MESHLAB) == pid


def test_an_engine_that_cannot_be_started_ahead_is_told_by_the_call(
    ball: Ball, monkeypatch: pytest.MonkeyPatch
) -> None:
    engines.stop_engines()
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    engines.start_engine(Operation.ALPHA_WRAP)
    with pytest.raises(engines.EngineError, match="cannot be started"):
        wrap(*ball)


def test_a_crash_is_an_error_that_names_the_engine_and_the_next_call_works(ball: Ball) -> None:
    expected = engines.cut_along_crossings(*ball)
    with pytest.raises(engines.EngineError, match=r"cgal died \(SIG.*1280 facets.*Repair"):
        _crash(ball)
    assert pid_of(Library.CGAL) is None
    np.testing.assert_array_equal(engines.cut_along_crossings(*ball)[0], expected[0])


def test_duplicate_and_degenerate_facets_do_not_take_the_parent_with_them(ball: Ball) -> None:
    faces = np.vstack([ball[1], ball[1], ball[1][:, [0, 0, 1]]])
    try:
        wrap(ball[0], faces)
    except engines.EngineError as error:
        assert "meshlab" in str(error)  # noqa: PT017 -- whether it crashes is the library's affair
    assert len(wrap(*ball)[1]) > 100


@pytest.mark.parametrize("wait", [True, False])
def test_an_engine_killed_while_idle_is_replaced_silently(ball: Ball, wait: bool) -> None:
    wrap(*ball)
    pid = pid_of(Library.MESHLAB)
    assert pid is not None
    os.kill(pid, signal.SIGTERM)
    # Without the wait the child still looks alive, and is gone before it answers.
    if wait:
        until(lambda: _gone(pid))
    assert len(wrap(*ball)[1]) > 100


@pytest.mark.skipif(sys.platform == "win32", reason="names a signal")
def test_an_engine_killed_at_work_is_an_error(ball: Ball) -> None:
    def kill_at_work(fraction: float) -> None:
        pid = pid_of(Library.MESHLAB)
        if fraction > 0 and pid is not None:
            os.kill(pid, signal.SIGKILL)

    with pytest.raises(engines.EngineError, match=r"meshlab died \(SIGKILL, possibly out of memory\)"):
        engines.alpha_wrap(*ball, *ENDLESS, monitor=engines.Monitor(kill_at_work))


def test_cancel_kills_the_child_and_the_next_call_starts_another(ball: Ball) -> None:
    pids: set[int | None] = set()
    told: list[float] = []

    def cancelled() -> bool:
        pids.add(pid_of(Library.MESHLAB))
        return told.count(0.1) > 3

    with pytest.raises(engines.Cancelled, match="meshlab"):
        engines.alpha_wrap(*ball, *ENDLESS, monitor=engines.Monitor(told.append, cancelled))
    pids.discard(None)
    assert pids
    until(lambda: all(_gone(pid) for pid in pids if pid is not None))
    assert told == sorted(told)
    assert len(wrap(*ball)[1]) > 100


def test_cancelled_before_it_began_starts_nothing(ball: Ball) -> None:
    engines.stop_engines()
    with pytest.raises(engines.Cancelled):
        wrap(*ball, monitor=engines.Monitor(cancelled=lambda: True))
    assert pid_of(Library.MESHLAB) is None


def test_a_timeout_is_an_error_that_says_how_long(ball: Ball) -> None:
    wrap(*ball)
    with pytest.raises(engines.EngineError, match=r"longer than 0\.2 s for 'alpha wrap'"):
        engines.alpha_wrap(*ball, *ENDLESS, timeout_s=0.2)


def test_progress_rises_to_one_and_what_it_raises_reaches_the_caller(ball: Ball) -> None:
    told: list[float] = []
    wrap(*ball, monitor=engines.Monitor(told.append))
    assert told[0] == 0
    assert told[-1] == 1
    assert told == sorted(told)

    def fail(_fraction: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        wrap(*ball, monitor=engines.Monitor(fail))
    assert len(wrap(*ball)[1]) > 100


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

    def wrap_for_ever() -> None:
        with pytest.raises(engines.Cancelled):
            engines.alpha_wrap(*ball, *ENDLESS, monitor=engines.Monitor(cancelled=finished.is_set))

    with ThreadPoolExecutor(1) as pool:
        wrapping = pool.submit(wrap_for_ever)
        try:
            assert len(engines.cut_along_crossings(*ball)[1]) == len(ball[1])
            assert not wrapping.done()
        finally:
            finished.set()
        wrapping.result()


def test_a_waiting_thread_can_cancel(ball: Ball) -> None:
    started, finished = threading.Event(), threading.Event()

    def wrap_for_ever() -> None:
        with pytest.raises(engines.Cancelled):
            engines.alpha_wrap(
                *ball, *ENDLESS, monitor=engines.Monitor(lambda _: started.set(), finished.is_set)
            )

    with ThreadPoolExecutor(1) as pool:
        wrapping = pool.submit(wrap_for_ever)
        started.wait(10)
        calls = iter([False, False, True])
        try:
            with pytest.raises(engines.Cancelled):
                wrap(*ball, monitor=engines.Monitor(cancelled=lambda: next(calls)))
            assert not wrapping.done()
        finally:
            finished.set()
        wrapping.result()


def _with_command(monkeypatch: pytest.MonkeyPatch, code: str) -> Child:
    command = [sys.executable, "-c", textwrap.dedent(code)]
    monkeypatch.setattr(child_module, "module_command", lambda *_: command)
    return Child(Library.MESHLAB)


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
        child.call(WireMessage("alpha wrap"))


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
        assert child.call(WireMessage("alpha wrap", {"alpha": 0.5, "offset": 0.1}, arrays)).kind == "done"
    finally:
        child.stop()


@pytest.mark.parametrize("code", ["print('Hello' * 99)", "import sys; sys.exit('no licence')", ""])
def test_a_child_that_makes_no_sense_is_an_error(monkeypatch: pytest.MonkeyPatch, code: str) -> None:
    child = _with_command(monkeypatch, code)
    with pytest.raises(engines.EngineError, match=r"meshlab (died|gave)") as raised:
        child.call(WireMessage("alpha wrap"))
    assert child.pid is None
    assert ("Last output: no licence" in str(raised.value)) == ("licence" in code)


def test_python_that_cannot_be_started_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(child_module, "module_command", lambda *_: ["/nowhere/python"])
    with pytest.raises(engines.EngineError, match="cannot be started"):
        Child(Library.MESHLAB).call(WireMessage("alpha wrap"))


_PARENT = """
import sys, threading
import numpy as np
from contactbench.pipeline.mesh import engines
from contactbench.pipeline.mesh.engines.child import _CHILDREN
from contactbench.pipeline.mesh.engines.libraries import Library
corners = np.array([[0, 0, 0], [99, 0, 0], [0, 99, 0], [0, 0, 99]])
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
engines.alpha_wrap(corners, faces, 50.0, 5.0)
print(_CHILDREN[Library.MESHLAB].pid, flush=True)
if "busy" in sys.argv:
    engines.alpha_wrap(corners, faces, 0.02, 0.02, monitor=engines.Monitor(lambda f: print(f, flush=True)))
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
from contactbench.pipeline.mesh.engines.child import _CHILDREN
from contactbench.pipeline.mesh.engines.libraries import Library
corners = np.array([[0, 0, 0], [99, 0, 0], [0, 99, 0], [0, 0, 99]])
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
engines.alpha_wrap(corners, faces, 50.0, 5.0)
pid = _CHILDREN[Library.MESHLAB].pid
fork = os.fork()
if fork == 0:
    assert _CHILDREN[Library.MESHLAB].pid is None
    engines.alpha_wrap(corners, faces, 50.0, 5.0)
    assert _CHILDREN[Library.MESHLAB].pid != pid
    engines.stop_engines()
    os._exit(0)
assert os.waitstatus_to_exitcode(os.waitpid(fork, 0)[1]) == 0
engines.alpha_wrap(corners, faces, 50.0, 5.0)
assert _CHILDREN[Library.MESHLAB].pid == pid
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_crossings_are_cut_in_one_thread_so_that_the_last_bit_is_the_same_each_time(monkeypatch) -> None:
    monkeypatch.setenv("IGL_NUM_THREADS", "8")
    assert child_module._environment()["IGL_NUM_THREADS"] == "1"


# ---- every operation does what it says -----------------------------------------------------------


def _mesh(vertices: np.ndarray, faces: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(vertices, faces, process=False)


def test_alpha_wrap_takes_absolute_lengths(ball: Ball) -> None:
    open_ball = ball[1][50:]
    vertices, faces = engines.alpha_wrap(ball[0], open_ball, 20.0, 2.0)
    assert _mesh(vertices, faces).is_watertight
    assert np.linalg.norm(vertices, axis=1).max() == pytest.approx(52, abs=0.5)
    finer, _ = engines.alpha_wrap(ball[0], open_ball, 5.0, 2.0)
    assert len(finer) > 1.5 * len(vertices)


@pytest.mark.parametrize("lengths", [(0.0, 1.0), (1.0, -1.0), (float("nan"), 1.0), (1.0, float("inf"))])
def test_alpha_wrap_refuses_lengths_that_are_none(ball: Ball, lengths: tuple[float, float]) -> None:
    with pytest.raises(engines.EngineError, match="give a length above 0"):
        engines.alpha_wrap(*ball, *lengths)


def test_a_refusal_is_told_and_leaves_the_engine_warm(ball: Ball) -> None:
    engines.alpha_wrap(*ball, 20.0, 2.0)
    pid = _CHILDREN[Library.MESHLAB].pid
    beyond = {"vertices": ball[0], "faces": ball[1] + np.int32(1)}
    with pytest.raises(engines.EngineError, match=r"meshlab refused 'alpha wrap'"):
        run(Operation.ALPHA_WRAP, beyond, {"alpha": 20.0, "offset": 1.0})
    assert _CHILDREN[Library.MESHLAB].pid == pid


@pytest.mark.parametrize(
    "operation", [partial(engines.alpha_wrap, alpha=20.0, offset=2.0), engines.cut_along_crossings]
)
def test_what_would_crash_a_library_is_refused_at_the_door(ball: Ball, operation: object) -> None:
    with pytest.raises(MeshError, match="refers to vertex"):
        operation(ball[0], ball[1] + 1)
    holed = ball[0].copy()
    holed[5, 1] = np.nan
    with pytest.raises(MeshError, match="row 5"):
        operation(holed, ball[1])
