"""How the results of a session stand: each step in a state and a sentence, and line by line what an export rests on."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.config.runtime.checks import CHECK_KINDS
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.session.state import minute_of
from contactbench.pipeline.workbench.regions_session import Standing, standing
from contactbench.pipeline.workbench.steps import Step, StepState, StepStatus
from contactbench.pipeline.workbench.trouble import NO_TROUBLE, SessionTrouble, files_behind

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from contactbench.pipeline.session import State
    from contactbench.pipeline.session.actions import FileRef
    from contactbench.pipeline.session.state import Input, Result

    Content = dict[str, Any]
    Facts = Mapping[str, Content]
    Stale = Mapping[tuple[str, str], tuple[str, ...]]

SENSOR, POSES, SERIAL, MOUNT = "devices.sensor", "devices.poses", "devices.serial", "devices.mount"
CERTIFICATE, DUE = "report.certificate", "report.due"
RESULTS = "export.results"
_MADE_OF = ("calibration", "probe", "verification", *CHECK_KINDS, "report")  # of these, a bundle
PROBE_DRAFT = "draft.probe"  # as `probe_draft` keeps it; here without what that needs


class CheckState(StrEnum):
    """How a part of an export stands."""

    DONE = "done"
    STALE = "stale"
    MISSING = "missing"
    FAILED = "failed"
    OPTIONAL = message("left out")


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


# ---- what the results say --------------------------------------------------------------------------


def read_facts(folder: Path, state: State) -> dict[str, Content]:
    """
    Return what the small JSON file of each kind's newest result says, of a probe the one beside it.

    It reads files, so not in a window's thread. Empty where one cannot be read: whoever needs it says why.
    """
    files: dict[str, Path] = {}
    for kind in ("calibration", "verification", *CHECK_KINDS):
        if (found := state.newest(kind)) is not None:
            files[kind] = folder / found.file.path
    if (probe := state.newest("probe")) is not None:
        beside = probe.companions if hasattr(probe, "companions") else probe.action.files
        files.update(("probe", folder / file.path) for name, file in beside.items() if name.endswith(".json"))
    return {kind: _json(file) for kind, file in files.items()}


def _json(file: Path) -> Content:
    try:
        content = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


@dataclass(frozen=True)
class Judged:
    """How the newest result of a kind stands."""

    found: Result | Input | None  # None: there is none, or somebody undid or rejected it
    state: CheckState
    why: str = ""  # Why it was rejected, is stale or failed
    broken: str = ""  # What is wrong with a file behind it: it does not count, whatever it says
    reasons: tuple[str, ...] = ()  # Of its verdict

    @property
    def day(self) -> str:
        """When it was made, for people."""
        return "" if self.found is None else minute_of(self.found.at)


class Judge:
    """
    Says how results stand.

    Parameters
    ----------
    state : State
    stale : mapping
        As `Session.stale` says.
    facts : mapping
        As `read_facts` says; a kind that is left out is taken to be good.
    trouble : SessionTrouble, optional
    """

    def __init__(
        self, state: State, stale: Stale, facts: Facts, trouble: SessionTrouble = NO_TROUBLE
    ) -> None:
        self.state, self.trouble, self._stale, self._facts = state, trouble, stale, facts

    def of(self, kind: str) -> Judged:
        """Return how the newest result of a kind stands."""
        found = self.state.newest(kind)
        if found is None:
            return Judged(None, CheckState.MISSING)
        if found.rejected:
            return Judged(None, CheckState.FAILED, "" if found.mark is None else found.mark.reason)
        if broken := self.trouble.behind(self.state, found):
            return Judged(found, CheckState.FAILED, broken, broken)
        if reasons := self._stale.get(found.slot, ()):
            return Judged(found, CheckState.STALE, reasons[0])
        verdict = self.verdict(kind)
        given = verdict.get("reasons")
        said = tuple(map(str, given)) if isinstance(given, list) else ()
        failed = (
            verdict.get("level") == "refuse"
            if kind == "calibration"
            else kind == "verification" and kind in self._facts and verdict.get("passed") is not True
        )
        why = said[0] if said else ""
        return Judged(found, CheckState.FAILED if failed else CheckState.DONE, why, reasons=said)

    def fact(self, kind: str, name: str) -> Any:
        """Return what the file of a kind's newest result has under a name; None: nothing."""
        return self._facts.get(kind, {}).get(name)

    def verdict(self, kind: str) -> Content:
        """Return the verdict of a calibration or a verification; empty: there is none."""
        found = self.fact(kind, "verdict")
        return found if isinstance(found, dict) else {}

    @property
    def figures(self) -> str:
        """How far off the touches of the verification were, in words; empty: nobody knows."""
        overall = self.fact("verification", "overall")
        mean, most = (
            overall.get(name) if isinstance(overall, dict) else None for name in ("mean_mm", "max_mm")
        )
        if not isinstance(mean, int | float) or not isinstance(most, int | float):
            return ""
        return message(f"{arg(mean):.2f} mm on average, {arg(most):.2f} mm at most")


