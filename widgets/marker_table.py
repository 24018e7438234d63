"""The markers as a table: name, place, touches, error, state."""

from collections.abc import Sequence
from dataclasses import replace

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QAbstractItemView, QSizePolicy, QTableWidget, QTableWidgetItem, QWidget

from contactbench.pipeline.workbench.verify_touches import MarkerRow
from contactbench.widgets.controls import StretchedColumn, plain_table
from contactbench.widgets.messages import filled, number
from contactbench.widgets.theme import icon

_NAME, _PLACE, _TOUCHES, _ERROR, _STATE = range(5)


class MarkerTable(QTableWidget):
    """Shows markers; what is typed or deleted is only asked for."""

    rename_wanted = Signal(str, str)  # from, to
    remove_wanted = Signal(list)  # names

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, 5, parent)
        self._rows: tuple[MarkerRow, ...] = ()
        titles = [
            self.tr("Marker"),
            self.tr("x  y  z"),
            self.tr("Touches"),
            self.tr("Error"),
            self.tr("State"),
        ]
        self.setHorizontalHeaderLabels(titles)
        for column, words in (
            (_PLACE, self.tr("Position in the sensor frame S, mm")),
            (_TOUCHES, self.tr("Accepted and required touches")),
            (_ERROR, self.tr("Mean error and largest error, mm")),
        ):
            item = self.horizontalHeaderItem(column)
            if item is not None:
                item.setToolTip(words)
        self.setAccessibleName(self.tr("Markers"))
        plain_table(self)
        StretchedColumn(self, _NAME)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setAlternatingRowColors(True)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        self.itemChanged.connect(self._typed)

    @property
    def current_name(self) -> str | None:
        """The marker that is selected, if one is."""
        names = self.selected_names
        return names[0] if len(names) == 1 else None

    @property
    def selected_names(self) -> list[str]:
        """All that are selected, in order."""
        rows = sorted({index.row() for index in self.selectedIndexes()})
        return [self._rows[row].name for row in rows if row < len(self._rows)]

    def select(self, name: str) -> None:
        """Select a marker, if it is there."""
        for row, each in enumerate(self._rows):
            if each.name == name:
                self.selectRow(row)
                return

    def show_rows(self, rows: Sequence[MarkerRow], next_one: int | None = None) -> None:
        """Show markers, and which of them is next; those that stayed the same are not touched."""
        before = self._rows
        self._rows = tuple(
            replace(row, state="next") if place == next_one and row.state == "open" else row
            for place, row in enumerate(rows)
        )
        if before == self._rows:
            return
        with QSignalBlocker(self):
            if len(before) != len(self._rows):
                self.clearSelection()
                self.setRowCount(len(self._rows))
            for row, each in enumerate(self._rows):
                if row >= len(before) or before[row] != each:
                    self._fill(row, each)

    def _fill(self, row: int, marker: MarkerRow) -> None:
        error = ""
        if marker.mean_mm is not None and marker.max_mm is not None:
            error = number(marker.mean_mm, ".2f")
            if marker.touches > 1:
                error += filled(" / {:.2f}", marker.max_mm)
        word, *look = self._looks()[marker.state]
        place = "  ".join(str(round(value)) for value in marker.point_mm)
        texts = (marker.name, place, f"{marker.touches} / {marker.wanted}", error, word)
        x, y, z = (number(value, ".2f") for value in marker.point_mm)
        tip = self.tr("{name}: x {x} mm, y {y} mm, z {z} mm").format(name=marker.name, x=x, y=y, z=z)
        for column, text in enumerate(texts):
            item = self.item(row, column)
            if item is None:
                item = QTableWidgetItem()
                self.setItem(row, column, item)
            flags = Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsEnabled
            item.setFlags(flags | Qt.ItemFlag.ItemIsEditable if column == _NAME else flags)
            item.setText(text)
            if column in (_TOUCHES, _ERROR):
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            item.setToolTip(tip)
        first = self.item(row, _STATE)
        if first is not None:
            first.setIcon(icon(*look))

    def _looks(self) -> dict[str, tuple[str, str, str]]:
        """Return a word for each state, its icon, and the theme's colour for that."""
        return {
            "open": (self.tr("open"), "ready", "muted"),
            "next": (self.tr("next"), "play", "accent"),
            "done": (self.tr("done"), "done", "good"),
            "failed": (self.tr("too far off"), "warning", "bad"),
            "skipped": (self.tr("left out"), "remove", "stale"),
        }

    def _typed(self, item: QTableWidgetItem) -> None:
        if item.column() != _NAME or item.row() >= len(self._rows):
            return
        old, new = self._rows[item.row()].name, item.text().strip()
        with QSignalBlocker(self):
            item.setText(old)  # until whoever is asked has done it
        if new and new != old:
            self.rename_wanted.emit(old, new)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Ask for markers to be removed with Delete."""
        if event.matches(QKeySequence.StandardKey.Delete) and self.selected_names:
            self.remove_wanted.emit(self.selected_names)
            return
        super().keyPressEvent(event)
