"""What is wrong with a session, and that everything that rests on it says so in the same words."""

import os
import shutil

import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.why import (
    DISK,
    CheckState,
    FileWatch,
    SessionTrouble,
    files_behind,
    read_facts,
    statuses,
)
from contactbench.pipeline.steps import Step, StepState
from contactbench.pipeline.workbench.export import export, survey


@pytest.fixture
def session(sessions, tmp_path):
    with Session.open(shutil.copytree(sessions / "verified", tmp_path / "s")) as found:
        found.set_parameter("config.rate", 200.0)
        yield found


def stand(session, running=(), failed=None, connected=True, **trouble):
    facts = read_facts(session.folder, session.state)
    return statuses(
        session.state, session.stale(), running, connected, failed or {}, facts, SessionTrouble(**trouble)
    )


def broken(found):
    return {step for step, status in found.items() if status.broken}


def place_of(session, kind):
    return session.state.newest(kind).file.path


def test_a_sound_session_has_no_trouble(session):
    assert FileWatch(session.folder).look(session.state) == {}
    assert SessionTrouble().sentences == ()
    assert broken(stand(session)) == set()


@pytest.mark.parametrize(
    ("kind", "steps"),
    [
        ("calibration", {Step.GRAVITY, Step.VERIFY, Step.EXPORT}),
        ("probe", {Step.PROBE, Step.VERIFY, Step.EXPORT}),
        ("verification", {Step.VERIFY, Step.EXPORT}),
        ("report", {Step.EXPORT}),
    ],
)
@pytest.mark.parametrize("damage", ["missing", "changed"])
def test_all_that_rests_on_a_file_says_the_same(session, tmp_path, kind, steps, damage):
    watch, place = FileWatch(session.folder), place_of(session, kind)
    assert watch.look(session.state) == {}
    file = session.folder / place
    if damage == "missing":
        file.unlink()
    else:
        content = bytearray(file.read_bytes())
        content[len(content) // 2] ^= 1
        file.chmod(0o644)
        file.write_bytes(content)
    files = watch.look(session.state)
    (sentence,) = files.values()
    assert place in sentence
    found = stand(session, files=files)
    assert broken(found) == steps
    assert {found[step].sentence for step in steps} == {sentence}
    assert {found[step].state for step in steps} == {StepState.FAILED}
    view = survey(session, SessionTrouble(files=files))
    assert view.preview is None
    assert view.problem == sentence
    failed = {item.step for item in view.items if item.state is CheckState.FAILED}
    assert failed >= steps - {Step.EXPORT}
    assert {item.sentence for item in view.items if item.state is CheckState.FAILED} == {sentence}
    with pytest.raises(InputError, match=place):
        export(session, tmp_path / "out.zip", unverified=True)
    assert not (tmp_path / "out.zip").exists()


def test_never_verified_without_the_recording_behind_it(session):
    used = session.state.current_results["verification", "verification.json"].action.inputs["recording"]
    place = session.state.input_with(used).file.path
    assert place in {ref.path for ref in files_behind(session.state, session.state.newest("report"))}
    (session.folder / place).unlink()
    found = stand(session, files=FileWatch(session.folder).look(session.state))
    assert found[Step.VERIFY].state is StepState.FAILED
    assert "missing" in found[Step.VERIFY].sentence
    assert found[Step.GRAVITY].state is StepState.DONE


def test_only_what_was_touched_is_looked_at_again(session, monkeypatch):
    watch, read = FileWatch(session.folder), []
    assert watch.look(session.state) == {}
    monkeypatch.setattr(
        "contactbench.pipeline.session.why.file_problem", lambda _folder, ref: read.append(ref.path) or ""
    )
    watch.look(session.state)
    assert read == []
    place = place_of(session, "probe")
    os.utime(session.folder / place, ns=(1, 1))
    watch.look(session.state)
    assert read == [place]


def test_put_back_it_is_sound_again(session):
    watch, file = FileWatch(session.folder), session.folder / place_of(session, "probe")
    watch.look(session.state)
    content = file.read_bytes()
    file.unlink()
    assert watch.look(session.state)
    file.write_bytes(content)
    assert watch.look(session.state) == {}


def test_a_full_disk_stops_what_would_be_written_and_the_export(session):
    found = stand(session, running=[Step.GRAVITY], disk=DISK)
    assert broken(found) == {Step.GRAVITY, Step.REGIONS, Step.EXPORT}
    assert {found[step].sentence for step in broken(found)} == {DISK}
    assert found[Step.PROBE].state is StepState.DONE  # what is there is safe


def test_a_device_that_is_gone(session):
    said = "The sensor is disconnected: plug it in again."
    assert broken(stand(session, devices=said)) == {Step.DEVICES, Step.EXPORT}
    running = stand(session, running=[Step.VERIFY], devices=said)
    assert broken(running) == {Step.DEVICES, Step.VERIFY, Step.EXPORT}
    view = survey(session, SessionTrouble(devices=said))
    assert view.items[0].state is CheckState.FAILED
    assert view.items[0].sentence == said
    assert view.preview is not None  # the results stand, whatever is plugged out


def test_a_damaged_file_is_said_before_a_full_disk(session):
    (session.folder / place_of(session, "probe")).unlink()
    files = FileWatch(session.folder).look(session.state)
    found = stand(session, files=files, disk=DISK, devices="gone")
    assert "missing" in found[Step.EXPORT].sentence
    assert found[Step.REGIONS].sentence == DISK


def test_what_fails_while_it_runs_is_red(session):
    found = stand(session, running=[Step.GRAVITY], failed={Step.GRAVITY: "The disk is full."})
    assert found[Step.GRAVITY].state is StepState.FAILED
    assert found[Step.GRAVITY].broken
