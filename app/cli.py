"""The command line with the window: what :mod:`contactbench.pipeline.cli` has, and the commands that open one."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from contactbench.app.study import study_app
from contactbench.pipeline.cli import app
from contactbench.pipeline.errors import InputError

__all__ = ["app", "main"]

app.add_typer(study_app, name="gui-study")


def main() -> None:
    """Run the command line; without arguments, open the window. The entry point of ``contactbench``."""
    if len(sys.argv) == 1:
        sys.argv.append("gui")
    app()


@app.command(
    help="Open the window: calibrate, prepare, verify and export at the bench. contactbench alone does the same.",
    epilog="Example: contactbench gui --virtual",
)
def gui(
    session: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Session to open; with --virtual, made if it is missing."),
    ] = None,
    virtual: Annotated[bool, typer.Option("--virtual", help="Begin with a virtual bench.")] = False,
    language: Annotated[
        str, typer.Option(metavar="CODE", help="Language, such as de or en [the computer's].")
    ] = "",
) -> None:
    """Open the window."""
    check_screen()
    from contactbench.app.application import run

    raise typer.Exit(run(session, virtual=virtual, language=language))


@app.command(
    name="heatmap-viewer",
    help="Look at heatmaps in a window: play back, compare, read values, save pictures and films.",
    epilog="Example: contactbench heatmap-viewer my-session",
)
def heatmap_viewer(
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="[FILES]...", help="Recordings, contacts or sessions.")
    ] = None,
) -> None:
    """Open the heatmap viewer."""
    check_screen()
    from contactbench.app.application import prepared

    application = prepared()
    from contactbench.app.heatmap_viewer import run
    from contactbench.app.settings import Settings
    from contactbench.app.translation import load
    from contactbench.widgets.theme import use_theme

    remembered = Settings().now
    load(application, remembered.language)
    use_theme(remembered.theme)
    raise typer.Exit(run(list(files or ())))


@app.command(
    help="Make the README's pictures by driving the real window.",
    epilog="Example: contactbench screenshots pictures --theme both --pages gravity,verify",
)
def screenshots(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="Folder to write.")],
    theme: Annotated[str, typer.Option(metavar="NAME", help="light, dark or both.")] = "light",
    size: Annotated[str, typer.Option(metavar="WxH", help="Of the window, px.")] = "1280x800",
    pages: Annotated[
        str, typer.Option(metavar="NAME,...", help="Of start, the six steps, motion and heatmap [all].")
    ] = "",
    language: Annotated[str, typer.Option(metavar="CODE", help="Language, such as de.")] = "en",
) -> None:
    """Make pictures."""
    check_screen()
    made = import_module("contactbench.app.screenshots")
    themes = made.THEMES if theme == "both" else (theme,)
    wanted = tuple(pages.split(",")) if pages else made.PAGES
    raise typer.Exit(made.run(out, themes, size_of(size), wanted, language))


def size_of(text: str) -> tuple[int, int]:
    """Return width and height, px; InputError."""
    width, _, height = text.partition("x")
    if not (width.isascii() and height.isascii() and width.isdigit() and height.isdigit()):
        raise InputError(f"--size {text}: give width and height in px, such as 1280x800.")
    return int(width), int(height)


def check_screen() -> None:
    """InputError, with the remedy, if no window can be opened: Qt itself would end the process without a word."""
    missing = [
        name for name in ("PySide6", "pyvista", "pyvistaqt", "pyqtgraph", "superqt") if not find_spec(name)
    ]
    if missing:
        raise InputError(
            f"the window needs {', '.join(missing)}, which is not installed: run pip install 'contactbench[gui]'."
            " All other commands work without it."
        )
    chosen = os.environ.get("QT_QPA_PLATFORM", "")
    if sys.platform.startswith("linux") and chosen.partition(":")[0] not in ("offscreen", "minimal", "vnc"):
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            raise InputError(
                "no screen: neither DISPLAY nor WAYLAND_DISPLAY is set, so no window can be opened: start it in a"
                " desktop session, or with ssh -X. The other commands (contactbench --help) need no screen."
            )


if __name__ == "__main__":
    main()