# ---- the steps -------------------------------------------------------------------------------------


def statuses(
    state: State,
    stale: Stale,
    running: Iterable[Step],
    connected: bool,
    failed: Mapping[Step, str],
    facts: Facts | None = None,
    trouble: SessionTrouble = NO_TROUBLE,
) -> dict[Step, StepStatus]:
    """
    Say how every step stands.

    Parameters
    ----------
    state : State
    stale : mapping
        As `Session.stale` says.
    running : set of Step
        In which something goes on.
    connected : bool
        Whether the devices are open.
    failed : mapping
        Step -> what went wrong there last, in a sentence, until it is done again.
    facts : mapping, optional
        As `read_facts` says; left out, results are taken to be good.
    trouble : SessionTrouble, optional
        What is wrong with the session: the steps that rest on it, and the export, have failed until it is mended.
    """
    judge = Judge(state, stale, facts or {}, trouble)
    missing = _missing(judge)
    known = {
        Step.DEVICES: StepStatus(*_devices(state, connected)),
        Step.GRAVITY: StepStatus(*_gravity(judge)),
        Step.PROBE: StepStatus(*_probe(judge)),
        Step.REGIONS: StepStatus(*_regions(judge)),
        Step.VERIFY: StepStatus(*((StepState.LOCKED, missing) if missing else _verify(judge))),
        Step.EXPORT: StepStatus(*((StepState.LOCKED, missing) if missing else _export(judge))),
    }
    for step in running:
        known[step] = StepStatus(StepState.RUNNING, GOING_ON[step])
    for step, why in failed.items():
        # What is done holds, whatever went wrong afterwards; its page says so.
        if known[step].state in {StepState.READY, StepState.LOCKED, StepState.RUNNING}:
            known[step] = StepStatus(StepState.FAILED, why, broken=step in running)
    for step, why in _broken(judge, known).items():
        known[step] = StepStatus(StepState.FAILED, why, broken=True)
    return known


def _broken(judge: Judge, known: Mapping[Step, StepStatus]) -> dict[Step, str]:
    """Return what is wrong with the session, by the steps that rest on it."""
    trouble, found = judge.trouble, dict[Step, str]()
    behind = {
        kind: trouble.behind(judge.state, judge.state.newest(kind))
        for kind in ("calibration", "probe", "verification", "regions")
    }
    working = [step for step in Step if known[step].state in {StepState.READY, StepState.RUNNING}]
    recording = [step for step in (Step.GRAVITY, Step.VERIFY) if known[step].state is StepState.RUNNING]
    # The last of what holds for a step is what it says: a damaged file before a full disk before a cable.
    if trouble.devices:
        ready = [Step.EXPORT] if known[Step.EXPORT].state is StepState.READY else []
        found.update(dict.fromkeys((Step.DEVICES, *recording, *ready), trouble.devices))
    if trouble.disk:
        found.update(dict.fromkeys((*working, Step.EXPORT), trouble.disk))
    begun = judge.state.setting(PROBE_DRAFT)
    mesh = judge.state.input_with(str(begun.get("mesh"))) if isinstance(begun, dict) else None
    draft = trouble.behind(judge.state, mesh)
    verified = (behind["verification"], behind["calibration"], behind["probe"])
    every = (broken_behind(judge.state, trouble),)
    for step, sentences in (
        (Step.GRAVITY, (behind["calibration"],)),
        (Step.PROBE, (behind["probe"], draft)),
        (Step.REGIONS, (behind["regions"],)),
        (Step.VERIFY, verified),
        (Step.EXPORT, every),
    ):
        if said := next(filter(None, sentences), ""):
            found[step] = said
    return found


