"""Results that are refused, failed or stale, and everything undone: said in words, and nothing that held is lost."""

import json
import shutil
import threading

import numpy as np
import pytest
from workbench.gravity_bench import batches, record
from workbench.probe_files import egg

from contactbench.app.pages.gravity_run import Phase
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step, StepState
from contactbench.pipeline.workbench.gravity_fit import finish
from contactbench.pipeline.workbench.undo_history import value_in
from contactbench.widgets.scene.scene import Pick

from .test_failures_files import click, close


def status(made, step):
    return made.window.pages.statuses[step]


def wait_state(made, step, state):
    made.wait(lambda: status(made, step).state is state)
    return status(made, step).sentence


# ---- refused, failed, stale ----------------------------------------------------------------------


@pytest.mark.parametrize(("poses", "words"), [(slice(0, 2), "pose"), (None, "direction")])
def test_a_calibration_that_is_refused_leaves_the_one_before(made, sessions, tmp_path, poses, words):
    folder = shutil.copytree(sessions / "calibrated", tmp_path / "s")
    some = batches()
    per_pose = len(some) // 6
    with Session.open(folder) as session:
        before = session.state.current_results[("calibration", "calibration.json")].number
        record(session, "gravity-1.mcap", some[: 2 * per_pose] if poses else some[:per_pose])
    bench = made.open(folder)
    page = made.page(Step.GRAVITY)
    made.idle()
    bench.do("Computing", lambda session: finish(session, "gravity-1.mcap"), None, page.run.idle_again)
    made.wait(lambda: bool(page.run.problem) or made.said(words))
    made.idle()
    assert page.panel.problem.isVisible() or page.panel.verdict.isVisible()
    assert made.alive()
    assert not made.unexpected
    now = bench.desk.state.current_results[("calibration", "calibration.json")]
    assert now.number == before or any(
        "refuse" in text for text in (status(made, Step.GRAVITY).sentence.lower(),)
    )
    close(made)
    assert not check(folder).problems


def test_a_verification_that_fails_says_what_to_do_and_is_not_exported(made, sessions, tmp_path):
    folder = shutil.copytree(sessions / "verified", tmp_path / "s")
    with Session.open(folder) as session:
        found = session.state.current_results[("verification", "verification.json")]
        content = json.loads((folder / found.file.path).read_bytes())
        content["verdict"] = {"passed": False, "reasons": ["M1 is 9.9 mm off, more than 2 mm."], "notes": []}
        action = found.action
        files = {"verification.json": json.dumps(content).encode()}
        session.add_result(action.kind, action.name, files, action.inputs, action.parameters)
        session.set_parameter("config.rate", 200.0)
    made.open(folder)
    sentence = wait_state(made, Step.VERIFY, StepState.FAILED)
    assert "9.9 mm" in sentence or "not passed" in sentence.lower()
    page = made.page(Step.VERIFY)
    made.wait(lambda: page.work.outcome is not None)
    assert (
        "not pass" in page.panel_result.verdict.text().lower()
        or "fail" in page.panel_result.verdict.text().lower()
    )
    page = made.page(Step.EXPORT)
    made.wait(lambda: page.view is not None)
    assert not page.zip.isEnabled()
    page.write(tmp_path / "out.zip")  # as if a button had been pressed a moment too soon
    made.idle()
    assert not (tmp_path / "out.zip").exists()
    made.wait_said("verif")
    assert not made.unexpected


def test_another_mesh_makes_stale_what_rests_on_the_one_before(made, sessions, tmp_path):
    folder = shutil.copytree(sessions / "verified", tmp_path / "s")
    bench = made.open(folder)
    wait_state(made, Step.VERIFY, StepState.DONE)
    bench.desk.do(lambda session: session.rezeroed("VB-1", "a cable was changed")).result(10)
    made.wait(lambda: status(made, Step.VERIFY).state in {StepState.STALE, StepState.LOCKED, StepState.READY})
    assert len(status(made, Step.VERIFY).sentence) > 20
    page = made.page(Step.EXPORT)
    made.wait(lambda: page.view is not None and not page.zip.isEnabled())
    bench.desk.do(lambda session: session.add_input(egg(tmp_path), "mesh")).result(10)
    made.idle()
    for step in Step:
        made.page(step)
        made.idle()
    assert made.alive()
    assert not made.unexpected
    close(made)
    assert not check(folder).problems


def test_without_anything_nothing_can_be_exported_and_each_page_says_why(made, tmp_path):
    made.new(tmp_path / "s")
    for step in (Step.GRAVITY, Step.REGIONS, Step.VERIFY, Step.EXPORT):
        made.page(step)
        made.idle()
        assert len(status(made, step).sentence) > 15
    page = made.window.pages.current
    assert not page.zip.isEnabled()
    assert len(page.standing.text()) > 15
    page.write(tmp_path / "out.zip")
    made.idle()
    assert not (tmp_path / "out.zip").exists()
    assert page.bar.words
    assert not made.unexpected


# ---- undone --------------------------------------------------------------------------------------


def plain(bench):
    """Return what a session amounts to: its settings, and which content is in use."""
    state = bench.desk.state
    settings = {key: value_in(state, key) for key in state.settings}
    inputs = {slot: each.content for slot, each in state.current_inputs.items()}
    results = {slot: each.file.sha256 for slot, each in state.current_results.items()}
    return settings, inputs, results


