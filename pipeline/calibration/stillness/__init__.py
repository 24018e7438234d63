"""When a reading is settled, how long to average it, and which captures to refuse.

Samples are summarised in blocks of 0.1 s: whole periods of 50 Hz and of 60 Hz, so that mains hum has no mean
in them, and is fitted and taken out where samples are missing. All else is decided from the blocks: that makes
a sample cheap, and makes a recording give, bit for bit, the captures of the live stream.
"""

from contactbench.pipeline.calibration.stillness.captures import (
    Capture,
    Rejected,
    Stillness,
    StillnessSettings,
    StillState,
)
from contactbench.pipeline.calibration.stillness.detector import StillnessDetector

__all__ = ["Capture", "Rejected", "StillState", "Stillness", "StillnessDetector", "StillnessSettings"]
