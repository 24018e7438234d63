"""How a stream is: what an operator is told."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contactbench.pipeline.devices.protocols import Counters


class State(StrEnum):
    """Where a stream is."""

    CLOSED = "closed"
    CONNECTING = "connecting"
    STREAMING = "streaming"
    SILENT = "silent"
    LOST = "lost"


@dataclass(frozen=True)
class Health:
    """
    A stream at one moment.

    Attributes
    ----------
    state : State
    findings : tuple of str
        What is wrong, in sentences; empty when nothing is.
    samples : int
        Given since the stream was opened.
    rate : float or None
        Measured over the last samples, Hz.
    jitter : float or None
        How unevenly they arrive: the 95th percentile of how far an interval is from the median one, s.
    counters : Counters
        Of the parser.
    reconnected : int
        Times samples came again after the line was lost.
    suspicions : tuple of str
        What may have happened, such as a re-zero, in sentences; they stay until `acknowledge`.
    lateness : (99th percentile, largest) or None
        How much later than they should samples came after the one before, s: of the last ones, and of all
        since the last gap.
    failure : str or None
        Why the stream ended for good; None: it goes on, or was stopped.
    """

    state: State
    findings: tuple[str, ...]
    samples: int
    rate: float | None
    jitter: float | None
    counters: Counters
    reconnected: int
    suspicions: tuple[str, ...] = ()
    lateness: tuple[float, float] | None = None
    failure: str | None = None

    @property
    def well(self) -> bool:
        """Whether samples come, and nothing is wrong with them or suspected to be."""
        return self.state is State.STREAMING and not self.findings and not self.suspicions
