"""Faults on the line from a sensor to a controller, by a script."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.devices.sample import WrenchSample

_ZERO = (0.0,) * 6


class FaultKind(StrEnum):
    """What a sensor does wrongly."""

    DROPOUT = "dropout"  # it gives nothing
    SPIKE = "spike"  # single readings far off
    STUCK = "stuck"  # the same reading again and again, with new times
    BIAS_JUMP = "bias jump"  # from then on every reading is off by as much


@dataclass(frozen=True)
class ScriptedFault:
    """
    One fault.

    Raises
    ------
    InputError
        A number is out of range.
    """

    kind: FaultKind
    start: float  # s, of the scene
    # how long it lasts; a spike of 0 s is one reading. Infinite: it does not end.
    seconds: float = 0.0
    wrench: tuple[float, ...] = field(default=_ZERO)  # (6,) what a spike or a jump adds, S, N and N·m

    def __post_init__(self) -> None:
        if not (0 <= self.start < math.inf and self.seconds >= 0):
            raise InputError(
                f"fault: {self.kind} from {self.start} s for {self.seconds} s: give times of 0 or more."
            )
        if len(self.wrench) != 6 or not all(map(math.isfinite, self.wrench)):
            raise InputError(f"fault: {self.kind} of {self.wrench}: give six finite numbers, N and N·m.")

    def at(self, time: float) -> bool:
        """Tell whether it is there at a time, s."""
        return self.start <= time <= self.start + self.seconds


class FaultyLine:
    """A line from a sensor to a controller on which faults happen."""

    def __init__(self, faults: Sequence[ScriptedFault] = ()) -> None:
        self._faults = tuple(faults)
        self._spiked: set[ScriptedFault] = set()
        self._last: WrenchSample | None = None

    def carry(self, sample: WrenchSample) -> WrenchSample | None:
        """Return what arrives of a sample; None: nothing."""
        given: WrenchSample | None = sample
        for fault in self._faults:
            if given is not None and self._happens(fault, sample.time):
                given = self._damaged(fault, given)
        self._last = given or self._last
        return given

    def _happens(self, fault: ScriptedFault, time: float) -> bool:
        if fault.kind is FaultKind.SPIKE and fault.seconds == 0:
            # The first reading not before its time, whatever the rate.
            first = time >= fault.start and fault not in self._spiked
            if first:
                self._spiked.add(fault)
            return first
        return fault.at(time)

    def _damaged(self, fault: ScriptedFault, sample: WrenchSample) -> WrenchSample | None:
        if fault.kind is FaultKind.DROPOUT:
            return None
        if fault.kind is FaultKind.STUCK:
            last = self._last or sample
            return replace(sample, force=last.force, torque=last.torque)
        both = [a + b for a, b in zip((*sample.force, *sample.torque), fault.wrench, strict=True)]
        return replace(sample, force=(both[0], both[1], both[2]), torque=(both[3], both[4], both[5]))
