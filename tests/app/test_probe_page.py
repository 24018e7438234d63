import numpy as np
import pytest
import trimesh
from driving.hand import drop_files
from PySide6.QtCore import Qt
from workbench.probe_files import bad_meshes, egg

from contactbench.app.bench import Bench
from contactbench.app.pages.probe import ProbePage
from contactbench.pipeline.mesh.inspect import inspect
from contactbench.pipeline.mesh.sidecar import save_probe_file
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.preparation.prepare import align_step, import_mesh
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.probe import draft_of
from contactbench.widgets.mesh_report import MeshReport
from contactbench.widgets.scene.scene import Pick
from contactbench.widgets.theme import colours, is_dark

from .page_window import PaperScene

PATIENCE = 60_000
VIRTUAL = "virtual://bench?probe=t-shape&sensor=paper"


@pytest.fixture
def bench(tmp_path):
    session = Session.create(tmp_path / "s", by="ada")
    bench = Bench(Desk(session), PaperScene())
    bench.messages = []
    bench.told.connect(bench.messages.append)
    yield bench
    bench.close()
    bench.scene.deleteLater()


@pytest.fixture
def page(qtbot, bench):
    page = open_page(qtbot, bench)
    yield page
    page.close_page()


def open_page(qtbot, bench):
    page = ProbePage(bench)
    qtbot.addWidget(page)
    page.resize(360, 760)
    page.show()
    qtbot.waitExposed(page)
    bench.changed.connect(lambda: page.show_state(StepStatus(StepState.READY, "")))
    page.enter()
    settled(qtbot, page)
    return page


def settled(qtbot, page):
    qtbot.waitUntil(lambda: not page.stages.worker.busy and not page.stages.using, timeout=PATIENCE)


def press(qtbot, button):
    assert button.isVisible()
    assert button.isEnabled()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def prepared(qtbot, page, file):
    page.stages.take(file)
    qtbot.waitUntil(lambda: page.stages.dense is not None, timeout=PATIENCE)
    page.stages.put(from_angles([0, 0, 35], [0, 0, 0]))
    qtbot.waitUntil(lambda: page.stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)


