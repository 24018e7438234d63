"""The 3D view of the bench."""

from contactbench.widgets.scene.contact_layer import TouchErrors
from contactbench.widgets.scene.mouse import Pick
from contactbench.widgets.scene.scene import Scene

__all__ = ["Pick", "Scene", "TouchErrors"]
