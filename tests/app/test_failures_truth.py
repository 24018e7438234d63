"""One truth: whatever is wrong is said by the step, by its page and by the export, at once and in the same words."""

import os
import shutil
import subprocess

import pytest

from contactbench.app.pages.gravity_run import Phase
from contactbench.app.window_pages import TroubleNotice
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.session.why import DISK, CheckState
from contactbench.pipeline.steps import Step, StepState

from .test_failures_files import click, close, full, mounted
from .test_failures_results import equipped, port_of, status

__all__ = ["full"]  # a fixture


@pytest.fixture(scope="module")
def verified(sessions, tmp_path_factory):
    folder = shutil.copytree(sessions / "verified", tmp_path_factory.mktemp("made") / "s")
    with Session.open(folder) as session:
        session.set_parameter("config.rate", 200.0)
    return folder


def wait_red(made, *steps):
    """Wait until these steps are red; return the one sentence that all of them, and their pages, say."""
    made.wait(lambda: all(status(made, step).state is StepState.FAILED for step in steps))
    (sentence,) = {status(made, step).sentence for step in steps}
    for step in steps:
        page = made.page(step)
        (notice,) = page.findChildren(TroubleNotice)
        made.wait(notice.isVisible)
        assert notice.words.text() == sentence
    return sentence


def file_of(folder, kind):
    with Session.open(folder, write=False) as session:
        return folder / session.state.newest(kind).file.path


def test_a_file_that_vanishes_under_the_window(made, verified, tmp_path):
    folder = shutil.copytree(verified, tmp_path / "s")
    made.open(folder)
    made.wait(lambda: status(made, Step.VERIFY).state is StepState.DONE)
    page = made.page(Step.VERIFY)
    made.wait(lambda: page.panel_result.verdict.text() == "Passed")
    made.idle()
    file = file_of(folder, "probe")
    content = file.read_bytes()
    file.unlink()
    sentence = wait_red(made, Step.PROBE, Step.VERIFY, Step.EXPORT)
    assert file.name in sentence
    assert made.said(sentence)  # in the list too, in the same words
    made.page(Step.VERIFY)
    assert page.panel_result.verdict.text() == "Does not count"
    assert page.bar.primary.text() != "Next: Export"
    assert status(made, Step.GRAVITY).state is StepState.DONE
    export = made.page(Step.EXPORT)
    made.wait(lambda: export.standing.text() == sentence)
    lines = {item.name: item for item in export.view.items}
    assert lines["Verification"].state is lines["Probe"].state is CheckState.FAILED
    assert lines["Verification"].sentence == lines["Probe"].sentence == sentence
    assert not export.zip.isEnabled()
    file.write_bytes(content)
    made.wait(lambda: status(made, Step.VERIFY).state is StepState.DONE)
    made.wait(export.zip.isEnabled)
    assert not export.findChild(TroubleNotice).isVisible()
    made.page(Step.VERIFY)
    assert page.panel_result.verdict.text() == "Passed"
    assert not made.unexpected
    close(made)
    assert not check(folder).problems


def test_a_file_that_was_damaged_before_it_was_opened(made, verified, tmp_path):
    folder = shutil.copytree(verified, tmp_path / "s")
    file = file_of(folder, "calibration")
    content = bytearray(file.read_bytes())
    content[content.index(b".") + 1] ^= 1  # one digit: it is still a calibration
    file.chmod(0o644)
    file.write_bytes(content)
    made.open(folder)
    sentence = wait_red(made, Step.GRAVITY, Step.VERIFY, Step.EXPORT)
    assert "does not match the journal" in sentence
    assert not made.unexpected


def test_a_full_disk_turns_red_what_would_be_written(made, verified, tmp_path, full):
    folder = shutil.copytree(verified, tmp_path / "s")
    made.open(folder)
    made.idle()
    full.fill()
    made.window.bench.do("Noting", lambda session: session.note("n"))
    made.wait_said("resumes automatically")
    assert made.window.bench.desk.refuses
    assert wait_red(made, Step.REGIONS, Step.EXPORT) == DISK
    assert made.said(DISK)
    full.free()
    made.wait_said("writable again")
    assert "writable again" in made.window._newest.text(), "and the line below is not red any more"
    made.wait(lambda: status(made, Step.EXPORT).state is not StepState.FAILED)
    assert not made.window.bench.desk.refuses
    made.window.bench.desk.do(lambda session: session.note("again")).result(10)
    assert not made.unexpected


