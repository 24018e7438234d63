"""Where the inputs of results came from, at the time, and how old they are."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Generic, TypeVar

from contactbench.pipeline.session.state import Input, Result

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.session.state import RezeroRecord, State

_T = TypeVar("_T", Input, Result)


@dataclass(frozen=True)
class InputSource:
    """What an input of a result may have been; more than one, if the same content was there under several names."""

    inputs: tuple[Input, ...]
    results: tuple[Result, ...]

    @property
    def lost(self) -> bool:
        """Whether no earlier record holds it: no session writes that, but a salvaged one can lack records."""
        return not self.inputs and not self.results


def sources_of(state: State) -> dict[int, tuple[InputSource, ...]]:
    """Return what each result was computed from: number of its record -> its inputs. What came later is none."""
    inputs: _Shelf[Input] = _Shelf()
    results: _Shelf[Result] = _Shelf()
    found: dict[int, tuple[InputSource, ...]] = {}
    added = iter(state.inputs)
    following = next(added, None)
    for result in state.results:
        while following is not None and following.number < result.number:
            inputs.put(following, {following.content})
            following = next(added, None)
        found[result.number] = tuple(
            InputSource(_of_kind(role, inputs.get(sha256)), results.get(sha256))
            for role, sha256 in result.action.inputs.items()
        )
        results.put(result, result.known_as)
    return found


class _Shelf(Generic[_T]):
    """What is in each slot now, found by what others call it."""

    def __init__(self) -> None:
        self._now: dict[tuple[str, str], tuple[_T, set[str]]] = {}
        self._by_hash: dict[str, dict[tuple[str, str], _T]] = {}
        self._newest: dict[str, _T] = {}

    def put(self, new: _T, known_as: set[str]) -> None:
        _, before = self._now.get(new.slot, (new, set[str]()))
        for sha256 in before - known_as:
            self._by_hash[sha256].pop(new.slot, None)
        for sha256 in known_as:
            self._by_hash.setdefault(sha256, {})[new.slot] = new
            self._newest[sha256] = new
        self._now[new.slot] = (new, known_as)

    def get(self, sha256: str) -> tuple[_T, ...]:
        """Return what has this hash now or, if nothing has, the last that had it."""
        there = tuple(self._by_hash.get(sha256, {}).values())
        return there or ((self._newest[sha256],) if sha256 in self._newest else ())


def _of_kind(role: str, found: tuple[Input, ...]) -> tuple[Input, ...]:
    # A copy that was added as something else, such as a backup, is not what was computed from.
    return tuple(each for each in found if each.kind == role) or found


class Recorded:
    """When files were recorded, and with which sensors: adding one once more makes it no newer."""

    def __init__(self, inputs: Iterable[Input]) -> None:
        self._first: dict[str, int] = {}
        self._sensors: dict[str, dict[str, None]] = {}
        self._started: dict[str, datetime] = {}
        for each in inputs:
            key = each.file.sha256
            self._first.setdefault(key, each.number)
            if each.sensor is not None:
                self._sensors.setdefault(key, {})[each.sensor] = None
            started = _time(each.about.get("started"))
            if started is not None:
                self._started[key] = min(started, self._started.get(key, started))

    def sensors(self, used: Input) -> tuple[str, ...]:
        """Return the serial numbers that were ever said of it."""
        return tuple(self._sensors.get(used.file.sha256, ()))

    def is_before(self, used: Input, rezero: RezeroRecord) -> bool:
        """Tell whether it was recorded before a sensor was re-zeroed, by the journal or by its own clock."""
        key = used.file.sha256
        if self._first[key] < rezero.number:
            return True
        started, moved = self._started.get(key), _time(rezero.at)
        return started is not None and moved is not None and started < moved


def _time(text: object) -> datetime | None:
    try:
        found = datetime.fromisoformat(text) if isinstance(text, str) else None
    except ValueError:
        return None
    return found if found is not None and found.tzinfo is not None else None
