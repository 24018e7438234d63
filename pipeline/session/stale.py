"""Which results no longer follow from what the session holds now, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pipeline.session.state import MESH

if TYPE_CHECKING:
    from pipeline.session.state import Input, Result, State


def stale_results(state: State) -> dict[tuple[str, str], tuple[str, ...]]:
    """
    Say of each current result why it is stale.

    A result is stale when one of its inputs has another content now or was measured before its sensor was
    re-zeroed, when a result that it was computed from was computed anew with another outcome or is stale itself,
    when a parameter was set to another value than the one it was computed with, or when somebody says so. Contents
    are compared, not times: what is put back as it was is not stale.

    Returns
    -------
    dict
        (kind, name) -> sentences; empty for a result that holds.
    """
    judge = _Judge(state)
    for result in state.results:  # oldest first, so that no long chain is followed all at once
        judge.reasons(result)
    return {slot: judge.reasons(result) for slot, result in state.current_results.items()}


class _Judge:
    def __init__(self, state: State) -> None:
        self._state = state
        self._inputs, self._results = state.current_inputs, state.current_results
        self._known: dict[int, tuple[str, ...]] = {}

    def reasons(self, result: Result) -> tuple[str, ...]:
        """Return the reasons; what refers to itself in a circle, in a journal made by hand, adds none."""
        if result.number not in self._known:
            self._known[result.number] = ()
            found = [
                *(reason for sha256 in result.action.inputs.values() for reason in self._of_input(sha256)),
                *self._of_parameters(result),
                *_said(result),
            ]
            self._known[result.number] = tuple(dict.fromkeys(found))
        return self._known[result.number]

    def _of_input(self, sha256: str) -> list[str]:
        used = self._state.input_with(sha256)
        if used is not None:
            return self._of_raw(used)
        made = self._state.result_with(sha256)
        if made is None:
            return [f"It was computed from the content {sha256[:12]}, which this session does not hold."]
        newest = self._results[made.slot]
        if newest.number != made.number:
            return [f"The {made.title} that it was computed from was computed anew on {newest.at}."]
        return [
            f"It was computed from the {made.title}, which is stale: {why}" for why in self.reasons(made)[:1]
        ]

    def _of_raw(self, used: Input) -> list[str]:
        newest, found = self._inputs[used.slot], []
        if newest.file.sha256 != used.file.sha256:
            what = "The mesh" if used.kind == MESH else f"The {used.kind} {used.name}"
            found.append(f"{what} that it was computed from was replaced by {newest.name} on {newest.at}.")
        if used.kind != MESH:
            found += self._of_rezeros(used)
        return found

    def _of_rezeros(self, used: Input) -> list[str]:
        for rezero in self._state.rezeros:
            # A recording of which nobody said the sensor may be of this one.
            if rezero.number > used.number and used.sensor in {None, rezero.sensor}:
                why = f" ({rezero.reason})" if rezero.reason else ""
                what = f"The sensor {rezero.sensor} was re-zeroed on {rezero.at}{why}"
                return [f"{what}, after the {used.kind} {used.name} was recorded."]
        return []

    def _of_parameters(self, result: Result) -> list[str]:
        found = []
        for key, setting in self._state.settings.items():
            kind, parameter = key.split(".", 1)
            used = result.action.parameters.get(parameter)
            if kind == result.action.kind and setting.number > result.number and setting.value != used:
                found.append(
                    f"The parameter {key} was set to {setting.value!r} on {setting.at}; it was computed with {used!r}."
                )
        return found


def _said(result: Result) -> list[str]:
    if not result.marks or result.marks[-1].mark != "stale":
        return []
    return [f"It was marked as stale: {result.marks[-1].reason or 'no reason was given'}."]
