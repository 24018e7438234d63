"""What can be judged of a window's layout without eyes: sentences on what is wrong, none where all is well."""

from itertools import chain, pairwise

from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QAccessible, QPalette
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractScrollArea,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QCheckBox,
    QComboBox,
    QDockWidget,
    QGraphicsView,
    QGroupBox,
    QHeaderView,
    QLabel,
    QLineEdit,
    QListView,
    QMainWindow,
    QPushButton,
    QRadioButton,
    QScrollArea,
    QScrollBar,
    QSplitter,
    QStackedWidget,
    QStyle,
    QStyleOptionButton,
    QStyleOptionComboBox,
    QTabBar,
    QTableView,
    QToolBar,
    QToolButton,
    QWidget,
)

from contactbench.widgets.scene import Scene
from contactbench.widgets.theme import contrast

CONTROLS = (QAbstractButton, QComboBox, QAbstractSpinBox, QLineEdit, QAbstractSlider, QListView)


def layout_faults(window: QWidget) -> list[str]:
    """Return what does not fit, lies over something else, or cannot be seen."""
    seen = VisibleWidgets(window)
    checks = (_cut, _cut_tables, _sideways, _outside, _overlaps, _scenes)
    return list(chain.from_iterable(check(seen) for check in checks))


class VisibleWidgets:
    """The visible widgets of a window, looked for once, without the insides of other controls and of the 3D view."""

    def __init__(self, window: QWidget) -> None:
        self.window = window
        self.all: list[QWidget] = []
        self.children: dict[QWidget, list[QWidget]] = {}
        self._walk(window)

    def _walk(self, parent: QWidget) -> None:
        below = [
            each
            for each in parent.children()
            if isinstance(each, QWidget) and not each.isHidden() and not each.isWindow()
        ]
        if isinstance(parent, (QComboBox, QAbstractSpinBox, QTabBar, Scene)):
            return
        self.children[parent] = below
        for each in below:
            if isinstance(each, QScrollBar) or each.objectName() == "qt_toolbar_ext_button":
                continue
            self.all.append(each)
            self._walk(each)

    def of(self, *kinds: type) -> list[QWidget]:
        return [each for each in self.all if isinstance(each, kinds)]


def what(widget: QWidget) -> str:
    """Return a few words on which widget it is."""
    text = widget.text() if hasattr(widget, "text") else ""
    name = text or widget.accessibleName() or widget.objectName()
    return f"{type(widget).__name__} {name[:60]!r} ({widget.width()} x {widget.height()})"


# ---- words that do not fit -----------------------------------------------------------------------------


def _cut(seen: VisibleWidgets):
    for button in seen.of(QPushButton, QToolButton, QCheckBox, QRadioButton):
        if (
            button.text()
            and not _only_icon(button)
            and _wide(button, QAbstractButton.text(button)) > _room(button)
        ):
            yield f"a button is cut: {what(button)}"
    for label in seen.of(QLabel):
        if label.text() and not _fits(label) and label.text() not in label.toolTip():
            yield f"words are cut: {what(label)}"
    yield from _cut_fields(seen)
    yield from _cut_titles(seen)


def _cut_fields(seen: VisibleWidgets):
    for box in seen.of(QComboBox):
        option = QStyleOptionComboBox()
        box.initStyleOption(option)
        field = box.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, box
        )
        if _wide(box, box.currentText()) > field.width() and box.currentText() not in box.toolTip():
            yield f"a choice is cut: {box.currentText()} ({field.width()} px)"
    for spin in seen.of(QAbstractSpinBox):
        if _wide(spin, spin.text()) > spin.lineEdit().width() - 4:
            yield f"a number is cut: {spin.text()} ({spin.lineEdit().width()} px)"
    for line in seen.of(QLineEdit):
        hint = line.placeholderText()
        if hint and not line.text() and _wide(line, hint) > line.width() - 16 and hint not in line.toolTip():
            yield f"a hint is cut: {hint} ({line.width()} px)"


def _cut_titles(seen: VisibleWidgets):
    for box in seen.of(QGroupBox):
        if _wide(box, box.title()) > box.width():
            yield f"a heading is cut: {box.title()}"
    for bar in seen.of(QTabBar):
        for index in range(bar.count()):
            rect = bar.tabRect(index)
            if _wide(bar, bar.tabText(index)) > rect.width() - 8 or not bar.rect().contains(rect):
                yield f"a tab is cut: {bar.tabText(index)} ({rect.width()} px)"
    for dock in seen.of(QDockWidget):
        if _wide(dock, dock.windowTitle()) > dock.width() - 60 and dock.titleBarWidget() is None:
            yield f"a dock's title is cut: {dock.windowTitle()}"


def _cut_tables(seen: VisibleWidgets):
    for table in seen.of(QTableView):
        header: QHeaderView = table.horizontalHeader()
        if header.isHidden():
            continue
        for column in range(header.count()):
            if (
                not header.isSectionHidden(column)
                and header.sectionSize(column) < header.sectionSizeHint(column) - 1
            ):
                name = table.model().headerData(column, Qt.Orientation.Horizontal)
                yield f"a heading of {what(table)} is cut: {name} ({header.sectionSize(column)} px)"


