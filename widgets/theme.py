"""Colours of both themes, and the style sheet made of them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from PySide6.QtCore import QByteArray, QRect, QRectF, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QGuiApplication,
    QIcon,
    QIconEngine,
    QPaintDevice,
    QPainter,
    QPaintEvent,
    QPalette,
    QPixmap,
)
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QApplication, QLabel, QWidget

from contactbench.pipeline.steps import StepState

_PICTURES = Path(__file__).parent / "pictures"  # a style sheet takes pictures from files only
_SHEET_IN_USE, _DRESSED = "sheet", "dressed"  # properties of the application, of a window
OKABE_ITO = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


@dataclass(frozen=True)
class Colours:
    """Colours of a theme, each as `#rrggbb`."""

    # text, muted: What is written, and what is written beside it; both at least 4.5:1 on `panel` and
    # `background`
    text: str
    muted: str
    # panel, background: Of controls, and of what lies behind them
    panel: str
    background: str
    line: str  # Borders and grids
    accent: str  # The one thing to press; `panel` is written on it
    # good, warning, bad, stale: States, for text and icons; never without a word or an icon
    good: str
    warning: str
    bad: str
    stale: str
    series: tuple[str, str, str, str, str, str]  # Six categories, Okabe and Ito: Fx, Fy, Fz, Mx, My, Mz


_LIGHT = Colours(
    text="#1b1f24",
    muted="#545d68",
    panel="#ffffff",
    background="#f1f3f5",
    line="#c5ccd3",
    accent="#005a9c",
    good="#00664b",
    warning="#8a4b00",
    bad="#b3261e",
    stale="#5f6670",
    series=OKABE_ITO,
)
_DARK = Colours(
    text="#e8eaed",
    muted="#a8b0ba",
    panel="#24282e",
    background="#191c20",
    line="#474e57",
    accent="#6cb6f2",
    good="#4cc9a0",
    warning="#f0b04c",
    bad="#ff8a80",
    stale="#9aa3ad",
    # the blue and the red-orange a little lighter: they must be told from a dark ground
    series=("#3d9be0", "#f0803c", "#1fbf92", "#dd92bb", "#eab04a", "#74c5f0"),
)


def colours(dark: bool) -> Colours:
    """Return the colours of the dark or the light theme."""
    return _DARK if dark else _LIGHT


def is_dark() -> bool:
    """Whether the running application is shown in the dark theme; False without one."""
    application = QGuiApplication.instance()
    if not isinstance(application, QGuiApplication):
        return False
    return application.palette().color(QPalette.ColorRole.Window).lightness() < 128


def contrast(one: str, other: str) -> float:
    """Return the contrast of two colours, 1 to 21, as WCAG 2.1 defines it."""
    bright, dim = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


def _luminance(colour: str) -> float:
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def palette(dark: bool) -> QPalette:
    """Return the palette of a theme; what is drawn without the style sheet keeps to it, too."""
    c, result = colours(dark), QPalette()
    role, group = QPalette.ColorRole, QPalette.ColorGroup
    for colour, roles in (
        (c.text, (role.WindowText, role.Text, role.ButtonText, role.ToolTipText)),
        (c.panel, (role.Base, role.Button, role.ToolTipBase, role.HighlightedText, role.Light)),
        (c.background, (role.Window, role.AlternateBase)),
        (c.accent, (role.Highlight, role.Link, role.LinkVisited)),
        (c.line, (role.Mid, role.Midlight, role.Dark)),
        (c.bad, (role.BrightText,)),
        (c.muted, (role.PlaceholderText,)),
    ):
        for which in roles:
            result.setColor(which, QColor(colour))
    for which in (role.WindowText, role.Text, role.ButtonText):
        result.setColor(group.Disabled, which, QColor(c.stale))
    return result


def use_theme(choice: str = "system") -> None:
    """
    Dress the running application.

    Parameters
    ----------
    choice : "system", "light" or "dark"
    """
    application = QGuiApplication.instance()
    if not isinstance(application, QGuiApplication):
        return
    dark = choice == "dark"
    if choice == "system":
        dark = application.styleHints().colorScheme() == Qt.ColorScheme.Dark
    application.setPalette(palette(dark))
    application.setProperty(_SHEET_IN_USE, style_sheet(dark))
    for window in QApplication.topLevelWidgets():
        if window.property(_DRESSED):
            dress(window)


def dress(window: QWidget) -> None:
    """
    Have a window, and all that is in it and above it, look as the theme in use says, also when another one is chosen.

    The application has no style sheet of its own: every part would then be styled anew, with all that is in it, for
    each parent that it is given while a page is built. That takes three times as long as building it.
    """
    window.setProperty(_DRESSED, True)
    window.setStyleSheet(QApplication.instance().property(_SHEET_IN_USE) or "")  # type: ignore[union-attr]


def follow_system(choice: Callable[[], str]) -> None:
    """Dress the running application anew whenever the computer's theme changes; `choice`: as of `use_theme`, then."""
    QGuiApplication.styleHints().colorSchemeChanged.connect(lambda _scheme: use_theme(choice()))


