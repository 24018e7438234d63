"""How good the devices are: a big rate, what is lost, noise and margin of each channel, and findings in words."""

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QWidget

from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.workbench.live_trial import ConnectionTrial
from contactbench.widgets.controls import beside, column, plain_label, sentence_label
from contactbench.widgets.messages import filled, translated
from contactbench.widgets.theme import Sign, icon

_CHANNELS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
_ICON_PX = 24


class DeviceTrial(QFrame):
    """What a connection is worth; `show_trial` brings it up to date."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.tr("Connection"))
        self._icon, self._facts, self._findings = (
            Sign(_ICON_PX),
            sentence_label("", "muted"),
            sentence_label(),
        )
        self._state, self._rate = plain_label("", "title"), plain_label("", "number")
        self._rate.setToolTip(self.tr("Measured readings per second"))
        head = beside(None, self._icon, (self._state, 1), self._rate)
        column(self, head, self._facts, self._findings, space=-1)
        self.show_trial(None)

    def show_trial(self, trial: ConnectionTrial | None) -> None:
        """Show what was measured; None: nothing is open."""
        name, colour, words = self._standing(trial)
        self._icon.show_icon(icon(name, colour))
        self._state.setText(words)
        rate = None if trial is None else trial.rate
        self._rate.setText(self.tr("– Hz") if rate is None else filled(self.tr("{rate:.0f} Hz"), rate=rate))
        self._facts.setText("" if trial is None else self._counted(trial))
        self._facts.setVisible(trial is not None)
        self._findings.setText(
            "" if trial is None else "\n\n".join(translated(sentence) for sentence in trial.sentences)
        )
        self._findings.setVisible(trial is not None and bool(trial.sentences))

    @property
    def words(self) -> str:
        """All that is said, as text."""
        return "\n".join(label.text() for label in (self._state, self._rate, self._facts, self._findings))

    def _standing(self, trial: ConnectionTrial | None) -> tuple[str, str, str]:
        if trial is None:
            return "ready", "muted", self.tr("Not connected")
        if trial.state is StreamState.STREAMING:
            if trial.sentences:
                return "warning", "warning", self.tr("Connected")
            return "done", "good", self.tr("Connected")
        return {
            StreamState.CONNECTING: ("running", "accent", self.tr("Waiting")),
            StreamState.SILENT: ("warning", "warning", self.tr("Silent")),
            StreamState.LOST: ("failed", "bad", self.tr("Lost")),
        }.get(trial.state, ("stop", "muted", self.tr("Ended")))

    def _counted(self, trial: ConnectionTrial) -> str:
        gaps = self.tr("no gaps")
        if trial.gaps:
            gaps = filled(
                self.tr("{count} gaps in 5 s, longest {longest:.0f} ms"),
                count=trial.gaps,
                longest=1e3 * trial.longest_gap,
            )
        poses = self.tr("no poses")
        if trial.pose_rate is not None:
            poses = filled(self.tr("poses {rate:.0f} Hz"), rate=trial.pose_rate)
        return filled(
            self.tr("{samples:,} readings, {lost:,} lost, {gaps}; {poses}"),
            samples=trial.samples,
            lost=trial.lost,
            gaps=gaps,
            poses=poses,
        )


class DeviceChannels(QWidget):
    """Noise, largest reading and margin of each channel; `show_trial` brings it up to date."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.tr("Noise and headroom per channel"))
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(4)
        heads = (
            (self.tr("channel"), ""),
            (self.tr("noise"), self.tr("Standard deviation of one reading at rest, N or N·m")),
            (self.tr("largest"), self.tr("Largest absolute reading in the last 5 s, N or N·m")),
            (self.tr("of range"), self.tr("Share of the sensor's range; readings above 100 % are clipped")),
        )
        for at, (text, tip) in enumerate(heads):
            label = plain_label(text, "muted")
            label.setToolTip(tip)
            if at:
                label.setAlignment(Qt.AlignmentFlag.AlignRight)
            grid.addWidget(label, 0, at)
        self._cells: list[tuple[QLabel, QLabel, QLabel]] = []
        for row, name in enumerate(_CHANNELS, start=1):
            cells = (QLabel(), QLabel(), QLabel())
            grid.addWidget(QLabel(name), row, 0)
            for at, cell in enumerate(cells, start=1):
                cell.setAlignment(Qt.AlignmentFlag.AlignRight)
                grid.addWidget(cell, row, at)
            self._cells.append(cells)
        self.show_trial(None)

    def show_trial(self, trial: ConnectionTrial | None) -> None:
        """Show what was measured; None: nothing is open."""
        for index, cells in enumerate(self._cells):
            self._show_channel(index, cells, trial)

    def _show_channel(
        self, index: int, cells: tuple[QLabel, QLabel, QLabel], trial: ConnectionTrial | None
    ) -> None:
        unit, digits = ("N", 3) if index < 3 else ("N·m", 4)
        noise = np.nan if trial is None else trial.noise[index]
        largest = np.nan if trial is None else trial.largest[index]
        used = np.nan if trial is None or trial.range_used is None else trial.range_used[index]
        cells[0].setText(filled("{:.{}f} {}", noise, digits, unit) if np.isfinite(noise) else "–")
        cells[1].setText(filled("{:.{}f} {}", largest, digits - 1, unit) if np.isfinite(largest) else "–")
        cells[2].setText(filled("{:.0f} %", 100 * used) if np.isfinite(used) else self.tr("unknown"))
