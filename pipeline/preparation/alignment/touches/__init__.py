"""The mount from touches of marked points."""

from contactbench.pipeline.preparation.alignment.touches.align import (
    Advice,
    CrossValidation,
    TouchAlignment,
    align_touches,
)
from contactbench.pipeline.preparation.alignment.touches.fit import MarkerTouches, MountBelief

__all__ = ["Advice", "CrossValidation", "MarkerTouches", "MountBelief", "TouchAlignment", "align_touches"]
