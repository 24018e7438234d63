"""The Verify page in a real window: markers by clicks, touches on a bench that goes by steps, the verdict."""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtWidgets import QInputDialog
from workbench.touch_session import STEPWISE, press

from contactbench.app.bench import Weight
from contactbench.app.pages.verify import VerifyPage
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.live import LiveReading
from contactbench.pipeline.workbench.markers import Markers, kept
from contactbench.widgets.scene import Scene
from contactbench.widgets.scene.scene import Pick

from .page_window import PageWindow


class Window(PageWindow):
    def __init__(self, qtbot, folder, devices=True):
        super().__init__(qtbot, Session.open(folder, by="ada"), VerifyPage, Scene())
        if devices:
            self.bench.live.open(STEPWISE, STEPWISE)
            self.bench.live.pair.step(300)
        self.enter()

    def kept(self):
        return kept(self.desk.folder, self.desk.state)


@pytest.fixture
def window(qtbot, calibrated, tmp_path):
    made = Window(qtbot, shutil.copytree(calibrated, tmp_path / "s"))
    made.wait(lambda: made.page.work.tool is not None)
    yield made
    made.close()


def offered(page):
    """What the page offers to do next, if it can be done."""
    return page.bar.primary.text() if page.bar.primary.isEnabled() else ""


def spread(window, count):
    panel = window.page.panel_markers
    panel.count.setValue(count)
    window.click(panel.spread)
    window.wait(lambda: len(window.page.work.markers) == count and window.kept() == window.page.work.markers)


def test_the_whole_way_by_clicks(window):
    page, touch = window.page, window.page.panel_touch
    window.wait(lambda: offered(page) == "Place 12 markers")
    spread(window, 2)
    page.tabs.setCurrentIndex(3)
    window.click(page.bar.primary)
    window.wait(lambda: offered(page) == "Touch M1")
    assert Step.VERIFY in window.bench.running
    assert not page.panel_markers.spread.isEnabled()
    page.tick()
    assert "M1" in touch.next.text()
    assert page.panel_markers.table.item(0, 4).text() == "next"
    for marker in page.work.markers.all:
        press(window.bench.live, marker.point_S)
        page.tick()
    assert touch.state.state == "accepted"
    assert "accepted" in page.panel_touch.sounds.played
    assert touch.error.number.endswith("mm")
    assert "All markers" in touch.next.text()
    window.click(page.bar.primary)
    window.wait(lambda: page.tabs.currentIndex() == 4 and offered(page) == "Next: Export")
    assert page.work.outcome.passed
    assert page.panel_result.verdict.text() == "Passed"
    assert page.panel_result.number.text() == f"{page.work.outcome.mean_mm:.2f} mm"
    assert page.panel_result.open.isVisible()
    assert Step.VERIFY not in window.bench.running
    assert window.told[-1].weight is Weight.GOOD
    assert ("verification", "verification.json") in window.desk.state.current_results
    the_result_is_seen(window, page.work.outcome.found)
    assert window.bench.undo.undoText() == "verify"
    window.bench.undo.undo()
    window.wait(lambda: page.work.outcome is None)
    assert page.panel_result.verdict.text() == "Not verified yet"
    window.bench.undo.redo()
    window.wait(lambda: page.work.outcome is not None)
    assert page.panel_result.verdict.text() == "Passed"


def the_result_is_seen(window, found):
    """Errors, ellipses and the worst marker are in the 3D view, and what they are is said beside it."""
    window.page.tick()
    scene = window.scene
    touches = scene._errors.touches
    used = [each for each in found.touches if each.accepted]
    np.testing.assert_allclose(1e3 * touches.points, [each.point_mm for each in used], atol=1e-9)
    np.testing.assert_allclose(1e3 * touches.sizes, [each.distance_mm for each in used], atol=1e-9)
    traces = 1e6 * np.trace(touches.covariances, axis1=1, axis2=2)
    np.testing.assert_allclose(traces, [each.predicted_mm**2 for each in used], rtol=1e-9)
    assert scene.colour_bar.isVisibleTo(scene)
    assert [sign.kind for sign in scene.key.signs if sign.kind != "ring"][-2:] == ["arrow", "ellipse"]
    worst = max(found.per_marker, key=lambda each: each.max_mm)
    at = next(each.point_S for each in window.page.work.markers.all if each.name == worst.name)
    assert scene._eye.sees(at)
    assert f"{worst.name}  {worst.max_mm:.2f} mm ✓" in [label._drawn[0] for label in scene._markers._labels]
    scene.look("top")
    window.click(window.page.panel_result.worst)
    assert scene._eye.sees(at)


