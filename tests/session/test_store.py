"""Sessions on disk: adding, reopening, two writers, versions, repair."""

import base64
import errno
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks.session_crash import kill_writers

from contactbench.pipeline.session import (
    JournalError,
    SchemaError,
    Session,
    SessionError,
    SessionLockedError,
    journal,
)
from contactbench.pipeline.session import lock as locks
from contactbench.pipeline.session.actions import VERSION
from contactbench.pipeline.session.archive import export_archive, import_archive
from contactbench.pipeline.session.check import check, repair
from contactbench.pipeline.session.state import MIGRATIONS

ROOT = Path(__file__).parents[2]


@pytest.fixture
def folder(tmp_path):
    with Session.create(tmp_path / "s", by="ada") as session:
        session.note("first")
    return tmp_path / "s"


@pytest.fixture
def poses(tmp_path):
    file = tmp_path / "poses µ.csv"
    file.write_bytes(b"t,fx\n0,1\n")
    return file


def test_what_was_added_is_there_after_reopening(folder, poses):
    with Session.open(folder, by="ada") as session:
        record = session.add_input(poses, "poses", sensor="42")
        session.set_parameter("calibration.noise_force", 0.1)
        session.add_result(
            "report", "r.txt", {"r.txt": b"!"}, {"poses": record.action.file.sha256}, {"a": [1, None]}
        )
        state = session.state
    with Session.open(folder, write=False) as again:
        assert again.state == state
        assert again.records[0].action.version == VERSION
        assert again.records[2].entry.by == "ada"
        assert again.records[2].entry.sensor == "42"
        assert again.records[2].entry.tool.startswith("contactbench ")
        assert again.records[2].entry.at.endswith("+00:00")
        [stored] = again.state.inputs
        assert stored.name == "poses µ.csv"
        assert (folder / stored.file.path).read_bytes() == poses.read_bytes()
    assert check(folder).sound


def test_bytes_are_an_input_as_their_file_is(folder, poses):
    with Session.open(folder) as session:
        session.add_input(poses, "poses", companions={"beside": poses})
        session.add_input(
            poses.read_bytes(), "poses", name=poses.name, companions={"beside": poses.read_bytes()}
        )
        first, second = session.state.inputs
        assert (first.file, first.companions) == (second.file, second.companions)
        with pytest.raises(SessionError, match="name"):
            session.add_input(b"1", "poses")


def test_the_newest_of_a_kind_is_a_result_or_what_was_brought_in_as_one(folder, poses):
    with Session.open(folder) as session:
        assert session.state.newest("calibration") is None
        session.add_result("calibration", "a.json", {"a.json": b"1"}, {}, {})
        session.add_input(poses, "calibration")
        assert session.state.newest("calibration").slot == ("calibration", poses.name)
        session.add_result("calibration", "a.json", {"a.json": b"2"}, {}, {})
        assert session.state.newest("calibration") == session.state.results[-1]


def test_times_are_in_no_results_hash(folder):
    with Session.open(folder) as session:
        for created in ("2026-01-01T00:00:00Z", "2027-01-01T00:00:00Z"):
            session.add_result("report", "r.txt", {"r.txt": b"!"}, {}, {}, created=created)
        first, second = session.state.results
    assert first.content == second.content
    assert first.at != second.at


@pytest.mark.parametrize("name", ["", ".", "..", "a/b", "a\\b", ".hidden", "c:x", "a\nb", "x" * 300])
def test_names_that_lead_elsewhere_are_refused_before_anything_is_copied(folder, poses, name):
    with Session.open(folder) as session, pytest.raises(SessionError, match="name"):
        session.add_input(poses, "poses", name=name)
    assert list((folder / "raw").iterdir()) == []


