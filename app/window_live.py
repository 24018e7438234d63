"""What is live around the pages: the devices that a session names, the charts, the rates."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from contactbench.app.bench import Bench, Weight
from contactbench.pipeline.errors import InputError
from contactbench.widgets.messages import translated
from contactbench.widgets.numbers import filled

if TYPE_CHECKING:
    from contactbench.widgets.strip_chart import StripChart

_MOST_TOLD = 20
_SENSOR, _POSES, _MOUNT = "devices.sensor", "devices.poses", "devices.mount"


class _Once:
    """Tells the hook what a follower raised in a stream's thread: once, not with each of 200 blocks a second."""

    def __init__(self) -> None:
        self._told: set[str] = set()

    def __call__(self, error: Exception) -> None:
        words = f"{type(error).__name__}: {error}"
        if words not in self._told and len(self._told) < _MOST_TOLD:
            self._told.add(words)
            sys.excepthook(type(error), error, error.__traceback__)


class LiveView(QObject):
    """The devices, the charts and the rates of an open session."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._bench: Bench | None = None
        self._well = True
        self.charts: StripChart | None = None

    def make_charts(self) -> StripChart:
        """Make charts for the next session; return them."""
        from contactbench.widgets.strip_chart import StripChart  # brings pyqtgraph: only once it is needed

        self.charts = StripChart()
        return self.charts

    def open(self, bench: Bench) -> None:
        """Begin with a session."""
        self._bench, self._well = bench, True
        bench.live.on_error.append(_Once())
        if self.charts is not None:
            self.charts.follow(bench.live)

    def forget(self) -> None:
        """Let go of it."""
        self._bench, self.charts = None, None

    def reopen(self) -> None:
        """Open the devices that the session names, in a worker; one that is not there is waited for, and says so."""
        bench = self._bench
        if bench is None:
            return
        sensor, poses, mount = map(bench.desk.state.setting, (_SENSOR, _POSES, _MOUNT))
        if not isinstance(sensor, str) or not sensor:
            return

        def work(_progress: object, _cancelled: object) -> None:
            from contactbench.pipeline.settings import mount_rotation

            bench.live.open(sensor, poses if isinstance(poses, str) else None, mount_rotation(mount))

        def failed(error: BaseException) -> None:
            words = self.tr("Could not open this session's devices: {} Choose them again in step 1.")
            reason = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}."
            bench.tell(Weight.WARNING, words.format(translated(reason)))

        bench.jobs.start(self.tr("Opening devices"), work, None, failed)

    def tick(self) -> None:
        """Show the newest samples in the charts; a fault is told once, and leaves the charts as they are."""
        if self.charts is None or not self._well:
            return
        try:
            self.charts.tick()
        except Exception:  # noqa: BLE001 - told by the hook; the rest of the window goes on
            self._well = False
            sys.excepthook(*sys.exc_info())

    def rates(self) -> str:
        """Return the rates of what is open, in a line."""
        health = None if self._bench is None else self._bench.live.health
        if health is None:
            return self.tr("no live samples")
        sensor, poses = health
        words = [self.tr("sensor {}").format(self._hertz(sensor.rate))]
        if poses is not None:
            words.append(self.tr("poses {}").format(self._hertz(poses.rate)))
        return " · ".join([*words, *self._followed()])

    def _followed(self) -> list[str]:
        """Say what is taken off where the zero follows."""
        if self._bench is None or (zero := self._bench.live.zero) is None:
            return []
        # It brings the kernel: only once something runs.
        from contactbench.pipeline.contact.following import follow_words

        return [translated(words)] if (words := follow_words(zero)) else []

    def _hertz(self, rate: float | None) -> str:
        return self.tr("waiting") if rate is None else filled(self.tr("{:.0f} Hz"), rate)
