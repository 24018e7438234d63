"""What every step's page is."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from PySide6.QtWidgets import QWidget

if TYPE_CHECKING:
    from contactbench.app.bench import Bench
    from contactbench.pipeline.workbench.steps import Step, StepStatus


class Page(QWidget):
    """
    The controls of one step, on the right of the window.

    Attributes
    ----------
    step : Step
        Of the class.
    """

    step: ClassVar[Step]

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.bench = bench

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
