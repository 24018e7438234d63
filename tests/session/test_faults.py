"""A disk that fails at each write, fsync, rename and truncation: what was acknowledged stays, nothing is half there."""

import errno
import os

import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.check import check, repair

CALLS = ("write", "fsync", "replace", "link", "ftruncate")


class Failing:
    """The n-th of the calls fails; a write that fails may have written a part."""

    def __init__(self, monkeypatch, at, code, forever):
        self.count, self.at, self.code, self.forever = 0, at, code, forever
        for name in CALLS:
            monkeypatch.setattr(os, name, self.wrap(name, getattr(os, name)))

    def wrap(self, name, real):
        def call(*arguments, **named):
            self.count += 1
            if self.count == self.at or (self.forever and self.count > self.at):
                if name == "write":
                    real(arguments[0], bytes(arguments[1])[: len(arguments[1]) // 2])
                raise OSError(self.code, os.strerror(self.code))
            return real(*arguments, **named)

        return call


def work(folder, acknowledged):
    with Session.create(folder, by="a") as session:
        acknowledged.append(session.records[0].hash)
        acknowledged.append(session.note("n" * 100).hash)
        acknowledged.append(session.add_input(b"solid" * 1000 + b"end", "mesh", name="m.stl").hash)
        mesh = session.state.mesh.file.sha256
        acknowledged.append(session.add_result("test", "r", {"r": b"1", "s": b"2"}, {"mesh": mesh}, {}).hash)
    with Session.open(folder, by="a") as session:
        acknowledged.append(session.rezeroed("42").hash)
        made_here = folder / "raw" / "unfinished-a.bin"
        made_here.write_bytes(b"samples" * 100)
        about = {"samples": 100}
        acknowledged.append(session.adopt(made_here, "test", name="a.bin", sensor="42", about=about).hash)


def calls_needed(tmp_path):
    with pytest.MonkeyPatch.context() as patch:
        counter = Failing(patch, at=-1, code=0, forever=False)
        work(tmp_path / "dry", [])
        return counter.count


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO])
@pytest.mark.parametrize("forever", [False, True])
def test_each_call_may_fail(tmp_path, code, forever):
    needed = calls_needed(tmp_path)
    assert needed > 30
    for at in range(1, needed + 1):
        folder, acknowledged = tmp_path / f"{at}", []
        with pytest.MonkeyPatch.context() as patch:
            Failing(patch, at, code, forever)
            said = ""
            try:
                work(folder, acknowledged)
            except InputError as error:
                said = str(error)
        # Only who holds the lock, and a link that became a copy, may go unsaid.
        assert os.strerror(code) in said or (len(acknowledged) == 6 and not forever)
        if not acknowledged and not (folder / "journal").exists():
            Session.create(folder).close()  # what is left of a session that was never made is in nobody's way
            assert check(folder).sound
            continue
        with Session.open(folder, by="a") as session:
            hashes = [record.hash for record in session.records]
            assert hashes[: len(acknowledged)] == acknowledged
            assert len(hashes) <= len(acknowledged) + bool(said)
            session.note("and on")
        assert check(folder).sound
        assert not list(folder.rglob("*.tmp"))
        repair(folder)
        with Session.open(folder, write=False) as session:
            # Acknowledged or not: what was written in the session's folder is never lost.
            assert len([each for each in session.state.inputs if each.name == "a.bin"]) == (
                len(acknowledged) > 4
            )
        assert check(folder).sound


def stays_shut(session):
    assert session.refuses
    with pytest.raises(SessionError, match="still rejects writes"):
        session.recover()
    assert session.refuses


def test_after_a_failed_write_the_journal_is_read_again_before_anything_is_accepted(tmp_path, monkeypatch):
    with Session.create(tmp_path / "s") as session:
        session.note("before")
        with monkeypatch.context() as patch:
            Failing(patch, 1, errno.EIO, forever=True)
            for _ in range(2):
                with pytest.raises(SessionError, match=r"not recorded|cannot be"):
                    session.note("lost")
            stays_shut(session)
        session.recover()
        assert not session.refuses
        session.note("and on")
    with Session.open(tmp_path / "s") as session:
        assert [note.text for note in session.state.notes] == ["before", "and on"]
    assert check(tmp_path / "s").sound
    assert not list((tmp_path / "s").glob(".room*"))


def test_a_disk_without_room_for_a_file_is_known_until_there_is_room(tmp_path, monkeypatch):
    with Session.create(tmp_path / "s") as session:
        with pytest.raises((SessionError, OSError)):
            session.add_input(tmp_path / "not there", "recording")
        assert not session.refuses, "the disk has nothing to do with it"
        with monkeypatch.context() as patch:
            Failing(patch, 1, errno.ENOSPC, forever=True)
            with pytest.raises(SessionError, match="free disk space"):
                session.add_input(b"markers", "markers", name="m.csv")
            stays_shut(session)
        session.recover()
        assert not session.refuses


def test_an_action_goes_on_by_itself_once_the_disk_does(tmp_path, monkeypatch):
    with Session.create(tmp_path / "s") as session:
        with monkeypatch.context() as patch:
            Failing(patch, 1, errno.ENOSPC, forever=False)
            with pytest.raises(SessionError, match="repeat it"):
                session.note("lost")
        session.note("again")
    with Session.open(tmp_path / "s") as session:
        assert [note.text for note in session.state.notes] == ["again"]


def test_a_journal_that_is_not_what_was_acknowledged_is_not_gone_on_with(tmp_path, monkeypatch):
    with Session.create(tmp_path / "s") as session:
        session.note("mine")
        with monkeypatch.context() as patch:
            Failing(patch, 1, errno.EIO, forever=False)
            with pytest.raises(SessionError):
                session.note("lost")
        journal = tmp_path / "s" / "journal"
        data = bytearray(journal.read_bytes())
        data[len(data) // 2] ^= 1
        journal.write_bytes(data)
        for _ in range(2):
            with pytest.raises(SessionError, match="reload the session"):
                session.recover()
        assert journal.read_bytes() == data


def test_files_are_there_before_the_record_that_names_them(tmp_path, monkeypatch):
    order = []
    with Session.create(tmp_path / "s") as session:
        for name in ("fsync", "replace"):
            real = getattr(os, name)
            monkeypatch.setattr(os, name, lambda *a, name=name, real=real: (order.append(name), real(*a))[1])
        session.add_input(b"x", "mesh", name="m.stl")
    # file, its name, its folder, and only then the record
    assert order == ["fsync", "replace", "fsync", "fsync"]
