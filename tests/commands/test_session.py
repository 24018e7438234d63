"""The ``session`` commands, as a technician types them."""

import json

import pytest
from typer.testing import CliRunner
from weighing_files import weighed, write_euler

from contactbench.pipeline.cli import app
from contactbench.pipeline.commands.session import session_app
from contactbench.pipeline.recording import RecordingInfo, RecordingWriter
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.recompute import RECOMPUTE, settings_of


def invoke(*arguments):
    return CliRunner().invoke(session_app, list(map(str, arguments)))


def facts(*arguments, code=0):
    result = invoke(*arguments, "--json")
    assert result.exit_code == code, result.output
    return json.loads(result.stdout)


@pytest.fixture
def folder(tmp_path):
    assert invoke("new", tmp_path / "s").exit_code == 0
    return tmp_path / "s"


@pytest.fixture(scope="module")
def poses(tmp_path_factory):
    return write_euler(tmp_path_factory.mktemp("weighed") / "poses.csv", weighed())


@pytest.fixture
def weighed_session(folder, poses):
    facts("add", folder, poses, "--kind", "poses", "--serial", "42")
    facts("compute", folder, "calibration", "c.json", "--set", "euler=xyz", "--set", "contact_force=8")
    return folder


def test_from_poses_to_a_calibration_that_is_the_same_again(weighed_session):
    found = facts("info", weighed_session)
    assert found["records"] == 3
    assert found["inputs"][0]["sensor"] == "42"
    assert [(each["kind"], each["stale"]) for each in found["results"]] == [("calibration", [])]
    assert facts("replay", weighed_session)["same"] == 1
    assert facts("verify", weighed_session)["sound"] is True


def test_other_poses_make_it_stale(weighed_session, tmp_path):
    (tmp_path / "new").mkdir()
    file = write_euler(tmp_path / "new" / "poses.csv", weighed(seed=5))
    assert facts("add", weighed_session, file, "--kind", "poses")["stale"] == ["calibration c.json"]
    result = invoke("info", weighed_session)
    assert "STALE" in result.output
    assert "was replaced by poses.csv" in result.output


def test_a_result_that_cannot_be_computed_again_ends_with_1(weighed_session):
    with Session.open(weighed_session) as session:
        made = session.state.results[0].action
        session.add_result(
            "calibration", "c.json", {"c.json": b"{}"}, made.inputs, made.parameters, created=made.created
        )
    assert [each["outcome"] for each in facts("replay", weighed_session, code=1)["results"]] == [
        "same",
        "different",
    ]


def test_verify_ends_with_1_and_repair_mends_a_damaged_end(folder):
    with Session.open(folder) as session:
        session.note("last")
    data = bytearray((folder / "journal").read_bytes())
    data[-2] ^= 4
    (folder / "journal").write_bytes(data)
    assert "record 2 at byte" in facts("verify", folder, code=1)["problems"][0]
    assert (folder / facts("repair", folder)["kept_as"]).read_bytes() == data
    assert facts("verify", folder)["records"] == 1


@pytest.fixture
def damaged(weighed_session):
    """A session of which the record of its poses is damaged; a calibration and a note follow it."""
    with Session.open(weighed_session) as session:
        session.note("after")
    data = bytearray((weighed_session / "journal").read_bytes())
    at = data.index(b"input_added")
    data[at - 40 : at] = b"#" * 40
    (weighed_session / "journal").write_bytes(data)
    return weighed_session


def test_salvage_ends_with_1_when_something_is_lost_and_with_0_when_not(damaged, tmp_path):
    before = (damaged / "journal").read_bytes()
    done = facts("salvage", damaged, "--out", tmp_path / "n", code=1)
    assert done["out"] == str(tmp_path / "n")
    assert done["records"] == 3
    assert not done["whole"]
    assert list(done["stale"]) == ["calibration c.json"]
    assert "is lost after record 1" in " ".join(done["found"])
    assert done["unclaimed"][0].endswith("poses.csv")
    assert (damaged / "journal").read_bytes() == before
    found = facts("info", tmp_path / "n")
    assert found["damage"] == ""
    assert "in no earlier record" in found["results"][0]["stale"][0]
    assert facts("verify", tmp_path / "n")["sound"] is True
    again = facts("salvage", tmp_path / "n")
    assert (again["whole"], again["out"]) == (True, str(tmp_path / "n-salvaged"))
    words = invoke("salvage", damaged, "--out", tmp_path / "m")
    assert words.exit_code == 1
    assert "not everything could be saved" in words.output
    assert words.stdout == ""


def test_a_damaged_session_is_told_of_with_1_and_written_by_nobody(damaged):
    before = {str(file): file.read_bytes() for file in damaged.rglob("*") if file.is_file()}
    found = facts("info", damaged, code=1)
    assert "is damaged" in found["damage"]
    assert found["results"][0]["stale"]
    for command in (("note", damaged, "x"), ("rezero", damaged, "--serial", "1", "--reason", "x")):
        assert "session salvage" in str(invoke(*command).exception)
    assert {str(file): file.read_bytes() for file in damaged.rglob("*") if file.is_file()} == before


