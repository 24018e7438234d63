"""One way to open any source of samples: devices, recordings, files of poses, typed poses."""

from pipeline.streams.opening import Pair, open_pair, open_poses, open_sensor
from pipeline.streams.replayed import ReplayStream
from pipeline.streams.stream import Stream
from pipeline.streams.tracks import PoseTrackError

__all__ = ["Pair", "PoseTrackError", "ReplayStream", "Stream", "open_pair", "open_poses", "open_sensor"]
