"""Every kernel variant gives the same bits."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from contactbench.pipeline import kernel
from contactbench.pipeline.kernel import _cpu

_SCRIPT = """
import hashlib, sys
import numpy as np
from contactbench import assets
from contactbench.pipeline import kernel
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.mesh import Probe
from slides import draw_slide
from contactbench.pipeline.simulation import add_noise
rng = np.random.default_rng(1)
wrenches = add_noise(draw_slide(assets.surface("t-shape"), 5000, rng).wrenches, WrenchNoise(), rng)
vertices, faces = assets.make("t-shape", 2000)
solver = ContactSolver(Probe.from_arrays(vertices, faces))
digest = hashlib.sha256()
for batch in (solver.locate_batch(wrenches), solver.track_batch(wrenches)):
    for name in ("points", "normals", "torques", "faces", "vertices", "reasons", "candidates", "covariances",
                 "misfits", "left_overs", "arms", "confidences", "seconds", "accepted"):
        digest.update(np.ascontiguousarray(getattr(batch, name)).tobytes())
sys.stdout.write(kernel.variant + " " + digest.hexdigest())
"""


def _run(variant: str) -> list[str]:
    environment = os.environ | {"CONTACTBENCH_KERNEL": variant}
    done = subprocess.run(
        [sys.executable, "-c", _SCRIPT],
        env=environment,
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    return done.stdout.split()


def test_same_bits_on_every_instruction_set():
    if not _cpu.features().get("avx2"):
        pytest.skip("this processor can run only the portable kernel")
    portable, fast = _run("base"), _run("avx2")
    assert (portable[0], fast[0]) == ("base", "avx2")
    assert portable[1] == fast[1]


def test_an_unknown_variant_is_refused():
    done = subprocess.run(
        [sys.executable, "-c", "import contactbench.pipeline.kernel"],
        env=os.environ | {"CONTACTBENCH_KERNEL": "sse9"},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode != 0
    assert "this machine can run" in done.stderr
    assert kernel.compiler
