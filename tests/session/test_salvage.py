"""Damage anywhere in a session: what is whole is kept, what rests on the rest is stale, and the original stays."""

import hashlib
import os
import random
import shutil

import pytest

from contactbench.pipeline.session import (
    JournalError,
    SchemaError,
    Session,
    SessionError,
    SessionReadOnlyError,
    journal,
)
from contactbench.pipeline.session import lock as locks
from contactbench.pipeline.session.actions import VERSION
from contactbench.pipeline.session.archive import export_archive
from contactbench.pipeline.session.check import check, repair, salvage
from contactbench.pipeline.session.remains import remains_of

POSES, CALIBRATION, MESH, PROBE, NOTE = range(1, 6)  # places in the journal, from 0


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A session: created, poses, calibration from them, mesh, probe from it, note, and a second set of both."""
    place = tmp_path_factory.mktemp("whole")
    with Session.create(place / "s", by="ada") as session:
        for turn in ("", "2"):
            table = b"t,fx\n0,1\n" + turn.encode()
            poses = session.add_input(table, "poses", name=f"p{turn}.csv", sensor="42").action.file.sha256
            session.add_result("calibration", f"c{turn}.json", {f"c{turn}.json": b"{}"}, {"poses": poses}, {})
            mesh = session.add_input(b"solid" + turn.encode(), "mesh", name=f"m{turn}.stl").action.file.sha256
            session.add_result(
                "probe", f"p{turn}.ply", {f"p{turn}.ply": b"ply" + turn.encode()}, {"mesh": mesh}, {}
            )
            session.note("a few words" * 40)
    return place / "s"


@pytest.fixture
def folder(whole, tmp_path):
    shutil.copytree(whole, tmp_path / "s")
    return tmp_path / "s"


def journal_frames(folder):
    return journal.scan((folder / "journal").read_bytes()).frames


def spoil(folder, change):
    """Let `change` have the records' bytes, one item a record, and write what it makes of them."""
    data = (folder / "journal").read_bytes()
    parts = [data[frame.offset : frame.end] for frame in journal.scan(data).frames]
    change(parts)
    (folder / "journal").write_bytes(b"".join(parts))


def wipe(place):
    """Damage the middle of a record so that nothing proves what it was."""

    def change(parts):
        part = bytearray(parts[place])
        part[60:76] = b"################"
        parts[place] = bytes(part)

    return change


def fingerprint(folder):
    files = sorted(each for each in folder.rglob("*") if each.is_file())
    return {
        str(each.relative_to(folder)): hashlib.sha256(each.read_bytes()).hexdigest() for each in files
    } | {"folders": sorted(str(each) for each in folder.rglob("*") if each.is_dir())}


def entries(folder):
    with Session.open(folder, write=False) as session:
        return [record.entry for record in session.records], session.stale()


def titles(stale):
    return {" ".join(slot) for slot, reasons in stale.items() if reasons}


# ---- damage anywhere -----------------------------------------------------------------------------


def _damages(size):
    """Yield (name, function of bytes) for every region of a journal, sampled with a fixed seed."""
    chance = random.Random(11)  # noqa: S311 places, no secrets
    for at in sorted(chance.sample(range(size), 25)):
        bit, length = chance.randrange(8), chance.randrange(1, 600)
        yield f"bit {at}", lambda d, at=at, bit=bit: d[:at] + bytes([d[at] ^ 1 << bit]) + d[at + 1 :]
        yield (
            f"wiped {at}+{length}",
            lambda d, at=at, n=length: d[:at] + b"\n" * len(d[at : at + n]) + d[at + n :],
        )
        yield f"lost {at}+{length}", lambda d, at=at, n=length: d[:at] + d[at + n :]
        yield f"lost byte {at}", lambda d, at=at: d[:at] + d[at + 1 :]
        yield f"cut {at}", lambda d, at=at: d[:at]
        yield f"junk {at}", lambda d, at=at: d[:at] + b"\r\n" + d[at:]
        yield f"zeros {at}", lambda d, at=at, n=length: d[:at] + bytes(len(d[at : at + n])) + d[at + n :]


