"""What happened where on a probe: contacts spread over its surface."""

from contactbench.pipeline.heatmap.bells import Bells
from contactbench.pipeline.heatmap.heatmap import Heatmap, HeatmapError, Normalisation, Quantity, heatmap

__all__ = ["Bells", "Heatmap", "HeatmapError", "Normalisation", "Quantity", "heatmap"]
