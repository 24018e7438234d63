"""What `repair` makes of recordings that ended abruptly: nothing that may hold samples is ever deleted."""

import json
import os
import threading
from functools import partial

import pytest
from typer.testing import CliRunner

from contactbench.pipeline.commands.session import session_app
from contactbench.pipeline.devices.protocols import Counters
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.stream import Health, StreamState
from contactbench.pipeline.recording import RecordingInfo, RecordingWriter, read_recording
from contactbench.pipeline.recording.recorder import Recorder
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.adoption import LiveRecording
from contactbench.pipeline.session.check import check, repair
from contactbench.pipeline.session.journal import JournalWriter

ABOUT = RecordingInfo(1_700_000_000_000_000_000, 0.0)


def samples(count, begin=0.0):
    return [WrenchSample(begin + n / 100, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3), n) for n in range(count)]


def left(folder, name="a.mcap", count=200):
    file = folder / "raw" / f"unfinished-{name}"
    with RecordingWriter(file, ABOUT) as writer:
        for sample in samples(count):
            writer.wrench(sample)
    return file


def inputs(folder):
    with Session.open(folder, write=False) as session:
        return session.state.inputs


def chunk_of(data):
    """Where the only chunk of a recording is: it is packed with zstd."""
    return data.index(b"zstd")


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[: chunk_of(data) + 60],
        lambda data: data[: chunk_of(data) - 30],
        lambda data: data[: chunk_of(data) + 60] + b"\xff" + data[chunk_of(data) + 61 :],
    ],
    ids=["cut in the chunk", "cut in its head", "changed"],
)
def test_a_recording_whose_only_chunk_is_damaged_is_kept(folder, damage):
    file = left(folder)
    data = damage(file.read_bytes())
    file.write_bytes(data)
    [words] = repair(folder).adopted
    assert "kept unchanged" in words
    [kept] = inputs(folder)
    assert kept.kind == "unreadable"
    assert (folder / kept.file.path).read_bytes() == data
    assert not file.exists()


def test_events_without_samples_are_kept(folder):
    file = folder / "raw" / "unfinished-a.mcap"
    with RecordingWriter(file, ABOUT) as writer:
        writer.event("stream", {"state": "lost"}, 0.1)
    repair(folder)
    assert [each.kind for each in inputs(folder)] == ["unreadable"]


def test_a_closed_one_without_anything_is_not_kept(folder):
    left(folder, count=0)
    assert "before its first sample" in repair(folder).adopted[0]
    assert inputs(folder) == ()
    assert list((folder / "raw").iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="pipes and links of POSIX")
def test_one_that_cannot_be_adopted_is_in_no_others_way(folder):
    (folder / "raw" / "unfinished-a").mkdir()
    os.mkfifo(folder / "raw" / "unfinished-b")
    left(folder, ".c:d.mcap")
    (folder / "raw" / "unfinished-l.mcap").symlink_to("/etc/hostname")
    left(folder, "z.mcap")
    done = repair(folder)
    assert len(done.adopted) == 1
    assert len(done.left) == 4
    assert all("was left in place" in words for words in done.left)
    assert [each.name for each in inputs(folder)] == ["z.mcap"]
    assert len(list((folder / "raw").glob("unfinished-*"))) == 4
    assert len(check(folder).problems) == 3  # the name alone harms nobody


def test_what_is_in_the_session_already_is_compared_with_the_file_itself(folder):
    data = left(folder).read_bytes()
    repair(folder)
    [kept] = inputs(folder)
    (folder / kept.file.path).unlink()
    (folder / "raw" / "unfinished-a.mcap").write_bytes(data)
    repair(folder)
    assert check(folder).sound
    assert (folder / kept.file.path).read_bytes() == data


# ---- names that are taken ----------------------------------------------------------------------