def test_a_touch_that_does_not_count_is_said_in_words(window):
    spread(window, 1)
    page = window.page
    page.start()
    window.wait(lambda: offered(page) == "Touch M1")
    press(window.bench.live, page.work.markers.all[0].point_S, force=4.0)
    page.tick()
    assert page.panel_touch.state.state == "rejected"
    assert "force out of window (" in page.panel_touch.state.detail.lower()
    assert page.panel_touch.sounds.played[-1] == "rejected"
    window.click(page.panel_touch.discard)
    window.wait(lambda: not page.work.going_on and offered(page) == "Start touching")
    assert ("recording", "verify-1.mcap") not in window.desk.state.current_inputs


def test_the_virtual_bench_touches_for_who_has_none(window):
    spread(window, 1)
    page = window.page
    page.start()
    window.wait(lambda: offered(page) == "Touch M1" and page.bar.primary.isEnabled())
    window.click(page.bar.primary)
    window.bench.live.pair.step(400)
    page.tick()
    assert page.work.touches.view().accepted == 1


def test_markers_are_edited_and_every_edit_can_be_undone(window):
    page, undo = window.page, window.bench.undo
    page.panel_markers.add((0.0, 0.0, 0.15))
    page.panel_markers.pick.setChecked(True)
    window.scene.picked.emit(Pick(0, np.array([0.01, 0.0, 0.15])))
    assert page.work.markers.names == ("M1", "M2")
    page.tick()
    page.panel_markers.table.item(0, 0).setText("tip")
    assert page.work.markers.names == ("tip", "M2")
    page.panel_markers.table.rename_wanted.emit("tip", "M2")
    assert window.told[-1].weight is Weight.WARNING
    page.tick()
    page.panel_markers.remove(["M2"])
    assert page.work.markers.names == ("tip",)
    undo.undo()
    assert page.work.markers.names == ("tip", "M2")
    for _ in range(3):
        undo.undo()
    assert page.work.markers == Markers()
    undo.setIndex(4)
    assert page.work.markers.names == ("tip",)
    window.wait(lambda: window.kept() == page.work.markers)
    page.panel_markers.pick.setChecked(False)
    window.scene.picked.emit(Pick(0, np.array([0.01, 0.0, 0.15])))
    assert page.work.markers.names == ("tip",)


def test_a_picked_point_moves_the_marker_that_is_selected(window):
    spread(window, 2)
    page = window.page
    page.tick()
    page.panel_markers.pick.setChecked(True)
    page.panel_markers.table.select("M2")
    window.scene.picked.emit(Pick(0, np.array([0.01, 0.0, 0.15])))
    assert page.work.markers.all[1].point_S.tolist() == [0.01, 0.0, 0.15]
    assert len(page.work.markers) == 2


def test_a_table_is_imported_and_saved(window, tmp_path):
    page, file = window.page, tmp_path / "m.csv"
    file.write_text("name,x_mm,y_mm,z_mm\nnose,0,0,150\n", encoding="utf-8")
    page.panel_markers.bring(file)
    window.wait(lambda: page.work.markers.names == ("nose",))
    page.panel_markers.write(tmp_path / "out.csv")
    window.wait(lambda: (tmp_path / "out.csv").exists())
    assert (tmp_path / "out.csv").read_bytes() == page.work.markers.to_bytes()
    file.write_text("nothing\n", encoding="utf-8")
    page.panel_markers.bring(file)
    window.wait(
        lambda: any("m.csv" in message.text and message.weight is Weight.WARNING for message in window.told)
    )
    assert page.work.markers.names == ("nose",)


