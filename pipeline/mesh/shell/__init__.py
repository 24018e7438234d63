"""From a hollow, open, doubled mesh to the closed surface that a finger could touch."""

from contactbench.pipeline.mesh.shell.result import ClosedOpening, Shell, left_open
from contactbench.pipeline.mesh.shell.rim import Closing, Opening
from contactbench.pipeline.mesh.shell.shell import Steps, find_mouths, make_shell
from contactbench.pipeline.mesh.shell.wrap import ShellFit

__all__ = [
    "ClosedOpening",
    "Closing",
    "Opening",
    "Shell",
    "ShellFit",
    "Steps",
    "find_mouths",
    "left_open",
    "make_shell",
]
