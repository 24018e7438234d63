"""The serial ports of this machine, with a guess at what hangs on each."""

from dataclasses import dataclass

from contactbench.pipeline.devices.protocols.registry import drivers
from contactbench.pipeline.errors import arg, message


@dataclass(frozen=True)
class SerialPort:
    """One serial port."""

    path: str  # as an address has it
    description: str  # what the system says about it
    serial_number: str | None  # of the USB converter
    guess: str | None  # the scheme of its driver; None: a converter that does not say what it belongs to

    @property
    def url(self) -> str | None:
        """The address to try, where there is a guess."""
        return f"{self.guess}+serial://{self.path}" if self.guess else None


def list_ports() -> list[SerialPort]:
    """Return the serial ports of this machine, ports with a guess first, then by path."""
    from serial.tools import list_ports as tool  # type: ignore[import-untyped]

    ports = []
    for port in tool.comports():
        words = [port.description, port.manufacturer, port.product]
        text = ", ".join(dict.fromkeys(str(word) for word in words if word and word != "n/a"))
        ports.append(
            SerialPort(port.device, text or message("no description"), port.serial_number, guess_device(text))
        )
    return sorted(ports, key=lambda port: (port.guess is None, port.path))


def guess_device(description: str) -> str | None:
    """Guess from what USB says of a port the scheme of its device; None: it does not say."""
    text = message(f"{arg(description.lower())} ")
    return next(
        (name for name, known in drivers().items() if any(word in text for word in known.usb_words)), None
    )
