"""A look at every file of a session, some time after it was opened: the window is drawn first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from contactbench.app.bench import Weight
from contactbench.app.opening import damage

if TYPE_CHECKING:
    from contactbench.app.bench import Bench

_AFTER_MS, _MOST = 2000, 5


class DamageCheck(QObject):
    """Looks once, in a worker, and tells what is not as it was written; belongs to its bench."""

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
