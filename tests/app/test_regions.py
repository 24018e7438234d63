"""The Regions page in a real window: painting, tools, undo, what is kept, and each of its states."""

import gc
import weakref
from importlib import import_module

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QPoint, QPointF, Qt
from PySide6.QtWidgets import QHBoxLayout, QWidget
from workbench.region_sessions import CENTRE, RADIUS, folder  # noqa: F401

from contactbench.app.bench import Bench
from contactbench.app.pages.regions import RegionsPage
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.why import RegionsState, regions_state
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.pipeline.workbench.desk import Desk
from contactbench.widgets.scene import Scene
from contactbench.widgets.scene.scene import Pick
from contactbench.widgets.theme import style_sheet

TRANSFER = import_module("contactbench.pipeline.mesh.regions.transfer")  # a function has its name, too
LONG = 20_000  # ms; a wait ends as soon as what it waits for is there
NO_KEY = Qt.KeyboardModifier.NoModifier
STATUS = StepStatus(StepState.READY, "")


class Window(QWidget):
    """A scene, a page, and a bench as the main window has them."""

    def __init__(self, desk):
        super().__init__()
        self.scene = Scene(self)
        self.bench = Bench(desk, self.scene)
        self.told = []
        self.bench.told.connect(self.told.append)
        self.page = RegionsPage(self.bench)
        self.page.setFixedWidth(360)
        self.bench.changed.connect(lambda: self.page.show_state(STATUS))
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.scene, 1)
        layout.addWidget(self.page)
        self.resize(1000, 700)

    def end(self):
        self.page.close_page()
        self.bench.close()
        self.scene.close_scene()


@pytest.fixture
def opened(qtbot):
    """Return what opens a window on a session folder, with its page shown; all are closed in the end."""
    windows = []

    def open_folder(place, *, wait=True):
        window = Window(Desk(Session.open(place)))
        windows.append(window)
        window.show()
        qtbot.waitExposed(window)
        window.page.enter()
        if wait:
            qtbot.waitUntil(lambda: window.page.work is not None, timeout=LONG)
        return window

    def close(window):
        windows.remove(window)
        window.end()
        window.close()
        window.deleteLater()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)

    open_folder.close = close
    yield open_folder
    while windows:
        close(windows[0])
    gc.collect()  # here, not in a worker of the next test: widgets must not be freed in another thread


@pytest.fixture
def window(opened, folder):  # noqa: F811
    made = opened(folder)
    made.page.panel.regions.add_button.click()
    return made


def pick(page, x, y, z):
    faces, points = page.work.graph.pick(CENTRE + RADIUS * np.array([x, y, z]))
    return Pick(int(faces[0]), points[0])


def draw(window, *places):
    scene = window.scene
    scene.brush_began.emit(pick(window.page, *places[0]), NO_KEY)
    for place in places[1:]:
        scene.brush_moved.emit(pick(window.page, *place))
    scene.brush_ended.emit()


def idle(window, qtbot):
    qtbot.waitUntil(lambda: window.page.job is None, timeout=LONG)


def rows(window):
    return [(row.name, row.facets) for row in window.page.work.rows()]


def said(window):
    return window.page.panel.state_text.text()


# ---- painting and undo -------------------------------------------------------------------------


def test_a_new_region_can_be_painted_at_once(window, qtbot):
    page = window.page
    assert page.panel.tools.tool == "brush"
    assert window.scene.mouse.tool == "brush"
    assert "Nothing painted yet" in said(window)
    draw(window, (0, 0, 1), (0.3, 0, 0.95))
    assert window.bench.undo.undoText() == "paint Region 1"
    colours = window.scene.probe_layer._colours
    assert np.array_equal(colours, page.work.colours), "the scene shows every facet as it is"
    window.bench.undo.undo()
    assert rows(window) == [("Region 1", 0)]
    assert np.array_equal(window.scene.probe_layer._colours, page.work.colours)
    window.bench.undo.redo()
    assert rows(window)[0][1] > 0
    assert float(page.panel.regions.rows.index(0, 2).data()) > 0
    window.bench.undo.undo()
    window.bench.undo.undo()
    assert rows(window) == []
    assert not window.bench.undo.canUndo()
    qtbot.waitUntil(lambda: not page.keeper.dirty, timeout=LONG)


