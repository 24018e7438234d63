"""What an export rests on: what of it is done, stale or missing, and what to do about it."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.config.runtime.checks import CHECK_KINDS
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.workbench.steps import Step

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from contactbench.pipeline.session import State
    from contactbench.pipeline.session.state import Input, Result

Stale = dict[tuple[str, str], tuple[str, ...]]


class CheckState(StrEnum):
    """How a part of an export stands."""

    DONE = "done"
    STALE = "stale"
    MISSING = "missing"
    FAILED = "failed"
    OPTIONAL = "left out"


@dataclass(frozen=True)
class CheckItem:
    """
    One line of the checklist.

    Attributes
    ----------
    name : str
        What it is.
    state : CheckState
    sentence : str
        What came of it, or what to do.
    step : Step
        Where that is done.
    """

    name: str
    state: CheckState
    sentence: str
    step: Step

    @property
    def holds(self) -> bool:
        """Whether nothing has to be done about it."""
        return self.state in (CheckState.DONE, CheckState.OPTIONAL)


def checklist(folder: Path, state: State, stale: Stale) -> tuple[CheckItem, ...]:
    """
    Say how everything stands that a bundle rests on; reads the session's small JSON files, so not in a window's thread.

    Parameters
    ----------
    folder : Path
        Of the session.
    state : State
    stale : dict
        As `Session.stale` says.
    """
    return (
        _sensor(state),
        _calibration(folder, state, stale),
        _probe(state, stale),
        _regions(folder, state),
        _verification(folder, state, stale),
        *_checks(folder, state, stale),
        _report(state, stale),
    )


def _sensor(state: State) -> CheckItem:
    stored = [
        state.settings[key].value for key in ("config.serial", "devices.serial") if key in state.settings
    ]
    known = [each for each in stored if each]
    known += sorted({each.sensor for each in state.current_inputs.values() if each.sensor})
    if not known:
        return CheckItem(
            "Sensor",
            CheckState.MISSING,
            "Nobody said the sensor's serial number: the bundle would say 'unknown'. Give it below.",
            Step.DEVICES,
        )
    return CheckItem("Sensor", CheckState.DONE, f"Serial number {known[0]}.", Step.DEVICES)


def _calibration(folder: Path, state: State, stale: Stale) -> CheckItem:
    found = state.newest("calibration")
    item = _standing("Calibration", found, stale, Step.GRAVITY, "Calibrate the sensor with this tool.")
    if item is not None or found is None:
        return item or _missing("Calibration", "Calibrate the sensor with this tool.", Step.GRAVITY)
    content = _content(folder, found)
    verdict = content.get("verdict", {})
    level = str(verdict.get("level", "")) if isinstance(verdict, dict) else ""
    if level == "refuse":
        return CheckItem(
            "Calibration", CheckState.FAILED, "The calibration was refused: calibrate again.", Step.GRAVITY
        )
    return CheckItem("Calibration", CheckState.DONE, f"Made on {_day(found)}.", Step.GRAVITY)


def _probe(state: State, stale: Stale) -> CheckItem:
    found = state.newest("probe")
    item = _standing("Probe", found, stale, Step.PROBE, "Prepare the probe's mesh.")
    if item is not None or found is None:
        return item or _missing("Probe", "Prepare the probe's mesh.", Step.PROBE)
    return CheckItem("Probe", CheckState.DONE, f"Made on {_day(found)}.", Step.PROBE)


def _regions(folder: Path, state: State) -> CheckItem:
    probe = state.newest("probe")
    named = 0 if probe is None else _named_regions(folder, probe)
    if named:
        words = "one priority region" if named == 1 else f"{named} priority regions"
        return CheckItem("Regions", CheckState.DONE, f"The probe has {words}.", Step.REGIONS)
    if state.newest("regions") is not None:
        return CheckItem(
            "Regions",
            CheckState.MISSING,
            "Regions are painted, but the probe does not have them yet: apply them.",
            Step.REGIONS,
        )
    return CheckItem(
        "Regions",
        CheckState.OPTIONAL,
        "No priority regions: among candidates none is preferred. That is fine for most probes.",
        Step.REGIONS,
    )


def _named_regions(folder: Path, probe: Result | Input) -> int:
    """Return how many regions the JSON file beside a probe names; 0 where it cannot be read."""
    files = probe.companions if hasattr(probe, "companions") else probe.action.files
    for name, file in files.items():
        if name.endswith(".json"):
            regions = _json(folder / file.path).get("regions", ())
            return len(regions) if isinstance(regions, list) else 0
    return 0


def _verification(folder: Path, state: State, stale: Stale) -> CheckItem:
    name, remedy = "Verification", "Touch the markers, so that somebody has shown that it is right."
    found = state.newest("verification")
    item = _standing(name, found, stale, Step.VERIFY, remedy)
    if item is not None or found is None:
        return item or _missing(name, remedy, Step.VERIFY)
    content = _content(folder, found)
    verdict, overall = content.get("verdict"), content.get("overall")
    if not (isinstance(verdict, dict) and verdict.get("passed") is True):
        why = "; ".join(map(str, verdict.get("reasons", ()))) if isinstance(verdict, dict) else ""
        return CheckItem(
            name, CheckState.FAILED, f"It did not pass: {why or 'see its report'}. Verify again.", Step.VERIFY
        )
    words = "Passed."
    if isinstance(overall, dict) and isinstance(overall.get("mean_mm"), float):
        words = f"Passed: {overall['mean_mm']:.2f} mm on average, {float(overall['max_mm']):.2f} mm at most."
    return CheckItem(name, CheckState.DONE, words, Step.VERIFY)


def _checks(folder: Path, state: State, stale: Stale) -> tuple[CheckItem, ...]:
    """Return a line each of known weight and known touch: one of them is enough."""
    items = [
        _check(folder, state, stale, *names)
        for names in (
            ("Known weight", "known_weight", "Hang a known weight on the tool.", Step.GRAVITY),
            ("Known touch", "known_touch", "Press a known point of the probe.", Step.VERIFY),
        )
    ]
    enough = any(item.state is CheckState.DONE for item in items)
    return tuple(
        replace(item, state=CheckState.OPTIONAL) if enough and item.state is CheckState.MISSING else item
        for item in items
    )


def _check(
    folder: Path, state: State, stale: Stale, name: str, kind: str, remedy: str, step: Step
) -> CheckItem:
    found = state.newest(kind)
    item = _standing(name, found, stale, step, remedy)
    if item is not None or found is None:
        unseen = f"Not checked: a wrong sign, unit or scale of the sensor would go unnoticed. {remedy}"
        return item or _missing(name, unseen, step)
    content = _content(folder, found)
    sentence, outcome = str(content.get("sentence", "")), content.get("outcome")
    if outcome == "failed":
        return CheckItem(name, CheckState.FAILED, sentence or f"It failed. {remedy}", step)
    return CheckItem(name, CheckState.DONE if outcome == "passed" else CheckState.MISSING, sentence, step)


def _report(state: State, stale: Stale) -> CheckItem:
    remedy = "Finish a verification: its report goes into the bundle."
    found = state.newest("report")
    item = _standing("Report", found, stale, Step.VERIFY, remedy)
    if item is not None or found is None:
        return item or _missing("Report", remedy, Step.VERIFY)
    return CheckItem("Report", CheckState.DONE, f"Made on {_day(found)}.", Step.VERIFY)


def _missing(name: str, remedy: str, step: Step) -> CheckItem:
    return CheckItem(name, CheckState.MISSING, remedy, step)


def _standing(
    name: str, found: Result | Input | None, stale: Stale, step: Step, remedy: str
) -> CheckItem | None:
    """Return the line of what is not there, rejected or stale; None: it holds."""
    if found is None:
        return None
    if found.mark is not None and found.rejected:
        words = f"It was rejected. {found.mark.reason} {remedy}".strip()
        return CheckItem(name, CheckState.FAILED, words, step)
    if reasons := stale.get(found.slot, ()):
        return CheckItem(name, CheckState.STALE, f"{reasons[0]} Do it again.", step)
    return None


def _content(folder: Path, found: Result | Input) -> dict[str, Any]:
    return _json(folder / found.file.path)


def _json(file: Path) -> dict[str, Any]:
    """Return a JSON object; empty where it cannot be read: the preview says why."""
    try:
        content = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _day(found: Result | Input) -> str:
    return found.at[:16].replace("T", " ") + " UTC"


def results_of(state: State) -> Mapping[str, str]:
    """Return kind -> content of the newest results that a bundle is made of: what an export is an export of."""
    kinds = ("calibration", "probe", "verification", *CHECK_KINDS, "report")
    found = {kind: state.newest(kind) for kind in kinds}
    return {kind: each.content for kind, each in found.items() if each is not None}


def refuse_without(state: State) -> None:
    """InputError unless there is what no bundle can do without."""
    for kind, what in (("calibration", "Calibrate first"), ("probe", "prepare the probe first")):
        if state.newest(kind) is None:
            raise InputError(f"There is no {kind} yet: nothing can be exported. {what[0].upper()}{what[1:]}.")
