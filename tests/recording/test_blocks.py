"""Recordings that are read block by block: the same to the byte as when they are in memory as a whole, and flat."""

import errno
import io
import json
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording.recording_cases import ABOUT, record
from scipy.spatial.transform import Rotation

from contactbench.pipeline import kernel
from contactbench.pipeline.devices.sample import FROZEN_CHANCE, FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import (
    RecordingError,
    RecordingReader,
    RecordingWriter,
    WrenchTrack,
    contents,
    read_recording,
    reader,
)
from contactbench.pipeline.recording.contents import LATE_S, Spill, Table, percentile, read_contents
from contactbench.pipeline.recording.convert import poses_at, write_csv, write_npz
from contactbench.pipeline.recording.reader import Repeats, columns_of, part
from contactbench.pipeline.tables.shortest import csv_rows

SIZES = (1, 7, 100_000)
COUNT = 1300


def eventful(file: Path) -> Path:
    """Write a recording with gaps, a clock that is set back, hung readings, and samples that lack something."""
    rng = np.random.default_rng(5)
    clock = count(step=0.0034)
    with RecordingWriter(file, ABOUT, clock=lambda: next(clock)) as writer:
        for number in range(COUNT):
            moment = 1000 + number / 500 - (1.5 if number > 700 else 0.0)
            hung = 400 <= number < 500 or 900 <= number < 904 or number > 1200
            if not hung:
                row = rng.normal(size=6)
            force, torque = tuple(row[:3].tolist()), tuple(row[3:].tolist())
            time = moment + (0.04 if 800 < number < 804 else 0.0)
            status = Status.OVERRANGE if number % 97 == 0 else Status.LATE if number % 55 == 0 else Status.OK
            sequence = None if number < 500 else number + 3 * (number > 650)
            wrench = WrenchSample(time, force, torque, sequence, status, None, 20.5 + number * 1e-4)
            late = 0.0 if number % 10 else rng.gamma(2, 0.02)
            writer.wrench(
                replace(wrench, force=(np.nan, 0.0, 0.0))
                if number in (5, 345, 850)
                else replace(wrench, arrival=time + late)
            )
            if number % 5 == 3 and not 1000 < number < 1160:
                R = Rotation.from_rotvec([number * 1e-3, 0.3, np.sin(number * 1e-2)]).as_matrix()
                p = np.array([number * 1e-3, 0.0, np.nan if number % 40 == 3 else 1.0])
                joints = None if number < 500 else rng.normal(size=7 if 800 < number < 1000 else 6)
                off = rng.normal() * 0.01
                writer.flange(FlangeSample(moment + off, R, p, joints, None if number % 3 else number * 0.1))
            if number % 250 == 0:
                writer.event("mark", {"n": number, "ü": [1, 2]}, moment)
    return file


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return eventful(tmp_path_factory.mktemp("blocks") / "r.mcap")


