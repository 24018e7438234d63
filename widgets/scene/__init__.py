"""The 3D view of the bench."""

from contactbench.widgets.scene.picking import Pick
from contactbench.widgets.scene.scene import Scene

__all__ = ["Pick", "Scene"]