def test_a_stroke_that_is_drawn_while_the_regions_are_kept_is_not_lost(window, qtbot):
    page, scene = window.page, window.scene
    page.keeper._timer.setInterval(50)
    draw(window, (0, 0, 1))  # is kept soon, while the next stroke is drawn
    scene.brush_began.emit(pick(page, 1, 0, 0), NO_KEY)
    before = int((page.work.model.labels > 0).sum())
    if page.keeper._timer.isActive():
        qtbot.waitSignal(page.keeper._timer.timeout, timeout=LONG).wait()
    assert page.work.drawing
    assert page.keeper.dirty, "kept would be half a stroke"
    scene.brush_moved.emit(pick(page, 0.9, 0.4, 0))
    scene.brush_ended.emit()
    assert int((page.work.model.labels > 0).sum()) > before
    qtbot.waitUntil(lambda: not page.keeper.dirty, timeout=LONG)
    window.bench.desk.do(lambda session: session).result(10)
    assert window.bench.desk.state.newest("regions") is not None


def test_the_mouse_paints_what_is_under_it(window, qtbot):
    page, view = window.page, window.scene.view
    window.scene.look("top")
    middle = QPoint(view.width() // 2, view.height() // 2)
    qtbot.waitUntil(lambda: window.scene.pick_at(QPointF(middle)) is not None, timeout=LONG)
    under = window.scene.pick_at(QPointF(middle))
    with qtbot.waitSignal(window.scene.drawn, timeout=LONG):
        qtbot.mousePress(view, Qt.MouseButton.LeftButton, pos=middle)
        qtbot.mouseMove(view, middle + QPoint(40, 0))
    assert page.work.model.labels[under.face] == 1, "seen before the button is let go"
    qtbot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=middle + QPoint(40, 0))
    assert window.bench.undo.undoText() == "paint Region 1"
    picture = window.scene.picture()
    orange = (np.abs(picture.astype(int) - [230, 159, 0]).argmax(axis=2) >= 0) & (
        picture[..., 0].astype(int) - picture[..., 2] > 80
    )
    assert orange.sum() > 20, "the colour of the region is in the picture"


def test_escape_takes_the_stroke_back_and_then_only_looks(window, qtbot):
    page = window.page
    window.activateWindow()
    page.panel.regions.view.setFocus()
    qtbot.waitUntil(window.isActiveWindow, timeout=LONG)
    window.scene.brush_began.emit(pick(page, 0, 0, 1), NO_KEY)
    assert rows(window)[0][1] > 0
    qtbot.keyClick(page.panel.regions.view, Qt.Key.Key_Escape)
    assert rows(window)[0][1] == 0
    assert window.bench.undo.undoText() == "add Region 1"
    window.scene.brush_ended.emit()
    qtbot.keyClick(page.panel.regions.view, Qt.Key.Key_Escape)
    assert (page.panel.tools.tool, window.scene.mouse.tool) == ("look", "turn")


def test_keys_choose_tools_and_scale_the_brush(window, qtbot):
    page = window.page
    window.activateWindow()
    page.panel.regions.view.setFocus()
    qtbot.waitUntil(window.isActiveWindow, timeout=LONG)
    for key, tool, mouse in (
        ("e", "eraser", "brush"),
        ("f", "fill", "pick"),
        ("x", "box", "pick"),
        ("h", "plane", "pick"),
        ("l", "look", "turn"),
        ("b", "brush", "brush"),
    ):
        qtbot.keyClick(page.panel.regions.view, key)
        assert (page.panel.tools.tool, window.scene.mouse.tool) == (tool, mouse)
    before = page.brush.radius
    qtbot.keyClick(page.panel.regions.view, "]")
    assert page.brush.radius == pytest.approx(1.2 * before)
    assert page.panel.tools.radius.value() == pytest.approx(1200 * before, abs=0.06)
    qtbot.keyClick(page.panel.regions.view, "[")
    assert page.brush.radius == pytest.approx(before)
    page.panel.tools.radius.setValue(7.0)
    assert page.brush.radius == pytest.approx(0.007)


