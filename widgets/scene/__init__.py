"""The 3D view of the bench."""

from contactbench.widgets.scene.contact_layer import TouchErrors
from contactbench.widgets.scene.scene import Scene
from contactbench.widgets.scene.views import Pick

__all__ = ["Pick", "Scene", "TouchErrors"]
