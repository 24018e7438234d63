"""The verdict of the Verify page: of the raw recording, as the report has it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from contactbench.widgets.icons import Sign, icon
from contactbench.widgets.phrases import said

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.workbench.verify import Outcome

_TALL, _ICON = 36, 34


class ResultPanel(QWidget):
    """Shows a verification."""

    again_wanted = Signal()
    go_on_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._report: Path | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 8, 0, 0)
        column.setSpacing(8)
        row = QHBoxLayout()
        row.setSpacing(10)
        self.sign, self.verdict = Sign(_ICON), QLabel()
        self.verdict.setProperty("role", "title")
        self.verdict.setWordWrap(True)
        row.addWidget(self.sign)
        row.addWidget(self.verdict, 1)
        column.addLayout(row)
        self.number = self._label("number")
        self.range = self._label("muted")
        self.figures = self._label("")
        self.why = self._label("")
        self.diagnosis = self._label("")
        self.notes = self._label("muted")
        self.model_error = self._label("")
        for label in self._labels():
            column.addWidget(label)
        buttons = QHBoxLayout()
        self.open = QPushButton(icon("folder"), self.tr("Open the report"))
        self.open.setMinimumHeight(_TALL)
        self.open.clicked.connect(self._open)
        self.again = QPushButton(icon("redo"), self.tr("Verify again"))
        self.again.setMinimumHeight(_TALL)
        self.again.clicked.connect(lambda _=False: self.again_wanted.emit())
        buttons.addWidget(self.open, 1)
        buttons.addWidget(self.again, 1)
        column.addLayout(buttons)
        self.go_on = QPushButton(icon("export", "panel"), self.tr("Go on: Export"))
        self.go_on.setProperty("primary", True)
        self.go_on.setMinimumHeight(_TALL)
        self.go_on.clicked.connect(lambda _=False: self.go_on_wanted.emit())
        column.addWidget(self.go_on)
        column.addStretch(1)
        self.show_outcome(None)

    def _label(self, role: str) -> QLabel:
        label = QLabel()
        label.setWordWrap(True)
        label.setTextFormat(Qt.TextFormat.PlainText)
        label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        if role:
            label.setProperty("role", role)
        return label

    def show_outcome(self, outcome: Outcome | None) -> None:
        """Show a verification; None: there is none yet."""
        self._report = None if outcome is None else outcome.report
        self.open.setVisible(self._report is not None)
        self.open.setToolTip(str(self._report or ""))
        self.again.setVisible(outcome is not None)
        self.go_on.setVisible(outcome is not None and outcome.passed and not outcome.stale)
        if outcome is None:
            self._put(self.tr("Not verified yet"), "ready", "muted")
            self._texts("", "", "", "", "", "", "")
            return
        if outcome.stale:
            self._put(self.tr("Stale: verify again"), "stale", "stale")
        elif outcome.passed:
            self._put(self.tr("Passed"), "done", "good")
        else:
            self._put(self.tr("Not passed"), "failed", "bad")
        mean = outcome.mean_mm
        number = (
            self.tr("no touch counted") if mean is None else self.tr("{mean} mm").format(mean=f"{mean:.2f}")
        )
        self._texts(
            number, self._range(outcome), self._figures(outcome), self._why(outcome), outcome.diagnosis,
            "\n".join((*outcome.notes, *outcome.warnings)), outcome.model_error,
        )  # fmt: skip

    def _put(self, words: str, name: str, colour: str) -> None:
        self.verdict.setText(words)
        self.sign.show_icon(icon(name, colour))

    def _labels(self) -> tuple[QLabel, ...]:
        return self.number, self.range, self.figures, self.why, self.diagnosis, self.notes, self.model_error

    def _texts(self, *texts: str) -> None:
        for label, text in zip(self._labels(), texts, strict=True):
            label.setText(said(text))
            label.setVisible(bool(text))

    def _range(self, outcome: Outcome) -> str:
        if outcome.mean_mm is None:
            return ""
        if outcome.touches == 1:
            return self.tr("mean error of one touch")
        if outcome.low_mm is None or outcome.high_mm is None:
            return self.tr("mean error of {count} touches").format(count=outcome.touches)
        return self.tr("mean error of {count} touches; surely between {low} and {high} mm (95 %)").format(
            count=outcome.touches, low=f"{outcome.low_mm:.2f}", high=f"{outcome.high_mm:.2f}"
        )

    def _figures(self, outcome: Outcome) -> str:
        if outcome.mean_mm is None or outcome.max_mm is None:
            return ""
        lines = [
            self.tr("Largest error: {size} mm; up to {limit} mm passes").format(
                size=f"{outcome.max_mm:.2f}", limit=f"{outcome.max_limit_mm:g}"
            ),
            self.tr("Mean error: up to {limit} mm passes").format(limit=f"{outcome.mean_limit_mm:g}"),
        ]
        if outcome.p95_mm is not None:
            lines.insert(1, self.tr("95 % of touches: within {size} mm").format(size=f"{outcome.p95_mm:.2f}"))
        if outcome.ratio is not None:
            lines.append(
                self.tr("{ratio} times what noise and calibration explain").format(
                    ratio=f"{outcome.ratio:.1f}"
                )
            )
        return "\n".join(lines)

    def _why(self, outcome: Outcome) -> str:
        lines = [outcome.stale] if outcome.stale else []
        lines += [f"{reason[0].upper()}{reason[1:]}." if reason else "" for reason in outcome.reasons]
        if outcome.rejected:
            listed = ", ".join(f"{count} × {reason}" for reason, count in outcome.rejected)
            lines.append(self.tr("Not counted: {listed}.").format(listed=listed))
        if outcome.differs:
            lines.append(outcome.differs)
        return "\n".join(lines)

    def _open(self) -> None:
        if self._report is not None:
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(self._report)))
