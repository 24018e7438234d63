"""A hand and an eye at a window: finds what a person sees, by its words, and uses mouse and keys only."""

import time

from PySide6.QtCore import QEvent, QEventLoop, QMimeData, QPoint, QPointF, Qt, QTimer, QUrl
from PySide6.QtGui import QDropEvent, QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDialogButtonBox,
    QFileDialog,
    QLabel,
    QLineEdit,
    QScrollArea,
    QTabBar,
    QWidget,
)

LEFT = Qt.MouseButton.LeftButton


def drop_files(widget, *paths):
    """Let files fall on a widget."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    place, keys = QPointF(widget.rect().center()), Qt.KeyboardModifier.NoModifier
    widget.dropEvent(QDropEvent(place, Qt.DropAction.CopyAction, data, LEFT, keys))


def turn_wheel(view, place, notches, keys=Qt.KeyboardModifier.NoModifier):
    """Turn the wheel over a place of a view."""
    turned, there = QPoint(0, 120 * notches), QPointF(view.mapToGlobal(QPointF(place)))
    kind = Qt.MouseButton.NoButton, keys, Qt.ScrollPhase.NoScrollPhase, False
    QApplication.sendEvent(view, QWheelEvent(QPointF(place), there, QPoint(0, 0), turned, *kind))


class StuckError(AssertionError):
    """What a person waits for does not come."""


class Hand:
    """
    Uses a window as a person does.

    Parameters
    ----------
    window : QWidget
    pictures : path
        Folder for pictures of the screen.
    """

    def __init__(self, window, pictures):
        self.window, self.pictures = window, pictures
        self.log = []  # what was done, and after how many seconds
        self._began = time.monotonic()

    # ---- the eye -----------------------------------------------------------------------------------

    def seen(self, kind=QWidget):
        """Return the widgets of a kind that are on the screen now."""
        return [each for each in self.window.findChildren(kind) if each.isVisible()]

    def words(self):
        """Return everything that can be read, by eyes or by a screen reader."""
        lines = [label.text() for label in self.seen(QLabel)]
        for each in self.seen():
            lines += [each.accessibleName(), each.accessibleDescription()]
        lines += [f"[{name_of(button)}]" for button in self.seen(QAbstractButton)]
        return "\n".join(filter(None, lines))

    def find(self, name, kind=QAbstractButton):
        """Return what is called so, by its text or its accessible name; None: it is not on the screen."""
        names = {each: (name_of(each), each.accessibleName()) for each in self.seen(kind)}
        for match in (str.__eq__, str.startswith):
            for each, called in names.items():
                if any(match(one, name) for one in called):
                    return each
        return None

    def read(self, text, seconds=60.0):
        """Wait until something can be read."""
        self.until(lambda: text in self.words(), f"'{text}' to be read", seconds)

    def reading(self, text):
        """Return the line in which something can be read; empty: none."""
        return next((line for line in self.words().splitlines() if text in line), "")

    def enabled(self, name):
        """Whether there is such a button, and it can be pressed."""
        button = self.find(name)
        return button is not None and button.isEnabled()

    def until(self, condition, what, seconds=60.0):
        """Wait for something; a picture of what is there instead is kept."""
        end = time.monotonic() + seconds
        while True:
            rest(20)
            if condition():
                return
            if time.monotonic() > end:
                file = self.picture("stuck")
                done = "\n".join(self.log[-12:])
                raise StuckError(
                    f"waited {seconds:.0f} s for {what}; the screen is in {file}.\nDone before:\n{done}"
                    f"\nTo be read:\n{self.words()}"
                )

    def picture(self, name):
        """Keep a picture of the screen."""
        self.pictures.mkdir(parents=True, exist_ok=True)
        file = self.pictures / f"{len(list(self.pictures.iterdir())):02}-{name}.png"
        frame = self.window.frameGeometry()
        screen = self.window.screen()
        screen.grabWindow(0, frame.x(), frame.y(), frame.width(), frame.height()).save(str(file))
        return file

    # ---- the hand ----------------------------------------------------------------------------------

    def press(self, name, seconds=60.0):
        """Click a button, a box or a tool, as soon as it can be."""

        self.until(lambda: self.enabled(name), f"the button '{name}'", seconds)
        self._note(f"press {name}")
        button = self.find(name)
        place = QPoint(12, button.height() // 2) if button.isCheckable() else button.rect().center()
        self.click(button, place)

    def tab(self, name, seconds=60.0):
        """Click a tab."""

        def place():
            for bar in self.seen(QTabBar):
                for index in range(bar.count()):
                    if bar.tabText(index) == name and bar.isTabEnabled(index):
                        return bar, bar.tabRect(index).center()
            return None

        self.until(lambda: place() is not None, f"the tab '{name}'", seconds)
        self._note(f"tab {name}")
        self.click(*place())

    def type(self, name, text):
        """Click into a field, type over what is in it, and press Return."""
        self.until(lambda: self.find(name, QWidget) is not None, f"the field '{name}'")
        field = self.find(name, QWidget)
        self._note(f"type {text} into {name}")
        self.click(field, QPoint(20, field.height() // 2))
        target = QApplication.focusWidget() or field
        QTest.keyClick(target, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
        QTest.keyClicks(target, text)
        QTest.keyClick(target, Qt.Key.Key_Return)

    def choose(self, name, entry):
        """Choose an entry of a list by the arrow keys; the list may still be filled meanwhile."""

        def chosen():
            box = self.find(name, QComboBox)
            if box is None or not box.isEnabled():
                return False
            scroll_to(box)
            box.setFocus()
            QTest.keyClick(box, Qt.Key.Key_Home)
            for _ in range(box.count()):
                if box.currentText() == entry:
                    return True
                QTest.keyClick(box, Qt.Key.Key_Down)
            return False

        self._note(f"choose {entry} in {name}")
        self.until(chosen, f"'{entry}' to be chosen in '{name}'")

    def key(self, key, modifier=Qt.KeyboardModifier.NoModifier):
        """Press a key, wherever the keys go now."""
        self._note(f"key {key}")
        if not self.window.isActiveWindow():  # without a window manager nobody else gives it the keys
            self.window.activateWindow()
            self.until(self.window.isActiveWindow, "the window to be active")
        QTest.keyClick(QApplication.focusWidget() or self.window, key, modifier)

    def click(self, widget, place=None):
        """Click at a place of a widget; something that lies over it gets the click, as it would from a person."""
        scroll_to(widget)
        rest(30)
        place = widget.rect().center() if place is None else place
        target, there = self._under(widget, place)
        QTest.mouseClick(target, LEFT, pos=there)

    def drag(self, widget, places):
        """Press the button at the first place, draw along the others, and let go at the last."""
        self._note(f"drag over {len(places)} places")
        target, there = self._under(widget, places[0])
        QTest.mouseMove(target, there)
        QTest.mousePress(target, LEFT, pos=there)
        for place in places[1:]:
            there = target.mapFrom(self.window, widget.mapTo(self.window, place))
            move(target, there)
            rest(30)
        QTest.mouseRelease(target, LEFT, pos=there)

    def name_file(self, button, file, seconds=30.0):
        """Press a button that asks for a file, type its name into the dialog, and press its first button."""
        answered = []

        def answer():
            dialog = QApplication.activeModalWidget()
            if isinstance(dialog, QFileDialog):
                field = dialog.findChild(QLineEdit, "fileNameEdit")
                if field.text() != str(file):
                    QTest.keyClick(field, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
                    QTest.keyClicks(field, str(file))
                else:  # the dialog looks at the folder meanwhile, and offers names in a list that would take the click
                    field.completer().popup().hide()
                    QTest.mouseClick(dialog.findChild(QDialogButtonBox).buttons()[0], LEFT)
                    answered.append(dialog)
            if time.monotonic() < end and not (answered and not answered[0].isVisible()):
                QTimer.singleShot(200, answer)

        end = time.monotonic() + seconds
        QTimer.singleShot(100, answer)
        self.press(button)
        self.until(lambda: answered, "a dialog that asks for a file", seconds)

    def _under(self, widget, place):
        """Return what is topmost there, and the place in it; not within the widget: somebody would miss it."""
        whole = widget.mapTo(self.window, place)
        target = self.window.childAt(whole)
        if target is None or (target is not widget and not widget.isAncestorOf(target)):
            file = self.picture("covered")
            raise StuckError(
                f"'{name_of(widget) or type(widget).__name__}' cannot be clicked: {target} is there; the screen is in"
                f" {file}"
            )
        return target, target.mapFrom(self.window, whole)

    def _note(self, what):
        self.log.append(f"{time.monotonic() - self._began:6.1f} s  {what}")


def rest(milliseconds):
    """Let the window go on; QTest.qWait would keep all other threads from running."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def name_of(widget):
    """Return how a person, or a screen reader, calls a widget."""
    text = widget.text() if isinstance(widget, (QAbstractButton, QLabel)) else ""
    return text.replace("&", "") or widget.accessibleName()


def scroll_to(widget):
    """Scroll until a widget can be seen."""
    above = widget.parentWidget()
    while above is not None:
        if isinstance(above, QScrollArea) and above.widget() is not None:
            above.ensureWidgetVisible(widget, 0, 20)
        above = above.parentWidget()


def move(widget, place):
    """Move the pointer with the left button held: QTest moves it without."""
    where = QPointF(place)
    event = QMouseEvent(
        QEvent.Type.MouseMove,
        where,
        QPointF(widget.mapToGlobal(place)),
        Qt.MouseButton.NoButton,
        LEFT,
        Qt.KeyboardModifier.NoModifier,
    )
    QApplication.sendEvent(widget, event)
