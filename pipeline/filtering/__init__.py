"""Filters for streams of wrenches or contact locations and what they cost in lag.

The filter of wrenches gives the same numbers live (`update`, `update_block`) and for a whole recording (`filter`).
Samples are rows (n, c) with one column per channel; channels are independent and keep their unit. NaN or an
infinity is a missing sample of its channel: the last answer is held. Before a channel's first sample it is NaN.
"""

from contactbench.pipeline.filtering.kalman import KalmanFigures, KalmanFilter
from contactbench.pipeline.filtering.lowpass import LowPass

__all__ = ["KalmanFigures", "KalmanFilter", "LowPass"]
