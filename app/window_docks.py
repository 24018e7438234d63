"""What lies around the scene, how it is laid out, remembered from one start to the next, and what is live in it."""

from __future__ import annotations

import base64
import sys
from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QCoreApplication, QObject, QSize, Qt, QTimer
from PySide6.QtWidgets import QDockWidget, QMainWindow, QSizePolicy, QStackedWidget, QToolBar, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.app.start import session_name
from contactbench.pipeline.errors import InputError
from contactbench.widgets.controls import ElidedLabel
from contactbench.widgets.message_list import MessageList
from contactbench.widgets.messages import filled, translated
from contactbench.widgets.step_list import StepList

if TYPE_CHECKING:
    from PySide6.QtGui import QAction

    from contactbench.pipeline.workbench.live import Live
    from contactbench.widgets.strip_chart import StripChart

_MOST_TOLD = 20
_SENSOR, _POSES, _MOUNT = "devices.sensor", "devices.poses", "devices.mount"
_VERSION = 1  # of the docks: an older layout is not restored
_STEPS_PX, _BOTTOM_PX = 150, 190
_LEAST_PX = 180  # that a page is high
_PAGE_PX = (320, 560)  # the least that every page fits into, and the most that it makes use of
_HIGH, _LOW, _CHART_SHARE = 900, 560, 0.6
_FRAME_PX = (4, 36)  # what a window manager puts around a window
_USUAL, _OF_SCREEN = (1280, 800), 0.75  # of a window that nobody sized: px, and of a large screen
SMALLEST = (640, 320)
"""The least that a window needs: half of a screen of 1366 x 768, which a scale of 200 % leaves."""


