"""The 3D view of the bench."""

from widgets.scene.picking import Pick
from widgets.scene.scene import Scene

__all__ = ["Pick", "Scene"]