def use_devices(made):
    page = made.page(Step.DEVICES)
    page.serial.setText("another")
    click(made, page.use_button)


def tilt(made):
    made.page(Step.GRAVITY).panel.tilt.setValue(90)


def spread(made):
    page = made.page(Step.VERIFY)
    made.wait(lambda: page.work.tool is not None)
    page.panel_markers.count.setValue(4)
    click(made, page.panel_markers.spread)
    made.wait(lambda: len(page.work.markers) == 4)


def pick(made):
    page = made.page(Step.VERIFY)
    made.wait(lambda: page.work.tool is not None and page.panel_markers.pick.isEnabled())
    page.panel_markers.pick.setChecked(True)
    made.window.scene.picked.emit(Pick(0, np.array([0.01, 0.0, 0.15])))
    page.panel_markers.pick.setChecked(False)


def repeats(made):
    made.page(Step.VERIFY).panel_how.rows["repeats"].field.setValue(3)


def force(made):
    page = made.page(Step.EXPORT)
    made.wait(lambda: page.view is not None)
    page.settings.rows["max_force"].field.setValue(21.0)


def leave_out(made):
    page = made.page(Step.GRAVITY)
    made.wait(lambda: page.run.outcome is not None and page.run.phase is Phase.IDLE)
    page._leave_out(tuple(page.panel.table.rows[:1]), left_out=True)
    made.wait(lambda: page.run.phase is Phase.IDLE)


def same(now, then):
    """Tell whether a session amounts to the same: what was not set before stands for what is meant without it."""
    settings = all(now[0].get(key) == value for key, value in then[0].items())
    inputs = all(now[1].get(slot) == content for slot, content in then[1].items())
    return settings and inputs and now[2] == then[2]


# ---- closed while all of it runs -----------------------------------------------------------------


def test_closed_while_everything_runs(made, sessions, tmp_path):
    folder = shutil.copytree(sessions / "calibrated", tmp_path / "s")
    bench = made.open(folder)
    made.wait(lambda: made.window.bench.connected)
    page = made.page(Step.VERIFY)
    spread(made)
    made.idle()
    page.tabs.setCurrentIndex(3)
    click(made, page.bar.primary)
    made.wait(lambda: page.work.going_on)
    probe = made.page(Step.PROBE)
    probe.stages.take_housing()
    ended = threading.Event()

    def work(_progress, cancelled):
        while not cancelled():
            ended.wait(0.02)
        ended.set()

    bench.jobs.start("Working", work)
    for number in range(20):
        bench.do("Noting", lambda session, number=number: session.note(f"note {number}"))
    close(made)
    assert ended.is_set()
    assert not made.unexpected
    assert not check(folder).problems
    with Session.open(folder) as session:
        notes = [note.text for note in session.state.notes]
        assert [f"note {number}" for number in range(20)] == [
            each for each in notes if each.startswith("note ")
        ]
        names = [each.name for each in session.state.inputs]
        assert "verify-1.mcap" in names or any(
            "verify-1.mcap" in each and "not kept" in each for each in notes
        )
    assert not list((folder / "raw").glob("unfinished-*"))


def test_closed_twice_and_while_it_closes(made, tmp_path):
    made.new(tmp_path / "s")
    made.window.close()
    made.window.close()
    made.window.show_step(Step.PROBE)
    made.window.menus.undo.trigger()
    made.wait(lambda: not made.window.isVisible())
    assert not made.unexpected
    assert not made.window.pages._pages  # none was made that nobody would close
    with Session.open(tmp_path / "s"):
        pass


# ---- devices that are not there, are pulled out, or give nonsense: said in words, and gone on from ----


STILL = "still://?rpy=180,0,0"


def equipped(folder, sensor, poses=STILL):
    """Make a session that names devices."""
    with Session.create(folder) as session:
        session.set_parameter("devices.sensor", sensor)
        session.set_parameter("devices.poses", poses)
    return folder


def port_of(url):
    return int(url.partition("127.0.0.1:")[2].partition("?")[0].strip("/"))


def typed(page, address, poses="None"):
    page.sensor.kind.setCurrentIndex(page.sensor.kind.findText("Enter address"))
    page.poses.kind.setCurrentIndex(page.poses.kind.findText(poses))
    page.sensor.address.setText(address)


def test_a_cut_serial_line_while_weighing_keeps_what_was_recorded(made, tmp_path):
    folder = tmp_path / "s"
    with emulator("sri", "serial", rate=200.0) as sensor:
        made.open(equipped(folder, sensor.url))
        made.wait(lambda: made.window.bench.connected)
        page = made.page(Step.GRAVITY)
        click(made, page.primary)
        made.wait(lambda: page.run.phase is Phase.CAPTURING)
        before = made.window.bench.live.ring.count  # the line was read before the recording began
        made.wait(lambda: made.window.bench.live.ring.count > before + 150)
    made.wait_said("sensor", "resumes automatically")
    click(made, page.panel.stop)  # nobody has to wait for it
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
    assert not page.use_button.isEnabled()  # none is named yet
    page.sensor.recording.edit.setText(str(file))
    click(made, page.use_button)
    made.wait_said("Could not open", "r.mcap")
    assert "r.mcap" in page.sensor.problem
    assert Step.DEVICES in made.window.bench.failed
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
