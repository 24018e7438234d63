"""What is wrong with an open session, looked for all the time: its disk, its devices, its files."""

import time
from concurrent.futures import Future

from PySide6.QtCore import QObject, QTimer

from contactbench.app.bench import Bench, Weight
from contactbench.app.errors import in_words
from contactbench.pipeline.session.check import other_problems
from contactbench.pipeline.session.why import DISK, FileWatch, SessionTrouble
from contactbench.pipeline.workbench.live_trial import gone

_DISK_EVERY_S, _FILES_EVERY_S = 2.0, 1.0
_AFTER_MS, _TOLD_AT_ONCE = 2000, 5


class TroubleWatch(QObject):
    """
    Keeps `bench.trouble` true, and tells what comes and goes; belongs to its bench.

    All files are looked at byte by byte once, some time after the session was opened, in a worker: nothing else would
    tell that one digit of a calibration was changed on the disk. After that, those that were touched.
    """

    def __init__(self, bench: Bench) -> None:
        super().__init__(bench)
        self._bench, self._watch = bench, FileWatch(bench.desk.folder)
        self._files: dict[str, str] | None = None  # None: not looked at yet
        self._hopeless = False
        self._disk_at = self._files_at = 0.0
        self._disk: Future[None] | None = None
        self._looking: Future[dict[str, str]] | None = None
        QTimer.singleShot(_AFTER_MS, self, self._look_at_all)

    def look(self) -> None:
        """See how it stands; called twice a second, never waits."""
        bench = self._bench
        if bench.ending or bench.desk.closed:
            return
        self._look_at_files()
        disk = self._look_at_disk()
        self._have(SessionTrouble(disk, gone(bench.live), dict(self._files or {})))

    # ---- the disk ----------------------------------------------------------------------------------

    def _look_at_disk(self) -> str:
        """Return what is wrong with it; a session whose last write failed is tried again."""
        desk = self._bench.desk
        if self._disk is not None and self._disk.done():
            looked, self._disk = self._disk, None
            self._tried(looked.exception())
        due = time.monotonic() >= self._disk_at + _DISK_EVERY_S
        if due and self._disk is None and desk.refuses and not self._hopeless:
            self._disk_at = time.monotonic()
            self._disk = desk.do(lambda session: session.recover())
        return DISK if desk.refuses else ""

    def _tried(self, error: BaseException | None) -> None:
        if error is None:
            self._bench.mended.emit()
        elif not isinstance(error.__cause__, OSError):  # it is not the disk: waiting mends nothing
            self._hopeless = True
            self._bench.tell(Weight.ERROR, *in_words(error)[:2])

    # ---- the files ---------------------------------------------------------------------------------

    def _look_at_all(self) -> None:
        bench = self._bench
        if bench.ending:
            return
        folder, state = bench.desk.folder, bench.desk.state

        def look(_progress: object, cancelled: object) -> tuple[dict[str, str], tuple[str, ...]]:
            return self._watch.look(state, cancelled), other_problems(folder)  # type: ignore[arg-type]

        bench.jobs.start(self.tr("Checking session files"), look, self._looked_at_all)

    def _looked_at_all(self, found: tuple[dict[str, str], tuple[str, ...]]) -> None:
        self._files, others = found
        for problem in others:
            self._bench.tell(Weight.ERROR, problem)
        self.look()

    def _look_at_files(self) -> None:
        if self._looking is not None and self._looking.done():
            looked, self._looking = self._looking, None
            if looked.exception() is None:
                self._files = looked.result()
        due = time.monotonic() >= self._files_at + _FILES_EVERY_S
        if due and self._looking is None and self._files is not None:
            self._files_at = time.monotonic()
            self._looking = self._bench.desk.do(lambda session: self._watch.look(session.state))

    # ---- told --------------------------------------------------------------------------------------

    def _have(self, trouble: SessionTrouble) -> None:
        before = self._bench.trouble
        if trouble == before:
            return
        self._bench.trouble = trouble
        self._tell(before, trouble)
        self._bench.changed.emit()

    def _tell(self, before: SessionTrouble, now: SessionTrouble) -> None:
        tell = self._bench.tell
        if now.disk and not before.disk:
            tell(Weight.ERROR, now.disk)
        elif before.disk and not now.disk:
            words = self.tr(
                "The disk is writable again and the session continues. Repeat the actions that were"
                " refused; earlier recordings are intact."
            )
            self._bench.tell_over(words)
        if now.devices and now.devices != before.devices:
            tell(Weight.WARNING, now.devices)
        elif before.devices and not now.devices and self._bench.connected:
            self._bench.tell_over(self.tr("The sensor is back and sending readings."))
        new = [why for place, why in now.files.items() if before.files.get(place) != why]
        for why in reversed(new[:_TOLD_AT_ONCE]):
            tell(Weight.ERROR, why)
        if new:
            words = (
                self.tr(
                    "A file in this session has changed since it was written. Results that depend on it"
                    " are invalid."
                )
                if len(now.files) == 1
                else self.tr(
                    "{} files in this session have changed since they were written. Results that depend"
                    " on them are invalid."
                ).format(len(now.files))
            )
            tell(Weight.ERROR, words)
        elif before.files and not now.files:
            self._bench.tell_over(self.tr("All files of this session are as they were written again."))