def test_damage_anywhere_keeps_every_record_that_is_not_damaged(whole):
    data = (whole / "journal").read_bytes()
    original = journal.scan(data).frames
    payloads = [frame.payload for frame in original]
    tried = lossless = 0
    for name, damage in _damages(len(data)):
        changed = damage(data)
        intact = {each.payload for each in original if data[each.offset : each.end] in changed}
        if not intact:
            with pytest.raises(SessionError):
                remains_of(whole, changed)
            continue
        left = remains_of(whole, changed)
        found = [frame.payload for frame in journal.scan(left.data).frames]
        assert journal.scan(left.data).end == len(left.data), name
        assert intact <= set(found), f"{name}: what is undamaged is kept"
        known = [each for each in found if each in payloads]
        assert known == [each for each in payloads if each in found], f"{name}: once each, and in order"
        assert found[1:] == known[known[0] == found[0] :], f"{name}: only a first record is made up"
        gone = [number for number, each in enumerate(payloads) if each not in found]
        # Cut off, or never written: that is a crash, and nobody was told that these records are safe.
        crash = data.startswith(changed.rstrip(b"\0")) and gone == list(range(len(known), len(payloads)))
        # Bytes lost at the end of a note's text, and its end with them: that looks the same.
        crash |= gone == [10] and journal.scan(changed).torn != ""
        assert bool(left.losses) == bool(gone and not crash), f"{name}: every loss is said"
        assert not (name.startswith(("bit", "junk between")) and gone), f"{name}: nothing has to be lost"
        tried += 1
        lossless += not gone
    assert tried > 140
    assert lossless > 20


def test_every_damaged_session_opens_or_is_refused_in_words_and_its_copy_is_sound(whole, tmp_path):
    data = (whole / "journal").read_bytes()
    before = fingerprint(whole)
    for number, (name, damage) in enumerate(_damages(len(data))):
        if number % 9:
            continue
        place = tmp_path / str(number)
        shutil.copytree(whole, place)
        (place / "journal").write_bytes(damage(data))
        spoiled = fingerprint(place)
        for options in ({}, {"damaged": True}):
            try:
                Session.open(place, write=False, **options).close()
            except SessionError:
                continue
        check(place)
        try:
            done = salvage(place)
        except SessionError as error:
            assert "no intact record" in str(error) or "backup" in str(error), name  # noqa: PT017
            continue
        assert fingerprint(place) == spoiled, name
        assert check(done.out).sound, (name, check(done.out).problems)
        kept, stale = entries(done.out)
        assert titles(stale) == set(done.stale), name
        seen, would = entries_damaged(place)
        assert [each.action for each in seen][: done.records] == [each.action for each in kept][
            : done.records
        ]
        assert titles(would) == titles(stale), name
    assert fingerprint(whole) == before


def entries_damaged(folder):
    with Session.open(folder, write=False, damaged=True) as session:
        return [record.entry for record in session.records], session.stale()


# ---- what rests on it ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        (POSES, {"calibration c.json"}),
        (CALIBRATION, set()),
        (MESH, {"calibration c.json", "probe p.ply"}),
        (PROBE, {"calibration c.json"}),
        (NOTE, {"calibration c.json", "probe p.ply"}),
        (POSES + 5, {"calibration c.json", "probe p.ply", "calibration c2.json"}),
        (NOTE + 5, {"calibration c.json", "probe p.ply", "calibration c2.json", "probe p2.ply"}),
    ],
)
def test_a_lost_record_makes_stale_what_may_rest_on_it(folder, place, expected):
    _, already = entries(folder)
    spoil(folder, wipe(place))
    with pytest.raises(JournalError):
        Session.open(folder)
    done = salvage(folder)
    assert not done.whole
    assert done.records == 10
    assert expected | titles(already) - {"calibration c.json", "probe p.ply"} <= set(done.stale)
    _, stale = entries(done.out)
    assert titles(stale) == set(done.stale)
    held = {" ".join(slot) for slot in stale} - set(done.stale)
    assert held or place >= NOTE  # what came after the loss with all that it rests on is not stale


def test_a_result_of_a_lost_input_is_kept_and_stale_also_when_the_input_comes_back(folder, tmp_path):
    lost = Session.open(folder, write=False).state.inputs[0]
    spoil(folder, wipe(POSES))
    done = salvage(folder)
    assert done.unclaimed == (lost.file.path,)
    with Session.open(done.out) as session:
        assert (
            "The poses it was computed from is in no earlier record"
            in session.stale()["calibration", "c.json"][0]
        )
        session.add_input(done.out / lost.file.path, "poses", name="p.csv")
    with Session.open(done.out) as session:
        assert session.stale()["calibration", "c.json"]
        session.add_result("calibration", "c.json", {"c.json": b"{}"}, {"poses": lost.content}, {})
        assert session.stale()["calibration", "c.json"] == ()
    assert check(done.out).sound
    export_archive(done.out, tmp_path / "s.zip")


def test_a_rejected_result_stays_rejected_and_an_accepted_one_does_not_stay_accepted(folder):
    with Session.open(folder) as session:
        session.mark("calibration", "c.json", "rejected", "bumped")
        session.mark("probe", "p2.ply", "accepted")
        session.note("last")
    spoil(folder, wipe(-1))
    with Session.open(salvage(folder).out, write=False) as session:
        marks = {each.title: each.mark.mark for each in session.state.current_results.values()}
    assert marks["calibration c.json"] == "rejected"
    assert marks["probe p2.ply"] == "stale"


