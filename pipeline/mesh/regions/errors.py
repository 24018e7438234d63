"""What the regions package raises."""

from contactbench.pipeline.mesh.errors import MeshError


class RegionError(MeshError):
    """Regions, an edit of them, or a file of them that cannot be used: names what is wrong and the remedy."""