GOING_ON = {
    Step.DEVICES: message("Testing the devices."),
    Step.GRAVITY: message("Recording a calibration."),
    Step.PROBE: message("Preparing the probe."),
    Step.REGIONS: message("Applying the regions to the probe."),
    Step.VERIFY: message("Recording a verification."),
    Step.EXPORT: message("Writing a bundle."),
}


def _devices(state: State, connected: bool) -> tuple[StepState, str]:
    sensor = state.setting(SENSOR)
    if not sensor:
        words = message("Choose the sensor and the source of its orientation, then test the connection.")
        return StepState.READY, words
    scheme, name = str(sensor).partition("://")[0], str(sensor).partition("?")[0]
    name = {"virtual": message("the virtual bench"), "replay": "a recording"}.get(scheme, name)
    if not connected:
        return StepState.DONE, message(f"Chosen: {arg(name)}. Not connected: connect to measure.")
    words = message(f"Connected: {arg(name)}.")
    if not state.setting(POSES):
        words += message(" Its orientation is unknown, so gravity cannot be calibrated.")
    return StepState.DONE, words


def _gravity(judge: Judge) -> tuple[StepState, str]:
    judged = judge.of("calibration")
    if judged.found is None:
        if not judge.state.setting(SENSOR):
            return StepState.LOCKED, message("Choose the devices first.")
        return StepState.READY, message(
            "Hold the tool still in about six orientations; the next one is always shown."
        )
    if judged.state is CheckState.STALE:
        return StepState.STALE, message(f"{arg(judged.why)} Calibrate again.")
    if judged.state is CheckState.FAILED:
        return StepState.FAILED, message(f"The calibration was refused. {arg(judged.why)} Recalibrate.")
    usable = (
        message(" It is usable, but not good.")
        if judge.verdict("calibration").get("level") == "usable"
        else ""
    )
    return StepState.DONE, message(f"Calibrated on {arg(judged.day)}.{arg(usable)}")


def _probe(judge: Judge) -> tuple[StepState, str]:
    judged, draft = judge.of("probe"), judge.state.setting(PROBE_DRAFT)
    if judged.found is None:
        if draft:
            return StepState.READY, message("In preparation: continue where you left off, then use it.")
        return StepState.READY, message("Choose the probe's mesh, align it and simplify it.")
    if judged.state is CheckState.STALE:
        return StepState.STALE, message(f"{arg(judged.why)} Prepare it again.")
    begun = message(" Another one is in preparation: use it, or undo it.") if draft else ""
    return StepState.DONE, message(f"Prepared on {arg(judged.day)}.{arg(begun)}")


def _regions(judge: Judge) -> tuple[StepState, str]:
    where = standing(judge.state)
    if where is Standing.NONE:
        if judge.of("probe").found is None:
            return StepState.LOCKED, message("Prepare the probe first.")
        return StepState.READY, message(
            "Optional: paint where contacts are preferred, or continue with Verify."
        )
    if where is Standing.WAITING:
        words = message("The regions are painted but not applied to the probe yet: apply them.")
        return StepState.STALE, words
    if where is Standing.PLANNED:
        return StepState.DONE, message("Painted. The regions are applied when the probe is prepared.")
    return StepState.DONE, message("Painted and applied to the probe.")


