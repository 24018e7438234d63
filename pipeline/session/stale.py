"""Which results no longer follow from what the session holds now, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session.recompute import parameter_of
from contactbench.pipeline.session.sources import Recorded, sources_of
from contactbench.pipeline.session.state import MESH, minute_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contactbench.pipeline.session.state import Input, Result, Setting, State


def stale_results(state: State) -> dict[tuple[str, str], tuple[str, ...]]:
    """
    Say of each current result why it is stale.

    A result is stale when one of its inputs is in no earlier record, has another content now or was measured before
    its sensor was re-zeroed, when a result that it was computed from was computed anew with another outcome, is stale
    itself or was rejected, when a parameter was set to another value than the one it was computed with, or when
    somebody says so.
    Contents are compared, not times: what is put back as it was is not stale. But a recording stays as old as it is:
    adding it again, or under another name, makes it no newer.

    Returns
    -------
    dict
        (kind, name) -> sentences; empty for a result that holds.
    """
    judge = _Judge(state)
    return {slot: judge.reasons(result) for slot, result in state.current_results.items()}


class _Judge:
    def __init__(self, state: State) -> None:
        self._inputs, self._results = state.current_inputs, state.current_results
        self._outcomes = {slot: result.outcome for slot, result in self._results.items()}
        self._sources = sources_of(state)
        self._recorded = Recorded(state.inputs)
        self._rezeros = {each.sensor: each for each in state.rezeros}  # the newest of each sensor
        self._settings: dict[str, list[tuple[str, Setting]]] = {}
        for key, setting in state.settings.items():
            kind, parameter = key.split(".", 1)
            self._settings.setdefault(kind, []).append((parameter, setting))
        self._known: dict[int, tuple[str, ...]] = {}

    def reasons(self, result: Result) -> tuple[str, ...]:
        """Return the reasons; those of what it was computed from are found first, however long the chain is."""
        path, met = [(result, self._before(result))], {result.number}
        while path:
            last, rest = path[-1]
            following = next((each for each in rest if each.number not in met), None)
            if following is not None:
                met.add(following.number)
                if following.number not in self._known:
                    path.append((following, self._before(following)))
                continue
            path.pop()
            if last.number not in self._known:
                self._known[last.number] = tuple(dict.fromkeys((*self._own(last), *self._inherited(last))))
        return self._known[result.number]

    def _before(self, result: Result) -> Iterator[Result]:
        for source in self._sources[result.number]:
            for made in source.results:
                yield self._results[made.slot]

    def _own(self, result: Result) -> Iterator[str]:
        """Yield what makes it stale by itself."""
        for role, source in zip(result.action.inputs, self._sources[result.number], strict=True):
            if source.lost:
                yield message(
                    f"The {arg(role)} it was computed from is in no earlier record: a record was lost."
                )
            for used in source.inputs:
                yield from self._of_raw(used)
        yield from self._of_parameters(result)
        yield from _said(result)

    def _inherited(self, result: Result) -> Iterator[str]:
        for source in self._sources[result.number]:
            for made in source.results:
                yield from self._of_made(made)

    def _of_made(self, made: Result) -> Iterator[str]:
        newest = self._results[made.slot]
        if made.outcome != self._outcomes[made.slot]:
            yield message(
                f"The {arg(made.title)} it was computed from was recomputed on {arg(minute_of(newest.at))}."
            )
            return
        # In a circle, which the newest results of journals made by hand can be, what it is by itself must do.
        known = self._known.get(newest.number)
        why = next(self._own(newest), None) if known is None else next(iter(known), None)
        if why is not None:
            yield message(f"It was computed from the {arg(made.title)}, which is stale: {arg(why)}")

    def _of_raw(self, used: Input) -> Iterator[str]:
        newest = self._inputs[used.slot]
        if newest.number != used.number and newest.content != used.content:
            what = (
                message("The mesh")
                if used.kind == MESH
                else message(f"The {arg(used.kind)} {arg(used.name)}")
            )
            yield message(
                f"{arg(what)} it was computed from was replaced by {arg(newest.name)} on {arg(minute_of(newest.at))}."
            )
        if used.kind != MESH:
            yield from self._of_rezeros(used)

    def _of_rezeros(self, used: Input) -> Iterator[str]:
        sensors = self._recorded.sensors(used)
        # A recording of which nobody said the sensor may be of this one.
        for sensor in sensors or self._rezeros:
            rezero = self._rezeros.get(sensor)
            if rezero is not None and self._recorded.is_before(used, rezero):
                why = message(f" ({arg(rezero.reason)})") if rezero.reason else ""
                what = message(
                    f"The sensor {arg(rezero.sensor)} was re-zeroed on {arg(minute_of(rezero.at))}{arg(why)}"
                )
                yield message(f"{arg(what)}, after the {arg(used.kind)} {arg(used.name)} was recorded.")
                return

    def _of_parameters(self, result: Result) -> Iterator[str]:
        kind, given = result.action.kind, result.action.parameters
        for parameter, setting in self._settings.get(kind, ()):
            if setting.number < result.number:
                continue
            used = parameter_of(kind, parameter, given)
            if parameter_of(kind, parameter, {**given, parameter: setting.value}) != used:
                yield message(
                    f"The parameter {arg(kind)}.{arg(parameter)} was set to {arg(setting.value)!r} on"
                    f" {arg(minute_of(setting.at))}; this was computed with {arg(used)!r}."
                )


def _said(result: Result) -> Iterator[str]:
    if result.mark is not None and result.mark.mark in {"stale", "rejected"}:
        what = message("marked as stale") if result.mark.mark == "stale" else message("rejected")
        yield message(f"It was {arg(what)}: {arg(result.mark.reason or message('no reason was given'))}.")
