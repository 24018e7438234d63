"""
What a real bench does that the ideal one does not: to the probe, to what its sensor feels, and to when samples come.

`contactbench.pipeline.reality` says which effects there are and how large. Here `RealProbe` is the probe that is on the
bench, beside the one that the program is told of; `WrenchDisturbance` is what the sensor feels beside the touch and the
weight; `LateLine` holds samples back. What the sensor makes of it is in `simulation.sensor_model`.
"""

from contactbench.pipeline.simulation.reality.chance import chance
from contactbench.pipeline.simulation.reality.line import LateLine
from contactbench.pipeline.simulation.reality.pulls import Pad, PadPress, WrenchDisturbance
from contactbench.pipeline.simulation.reality.real_probe import RealProbe

__all__ = ["LateLine", "Pad", "PadPress", "RealProbe", "WrenchDisturbance", "chance"]
