"""Sensors read while they stream, and the same bytes from memory."""

import os
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.live.reader import GIVEN, GIVEN_TYPE, SENT, SENT_TYPE, read_back, resident
from benchmarks.live.trial import Sleeper, compare

from contactbench.pipeline.devices.protocols.sri import sri_frame
from contactbench.pipeline.errors import InputError

pytestmark = pytest.mark.alone  # it judges how soon things happen

needs_pty = pytest.mark.skipif(os.name == "nt", reason="pseudo-terminals")


def values(number):
    return (float(number), -1.5, 0.1, 2.0, -0.25, 0.0)


def sent(count, first=0):
    frames = (sri_frame(values(n), first + n) for n in range(count))
    return np.frombuffer(
        b"".join(SENT.pack(10 + 0.001 * n, frame) for n, frame in enumerate(frames)), SENT_TYPE
    )


def given(numbers, late=0.002, change=lambda _, row: row):
    rows = []
    for n in numbers:
        row = struct.unpack("<6f", struct.pack("<6f", *change(n, values(n))))
        rows.append(GIVEN.pack(10 + 0.001 * n + late, n, *row))
    return np.frombuffer(b"".join(rows), GIVEN_TYPE)


class TestCompare:
    def test_all_given(self):
        pair = compare(sent(100), given(range(100)), 11.0)
        assert (pair.sent, pair.lost, pair.changed) == (100, 0, 0)
        assert pair.latency == pytest.approx(np.full(100, 0.002))

    def test_a_missing_frame_is_lost_the_first_ones_too(self):
        pair = compare(sent(100), given(n for n in range(2, 100) if n not in (7, 50)), 11.0)
        assert (pair.lost, pair.changed) == (4, 0)

    def test_what_was_sent_after_the_end_may_be_missing(self):
        pair = compare(sent(100), given(range(91)), 10.0901)
        assert (pair.sent, pair.lost) == (91, 0)

    def test_another_value_is_a_change_and_a_loss(self):
        pair = compare(
            sent(100), given(range(100), change=lambda n, row: (*row[:5], 1e-3) if n == 5 else row), 11.0
        )
        assert (pair.lost, pair.changed) == (1, 1)

    @pytest.mark.parametrize("wrong", [-1, 100, 2**40])
    def test_a_sample_that_was_never_sent(self, wrong):
        numbers = list(range(100))
        numbers[40] = wrong
        rows = given(numbers).copy()
        rows["values"] = given(range(100))["values"]
        assert compare(sent(100), rows, 11.0).changed >= 1

    def test_a_sample_given_twice(self):
        pair = compare(sent(100), given([*range(50), *range(49, 100)]), 11.0)
        assert (pair.lost, pair.changed) == (0, 1)

    def test_the_frames_number_must_fit_too(self):
        assert compare(sent(100, first=3), given(range(100)), 11.0).changed == 100

    def test_nothing_to_compare(self):
        with pytest.raises(InputError, match="last longer"):
            compare(sent(100), given([]), 11.0)
        with pytest.raises(InputError, match="last longer"):
            compare(sent(0), given(range(5)), 11.0)


def test_records_keep_what_is_written(tmp_path):
    path = tmp_path / "sent.bin"
    frame = sri_frame((1.0, -2.0, 3.5, 0.1, -0.2, 0.05), 513)
    path.write_bytes(SENT.pack(1.25, frame) * 2)
    rows = read_back(path, SENT_TYPE)
    assert rows["at"].tolist() == [1.25, 1.25]
    assert rows["number"].tolist() == [513, 513]
    assert rows["values"][0].tolist() == np.float32([1.0, -2.0, 3.5, 0.1, -0.2, 0.05]).tolist()
    assert rows["sum"][0] == frame[-1]
    path.write_bytes(SENT.pack(1.25, frame)[:-1])
    with pytest.raises(InputError, match=r"sent\.bin: the last record is cut off"):
        read_back(path, SENT_TYPE)


@pytest.mark.skipif(sys.platform != "linux", reason="where the system says it in /proc")
def test_memory_that_is_used_is_seen():
    before = resident()
    kept = np.ones(8_000_000)  # over 32 MiB, or it may lie where something freed lay
    assert resident() - before > 0.9 * kept.nbytes


def test_a_sleeper_is_never_early():
    sleeper = Sleeper()
    assert sleeper.late == 0
    with sleeper:
        while sleeper.late == 0:
            pass
    assert sleeper.late > 0


@needs_pty
def test_a_sensor_that_cannot_start_is_named(monkeypatch, tmp_path):
    from benchmarks.live import trial

    (tmp_path / "broken").write_text("#!/bin/sh\nexit 3\n", encoding="utf-8")
    Path(tmp_path / "broken").chmod(0o755)
    monkeypatch.setattr(trial.sys, "executable", str(tmp_path / "broken"))
    with pytest.raises(InputError, match="did not start"), trial.sensor_process(tmp_path / "sent.bin", 100.0):
        pass
