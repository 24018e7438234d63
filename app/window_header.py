"""The tool bar on top: which session, which devices, and what is needed at any time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QSizePolicy, QToolBar, QWidget

from contactbench.app.start import session_name
from contactbench.widgets.controls import ElidedLabel
from contactbench.widgets.numbers import filled

if TYPE_CHECKING:
    from PySide6.QtGui import QAction

    from contactbench.app.bench import Bench
    from contactbench.pipeline.workbench.live import Live

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
        setting = bench.desk.state.settings.get("devices.sensor")
        if setting is None:
            return self.tr("no devices chosen")
        name = self._short(str(setting.value))
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
