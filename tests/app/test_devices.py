import threading

import pytest
from PySide6.QtCore import Qt

from contactbench.app.bench import Bench
from contactbench.app.pages.devices import DevicesPage
from contactbench.app.trouble_watch import TroubleWatch
from contactbench.app.undo import SessionCommand, SetParameters
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, sine
from contactbench.pipeline.devices.transport.ports import SerialPort
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live_trial import Devices

PATIENCE_MS = 30_000
BENCH = "virtual://bench?probe=convex&sensor=paper"


@pytest.fixture
def bench(tmp_path, qapp):  # noqa: ARG001 - a window needs one
    found = Bench(Desk(Session.create(tmp_path / "session")), None)
    yield found
    found.close()


@pytest.fixture
def page(bench, qtbot):
    found = DevicesPage(bench)
    qtbot.addWidget(found)
    found.resize(380, 720)
    found.show()
    qtbot.waitExposed(found)
    yield found
    found.close_page()


def settings(bench):
    return {key: setting.value for key, setting in bench.desk.state.settings.items()}


def settle(bench):
    bench.desk.do(lambda _session: None).result(30)


def click(qtbot, button):
    assert button.isEnabled()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def tick_until(qtbot, page, condition):
    def ticked():
        page._trial_at = 0.0
        page.tick()
        return condition()

    qtbot.waitUntil(ticked, timeout=PATIENCE_MS)


def choose(source, name):
    source.kind.setCurrentIndex(source.kind.findText(name))


def test_using_the_virtual_bench_writes_settings_opens_it_and_can_be_undone(page, bench, qtbot):
    page.sensor.probe.setCurrentIndex(page.sensor.probe.findData("convex"))
    click(qtbot, page.use_button)
    tick_until(qtbot, page, lambda: "Connected" in page.trial.words and "200 Hz" in page.trial.words)
    assert settings(bench)["devices.sensor"] == settings(bench)["devices.poses"] == BENCH
    assert bench.live.addresses == (BENCH, BENCH)
    assert bench.undo.undoText() == "choose devices"
    bench.undo.undo()
    qtbot.waitUntil(lambda: bench.live.pair is None, timeout=PATIENCE_MS)
    assert Devices.of(bench.desk.state) == Devices()
    bench.undo.redo()
    qtbot.waitUntil(lambda: settings(bench)["devices.sensor"] == BENCH, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: page.devices().sensor == BENCH, timeout=PATIENCE_MS)


def test_testing_a_connection_changes_nothing_in_the_session(page, bench, qtbot):
    click(qtbot, page.try_button)
    tick_until(qtbot, page, lambda: "Connected" in page.trial.words)
    assert not settings(bench)
    assert "0 lost" in page.trial.words
    assert not bench.undo.canUndo()


def test_noise_and_margin_of_each_channel_are_shown(page, qtbot):
    click(qtbot, page.try_button)
    cells = page.channels._cells
    tick_until(qtbot, page, lambda: cells[0][0].text() != "–")
    assert float(cells[0][0].text().split()[0]) == pytest.approx(0.05, rel=0.5)
    assert cells[5][0].text().endswith("N·m")
    assert cells[0][2].text().endswith("%")


def test_a_wrong_address_is_told_beside_it_and_nothing_can_be_used(page):
    choose(page.sensor, "Enter address")
    page.sensor.address.setText("elfin+tcp://1.2.3.4")
    assert "not a force/torque sensor" in page.sensor.problem
    assert not page.use_button.isEnabled()
    page.sensor.address.setText("sri+tcp://1.2.3.4")
    assert not page.sensor.problem
    assert "Choose the robot that moves it" in page.poses.problem
    choose(page.poses, "Robot")
    page.poses.network.make.setCurrentIndex(page.poses.network.make.findData("ur+tcp://"))
    page.poses.network.host.setText("1.2.3.5")
    assert page.poses.address_line.text() == "Address for commands: ur+tcp://1.2.3.5"
    assert page.use_button.isEnabled()
    assert page.devices().poses == "ur+tcp://1.2.3.5"
    choose(page.poses, "None")
    assert page.devices().poses is None


def test_ports_come_and_go_while_one_is_chosen(page):
    ports = (
        SerialPort("/dev/ttyUSB0", "Bota Systems", None, "bota"),
        SerialPort("/dev/ttyUSB1", "FT232R", None, None),
    )
    page.sensor.set_ports(ports)
    page.sensor.kind.setCurrentIndex(0)
    assert page.sensor.kind.currentText() == "BOTA sensor at /dev/ttyUSB0"
    assert page.devices().sensor == "bota+serial:///dev/ttyUSB0"
    page.sensor.kind.setCurrentIndex(1)
    page.sensor.protocol.setCurrentIndex(page.sensor.protocol.findData("robotiq"))
    assert page.devices().sensor == "robotiq+serial:///dev/ttyUSB1"
    page.sensor.set_ports(ports[:1])
    assert "not plugged in" in page.sensor.kind.currentText()
    assert page.devices().sensor == "robotiq+serial:///dev/ttyUSB1"
    page.sensor.set_ports(ports)
    assert "not plugged in" not in page.sensor.kind.currentText()