@pytest.fixture
def blocks_of(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Return what sets the size of the blocks, and puts all that is put aside on the disk."""
    monkeypatch.setattr(contents, "IN_MEMORY", 1)
    return lambda size: monkeypatch.setattr(reader, "BLOCK_ROWS", size)


def whole_table(file: Path) -> tuple[bytes, int, int]:
    """Return the rows of the sensor's table from the whole; and how many readings are bad, and without a pose."""
    found = read_recording(file)
    (track,), (flange,) = found.wrenches.values(), found.flanges.values()
    poses, there = poses_at(flange, track.times)
    kept = track.usable & there
    columns = [*np.column_stack((track.times, track.wrenches, poses))[kept].T, track.status[kept].astype("S")]
    if np.isfinite(track.temperature).all():
        columns.append(track.temperature[kept])
    return csv_rows(*columns), int((~track.usable).sum()), int((track.usable & ~there).sum())


def test_the_whole_knows_hung_readings_and_gaps(file: Path) -> None:
    found = read_recording(file)
    (track,), (flange,) = found.wrenches.values(), found.flanges.values()
    assert track.frozen[399:500].all()
    assert not track.frozen[900:904].any()
    assert track.frozen[-1]
    assert flange.joints.shape[1] == 7
    _, bad, lost = whole_table(file)
    assert bad > 200
    assert lost > 50
    assert (np.diff(flange.times) < 0).any()


@pytest.mark.parametrize("size", SIZES)
def test_a_table_of_blocks_is_that_of_the_whole(
    file: Path, tmp_path: Path, size: int, blocks_of: Callable[[int], None]
) -> None:
    rows, bad, lost = whole_table(file)
    blocks_of(size)
    done = write_csv(tmp_path / "r.csv", file)
    header, _, body = (tmp_path / "r.csv").read_bytes().partition(b"\n")
    assert header == b"t,fx,fy,fz,mx,my,mz,qw,qx,qy,qz,px,py,pz,status,temperature"
    assert body == rows
    assert [said.split()[0] for said in done.left_out] == [f"{bad:,}", f"{lost:,}"]


@pytest.mark.parametrize("size", SIZES)
def test_poses_of_blocks_are_those_of_the_whole(
    file: Path, tmp_path: Path, size: int, blocks_of: Callable[[int], None]
) -> None:
    blocks_of(100_000)
    write_csv(tmp_path / "whole.csv", file, "/flange")
    blocks_of(size)
    write_csv(tmp_path / "r.csv", file, "/flange")
    assert (tmp_path / "r.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


@pytest.mark.parametrize("size", SIZES)
def test_arrays_of_blocks_are_those_of_the_whole(
    file: Path, tmp_path: Path, size: int, blocks_of: Callable[[int], None]
) -> None:
    found = read_recording(file)
    blocks_of(size)
    write_npz(tmp_path / "r.npz", file)
    with np.load(tmp_path / "r.npz", allow_pickle=False) as stored:
        facts = {name: stored[name] for name in ("topics", "about", "events")}
    tracks = enumerate((*found.wrenches.values(), *found.flanges.values()))
    arrays = {f"{n}/{name}": values for n, track in tracks for name, values in columns_of(track).items()}
    expected = io.BytesIO()
    np.savez(expected, **facts, **arrays)
    assert (tmp_path / "r.npz").read_bytes() == expected.getvalue()
    assert len(json.loads(facts["events"].tobytes())) == len(found.events) == 6


@pytest.mark.parametrize("size", SIZES)
def test_what_is_counted_in_blocks_is_what_the_whole_says(
    file: Path, size: int, blocks_of: Callable[[int], None]
) -> None:
    found = read_recording(file)
    (track,), (flange,) = found.wrenches.values(), found.flanges.values()
    blocks_of(size)
    contents = read_contents(file)
    wrench, pose = contents.topics
    late = (track.arrivals - track.times)[np.isfinite(track.arrivals)]
    steps = np.diff(track.sequence[track.sequence >= 0])
    assert wrench["samples"] == COUNT
    assert wrench["seconds"] == np.ptp(track.times)
    assert [wrench["latency_median"], wrench["latency_p99"]] == np.percentile(late, (50, 99)).tolist()
    assert wrench["late"] == (late > LATE_S).sum() > 0
    assert wrench["lost"] == (steps - 1)[steps > 1].sum() == 3
    assert wrench["unusable"] == (~track.usable).sum()
    assert wrench["frozen"] == track.frozen.sum()
    assert wrench["flags"] == {"overrange": (track.status == 1).sum(), "late": (track.status == 8).sum()}
    assert (pose["samples"], pose["joints"], pose["latency_p99"]) == (len(flange.times), 7, None)
    assert contents.events == 6


@pytest.mark.parametrize("size", SIZES)
def test_the_whole_is_made_of_blocks_of_any_size(
    file: Path, size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = read_recording(file)
    monkeypatch.setattr(reader, "BLOCK_ROWS", size)
    other = read_recording(file)
    for one, two in zip(
        (*whole.wrenches.values(), *whole.flanges.values()),
        (*other.wrenches.values(), *other.flanges.values()),
        strict=True,
    ):
        for name, values in columns_of(one).items():
            np.testing.assert_array_equal(columns_of(two)[name], values, strict=True)
    (track,) = whole.wrenches.values()
    with RecordingReader(file) as samples:
        given = [repr(sample) for _, sample in samples if isinstance(sample, WrenchSample)]
    assert [repr(sample) for sample in track.samples()] == given


@pytest.mark.parametrize("size", SIZES)
def test_a_cut_and_damaged_file_gives_the_same_and_says_the_same(
    file: Path, tmp_path: Path, size: int, blocks_of: Callable[[int], None]
) -> None:
    data = bytearray(file.read_bytes())
    data[len(data) // 3] ^= 0x40
    hurt = tmp_path / "hurt.mcap"
    hurt.write_bytes(data[: len(data) * 4 // 5])
    rows, *_ = whole_table(hurt)
    warnings = read_recording(hurt).warnings
    assert len(warnings) == 3  # the clock was set back, too
    blocks_of(size)
    done = write_csv(tmp_path / "r.csv", hurt)
    assert (tmp_path / "r.csv").read_bytes().partition(b"\n")[2] == rows
    assert done.warnings == warnings == read_contents(hurt).warnings
    assert not done.complete


# ---- poses at the borders ------------------------------------------------------------------------


@pytest.mark.parametrize("size", [1, 2, 3, 5])
@pytest.mark.parametrize("behind", [0, 4, 40])
def test_poses_may_come_long_before_or_after_their_readings(
    tmp_path: Path, size: int, behind: int, blocks_of: Callable[[int], None]
) -> None:
    poses = [
        FlangeSample(1000 + n / 10, Rotation.from_rotvec([0.1 * n, 0.0, 0.2]).as_matrix(), np.zeros(3))
        for n in range(12)
    ]
    readings = [
        WrenchSample(1000 + time, (n, 0.0, 1.0), (0.0, 0.0, 0.0))
        # On a pose, between two, before the first, behind the last; and a little back.
        for n, time in enumerate([-0.1, 0.0, 0.05, 0.1, 0.25, 0.4, 0.4, 0.55, 0.95, 1.05, 1.1, 1.08, 1.15])
    ]
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for number in range(max(len(poses) + behind, len(readings))):
            if number < len(readings):
                writer.wrench(readings[number])
            if behind <= number < len(poses) + behind:
                writer.flange(poses[number - behind])
    whole, _, lost = whole_table(tmp_path / "r.mcap")
    assert lost == 2
    blocks_of(size)
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap")
    assert (tmp_path / "r.csv").read_bytes().partition(b"\n")[2] == whole


# ---- hung readings -------------------------------------------------------------------------------


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 3), st.integers(1, 300)), max_size=12), st.integers(1, 400))
def test_frozen_readings_are_the_same_in_blocks(runs: list[tuple[int, int]], size: int) -> None:
    values = [value for value, length in [(9, 1), *runs] for _ in range(length)]
    wrenches = np.repeat(np.array(values, dtype=float)[:, None], 6, axis=1)
    wrenches[wrenches == 3] = np.nan
    nothing, none = np.full(len(values), np.nan), np.zeros(len(values), dtype=np.int64)
    track = WrenchTrack(np.arange(len(values)) / 100, wrenches, none, none, nothing, nothing, nothing)
    repeats = Repeats()
    parts = [repeats.add(part(track, slice(row, row + size))) for row in range(0, len(values), size)]
    parts.extend(repeats.end())
    np.testing.assert_array_equal(np.concatenate([each.times for each in parts]), track.times)
    np.testing.assert_array_equal(
        np.concatenate([each.frozen for each in parts]), kernel.frozen(wrenches, FROZEN_CHANCE)
    )


# ---- percentiles ---------------------------------------------------------------------------------


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(-1e9, 1e9) | st.sampled_from([0.001, 0.002]), min_size=1, max_size=60),
    st.integers(1, 20),
)
def test_percentiles_are_numpys_to_the_bit(numbers: list[float], size: int) -> None:
    values = np.array(numbers) + 0.0  # no -0.0: a difference of times is none
    with Spill() as file:
        table = Table(file)
        for begin in range(0, len(values), size):
            table.add({"x": values[begin : begin + size]})
        for share in (0, 50, 99, 100):
            assert percentile(table, "x", share) == np.percentile(values, share)


