"""The compiled core: header-only C++20 in ``include/``, bound once per instruction set.

The headers know neither Python nor any other library. This package loads the variant that the
processor can run; ``CONTACTBENCH_KERNEL=base`` forces the portable one. All variants give the same
bits: no operation is contracted or reordered.
"""

import importlib
import os

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import _cpu


def _variant() -> str:
    wanted = os.environ.get("CONTACTBENCH_KERNEL", "")
    available = [name for name in ("avx2",) if _cpu.features().get(name)] + ["base"]
    if wanted and wanted not in available:
        msg = f"CONTACTBENCH_KERNEL={wanted}: this machine can run {', '.join(available)}; unset it to choose by itself"
        raise InputError(msg)
    return wanted or available[0]


_module = importlib.import_module(f"contactbench.pipeline.kernel._kernel_{_variant()}")

variant: str = _module.variant
compiler: str = _module.compiler
Algorithm1 = _module.Algorithm1
Batch = _module.Batch
Candidate = _module.Candidate
Contact = _module.Contact
FrozenDetector = _module.FrozenDetector
Geodesic = _module.Geodesic
Iterative = _module.Iterative
Reason = _module.Reason
Runtime = _module.Runtime
RuntimeBatch = _module.RuntimeBatch
RuntimeContact = _module.RuntimeContact
Scan = _module.Scan
Solver = _module.Solver
SurfaceIndex = _module.SurfaceIndex
WrenchKalman = _module.WrenchKalman
Zero = _module.Zero
ZeroFollow = _module.ZeroFollow
ZeroWatch = _module.ZeroWatch
collapse_edges = _module.collapse_edges
crossings = _module.crossings
frozen = _module.frozen
kalman = _module.kalman
plain_rows = _module.plain_rows
poses_at = _module.poses_at

__all__ = [
    "Algorithm1",
    "Batch",
    "Candidate",
    "Contact",
    "FrozenDetector",
    "Geodesic",
    "Iterative",
    "Reason",
    "Runtime",
    "RuntimeBatch",
    "RuntimeContact",
    "Scan",
    "Solver",
    "SurfaceIndex",
    "WrenchKalman",
    "Zero",
    "ZeroFollow",
    "ZeroWatch",
    "collapse_edges",
    "compiler",
    "crossings",
    "frozen",
    "kalman",
    "plain_rows",
    "poses_at",
    "variant",
]
