"""The C++ runtime library of this checkout: configured and built once, whoever asks first."""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCE, BUILD = ROOT / "pipeline/kernel/runtime", ROOT / "build/runtime"


def _tool(name: str) -> str | None:
    """Find a program, also one that came with a wheel."""
    beside = Path(sys.executable).parent / name
    return str(beside) if beside.exists() else shutil.which(name)


CMAKE = _tool("cmake")
needs_cmake = pytest.mark.skipif(CMAKE is None, reason="no cmake")


def run(*command: object, given: str = "") -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command], input=given, capture_output=True, text=True, check=False, timeout=300
    )


def cmake(*arguments: object) -> None:
    done = run(CMAKE, *arguments)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


@contextmanager
def locked(file: Path) -> Iterator[None]:
    """Let two workers do something one after the other."""
    with file.open("w") as lock:
        if sys.platform != "win32":
            import fcntl

            fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@cache
def built() -> Path:
    """Build library and tools, again only what changed, and return where; two workers do so one after the other."""
    if CMAKE is None:
        pytest.skip("no cmake")
    BUILD.mkdir(parents=True, exist_ok=True)
    with locked(BUILD / "lock"):
        # All sources in one: the same code in half the time. `packaging/compilers` compiles them one by one.
        unity = ("-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=0")
        cmake("-S", SOURCE, "-B", BUILD, "-DCONTACTBENCH_TOOLS=ON", "-DCMAKE_BUILD_TYPE=Release", *unity)
        cmake("--build", BUILD)
    return BUILD


def installed(prefix: Path) -> Path:
    """Install it into a folder, and return that."""
    cmake("--install", built(), "--prefix", prefix)
    return prefix
