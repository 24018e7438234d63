"""The Export page in a real window: what it says, and the bytes that it writes."""

import json
import shutil
import socket

import pytest
from PySide6.QtGui import QGuiApplication
from terminal import invoke
from workbench.touch_session import STEPWISE

from contactbench.app.bench import Weight
from contactbench.app.pages.export import ExportPage
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.control.settings import ControlSettings, controller_of
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step

from .page_window import PageWindow


class Window(PageWindow):
    def __init__(self, qtbot, folder):
        super().__init__(qtbot, Session.open(folder, by="ada"), ExportPage)
        self.enter()
        self.wait(lambda: self.page.view is not None)


@pytest.fixture
def window(qtbot, sessions, tmp_path, request):
    name = getattr(request, "param", "verified")
    opened = Window(qtbot, shutil.copytree(sessions / name, tmp_path / "s"))
    yield opened
    opened.close()


def test_a_verified_session_is_exported_to_the_bytes_of_the_command(window, tmp_path):
    page = window.page
    assert "ready" in page.standing.text()
    assert "Neither a known weight nor a known touch was checked" in page.standing.text()
    assert page.zip.isEnabled()
    assert not page.unverified.isVisible()
    assert "probe.ply" in page.files.text()
    page.settings.texts["operator"].setText("Ada Lovelace")
    page.settings.texts["operator"].editingFinished.emit()
    page.settings.rows["max_force"].field.setValue(20.0)
    page.settings.texts["sensor_name"].setText("wrist")
    page.settings.texts["sensor_name"].editingFinished.emit()
    window.wait(lambda: "Ada Lovelace" in page.figures.text() and "20 N" in page.figures.text())
    page.write(tmp_path / "window.zip")
    window.wait(lambda: page.exported is not None)
    assert page.exported.verified
    assert "verified" in page.bar.words
    assert window.told[-1].weight is Weight.WARNING  # "good" never stands beside what nobody checked
    window.wait(lambda: "Verified and exported" in page.standing.text())
    assert page.show_folder.isVisible()
    folder = window.desk.folder
    done = invoke("bundle", "export", folder, "--out", tmp_path / "command.zip")
    assert done.exit_code == 0, done.stderr
    assert (tmp_path / "window.zip").read_bytes() == (tmp_path / "command.zip").read_bytes()
    assert b'sensor_name: "wrist"' in (tmp_path / "window.zip").read_bytes()
    window.bench.undo.undo()
    window.bench.undo.undo()
    window.wait(lambda: "limits.max_force_N: 20 → 30" in page.changes.text())
    page.settings.changed.emit({"no_filter": True, "follow": True, "rival_odds": 20.0}, "as not verified")
    window.wait(lambda: page.standing.text().count("\n• ") == 3)  # every reason: each asks for something else


def test_the_robots_payload_is_the_line_of_the_command(window, tmp_path):
    panel = window.page.payload
    assert "set_target_payload(" in panel.line.text()
    assert "The sensor's own mass is not included." in panel.note.text()
    assert "nothing touching the tool" in panel.note.text()
    panel.at[2].setValue(37.5)
    panel.mass.setValue(0.29)
    panel.centre[2].setValue(18.0)
    panel.robot.setCurrentIndex(panel.robot.findText("KUKA"))
    panel.robot.activated.emit(panel.robot.currentIndex())
    window.wait(lambda: panel.line.text().startswith("LOAD_DATA[1]="))
    assert "not included" not in panel.note.text()
    assert "nothing touching the tool" not in panel.note.text()
    panel.copy.click()
    assert QGuiApplication.clipboard().text() == panel.line.text()
    window.page.write(tmp_path / "runtime.zip")
    window.wait(lambda: window.page.exported is not None)
    words = ["--robot", "kuka", "--mount", "0,0,0", "--sensor-at", "0,0,37.5", "--sensor-body", "0.29,0,0,18"]
    done = invoke("bundle", "payload", tmp_path / "runtime.zip", *words)
    assert done.exit_code == 0, done.stderr
    assert panel.line.text() in done.stdout
    window.bench.undo.undo()
    window.wait(lambda: panel.line.text().startswith("set_target_payload("))


