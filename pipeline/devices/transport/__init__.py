"""Lines to devices: serial, TCP and UDP behind one small protocol type."""

from contactbench.pipeline.devices.driver import AddressError, Carrier
from contactbench.pipeline.devices.transport.ports import SerialPort, guess_device, list_ports
from contactbench.pipeline.devices.transport.serial_line import SerialLine
from contactbench.pipeline.devices.transport.sockets import (
    Chunk,
    Line,
    LineError,
    LineLost,
    LineUnavailable,
    TcpLine,
    UdpLine,
)
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import arg

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


# ---- which line an address asks for --------------------------------------------------------------


def line_to(address: DeviceAddress) -> Line:
    """Return the line to a device, not yet open.

    Raises
    ------
    AddressError
        It is a recording: no line leads there.
    """
    if address.carrier is Carrier.SERIAL and address.baud is not None:
        return SerialLine(address.path, address.baud)
    if address.carrier is Carrier.TCP and address.port is not None:
        return TcpLine(address.host, address.port)
    if address.carrier is Carrier.UDP and address.port is not None:
        return UdpLine(address.host, address.port, address.options.get("listen"))
    raise AddressError(f"address {arg(str(address))!r} has no line: give the address of a device.")
