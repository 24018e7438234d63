"""One piece of work on the probe at a time: begun, followed, stopped, and its end taken only if it still matters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QCoreApplication, QObject

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.workbench.steps import Step

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.bench import Bench
    from contactbench.app.jobs import Job
    from contactbench.app.pages.probe_sections import NextBar


class Worker(QObject):
    """
    Runs what takes long; beginning something else stops what ran before.

    Parameters
    ----------
    bench : Bench
    bar : NextBar
        Shows what runs, how far it is, and stops it.
    wrong : callable
        Gets the sentence of what went wrong.
    ended : callable
        Called after everything else, however it ended.
    """

    def __init__(
        self, bench: Bench, bar: NextBar, wrong: Callable[[str], None], ended: Callable[[], None]
    ) -> None:
        super().__init__(bar)
        self._bench, self._bar, self._wrong, self._ended = bench, bar, wrong, ended
        self._job: Job | None = None
        bar.cancel.clicked.connect(self._cancel)

    @property
    def busy(self) -> bool:
        """Whether something runs."""
        return self._job is not None

    def start(self, title: str, work: Callable[..., Any], done: Callable[[Any], None]) -> None:
        """
        Begin something.

        Parameters
        ----------
        title : str
        work : callable
            Gets `progress` and `cancelled`, in a worker.
        done : callable
            Gets what it returned, in the GUI thread, unless something else was begun meanwhile.
        """
        self.stop()
        number = _Number()

        def finish(result: Any) -> None:
            if self._over(number):
                self._bar.say("")
                done(result)
                self._ended()

        def fail(error: BaseException) -> None:
            if self._over(number):
                self._failed(error)
                self._ended()

        job = self._bench.jobs.start(title, work, finish, fail)
        number.job = self._job = job
        job.progressed.connect(self._bar.show_share)
        self._bar.show_working(title)
        self._bench.set_failed(Step.PROBE, "")
        self._bench.set_running(Step.PROBE, going_on=True)

    def stop(self) -> None:
        """Stop what runs; nobody hears of its end."""
        if self._job is not None:
            self._let_go().cancel()

    def _let_go(self) -> Job:
        job = self._job
        assert job is not None  # noqa: S101  (asked before)
        self._job = None
        job.progressed.disconnect(self._bar.show_share)
        self._bar.show_idle()
        self._bench.set_running(Step.PROBE, going_on=False)
        return job

    def _cancel(self) -> None:
        if self._job is not None:
            self._bar.say(QCoreApplication.translate("Worker", "Stopping..."))
            self._job.cancel()

    def _over(self, number: _Number) -> bool:
        """Tell whether this is the end of what runs, and not of something that was stopped."""
        if self._job is None or number.job is not self._job:
            return False
        self._let_go()
        return True

    def _failed(self, error: BaseException) -> None:
        if isinstance(error, Cancelled):
            self._bar.say(QCoreApplication.translate("Worker", "Stopped. Nothing was changed."))
        elif isinstance(error, InputError):
            self._bench.set_failed(Step.PROBE, str(error))
            self._wrong(str(error))
        else:
            self._bench.set_failed(Step.PROBE, str(error))
            self._wrong(
                QCoreApplication.translate(
                    "Worker", "Something unexpected went wrong ({}). What there was is as it was; try again."
                ).format(error)
            )


class _Number:
    """Which job an end belongs to: known only after it was begun."""

    job: Job | None = None
