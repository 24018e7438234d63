"""``contactbench gui``, and whether a window can be opened at all."""

import os
import sys
from importlib.util import find_spec
from pathlib import Path

import typer

from contactbench.pipeline.console import Noun
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.installation import remedy

gui_app = Noun()


@gui_app.command(example=("gui --virtual", "gui bench-1.contactbench"), as_json=False)
def gui(
    file: Path | None = None, /, session: Path | None = None, virtual: bool = False, language: str = ""
) -> None:
    """Open the window: calibrate, prepare, verify and export at the bench. contactbench alone does the same.

    Parameters
    ----------
    file : [SESSION]
        Session to open, or a session archive to unpack and open.
    session : DIR
        Session to open; with --virtual, made if it is missing.
    virtual
        Begin with a virtual bench.
    language : CODE
        Language, such as de or en [the computer's].
    """
    if file is not None and session is not None:
        raise typer.BadParameter("SESSION and --session contradict each other: give one.")
    check_screen()
    from contactbench.app.application import run

    raise typer.Exit(run(file or session, virtual=virtual, language=language))


def check_screen() -> None:
    """InputError, with the remedy, if no window can be opened: Qt itself would end the process without a word."""
    missing = [name for name in ("PySide6", "pyvista", "pyvistaqt", "pyqtgraph") if not find_spec(name)]
    if missing:
        raise InputError(
            f"the window needs {arg(', '.join(missing))}, which is not installed: {arg(remedy('gui'))}."
            " All other commands work without it."
        )
    chosen = os.environ.get("QT_QPA_PLATFORM", "")
    if sys.platform.startswith("linux") and chosen.partition(":")[0] not in ("offscreen", "minimal", "vnc"):
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            raise InputError(
                "no screen: neither DISPLAY nor WAYLAND_DISPLAY is set, so no window can be opened: start it in a"
                " desktop session, or with ssh -X. The other commands (contactbench --help) need no screen."
            )
