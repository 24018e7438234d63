"""An export from a session: the checklist, the preview, and the same bytes as the command's."""

import json
import shutil
from pathlib import Path

import pytest
from terminal import invoke

from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig, UnverifiedError
from contactbench.pipeline.config.runtime.differ import ConfigDifference, Differences
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.why import RESULTS, checklist, results_of
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.export import PLACE, SHA256, export, survey, told


@pytest.fixture
def verified(sessions, tmp_path):
    return shutil.copytree(sessions / "verified", tmp_path / "s")


@pytest.fixture
def bare(sessions, tmp_path):
    return shutil.copytree(sessions / "calibrated", tmp_path / "s")


def command(*arguments):
    return invoke("bundle", "export", *arguments)


def states(session):
    items = checklist(session.folder, session.state, session.stale())
    return {item.name: item.state.value for item in items}


def test_the_window_and_the_command_write_the_same_bytes(verified, tmp_path):
    with Session.open(verified, by="ada") as session:
        session.set_parameter("config.sensor", "M8128")
        session.set_parameter("config.max_force", 12.5)
        session.set_parameter("config.cutoff", 20)
        found = export(session, tmp_path / "window.zip")
    assert command(verified, "--out", tmp_path / "command.zip").exit_code == 0
    assert (tmp_path / "window.zip").read_bytes() == (tmp_path / "command.zip").read_bytes()
    with Session.open(verified, by="bob") as session:  # whoever does it, whenever, and into a folder, too
        assert export(session, tmp_path / "folder").sha256 == found.sha256
    model = RuntimeConfig.load(tmp_path / "folder").model
    assert (model.sensor.model, model.sensor.serial) == ("M8128", "VB-1")
    assert model.limits.max_force_N == 12.5
    assert model.filters.location.cutoff_Hz == 20
    assert model.filters.wrench is not None
    assert model.provenance.operator == "ada"
    with Session.open(verified, write=False) as session:
        assert model.provenance.created[:16] == session.state.current_results["report", "report.html"].at[:16]


def test_the_sensors_name_reaches_ros2_yaml_from_the_session_and_from_the_command(verified, tmp_path):
    given, stored = tmp_path / "given", tmp_path / "stored"
    assert command(verified, "--sensor-name", "wrist", "--out", given).exit_code == 0
    with Session.open(verified) as session:
        session.set_parameter("config.sensor_name", "wrist")
        export(session, stored)
    text = (given / "ros2.yaml").read_text("ascii")
    assert 'sensor_name: "wrist"' in text
    assert (stored / "ros2.yaml").read_text("ascii") == text


def test_a_result_of_this_sitting_is_listed_as_one_read_from_the_journal(bare, tmp_path):
    with Session.open(bare, by="ada") as session:
        probe = session.state.current_results["probe", "probe.ply"]
        files = {
            name: (bare / file.path).read_bytes()
            for name, file in sorted(probe.action.files.items(), reverse=True)
        }
        session.set_parameter("config.rate", 200)
        session.add_result("probe", "probe.ply", files, {}, {"again": 1})
        export(session, tmp_path / "window.zip", unverified=True)
    command(bare, "--unverified", "--out", tmp_path / "command.zip")
    assert (tmp_path / "window.zip").read_bytes() == (tmp_path / "command.zip").read_bytes()


def test_what_is_given_to_the_command_counts_more_than_the_session(verified, tmp_path):
    with Session.open(verified, by="ada") as session:
        session.set_parameter("config.sensor", "M8128")
        session.set_parameter("config.no_filter", True)
    made = command(verified, "--model", "other", "--filter", "--out", tmp_path / "b")
    assert made.exit_code == 0, made.stderr
    model = RuntimeConfig.load(tmp_path / "b").model
    assert model.sensor.model == "other"
    assert model.filters.wrench is not None
    assert "scatter" in command(verified, "--out", tmp_path / "c").output  # more than was verified
    assert command(verified, "--unverified", "--out", tmp_path / "b").exit_code == 0
    assert RuntimeConfig.load(tmp_path / "b").model.filters.wrench is None


def test_a_setting_that_does_not_do_is_named(verified, tmp_path):
    with Session.open(verified, by="ada") as session:
        session.set_parameter("config.max_force", -1)
        view = survey(session)
    assert view.preview is None
    assert "config.max_force" in view.problem
    refused = command(verified, "--out", tmp_path / "b")
    assert refused.exit_code == 2
    assert "config.max_force" in " ".join(refused.output.split())


