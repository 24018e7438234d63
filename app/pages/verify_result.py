"""The verdict of the Verify page: of the raw recording, as the report has it."""

from pathlib import Path

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QLabel, QWidget

from contactbench.pipeline.errors import capitalised, join
from contactbench.pipeline.verification.figures import Verification
from contactbench.pipeline.verification.model_error import model_error_words
from contactbench.pipeline.workbench.verify import VerifyOutcome
from contactbench.widgets.controls import column, plain_label, push_button, row, sentence_label
from contactbench.widgets.messages import number, translated
from contactbench.widgets.theme import Sign, icon

_ICON = 34


class ResultPanel(QWidget):
    """Shows a verification."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._report: Path | None = None
        self.sign, self.verdict = Sign(_ICON), plain_label("", "title")
        self.verdict.setWordWrap(True)
        self.number, self.range = sentence_label(role="number"), sentence_label(role="muted")
        self.figures, self.why, self.diagnosis = sentence_label(), sentence_label(), sentence_label()
        self.notes, self.model_error = sentence_label(role="muted"), sentence_label()
        self.more = push_button(self.tr("Details"), self._fold)
        self.more.setCheckable(True)
        self.open = push_button(self.tr("Open report"), self._open, "folder")
        self.worst = push_button(
            self.tr("Show the worst marker"),
            None,
            "search",
            tip=self.tr("Turn the 3D view to the marker with the largest error"),
        )
        column(
            self, row(self.sign, (self.verdict, 1), space=10), self.number, self.range, self.why,
            self.worst, self.open, self.more, *self._folded(), margins=(0, 8, 0, 0),
        ).addStretch(1)  # fmt: skip
        self.show_outcome(None)

    def show_outcome(self, outcome: VerifyOutcome | None) -> None:
        """Show a verification; None: there is none yet."""
        self._report = None if outcome is None else outcome.report
        self.open.setVisible(self._report is not None)
        self.open.setToolTip(str(self._report or ""))
        self.worst.setVisible(outcome is not None and outcome.touches > 0 and not outcome.stale)
        if outcome is None:
            self._put(self.tr("Not verified yet"), "ready", "muted")
            self._texts("", "", "", "", "", "", "")
            return
        if outcome.broken:
            self._put(self.tr("Does not count"), "failed", "bad")
        elif outcome.stale:
            self._put(self.tr("Outdated: verify again"), "stale", "stale")
        elif outcome.passed:
            self._put(self.tr("Passed"), "done", "good")
        else:
            self._put(self.tr("Not passed"), "failed", "bad")
        if not outcome.passed:
            self.more.setChecked(True)  # the likely cause is among it
        mean = outcome.mean_mm
        size = self.tr("no accepted touches")
        if mean is not None:
            size = self.tr("{mean} mm").format(mean=number(mean, ".2f"))
        found = outcome.found
        self._texts(
            size,
            self._range(outcome),
            self._why(outcome),
            self._figures(found),
            "" if found.diagnosis is None else found.diagnosis.text,
            join("\n", (*found.verdict.notes, *found.warnings)),
            model_error_words(found.model_error),
        )

    def _put(self, words: str, name: str, colour: str) -> None:
        self.role = "text" if colour == "muted" else colour  # the theme's colour for the verdict
        self.verdict.setText(words)
        self.sign.show_icon(icon(name, colour))

    def _folded(self) -> tuple[QLabel, ...]:
        return self.figures, self.diagnosis, self.notes, self.model_error

    def _texts(self, size: str, extent: str, why: str, *folded: str) -> None:
        labels = (self.number, self.range, self.why, *self._folded())
        for label, text in zip(labels, (size, extent, why, *folded), strict=True):
            label.setText(translated(text))
            label.setVisible(bool(text))
        self._fold()

    def _fold(self) -> None:
        """Show what only some ask for, or not."""
        for label in self._folded():
            label.setVisible(self.more.isChecked() and bool(label.text()))
        self.more.setVisible(any(label.text() for label in self._folded()))

    def _range(self, outcome: VerifyOutcome) -> str:
        if outcome.mean_mm is None:
            return ""
        if outcome.touches == 1:
            return self.tr("error of a single touch")
        ci = outcome.found.ci
        if ci is None:
            return self.tr("mean error of {count} touches").format(count=outcome.touches)
        low, high = ci.mean_mm
        return self.tr("mean error of {count} touches; 95 % CI {low}–{high} mm").format(
            count=outcome.touches, low=number(low, ".2f"), high=number(high, ".2f")
        )

    def _figures(self, found: Verification) -> str:
        overall, limits = found.overall, found.limits
        if overall is None:
            return ""
        lines = [
            self.tr("Largest error: {size} mm (limit {limit} mm)").format(
                size=number(overall.max_mm, ".2f"), limit=number(1e3 * limits.max_m, "g")
            ),
            self.tr("95 % of touches within {size} mm").format(size=number(overall.p95_mm, ".2f")),
            self.tr("Limit of the mean error: {limit} mm").format(limit=number(1e3 * limits.mean_m, "g")),
        ]
        if found.ratio is not None:
            words = self.tr("{ratio} times the expected error (noise and calibration)")
            lines.append(words.format(ratio=number(found.ratio, ".1f")))
        return "\n".join(lines)

    def _why(self, outcome: VerifyOutcome) -> str:
        lines = [outcome.stale] if outcome.stale and not outcome.broken else []
        lines += [
            join("", (capitalised(reason), ".")) if reason else "" for reason in outcome.found.verdict.reasons
        ]
        if rejected := outcome.found.rejected:
            listed = ", ".join(f"{count} × {translated(reason)}" for reason, count in rejected.items())
            lines.append(self.tr("Not counted: {listed}.").format(listed=listed))
        if outcome.differs:
            lines.append(outcome.differs)
        return join("\n", lines)

    def _open(self) -> None:
        if self._report is not None:
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(self._report)))