@cache
def style_sheet(dark: bool) -> str:
    """Return the style sheet of a theme."""
    return _SHEET.format(
        **vars(colours(dark)), pictures=_PICTURES.as_posix(), which="dark" if dark else "light"
    )


# Lengths in px. A property `primary` on a button makes it the accented one; `role` on a label chooses its size.
_SHEET = """
QWidget {{ font-size: 10.5pt; color: {text}; }}
QMainWindow, QDialog {{ background: {background}; }}
QToolTip {{ color: {text}; background: {panel}; border: 1px solid {line}; padding: 4px; }}
QPushButton {{ min-height: 28px; padding: 4px 14px; border: 1px solid {line}; border-radius: 6px;
  background: {panel}; color: {text}; }}
QPushButton {{ icon-size: 18px; }}
QPushButton:hover, QPushButton:focus {{ border-color: {accent}; }}
QPushButton:pressed, QPushButton:checked {{ background: {background}; border: 2px solid {accent}; }}
QPushButton:disabled {{ color: {stale}; background: {background}; }}
QPushButton[primary="true"] {{ background: {accent}; color: {panel}; border-color: {accent}; font-weight: 600; }}
QPushButton[primary="true"]:focus {{ border: 2px solid {text}; }}
QPushButton[primary="true"]:disabled {{ background: {background}; color: {stale}; border-color: {line}; }}
QToolButton {{ min-height: 24px; padding: 5px; border: 1px solid transparent; border-radius: 6px;
  background: transparent; }}
QToolButton:hover, QToolButton:focus {{ border-color: {accent}; }}
QToolButton:checked, QToolButton:pressed {{ background: {background}; border-color: {accent}; }}
QToolButton:disabled {{ color: {stale}; }}
QLineEdit, QComboBox, QAbstractSpinBox, QPlainTextEdit, QTextEdit, QTextBrowser, QAbstractItemView {{
  background: {panel}; color: {text}; border: 1px solid {line}; border-radius: 5px;
  selection-background-color: {accent}; selection-color: {panel}; }}
QLineEdit, QComboBox, QAbstractSpinBox {{ min-height: 26px; padding: 3px 6px; }}
QAbstractSpinBox {{ padding: 3px 2px 3px 8px; }}
QLineEdit:focus, QComboBox:focus, QAbstractSpinBox:focus {{ border-color: {accent}; }}
QListWidget::item {{ padding: 4px 2px; }}
QFrame[role="card"] {{ background: {panel}; border: 1px solid {line}; border-radius: 6px; }}
QFrame[role="card"] QLabel {{ background: transparent; }}
QAbstractItemView::item:disabled {{ color: {stale}; }}
QPushButton[large="true"] {{ min-height: 40px; }}
QComboBox::drop-down {{ border: none; width: 22px; }}
QComboBox::down-arrow, QAbstractSpinBox::down-arrow {{ image: url({pictures}/down-{which}.svg);
  width: 12px; height: 12px; }}
QAbstractSpinBox::up-arrow {{ image: url({pictures}/up-{which}.svg); width: 12px; height: 12px; }}
QAbstractSpinBox::up-button {{ subcontrol-position: top right; width: 22px; border: none; }}
QAbstractSpinBox::down-button {{ subcontrol-position: bottom right; width: 22px; border: none; }}
QHeaderView::section {{ background: {background}; color: {muted}; border: none;
  border-bottom: 1px solid {line}; padding: 4px 3px; }}
QLabel[role="title"] {{ font-size: 15pt; font-weight: 600; }}
QLabel[role="number"] {{ font-size: 26pt; font-weight: 600; }}
QLabel[role="muted"] {{ color: {muted}; }}
QLabel[role="bad"] {{ color: {bad}; }}
QGroupBox {{ border: 1px solid {line}; border-radius: 6px; margin-top: 20px; padding: 2px 0px 0px 0px;
  font-weight: 600; }}
QGroupBox::title {{ subcontrol-origin: margin; left: 2px; color: {muted}; }}
QDockWidget {{ titlebar-close-icon: url({pictures}/close-{which}.svg);
  titlebar-normal-icon: url({pictures}/float-{which}.svg); }}
QDockWidget::title {{ background: {background}; padding: 6px 8px 2px 8px; border-bottom: 1px solid {line}; }}
QCheckBox, QRadioButton {{ min-height: 28px; spacing: 8px; }}
QCheckBox, QRadioButton, QSlider {{ border: 1px solid transparent; border-radius: 4px; }}
QCheckBox:focus, QRadioButton:focus, QSlider:focus {{ border-color: {accent}; }}
QRadioButton::indicator {{ width: 18px; height: 18px; }}
QCheckBox::indicator {{ width: 16px; height: 16px; border: 1px solid {muted}; border-radius: 3px;
  background: {panel}; }}
QCheckBox::indicator:disabled {{ border-color: {line}; }}
QCheckBox::indicator:checked {{ image: url({pictures}/check-{which}.svg); }}
QTabWidget::pane {{ border: none; border-top: 1px solid {line}; }}
QTabBar {{ qproperty-drawBase: 0; }}
QTabBar::tab {{ min-height: 26px; padding: 4px 5px; border: none; border-bottom: 3px solid transparent;
  background: transparent; color: {muted}; }}
QTabBar::tab:selected {{ color: {text}; border-bottom-color: {accent}; }}
QTabBar::tab:hover, QTabBar::tab:focus {{ color: {text}; background: {panel}; }}
QToolBar {{ background: {panel}; border: none; border-bottom: 1px solid {line}; spacing: 6px; padding: 3px 6px; }}
QStatusBar {{ background: {panel}; border-top: 1px solid {line}; }}
QStatusBar::item {{ border: none; }}
QStatusBar QPushButton {{ min-height: 20px; padding: 2px 14px; }}
QMenuBar {{ background: {panel}; }}
QMenuBar::item {{ padding: 5px 10px; background: transparent; }}
QMenuBar::item:selected, QMenu::item:selected {{ background: {accent}; color: {panel}; }}
QMenu {{ background: {panel}; border: 1px solid {line}; }}
QMenu::item {{ padding: 5px 28px 5px 22px; }}
QMenu::item:disabled {{ color: {stale}; }}
QMenu::separator {{ height: 1px; background: {line}; margin: 4px 8px; }}
QProgressBar {{ border: 1px solid {line}; border-radius: 5px; text-align: center; background: {background};
  color: {text}; min-height: 16px; }}
QProgressBar::chunk {{ background: {line}; border-radius: 4px; }}
QScrollArea {{ border: none; background: transparent; }}
QScrollBar:vertical {{ background: transparent; border: none; width: 14px; margin: 0px; }}
QScrollBar:horizontal {{ background: transparent; border: none; height: 14px; margin: 0px; }}
QScrollBar::handle {{ background: {line}; border-radius: 4px; margin: 3px; }}
QScrollBar::handle:vertical {{ min-height: 40px; }}
QScrollBar::handle:horizontal {{ min-width: 40px; }}
QScrollBar::handle:hover, QScrollBar::handle:pressed {{ background: {stale}; }}
QScrollBar::add-line, QScrollBar::sub-line {{ width: 0px; height: 0px; }}
QScrollBar::add-page, QScrollBar::sub-page {{ background: transparent; }}
QSplitter::handle, QMainWindow::separator {{ background: {line}; }}
QMainWindow::separator {{ width: 4px; height: 4px; }}
"""