def test_a_result_that_came_after_the_loss_is_stale_if_its_recording_came_before(folder):
    with Session.open(folder) as session:
        session.rezeroed("42", "new cable")
        before, mesh = session.state.inputs[2], session.state.mesh
        session.add_result("calibration", "late.json", {"late.json": b"{}"}, {"poses": before.content}, {})
        session.add_result("probe", "late.ply", {"late.ply": b"late"}, {"mesh": mesh.content}, {})
    spoil(folder, wipe(11))
    done = salvage(folder)
    assert "re-zeroed sensor" in done.stale["calibration late.json"][0]
    assert "probe late.ply" not in done.stale


def test_a_record_that_cannot_be_read_is_a_loss(folder):
    payloads = [frame.payload for frame in journal_frames(folder)]
    payloads[NOTE] = b'{"action":{"type":"dance"}}'
    (folder / "journal").write_bytes(journal.encode_all(payloads))
    done = salvage(folder)
    assert (done.whole, done.records) == (False, 10)
    assert {"calibration c.json", "probe p.ply"} <= set(done.stale)


# ---- kinds of damage -----------------------------------------------------------------------------


def test_whatever_one_bit_is_flipped_nothing_is_lost(folder):
    data = (folder / "journal").read_bytes()
    second = journal_frames(folder)[POSES]
    payloads = [frame.payload for frame in journal_frames(folder)]
    for at in range(second.offset, second.end, 7):
        changed = bytearray(data)
        changed[at] ^= 0x20
        left = remains_of(folder, bytes(changed))
        assert [frame.payload for frame in journal.scan(left.data).frames] == payloads, at
        assert not left.losses
        assert "restored" in left.sentences[0]


def test_a_whole_header_that_is_gone_costs_nothing(folder):
    def change(parts):
        parts[MESH] = b"\xff" * 48 + parts[MESH][48:]

    spoil(folder, change)
    done = salvage(folder)
    assert done.whole
    assert done.records == 11


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda parts: parts.insert(4, parts[3]), "appears twice"),
        (lambda parts: parts.insert(8, parts[2]), "appears twice"),
        (lambda parts: parts.insert(3, parts.pop(6)), "out of order"),
        (lambda parts: parts.reverse(), "out of order"),
        (lambda parts: parts.insert(5, b"\n"), "damaged"),
    ],
)
def test_records_twice_or_out_of_order_and_junk_cost_nothing(folder, change, said):
    payloads = [frame.payload for frame in journal_frames(folder)]
    _, already = entries(folder)
    spoil(folder, change)
    done = salvage(folder)
    assert done.whole
    assert any(said in sentence for sentence in done.found)
    assert [frame.payload for frame in journal_frames(done.out)][: len(payloads)] == payloads
    assert set(done.stale) == titles(already)


def test_a_lost_first_record_costs_the_identity(folder):
    spoil(folder, wipe(0))
    done = salvage(folder)
    assert done.records == 11
    with Session.open(done.out, write=False) as session:
        assert len(session.state.inputs) == 4
        assert len(session.state.id) == 32


def test_a_torn_tail_is_no_loss_but_a_damaged_one_is(folder):
    data = (folder / "journal").read_bytes()
    (folder / "journal").write_bytes(data[:-5])
    done = salvage(folder)
    assert (done.whole, done.records) == (True, 10)
    (folder / "journal").write_bytes(data[:-30] + b"#" * 30)
    done = salvage(folder)
    assert (done.whole, done.records) == (False, 10)
    assert len(done.stale) == 4


@pytest.mark.parametrize("wrong", ["missing", "changed", "a link"])
@pytest.mark.parametrize(
    ("kind", "stale"), [("raw", "calibration c.json"), ("results", "calibration c.json")]
)
def test_a_file_that_is_lost_makes_stale_what_rests_on_it(folder, tmp_path, wrong, kind, stale):
    if wrong == "a link" and os.name == "nt":
        pytest.skip("links of POSIX")
    with Session.open(folder, write=False) as session:
        state = session.state
    ref = state.inputs[0].file if kind == "raw" else state.results[0].file
    place = folder / ref.path
    content = place.read_bytes()
    place.unlink()
    if wrong == "changed":
        place.write_bytes(b"x" * len(content))
    elif wrong == "a link":
        (tmp_path / "elsewhere").write_bytes(content)
        place.symlink_to(tmp_path / "elsewhere")
    done = salvage(folder)
    assert not done.whole
    assert done.records == 11
    assert stale in done.stale
    assert not (done.out / ref.path).exists()
    assert ref.path in " ".join(done.found)
    assert "is missing" in check(done.out).problems[0]
    if kind == "raw":  # the original, added again, mends the copy
        with Session.open(done.out) as session:
            session.add_input(content, "poses", name="p.csv")
        assert check(done.out).sound


