"""Lines to devices: serial, TCP and UDP behind one small protocol type."""

from contactbench.pipeline.devices.transport.line import Chunk, Line, LineError, LineLost, LineUnavailable
from contactbench.pipeline.devices.transport.opening import line_to
from contactbench.pipeline.devices.transport.ports import SerialPort, guess_device, list_ports
from contactbench.pipeline.devices.transport.serial_line import SerialLine
from contactbench.pipeline.devices.transport.sockets import TcpLine, UdpLine

__all__ = [
    "Chunk",
    "Line",
    "LineError",
    "LineLost",
    "LineUnavailable",
    "SerialLine",
    "SerialPort",
    "TcpLine",
    "UdpLine",
    "guess_device",
    "line_to",
    "list_ports",
]
