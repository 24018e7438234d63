"""Raw streams on disk: MCAP files of wrenches, poses and events."""

from contactbench.pipeline.errors import RecordingError, SampleError
from contactbench.pipeline.recording.messages import DeviceInfo, Event, RecordingInfo
from contactbench.pipeline.recording.reader import (
    FlangeTrack,
    Recording,
    RecordingReader,
    WrenchTrack,
    read_recording,
)
from contactbench.pipeline.recording.recorder import RecordingWriter

__all__ = [
    "DeviceInfo",
    "Event",
    "FlangeTrack",
    "Recording",
    "RecordingError",
    "RecordingInfo",
    "RecordingReader",
    "RecordingWriter",
    "SampleError",
    "WrenchTrack",
    "read_recording",
]
