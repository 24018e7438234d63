"""The heatmap viewer: a window of its own, or inside the main one."""

import sys
from pathlib import Path

from contactbench.app.heatmap_viewer.viewer import HeatmapViewer

__all__ = ["HeatmapViewer", "run"]


def run(paths: list[Path]) -> int:
    """
    Show the heatmap viewer until it is closed.

    Parameters
    ----------
    paths : list of Path
        Recordings, contacts, verifications, sessions, with their probe and calibration.

    Returns
    -------
    int
        Exit code.
    """
    from PySide6.QtCore import QCoreApplication
    from PySide6.QtWidgets import QApplication

    from contactbench.widgets.theme import dress

    application = QApplication.instance() or QApplication(sys.argv[:1])
    viewer = HeatmapViewer()
    viewer.setWindowTitle(QCoreApplication.translate("HeatmapViewer", "Heatmaps - contactbench"))
    dress(viewer)
    viewer.resize(1280, 800)
    viewer.show()
    if paths:
        viewer.open(paths)
    try:
        return int(application.exec())
    finally:
        viewer.close_viewer()
