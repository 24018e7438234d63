"""The command line with the window: what :mod:`contactbench.pipeline.cli` has, and the commands that open one."""

import sys
from dataclasses import replace

from contactbench.pipeline.cli import ENTRIES, Entry, app

__all__ = ["app", "main"]

ENTRIES["gui"] = Entry(
    "Begin",
    "contactbench.app.commands:gui_app",
    "Open the window for the bench; contactbench alone does it too",
)
ENTRIES["heatmap"] = replace(ENTRIES["heatmap"], place="contactbench.app.heatmap_commands:heatmap_app")


def main() -> None:
    """Run the command line; without arguments, open the window. The entry point of ``contactbench``."""
    if len(sys.argv) == 1:
        sys.argv.append("gui")
    app()


if __name__ == "__main__":
    main()