def test_ports_are_looked_for_beside_the_window(page, qtbot, monkeypatch):
    found = [SerialPort("/dev/ttyACM7", "SRI M8128", None, "sri")]
    monkeypatch.setattr("contactbench.app.pages.devices.list_ports", lambda: found)
    page.enter()
    tick_until(qtbot, page, lambda: page.sensor.kind.findText("SRI sensor at /dev/ttyACM7") >= 0)


def test_what_the_session_says_is_shown(bench, qtbot):
    chosen = Devices("sri+tcp://1.2.3.4?rate=500", "still://?rpy=0,90,0", (0.0, 0.0, 90.0), "SN 3")
    for key, value in chosen.settings.items():
        bench.desk.do(lambda session, key=key, value=value: session.set_parameter(key, value)).result(30)
    page = DevicesPage(bench)
    qtbot.addWidget(page)
    assert page.devices() == chosen
    page.close_page()


def test_an_unplugged_sensor_and_its_return_are_told(page, bench, qtbot):
    told, watch = [], TroubleWatch(bench)
    bench.told.connect(lambda message: told.append(message.text))

    def heard(words):
        watch.look()
        return any(words in text for text in told)

    with emulator(
        "sri", "tcp", script=Script([FaultEvent(1.0, Fault.RECONNECT, 1.5)]), signal=sine((5, 5, 5, 1, 1, 1))
    ) as device:
        choose(page.sensor, "Enter address")
        choose(page.poses, "None")
        page.sensor.address.setText(device.url)
        click(qtbot, page.use_button)
        tick_until(qtbot, page, lambda: heard("plug it in again"))
        assert "Lost" in page.trial.words or "Connected" in page.trial.words
        tick_until(qtbot, page, lambda: heard("is back"))


def test_devices_cannot_be_changed_while_a_recording_is_made(page, bench):
    assert page.use_button.isEnabled()
    bench.set_running(Step.GRAVITY, True)
    assert not page.use_button.isEnabled()
    assert "recording" in page.bar.words
    bench.set_running(Step.GRAVITY, False)
    assert page.use_button.isEnabled()


def test_nothing_is_wider_than_the_page(page):
    page.resize(340, 700)
    area = page.findChild(type(page.sensor)).parentWidget()
    assert area.width() <= 340
    assert page.sensor.minimumSizeHint().width() <= 330


# ---- undo of what is done with the session -------------------------------------------------------


def test_a_command_that_failed_is_told_and_leaves_nothing_to_undo(bench, qtbot):
    failures = []
    bench.undo.push(
        SessionCommand(
            bench, "try", lambda session: session.set_parameter("NONSENSE", 1), None, failures.append
        )
    )
    qtbot.waitUntil(lambda: bool(failures), timeout=PATIENCE_MS)
    count = bench.desk.state.count
    bench.undo.undo()
    settle(bench)
    assert bench.desk.state.count == count


def test_undone_before_it_is_over(bench):
    undone = threading.Event()

    def slow(session):
        assert undone.wait(10)
        session.set_parameter("calibration.inverse", True)

    bench.undo.push(SessionCommand(bench, "turn round", slow))
    bench.undo.undo()
    undone.set()
    settle(bench)
    assert settings(bench)["calibration.inverse"] is False
    bench.undo.redo()
    settle(bench)
    assert settings(bench)["calibration.inverse"] is True


def test_the_sensors_certificate_goes_into_the_session(page, bench, qtbot):
    page.due.setText("31 March")
    assert not page.use_button.isEnabled()
    assert "2027-03-31" in page.bar.words
    page.serial.setText("SN 7")
    page.certificate.setText("DKD-7")
    page.due.setText("2031-01-31")
    click(qtbot, page.use_button)
    tick_until(qtbot, page, lambda: "Connected" in page.trial.words)
    assert settings(bench)["report.due"] == "2031-01-31"
    assert (settings(bench)["report.certificate"], settings(bench)["devices.serial"]) == ("DKD-7", "SN 7")
    bench.undo.undo()
    qtbot.waitUntil(lambda: bench.live.pair is None, timeout=PATIENCE_MS)
    assert not page.certificate.text()


def test_one_parameter(bench):
    bench.undo.push(SetParameters(bench, {"devices.serial": "SN 1"}, "set the serial number"))
    bench.undo.push(SetParameters(bench, {"devices.serial": "SN 2"}, "set the serial number"))
    bench.undo.undo()
    settle(bench)
    assert settings(bench)["devices.serial"] == "SN 1"


@pytest.mark.parametrize(
    ("address", "kind"),
    [
        ("sri+tcp://10.0.0.5", "Sensor on the network"),
        ("rdt+udp://box:5000", "Sensor on the network"),
        ("sri+tcp://10.0.0.5?rate=500", "Enter address"),
    ],
)
def test_a_sensor_on_the_network_is_known_by_its_make_and_nothing_of_its_address_is_lost(page, address, kind):
    page.sensor.choose(address)
    assert page.sensor.kind.currentText() == kind
    assert page.sensor.address_now() == address
    assert page.sensor.address_line.isHidden() == (kind == "Enter address")
