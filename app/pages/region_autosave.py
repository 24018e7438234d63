"""Regions are kept in the session by themselves: soon after the last change, and at once when the page goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from contactbench.app.bench import Weight
from contactbench.pipeline.workbench.regions_session import keep_with_steps

if TYPE_CHECKING:
    from contactbench.app.bench import Bench
    from contactbench.pipeline.workbench.regions import RegionsWork

PAUSE = 1500  # ms after the last change


class RegionAutosave(QObject):
    """
    Saves the regions of one page.

    Attributes
    ----------
    dirty : bool
        There are changes that the session does not have.
    """

    kept = Signal()  # nothing is left to be kept
    failed = Signal(object)  # why it could not be; the next change tries again

    def __init__(self, bench: Bench, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bench = bench
        self._work: RegionsWork | None = None
        self._kept_at = 0
        self._timer = QTimer(self, singleShot=True, interval=PAUSE)
        self._timer.timeout.connect(self._keep_or_wait)
        bench.mended.connect(self.changed)

    @property
    def dirty(self) -> bool:
        """See the class."""
        return self._work is not None and self._work.revision != self._kept_at

    def watch(self, work: RegionsWork | None) -> None:
        """Keep these from now on, after those before."""
        self.keep_now()
        self._work = work
        self._kept_at = 0 if work is None else work.revision

    def changed(self) -> None:
        """Keep them soon."""
        if self.dirty:
            self._timer.start()

    def _keep_or_wait(self) -> None:
        """Keep them, but not amid a stroke: that would be lost, and its end comes soon."""
        if self._work is not None and self._work.drawing:
            self._timer.start()
        else:
            self.keep_now()

    def keep_now(self) -> None:
        """Keep them at once, in the desk's thread; a stroke that is being drawn is given up."""
        self._timer.stop()
        work = self._work
        if work is None or not self.dirty:
            return
        work.abort()
        revision, regions, shell, steps = work.revision, work.model.snapshot(), work.shell, work.model.steps
        self._kept_at = revision
        bench, title = self._bench, self.tr("Saving regions")

        def done(_record: object) -> None:
            # Something else may be watched by now, or the page be closed and this object be gone.
            if self._work is work and not self.dirty:
                self.kept.emit()

        def wrong(error: BaseException) -> None:
            if self._work is work:
                self._kept_at = -1
                self.failed.emit(str(error))
            else:
                bench.tell(Weight.ERROR, str(error))

        bench.do(title, lambda session: keep_with_steps(session, regions, shell, steps), done, wrong)
