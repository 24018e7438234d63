"""What every step's page is."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from PySide6.QtWidgets import QVBoxLayout, QWidget

from contactbench.widgets.action_bar import ActionBar

if TYPE_CHECKING:
    from contactbench.app.undo import Bench
    from contactbench.pipeline.steps import Step, StepStatus


class Page(QWidget):
    """
    The controls of one step, on the right of the window: what `fill` put there, above what to do next.

    Attributes
    ----------
    step : Step
        Of the class.
    bar : ActionBar
        At the foot, at the same place on every page.
    """

    step: ClassVar[Step]

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.bench = bench
        self.bar = ActionBar()
        self._foot = QVBoxLayout(self)
        self._foot.setContentsMargins(0, 0, 0, 0)
        self._foot.setSpacing(0)
        self._foot.addStretch()
        self._foot.addWidget(self.bar)

    def fill(self, body: QWidget) -> None:
        """Put what the page is made of above its foot."""
        self._foot.takeAt(0)
        self._foot.insertWidget(0, body, 1)

    def enter(self) -> None:
        """Be shown: set the scene up as this step needs it, and begin to follow what is live."""

    def leave(self) -> None:
        """Be hidden: end what only this page needs; what runs goes on."""

    def show_state(self, status: StepStatus) -> None:
        """Show how the step stands; called whenever the session or that changed."""

    def tick(self) -> None:
        """Show the newest of what is live; called 30 times a second while the page is shown."""

    def watch(self) -> None:
        """See what goes on, and tell what somebody should know; called twice a second, shown or not."""

    def close_page(self) -> None:
        """End everything: the session is being closed."""
