"""Our own line icons: drawn on a grid of 24, coloured for the theme, sharp at any size."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QIcon, QIconEngine, QPainter, QPaintEvent, QPixmap
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QLabel

from contactbench.pipeline.steps import StepState
from contactbench.widgets.theme import colours, is_dark

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

# What is inside <svg viewBox="0 0 24 24">; F stands for the colour where something is filled.
_SHAPES: dict[str, str] = {
    "locked": '<rect x="5" y="11" width="14" height="9" rx="2"/><path d="M8 11V8a4 4 0 0 1 8 0v3"/>',
    "ready": '<circle cx="12" cy="12" r="8.5"/>',
    "running": '<path d="M20 12a8 8 0 1 1-3-6.2"/><path d="M17.5 2v4h-4"/>',
    "done": '<circle cx="12" cy="12" r="9"/><path d="M7.5 12.5l3 3 6-6.5"/>',
    "failed": '<path d="M8 3h8l5 5v8l-5 5H8l-5-5V8z"/><path d="M9 9l6 6M15 9l-6 6"/>',
    "stale": '<path d="M4 7a9 9 0 1 1-1 6"/><path d="M3.5 3v4.5H8"/><path d="M12 8v4.5l3 2"/>',
    "play": '<path d="M7 4.5v15l12-7.5z"/>',
    "stop": '<rect x="6" y="6" width="12" height="12" rx="1"/>',
    "pause": '<path d="M8 5v14M16 5v14"/>',
    "undo": '<path d="M4 9h10a5.5 5.5 0 0 1 0 11H8"/><path d="M8 5L4 9l4 4"/>',
    "redo": '<path d="M20 9H10a5.5 5.5 0 0 0 0 11h6"/><path d="M16 5l4 4-4 4"/>',
    "help": '<circle cx="12" cy="12" r="9"/><path d="M9.3 9.5a2.8 2.8 0 1 1 3.9 2.6c-.8.4-1.2.9-1.2 1.9"/>'
    '<circle cx="12" cy="17" r=".6" fill="F"/>',
    "settings": '<path d="M4 7h9M17 7h3M4 17h3M11 17h9"/><circle cx="15" cy="7" r="2"/>'
    '<circle cx="9" cy="17" r="2"/>',
    "camera": '<path d="M4 7h4l1.5-2.5h5L16 7h4v12H4z"/><circle cx="12" cy="13" r="3.5"/>',
    "warning": '<path d="M12 3.5L22 20H2z"/><path d="M12 10v4.5"/><circle cx="12" cy="17" r=".6" fill="F"/>',
    "info": '<circle cx="12" cy="12" r="9"/><path d="M12 11v6"/><circle cx="12" cy="7.7" r=".6" fill="F"/>',
    "check": '<path d="M4.5 12.5l5 5L19.5 7"/>',
    "cross": '<path d="M6 6l12 12M18 6L6 18"/>',
    "brush": '<path d="M20.5 3.5L11 13"/><path d="M11 13c-2.5-1-5 .5-5.3 3-.2 2-1.2 3-2.7 3.5 '
    '4 1.8 9 .5 9.3-3.5.1-1.3-.4-2.3-1.3-3z"/>',
    "eraser": '<path d="M9 20l-5.5-5.5 10-10.5 6.5 6.5L11 20z"/><path d="M8.5 9.5l6.5 6.5M9 20h11"/>',
    "flood": '<path d="M11 4l8 8-7 7-8-8z"/><path d="M4.5 11.5h14"/><path d="M11 4L9 2"/>'
    '<path d="M21 16c1.2 2 1.2 4 0 4s-1.2-2 0-4z"/>',
    "box": '<path d="M4 4h3M10 4h4M17 4h3v3M20 10v4M20 17v3h-3M14 20h-4M7 20H4v-3M4 14v-4M4 7V4"/>',
    "mirror": '<path d="M12 3v3M12 9v2.5M12 14v2.5M12 19v2"/><path d="M9 7v10H2.5z"/><path d="M15 7v10h6.5z"/>',
    "add": '<path d="M12 4v16M4 12h16"/>',
    "remove": '<path d="M4 12h16"/>',
    "up": '<path d="M5 15l7-7 7 7"/>',
    "down": '<path d="M5 9l7 7 7-7"/>',
    "folder": '<path d="M3 6h6l2 2.5h10V19H3z"/>',
    "export": '<path d="M12 3v12M7.5 7.5L12 3l4.5 4.5"/><path d="M4 14v6h16v-6"/>',
    "sound": '<path d="M4 9.5h3.5L12 5v14l-4.5-4.5H4z"/><path d="M15.5 9a4 4 0 0 1 0 6M18 6.5a8 8 0 0 1 0 11"/>',
    "mute": '<path d="M4 9.5h3.5L12 5v14l-4.5-4.5H4z"/><path d="M16 9.5l5 5M21 9.5l-5 5"/>',
    "zoom-fit": '<path d="M3.5 8.5v-5h5M15.5 3.5h5v5M20.5 15.5v5h-5M8.5 20.5h-5v-5"/>'
    '<circle cx="12" cy="12" r="3.5"/>',
    "copy": '<rect x="8" y="8" width="12" height="12" rx="2"/><path d="M16 8V4H4v12h4"/>',
    "search": '<circle cx="10.5" cy="10.5" r="6"/><path d="M15 15l6 6"/>',
    "record": '<circle cx="12" cy="12" r="6" fill="F"/>',
}
NAMES = tuple(_SHAPES)
"""Every icon there is."""

_OF_STATE = {
    StepState.LOCKED: "muted",
    StepState.READY: "accent",
    StepState.RUNNING: "accent",
    StepState.DONE: "good",
    StepState.FAILED: "bad",
    StepState.STALE: "stale",
}


class _Engine(QIconEngine):
    """Draws from the shape each time, so that a change of theme or of screen needs no new icon."""

    def __init__(self, name: str, colour: str) -> None:
        super().__init__()
        self._name, self._colour = name, colour

    def paint(self, painter: QPainter, rect: QRect, mode: QIcon.Mode, state: QIcon.State) -> None:  # noqa: ARG002
        chosen = colours(is_dark())
        colour = getattr(chosen, self._colour, self._colour)
        if mode == QIcon.Mode.Disabled:
            colour = chosen.line
        elif mode == QIcon.Mode.Selected:
            colour = chosen.panel
        _renderer(self._name, colour).render(painter, QRectF(rect))

    def pixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        result = QPixmap(size)
        result.fill(Qt.GlobalColor.transparent)
        painter = QPainter(result)
        self.paint(painter, result.rect(), mode, state)
        painter.end()
        return result

    def clone(self) -> QIconEngine:
        return _keep(_Engine(self._name, self._colour))


# Python must hold an engine that C++ owns as long as an icon may use it; there are few, each is made once.
_ENGINES: list[_Engine] = []


def _keep(engine: _Engine) -> _Engine:
    _ENGINES.append(engine)
    return engine


@cache
def _renderer(name: str, colour: str) -> QSvgRenderer:
    shape = _SHAPES[name].replace('"F"', f'"{colour}"')
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24">'
        f'<g fill="none" stroke="{colour}" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round">'
        f"{shape}</g></svg>"
    )
    return QSvgRenderer(QByteArray(svg.encode()))


@cache
def icon(name: str, colour: str = "text") -> QIcon:
    """
    Return one of our icons.

    Parameters
    ----------
    name : str
        One of `NAMES`.
    colour : str, optional
        Name of a colour of the theme, or `#rrggbb`.
    """
    if name not in _SHAPES:
        raise KeyError(f"no icon is called {name}; there are {', '.join(NAMES)}")
    return QIcon(_keep(_Engine(name, colour)))


class Sign(QLabel):
    """
    An icon beside words, painted anew each time: it follows the theme and the screen by itself.

    Parameters
    ----------
    pixels : int
        Its width and height.
    """

    def __init__(self, pixels: int = 24, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._icon = QIcon()
        self.setFixedSize(pixels, pixels)

    def show_icon(self, shown: QIcon) -> None:
        """Show another one."""
        self._icon = shown
        self.update()

    def paintEvent(self, _: QPaintEvent) -> None:
        """Draw it."""
        painter = QPainter(self)
        self._icon.paint(painter, self.rect())
        painter.end()


def state_icon(state: StepState) -> QIcon:
    """Return the icon of a step's state, the same everywhere."""
    return icon(state.value, _OF_STATE[state])


def state_colour(state: StepState) -> str:
    """Return the name of the theme's colour for a step's state."""
    return _OF_STATE[state]
