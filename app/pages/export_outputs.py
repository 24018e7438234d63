"""Live outputs: where contacts go while devices are open, their addresses, and how each is doing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QCheckBox, QLabel, QLineEdit, QWidget

from contactbench.app.undo import Weight
from contactbench.widgets.controls import (
    check_box,
    column,
    named,
    push_button,
    row,
    sentence_label,
    show_quietly,
)
from contactbench.widgets.numbers import filled, translated

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.undo import Bench
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.live import OutputState

_LOOK_MS = 100  # ten lines a second say that no sample comes
SETTING = "outputs.addresses"
"""Setting of the session: outputs that were started last, with their addresses."""


class LiveOutputsPanel(QWidget):
    """
    A row for each output, and a button that starts and stops them.

    Parameters
    ----------
    bench : Bench
    unverified : callable
        Tells whether a bundle that is not verified is wanted.
    """

    def __init__(self, bench: Bench, unverified: Callable[[], bool], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        from contactbench.pipeline.runtime.outputs import OUTPUTS
        from contactbench.pipeline.workbench.live import LiveOutputs

        self._bench, self._unverified = bench, unverified
        self.outputs = LiveOutputs(bench.live)
        self._busy = self._was_running = self._closed = False
        self.chosen: dict[str, QCheckBox] = {}
        self.addresses: dict[str, QLineEdit] = {}
        self.states: dict[str, QLabel] = {}
        parts: list[QWidget] = []
        for option, output in OUTPUTS.items():
            if not output.title:
                continue
            title = translated(output.title)
            self.chosen[option] = check_box(title)
            address = QLineEdit(output.usual, maxLength=300)
            self.addresses[option] = named(address, self.tr("Address of {output}").format(output=title))
            self.states[option] = sentence_label(role="muted")
            self.states[option].hide()
            parts += [self.chosen[option], address, self.states[option]]
        self.remote = check_box(
            self.tr("Allow other machines"), tip=self.tr("Contacts are neither encrypted nor signed")
        )
        self.button = push_button("", self._toggle)
        column(
            self,
            sentence_label(self.tr("Send contacts while devices are open, as contactbench run does.")),
            *parts,
            self.remote,
            row((self.button, 1)),
        )
        self._timer = QTimer(self, interval=_LOOK_MS)
        self._timer.timeout.connect(self.look)
        self._show_running()

    def show_session(self) -> None:
        """Show what the session knows of the outputs."""
        setting = self._bench.desk.state.settings.get(SETTING)
        known = setting.value if setting is not None and isinstance(setting.value, dict) else {}
        for option, field in self.addresses.items():
            address = known.get(option)
            if isinstance(address, str) and not self.outputs.running:
                show_quietly(field, address[:300])
                show_quietly(self.chosen[option], True)

    def close_panel(self) -> None:
        """Stop them; the window goes."""
        self._closed = True
        self._timer.stop()
        self.outputs.stop()

    def look(self) -> None:
        """Show how the outputs are doing."""
        states = {state.option: state for state in self.outputs.look()}
        for option, label in self.states.items():
            state = states.get(option)
            label.setVisible(state is not None)
            if state is not None:
                label.setText(self._words(state))
        if self.outputs.running != self._was_running:
            self._show_running()

    def _words(self, state: OutputState) -> str:
        if state.error:
            return translated(state.error)
        if state.lost:
            return filled(
                self.tr("{published:,} contacts sent, {lost:,} lost: the receiver is missing or too slow."),
                published=state.published,
                lost=state.lost,
            )
        return filled(self.tr("{published:,} contacts sent."), published=state.published)

    def _show_running(self) -> None:
        running = self._was_running = self.outputs.running
        self.button.setText(self.tr("Stop outputs") if running else self.tr("Start outputs"))
        self.button.setEnabled(not self._busy)
        for widget in (*self.chosen.values(), *self.addresses.values(), self.remote):
            widget.setEnabled(not running and not self._busy)
        if not running:
            for label in self.states.values():
                label.hide()
        (self._timer.start if running else self._timer.stop)()

    def _toggle(self) -> None:
        if self.outputs.running:
            self._begin(self.tr("Stopping outputs"), lambda _: self.outputs.stop())
            return
        addresses = {
            option: self.addresses[option].text().strip()
            for option, box in self.chosen.items()
            if box.isChecked()
        }
        unverified, remote = self._unverified(), self.remote.isChecked()

        def start(session: Session) -> None:
            from contactbench.pipeline.workbench.export import built

            config = built(session, unverified=True)
            if session.state.settings.get(SETTING) is None or session.state.setting(SETTING) != addresses:
                session.set_parameter(SETTING, addresses)
            self.outputs.start(config, addresses, unverified=unverified, remote=remote)

        self._begin(self.tr("Starting outputs"), start)

    def _begin(self, title: str, action: Callable[[Session], None]) -> None:
        self._busy = True
        self._show_running()

        def done(_: object) -> None:
            self._busy = False
            if self._closed:
                self.outputs.stop()
                return
            self._show_running()

        def wrong(error: BaseException) -> None:
            self._busy = False
            if not self._closed:
                self._show_running()
            self._bench.tell_error(error, Weight.WARNING)

        self._bench.do(title, action, done, wrong)
