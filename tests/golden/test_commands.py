"""What commands print and write, byte for byte, from sample data to a session and a bundle."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from golden.recorder import COMMANDS

# NumPy and OpenBLAS round as they do on processors without AVX-512, whatever this one has.
_ROUNDED = {"NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR", "OPENBLAS_CORETYPE": "Haswell"}


@pytest.fixture(scope="module")
def said(tmp_path_factory):
    pytest.importorskip("mujoco", reason="the sample data comes from the virtual bench (extra sim)")
    folder = tmp_path_factory.mktemp("golden") / "work"
    recorder = Path(__file__).with_name("recorder.py")
    subprocess.run([sys.executable, recorder, folder], check=True, env=os.environ | _ROUNDED, timeout=500)
    return folder.with_name("work.said")


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_gives_what_it_gave(said, pin, name):
    pin(name, (said / f"{name}.txt").read_text(encoding="utf-8"))