def test_the_list_edits_as_steps(window):
    page, listed = window.page, window.page.panel.regions
    listed.renamed.emit(1, "Lens")
    listed.add_button.click()
    listed.recoloured.emit(2, "#123456")
    draw(window, (0, 0, 1))
    listed.moved.emit(2, 1)
    assert [name for name, _ in rows(window)] == ["Region 2", "Lens"]
    assert listed.rank == 1
    assert page.work.model.labels[pick(page, 0, 0, 1).face] == 1
    listed.renamed.emit(1, "Lens")  # taken
    assert "called 'Lens'" in window.told[-1].text
    assert rows(window)[0][0] == "Region 2"
    texts = []
    while window.bench.undo.canUndo():
        texts.append(window.bench.undo.undoText())
        window.bench.undo.undo()
    assert texts == [
        "reorder regions",
        "paint Region 2",
        "colour Region 2",
        "add Region 2",
        "rename Region 1",
        "add Region 1",
    ]
    while window.bench.undo.canRedo():
        window.bench.undo.redo()
    assert page.work.model.regions[0].colour == "#123456"


# ---- tools -------------------------------------------------------------------------------------


def test_fill_box_and_plane_by_clicking(window, qtbot):
    page, tools, scene = window.page, window.page.panel.tools, window.scene
    tools.choose("plane")
    scene.picked.emit(pick(page, 1, 0, 0))
    assert tools.position.value() == pytest.approx(80, abs=3)
    assert "cm²" in tools.plane_plan.text()
    plain = page.work.colours.copy()
    assert (scene.probe_layer._colours != plain).any(), "what it would take is half painted"
    tools._give(False)
    idle(window, qtbot)
    half = page.work.rows()[0]
    assert half.facets == pytest.approx(640, rel=0.15)
    assert np.array_equal(scene.probe_layer._colours, page.work.colours)

    tools.choose("box")
    scene.picked.emit(pick(page, -0.9, -0.9, 0.6))
    assert "opposite" in tools.box_hint.text()
    scene.picked.emit(pick(page, 0.9, 0.9, 1))
    tools._give(True)
    idle(window, qtbot)
    assert 0 < page.work.rows()[0].area < half.area

    tools.choose("fill")
    tools.crease.setValue(90)
    scene.picked.emit(pick(page, 0, 0, -1))
    idle(window, qtbot)
    assert rows(window)[0][1] == page.work.graph.facet_count
    assert scene.mouse.tool == "pick", "the tool stays for the next click"
    tools.choose("look")
    assert np.array_equal(scene.probe_layer._colours, page.work.colours)


def test_a_box_whose_numbers_are_no_box_is_said(window):
    tools = window.page.panel.tools
    tools.choose("box")
    tools.lows[0].setValue(50)
    assert "below" in tools.box_plan.text()
    tools._give(False)
    assert window.page.job is None


def test_shape_buttons_change_the_chosen_region(window, qtbot):
    shape = window.page.panel.shape
    shape.grow_button.click()
    idle(window, qtbot)
    assert "empty" in window.told[-1].text
    draw(window, (1, 0, 0))
    one = window.page.work.rows()[0].area
    shape.mirror_button.click()
    idle(window, qtbot)
    assert window.page.work.rows()[0].area == pytest.approx(2 * one, rel=0.2)
    assert "counterpart" in window.told[-1].text
    shape.amount.setValue(5)
    shape.grow_button.click()
    idle(window, qtbot)
    grown = window.page.work.rows()[0].area
    assert grown > 2 * one
    shape.shrink_button.click()
    idle(window, qtbot)
    assert window.page.work.rows()[0].area < grown
    shape.smooth_button.click()
    idle(window, qtbot)
    shape.clear_button.click()
    assert rows(window)[0][1] == 0
    texts = [window.bench.undo.text(index) for index in range(window.bench.undo.count())]
    assert [text.split()[0] for text in texts[1:5]] == ["paint", "mirror", "grow", "shrink"]
    assert texts[-1] == "clear Region 1"