def _verify(judge: Judge) -> tuple[StepState, str]:
    judged = judge.of("verification")
    if judged.found is None:
        return StepState.READY, message("Touch the markers to check that contacts are correct.")
    if judged.state is CheckState.STALE:
        return StepState.STALE, message(f"{arg(judged.why)} Verify again.")
    why = judged.why or judge.figures
    if judged.state is CheckState.FAILED:
        return StepState.FAILED, message(f"Not passed. {arg(why)} Correct the cause, then verify again.")
    return StepState.DONE, message(f"Passed: {arg(why)}.") if why else message(
        f"Verified on {arg(judged.day)}."
    )


def _export(judge: Judge) -> tuple[StepState, str]:
    parts = [judge.of(kind) for kind in ("calibration", "probe", "verification")]
    if parts[-1].found is None:
        return StepState.LOCKED, message("Verify first. For trials, an unverified bundle can be exported.")
    exported = judge.state.setting(RESULTS)
    if not exported:
        return StepState.READY, message("Review the bundle, then export it.")
    if exported != dict(results_of(judge.state)):
        return StepState.STALE, message("Results have changed since the last export: export again.")
    for part in parts:
        if part.state is CheckState.STALE:
            return StepState.STALE, message(f"{arg(part.why)} Repeat that, then export again.")
    return StepState.DONE, message("The latest results are exported.")


def _missing(judge: Judge) -> str:
    """Return what has to be done before contacts can be found; empty: nothing."""
    calibration, probe = judge.of("calibration"), judge.of("probe")
    if calibration.found is None:
        if probe.found is None:
            return message("Calibrate gravity and prepare the probe first.")
        return message("Calibrate gravity first.")
    if judge.verdict("calibration").get("level") == "refuse":
        return message("The calibration was refused: recalibrate gravity first.")
    return "" if probe.found is not None else message("Prepare the probe first.")


# ---- the checklist of an export --------------------------------------------------------------------


def checklist(
    folder: Path, state: State, stale: Stale, trouble: SessionTrouble = NO_TROUBLE
) -> tuple[CheckItem, ...]:
    """Say how everything stands that a bundle rests on; reads files, see `read_facts`."""
    judge = Judge(state, stale, read_facts(folder, state), trouble)
    checks = [
        _line(
            judge,
            message("Known weight"),
            "known_weight",
            Step.GRAVITY,
            message("Hang a known weight on the tool."),
        ),
        _line(
            judge,
            message("Known touch"),
            "known_touch",
            Step.VERIFY,
            message("Press a known point of the probe."),
        ),
    ]
    if any(each.state is CheckState.DONE for each in checks):  # one of them is enough
        checks = [
            replace(each, state=CheckState.OPTIONAL) if each.state is CheckState.MISSING else each
            for each in checks
        ]
    touch = message("Touch the markers to verify contacts.")
    report = message("Finish a verification: its report is part of the bundle.")
    calibrate = message("Calibrate the sensor with this tool.")
    return (
        _sensor_line(judge),
        _line(judge, "Calibration", "calibration", Step.GRAVITY, calibrate),
        _line(judge, "Probe", "probe", Step.PROBE, message("Prepare the probe's mesh.")),
        _regions_line(judge),
        _line(judge, "Verification", "verification", Step.VERIFY, touch),
        *checks,
        _line(judge, "Report", "report", Step.VERIFY, report),
    )