def test_from_a_dropped_file_to_a_probe_in_use_and_back(qtbot, bench, page, tmp_path):
    stages, next_one = page.stages, page.bar.primary
    assert next_one.text() == "Choose mesh…"
    bench.scene.dropped.emit(egg(tmp_path))
    qtbot.waitUntil(lambda: stages.dense is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert next_one.text() == "Align with sensor (3)"
    assert bench.scene.probe is stages.dense.content.probe

    middle = np.mean(stages.mesh.original.probe.bounds, axis=0)
    assert bench.scene.handle[1] == pytest.approx(middle)
    T = np.diag([-1.0, -1.0, 1.0, 1.0])
    for height in (0.02, 0.035):
        T[:3, 3] = T[:3, :3] @ middle + [0, 0, height]
        bench.scene.handle_moved.emit(T.copy())
    bench.scene.handle_dropped.emit()
    assert page.place.panel.typed == pytest.approx((0, 0, 35.0, 0, 0, 180.0))
    bench.undo.undo()
    assert (page.place.panel.typed, bench.scene.ghost) == ((0.0,) * 6, None)
    page.hide()  # as bench mode does
    assert bench.scene.handle is None
    page.show()

    page.place.panel.numbers[2].setValue(35.0)
    assert bench.scene.ghost[1].tolist() == pytest.approx([0, 0, 0.035])
    assert bench.scene.handle[1] == pytest.approx(middle + [0, 0, 0.035])
    assert next_one.text() == "Apply placement"
    press(qtbot, next_one)
    assert bench.scene.ghost is None
    qtbot.waitUntil(lambda: stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    advised = stages.trade.advised
    assert stages.plan.facets == advised
    assert bench.scene.probe.bounds[0, 2] == pytest.approx(0.0, abs=3e-4)
    assert page.facets.chart.facets == len(stages.preview.done.content.probe.faces)

    page.facets.deviation.setChecked(True)
    assert bench.scene.field.shape == (len(bench.scene.probe.vertices),)
    page.facets.deviation.setChecked(False)
    page.facets.overlay.setChecked(True)
    assert bench.scene.field is None
    assert len(bench.scene.overlay.faces) == 1280

    fewer = stages.trade.points[0].facets
    page.facets.chart.setFocus()
    while page.facets.chart.facets > fewer:
        qtbot.keyClick(page.facets.chart, Qt.Key.Key_Left)
    assert stages.preview is None
    qtbot.waitUntil(lambda: stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    press(qtbot, next_one)
    settled(qtbot, page)
    assert next_one.text() == "Next: Regions"
    result = bench.desk.state.current_results["probe", "probe.ply"]
    assert result.action.parameters == {"facets": fewer}
    assert next_one.isEnabled()

    bench.undo.undo()
    qtbot.waitUntil(lambda: stages.view.used is None and not stages.in_use, timeout=PATIENCE)
    settled(qtbot, page)
    assert bench.desk.state.current_results["probe", "probe.ply"].mark.mark == "rejected"
    bench.undo.redo()
    qtbot.waitUntil(lambda: stages.in_use, timeout=PATIENCE)
    settled(qtbot, page)
    assert bench.desk.state.current_results["probe", "probe.ply"].outcome == result.outcome
    assert len(bench.scene.probe.faces) == fewer


def test_a_session_with_a_probe_opens_as_it_was_left(qtbot, bench, page, tmp_path):
    prepared(qtbot, page, egg(tmp_path))
    page.stages.use()
    settled(qtbot, page)
    other = open_page(qtbot, bench)
    try:
        assert other.stages.in_use
        assert other.stages.mesh.file.name == "egg.stl"
        assert other.stages.plan.parameters == page.stages.plan.parameters
        assert other.place.panel.numbers[2].value() == 35.0
        assert f"{len(bench.scene.probe.faces):,} facets" in other.facets.number.text()
        assert other.bar.primary.isEnabled()
    finally:
        other.close_page()


def test_every_stage_is_in_the_session_at_once_and_can_be_undone(qtbot, bench, page, tmp_path):
    def kept():
        draft = draft_of(bench.desk.state)
        return None if draft is None else (draft.name, draft.plan.alignment is not None, draft.plan.facets)

    def reached(wanted):
        qtbot.waitUntil(lambda: kept() == wanted, timeout=PATIENCE)

    stages = page.stages
    stages.take(egg(tmp_path))
    reached(("egg.stl", False, None))
    qtbot.waitUntil(lambda: stages.dense is not None, timeout=PATIENCE)
    stages.put(from_angles([0, 0, 35], [0, 0, 0]))
    qtbot.waitUntil(lambda: stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    advised, fewer = stages.plan.facets, stages.trade.points[0].facets
    reached(("egg.stl", True, advised))
    stages.keep(fewer)
    reached(("egg.stl", True, fewer))
    qtbot.waitUntil(lambda: stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert not bench.desk.state.results  # nothing of it is in use
    # Opened again, it goes on where it was left: also what is computed is there again.
    other = open_page(qtbot, bench)
    try:
        qtbot.waitUntil(lambda: other.stages.preview is not None, timeout=PATIENCE)
        settled(qtbot, other)
        same = other.stages.preview.done.content.probe, stages.preview.done.content.probe
        assert np.array_equal(same[0].vertices, same[1].vertices)
        assert other.bar.primary.text() == "Use this probe"
    finally:
        other.close_page()
    for wanted, words in (
        (("egg.stl", True, advised), "Use this probe"),
        (("egg.stl", False, None), "Align with sensor (3)"),
        (None, "Choose mesh…"),
    ):
        bench.undo.undo()
        reached(wanted)
        qtbot.waitUntil(lambda words=words: page.bar.primary.text() == words, timeout=PATIENCE)
        settled(qtbot, page)
    for _ in range(3):
        bench.undo.redo()
    reached(("egg.stl", True, fewer))
    qtbot.waitUntil(lambda: stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert len(stages.preview.done.content.probe.faces) <= fewer


def test_a_draft_changes_nothing_of_what_is_in_use(qtbot, bench, page, tmp_path):
    prepared(qtbot, page, egg(tmp_path))
    page.stages.use()
    settled(qtbot, page)
    assert draft_of(bench.desk.state) is None
    page.stages.put(from_angles([0, 0, 50], [0, 0, 0]))
    qtbot.waitUntil(lambda: draft_of(bench.desk.state) is not None, timeout=PATIENCE)
    assert bench.desk.stale["probe", "probe.ply"] == ()
    assert [each.kind for each in bench.desk.state.inputs].count("draft-mesh") == 1  # of the first time
    qtbot.waitUntil(lambda: page.stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert page.bar.primary.text() == "Use this probe"
    assert bench.undo.undoText() == "place the mesh"
    bench.undo.undo()
    qtbot.waitUntil(lambda: page.stages.in_use, timeout=PATIENCE)
    settled(qtbot, page)
    assert page.place.panel.numbers[2].value() == 35.0


def test_what_was_chosen_a_moment_ago_is_kept_when_the_page_goes(qtbot, bench, page, tmp_path):
    prepared(qtbot, page, egg(tmp_path))
    page.stages.keep(200)
    page.stages.close()
    bench.desk.do(lambda _session: None).result(10)
    assert draft_of(bench.desk.state).plan.facets == 200


def test_a_bad_mesh_is_told_and_what_was_there_stays(qtbot, bench, page, tmp_path):
    prepared(qtbot, page, egg(tmp_path))
    preview, count = page.stages.preview, bench.desk.state.count
    for file, words in bad_meshes(tmp_path).items():
        page.stages.take(file)
        settled(qtbot, page)
        assert words in page.bar.words
        assert words in bench.messages[-1].text
        assert Step.PROBE in bench.failed
        assert page.stages.preview is preview
        assert page.bar.primary.text() == "Use this probe"
    assert bench.desk.state.count == count


def test_the_unit_is_a_question_with_lengths(qtbot, page, tmp_path):
    page.stages.take(egg(tmp_path, "small.stl", scale=0.2))
    qtbot.waitUntil(lambda: page.stages.mesh is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert page.bar.primary.text() == "Enter probe length (1)"
    assert page.stages.dense is None
    buttons = page.mesh_section.unit_buttons
    assert {"mm", "cm", "in"} <= set(buttons)
    assert buttons["cm"].text().startswith("140 mm long")
    middle = {}
    for unit in ("mm", "cm"):
        drawn = buttons[unit].icon().pixmap(buttons[unit].iconSize()).toImage()
        middle[unit] = drawn.pixelColor(drawn.rect().center()).name()
    # A probe of 14 mm lies on the card, and the card on one of 140 mm.
    theme = colours(is_dark())
    assert middle == {"mm": theme.accent, "cm": theme.muted}
    qtbot.waitUntil(buttons["cm"].isVisible, timeout=PATIENCE)  # once it is laid out
    press(qtbot, buttons["cm"])
    qtbot.waitUntil(lambda: page.stages.dense is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert page.stages.plan.units == "cm"
    assert page.stages.dense.content.probe.size == pytest.approx(0.14, rel=1e-2)
    assert not page.mesh_section.unit_buttons


def test_work_can_be_stopped_and_begun_again(qtbot, bench, page, tmp_path):
    page.stages.take(egg(tmp_path, "stop.stl", facets=6))
    qtbot.waitUntil(lambda: page.stages.mesh is not None, timeout=PATIENCE)
    assert bench.running == {Step.PROBE}
    page.stages.worker._job.cancel()  # as the status bar does
    settled(qtbot, page)
    assert bench.running == set()
    assert page.bar.words.startswith("Stopped")
    assert page.stages.dense is None
    assert page.bar.primary.text() == "Create outer surface"
    press(qtbot, page.bar.primary)
    qtbot.waitUntil(lambda: page.stages.dense is not None, timeout=PATIENCE)


def test_places_on_the_mesh_are_matched(qtbot, bench, page, tmp_path):
    prepared(qtbot, page, egg(tmp_path))
    before = page.stages.plan.alignment
    mount = from_angles([2, 1, 40], [0, 0, 30])
    panel = page.place.panel
    assert bench.scene.tool == "turn"
    panel.way.setCurrentIndex(1)
    assert bench.scene.tool == "pick"
    shown = page.stages.view.shown.dense
    for row, vertex in enumerate((0, 100, 300)):
        point_S = shown.vertices[vertex]
        bench.scene.picked.emit(Pick(0, point_S))
        point_P = (point_S - before.p_SP_S) @ before.R_SP
        panel.points.type_in(row, tuple(1e3 * (mount.R_SP @ point_P + mount.p_SP_S)))
    assert not page.stages.worker.busy
    panel.place_points.click()
    assert np.allclose(page.stages.plan.alignment.T_SP, mount.T_SP, atol=1e-6)
    page.leave()
    assert bench.scene.tool == "turn"


def test_the_virtual_bench_offers_its_housing(qtbot, bench, page):
    assert not page.mesh_section.housing.isVisible()
    with qtbot.waitSignal(bench.changed, timeout=PATIENCE):
        bench.do("set", lambda session: session.set_parameter("devices.sensor", VIRTUAL))
    qtbot.waitUntil(lambda: page.bar.primary.text() == "Use virtual bench housing", timeout=PATIENCE)
    settled(qtbot, page)
    press(qtbot, page.bar.primary)
    qtbot.waitUntil(lambda: page.stages.mesh is not None, timeout=PATIENCE)
    assert page.stages.mesh.file.name == "t-shape-housing.stl"
    placed = page.stages.plan.alignment.place(page.stages.mesh.original.probe)
    assert placed.bounds[:, 2] == pytest.approx([0.003, 0.128], abs=4e-3)
    page.stages.worker.stop()  # the surface takes its time


def test_a_mesh_that_lies_in_the_sensor_frame_is_not_placed_again(qtbot, bench, page, tmp_path):
    content = import_mesh(egg(tmp_path))
    file = tmp_path / "ready.ply"
    save_probe_file(align_step(content, from_angles([0, 0, 35], [0, 0, 0])), file)
    page.stages.take(file)
    qtbot.waitUntil(lambda: page.stages.preview is not None, timeout=PATIENCE)
    settled(qtbot, page)
    assert not page.place.isVisible()
    press(qtbot, page.bar.primary)
    settled(qtbot, page)
    mesh = bench.desk.state.mesh
    assert (mesh.name, set(mesh.companions)) == ("ready.ply", {"ready.json"})
    assert bench.desk.state.results[0].action.inputs == {"mesh": mesh.content}
    assert bench.desk.stale["probe", "probe.ply"] == ()


def test_a_file_can_be_dropped_on_the_page(qtbot, page, tmp_path):
    drop_files(page, egg(tmp_path))
    qtbot.waitUntil(lambda: page.stages.mesh is not None, timeout=PATIENCE)
    assert page.stages.mesh.file.name == "egg.stl"


def test_nothing_is_cut_in_a_narrow_panel(qtbot, page, tmp_path):
    prepared(qtbot, page, egg(tmp_path))
    page.resize(340, 700)
    view, inside = page.area.viewport(), page.area.widget()
    qtbot.waitUntil(lambda: inside.width() <= view.width() <= 340, timeout=PATIENCE)
    assert inside.minimumSizeHint().width() <= view.width()


def test_a_doubtful_mesh_is_not_praised(qtbot, tmp_path):
    report = MeshReport()
    qtbot.addWidget(report)
    box = trimesh.creation.box(extents=(1.0, 0.8, 3.15))
    (tmp_path / "box.stl").write_bytes(box.export(file_type="stl"))
    report.show_inspection(inspect(tmp_path / "box.stl", samples=200))
    assert [level for level, _ in report.sentences if level != "note"] == ["doubt"]
    report.show_inspection(inspect(tmp_path / "box.stl", "in", samples=200))
    assert report.sentences[0][0] == "good"
    box.faces = box.faces[1:]
    (tmp_path / "box.stl").write_bytes(box.export(file_type="stl"))
    for mended, levels in ((False, {"fault", "doubt", "note"}), (True, {"good", "doubt", "note"})):
        report.show_inspection(inspect(tmp_path / "box.stl", "in", samples=200), mended)
        assert {level for level, _ in report.sentences} == levels


def test_a_placement_that_is_typed_and_left_is_applied(qtbot, bench, page, tmp_path):
    page.stages.take(egg(tmp_path))
    qtbot.waitUntil(lambda: page.stages.dense is not None, timeout=PATIENCE)
    settled(qtbot, page)
    page.place.panel.numbers[0].setValue(12.5)
    page.leave()
    assert page.stages.plan.alignment.p_SP_S.tolist() == pytest.approx([0.0125, 0, 0])
    assert bench.undo.undoText() == "place the mesh"
    page.leave()
    settled(qtbot, page)
