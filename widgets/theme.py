"""Colours of both themes, and the style sheet made of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QGuiApplication, QPalette
from PySide6.QtWidgets import QApplication

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QWidget

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
    for which, colour in (
        (role.Window, c.background),
        (role.WindowText, c.text),
        (role.Base, c.panel),
        (role.AlternateBase, c.background),
        (role.Text, c.text),
        (role.Button, c.panel),
        (role.ButtonText, c.text),
        (role.BrightText, c.bad),
        (role.PlaceholderText, c.muted),
        (role.ToolTipBase, c.panel),
        (role.ToolTipText, c.text),
        (role.Highlight, c.accent),
        (role.HighlightedText, c.panel),
        (role.Link, c.accent),
        (role.LinkVisited, c.accent),
        (role.Mid, c.line),
        (role.Midlight, c.line),
        (role.Dark, c.line),
        (role.Light, c.panel),
    ):
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
    c = colours(dark)
    return _SHEET.format(
        text=c.text,
        muted=c.muted,
        panel=c.panel,
        background=c.background,
        line=c.line,
        accent=c.accent,
        stale=c.stale,
        bad=c.bad,
        pictures=_PICTURES.as_posix(),
        which="dark" if dark else "light",
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
