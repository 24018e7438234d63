"""Leaving a marker out: only with a reason, which the verdict and the report repeat."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QInputDialog

from contactbench.app.bench import Weight

if TYPE_CHECKING:
    from contactbench.app.pages.verify import VerifyPage

_LONGEST = 200  # characters of a reason


class Leaving(QObject):
    """
    Asks why the next marker is left out, and leaves it out.

    Parameters
    ----------
    page : VerifyPage
    """

    def __init__(self, page: VerifyPage) -> None:
        super().__init__(page)
        self._page = page

    def ask(self) -> None:
        """Ask for the reason; touches go on meanwhile."""
        touches = self._page.work.touches
        view = None if touches is None else touches.view()
        if view is None or view.next_one is None:
            return
        name = view.rows[view.next_one].name
        dialog = QInputDialog(self._page.window())
        dialog.setWindowTitle(self.tr("Leave {name} out").format(name=name))
        dialog.setLabelText(self.tr("Why is {name} not touched? The report says so.").format(name=name))
        dialog.setComboBoxEditable(True)
        dialog.setComboBoxItems(
            [
                self.tr("nothing reaches it"),
                self.tr("the mark cannot be seen any more"),
                self.tr("the housing gives way there"),
                self.tr("a touch there would do damage"),
            ]
        )
        dialog.setOkButtonText(self.tr("Leave it out"))
        dialog.textValueSelected.connect(lambda why: self.leave_out(name, why))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def leave_out(self, name: str, why: str) -> None:
        """Leave a marker out for a reason, if it is still the next one."""
        touches, why, bench = self._page.work.touches, " ".join(why.split())[:_LONGEST], self._page.bench
        if touches is None:
            return
        if not why:
            bench.tell(
                Weight.WARNING,
                self.tr("{name} is not left out: that needs a reason.").format(name=name),
            )
        elif touches.skip(why, name) is None:
            bench.tell(
                Weight.INFO,
                self.tr("{name} is not left out: it was touched meanwhile.").format(name=name),
            )
        else:
            words = self.tr("{name} is left out: {why}. The verdict and the report say so.")
            bench.tell(Weight.WARNING, words.format(name=name, why=why))
