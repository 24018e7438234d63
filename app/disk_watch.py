"""The disk under a session: a write that failed, and files that are not as they were written."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from contactbench.app.bench import Weight
from contactbench.app.errors import in_words
from contactbench.app.opening import damage

if TYPE_CHECKING:
    from concurrent.futures import Future

    from contactbench.app.bench import Bench

_EVERY_S = 2.0
_AFTER_MS, _MOST = 2000, 5


class DiskWatch(QObject):
    """Says that the last write failed, and goes on by itself when the disk does; belongs to its bench."""

    def __init__(self, bench: Bench) -> None:
        super().__init__(bench)
        self._bench = bench
        self._told = self._hopeless = False
        self._looked_at = 0.0
        self._looking: Future[None] | None = None

    def look(self) -> None:
        """See how it stands; called twice a second, never waits."""
        if self._looking is not None:
            if self._looking.done():
                looked, self._looking = self._looking, None
                self._looked(looked.exception())
            return
        if self._hopeless or not self._bench.desk.refuses:
            self._told = False
            return
        if not self._told:
            self._told = True
            self._bench.tell(
                Weight.WARNING,
                self.tr(
                    "Nothing is written into this session at the moment, because the last write failed. Free some"
                    " space, or check the disk: the session goes on by itself then, and says so."
                ),
            )
        if time.monotonic() >= self._looked_at + _EVERY_S:
            self._looked_at = time.monotonic()
            self._looking = self._bench.desk.do(lambda session: session.recover())

    def _looked(self, error: BaseException | None) -> None:
        if error is None:
            self._told = False
            self._bench.tell(
                Weight.GOOD,
                self.tr(
                    "The disk can be written again, and the session goes on. Do again what was refused;"
                    " what was recorded before is there."
                ),
            )
            self._bench.mended.emit()
        elif not isinstance(error.__cause__, OSError):  # it is not the disk: waiting mends nothing
            self._hopeless = True
            self._bench.tell(Weight.ERROR, *in_words(error)[:2])


class DamageCheck(QObject):
    """
    Looks at every file of a session once, and tells what is not as it was written; belongs to its bench.

    Some time after it was opened, in a worker: the window is drawn first.
    """

    def __init__(self, bench: Bench) -> None:
        super().__init__(bench)
        self._bench = bench
        QTimer.singleShot(_AFTER_MS, self, self._look)

    def _look(self) -> None:
        if self._bench.ending:
            return
        folder = self._bench.desk.folder
        self._bench.jobs.start(
            self.tr("Checking the session's files"),
            lambda _progress, cancelled: damage(folder, cancelled),
            self._tell,
        )

    def _tell(self, problems: tuple[str, ...]) -> None:
        for problem in reversed(problems[:_MOST]):
            self._bench.tell(Weight.ERROR, problem)
        if problems:
            words = (
                self.tr(
                    "A file of this session is not as it was written, so nothing that rests on it counts."
                )
                if len(problems) == 1
                else self.tr(
                    "{} files of this session are not as they were written, so nothing that rests on them counts."
                    " `contactbench session verify` lists them all."
                )
            )
            self._bench.tell(Weight.ERROR, words.format(len(problems)))
