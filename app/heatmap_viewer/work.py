"""Long work of the viewer: how far it is and a way to stop it in its panel, and its end in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from contactbench.widgets.messages import translated

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.heatmap_viewer.controls import HeatmapControls
    from contactbench.app.jobs import Job, Jobs


class ViewerWork(QObject):
    """
    Starts jobs, and shows the newest of them.

    Parameters
    ----------
    jobs : Jobs
    controls : HeatmapControls
        The panel.
    """

    def __init__(self, jobs: Jobs, controls: HeatmapControls) -> None:
        super().__init__(controls)
        self._jobs, self._controls = jobs, controls
        self._running: list[Job] = []
        self._closed = False
        controls.asked_stop.connect(self.stop)

    def start(
        self,
        title: str,
        work: Callable[[Callable[[float], None], Callable[[], bool]], Any],
        done: Callable[[Any], None],
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        """Do something long; as `Jobs.start`, but nobody is told once the viewer is closed."""
        job = self._jobs.start(
            title,
            work,
            lambda result: None if self._closed else done(result),
            lambda error: None if self._closed else (failed or self.tell)(error),
        )
        self._running.append(job)
        job.progressed.connect(self._show)
        job.finished.connect(lambda: self._ended(job))
        self._show()

    def stop(self) -> None:
        """Ask all of it to stop."""
        for job in self._running:
            job.cancel()

    def close(self) -> None:
        """Stop it, and tell nobody."""
        self._closed = True
        self.stop()

    def tell(self, error: BaseException) -> None:
        """Say why something did not come to its end."""
        if type(error).__name__ == "Cancelled":  # the pipeline's, which takes long to import
            self._controls.say(self.tr("Stopped; nothing was changed."))
        elif isinstance(error, ValueError | OSError):
            self._controls.say(str(error), bad=True)
        else:
            said = self.tr("Unexpected error: {what}.")
            self._controls.say(said.format(what=translated(error)), bad=True)

    def _show(self, _share: float = 0.0) -> None:
        if self._running and not self._closed:
            self._controls.show_work(self._running[-1].title, self._running[-1].share)

    def _ended(self, job: Job) -> None:
        self._running.remove(job)
        if not self._running and not self._closed:
            self._controls.show_work(None)
