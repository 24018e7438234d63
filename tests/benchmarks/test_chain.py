"""The chain's benchmark, short: what is sealed in breaks out if it can, and no frame is lost on the way."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import native
import pytest
from benchmarks import chain
from benchmarks.bundle_example import example_config
from benchmarks.bundle_fuzz import mutants, run

from contactbench.pipeline.errors import InputError

pytestmark = [
    native.needs_cmake,
    pytest.mark.skipif(sys.platform != "linux" or shutil.which("g++") is None, reason="Linux and g++"),
]
FRAMES = 4_000


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, int]:
    """Where a bundle and its frames are, the program, and how many contacts Python accepts."""
    folder = tmp_path_factory.mktemp("chain")
    config = example_config(1_000)
    config.write(folder / "bundle")
    accepted = chain.write_frames(folder / "frames", config, FRAMES)
    return folder, chain.build(folder), accepted


def test_updates_ask_neither_the_heap_nor_a_lock_nor_the_kernel(place: tuple[Path, Path, int]) -> None:
    folder, program, accepted = place
    said = chain.sealed(program, folder)
    assert said["tracked"] > 500
    assert 500 < accepted == said["accepted"]
    assert (said["updates"], said["requests"], said["locks"]) == (FRAMES, 0, 0)


def test_whoever_does_is_found_out(place: tuple[Path, Path, int]) -> None:
    folder, program, _ = place
    assert chain.sealed(program, folder, "malloc")["requests"] == 1
    assert chain.sealed(program, folder, "lock")["locks"] == 1
    with pytest.raises(InputError, match="ended with -9"):
        chain.sealed(program, folder, "syscall")


def test_the_library_knows_no_lock() -> None:
    """It asks nobody for one: not for a static variable either, which is made under a guard."""
    listed = out_of("nm", "-D", "--undefined-only", native.built() / "libcontactbench_runtime.so")
    assert "memcpy" in listed
    for name in ("pthread", "guard_acquire", "sem_", "mtx_", "futex", "syscall"):
        assert name not in listed, name


@pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="cores cannot be chosen")
@pytest.mark.parametrize("way", [chain.Way(0), chain.Way(busy=True)])
def test_every_frame_comes_to_a_contact(place: tuple[Path, Path, int], way: chain.Way) -> None:
    folder, program, _ = place
    times, said = chain.timed(program, folder, 500, way)
    assert (said["done"], said["came"]) == (500, 500)
    for earlier, later in (("sent", "received"), ("received", "located"), ("located", "published")):
        assert (times[later] >= times[earlier]).all()
    assert (times["used"] > 0).all()


# ---- mutated bundles: the loader in C++ accepts exactly those that the loader here accepts -------


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


# ---- mutated bundles: a short run, and the set that other loaders are fed with -------------------


def test_every_mutant_is_refused_with_a_typed_error_or_is_what_it_was():
    report = run(300, seed=5)
    tried, refused, same, other, _, wrong, *_ = (figure.measured for figure in report.figures)
    assert wrong == 0, report.notes
    assert refused > 240
    assert report.settings["kinds"] == 31
    assert refused + same + other == tried == 300


def test_the_same_seed_gives_the_same_mutants():
    assert list(mutants(20, 3)) == list(mutants(20, 3))
    assert list(mutants(20, 3)) != list(mutants(20, 4))
