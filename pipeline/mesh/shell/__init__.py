"""From a hollow, open, doubled mesh to the closed surface that a finger could touch."""

from contactbench.pipeline.mesh.shell.result import ClosedOpening, Shell
from contactbench.pipeline.mesh.shell.rim import Closing, Opening
from contactbench.pipeline.mesh.shell.shell import make_shell
from contactbench.pipeline.mesh.shell.wrap import ShellFit

__all__ = ["ClosedOpening", "Closing", "Opening", "Shell", "ShellFit", "make_shell"]
