"""Results computed again from raw inputs, and compared with what the commands write."""

import dataclasses
import json
from types import SimpleNamespace

import numpy as np
import pytest
from terminal import invoke
from weighing_files import weighed, write_euler

from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.recompute import RECOMPUTE, ReplayOutcome, _moved, compute, replay


@pytest.fixture(scope="module")
def poses(tmp_path_factory):
    return write_euler(tmp_path_factory.mktemp("weighed") / "poses.csv", weighed())


@pytest.fixture
def mesh(tmp_path):
    import trimesh

    file = tmp_path / "ball.stl"
    file.write_bytes(trimesh.creation.icosphere(2, 30.0).export(file_type="stl"))
    return file


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s", by="a") as session:
        yield session


def calibrated(session, poses, **parameters):
    sha256 = session.add_input(poses, "poses").action.file.sha256
    return compute(
        session, "calibration", "calibration.json", {"poses": sha256}, {"euler": "xyz", **parameters}
    )


def test_a_calibration_has_the_bytes_of_the_command(session, poses, tmp_path, monkeypatch):
    record = calibrated(session, poses, tip=[0, 0, 120], noise_force=0.05, noise_torque=0.002)
    created = np.datetime64(record.action.created[:-1]).astype("datetime64[s]").astype(int)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", str(created))
    options = ("--euler", "xyz", "--tip", "0,0,120", "--noise-force", 0.05, "--noise-torque", 0.002)
    assert invoke("calibrate", "fit", poses, *options, "--out", tmp_path / "c.json").exit_code == 0
    stored = session.folder / record.action.files["calibration.json"].path
    assert stored.read_bytes() == (tmp_path / "c.json").read_bytes()
    assert [each.outcome for each in replay(session)] == [ReplayOutcome.SAME]


def test_a_probe_of_the_command_is_made_again_to_the_byte(session, mesh, tmp_path):
    out = tmp_path / "probe.ply"
    options = ("--facets", 100, "--engine", "fast-simplification", "--units", "mm")
    result = invoke("probe", "prepare", mesh, *options, "--place", "0,0,40,0,0,90", "--out", out)
    assert result.exit_code == 0, result.stderr
    inputs = {"mesh": session.add_input(mesh, "mesh").action.file.sha256}
    parameters = {
        "facets": 100,
        "engine": "fast-simplification",
        "mount": [0, 0, 40, 0, 0, 90],
        "units": "mm",
    }
    files = {file.name: file.read_bytes() for file in (out, out.with_suffix(".json"))}
    session.add_result("probe", "probe.ply", files, inputs, parameters)
    assert [(each.outcome, each.sentence) for each in replay(session)] == [
        (ReplayOutcome.SAME, "probe probe.ply: identical bytes.")
    ]


def test_what_differs_fails_or_is_unknown_is_said(session, poses):
    good = calibrated(session, poses).action
    made = json.loads((session.folder / good.files["calibration.json"].path).read_bytes())
    made["mass_kg"] *= 2
    changed = {"calibration.json": json.dumps(made).encode()}
    session.add_result(
        "calibration", "calibration.json", changed, good.inputs, good.parameters, created=good.created
    )
    wrong = {**good.parameters, "euler": "abc"}
    session.add_result("calibration", "calibration.json", changed, good.inputs, wrong, created=good.created)
    session.add_result("photo", "p.png", {"p.png": b""}, {}, {})
    found = replay(session)
    assert [each.outcome for each in found] == [
        ReplayOutcome.SAME,
        ReplayOutcome.DIFFERENT,
        ReplayOutcome.FAILED,
        ReplayOutcome.UNKNOWN,
    ]
    assert "different bytes in calibration.json" in found[1].sentence
    assert "Euler order" in found[2].sentence
    assert len(session.records) == 6


def test_it_is_said_how_far_the_contacts_of_a_verification_moved(tmp_path):
    told = [{"point_mm": [1.0, 2.0, 3.0]}, {"point_mm": None}, {"point_mm": [0.0, 0.0, 0.0]}]
    (tmp_path / "v.json").write_text(json.dumps({"touches": told}))
    action = SimpleNamespace(name="v.json", files={"v.json": SimpleNamespace(path="v.json")})
    for touches, words in (
        ([told[0], told[1], {"point_mm": [0.0, 0.3, 0.4]}], " Contacts moved by up to 0.5 mm."),
        (told[:2], " It finds 2 touches, and found 3."),
        (None, ""),
    ):
        assert _moved(tmp_path, action, {"v.json": json.dumps({"touches": touches}).encode()}) == words


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"noise_force": 1.0}, "neither"),
        ({"colour": "red"}, "parameter colour"),
        ({"robot": "elfin3"}, "contradict"),
        ({"contact_force": "strong"}, "parameter contact_force"),
        ({"tip": [1e308, 0, 0]}, "parameter tip"),
        ({"mount": [float("nan"), 0, 0]}, "parameter mount"),
    ],
)
def test_wrong_parameters_are_named_and_nothing_is_recorded(session, poses, parameters, said):
    with pytest.raises(SessionError, match=said):
        calibrated(session, poses, **parameters)
    assert len(session.records) == 2


def test_wrong_kinds_names_and_inputs(session, poses):
    sha256 = session.add_input(poses, "poses").action.file.sha256
    for kind, name, inputs in (
        ("photo", "p.png", {}),
        ("calibration", "../c.json", {"poses": sha256}),
        ("calibration", "c.txt", {"poses": sha256}),
        ("calibration", "c.json", {}),
        ("calibration", "c.json", {"poses": "0" * 64}),
    ):
        with pytest.raises(SessionError):
            compute(session, kind, name, inputs, {"euler": "xyz"})


def test_an_input_that_was_added_again_under_another_name_changes_no_replay(session, poses):
    calibrated(session, poses)
    session.add_input(poses, "poses", name="renamed.csv")
    assert [each.outcome for each in replay(session)] == [ReplayOutcome.SAME]


def test_an_input_that_changes_while_it_is_read_is_refused(session, poses, monkeypatch):
    done = RECOMPUTE["calibration"]

    def meddled(files, parameters, created):
        found = done.make(files, parameters, created)
        files["poses"].path.write_bytes(b"other")
        return found

    monkeypatch.setitem(RECOMPUTE, "calibration", dataclasses.replace(done, make=meddled))
    with pytest.raises(SessionError, match="an input changed while it was read"):
        calibrated(session, poses)
    assert not session.state.results


def test_errors_name_the_file_as_its_user_does(session, tmp_path):
    (tmp_path / "empty.csv").write_bytes(b"nothing\n")
    with pytest.raises(SessionError) as caught:
        calibrated(session, tmp_path / "empty.csv")
    assert str(caught.value).startswith("empty.csv: ")
    assert str(session.folder) not in str(caught.value)