class Docks:
    """The docks of a window."""

    def __init__(self, window: QMainWindow) -> None:
        self._window = window
        self.steps, self.pages, self.messages = StepList(), QStackedWidget(), MessageList()
        self._charts = QStackedWidget()
        area = Qt.DockWidgetArea
        self.step_dock = self._dock(
            "steps", QCoreApplication.translate("Docks", "Steps"), self.steps, area.LeftDockWidgetArea
        )
        self.page_dock = self._dock(
            "page", QCoreApplication.translate("Docks", "Step"), self.pages, area.RightDockWidgetArea
        )
        self.chart_dock = self._dock(
            "charts", QCoreApplication.translate("Docks", "Charts"), self._charts, area.BottomDockWidgetArea
        )
        self.message_dock = self._dock(
            "messages",
            QCoreApplication.translate("Docks", "Messages"),
            self.messages,
            area.BottomDockWidgetArea,
        )
        # As low as in the smallest window, whatever a page asks for: a window that was made lower would else go on
        # showing pages as high as they were before their foot took less room.
        self.pages.setMinimumSize(_PAGE_PX[0], _LEAST_PX)
        # The steps and the page reach down to the edge: the page has the most to show.
        window.setCorner(Qt.Corner.BottomRightCorner, area.RightDockWidgetArea)
        window.setCorner(Qt.Corner.BottomLeftCorner, area.LeftDockWidgetArea)
        self.hide()

    @property
    def all(self) -> tuple[QDockWidget, ...]:
        """The docks, as they are offered in a menu."""
        return (self.step_dock, self.page_dock, self.chart_dock, self.message_dock)

    def set_charts(self, charts: QWidget | None) -> None:
        """Put charts into their dock, and take out those that were there."""
        while (before := self._charts.widget(0)) is not None:
            self._charts.removeWidget(before)
            before.deleteLater()
        if charts is not None:
            self._charts.addWidget(charts)

    def charts_seen(self) -> bool:
        """Whether somebody can see the charts."""
        return self._charts.isVisible() and not self._charts.visibleRegion().isEmpty()

    def show_messages(self) -> None:
        """Show the list of messages: somebody wants to read it."""
        self.message_dock.show()
        self.message_dock.raise_()
        self.messages.setFocus()

    def hide(self) -> None:
        """Hide all of them."""
        for dock in self.all:
            dock.hide()

    def arrange(self) -> None:
        """Lay them out as they are at first; where there is hardly any room, without those at the bottom."""
        window, area = self._window, Qt.DockWidgetArea
        for dock, where in (
            (self.step_dock, area.LeftDockWidgetArea),
            (self.page_dock, area.RightDockWidgetArea),
            (self.chart_dock, area.BottomDockWidgetArea),
            (self.message_dock, area.BottomDockWidgetArea),
        ):
            dock.setFloating(False)
            window.addDockWidget(where, dock)
            dock.setVisible(where is not area.BottomDockWidgetArea or window.height() >= _LOW)
        window.splitDockWidget(self.chart_dock, self.message_dock, Qt.Orientation.Horizontal)
        sideways, high = Qt.Orientation.Horizontal, window.height()
        page = min(max(round(0.2 * window.width()) + 124, _PAGE_PX[0]), _PAGE_PX[1])
        window.resizeDocks([self.step_dock, self.page_dock], [_STEPS_PX, page], sideways)
        bottom = _BOTTOM_PX if high < _HIGH else round(high * 0.22)
        window.resizeDocks([self.chart_dock, self.message_dock], [bottom, bottom], Qt.Orientation.Vertical)
        middle = window.width() - _STEPS_PX - page
        widths = [round(_CHART_SHARE * middle), round((1 - _CHART_SHARE) * middle)]
        below = [self.chart_dock, self.message_dock]
        # Docks that were just shown take sizes only once they are laid out.
        QTimer.singleShot(0, window, lambda: window.resizeDocks(below, widths, sideways))

    def layout_text(self) -> str:
        """Return how they are laid out, to be remembered."""
        return base64.b64encode(self._window.saveState(_VERSION).data()).decode()

    def restore(self, text: str) -> None:
        """Lay them out as remembered, or as at first."""
        if not text or not self._window.restoreState(_decoded(text), _VERSION):
            self.arrange()

    def _dock(self, name: str, title: str, widget: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
        dock = QDockWidget(title, self._window)
        dock.setObjectName(name)
        dock.setWidget(widget)
        self._window.addDockWidget(area, dock)
        return dock


def geometry_text(window: QMainWindow) -> str:
    """Return where a window is, and how large, to be remembered."""
    return base64.b64encode(window.saveGeometry().data()).decode()


def first_size(window: QWidget) -> QSize:
    """Return how large a window is that nobody has sized yet: larger on a large screen, and always within it."""
    room = window.screen().availableSize()
    wanted = (
        max(usual, round(_OF_SCREEN * given)) for usual, given in zip(_USUAL, room.toTuple(), strict=True)
    )
    return QSize(*wanted).boundedTo(room - QSize(*_FRAME_PX))


def restore_geometry(window: QMainWindow, text: str) -> bool:
    """Put a window where it was; False: nothing usable is remembered."""
    return bool(text) and window.restoreGeometry(_decoded(text))


def _decoded(text: str) -> QByteArray:
    return QByteArray.fromBase64(QByteArray(text.encode("ascii", "replace")))


# ---- the tool bar on top: which session, which devices, and what is needed at any time -----------


_ICON_PX = 22


class HeaderBar(QToolBar):
    """The session's name, its devices in one line, and a few actions."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("header")
        self.setWindowTitle(self.tr("Header"))
        self.setMovable(False)
        self.setIconSize(QSize(_ICON_PX, _ICON_PX))
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        self._session, self._devices = ElidedLabel(), ElidedLabel(role="muted")
        self._session.setStyleSheet("font-weight: 600;")
        self._session.setContentsMargins(6, 0, 0, 0)
        self._devices.setContentsMargins(14, 0, 0, 0)
        space = QWidget()
        space.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        for widget in (self._session, self._devices, space):
            self.addWidget(widget)

    def add(self, *actions: QAction) -> None:
        """Put actions on the right."""
        for action in actions:
            self.addAction(action)
            button = self.widgetForAction(action)
            button.setAccessibleName(action.text().replace("&", ""))

    def show_bench(self, bench: Bench | None) -> None:
        """Show what is open; to be called now and then."""
        if bench is None:
            self._session.setText(self.tr("No session"))
            self._devices.setText("")
            return
        self._session.setText(session_name(bench.desk.folder))
        self._devices.setText(self.device_line(bench))

    def device_line(self, bench: Bench) -> str:
        """Return the devices in a line: what, how fast, what was lost."""
        if "devices.sensor" not in bench.desk.state.settings:
            return self.tr("no devices chosen")
        name = self._short(str(bench.desk.state.setting("devices.sensor")))
        numbers = live_numbers(bench.live)
        if numbers is None:
            return self.tr("{} · not connected").format(name)
        rate, lost = numbers
        return filled(self.tr("{} · {:.0f} Hz · {} lost"), name, rate, lost)

    def _short(self, address: str) -> str:
        if address.startswith("virtual:"):
            return self.tr("virtual bench")
        if address.startswith("replay:"):
            return self.tr("replay of {}").format(address.partition("?")[0].rpartition("/")[2])
        return address.partition("?")[0]


def live_numbers(live: Live) -> tuple[float, int] | None:
    """Return rate (Hz) and lost samples of the sensor; None: nothing is open."""
    health = live.health
    if health is None:
        return None
    return live.rate or 0.0, live.lost


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
