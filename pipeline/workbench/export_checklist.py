"""What an export rests on: what of it is done, stale or missing, and what to do about it."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.config.runtime.checks import CHECK_KINDS
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.workbench.steps import Step

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from contactbench.pipeline.session import State
    from contactbench.pipeline.session.state import Input, Result

    Content = dict[str, Any]
    Judged = tuple["CheckState", str]
    Judge = Callable[[Content, str], Judged | None]

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
    """One line of the checklist."""

    name: str  # What it is
    state: CheckState
    sentence: str  # What came of it, or what to do
    step: Step  # Where that is done

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
    item = partial(_item, folder, state, stale)
    touch = "Touch the markers, so that somebody has shown that it is right."
    checks = [
        item("Known weight", "known_weight", Step.GRAVITY, "Hang a known weight on the tool.", _checked),
        item("Known touch", "known_touch", Step.VERIFY, "Press a known point of the probe.", _checked),
    ]
    if any(each.state is CheckState.DONE for each in checks):  # one of them is enough
        checks = [
            replace(each, state=CheckState.OPTIONAL) if each.state is CheckState.MISSING else each
            for each in checks
        ]
    return (
        _sensor(state),
        item("Calibration", "calibration", Step.GRAVITY, "Calibrate the sensor with this tool.", _fitted),
        item("Probe", "probe", Step.PROBE, "Prepare the probe's mesh."),
        _regions(folder, state),
        item("Verification", "verification", Step.VERIFY, touch, _verified),
        *checks,
        item("Report", "report", Step.VERIFY, "Finish a verification: its report goes into the bundle."),
    )


def _item(
    folder: Path,
    state: State,
    stale: Stale,
    name: str,
    kind: str,
    step: Step,
    remedy: str,
    judge: Judge | None = None,
) -> CheckItem:
    """Return the line of the newest result of a kind; `judge` says what its JSON file says of it."""
    found = state.newest(kind)
    if found is None:
        unseen = "Not checked: a wrong sign, unit or scale of the sensor would go unnoticed. "
        return CheckItem(name, CheckState.MISSING, (unseen if kind in CHECK_KINDS else "") + remedy, step)
    if found.mark is not None and found.rejected:
        words = f"It was rejected. {found.mark.reason} {remedy}".strip()
        return CheckItem(name, CheckState.FAILED, words, step)
    if reasons := stale.get(found.slot, ()):
        return CheckItem(name, CheckState.STALE, f"{reasons[0]} Do it again.", step)
    judged = None if judge is None else judge(content_of(folder, found), remedy)
    return CheckItem(name, *(judged or (CheckState.DONE, f"Made on {day_of(found)}.")), step)


def _fitted(content: Content, _remedy: str) -> Judged | None:
    if verdict_of(content).get("level") == "refuse":
        return CheckState.FAILED, "The calibration was refused: calibrate again."
    return None


def _verified(content: Content, _remedy: str) -> Judged:
    verdict = verdict_of(content)
    if verdict.get("passed") is not True:
        why = "; ".join(map(str, verdict.get("reasons", ()))) or "see its report"
        return CheckState.FAILED, f"It did not pass: {why}. Verify again."
    figures = figures_of(content)
    return CheckState.DONE, f"Passed: {figures}." if figures else "Passed."


def _checked(content: Content, remedy: str) -> Judged:
    sentence, outcome = str(content.get("sentence", "")), content.get("outcome")
    if outcome == "failed":
        return CheckState.FAILED, sentence or f"It failed. {remedy}"
    return (CheckState.DONE if outcome == "passed" else CheckState.MISSING), sentence


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


def content_of(folder: Path, found: Result | Input) -> Content:
    """Return the JSON object of a result's main file; empty where it cannot be read: whoever needs it says why."""
    return _json(folder / found.file.path)


def _json(file: Path) -> Content:
    try:
        content = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def verdict_of(content: Content) -> Content:
    """Return the verdict of a calibration or a verification; empty: there is none."""
    found = content.get("verdict")
    return found if isinstance(found, dict) else {}


def figures_of(content: Content) -> str:
    """Return how far off the touches of a verification were, in words; empty: nobody knows."""
    overall = content.get("overall")
    mean = overall.get("mean_mm") if isinstance(overall, dict) else None
    most = overall.get("max_mm") if isinstance(overall, dict) else None
    if not isinstance(mean, int | float) or not isinstance(most, int | float):
        return ""
    return f"{mean:.2f} mm on average, {most:.2f} mm at most"


def day_of(found: Result | Input) -> str:
    """Return when something was added, for people."""
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
