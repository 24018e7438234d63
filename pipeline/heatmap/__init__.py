"""What happened where on a probe: contacts spread over its surface."""

from contactbench.pipeline.heatmap.heatmap import Bells, Heatmap, HeatmapError, heatmap

__all__ = ["Bells", "Heatmap", "HeatmapError", "heatmap"]