def test_what_is_wrong_is_refused(folder, tmp_path):
    with Session.open(folder) as session:
        with pytest.raises(SessionError, match="not a regular file"):
            session.add_input(tmp_path, "poses")
        with pytest.raises(SessionError, match="cannot be read"):
            session.add_input(tmp_path / "none", "poses")
        with pytest.raises(SessionError, match="contains nothing with the hash"):
            session.add_result("report", "r", {"r": b""}, {"poses": "0" * 64}, {})
        with pytest.raises(SessionError, match="cannot be written"):
            session.set_parameter("a.b", float("nan"))
        with pytest.raises(SessionError, match="no result"):
            session.mark("report", "r", "stale")
        assert len(session.records) == 2
        session.note("still works")
    with Session.open(folder, write=False) as session, pytest.raises(SessionError, match="read-only"):
        session.note("no")
    with pytest.raises(SessionError, match="there is already a session"):
        Session.create(folder)
    with pytest.raises(SessionError, match="the folder contains"):
        Session.create(tmp_path)
    with pytest.raises(SessionError, match="is not a session"):
        Session.open(tmp_path)


# ---- two writers -------------------------------------------------------------------------------

HOLD = "import sys; from pathlib import Path; from contactbench.pipeline.session import Session\n"
HOLD += "s = Session.open(Path(sys.argv[1])); s.note('held'); print('ready', flush=True); sys.stdin.read()"


def test_two_cannot_write_reading_is_possible_and_a_dead_writer_blocks_nobody(folder):
    command = [sys.executable, "-c", HOLD, str(folder)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=ROOT) as other:
        assert other.stdout.readline() == b"ready\n"
        with pytest.raises(SessionLockedError, match=f"process {other.pid}"):
            Session.open(folder)
        with pytest.raises(SessionLockedError):
            repair(folder)
        with Session.open(folder, write=False) as reader:
            assert reader.records[-1].action.text == "held"
        other.kill()
    with Session.open(folder) as session:
        session.note("after")
    assert (folder / "lock").exists()


def test_one_process_cannot_write_twice_either(folder):
    with Session.open(folder), pytest.raises(SessionLockedError):
        Session.open(folder)


# ---- torn, damaged -----------------------------------------------------------------------------


def test_a_torn_record_is_cut_off_with_a_sentence(folder):
    data = (folder / "journal").read_bytes()
    with Session.open(folder) as session:
        session.note("torn")
    longer = (folder / "journal").read_bytes()
    for cut in (len(data) + 1, len(data) + 47, len(data) + 48, len(longer) - 1):
        (folder / "journal").write_bytes(longer[:cut])
        with Session.open(folder, write=False) as session:
            assert "never confirmed" in session.notes[0]
        assert (folder / "journal").stat().st_size == cut
        assert check(folder).sound
        with Session.open(folder) as session:
            assert "has been cut off" in session.notes[0]
            assert len(session.records) == 2
        assert (folder / "journal").read_bytes() == data


def test_repair_cuts_a_torn_tail_and_keeps_the_original(folder):
    data = (folder / "journal").read_bytes()
    (folder / "journal").write_bytes(data + b"\x93CBJ")
    done = repair(folder)
    assert done.removed == 4
    assert (folder / done.kept_as).read_bytes() == data + b"\x93CBJ"
    assert (folder / "journal").read_bytes() == data
    assert repair(folder).removed == 0


def test_repair_sets_a_damaged_last_record_aside_but_opening_does_not(folder):
    data = bytearray((folder / "journal").read_bytes())
    data[-1] ^= 1
    (folder / "journal").write_bytes(data)
    with pytest.raises(JournalError, match=r"record 2 at byte .* is damaged.*session repair"):
        Session.open(folder)
    assert (folder / "journal").read_bytes() == data
    assert (folder / repair(folder).kept_as).read_bytes() == data
    assert len(Session.open(folder, write=False).records) == 1


def test_damage_in_the_middle_is_named_and_never_repaired(folder):
    data = bytearray((folder / "journal").read_bytes())
    data[60] ^= 1
    (folder / "journal").write_bytes(data)
    for attempt in (repair, Session.open):
        with pytest.raises(JournalError, match=r"record 1 at byte 0 is damaged.*intact records follow"):
            attempt(folder)
    assert not check(folder).sound
    assert (folder / "journal").read_bytes() == data