def test_a_marker_is_left_out_only_with_a_reason(window):
    spread(window, 2)
    page = window.page
    page.start()
    window.wait(lambda: offered(page) == "Touch M1")
    window.click(page.panel_touch.skip)
    dialog = page.window().findChild(QInputDialog)
    assert "M1" in dialog.labelText()
    assert dialog.isComboBoxEditable()
    dialog.setTextValue("the arm cannot get there")
    dialog.accept()
    assert page.work.touches.left_out == {"M1": "the arm cannot get there"}
    assert "the arm cannot get there" in window.told[-1].text
    page.panel_touch.leave_out("M2", "  ")
    assert "enter a reason" in window.told[-1].text
    page.panel_touch.leave_out("M1", "again")
    assert "was not skipped because it has been touched in the meantime" in window.told[-1].text
    page.tick()
    assert page.panel_markers.table.item(0, 4).text() == "left out"
    press(window.bench.live, page.work.markers.all[1].point_S)
    page.tick()
    window.click(page.bar.primary)
    window.wait(lambda: page.work.outcome is not None and not page.work.going_on)
    assert page.work.outcome.passed
    assert any("M1 (the arm cannot get there)" in note for note in page.work.outcome.found.verdict.notes)


def test_settings_are_those_of_the_session_and_can_be_undone(window):
    page = window.page
    page.panel_how.rows["repeats"].field.setValue(3)
    window.wait(lambda: "verification.repeats" in window.desk.state.settings)
    assert window.desk.state.settings["verification.repeats"].value == 3
    page.panel_how.low.setValue(7.0)
    window.wait(lambda: "verification.windows" in window.desk.state.settings)
    assert window.desk.state.settings["verification.windows"].value == [[7.0, 10.0]]
    window.bench.undo.undo()
    window.bench.undo.undo()
    window.wait(lambda: window.desk.state.settings["verification.repeats"].value == 1)
    window.wait(lambda: page.panel_how.rows["repeats"].value == 1 and page.panel_how.low.value() == 8.0)


def test_without_calibration_or_devices_the_page_says_what_to_do(qtbot, tmp_path):
    Session.create(tmp_path / "s").close()
    window = Window(qtbot, tmp_path / "s", devices=False)
    try:
        page, went = window.page, []
        window.bench.go_to.connect(went.append)
        assert "Gravity" in page.bar.words
        assert not page.tabs.isVisible()
        window.click(page.bar.primary)
        assert went == [Step.GRAVITY]
        page.tick()
        assert "No sensor" in page.panel_touch.state.detail
    finally:
        window.close()


def test_nothing_of_the_page_stays_in_the_scene_and_no_panel_is_too_wide(window):
    spread(window, 2)
    page = window.page
    for tab in range(page.tabs.count()):
        page.tabs.setCurrentIndex(tab)
        area = page.tabs.widget(tab)
        window.wait(lambda area=area: 300 < area.widget().width() <= area.viewport().width())
        assert area.widget().minimumSizeHint().width() <= 330
    page.panel_touch.heat.setChecked(True)
    page.tick()
    page.leave()
    window.page.enter()
    page.panel_touch.mute.click()
    assert page.panel_touch.sounds.muted


def found(reason, **known):
    """A contact as the solver gives it."""
    usual = {
        "reason": reason,
        "accepted": reason in (Reason.OK, Reason.VERTEX, Reason.BY_REGION),
        "point": np.array([0.0, 0.0, 0.15]),
        "normal": np.array([0.0, 0.0, 1.0]),
        "covariance": 1e-8 * np.eye(3),
        "sigma_max": 1e-4,
        "within": 1.23e-3,
        "confidence": 0.98,
        "candidates": [],
        "second": None,
        "misfit": 0.1,
        "arm": 0.0,
        "torsion_arm": 0.001,
        "torsion_since": 2.0,
    }
    return SimpleNamespace(**(usual | known))


def shown(window, monkeypatch, contact, force=9.0, on=None):
    """Let the page see a contact; return what it says, whether without a doubt, and what it shows in the scene."""
    wrench, seen = np.array([0.0, 0.0, -force, 0.0, 0.0, 0.0]), []
    monkeypatch.setattr(
        window.bench.live, "reading", lambda: LiveReading(1.0, wrench, wrench, np.eye(3), contact, on)
    )
    monkeypatch.setattr(window.scene, "show_contact", lambda *given: seen.append(given))
    window.page.tick()
    state = window.page.panel_touch.state
    return state.contact, state.sure, seen


