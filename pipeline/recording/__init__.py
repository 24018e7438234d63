"""Raw streams on disk: MCAP files of wrenches, poses and events."""

from pipeline.recording.errors import RecordingError, SampleError
from pipeline.recording.info import DeviceInfo, RecordingInfo
from pipeline.recording.messages import Event
from pipeline.recording.reader import Recording, RecordingReader, read_recording
from pipeline.recording.tracks import FlangeTrack, WrenchTrack
from pipeline.recording.writer import RecordingWriter

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
