"""What the bench gives: samples, the truth beside them, and what was done to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.simulation.virtual.commands import Command, SecretRezero

if TYPE_CHECKING:
    from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
    from contactbench.pipeline.simulation.scenes import SceneMoment


@dataclass(frozen=True)
class Done:
    """A command that took effect."""

    time: float  # when, s of the bench's clock
    command: Command
    until: float  # when it is over: a turn at its end, a touch when the tip leaves by itself; else `time`

    @property
    def secret(self) -> bool:
        """Whether nobody but the truth may tell of it."""
        return isinstance(self.command, SecretRezero)


@dataclass(frozen=True)
class Slip:
    """A tip that was told to press and touched nothing for half a second: it slid off, or never met the probe."""

    time: float  # when that was found, s of the bench's clock
    touch: Done  # the command


@dataclass(frozen=True)
class Batch:
    """What the bench gave over some time, each by increasing time."""

    wrenches: tuple[WrenchSample, ...] = ()
    flanges: tuple[FlangeSample, ...] = ()
    truths: tuple[SceneMoment, ...] = ()  # one for every wrench
    done: tuple[Done, ...] = ()  # commands that took effect
    slips: tuple[Slip, ...] = ()  # touches that were found to press nothing