def _only_icon(button: QWidget) -> bool:
    style = Qt.ToolButtonStyle.ToolButtonIconOnly
    return (
        isinstance(button, QToolButton) and not button.icon().isNull() and button.toolButtonStyle() == style
    )


def _wide(widget: QWidget, text: str) -> int:
    return widget.fontMetrics().size(Qt.TextFlag.TextShowMnemonic, text).width()


def _room(button: QAbstractButton) -> int:
    if isinstance(button, QPushButton):
        option = QStyleOptionButton()
        button.initStyleOption(option)
        inner = button.style().subElementRect(QStyle.SubElement.SE_PushButtonContents, option, button)
        used = 0 if button.icon().isNull() else button.iconSize().width() + 4
        return min(inner.width(), button.width() - 4) - used + 4  # a little of the padding
    if isinstance(button, (QCheckBox, QRadioButton)):
        return button.width() - 24
    return button.width()


def _fits(label: QLabel) -> bool:
    room = label.contentsRect()
    if label.wordWrap():
        return label.heightForWidth(
            label.width()
        ) <= label.height() + 2 and label.minimumSizeHint().width() <= (label.width() + 2)
    if "<" in label.text():
        return (
            label.sizeHint().width() <= label.width() + 4 and label.sizeHint().height() <= label.height() + 2
        )
    size = label.fontMetrics().size(0, label.text())
    return size.width() <= room.width() + 1 and size.height() <= room.height() + 2


# ---- room that is not there ----------------------------------------------------------------------------


def _sideways(seen: VisibleWidgets):
    for area in seen.of(QAbstractScrollArea):
        if isinstance(area, (QTableView, QHeaderView, QGraphicsView)):
            continue  # a table may be scrolled: its first column says which row it is
        inside = area.widget() if isinstance(area, QScrollArea) else None
        wide = inside is not None and inside.width() > area.viewport().width()
        if wide or area.horizontalScrollBar().isVisibleTo(seen.window):
            yield f"scrolls sideways: {what(area)}, because of {_widest(area)}"


def _widest(area: QAbstractScrollArea) -> str:
    """Say which of what a scroll area shows needs the most room, and has no part that does."""
    room = area.viewport().width() - 24
    inside = [each for each in area.findChildren(QWidget) if not each.isHidden()]
    wide = [each for each in inside if each.minimumSizeHint().width() > room]
    deepest = [each for each in wide if not any(each.isAncestorOf(other) for other in wide)]
    return ", ".join(f"{what(each)} needs {each.minimumSizeHint().width()}" for each in deepest[:3])


def _outside(seen: VisibleWidgets):
    """What reaches out of what it lies in: nobody can see or press all of it."""
    for parent, below in seen.children.items():
        if (
            isinstance(parent, (Scene, QSplitter, QToolBar))
            or parent.objectName() == "qt_scrollarea_viewport"
        ):
            continue
        for each in below:
            if not isinstance(each, (*CONTROLS, QLabel, QAbstractScrollArea)) or not each.isVisibleTo(
                seen.window
            ):
                continue
            if not _whole(each, parent, seen.window):
                yield f"reaches out of its place: {what(each)} at {each.geometry().getRect()} in {what(parent)}"


def _whole(widget: QWidget, parent: QWidget, window: QWidget) -> bool:
    """Whether all of a widget can be seen in everything that it lies in, or scrolled to."""
    rect = widget.geometry()
    while parent.objectName() != "qt_scrollarea_viewport":
        if not parent.rect().adjusted(-2, -2, 2, 2).contains(rect):
            return False
        if parent is window:
            break
        rect = rect.translated(parent.pos())
        parent = parent.parentWidget()
    return True


def _overlaps(seen: VisibleWidgets):
    for parent, below in seen.children.items():
        if isinstance(parent, (Scene, QStackedWidget, QMainWindow)):
            continue
        drawn = [each for each in below if _drawn(each)]
        for number, one in enumerate(drawn):
            for other in drawn[:number]:
                common = one.geometry() & other.geometry()
                if common.width() > 2 and common.height() > 2:
                    yield f"overlap: {what(one)} and {what(other)}"


def _drawn(widget: QWidget) -> bool:
    through = widget.testAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
    return not through and isinstance(widget, (*CONTROLS, QLabel, QAbstractScrollArea, QGroupBox))


def _scenes(seen: VisibleWidgets):
    """What lies over a 3D view and is cut, or covers something else that does."""
    for scene in seen.of(Scene):
        buttons, bar = scene.buttons, scene.scale_bar
        if not buttons.isVisibleTo(scene):
            continue
        if not scene.view.geometry().contains(buttons.geometry()):
            yield f"the view's buttons are cut: {buttons.geometry().getRect()} in {scene.view.geometry().getRect()}"
        for each in (*buttons.buttons.values(), buttons.menu):
            if not each.isVisibleTo(buttons):
                continue
            if not buttons.rect().contains(each.geometry()) or each.width() < each.minimumSizeHint().width():
                yield f"a button of the view is cut: {what(each)}"
        if bar.isVisibleTo(scene) and bar.geometry().intersects(buttons.geometry()):
            yield "the scale bar lies over the view's buttons"