def test_missing_changed_and_longer_files_are_found(folder, poses):
    with Session.open(folder) as session:
        ref = session.add_input(poses, "poses").action.file
    file = folder / ref.path
    for content, said in (
        (b"t,fx\n0,2\n", "does not match the journal"),
        (b"", "has 0 bytes, not 9"),
        (None, "is missing"),
    ):
        file.unlink() if content is None else file.write_bytes(content)
        assert said in check(folder).problems[0]
    with Session.open(folder) as session:  # adding the original again mends it
        session.add_input(poses, "poses")
    assert check(folder).sound
    (folder / "raw" / "orphan").write_bytes(b"")
    assert "belong to no record" in check(folder).notes[0]


# ---- versions ----------------------------------------------------------------------------------


def rewrite(folder, change):
    found = journal.scan((folder / "journal").read_bytes())
    payloads = [json.loads(frame.payload) for frame in found.frames]
    change(payloads)
    (folder / "journal").write_bytes(journal.encode_all(map(journal.canonical, payloads)))
    return (folder / "journal").read_bytes()


def test_a_newer_version_is_refused_and_left_alone(folder):
    data = rewrite(folder, lambda payloads: payloads[0]["action"].update(version=VERSION + 1, news=True))
    for write in (True, False):
        with pytest.raises(SchemaError, match="use a newer contactbench"):
            Session.open(folder, write=write)
    assert (folder / "journal").read_bytes() == data


def older(payloads):
    payloads[0]["action"]["version"] = 0
    for payload in payloads:
        payload["who"] = payload.pop("by")


def newer(payloads):
    return [{**{k: v for k, v in each.items() if k != "who"}, "by": each["who"]} for each in payloads]


def test_an_older_version_is_migrated_and_the_original_kept(folder, monkeypatch):
    old = rewrite(folder, older)
    with pytest.raises(SchemaError, match="too old"):
        Session.open(folder)
    monkeypatch.setitem(MIGRATIONS, 0, newer)
    with Session.open(folder, write=False) as session:
        assert session.records[1].entry.by == "ada"
    assert (folder / "journal").read_bytes() == old
    with Session.open(folder) as session:
        assert f"migrated from version 0 to {VERSION}" in session.notes[0]
        session.note("after")
    assert (folder / "journal.v0").read_bytes() == old
    assert check(folder).sound
    with Session.open(folder, write=False) as session:
        assert session.notes == ()
        assert [record.entry.by for record in session.records][:2] == ["ada", "ada"]
    (folder / "journal.v0").write_bytes(b"")
    assert "was changed" in check(folder).problems[0]


@pytest.mark.parametrize(
    "change",
    [
        lambda p: p[1].update(at="yesterday"),
        lambda p: p[1].update(at="2026-01-01T00:00:00+02:00"),
        lambda p: p[1].update(action=p[0]["action"]),
        lambda p: p[1]["action"].update(type="other"),
        lambda p: p[1].update(
            action={
                "type": "mesh_changed",
                "name": "m",
                "file": {"path": "../x", "sha256": "0" * 64, "size": 1},
            }
        ),
        lambda p: p.pop(0),
    ],
)
def test_records_that_cannot_be_are_named(folder, change):
    rewrite(folder, change)
    with pytest.raises(SessionError, match="record"):
        Session.open(folder)


# ---- kill -9 -----------------------------------------------------------------------------------


@pytest.mark.skipif(os.name == "nt", reason="kill is TerminateProcess there, the same by another name")
def test_killed_at_ten_moments_nothing_acknowledged_is_lost(tmp_path):
    report = kill_writers(tmp_path / "s", 10, seed=5)
    assert report.problems == ()
    assert report.acknowledged > 10