def test_of_nothing_there_is_no_percentile() -> None:
    with Spill() as file:
        assert percentile(Table(file), "x", 50) is None


# ---- memory --------------------------------------------------------------------------------------


def most(work: Callable[[], Any]) -> int:
    """Return the most bytes that Python and NumPy held during some work, beyond those before."""
    work()  # what is imported or kept once
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("ending", ["info", "csv", "npz"])
def test_memory_is_flat_in_the_length(tmp_path: Path, ending: str, blocks_of: Callable[[int], None]) -> None:
    def work(source: Path) -> Callable[[], Any]:
        out = tmp_path / f"r.{ending}"
        convert = {"csv": write_csv, "npz": write_npz}
        return (lambda: read_contents(source)) if ending == "info" else lambda: convert[ending](out, source)

    blocks_of(64)
    short, long = (record(tmp_path / f"{n}.mcap", 2 * n, n) for n in (500, 2_000))
    more = most(work(long)) - most(work(short))
    found = read_recording(long)
    tracks = (*found.wrenches.values(), *found.flanges.values())
    held = sum(values.nbytes for track in tracks for values in columns_of(track).values())
    assert held > 700_000
    assert more < held / 3


# ---- what goes wrong -----------------------------------------------------------------------------


class Full(io.BytesIO):
    """A disk that has no room for more than a few blocks."""

    def write(self, data: Any, /) -> int:
        if self.tell() > 10_000:
            raise OSError(errno.ENOSPC, "No space left on device")
        return super().write(data)

    def close(self) -> None:
        """As a file does that still holds bytes: it tries to write them."""
        super().close()
        raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("convert", [write_csv, write_npz])
