"""Mutated bundles: the loader in C++ accepts exactly those that the loader here accepts."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import native
import pytest
from benchmarks.bundle_fuzz import run

from contactbench.pipeline.errors import InputError


def out_of(*command: object) -> str:
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.fixture(scope="module")
def loader() -> Path:
    return native.built() / "contactbench-load_all"


def test_both_loaders_come_to_the_same_verdict(loader: Path) -> None:
    # In a process of its own: the most memory that this one ever used says nothing of bundles.
    code = (
        "import json, sys; from pathlib import Path; from benchmarks.bundle_fuzz import run;"
        " print(json.dumps(run(150, seed=7, cpp=Path(sys.argv[1])).to_json()))"
    )
    report = json.loads(out_of(sys.executable, "-c", code, loader))
    tried, _, _, other, compared, wrong, slowest, largest = (each["measured"] for each in report["figures"])
    assert wrong == 0, report["notes"]
    assert slowest < 20.0  # none hangs; the command holds it to its target
    assert largest < 500
    assert compared > 0.7 * tried
    assert other > 0.02 * tried  # not all are refused, for whatever reason


def test_a_loader_that_takes_everything_is_noticed(tmp_path: Path) -> None:
    program = tmp_path / "load_all"
    program.write_text(
        '#!/bin/sh\nfor each in "$1"/*; do echo "${each##*/} loaded"; done; echo slowest x 0.1 s >&2\n',
        encoding="utf-8",
    )
    program.chmod(0o755)
    report = run(20, seed=7, cpp=program)
    assert report.figures[5].measured > 10
    assert "refused here, in C++: loaded" in report.notes[1]
    with pytest.raises(InputError, match="build contactbench-load_all"):
        run(2, seed=7, cpp=tmp_path / "none")
