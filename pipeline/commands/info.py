"""``contactbench info``: what is installed, and what this machine offers."""

import os
from typing import Any

from contactbench import __version__
from contactbench.pipeline.console import Noun, answer, as_json
from contactbench.pipeline.installation import processor

info_app = Noun()

# Name to import, and the distributions that provide it.
_OPTIONAL = {
    "embreex": ("embreex",),
    "pyvista": ("pyvista",),
    "PySide6": ("PySide6-Essentials", "PySide6"),
    "mujoco": ("mujoco",),
    "pymeshlab": ("pymeshlab",),
    "igl": ("libigl",),
}


@info_app.command(example="info --json")
def info() -> None:
    """Show versions, the compiled kernel in use, the processor, and the installed optional packages."""
    found = facts()
    answer(found)
    if as_json():
        return
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, show_header=False)
    for name, value in found.items():
        table.add_row(name.replace("_", " "), _plain(value))
    Console().print(table)


def facts() -> dict[str, Any]:
    """Tell what is installed, and what this machine offers."""
    import platform
    from importlib import import_module
    from importlib.util import find_spec

    from contactbench.pipeline import kernel
    from contactbench.pipeline.kernel.build import build

    built = build()
    optional = {
        name: _version(*distributions) if find_spec(name) else None
        for name, distributions in _OPTIONAL.items()
    }
    return {
        "contactbench": __version__,
        "python": platform.python_version(),
        **{name: _version(name) for name in ("numpy", "scipy", "manifold3d")},
        "platform": platform.platform(),
        "cpu": processor(),
        "cpu_count": os.cpu_count(),
        "cpu_features": dict(import_module("contactbench.pipeline.kernel._cpu").features()),
        "kernel": kernel.variant,
        "commit": built.commit,
        "build_type": built.kind,
        "compiler": kernel.compiler,
        "optional": optional,
    }


def _version(*distributions: str) -> str:
    from importlib.metadata import PackageNotFoundError, version

    for name in distributions:
        try:
            return version(name)
        except PackageNotFoundError:
            continue
    return "unknown version"


def _plain(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_plain(item)}" for name, item in value.items()) or "none"
    return {None: "absent", True: "yes", False: "no"}[value] if value in (None, True, False) else str(value)