def test_a_file_that_is_not_what_its_name_says_stays_behind(folder):
    (folder / "raw" / "0123456789ab-poses.csv").write_bytes(b"changed since")
    spoil(folder, wipe(MESH))
    done = salvage(folder)
    assert not (done.out / "raw" / "0123456789ab-poses.csv").exists()
    assert "raw/0123456789ab-poses.csv" not in done.unclaimed


def test_what_was_being_recorded_comes_along(folder):
    (folder / "raw" / "unfinished-a.mcap").write_bytes(b"begun")
    (folder / "raw" / ".stored.0123456789abcdef.tmp").write_bytes(b"half")
    spoil(folder, wipe(MESH))
    out = salvage(folder).out
    assert (out / "raw" / "unfinished-a.mcap").read_bytes() == b"begun"
    assert not list(out.rglob("*.tmp"))


# ---- places and versions -------------------------------------------------------------------------


def test_where_the_copy_goes(folder, tmp_path):
    spoil(folder, wipe(MESH))
    assert salvage(folder).out == tmp_path / "s-salvaged"
    assert salvage(folder).out == tmp_path / "s-salvaged-2"
    assert salvage(folder, tmp_path / "n").out == tmp_path / "n"
    for out, said in ((tmp_path / "n", "already exists"), (folder / "in", "inside")):
        with pytest.raises(SessionError, match=said):
            salvage(folder, out)
    with pytest.raises(SessionError, match="choose another location"):
        salvage(folder, tmp_path / "none" / "n")


def test_a_disk_that_fills_leaves_nothing(folder, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("contactbench.pipeline.session.check.write_file", full)
    with pytest.raises(SessionError, match="No space left"):
        salvage(folder, tmp_path / "n")
    assert [each.name for each in tmp_path.iterdir()] == ["s"]


def test_a_newer_version_and_no_session_are_refused(folder, tmp_path):
    payloads = [frame.payload for frame in journal_frames(folder)]
    payloads[0] = payloads[0].replace(b'"version":%d' % VERSION, b'"version":%d' % (VERSION + 1))
    (folder / "journal").write_bytes(journal.encode_all(payloads) + b"#" * 60)
    with pytest.raises(SchemaError):
        salvage(folder)
    (folder / "journal").write_bytes(b"")
    with pytest.raises(SessionError, match="no intact record"):
        salvage(folder)
    with pytest.raises(SessionError, match="is not a session"):
        salvage(tmp_path)
    assert [each.name for each in tmp_path.iterdir()] == ["s"]


def test_an_older_version_is_salvaged_too(folder):
    payloads = [frame.payload for frame in journal_frames(folder)]
    payloads[0] = payloads[0].replace(b'"version":%d' % VERSION, b'"version":1')
    (folder / "journal").write_bytes(journal.encode_all(payloads))
    spoil(folder, wipe(NOTE))
    done = salvage(folder)
    assert done.records == 10
    assert (done.out / "journal.v1").is_file()
    assert check(done.out).sound


# ---- read-only -----------------------------------------------------------------------------------


@pytest.fixture(params=["asked", "really"])
def read_only(request, folder, monkeypatch):
    """A session that cannot be written, for this program or, for a user who is not root, really."""
    if request.param == "asked":
        monkeypatch.setattr(locks, "writable", lambda _path: False)
        yield folder
        return
    if os.name == "nt" or os.geteuid() == 0:
        pytest.skip("rights do not bind this user")
    for each in (folder, *folder.rglob("*")):
        each.chmod(0o555 if each.is_dir() else 0o444)
    yield folder
    for each in (folder, *folder.rglob("*")):
        each.chmod(0o755)


def test_a_session_that_cannot_be_written_is_read_and_nothing_is_left_in_it(read_only):
    (read_only / "lock").unlink() if os.access(read_only, os.W_OK) else None
    before = fingerprint(read_only)
    for attempt in (Session.open, repair):
        with pytest.raises(SessionReadOnlyError, match="read-only"):
            attempt(read_only)
    with Session.open(read_only, write=False) as session:
        assert session.state.count == 11
        assert not session.writable
        with pytest.raises(SessionError, match="read-only"):
            session.note("x")
    assert check(read_only).sound
    assert fingerprint(read_only) == before


def test_a_damaged_session_is_read_without_a_trace(folder):
    spoil(folder, wipe(MESH))
    before = fingerprint(folder)
    with Session.open(folder, write=False, damaged=True) as session:
        assert session.damage
        assert any("lost after record 3" in note for note in session.notes)
        with pytest.raises(SessionError, match="read-only"):
            session.note("x")
    assert fingerprint(folder) == before
