"""Devices that are not there, are pulled out, or give nonsense: said in words, and gone on from."""

from __future__ import annotations

import shutil

import pytest
from PySide6.QtCore import Qt
from workbench.gravity_bench import batches, record

from contactbench.app.pages.gravity_run import Phase
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step

STILL = "still://?rpy=180,0,0"


def equipped(folder, sensor, poses=STILL):
    """Make a session that names devices."""
    with Session.create(folder) as session:
        session.set_parameter("devices.sensor", sensor)
        session.set_parameter("devices.poses", poses)
    return folder


def port_of(url):
    return int(url.partition("127.0.0.1:")[2].partition("?")[0].strip("/"))


def click(made, button):
    made.wait(button.isEnabled)
    made.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def typed(page, address, poses="None"):
    page.sensor.kind.setCurrentIndex(page.sensor.kind.findText("Enter address"))
    page.poses.kind.setCurrentIndex(page.poses.kind.findText(poses))
    page.sensor.address.setText(address)


def test_unplugged_while_weighing_and_back(made, tmp_path):
    folder = tmp_path / "s"
    with emulator("sri", "tcp", rate=200.0) as sensor:
        port = port_of(sensor.url)
        made.open(equipped(folder, sensor.url))
        made.wait(lambda: made.window.bench.connected)
        page = made.page(Step.GRAVITY)
        click(made, page.primary)
        made.wait(lambda: page.run.phase is Phase.CAPTURING)
        made.wait(lambda: page.run.work.view().state is not None and made.window.bench.live.samples > 100)
    made.wait_said("sensor", "resumes automatically")
    assert made.alive()
    made.page(Step.DEVICES)
    made.wait_said("the sensor is disconnected")  # and what to do, on the page of devices
    made.wait_said("plug it in again")
    made.page(Step.GRAVITY)
    with emulator("sri", "tcp", port=port, rate=200.0):
        made.wait_said("samples again")
        click(made, page.second)
        made.wait(lambda: page.run.phase is Phase.IDLE)
    assert ("recording", "gravity-1.mcap") in made.window.bench.desk.state.current_inputs
    assert not made.unexpected


def test_a_cut_serial_line_while_weighing_keeps_what_was_recorded(made, tmp_path):
    folder = tmp_path / "s"
    with emulator("sri", "serial", rate=200.0) as sensor:
        made.open(equipped(folder, sensor.url))
        made.wait(lambda: made.window.bench.connected)
        page = made.page(Step.GRAVITY)
        click(made, page.primary)
        made.wait(lambda: page.run.phase is Phase.CAPTURING)
        before = made.window.bench.live.samples  # the line was read before the recording began
        made.wait(lambda: made.window.bench.live.samples > before + 150)
    made.wait_said("sensor", "resumes automatically")
    click(made, page.second)  # nobody has to wait for it
    made.wait(lambda: page.run.phase is Phase.IDLE)
    (kept,) = [each for each in made.window.bench.desk.state.inputs if each.name == "gravity-1.mcap"]
    assert kept.about["streams"]["sensor"]["samples"] > 100
    assert not made.unexpected


def test_unplugged_while_verifying_and_closed(made, calibrated, tmp_path):
    folder = shutil.copytree(calibrated, tmp_path / "s")
    with emulator("sri", "tcp", rate=200.0) as sensor:
        with Session.open(folder) as session:
            session.set_parameter("devices.sensor", sensor.url)
            session.set_parameter("devices.poses", STILL)
        made.open(folder)
        made.wait(lambda: made.window.bench.connected)
        page = made.page(Step.VERIFY)
        made.wait(lambda: page.work.tool is not None)
        page.panel_markers.count.setValue(2)
        click(made, page.panel_markers.spread)
        made.wait(lambda: len(page.work.markers) == 2 and not page.panel_markers.pending)
        page.tabs.setCurrentIndex(3)
        click(made, page.bar.primary)
        made.wait(lambda: page.work.going_on)
    made.wait_said("sensor", "resumes automatically")
    assert "resumes automatically" in page.bar.words
    assert made.alive()
    click(made, page.bar.primary)
    made.wait(lambda: not page.work.going_on)
    made.idle()
    # Nothing was touched. Whether the robot had said a pose by then decides between a verdict and the reason for none.
    made.wait(lambda: made.said("Verification failed") or made.said("verify-1.mcap"))
    reason = [text for text in made.window.messages.texts() if "verify-1.mcap" in text]
    assert page.bar.words == (reason[0] if reason else "")
    assert ("recording", "verify-1.mcap") in made.window.bench.desk.state.current_inputs
    assert not made.unexpected
    assert ("calibration", "calibration.json") in made.window.bench.desk.state.current_results


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("sri+tcp:/127.0.0.1", "://"),
        ("nonsense", "://"),
        ("sri+tcp://127.0.0.1:99999", "port"),
        ("elfin+tcp://1.2.3.4", "not a force/torque sensor"),
    ],
)
def test_a_wrong_address_cannot_be_used_and_says_why(made, tmp_path, address, words):
    made.new(tmp_path / "s")
    page = made.page(Step.DEVICES)
    typed(page, address)
    assert words in page.sensor.problem
    assert not page.use_button.isEnabled()


@pytest.mark.parametrize("way", ["nobody", "serial"])
def test_nobody_there_is_waited_for_in_words(made, tmp_path, way):
    made.new(tmp_path / "s")
    page = made.page(Step.DEVICES)
    typed(page, "sri+tcp://127.0.0.1:1" if way == "nobody" else f"sri+serial://{tmp_path}/ttyNone")
    click(made, page.use_button)
    made.wait(
        lambda: any(words in page.trial._findings.text() for words in ("does not respond", "is disconnected"))
    )
    assert made.alive()
    made.page(Step.GRAVITY)
    assert not made.unexpected


@pytest.mark.parametrize("damage", ["missing", "truncated", "text", "empty"])
def test_a_replay_that_cannot_be_played(made, tmp_path, damage):
    with Session.create(tmp_path / "source") as session:
        record(session, "gravity-1.mcap", batches(1))
        whole_file = session.folder / session.state.inputs[0].file.path
    file = tmp_path / "r.mcap"
    content = whole_file.read_bytes()
    bytes_of = {"truncated": content[:200], "text": b"Dear Sir or Madam", "empty": b""}
    if damage != "missing":
        file.write_bytes(bytes_of[damage])
    made.new(tmp_path / "s")
    page = made.page(Step.DEVICES)
    page.sensor.kind.setCurrentIndex(page.sensor.kind.findText("Replay a recording"))
    page.sensor.recording.edit.setText(str(file))
    click(made, page.use_button)
    made.wait_said("Could not open", "r.mcap")
    assert page.sensor.problem
    assert page.use_button.isEnabled()  # to be tried again
    assert made.alive()
    assert not made.unexpected
    made.window.close()
    made.wait(lambda: not made.window.isVisible())
    assert not check(tmp_path / "s").problems


def test_a_session_whose_replay_is_gone_opens_all_the_same(made, tmp_path):
    made.open(equipped(tmp_path / "s", f"replay://{tmp_path}/gone.mcap", f"replay://{tmp_path}/gone.mcap"))
    made.wait_said("Could not open", "gone.mcap", "step 1")
    page = made.page(Step.GRAVITY)
    made.idle()
    if page.primary.isEnabled():
        click(made, page.primary)
        made.wait_said("no device is open")
    assert made.alive()
    assert not made.unexpected
