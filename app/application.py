"""Starting the window: the Qt application, its theme and language, and what happens to errors."""

import signal
import sys
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QIcon, QPixmapCache
from PySide6.QtWidgets import QApplication

from contactbench.app.errors import Faults, LogFile
from contactbench.app.settings import WindowSettings
from contactbench.app.translation import in_use, keep_said, load, recall_said
from contactbench.app.window import MainWindow
from contactbench.widgets.software_gl import spare_cores
from contactbench.widgets.theme import follow_system, use_theme

# Streams and workers share one interpreter with the window, which waits so long for each of them at most: Python's
# 5 ms, a hundred times in a frame, are a window that hangs.
_SWITCH_S = 0.0005
# The axes of the charts are kept as pictures: 1 MB each on a large screen, and Qt keeps ten.
_PIXMAPS_KB = 64 * 1024
# Its package is not asked: that would load the probes in it, and with them scipy, before the window is there.
_ICON = Path(__file__).parents[1] / "assets" / "icon.svg"


def run(session: Path | None = None, *, virtual: bool = False, language: str = "") -> int:
    """
    Open the window, and return when it is closed.

    Parameters
    ----------
    session : path, optional
        Opened at once; with `virtual`, made where there is none. An archive is unpacked first.
    virtual : bool
        Whether to begin with a virtual bench.
    language : str
        Such as "de"; empty: as remembered, or that of the computer.

    Returns
    -------
    int
        Exit code.
    """
    application = prepared()
    settings, faults, log = WindowSettings(), Faults(), LogFile()
    if load(application, language or settings.now.language) != "en":
        recall_said(settings.file.parent)
    use_theme(settings.now.theme)
    window = MainWindow(settings, faults, log)
    faults.install()
    follow_system(lambda: settings.now.theme)
    window.show()
    for number in (signal.SIGINT, signal.SIGTERM):  # the heartbeat lets Python see them
        signal.signal(number, lambda *_: window.close())
    if virtual:
        window.sessions.try_virtual(session)
    elif session is not None and session.is_file():
        window.sessions.unpack(session)
    elif session is not None:
        window.sessions.open(session)
    try:
        return application.exec()
    finally:
        if in_use() != "en":
            keep_said(settings.file.parent)
        faults.uninstall()
        log.close()


def prepared() -> QApplication:
    """Return the Qt application, made and named if there is none yet."""
    # the 3D view may be a window of its own; what lies beside it need not
    QApplication.setAttribute(Qt.ApplicationAttribute.AA_DontCreateNativeWidgetSiblings)
    application = QApplication.instance()
    if not isinstance(application, QApplication):
        application = QApplication(sys.argv[:1])
    sys.setswitchinterval(_SWITCH_S)
    spare_cores()
    application.setApplicationName("contactbench")
    application.setDesktopFileName("contactbench")
    application.setStyle("Fusion")  # the same everywhere, and it keeps to the palette
    QPixmapCache.setCacheLimit(_PIXMAPS_KB)
    application.setWindowIcon(QIcon(str(_ICON)))
    return application
