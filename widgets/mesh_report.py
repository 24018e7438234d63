"""What is known about a mesh, as sentences with icons; the important ones first."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPixmap, QPolygonF, QTransform
from PySide6.QtWidgets import QPushButton, QSizePolicy, QWidget

from contactbench.pipeline.errors import message
from contactbench.pipeline.mesh.inspect import Inspection
from contactbench.widgets.controls import beside, called, column, sentence_label
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import Sign, colours, icon, is_dark, smooth_painter

_ICON_PX = 20
_SHOWN = 2
# Level -> icon, name of the theme's colour, word.
_LOOKS = {
    "fault": ("failed", "bad", message("Fault")),
    "doubt": ("warning", "warning", message("Check")),
    "note": ("info", "muted", message("Note")),
    "good": ("done", "good", message("Good")),
}


PICTURE = QSize(96, 44)


def size_icon(outline_mm: NDArray[np.float64]) -> QIcon:
    """
    Draw a silhouette and a bank card to one scale, the larger behind the smaller.

    Parameters
    ----------
    outline_mm : (k, 2) float64
        Corners about its middle, the longest extent along the first axis.
    """
    image = QPixmap(PICTURE * 2)
    image.setDevicePixelRatio(2)
    image.fill(Qt.GlobalColor.transparent)
    theme = colours(is_dark())
    card = QPolygonF(QRectF(-42.8, -27.0, 85.6, 54.0))
    probe = QPolygonF([QPointF(x, y) for x, y in outline_mm.tolist()])
    both = card.boundingRect().united(probe.boundingRect())
    scale = 0.95 * min(PICTURE.width() / both.width(), PICTURE.height() / both.height())
    painter = smooth_painter(image)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setTransform(QTransform(scale, 0, 0, scale, PICTURE.width() / 2, PICTURE.height() / 2))
    for shape in sorted((card, probe), key=lambda each: -each.boundingRect().width()):
        painter.setBrush(QColor(theme.muted if shape is card else theme.accent))
        painter.drawPolygon(shape)
    painter.end()
    return QIcon(image)


class MeshReport(QWidget):
    """
    Sentences one below the other.

    Parameters
    ----------
    shown : int
        How many are shown at once; the others on demand.
    parent : QWidget, optional
    """

    def __init__(self, shown: int = _SHOWN, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shown = shown
        self.sentences: tuple[tuple[str, str], ...] = ()
        self._rows: list[QWidget] = []
        self.more = QPushButton(flat=True)
        self.more.setCheckable(True)
        self.more.toggled.connect(self._show_rows)
        self._layout = column(self, self.more, space=6)
        self.show_sentences(())

    def show_inspection(self, inspection: Inspection | None, mended: bool = False) -> None:
        """Show what an inspection found; None: nothing; `mended`: its faults are those of a file that was mended."""
        if inspection is None:
            self.show_sentences(())
            return
        # The sentence of the unit names an option of the command.
        asked = "" if inspection.unit is None else inspection.unit.doubt
        choose = self.tr("The file leaves the unit of its numbers open: choose the length of the probe.")
        found: list[tuple[str, str]] = [
            (each.level, choose if each.text == asked else each.text) for each in inspection.findings
        ]
        if mended and any(level == "fault" for level, _ in found):
            found = [("note" if level == "fault" else level, text) for level, text in found]
            found.insert(0, ("good", self.tr("The outer surface has none of the file's faults:")))
        elif inspection.clear:
            found.insert(0, ("good", self.tr("No problems found that affect contacts.")))
        self.show_sentences((*found, *(("note", fact) for fact in inspection.facts)))

    def show_sentences(self, sentences: Sequence[tuple[str, str]]) -> None:
        """Show levels ("fault", "doubt", "note" or "good") and texts."""
        if self.sentences == tuple(sentences) and self._rows:
            return  # what is unfolded stays so
        self.sentences = tuple(sentences)
        for row in self._rows:
            self._layout.removeWidget(row)
            row.deleteLater()
        self._rows = [self._row(level, text) for level, text in self.sentences]
        for number, row in enumerate(self._rows):
            self._layout.insertWidget(number, row)
        self.more.setChecked(False)
        self._show_rows()

    def _row(self, level: str, text: str) -> QWidget:
        row = QWidget(self)
        *look, word = _LOOKS[level]
        mark = called(Sign(_ICON_PX), translated(word), translated(word))
        mark.show_icon(icon(*look))
        words = sentence_label(translated(text))
        words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        beside(row, (mark, 0, Qt.AlignmentFlag.AlignTop), (words, 1), space=8)
        return row

    def _show_rows(self) -> None:
        every = self.more.isChecked()
        for number, row in enumerate(self._rows):
            row.setVisible(every or number < self._shown)
        hidden = len(self._rows) - self._shown
        self.more.setVisible(hidden > 0)
        self.more.setText(self.tr("Show less") if every else self.tr("Show {} more").format(max(hidden, 0)))
        self.setVisible(bool(self._rows))
