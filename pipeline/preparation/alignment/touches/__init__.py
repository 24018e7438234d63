"""The mount from touches of marked points."""

from contactbench.pipeline.preparation.alignment.touches.align import TouchAlignment, align_touches
from contactbench.pipeline.preparation.alignment.touches.crossval import Advice, CrossValidation
from contactbench.pipeline.preparation.alignment.touches.marker import MarkerTouches
from contactbench.pipeline.preparation.alignment.touches.solve import MountBelief

__all__ = ["Advice", "CrossValidation", "MarkerTouches", "MountBelief", "TouchAlignment", "align_touches"]
