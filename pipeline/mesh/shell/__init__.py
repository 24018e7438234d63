"""From a hollow, open, doubled mesh to the closed surface that a finger could touch."""

from pipeline.mesh.shell.fit import ShellFit
from pipeline.mesh.shell.openings import Opening
from pipeline.mesh.shell.patch import Closing
from pipeline.mesh.shell.result import ClosedOpening, Shell
from pipeline.mesh.shell.shell import make_shell

__all__ = ["ClosedOpening", "Closing", "Opening", "Shell", "ShellFit", "make_shell"]
