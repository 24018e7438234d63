"""
How this copy came here: as a Python package, or as the application that needs no Python.

The application is one program: there is no interpreter to be called with ``-m``, and nothing to install a package
into. Whatever depends on the difference asks here.
"""

import runpy
import sys
from collections.abc import Sequence
from pathlib import Path

# The first word of the command line by which the application runs a module instead of a command.
_MODULE = "--run-module"
# What the application runs in processes of its own, and nothing else.
MODULES = ("contactbench.pipeline.cli", "contactbench.pipeline.mesh.engines.worker")


def is_application() -> bool:
    """Tell whether this is the application, and not a Python package."""
    return bool(getattr(sys, "frozen", False))


def module_command(module: str, *arguments: str) -> list[str]:
    """
    Return the command that runs one of `MODULES` in a process of its own.

    Parameters
    ----------
    module : str
        One of `MODULES`.
    *arguments : str
        What follows it on the command line.

    Raises
    ------
    ValueError
        The module is none of `MODULES`, so that the application could not run it.
    """
    if module not in MODULES:
        raise ValueError(f"{module} is not in MODULES: add it, for the application runs nothing else.")
    if is_application():
        return [sys.executable, _MODULE, module, *arguments]
    # -P: a file called numpy.py in the current folder must not be imported.
    return [sys.executable, "-P", "-m", module, *arguments]


def run_asked_module(words: Sequence[str]) -> bool:
    """
    Run the module that `module_command` asked for; the application calls it before anything else.

    Parameters
    ----------
    words : sequence of str
        The command line, with the program's name.

    Returns
    -------
    bool
        False: the command line asks for no module.
    """
    if len(words) < 3 or words[1] != _MODULE or words[2] not in MODULES:
        return False
    program, _, module, *rest = words
    sys.argv = [program, *rest]
    runpy.run_module(module, run_name="__main__")
    return True


def remedy(extra: str) -> str:
    """Return what to do, as an imperative, where a package that an extra brings is missing."""
    if not is_application():
        return f"pip install 'contactbench[{extra}]'"
    if extra in COMPONENTS:
        return f"install the component {extra} (contactbench-{extra}) of the same version"
    return f"use the Python package instead of this application: pip install 'contactbench[{extra}]'"


# Extras that are installed beside the application, because their licence differs from its own.
COMPONENTS = ("meshlab",)


def component_folders(name: str) -> list[Path]:
    """Return where the packages of a component may be: beside the application, or in the user's own folder."""
    if not is_application():
        return []
    from platformdirs import user_data_path

    beside = Path(sys.executable).parent
    own = user_data_path("contactbench", appauthor=False)
    return [place / "components" / name for place in (beside, own)]


def processor() -> str:
    """Return the name of this machine's processor, as well as the system says it."""
    import platform

    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass  # not Linux
    return platform.processor() or platform.machine() or "unknown"
