import pytest
from waiting import until

from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, sine
from contactbench.pipeline.errors import InputError, RecordingError
from contactbench.pipeline.recording import read_recording
from contactbench.pipeline.workbench.tape import SessionTape

BENCH = "virtual://bench?probe=convex&sensor=paper&speed=step"
PATIENCE = 30


def start(desk, live, name="gravity-1.mcap"):
    desk.do(lambda session: session.set_parameter("devices.serial", "SN 7"))
    return SessionTape.start(desk, live, name).result(PATIENCE)


def test_what_comes_while_it_runs_is_an_input_of_the_session(desk, live):
    live.open(BENCH, BENCH)
    live.pair.step(50)
    tape = start(desk, live)
    live.pair.step(500)
    assert not tape._ended
    samples, seconds = tape.samples, tape.seconds
    tape.keep().result(PATIENCE)
    live.pair.step(50)
    kept = desk.state.current_inputs["recording", "gravity-1.mcap"]
    assert kept.sensor == "SN 7"
    assert kept.about["streams"]["sensor"]["samples"] == samples == tape.samples
    assert kept.about["streams"]["robot"]["samples"] == 500 - samples
    (wrenches,) = read_recording(desk.folder / kept.file.path).wrenches.values()
    assert len(wrenches.times) == samples
    assert wrenches.times[-1] - wrenches.times[0] == pytest.approx(seconds)
    assert tape._ended


def test_discarding_leaves_no_file_and_says_so(desk, live):
    live.open(BENCH, BENCH)
    tape = start(desk, live)
    live.pair.step(100)
    tape.discard().result(PATIENCE)
    assert not desk.state.current_inputs
    assert not list((desk.folder / "raw").iterdir())
    assert "abandoned" in desk.state.notes[-1].text


def test_without_a_sample_nothing_is_kept(desk, live):
    live.open(BENCH, BENCH)
    tape = start(desk, live)
    with pytest.raises(InputError, match="no sample arrived"):
        tape.keep().result(PATIENCE)
    assert not list((desk.folder / "raw").iterdir())
    with pytest.raises(InputError, match="already ended"):
        tape.discard().result(PATIENCE)


def test_without_devices_nothing_begins(desk, live):
    with pytest.raises(InputError, match="choose devices first"):
        start(desk, live)


def test_a_name_that_is_taken_is_refused(desk, live):
    live.open(BENCH, BENCH)
    first = start(desk, live)
    live.pair.step(10)
    first.keep().result(PATIENCE)
    with pytest.raises(InputError, match="choose another name"):
        start(desk, live)


def test_an_unplugged_sensor_does_not_end_it(desk, live):
    script = Script([FaultEvent(0.5, Fault.RECONNECT, 0.8)])

    with emulator("sri", "tcp", script=script, signal=sine((5, 5, 5, 0.1, 0.1, 0.1))) as device:
        live.open(device.url, None)
        tape = start(desk, live)
        until(lambda: tape.findings)
        assert any("resumes automatically" in words for words in tape.findings)
        before = tape.samples
        assert before
        until(lambda: tape.samples > before + 20)
        assert not tape._ended
        tape.keep().result(PATIENCE)
    kept = desk.state.current_inputs["recording", "gravity-1.mcap"]
    assert kept.about["streams"]["sensor"]["reconnected"] == 1


def test_closed_devices_leave_what_came(desk, live):
    live.open(BENCH, BENCH)
    tape = start(desk, live)
    live.pair.step(100)
    live.close()
    assert tape._cut
    assert any("devices were closed" in words for words in tape.findings)
    tape.keep().result(PATIENCE)
    assert desk.state.current_inputs


def test_a_full_disk_is_told_and_what_was_recorded_is_kept(desk, live, monkeypatch):
    live.open(BENCH, BENCH)
    tape = start(desk, live)
    live.pair.step(200)
    recorder = tape._recording.recorder

    def full(_sample, _topic=None):
        raise RecordingError("raw: it cannot be written (No space left on device): free space.")

    assert tape.error is None
    (raw,) = (desk.folder / "raw").iterdir()
    until(lambda: any(len(each.times) > 100 for each in read_recording(raw).wrenches.values()))
    monkeypatch.setattr(tape._recording._writer, "wrench", full)
    live.pair.step(200)
    assert recorder.failed.wait(PATIENCE)
    assert "No space left" in tape.error
    assert tape.error in tape.findings
    tape.keep().result(PATIENCE)
    kept = desk.state.current_inputs["recording", "gravity-1.mcap"]
    assert "No space left" in kept.about["problem"]
    (wrenches,) = read_recording(desk.folder / kept.file.path).wrenches.values()
    assert len(wrenches.times) > 100
