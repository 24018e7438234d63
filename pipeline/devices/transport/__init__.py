"""Lines to devices: serial, TCP and UDP behind one small protocol type."""

from pipeline.devices.transport.line import Chunk, Line, LineError, LineLost, LineUnavailable
from pipeline.devices.transport.opening import line_to
from pipeline.devices.transport.ports import SerialPort, guess_device, list_ports
from pipeline.devices.transport.serial_line import SerialLine
from pipeline.devices.transport.sockets import TcpLine, UdpLine

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
