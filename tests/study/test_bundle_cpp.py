"""Mutated bundles: what the loader here must refuse, the loader in C++ refuses too."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline.study.bundle_fuzz import write_mutants

ROOT = Path(__file__).parents[2]
BESIDE = Path(sys.executable).parent / "cmake"
CMAKE = str(BESIDE) if BESIDE.exists() else shutil.which("cmake")


def run(*command: object) -> str:
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.mark.skipif(CMAKE is None, reason="no cmake")
def test_cpp_refuses_what_python_refuses(tmp_path: Path) -> None:
    source, build = ROOT / "pipeline/kernel/runtime", ROOT / "build/runtime"
    run(CMAKE, "-S", source, "-B", build, "-DCONTACTBENCH_TOOLS=ON", "-DCMAKE_BUILD_TYPE=Release")
    run(CMAKE, "--build", build)
    assert write_mutants(tmp_path, 200, seed=7) > 100
    told = {file.stem: json.loads(file.read_text()) for file in tmp_path.glob("*.json")}
    for file in tmp_path.glob("*.json"):
        file.unlink()
    found = dict(line.split(" ", 1) for line in run(build / "contactbench-load_all", tmp_path).splitlines())
    assert sorted(found) == sorted(told)
    wrong = [
        (name, about["kind"])
        for name, about in told.items()
        if found[name] == "loaded" and about["expected"] == "refused"
    ]
    assert wrong == []
