"""Wire protocols of sensors and robots: bytes in, samples out; nothing here opens a line.

One module per protocol. Each sensor module has a parser (`SensorParser`), `start_commands` and
`stop_commands`; those are all the commands that contactbench ever sends. None of them zeroes a sensor,
stores a setting or moves a robot.
"""

from contactbench.pipeline.devices.protocols.commands import Command, highest_rate
from contactbench.pipeline.devices.protocols.parser import Counters, ProtocolError, SensorParser

__all__ = ["Command", "Counters", "ProtocolError", "SensorParser", "highest_rate"]