# ---- what those miss in a window who cannot see, point, or tell colours apart; nothing where all is well ----


LEAST = 4.5  # contrast, as WCAG 2.1 asks for
_LINE_PX = 12  # what lies in one line


def access_faults(window: QWidget, page: QWidget) -> list[str]:
    """Return what has no name, cannot be reached by keys or in an odd order, or does not show the focus."""
    seen = VisibleWidgets(window)
    return list(chain(_nameless(seen), _out_of_reach(seen), _disordered(page), _unseen_focus(page)))


def _nameless(seen: VisibleWidgets):
    """Controls that a screen reader has no word for, as Qt gives them to it."""
    for control in seen.of(*CONTROLS):
        if not control.isEnabled():
            continue
        interface = QAccessible.queryAccessibleInterface(control)
        if interface is None or not interface.text(QAccessible.Text.Name).strip():
            yield f"has no name: {what(control)} in {type(control.parent()).__name__}"
        elif interface.role() in (QAccessible.Role.NoRole, QAccessible.Role.Client):
            yield f"has no role: {what(control)}"
        if isinstance(control, QToolButton) and not control.text() and not control.toolTip():
            yield f"an icon without words: {what(control)}"


def _chain(window: QWidget) -> list[QWidget]:
    found, at = [], window
    while True:
        found.append(at)
        at = at.nextInFocusChain()
        if at is window:
            return found


def _out_of_reach(seen: VisibleWidgets):
    """Controls that the tabulator key never comes to."""
    order = set(_chain(seen.window))
    for control in seen.of(*CONTROLS):
        if not control.isEnabled() or isinstance(control.parentWidget(), (QDockWidget, QToolBar)):
            continue  # what these hold is in the menus
        if not any(
            each in order and each.focusPolicy() & Qt.FocusPolicy.TabFocus for each in _together(control)
        ):
            yield f"cannot be reached by keys: {what(control)}"


def _together(control: QWidget) -> list[QWidget]:
    """Return what can be reached from one another by arrows: of buttons that exclude each other one is a stop."""
    group = control.group() if isinstance(control, QAbstractButton) else None
    members = group.buttons() if group is not None and group.exclusive() else []
    return [control, *(each for each in members if each.isEnabled() and each.isVisible())]


def _stops(page: QWidget) -> list[QWidget]:
    """Return where the tabulator key stops on a page, in its order."""
    return [
        each
        for each in _chain(page.window())
        if page.isAncestorOf(each)
        and each.focusPolicy() & Qt.FocusPolicy.TabFocus
        and each.isEnabled()
        and each.isVisibleTo(page)
        and each.focusProxy() is None
    ]


def _disordered(page: QWidget):
    """Places where the tabulator key goes up, or back in a line."""
    at = {each: each.mapTo(page, QPoint(0, 0)) for each in _stops(page)}
    for one, other in pairwise(at):
        up = at[other].y() < at[one].y() - _LINE_PX
        back = abs(at[other].y() - at[one].y()) <= _LINE_PX and at[other].x() < at[one].x()
        if (up or back) and _scrolled(one) is _scrolled(other):  # else they move against each other
            yield f"the tabulator key goes back: from {what(one)} to {what(other)}"


def _scrolled(widget: QWidget) -> QWidget | None:
    parent = widget.parentWidget()
    while parent is not None and not isinstance(parent, QScrollArea):
        parent = parent.parentWidget()
    return parent


def _unseen_focus(page: QWidget):
    """Controls that look the same with the focus and without; one of each kind."""
    before = QApplication.focusWidget()
    kinds = {
        (type(each), bool(each.property("primary"))): each
        for each in _stops(page)
        if isinstance(each, CONTROLS)
    }
    for control in kinds.values():
        page.window().setFocus()
        plain = control.grab().toImage()
        control.setFocus(Qt.FocusReason.TabFocusReason)
        if control.hasFocus() and control.grab().toImage() == plain:
            yield f"does not show the focus: {what(control)}"
    if before is not None:
        before.setFocus()


def pale(window: QWidget):
    """Return words whose colour hardly differs from the ground that they stand on, as painted."""
    seen = VisibleWidgets(window)
    for each in seen.of(QLabel, QAbstractButton):
        role = QPalette.ColorRole.WindowText if isinstance(each, QLabel) else QPalette.ColorRole.ButtonText
        words, top = each.palette().color(role).name(), each.mapTo(seen.window, QPoint(0, 0))
        shown = seen.window.rect().contains(QRect(top, each.size())) and each.isVisible()
        if not each.text() or not shown or not each.isEnabled() or "<" in each.text():
            continue
        picture = each.grab().toImage()
        place = (10, 6) if isinstance(each, QAbstractButton) else (0, 0)
        ground = picture.pixelColor(*place)
        if ground.alpha() == 255 and contrast(words, ground.name()) < LEAST:
            yield f"too pale: {what(each)} {words} on {ground.name()}"
