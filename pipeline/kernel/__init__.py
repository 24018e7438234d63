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

__all__ = [name for name in vars(_module) if not name.startswith("_")]
globals().update({name: getattr(_module, name) for name in __all__})  # the stub says what they are
