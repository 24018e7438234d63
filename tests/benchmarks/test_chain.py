"""The chain's benchmark, short: what is sealed in breaks out if it can, and no frame is lost on the way."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import native
import pytest
from benchmarks import chain
from benchmarks.bundle_example import example_config

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
    listed = subprocess.run(
        ["nm", "-D", "--undefined-only", native.built() / "libcontactbench_runtime.so"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
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


def test_nonsense_is_refused() -> None:
    with pytest.raises(InputError, match="minutes above 0"):
        chain.run(1.0, 0.0)