@pytest.mark.parametrize("arguments", [("salvage", "none"), ("info", "none")])
def test_an_error_is_one_json_object_and_2(tmp_path, arguments):
    result = CliRunner().invoke(app, ["session", arguments[0], str(tmp_path / arguments[1]), "--json"])
    assert result.exit_code == 2
    assert "is not a session" in json.loads(result.stdout)["error"]


def test_every_command_that_writes_says_so_where_nothing_can_be_written(weighed_session, poses, monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.session.lock.writable", lambda _path: False)
    before = {str(file): file.read_bytes() for file in weighed_session.rglob("*") if file.is_file()}
    for command in (
        ("add", weighed_session, poses, "--kind", "poses"),
        ("compute", weighed_session, "calibration", "c.json"),
        ("note", weighed_session, "x"),
        ("set", weighed_session, "calibration.tip=null"),
        ("rezero", weighed_session, "--serial", "1", "--reason", "x"),
        ("repair", weighed_session),
        ("record", weighed_session, "--source", "virtual://bench", "--seconds", "1"),
    ):
        result = CliRunner().invoke(app, ["session", *map(str, command), "--json"])
        assert result.exit_code == 2, command
        assert "not writable: open the session read-only" in json.loads(result.stdout)["error"], command
    for command in ("info", "verify", "replay"):
        facts(command, weighed_session)
    assert {str(file): file.read_bytes() for file in weighed_session.rglob("*") if file.is_file()} == before


def test_the_help_names_every_kind_that_can_be_computed():
    words = " ".join(invoke("compute", "--help").stdout.split())
    for kind in RECOMPUTE:
        assert f"{kind}, from" in words, kind


def test_there_and_back_as_an_archive(weighed_session, tmp_path):
    assert facts("export-archive", weighed_session, "--out", tmp_path / "s.zip")["files"] == 3
    assert invoke("import-archive", tmp_path / "s.zip", "--out", tmp_path / "back").exit_code == 0
    assert facts("info", tmp_path / "back") == facts("info", weighed_session)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("compute", "{}", "photo", "p.png"), "cannot be computed"),
        (("compute", "{}", "probe", "p.ply"), "add it with --kind mesh"),
        (("add", "{}", "none.csv", "--kind", "poses"), "cannot be read"),
        (("add", "{}", __file__, "--kind", "Not a word"), "kind"),
        (("new", "{}"), "already a session"),
    ],
)
def test_what_cannot_be_is_said(folder, arguments, said):
    result = invoke(*(each.format(folder) for each in arguments))
    assert isinstance(result.exception, SessionError)
    assert said in str(result.exception)


def test_an_input_may_be_called_otherwise(folder, poses):
    facts("add", folder, poses, "--kind", "poses", "--name", "first.csv")
    assert facts("info", folder)["inputs"][0]["name"] == "first.csv"
    result = invoke("add", folder, poses, "--kind", "poses", "--name", "12:30.csv")
    assert "no control characters and none of" in str(result.exception)


def test_a_recording_brings_the_time_of_its_start(folder, tmp_path):
    with RecordingWriter(tmp_path / "a.mcap", RecordingInfo(1_700_000_000_000_000_000, 0.0)) as writer:
        writer.event("begun", {}, 0.0)
    facts("add", folder, tmp_path / "a.mcap", "--kind", "recording")
    assert facts("info", folder)["inputs"][0]["about"] == {"started": "2023-11-14T22:13:20+00:00"}


def test_repair_ends_with_1_when_something_stays(folder):
    (folder / "raw" / "unfinished-a").mkdir()
    assert "was left in place" in facts("repair", folder, code=1)["left"][0]


def test_a_setting_needs_a_value(folder):
    assert invoke("compute", folder, "calibration", "c.json", "--set", "euler").exit_code == 2


def test_what_was_set_is_what_a_result_is_computed_with(tmp_path):
    folder = tmp_path / "s"
    invoke("new", folder)
    done = invoke(
        "set", folder, "calibration.tip=[0,0,120]", "calibration.euler=xyz", "devices.serial=A-1", "--json"
    )
    assert json.loads(done.stdout) == {"records": [2, 3, 4], "stale": []}
    with Session.open(folder, write=False) as session:
        assert settings_of(session.state, "calibration") == {"tip": [0, 0, 120], "euler": "xyz"}
        assert session.state.settings["devices.serial"].value == "A-1"
    assert invoke("set", folder, "calibration.euler=null").exit_code == 0
    with Session.open(folder, write=False) as session:
        assert settings_of(session.state, "calibration") == {"tip": [0, 0, 120]}
    assert invoke("set", folder, "euler").exit_code == 2
    assert isinstance(invoke("set", folder, "euler=xyz").exception, SessionError)
    assert "calibration.euler" in str(invoke("set", folder, "calibration.eulr=xyz").exception)
