"""Folders that somebody else had a hand in: links, pipes, foreign locks, journals made by hand."""

from __future__ import annotations

import errno
import hashlib
import json
import os
from pathlib import Path

import pytest

from contactbench.pipeline.session import Session, SessionError, SessionLockedError, journal
from contactbench.pipeline.session import lock as locks
from contactbench.pipeline.session.archive import import_archive
from contactbench.pipeline.session.check import check, repair

posix = pytest.mark.skipif(os.name == "nt", reason="pipes and links of POSIX")


# ---- the lock ----------------------------------------------------------------------------------


def test_a_lock_of_another_program_is_left_alone(tmp_path):
    for name, more in (("full", True), ("alone", False)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "lock").write_text("my precious", encoding="utf-8")
        if more:
            (tmp_path / name / "other").write_text("x", encoding="utf-8")
        for attempt in (Session.create, Session.open, repair):
            with pytest.raises(SessionError):
                attempt(tmp_path / name)
        assert (tmp_path / name / "lock").read_text(encoding="utf-8") == "my precious"


def test_no_lock_is_left_in_a_folder_that_is_no_session(tmp_path):
    (tmp_path / "other").write_text("x", encoding="utf-8")
    for attempt in (Session.create, Session.open, repair):
        with pytest.raises(SessionError):
            attempt(tmp_path)
    assert [each.name for each in tmp_path.iterdir()] == ["other"]


@posix
def test_a_lock_that_is_a_link_or_a_pipe_is_refused(folder, tmp_path):
    (tmp_path / "target").write_text("precious", encoding="utf-8")
    (folder / "lock").unlink()
    (folder / "lock").symlink_to("../target")
    with pytest.raises(SessionError, match="cannot be locked"):
        Session.open(folder)
    assert (tmp_path / "target").read_text(encoding="utf-8") == "precious"
    (folder / "lock").unlink()
    os.mkfifo(folder / "lock")
    with pytest.raises(SessionError, match="not a regular file"):
        Session.open(folder)


def test_a_file_system_without_locks_is_not_called_another_process(folder, monkeypatch):
    def take(_):
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(locks, "_take", take)
    with pytest.raises(SessionError, match="no locks available") as caught:
        Session.open(folder)
    assert not isinstance(caught.value, SessionLockedError)


@posix
def test_two_writers_after_the_lock_was_removed_do_not_mix(folder):
    first = Session.open(folder)
    (folder / "lock").unlink()
    with Session.open(folder) as second:
        second.note("two")
        with pytest.raises(SessionError, match="lock was removed"):
            first.note("one")
    first.close()
    assert check(folder).sound


def test_a_journal_that_somebody_else_wrote_takes_no_record(folder):
    with Session.open(folder) as session:
        with (folder / "journal").open("ab") as journal:
            journal.write(b"x")
        data = (folder / "journal").read_bytes()
        for _ in range(2):
            with pytest.raises(SessionError, match="reload the session"):
                session.note("mine")
    assert (folder / "journal").read_bytes() == data


# ---- links and pipes ---------------------------------------------------------------------------


@posix
@pytest.mark.parametrize("name", ["raw", "meshes", "results"])
def test_a_folder_that_is_a_link_is_refused(folder, tmp_path, name):
    (folder / name).rmdir()
    (tmp_path / "elsewhere").mkdir()
    (folder / name).symlink_to(tmp_path / "elsewhere")
    for write in (True, False):
        with pytest.raises(SessionError, match="not a folder"):
            Session.open(folder, write=write)
    assert "not a folder" in check(folder).problems[0]


@posix
def test_pipes_are_refused_not_waited_for(folder, tmp_path):
    os.mkfifo(tmp_path / "pipe.zip")
    with pytest.raises(SessionError, match="not a regular file"):
        import_archive(tmp_path / "pipe.zip", tmp_path / "out")
    (folder / "journal").unlink()
    os.mkfifo(folder / "journal")
    for attempt in (Session.open, check, repair):
        with pytest.raises(SessionError, match="not a regular file"):
            attempt(folder)


# ---- journals made by hand ---------------------------------------------------------------------


def test_a_result_of_what_comes_later_is_stale(folder):
    data = (folder / "journal").read_bytes()
    payloads = [journal.scan(data).frames[0].payload]
    for n in range(3000):
        content = str(n).encode()
        sha256, following = (hashlib.sha256(str(each).encode()).hexdigest() for each in (n, n + 1))
        ref = {"path": f"results/{sha256[:12]}-r", "sha256": sha256, "size": len(content)}
        action = {"type": "result_added", "kind": "k", "name": f"r{n}", "files": {f"r{n}": ref}}
        action |= {"inputs": {"x": following}, "parameters": {}, "created": None}
        at = "2026-01-01T00:00:00+00:00"
        payloads.append(
            json.dumps({"at": at, "by": "x", "tool": "t", "sensor": None, "action": action}).encode()
        )
    (folder / "journal").write_bytes(journal.encode_all(payloads))
    with Session.open(folder, write=False) as session:
        stale = session.stale()
    assert len(stale) == 3000
    assert all("in no earlier record" in reasons[0] for reasons in stale.values())
    assert any(
        "3000 results were computed from inputs that no earlier record" in note
        for note in check(folder).notes
    )


# ---- words -------------------------------------------------------------------------------------


def test_names_and_kinds_are_refused_in_words(folder, tmp_path):
    (tmp_path / "a.csv").write_bytes(b"1")
    with Session.open(folder) as session:
        with pytest.raises(SessionError, match="none of / ") as caught:
            session.add_input(tmp_path / "a.csv", "poses", name="12:30.csv")
        assert "pattern" not in str(caught.value)
        with pytest.raises(SessionError, match="must begin with a small letter"):
            session.add_input(tmp_path / "a.csv", "Poses")
        with pytest.raises(SessionError) as caught:
            session.add_input(Path(tmp_path), "poses")
        assert str(caught.value).count("check the path") == 0
