"""What every line to a device can do: open, read with a time limit, write, close."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from contactbench.pipeline.errors import InputError


class LineError(InputError):
    """A line to a device cannot be used; the message names the line and the remedy."""


class LineUnavailable(LineError):  # noqa: N818 - it is said as a state, as in the status shown to people
    """A line could not be opened; trying again later may work."""


class LineLost(LineError):  # noqa: N818
    """A line that was open is gone: unplugged, closed by the other side, or never opened."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """Bytes, and when the last of them arrived."""

    data: bytes  # empty when nothing came within the time limit
    time: float  # seconds of the host's monotonic clock, taken right after the read


class Line(Protocol):
    """A line to a device. One thread uses it; after `LineLost` it can be opened again.

    Attributes
    ----------
    name : str
        Of the line, for messages.
    datagrams : bool
        Whether each chunk is one whole datagram.
    """

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def datagrams(self) -> bool: ...  # noqa: D102

    def open(self) -> None:
        """Open it; an open one is closed first.

        Raises
        ------
        LineUnavailable
            It is not there, busy, or not allowed.
        """

    def read(self, timeout: float) -> Chunk:
        """Return what is there, waiting at most `timeout` seconds (0: not at all) for the first byte.

        Raises
        ------
        LineLost
        """

    def write(self, data: bytes) -> None:
        """Send all of `data`.

        Raises
        ------
        LineLost
            Also when the other side takes nothing for a second.
        """

    def close(self) -> None:
        """Close it; a closed one stays closed. Raises nothing."""