def test_a_name_that_is_taken_is_refused_before_anything_is_said(folder):
    with Session.open(folder) as session:
        live = LiveRecording(session, ABOUT, name="a.mcap")
        with live:
            live.recorder.samples(samples(10))
        with pytest.raises(SessionError, match="session repair"):
            LiveRecording(session, ABOUT, name="a.mcap")
        live.keep({})
        before = len(session.records)
        with pytest.raises(SessionError, match="choose another name"):
            LiveRecording(session, ABOUT, name="a.mcap")
        assert len(session.records) == before
    assert len(inputs(folder)) == 1


def test_no_file_is_left_when_the_journal_takes_no_note(folder):
    with Session.open(folder) as session, pytest.MonkeyPatch.context() as patch:
        patch.setattr(JournalWriter, "append", lambda *_: (_ for _ in ()).throw(SessionError("full")))
        with pytest.raises(SessionError, match="full"):
            LiveRecording(session, ABOUT, name="a.mcap")
    assert list((folder / "raw").iterdir()) == []


# ---- a disk that is slower than the samples ----------------------------------------------------


class Slow:
    """A writer that waits until it is told to go on."""

    def __init__(self, writer):
        self._writer, self.go = writer, threading.Event()
        self.event, self.flush = writer.event, writer.flush

    def wrench(self, sample):
        self.go.wait(10)
        self._writer.wrench(sample)


def health():
    return Health(StreamState.STREAMING, (), 1, 100.0, 0.0, Counters(), 0)


def test_a_device_drops_samples_and_says_so(tmp_path):
    said = []
    with RecordingWriter(tmp_path / "a.mcap", ABOUT) as writer:
        slow = Slow(writer)
        with Recorder(
            slow, lambda _, now: said.extend(now.findings), clock=lambda: 1.0, most_waiting=20
        ) as it:
            it.health("sensor", health())
            for begin in range(10):
                it.samples(samples(10, begin))
            slow.go.set()
        assert it.dropped == 80
        assert it.error is None
    found = read_recording(tmp_path / "a.mcap")
    assert len(found.wrenches["/wrench"].times) == 20
    assert [each.fields for each in found.events if each.name == "dropped"] == [
        {"device": "sensor", "samples": 80}
    ]
    assert [words for words in said if "dropped" in words] == said != []


def test_what_can_wait_waits_and_loses_nothing(tmp_path):
    with RecordingWriter(tmp_path / "a.mcap", ABOUT) as writer:
        slow = Slow(writer)
        with Recorder(slow, patient=True, most_waiting=20) as it:
            later = threading.Timer(0.2, slow.go.set)
            later.start()
            for begin in range(100):
                it.samples(samples(10, begin))
            later.join()
        assert it.dropped == 0
    assert len(read_recording(tmp_path / "a.mcap").wrenches["/wrench"].times) == 1000


def test_who_waits_is_freed_when_the_disk_fails(tmp_path):
    with RecordingWriter(tmp_path / "a.mcap", ABOUT) as writer:
        slow = Slow(writer)
        slow.flush = lambda: (_ for _ in ()).throw(SessionError("full"))
        with Recorder(slow, patient=True, most_waiting=20, flush_seconds=0.01) as it:
            threading.Timer(0.1, slow.go.set).start()
            for begin in range(100):
                it.samples(samples(10, begin))
        assert str(it.error) == "full"


def test_a_stepwise_replay_into_a_session_waits_for_the_disk(folder, tmp_path, monkeypatch):
    with RecordingWriter(tmp_path / "a.mcap", ABOUT) as writer:
        for sample in samples(2000):
            writer.wrench(sample)
    monkeypatch.setattr("contactbench.pipeline.session.adoption.Recorder", partial(Recorder, most_waiting=5))
    address = f"replay://{tmp_path / 'a.mcap'}?speed=step"
    result = CliRunner().invoke(session_app, ["record", str(folder), "--source", address, "--json"])
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["dropped"] == 0
    [kept] = inputs(folder)
    assert kept.about["dropped"] == 0
    assert len(read_recording(folder / kept.file.path).wrenches["/wrench"].times) == 2000
