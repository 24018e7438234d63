"""Where the probe's mesh lies in the sensor frame: typed, by points, by the flange, by its shape, by touches."""

from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    AlignmentMethod,
    check_transform,
    from_angles,
    from_json,
    from_transform,
    load_alignment,
)
from contactbench.pipeline.preparation.alignment.axes import align_axes
from contactbench.pipeline.preparation.alignment.flange import align_flange, find_mounting_face
from contactbench.pipeline.preparation.alignment.points import align_frame, align_points
from contactbench.pipeline.preparation.alignment.touches.align import Advice, TouchAlignment, align_touches
from contactbench.pipeline.preparation.alignment.touches.fit import (
    MarkerTouches,
    MountBelief,
    TouchFileError,
    read_touches,
)

__all__ = [
    "Advice",
    "Alignment",
    "AlignmentError",
    "AlignmentMethod",
    "MarkerTouches",
    "MountBelief",
    "TouchAlignment",
    "TouchFileError",
    "align_axes",
    "align_flange",
    "align_frame",
    "align_points",
    "align_touches",
    "check_transform",
    "find_mounting_face",
    "from_angles",
    "from_json",
    "from_transform",
    "load_alignment",
    "read_touches",
]