# ---- our own line icons: drawn on a grid of 24, coloured for the theme, sharp at any size --------


# What is inside <svg viewBox="0 0 24 24">; F stands for the colour where something is filled.
_SHAPES: dict[str, str] = {
    "locked": '<rect x="5" y="11" width="14" height="9" rx="2"/><path d="M8 11V8a4 4 0 0 1 8 0v3"/>',
    "ready": '<circle cx="12" cy="12" r="8.5"/>',
    "running": '<path d="M20 12a8 8 0 1 1-3-6.2"/><path d="M17.5 2v4h-4"/>',
    "done": '<circle cx="12" cy="12" r="9"/><path d="M7.5 12.5l3 3 6-6.5"/>',
    "failed": '<path d="M8 3h8l5 5v8l-5 5H8l-5-5V8z"/><path d="M9 9l6 6M15 9l-6 6"/>',
    "stale": '<path d="M4 7a9 9 0 1 1-1 6"/><path d="M3.5 3v4.5H8"/><path d="M12 8v4.5l3 2"/>',
    "play": '<path d="M7 4.5v15l12-7.5z"/>',
    "full": '<path d="M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"/>',
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
    "moving": '<path d="M4 8h16l-4-4M20 16H4l4 4"/>',
    "settling": '<path d="M2 12q2.5-16 5 0t5 0q1.5-9 3 0t3 0q1-5 2 0t2 0"/>',
    "touched": '<path d="M12 3v12M7.5 10.5L12 15l4.5-4.5M4 20h16"/>',
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


def smooth_painter(device: QPaintDevice) -> QPainter:
    """Return a painter that draws smooth edges."""
    painter = QPainter(device)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    return painter


def sized(font: QFont, points: float, *, bold: bool = False) -> QFont:
    """Return a font in another size."""
    made = QFont(font)
    made.setPointSizeF(points)
    made.setBold(bold)
    return made


def draw_fitted(
    painter: QPainter,
    box: QRectF,
    text: str,
    points: float,
    least: float,
    flags: Qt.AlignmentFlag | Qt.TextFlag | int,
    *,
    bold: bool = False,
) -> float:
    """
    Draw a text in a box, in a font of so many points, or in a smaller one in which it fits, down to `least`.

    Returns
    -------
    float
        How high the text is, px.
    """
    font = QFont(painter.font())
    while True:
        painter.setFont(sized(font, points, bold=bold))
        taken = painter.boundingRect(box, flags, text)
        if points <= least or (taken.height() <= box.height() and taken.width() <= box.width()):
            break
        points -= 1.0
    painter.drawText(box, flags, text)
    painter.setFont(font)
    return float(taken.height())


def state_icon(state: StepState) -> QIcon:
    """Return the icon of a step's state, the same everywhere."""
    return icon(state.value, _OF_STATE[state])


def state_colour(state: StepState) -> str:
    """Return the name of the theme's colour for a step's state."""
    return _OF_STATE[state]