def test_no_pose_is_captured_that_is_not_recorded_and_what_was_is_kept(made, tmp_path, full):
    folder = tmp_path / "s"
    made.window.sessions.try_virtual(folder)
    made.wait(lambda: made.window.bench is not None and made.window.bench.connected)
    page = made.page(Step.GRAVITY)
    click(made, page.primary)
    made.wait(lambda: page.run.phase is Phase.CAPTURING)
    made.wait(lambda: page.run._tape.seconds > 1.5)
    full.fill()
    made.wait(lambda: status(made, Step.GRAVITY).state is StepState.FAILED)
    made.wait_said("no space left")
    assert "no space left" in status(made, Step.GRAVITY).sentence.lower()
    assert not page.panel.state.isVisible()  # no green "captured" beside it
    count = len(page.run.work.view().rows)
    samples = made.window.bench.live.ring.count
    made.wait(lambda: made.window.bench.live.ring.count > samples + 400)
    assert len(page.run.work.view().rows) == count
    full.free()
    click(made, page.panel.stop)
    made.wait(lambda: page.run.phase is Phase.IDLE)
    # Until it is begun again; but nothing is wrong any more.
    made.wait(lambda: not status(made, Step.GRAVITY).broken)
    assert "no space left" in status(made, Step.GRAVITY).sentence.lower()
    click(made, page.second if page.second.isVisible() else page.primary)
    made.wait(lambda: status(made, Step.GRAVITY).state is StepState.RUNNING)
    assert not made.unexpected
    close(made)
    assert not check(folder).problems
    with Session.open(folder) as session:  # what was written before is there, in the session or to be adopted
        kept = [*session.state.inputs, *(folder / "raw").iterdir()]
    assert any("gravity-1.mcap" in each.name for each in kept)


def test_a_device_that_is_gone_is_said_by_all_that_need_it(made, tmp_path):
    folder = tmp_path / "s"
    with emulator("sri", "tcp", rate=200.0) as sensor:
        port = port_of(sensor.url)
        made.open(equipped(folder, sensor.url))
        made.wait(lambda: made.window.bench.connected)
        page = made.page(Step.GRAVITY)
        click(made, page.primary)
        made.wait(lambda: page.run.phase is Phase.CAPTURING)
        made.wait(lambda: page.run.work.view().state is not None and made.window.bench.live.ring.count > 100)
    made.wait_said("sensor", "resumes automatically")
    sentence = wait_red(made, Step.DEVICES, Step.GRAVITY)
    made.wait_said("the sensor is disconnected")  # and what to do, on the page of devices
    made.wait_said("plug it in again")
    assert "disconnected" in sentence or "silent" in sentence
    assert not page.panel.state.isVisible()
    with emulator("sri", "tcp", port=port, rate=200.0):
        made.wait(lambda: status(made, Step.DEVICES).state is StepState.DONE)
        made.wait_said("samples again")
        made.wait(lambda: status(made, Step.GRAVITY).state is StepState.RUNNING)
        assert made.page(Step.GRAVITY).panel.state.isVisible()
        click(made, page.panel.stop)
        made.wait(lambda: page.run.phase is Phase.IDLE)
    assert ("recording", "gravity-1.mcap") in made.window.bench.desk.state.current_inputs
    assert not made.unexpected


def test_on_a_disk_that_really_is_full(made, verified, tmp_path):
    disk = mounted(tmp_path / "disk", "8m")
    try:
        folder = shutil.copytree(verified, disk / "s")
        made.open(folder)
        made.idle()
        filling = os.open(disk / "filling", os.O_WRONLY | os.O_CREAT)
        try:
            while os.write(filling, b"x" * 4096):
                pass
        except OSError:
            os.close(filling)
        for _ in range(20):
            made.window.bench.do("Noting", lambda session: session.note("n" * 1000))
        assert wait_red(made, Step.REGIONS, Step.EXPORT) == DISK
        (disk / "filling").unlink()
        made.wait(lambda: status(made, Step.EXPORT).state is not StepState.FAILED)  # by itself
        close(made)
        assert not check(folder).problems
    finally:
        close(made)
        subprocess.run(["umount", "-l", str(disk)], check=False)
