"""What happened where on a probe: contacts spread over its surface."""

from contactbench.pipeline.heatmap.heatmap import Heatmap, HeatmapError, heatmap
from contactbench.pipeline.heatmap.surface_kde import Bells

__all__ = ["Bells", "Heatmap", "HeatmapError", "heatmap"]