@pytest.mark.parametrize("window", ["calibrated"], indirect=True)
def test_an_unverified_bundle_needs_a_word_more(window, tmp_path):
    page, went = window.page, []
    window.bench.go_to.connect(went.append)
    page.checklist.wanted.emit(Step.VERIFY)
    assert went == [Step.VERIFY]
    # In the window's words, not the command line's.
    assert "or enter Readings under Settings to match the sensor" in page.standing.text()
    assert "--" not in page.standing.text()
    assert [name for name, each in page.folds.items() if each.isChecked()] == ["settings"]
    page.settings.rows["rate"].field.setValue(200.0)
    window.wait(lambda: "Not verified" in page.standing.text())
    assert not page.zip.isEnabled()
    page.unverified.setChecked(True)
    assert page.zip.isEnabled()
    page.write(tmp_path / "b")
    window.wait(lambda: page.exported is not None)
    assert not RuntimeConfig.load(tmp_path / "b").model.verified
    assert "NOT verified" in page.bar.words


def test_gains_come_along_and_can_be_taken_out_again(window, tmp_path):
    page, gains = window.page, tmp_path / "gains.json"
    controller = controller_of(ControlSettings(desired_force=6.0))
    gains.write_text(json.dumps({"controller": controller.model_dump()}), encoding="utf-8")
    assert page.settings.gains.text() == "left out"
    page.settings.read_gains(gains)
    window.wait(lambda: page.settings.gains.text() == "6 N, predictive")
    window.wait(lambda: page.zip.isEnabled())
    page.write(tmp_path / "with.zip")
    window.wait(lambda: page.exported is not None)
    assert RuntimeConfig.load(tmp_path / "with.zip").model.controller == controller
    result = invoke("bundle", "export", window.desk.folder, "--out", tmp_path / "same.zip")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "same.zip").read_bytes() == (tmp_path / "with.zip").read_bytes()
    page.settings.no_gains.click()
    window.wait(lambda: page.settings.gains.text() == "left out")
    assert not page.settings.no_gains.isVisible()
    gains.write_text('{"controller": {"variant": "bold"}}', encoding="utf-8")
    page.settings.read_gains(gains)
    assert "gains.json: controller" in window.told[-1].text


def test_a_place_that_does_not_do_is_said_in_words(window, tmp_path):
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "mine.txt").write_text("x", encoding="utf-8")
    page = window.page
    page.write(tmp_path / "b")
    window.wait(lambda: bool(page.bar.words))
    assert window.told[-1].weight is Weight.ERROR
    assert page.exported is None
    window.wait(lambda: page.zip.isEnabled())


def test_nothing_is_wider_than_the_page(window):
    from PySide6.QtWidgets import QScrollArea

    area = window.page.findChild(QScrollArea)
    window.wait(lambda: area.widget().width() <= area.viewport().width())  # once the scroll bar has its room


def test_contacts_go_out_while_devices_are_open(window):
    page, outputs = window.page, window.page.outputs
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(("127.0.0.1", 0))
        listener.settimeout(10)
        place = f"127.0.0.1:{listener.getsockname()[1]}"
        outputs.chosen["udp"].setChecked(True)
        outputs.addresses["udp"].setText(place)
        window.click(outputs.button)
        window.wait(lambda: any("open them in step 1" in text for text in window.said()))
        window.wait(outputs.button.isEnabled)
        window.bench.live.open(STEPWISE, STEPWISE)
        window.click(outputs.button)
        window.wait(lambda: outputs.outputs.running and outputs.button.isEnabled())
        assert "Stop" in outputs.button.text()
        assert not outputs.addresses["udp"].isEnabled()
        window.bench.live.pair.step(50)
        assert b'"reason"' in listener.recv(65_536)
        window.wait(lambda: "contacts sent." in outputs.states["udp"].text())
    window.click(outputs.button)
    window.wait(lambda: not outputs.outputs.running and outputs.button.isEnabled())
    assert "Start" in outputs.button.text()
    assert window.desk.state.setting("outputs.addresses") == {"udp": place}
    outputs.chosen["udp"].setChecked(False)
    page.enter()
    assert outputs.chosen["udp"].isChecked()


def test_closed_devices_end_the_outputs(window):
    outputs = window.page.outputs
    window.bench.live.open(STEPWISE, STEPWISE)
    outputs.chosen["udp"].setChecked(True)
    window.click(outputs.button)
    window.wait(lambda: outputs.outputs.running)
    window.bench.live.close()
    window.wait(lambda: "Start" in outputs.button.text())