IMPLAUSIBLE = (
    "No single touch explains this wrench (residual 4.2 sigma, moment arm 12 mm). Check for two"
    " simultaneous touches, and check units, mount and compensation."
)
RIVALS = [SimpleNamespace(point=np.array([0.0, 0.02, 0.1])), SimpleNamespace(point=np.array([0.0, 0.0, 0.1]))]


@pytest.mark.parametrize(
    ("contact", "words", "sure", "rings", "caption"),
    [
        (found(Reason.OK, candidates=RIVALS), "Sure, within 1.2 mm", True, None, None),
        (found(Reason.VERTEX, within=1e-6), "Sure, within 0.1 mm", True, None, None),
        (
            found(Reason.UNCERTAIN, within=0.0123, candidates=RIVALS),
            "Only within 12.3 mm.",
            False,
            None,
            None,
        ),
        (found(Reason.OK, torsion_arm=0.0032), "Torsion arm 3.2 mm, learned for 2 s.", True, None, None),
        (
            found(Reason.BY_REGION, candidates=RIVALS),
            "Sure by the defined regions, within 1.2 mm",
            True,
            2,
            "possible alternative",
        ),
        (
            found(Reason.AMBIGUOUS, confidence=0.6, candidates=RIVALS),
            "Confidence 60 %: the wrench also fits another place",
            False,
            2,
            "possible alternative",
        ),
        (
            found(Reason.TWO_TOUCHES, second=RIVALS[0].point),
            "Two touches detected; both are shown.",
            False,
            1,
            "second touch",
        ),
    ],
)
def test_how_sure_a_contact_is_and_where_it_could_be_as_well(
    window, monkeypatch, contact, words, sure, rings, caption
):
    said, is_sure, seen = shown(window, monkeypatch, contact)
    assert words in said
    assert is_sure is sure
    (point, covariance, _, others, captions, sure_words) = seen[-1]
    assert ("sure" in said.lower()) is sure  # no doubt beside it
    near = f"≤ {max(1e3 * contact.within, 0.1):.1f} mm"
    assert sure_words == {Reason.TWO_TOUCHES: "", Reason.AMBIGUOUS: "60 %"}.get(contact.reason, near)
    assert point is contact.point
    assert (covariance is None) == (contact.reason is Reason.TWO_TOUCHES)
    assert (others is None) if rings is None else others.shape == (rings, 3)
    if rings:
        assert others[0].tolist() == RIVALS[0].point.tolist()  # the likeliest of them has the words
        assert captions == (caption, f"{caption}, behind")


@pytest.mark.parametrize(
    ("reason", "words"),
    [
        (Reason.IMPLAUSIBLE, IMPLAUSIBLE),
        (Reason.TANGENTIAL, "Press more directly into it"),
        (Reason.OFF_SURFACE, "No part of the probe faces this force"),
        (Reason.OUTSIDE_REGION, "outside all regions"),
        (Reason.SATURATED, "The sensor is at the limit of its range"),
    ],
)
def test_why_there_is_no_contact_is_said_in_plain_words(window, monkeypatch, reason, words):
    contact = found(reason, point=None, misfit=4.2**2, arm=-0.012)
    said, sure, seen = shown(window, monkeypatch, contact)
    assert words in said
    assert not sure
    assert not any(point is not None for point, *_ in seen)
    # Too light to say anything, or nothing at all.
    assert shown(window, monkeypatch, contact, force=0.8)[:2] == ("", True)
    assert shown(window, monkeypatch, None)[:2] == ("", True)


@pytest.mark.parametrize(
    ("on", "words", "sure"),
    [
        ("measured", "Sure, within 1.2 mm", True),
        ("invented", "On a facet added during repair: its position is an estimate.", False),
        ("untouchable", "On an untouchable region: check the region and the mount.", False),
    ],
)
def test_a_contact_on_an_invented_or_untouchable_facet_is_a_doubt(window, monkeypatch, on, words, sure):
    assert shown(window, monkeypatch, found(Reason.OK), on=on)[:2] == (words, sure)
    # Not of what is too light to be shown.
    assert shown(window, monkeypatch, found(Reason.OK), force=0.8, on=on)[:2] == ("", True)
