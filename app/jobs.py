"""Long work beside the window: one worker each, with progress, a way to stop it, and its end told in words."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from PySide6.QtCore import QObject, QThreadPool, QTimer, Signal

# Most work waits for a disk or a device: one per processor, as Qt's own pool has it, would hold up the rest.
_MOST_AT_ONCE = 16
_TELL_S = 0.05  # work that tells of each of a million facets must not fill the event loop


class Job(QObject):
    """
    One piece of long work.

    Attributes
    ----------
    title : str
        What it does, for people.
    share : float
        How far it is, 0 to 1.
    started : float
        `time.monotonic` when it was begun, s.
    stoppable : bool
        Whether `cancel` can have an effect.
    """

    progressed = Signal(float)  # share, 0 to 1
    finished = Signal()  # however it ended
    _returned = Signal(object)
    _errored = Signal(object)

    def __init__(self, title: str, parent: QObject | None = None, *, stoppable: bool = True) -> None:
        super().__init__(parent)
        self.title, self.stoppable = title, stoppable
        self.share = 0.0
        self.started = time.monotonic()
        self._told = 0.0
        self._stop = threading.Event()

    def cancel(self) -> None:
        """Ask it to stop."""
        self._stop.set()

    def cancelled(self) -> bool:
        """Whether it was asked to stop; for the work itself."""
        return self._stop.is_set()

    def progress(self, share: float) -> None:
        """Tell how far it is; for the work itself, in its thread."""
        self.share = share
        now = time.monotonic()
        if share >= 1.0 or now - self._told >= _TELL_S:
            self._told = now
            self.progressed.emit(share)


class _Work:
    """What is done in a thread; what it holds may be widgets, and is let go of in the GUI thread, by `forget`."""

    def __init__(self, job: Job, work: Callable[..., Any]) -> None:
        self._job = job
        self._do: Callable[..., Any] | None = work

    def forget(self) -> None:
        self._do = None

    def run(self) -> None:
        do = self._do
        if do is None:
            return
        try:
            result = do(self._job.progress, self._job.cancelled)
        except Exception as error:  # noqa: BLE001 - handed to whoever started it
            del do
            self._job._errored.emit(error)
        else:
            del do
            self._job._returned.emit(result)


class Jobs(QObject):
    """All long work of a window."""

    started = Signal(object)  # Job
    failed = Signal(object, object)  # Job, exception that nobody took

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._running: dict[Job, object] = {}
        self._pool = QThreadPool(self, maxThreadCount=_MOST_AT_ONCE)
        self.let_gone = False

    @property
    def running(self) -> tuple[Job, ...]:
        """What is under way."""
        return tuple(self._running)

    def start(
        self,
        title: str,
        work: Callable[[Callable[[float], None], Callable[[], bool]], Any],
        done: Callable[[Any], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
    ) -> Job:
        """
        Do something in a thread of its own.

        Parameters
        ----------
        title : str
        work : callable
            Gets `progress(share)` and `cancelled()`; touches no widget.
        done, failed : callable, optional
            Get what it returned or raised, in the GUI thread; without `failed`, the signal tells.
        """
        job = self._job(title, done, failed, stoppable=True)
        self._running[job] = begun = _Work(job, work)
        self.started.emit(job)
        self._pool.start(begun.run)
        return job

    def follow(
        self,
        title: str,
        future: Future[Any],
        done: Callable[[Any], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
    ) -> Job:
        """Show what is done elsewhere, such as at the desk, until it ends; as `start`, without a thread."""
        job = self._job(title, done, failed, stoppable=False)
        self._running[job] = future
        self.started.emit(job)
        future.add_done_callback(lambda ended: _hand_on(job, ended))
        return job

    def let_go(self) -> None:
        """Ask all to stop; how they end is told to nobody, for what they were for is being closed."""
        self.let_gone = True
        for job in self.running:
            job.cancel()

    def wait(self, seconds: float) -> bool:
        """Wait for what runs in workers; False: something still does. Blocks: only at the very end."""
        return self._pool.waitForDone(round(1000 * seconds))

    def _job(
        self,
        title: str,
        done: Callable[[Any], None] | None,
        failed: Callable[[BaseException], None] | None,
        *,
        stoppable: bool,
    ) -> Job:
        job = Job(title, self, stoppable=stoppable)
        ending = _Ending(job, self, done, failed)
        job._returned.connect(ending.returned)  # bound to an object of this thread: called in this thread
        job._errored.connect(ending.errored)
        return job

    def _over(self, job: Job) -> None:
        work = self._running.pop(job, None)
        if isinstance(work, _Work):
            work.forget()
        job.finished.emit()
        job.deleteLater()


class _Ending(QObject):
    """Gets how a job ended, in the thread that started it."""

    def __init__(
        self,
        job: Job,
        jobs: Jobs,
        done: Callable[[Any], None] | None,
        failed: Callable[[BaseException], None] | None,
    ) -> None:
        super().__init__(job)
        self._job, self._jobs, self._done, self._failed = job, jobs, done, failed

    def returned(self, result: object) -> None:
        # In a turn of its own, as a page shows what came: a chart's picture and this one's in one breath are a stall.
        QTimer.singleShot(0, self, lambda: self._take(result))

    def errored(self, error: BaseException) -> None:
        QTimer.singleShot(0, self, lambda: self._tell(error))

    def _take(self, result: object) -> None:
        try:
            if self._done is not None and not self._jobs.let_gone:
                self._done(result)
        finally:
            self._jobs._over(self._job)

    def _tell(self, error: BaseException) -> None:
        try:
            if self._jobs.let_gone:
                return
            if self._failed is not None:
                self._failed(error)
            else:
                self._jobs.failed.emit(self._job, error)
        finally:
            self._jobs._over(self._job)


def _hand_on(job: Job, future: Future[Any]) -> None:
    error = future.exception()
    try:
        if error is not None:
            job._errored.emit(error)
        else:
            job._returned.emit(future.result())
    except RuntimeError:  # the window, and the job with it, was closed meanwhile
        return
