"""The journal's bytes: cut anywhere, flipped anywhere, chained."""

import os

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.session import journal
from contactbench.pipeline.session.journal import JOURNAL, JournalError, JournalWriter, SessionError

PAYLOADS = [journal.canonical({"n": n, "text": "µ" * n}) for n in range(6)]
DATA = journal.encode_all(PAYLOADS)
ENDS = [0, *(frame.end for frame in journal.scan(DATA).frames)]


def test_what_was_written_is_read():
    found = journal.scan(DATA)
    assert [frame.payload for frame in found.frames] == PAYLOADS
    assert (found.torn, found.damage, found.end) == ("", "", len(DATA))


def test_cut_at_every_byte_the_whole_records_stay_and_the_rest_is_torn():
    for cut in range(len(DATA)):
        found = journal.scan(DATA[:cut])
        whole = max(n for n, end in enumerate(ENDS) if end <= cut)
        assert len(found.frames) == whole
        assert found.end == ENDS[whole]
        assert bool(found.torn) == (cut not in ENDS)
        assert not found.damage


def test_a_last_record_that_lost_a_byte_in_its_text_is_damaged_and_not_torn():
    last = ENDS[-2] + 48
    at = DATA.index(b"text", last)
    found = journal.scan(DATA[:at] + DATA[at + 1 :])
    assert found.damage
    assert found.last


def test_blocks_of_zeros_at_the_end_are_torn():
    for cut in range(ENDS[-2], len(DATA)):
        padded = DATA[:cut] + bytes(5000)
        found = journal.scan(padded)
        assert len(found.frames) == len(PAYLOADS) - 1
        # A header that was half written has no length to trust: then a person decides, nothing is dropped.
        assert found.torn or (found.damage and found.last and ENDS[-2] < cut < ENDS[-2] + 48)


def test_every_flipped_bit_is_found_and_nothing_acknowledged_is_called_torn():
    for bit in range(8 * len(DATA)):
        changed = bytearray(DATA)
        changed[bit // 8] ^= 1 << bit % 8
        found = journal.scan(bytes(changed))
        assert found.damage
        assert not found.torn
        record = max(n for n, end in enumerate(ENDS) if end <= bit // 8)
        assert len(found.frames) == record
        assert found.last == (record == len(PAYLOADS) - 1)


@pytest.mark.parametrize("order", [[0, 2, 1], [0, 2], [1, 2], [0, 1, 1]])
def test_records_that_were_moved_or_removed_break_the_chain(order):
    parts = [DATA[ENDS[n] : ENDS[n + 1]] for n in order]
    assert "does not follow the one before" in journal.scan(b"".join(parts)).damage


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.binary(max_size=300), st.integers(0, len(DATA)))
def test_any_bytes_are_read_without_an_error(junk, cut):
    found = journal.scan(DATA[:cut] + junk)
    assert found.end <= cut + len(junk)
    assert journal.encode_all(frame.payload for frame in found.frames) == (DATA[:cut] + junk)[: found.end]


def test_what_json_cannot_hold_is_refused():
    with pytest.raises(JournalError, match="cannot be written"):
        journal.canonical({"x": float("nan")})
    with pytest.raises(JournalError, match="put large data into a file"):
        journal.encode(b" " * (2**20 + 1), journal.GENESIS)


def failed_writer(folder, monkeypatch):
    """Make a journal, and a writer whose last write did not reach the disk."""
    (folder / JOURNAL).write_bytes(DATA)
    writer = JournalWriter(folder, journal.scan(DATA))
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(5, "the disk is gone")))
        with pytest.raises(SessionError, match="not recorded"):
            writer.append(PAYLOADS[0])
    return writer


def test_after_a_write_that_failed_all_is_refused_until_it_is_mended(tmp_path, monkeypatch):
    writer = failed_writer(tmp_path, monkeypatch)
    with pytest.raises(SessionError, match="an earlier write failed"):
        writer.append(PAYLOADS[0])
    writer.mend()
    writer.append(PAYLOADS[0])
    writer.close()
    assert (tmp_path / JOURNAL).read_bytes()[: len(DATA)] == DATA
    assert len(journal.scan((tmp_path / JOURNAL).read_bytes()).frames) == len(PAYLOADS) + 1


def test_a_journal_of_the_same_length_that_others_wrote_is_not_mended(tmp_path, monkeypatch):
    writer = failed_writer(tmp_path, monkeypatch)
    other = journal.encode_all([PAYLOADS[0].replace(b"0", b"9"), *PAYLOADS[1:]])
    assert len(other) == len(DATA)
    (tmp_path / JOURNAL).write_bytes(other)
    with pytest.raises(SessionError, match="another program changed the journal"):
        writer.mend()
    writer.close()
    assert (tmp_path / JOURNAL).read_bytes() == other