def test_all_that_is_done_is_said_to_be_done(verified):
    with Session.open(verified, by="ada") as session:
        found = states(session)
        assert (found.pop("Known weight"), found.pop("Known touch")) == ("missing", "missing")
        assert set(found.values()) == {"done"}
        view = survey(session)
        assert view.preview.reasons == ()
        assert view.preview.changes is None
        assert {name for name, _ in view.preview.files} >= {"contactbench.json", "probe.ply", "report.html"}
        assert ("Readings", "200 readings per second") in view.preview.figures
        session.rezeroed("VB-1", "bumped")
        assert states(session)["Verification"] == "stale"
        assert survey(session).preview.reasons


def test_one_check_is_enough_and_one_that_failed_is_said(verified):
    with Session.open(verified, by="ada") as session:
        calibration = next(
            each for each in session.state.current_results.values() if each.action.kind == "calibration"
        )

        def done(kind, outcome):
            data = json.dumps({"outcome": outcome, "sentence": f"It {outcome}."}).encode()
            given = {"calibration": calibration.content}
            session.add_result(kind, "c.json", {"c.json": data}, given, {"outcome": outcome})
            items = {item.name: item for item in checklist(session.folder, session.state, session.stale())}
            return items["Known weight"], items["Known touch"]

        weight, touch = done("known_weight", "undecided")
        assert (weight.state.value, touch.state.value) == ("missing", "missing")
        assert weight.sentence == "It undecided."
        assert "Press a known point" in touch.sentence
        weight, touch = done("known_touch", "passed")
        assert (weight.state.value, touch.state.value) == ("left out", "done")
        before = results_of(session.state)
        weight, touch = done("known_weight", "failed")
        assert (weight.state.value, weight.sentence, weight.step) == ("failed", "It failed.", Step.GRAVITY)
        assert touch.state.value == "done"
        assert results_of(session.state) != before


def test_what_was_rejected_or_is_missing_is_said(bare, tmp_path):
    with Session.open(bare, by="ada") as session:
        found = states(session)
        assert (found["Verification"], found["Report"], found["Probe"]) == ("missing", "missing", "done")
        session.mark("probe", "probe.ply", "rejected", "bent")
        items = checklist(session.folder, session.state, session.stale())
        (probe,) = (item for item in items if item.name == "Probe")
        assert probe.state.value == "failed"
        assert "bent" in probe.sentence
        assert probe.step is Step.PROBE
    with Session.create(tmp_path / "empty") as session:
        assert set(states(session).values()) == {"missing", "left out"}
        view = survey(session)
        assert view.preview is None
        assert "no calibration" in view.problem


def test_an_unverified_bundle_is_written_only_when_somebody_says_so(bare, tmp_path):
    with Session.open(bare, by="ada") as session:
        session.set_parameter("config.rate", 200)
        with pytest.raises(UnverifiedError):
            export(session, tmp_path / "b.zip")
        assert not (tmp_path / "b.zip").exists()
        assert PLACE not in session.state.settings
        found = export(session, tmp_path / "b.zip", unverified=True)
        assert not found.verified
        assert "NOT verified" in found.sentence
        assert "NOT verified" in session.state.notes[-1].text


def test_the_session_knows_what_was_exported_and_what_differs_since(verified, tmp_path):
    with Session.open(verified, by="ada") as session:
        found = export(session, tmp_path / "b.zip")
        settings = session.state.settings
        assert (settings[SHA256].value, settings[PLACE].value) == (found.sha256, str(tmp_path / "b.zip"))
        assert settings[RESULTS].value == dict(results_of(session.state))
        view = survey(session)
        assert view.preview.sha256 == found.sha256
        assert "Identical" in view.preview.changes[0]
        session.set_parameter("config.max_force", 12.0)
        changes = survey(session).preview.changes
        assert changes == ("limits.max_force_N: 30 → 12 (the limits of the robot).",)
        (tmp_path / "b.zip").unlink()
        assert survey(session).preview.changes is None


def test_what_stands_at_the_place_stays_when_the_export_cannot_be(verified, tmp_path):
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "mine.txt").write_text("x", encoding="utf-8")
    with Session.open(verified, by="ada") as session:
        with pytest.raises(ConfigError):
            export(session, tmp_path / "b")
        assert PLACE not in session.state.settings
    assert [each.name for each in Path(tmp_path / "b").iterdir()] == ["mine.txt"]


def test_differences_are_told_in_few_words():
    fields = tuple(ConfigDifference(f"limits.f{n}", 0.123456, [1.0, 2.0], "") for n in range(15))
    said = told(Differences(fields, (), {"facets": [10, 20], "hausdorff_mm": 0.5, "rms_mm": 0.1}))
    assert said[0] == "limits.f0: 0.1235 → [1, 2]."
    assert "3 more" in said[12]
    assert "0.5 mm apart" in said[-1]
    only = (ConfigDifference("provenance.created", "a", "b", ""),)
    assert "Only origin" in told(Differences(only, (), None))[0]
