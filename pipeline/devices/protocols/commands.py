"""Commands as values, and the rates that a serial line can carry."""

from __future__ import annotations

import math
from dataclasses import dataclass

from contactbench.pipeline.devices.protocols.parser import ProtocolError
from contactbench.pipeline.errors import arg

# A start bit, eight data bits and a stop bit (8N1).
_BITS_PER_BYTE = 10


@dataclass(frozen=True, slots=True)
class Command:
    """One command to a device."""

    data: bytes  # what to write
    # what the device's answer contains when it agrees; None where no answer comes, or none is known
    reply: bytes | None = None
    # seconds that must pass before the next command; what comes meanwhile belongs to the time before
    settle: float = 0.0
    refusal: bytes | None = None  # what the device's answer, a line of text, contains when it does not agree
    instead: Command | None = None  # what to send when it does not agree

    def answered(self, heard: bytes) -> bool | None:
        """Tell from all that came since whether the device agreed; None: it has not said yet."""
        if self.reply is None:
            return True
        start = heard.find(self.reply)
        if self.refusal is None:
            return True if start >= 0 else None
        refused = heard.find(self.refusal)
        if refused >= 0:
            return False
        # The refusal may be the end of a line that begins like agreement.
        return True if start >= 0 and b"\n" in heard[start:] else None


def highest_rate(baud: int, frame_bytes: int) -> float:
    """
    Return the frames per second that a serial line (8N1) can carry.

    Parameters
    ----------
    baud : int
        Bits per second.
    frame_bytes : int
        Length of a frame.
    """
    return baud / _BITS_PER_BYTE / frame_bytes


def check_rate(device: str, rate_hz: float, low: float, high: float) -> float:
    """
    Return a sample rate that the device has.

    Raises
    ------
    ProtocolError
        It is not finite or outside low .. high, Hz.
    """
    if not (math.isfinite(rate_hz) and low <= rate_hz <= high):
        raise ProtocolError(
            f"{arg(device)}: the rate must be between {arg(low):g} and {arg(high):g} Hz, not {arg(rate_hz):g}."
        )
    return rate_hz


def check_line(device: str, rate_hz: float, baud: int | None, frame_bytes: int) -> None:
    """
    Refuse a rate that the serial line cannot carry; `baud` None means that there is no serial line.

    Raises
    ------
    ProtocolError
        The baud rate is not positive, or too low.
    """
    if baud is None:
        return
    if baud <= 0:
        raise ProtocolError(f"{arg(device)}: the baud rate must be above 0, not {arg(baud)}.")
    ceiling = highest_rate(baud, frame_bytes)
    if rate_hz > ceiling:
        raise ProtocolError(
            f"{arg(device)}: {arg(rate_hz):g} Hz is too fast for {arg(baud)} baud, which carries"
            f" {arg(math.floor(ceiling))} frames of {arg(frame_bytes)} bytes per second: lower the rate or"
            " raise the baud rate."
        )