# ---- folders that somebody else had a hand in ----------------------------------------------------


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
    payloads = [journal.scan((folder / "journal").read_bytes()).frames[0].payload]
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


# ---- A session that the version 1 wrote ----------------------------------------------------------


ARCHIVE = base64.b64decode(
    "UEsDBBQAAAAIAAAAIQCe6MSJuAEAAHgCAAAHAAAAam91cm5hbKWQvWsUQRjGV0h6IVoKMiomcW+dj/2YXStjlWAXy8Dx7sxsbvFu"
    "59idJMTj0ghWEosIIRCS0iaQNiSBaKOCpLC10SY2KfQPsHAmfhAtbISBGd7nmed5+a3dm5r54nneu2srJ5MfJ4cf1rdPvk4dzF2+"
    "eeeZf2Xz0+Dp6Vt9cfw4u3R3Zuvz6d4AgTClrlA2QKVEGYpFolLGgPBcYUyTFEeERVLmRcq4DAnyUa+cr8Eo2S5q3UNZtdDt+qgR"
    "HdWD9lmG0JWxsbmqRCdoVNO4Ah+Z5b6y6s9BW9TKpVhhUdVnlowMfQTGeiimcYuQFiUPKMvciQPGwiiKbmGcYWw/5cvWV2tt7LtR"
    "VaPrX6sYrbt/bXEVByTAaLhm8Uxc8LwXj8uRiePnY/ent9+PjZCV/bml0Z3XGy+fvNnFN1aPVq/Pzx6+Otj/dh5PUXaVu/tgOq4a"
    "lm4nTOSMRxxinrQgEM2iW6YDNIqt47wKPExDAYxRhiOGSUw5LZgEyVIZUlHEVECoklRKoAAikSkIl1U+sp3UYnlYVg5tX1t8Vqig"
    "51j+7vwTwA/QZdVfMG2Q0kL+N1gecvp/YL8DUEsDBC0AAAAIAAAAIQAfCOpG//////////8WABQAcmF3LzczY2IzODU4YTY4Ny1h"
    "LmNzdgEAEAACAAAAAAAAAAQAAAAAAAAAq+ACAFBLAQIUAxQAAAAIAAAAIQCe6MSJuAEAAHgCAAAHAAAAAAAAAAAAAACkgQAAAABq"
    "b3VybmFsUEsBAi0DLQAAAAgAAAAhAB8I6kYEAAAAAgAAABYAAAAAAAAAAAAAAKSB3QEAAHJhdy83M2NiMzg1OGE2ODctYS5jc3ZQ"
    "SwUGAAAAAAIAAgB5AAAAKQIAAAAA"
)


@pytest.fixture
def old_folder(tmp_path):
    (tmp_path / "old.zip").write_bytes(ARCHIVE)
    import_archive(tmp_path / "old.zip", tmp_path / "s")
    return tmp_path / "s"


def test_an_old_session_is_sound_and_stays_old_until_it_is_written(old_folder):
    data = (old_folder / "journal").read_bytes()
    assert b'"version":1' in data
    found = check(old_folder)
    assert found.problems == ()
    assert "older version 1" in found.notes[0]
    assert (old_folder / "journal").read_bytes() == data


def test_it_is_packed_as_it_is(old_folder, tmp_path):
    done = export_archive(old_folder, tmp_path / "again.zip")
    assert done.files == 2
    assert "older version 1" in done.notes[0]
    import_archive(tmp_path / "again.zip", tmp_path / "back")
    assert (tmp_path / "back" / "journal").read_bytes() == (old_folder / "journal").read_bytes()


def test_once_migrated_its_first_journal_goes_with_it(old_folder, tmp_path):
    with Session.open(old_folder) as session:
        assert session.records[0].action.version == VERSION
        session.note("after")
    assert check(old_folder).problems == ()
    assert export_archive(old_folder, tmp_path / "new.zip").files == 3
    import_archive(tmp_path / "new.zip", tmp_path / "back")
    assert (tmp_path / "back" / "journal.v1").exists()
