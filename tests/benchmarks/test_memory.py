"""The memory of commands, short: what reads on stays flat, and what holds everything is seen to."""

import shutil
import sys

import pytest
from benchmarks import memory

pytestmark = pytest.mark.skipif(sys.platform not in ("linux", "darwin"), reason="rusage")


def test_reading_on_is_flat_and_holding_all_is_not(monkeypatch: pytest.MonkeyPatch, tutorial) -> None:
    monkeypatch.setattr(memory, "_call", lambda _, folder: shutil.copytree(tutorial.folder, folder))
    monkeypatch.setattr(memory, "_MORE_MB", 4.0)  # two copies more, held, take 7 MB
    report = memory.run((1, 3), ["record start from a replay", "record delay"])
    flat, held = report.figures
    assert flat.most is not None
    assert flat.passed, flat
    assert held.most is None
    assert held.measured > 5
    (sheet,) = report.sheets
    assert [row[0] for row in sheet.rows] == ["record start from a replay", "record delay"]
    assert all(30 < peak < 1_000 for row in sheet.rows for peak in row[1:3])


def test_a_process_that_takes_more_is_seen_to() -> None:
    small, large = (
        memory.peak([sys.executable, "-c", f"bytearray({size})"], (0,)) for size in (1, 50_000_000)
    )
    assert large - small == pytest.approx(50, abs=10)