def test_import_and_export(window, qtbot, tmp_path):
    draw(window, (0, 0, 1))
    painted = rows(window)
    for name in ("regions.json", "regions.csv"):
        window.page.write(tmp_path / name)
        idle(window, qtbot)
        window.page.panel.shape.clear_button.click()
        window.page.read(tmp_path / name)
        idle(window, qtbot)
        assert rows(window) == painted
        assert window.bench.undo.undoText() == "import regions"
    (tmp_path / "other.json").write_text("{}", encoding="utf-8")
    window.page.read(tmp_path / "other.json")
    idle(window, qtbot)
    assert "other.json" in window.told[-1].text
    assert rows(window) == painted


# ---- the session -------------------------------------------------------------------------------


def test_it_is_kept_by_itself_and_found_again(window, opened, folder, qtbot):  # noqa: F811
    draw(window, (0, 0, 1))
    assert "Saving" in said(window)
    qtbot.waitUntil(lambda: window.bench.desk.state.newest("regions") is not None, timeout=LONG)
    qtbot.waitUntil(lambda: "but not yet applied to the probe" in said(window), timeout=LONG)
    draw(window, (0, 1, 0))
    painted = rows(window)
    opened.close(window)  # at once: nothing waits for the pause
    again = opened(folder)
    assert rows(again) == painted
    assert "but not yet applied to the probe" in said(again)


def test_leaving_keeps_at_once_and_gives_the_tool_back(window, qtbot):
    draw(window, (0, 0, 1))
    window.page.leave()
    assert not window.page.keeper.dirty
    assert window.scene.mouse.tool == "turn"
    qtbot.waitUntil(lambda: window.bench.desk.state.newest("regions") is not None, timeout=LONG)
    shown = []
    window.bench.go_to.connect(lambda step: (shown.append(step), window.page.enter()))
    window.bench.undo.undo()
    assert shown == [Step.REGIONS], "what is undone is seen"
    assert rows(window)[0][1] == 0


def test_giving_them_to_the_probe(window, qtbot, monkeypatch):
    monkeypatch.setattr(TRANSFER, "_MOST_OFF", 0.1)  # 300 facets do not hold a dab of 6 mm to 3 %
    panel = window.page.panel
    draw(window, (0, 0, 1))
    assert window.page.bar.primary.property("primary")
    window.page.bar.primary.click()
    assert not panel.body.isEnabled()
    qtbot.waitUntil(lambda: regions_state(window.bench.desk.state) is RegionsState.APPLIED, timeout=LONG)
    qtbot.waitUntil(lambda: "has these regions" in said(window), timeout=LONG)
    idle(window, qtbot)
    assert window.page.bar.primary.text() == "Next: Verify"
    assert Step.REGIONS not in window.bench.running
    assert rows(window)[0][1] > 0, "the surface is the same: it was not read again"
    window.bench.undo.undo()
    qtbot.waitUntil(lambda: regions_state(window.bench.desk.state) is RegionsState.WAITING, timeout=LONG)
    window.bench.undo.redo()
    qtbot.waitUntil(lambda: regions_state(window.bench.desk.state) is RegionsState.APPLIED, timeout=LONG)


def test_regions_that_are_not_as_painted_are_told_as_long_as_they_are_so(window, opened, qtbot, monkeypatch):
    monkeypatch.setattr(TRANSFER, "_MOST_OFF", 0.0)
    draw(window, (0, 0, 1))
    window.page.bar.primary.click()
    qtbot.waitUntil(lambda: "Applied, but the region" in said(window), timeout=LONG)
    assert "is not what was painted" in said(window)
    idle(window, qtbot)
    assert sum("is not what was painted" in str(each) for each in window.told) == 1
    place = window.bench.desk.folder
    opened.close(window)
    assert "Applied, but the region" in said(opened(place))