def _line(judge: Judge, name: str, kind: str, step: Step, remedy: str) -> CheckItem:
    """Return the line of the newest result of a kind."""
    judged = judge.of(kind)
    state = judged.state
    if judged.found is None and state is CheckState.MISSING:
        unseen = message("Not checked: a wrong sign, unit or scale of the sensor would go unnoticed. ")
        words = (unseen if kind in CHECK_KINDS else "") + remedy
    elif judged.found is None:
        words = message(f"It was rejected. {arg(judged.why)} {arg(remedy)}").strip()
    elif judged.broken:
        words = judged.broken
    elif state is CheckState.STALE:
        words = message(f"{arg(judged.why)} Repeat it.")
    elif kind in CHECK_KINDS:
        outcome, words = judge.fact(kind, "outcome"), str(judge.fact(kind, "sentence") or "")
        if outcome == "failed":
            state, words = CheckState.FAILED, words or message(f"The check failed. {arg(remedy)}")
        elif outcome != "passed":
            state = CheckState.MISSING
    elif kind == "calibration" and state is CheckState.FAILED:
        words = message("The calibration was refused: recalibrate.")
    elif kind == "verification":
        if state is CheckState.FAILED:
            words = message(
                f"Not passed: {arg(join('; ', judged.reasons) or message('see its report'))}. Verify again."
            )
        else:
            words = message(f"Passed: {arg(judge.figures)}.") if judge.figures else "Passed."
    else:
        words = message(f"Made on {arg(judged.day)}.")
    return CheckItem(name, state, words, step)


def _sensor_line(judge: Judge) -> CheckItem:
    state = judge.state
    if judge.trouble.devices:
        return CheckItem("Sensor", CheckState.FAILED, judge.trouble.devices, Step.DEVICES)
    known = [state.setting(key) for key in ("config.serial", SERIAL)]
    known = [each for each in known if each]
    known += sorted({each.sensor for each in state.current_inputs.values() if each.sensor})
    if known:
        return CheckItem("Sensor", CheckState.DONE, message(f"Serial number {arg(known[0])}."), Step.DEVICES)
    words = message("Serial number missing: the bundle would say 'unknown'. Enter it below.")
    return CheckItem("Sensor", CheckState.MISSING, words, Step.DEVICES)


def _regions_line(judge: Judge) -> CheckItem:
    if broken := judge.trouble.behind(judge.state, judge.state.newest("regions")):
        return CheckItem("Regions", CheckState.FAILED, broken, Step.REGIONS)
    given = judge.fact("probe", "regions")
    count = len(given) if isinstance(given, list) else 0
    state = CheckState.DONE
    if count:
        regions = message("one priority region") if count == 1 else message(f"{arg(count)} priority regions")
        words = message(f"The probe has {arg(regions)}.")
    elif judge.state.newest("regions") is not None:
        state = CheckState.MISSING
        words = message("Regions are painted but not applied to the probe yet: apply them.")
    else:
        state = CheckState.OPTIONAL
        words = message("No priority regions: all candidates are equal. That is fine for most probes.")
    return CheckItem("Regions", state, words, Step.REGIONS)


def results_of(state: State) -> Mapping[str, str]:
    """Return kind -> content of the newest results that a bundle is made of: what an export is an export of."""
    found = {kind: state.newest(kind) for kind in _MADE_OF}
    return {kind: each.content for kind, each in found.items() if each is not None}


def broken_behind(state: State, trouble: SessionTrouble) -> str:
    """Return what is wrong with a file behind any of the results that a bundle is made of; empty: nothing."""
    return next(filter(None, (trouble.behind(state, state.newest(kind)) for kind in _MADE_OF)), "")


def files_of_bundle(state: State) -> tuple[FileRef, ...]:
    """Return the files behind all results that a bundle is made of, those of each once."""
    newest = (state.newest(kind) for kind in _MADE_OF)
    refs = (ref for each in newest if each is not None for ref in files_behind(state, each))
    return tuple({ref.path: ref for ref in refs}.values())


def refuse_without(state: State) -> None:
    """InputError unless there is what no bundle can do without."""
    for kind, what in (
        ("calibration", message("Calibrate first.")),
        ("probe", message("Prepare the probe first.")),
    ):
        if state.newest(kind) is None:
            raise InputError(f"There is no {arg(kind)} yet, so nothing can be exported. {arg(what)}")
