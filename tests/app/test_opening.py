"""Sessions are opened from what a file manager hands over."""

import pytest
from typer.testing import CliRunner

from contactbench.app import application, commands
from contactbench.app.cli import app
from contactbench.app.opening import unpacked
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.archive import export_archive


@pytest.fixture
def archive(tmp_path):
    folder = tmp_path / "bench-1"
    session = Session.create(folder)
    session.set_parameter("devices.sensor", "virtual://bench?probe=linear")
    session.close()
    export_archive(folder, tmp_path / "bench-1.contactbench")
    return tmp_path / "bench-1.contactbench"


def test_an_archive_becomes_a_session_of_its_own(archive, tmp_path):
    one, other = (unpacked(archive, tmp_path / "sessions") for _ in range(2))
    try:
        assert one.desk.folder.parent == tmp_path / "sessions"
        assert one.desk.folder.name.startswith("bench-1 ")
        assert one.desk.folder != other.desk.folder
        with Session.open(one.desk.folder, write=False) as session:
            assert session.state.settings["devices.sensor"].value == "virtual://bench?probe=linear"
    finally:
        one.desk.close()
        other.desk.close()


def test_what_is_no_archive_leaves_nothing(tmp_path):
    (tmp_path / "a.contactbench").write_text("no zip", "utf-8")
    with pytest.raises(SessionError, match=r"a\.contactbench"):
        unpacked(tmp_path / "a.contactbench", tmp_path / "sessions")
    assert list((tmp_path / "sessions").iterdir()) == []


def test_the_window_is_given_what_the_command_line_names(archive, monkeypatch):
    given = []
    monkeypatch.setattr(commands, "check_screen", lambda: None)
    monkeypatch.setattr(application, "run", lambda session, **_: given.append(session) or 0)
    assert CliRunner().invoke(app, ["gui", str(archive)]).exit_code == 0
    assert CliRunner().invoke(app, ["gui", "--session", "a"]).exit_code == 0
    assert [str(each) for each in given] == [str(archive), "a"]
    assert CliRunner().invoke(app, ["gui", str(archive), "--session", "a"]).exit_code == 2