def test_a_full_disk_is_named_and_what_was_there_stays(
    file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    convert: Any,
    blocks_of: Callable[[int], None],
) -> None:
    blocks_of(64)
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    monkeypatch.setattr(contents.tempfile, "SpooledTemporaryFile", lambda *_, **__: Full())
    with pytest.raises(
        RecordingError, match=r"put aside there .*No space left on device.*: free disk space"
    ) as told:
        convert(tmp_path / "out", file)
    assert str(tmp_path) in str(told.value)
    assert [(each.name, each.read_text(encoding="utf-8")) for each in tmp_path.iterdir()] == [("out", "mine")]
    with pytest.raises(RecordingError, match=r"the temporary folder: .*No space left"):
        read_contents(file)


@pytest.mark.parametrize("convert", [write_csv, write_npz])
@pytest.mark.parametrize("stop", [KeyboardInterrupt, RecordingError])
def test_a_conversion_that_is_broken_off_leaves_what_was_there(
    file: Path, tmp_path: Path, convert: Any, stop: type[BaseException], blocks_of: Callable[[int], None]
) -> None:
    def progress(done: int, total: int) -> None:
        if done > total / 2:
            raise stop

    blocks_of(64)
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    with pytest.raises(stop):
        convert(tmp_path / "out", file, progress=progress)
    assert [(each.name, each.read_text(encoding="utf-8")) for each in tmp_path.iterdir()] == [("out", "mine")]