def test_cancelling_leaves_the_probe_as_it_was(window, qtbot, monkeypatch):
    import threading

    from contactbench.app.pages import regions

    draw(window, (0, 0, 1))
    real, asked = regions.apply, threading.Event()

    def slow(desk, monitor):
        monitor.tell(0.5)
        asked.wait(20)
        return real(desk, monitor)

    monkeypatch.setattr(regions, "apply", slow)
    window.page.bar.primary.click()
    qtbot.waitUntil(lambda: window.page.job.share == 0.5, timeout=LONG)
    assert Step.REGIONS in window.bench.running
    window.page.job.cancel()  # as the status bar does
    asked.set()
    idle(window, qtbot)
    assert regions_state(window.bench.desk.state) is RegionsState.WAITING
    assert window.page.bar.primary.isEnabled()


def test_a_full_disk_is_said_and_tried_again(window, qtbot, monkeypatch):
    from contactbench.app.pages import regions as page

    def full(*_):
        raise SessionError("The disk is full.")

    real = page.keep_with_steps
    monkeypatch.setattr(page, "keep_with_steps", full)
    draw(window, (0, 0, 1))
    window.page.keeper.keep_now()
    qtbot.waitUntil(lambda: "The disk is full." in said(window), timeout=LONG)
    assert window.page.keeper.dirty
    monkeypatch.setattr(page, "keep_with_steps", real)
    draw(window, (0, 1, 0))
    window.page.keeper.keep_now()
    qtbot.waitUntil(lambda: window.bench.desk.state.newest("regions") is not None, timeout=LONG)
    qtbot.waitUntil(lambda: "but not yet applied to the probe" in said(window), timeout=LONG)


def test_another_alignment_opens_another_surface(window, qtbot):
    first = window.page.work
    draw(window, (0, 0, 1))
    painted = rows(window)
    window.bench.do("", lambda session: session.set_parameter("probe.mount", [0, 0, 90, 0, 0, 0]))
    qtbot.waitUntil(lambda: window.page.work not in (first, None), timeout=LONG)
    assert rows(window) == painted
    window.bench.undo.undo()  # a stroke on the surface before, which has the same facets
    assert rows(window) == [("Region 1", 0)]


def test_without_a_probe_it_is_locked(opened, tmp_path, qtbot):
    Session.create(tmp_path / "empty").close()
    window = opened(tmp_path / "empty", wait=False)
    panel = window.page.panel
    assert "No probe yet" in said(window)
    assert window.page.bar.primary.text() == "Open Probe"
    assert not panel.body.isVisible()
    with qtbot.waitSignal(window.bench.go_to) as asked:
        window.page.bar.primary.click()
    assert asked.args == [Step.PROBE]


def test_nothing_outlives_the_page(window, opened, qtbot):
    draw(window, (0, 0, 1))
    work = weakref.ref(window.page.work)
    opened.close(window)

    def gone():
        gc.collect()
        return work() is None

    qtbot.waitUntil(gone, timeout=LONG)


def test_nothing_is_cut_and_nothing_scrolls_sideways(window):
    panel = window.page.panel
    window.page.setStyleSheet(style_sheet(False))
    for width in (320, 400):
        window.page.setFixedWidth(width)
        for tool in ("look", "brush", "fill", "box", "plane"):
            panel.tools.choose(tool)
            window.repaint()
            assert panel.widget().minimumSizeHint().width() <= panel.viewport().width()
    for button in (window.page.bar.primary, panel.regions.add_button, panel.shape.grow_button):
        assert button.height() >= 36 or not button.isVisible()


def test_what_nothing_can_touch_is_crossed_out_until_it_is_undone(window):
    page, listed = window.page, window.page.panel.regions
    draw(window, (0, 0, 1), (0.3, 0, 0.95))
    layer = window.scene.probe_layer

    def lines():
        return layer._crossed.mapper.GetInput().GetNumberOfLines()

    assert lines() == 0
    listed.untouchable.click()
    assert page.work.model.regions[0].untouchable
    assert window.bench.undo.undoText() == "mark Region 1 untouchable"
    assert "untouchable" in listed.rows.index(0, 1).data()
    before = lines()
    assert before > 0
    draw(window, (0, 0, 1), (-0.4, 0, 0.9))
    assert lines() > before
    page.leave()
    page.enter()  # shown anew
    assert lines() > before
    window.bench.undo.undo()
    assert lines() == before
    window.bench.undo.undo()
    assert lines() == 0
    assert not listed.untouchable.isChecked()
