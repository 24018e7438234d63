"""One way to open any source of samples: devices, recordings, files of poses, typed poses."""

from contactbench.pipeline.streams.opening import Pair, open_pair, open_poses, open_sensor
from contactbench.pipeline.streams.replayed import ReplayStream
from contactbench.pipeline.streams.stream import Stream
from contactbench.pipeline.streams.tracks import PoseTrackError

__all__ = ["Pair", "PoseTrackError", "ReplayStream", "Stream", "open_pair", "open_poses", "open_sensor"]
