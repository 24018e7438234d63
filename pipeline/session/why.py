"""
Why a session stands as it does: the one answer for its results, its steps and what an export rests on.

A result may be stale, because something that it was computed from changed since (`stale_results`); a file behind it may
be damaged, or the disk or a device may have failed (`SessionTrouble`); or the result itself says that it is no good
(`read_facts`). `statuses` makes of all that a state and a sentence for each step, `checklist` the same line by line for
an export.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.session.actions import FileRef, files_of
from contactbench.pipeline.session.files import file_problem, touched_mark
from contactbench.pipeline.session.recompute import parameter_of
from contactbench.pipeline.session.state import MESH, Input, Recorded, Result, State, minute_of, sources_of
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT

Content = dict[str, Any]
Facts = Mapping[str, Content]
Stale = Mapping[tuple[str, str], tuple[str, ...]]


SENSOR, POSES, SERIAL, MOUNT = "devices.sensor", "devices.poses", "devices.serial", "devices.mount"
CERTIFICATE, DUE = "report.certificate", "report.due"
RESULTS = "export.results"
_CHECKS = (WEIGHT, TOUCH)
_MADE_OF = ("calibration", "probe", "verification", *_CHECKS, "report")  # of these, a bundle
PROBE_DRAFT = "draft.probe"  # as `probe_draft` keeps it; here without what that needs


# ---- stale ----------------------------------------------------------------------------------------


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
    follows = _Follows(state)
    return {slot: follows.reasons(result) for slot, result in state.current_results.items()}


class _Follows:
    def __init__(self, state: State) -> None:
        self._inputs, self._results = state.current_inputs, state.current_results
        self._outcomes = {slot: result.outcome for slot, result in self._results.items()}
        self._sources = sources_of(state)
        self._recorded = Recorded(state.inputs)
        self._rezeros = {each.sensor: each for each in state.rezeros}  # the newest of each sensor
        self._settings = {kind: state.named(kind) for kind, _ in self._results}
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
        for parameter, setting in self._settings[kind].items():
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


# ---- broken ---------------------------------------------------------------------------------------

DISK = message(
    "The last write failed, so nothing is written to this session at the moment. Free disk space,"
    " or check the disk; writing then resumes automatically."
)


@dataclass(frozen=True)
class SessionTrouble:
    """What is wrong, in sentences that say the remedy; empty ones: nothing."""

    disk: str = ""  # Why nothing is written
    devices: str = ""  # Why no readings, or no poses, come
    files: Mapping[str, str] = field(default_factory=dict)  # Place of a file -> what is wrong with it

    @property
    def sentences(self) -> tuple[str, ...]:
        """All of it."""
        return tuple(filter(None, (self.disk, self.devices, *self.files.values())))

    def behind(self, state: State, found: Result | Input | None) -> str:
        """Return what is wrong with a result, with an input, or with anything that it was computed from."""
        if found is None or not self.files:
            return ""
        return next(
            (self.files[ref.path] for ref in files_behind(state, found) if ref.path in self.files), ""
        )


NO_TROUBLE = SessionTrouble()


def files_behind(state: State, found: Result | Input) -> Iterator[FileRef]:
    """Yield the files of a result or an input, then of all that it was computed from."""
    waiting, met = [found], set[int]()
    while waiting:
        each = waiting.pop(0)
        if each.number in met:
            continue
        met.add(each.number)
        if not isinstance(each, Result):
            yield from (each.file, *each.companions.values())
            continue
        yield from each.action.files.values()
        for sha256 in each.action.inputs.values():
            sources = (state.input_with(sha256, each.number), state.result_with(sha256, each.number))
            waiting += [source for source in sources if source is not None]


class FileWatch:
    """
    Looks at the files of a session: the first time at every byte, after that at those that were touched since.

    Parameters
    ----------
    folder : Path
        Of the session.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._seen: dict[str, tuple[tuple[int, int, int] | None, str]] = {}

    def look(self, state: State, cancelled: Callable[[], bool] = lambda: False) -> dict[str, str]:
        """Return what is wrong: place of a file -> sentence. Stopped, it knows the rest as it was before."""
        refs = {ref.path: ref for each in state.inputs for ref in (each.file, *each.companions.values())}
        refs |= {ref.path: ref for each in state.results for ref in files_of(each.action)}
        for place, ref in refs.items():
            if cancelled():
                break
            mark = touched_mark(self._folder / place)
            if place not in self._seen or self._seen[place][0] != mark:
                self._seen[place] = (mark, file_problem(self._folder, ref))
        return {place: why for place, (_, why) in self._seen.items() if why and place in refs}


# ---- what the results say --------------------------------------------------------------------------


def read_facts(folder: Path, state: State) -> dict[str, Content]:
    """
    Return what the small JSON file of each kind's newest result says, of a probe the one beside it.

    It reads files, so not in a window's thread. Empty where one cannot be read: whoever needs it says why.
    """
    files: dict[str, Path] = {}
    for kind in ("calibration", "verification", *_CHECKS):
        if (found := state.newest(kind)) is not None:
            files[kind] = folder / found.file.path
    if (probe := state.newest("probe")) is not None:
        beside = probe.action.files if isinstance(probe, Result) else probe.companions
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


class Standing:
    """
    Says how the newest result of each kind stands.

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
        if broken := self.broken(kind):
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

    def broken(self, *kinds: str) -> str:
        """Return what is wrong with a file behind the newest result or input of kinds; empty: nothing."""
        found = (self.trouble.behind(self.state, self.state.newest(kind)) for kind in kinds)
        return next(filter(None, found), "")

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
    standing = Standing(state, stale, facts or {}, trouble)
    missing = _missing(standing)
    known = {
        Step.DEVICES: StepStatus(*_devices(state, connected)),
        Step.GRAVITY: StepStatus(*_gravity(standing)),
        Step.PROBE: StepStatus(*_probe(standing)),
        Step.REGIONS: StepStatus(*_regions(standing)),
        Step.VERIFY: StepStatus(*((StepState.LOCKED, missing) if missing else _verify(standing))),
        Step.EXPORT: StepStatus(*((StepState.LOCKED, missing) if missing else _export(standing))),
    }
    for step in running:
        known[step] = StepStatus(StepState.RUNNING, GOING_ON[step])
    for step, why in failed.items():
        # What is done holds, whatever went wrong afterwards; its page says so.
        if known[step].state in {StepState.READY, StepState.LOCKED, StepState.RUNNING}:
            known[step] = StepStatus(StepState.FAILED, why, broken=step in running)
    for step, why in _broken(standing, known).items():
        known[step] = StepStatus(StepState.FAILED, why, broken=True)
    return known


def _broken(standing: Standing, known: Mapping[Step, StepStatus]) -> dict[Step, str]:
    """Return what is wrong with the session, by the steps that rest on it."""
    trouble, found = standing.trouble, dict[Step, str]()
    working = [step for step in Step if known[step].state in {StepState.READY, StepState.RUNNING}]
    recording = [step for step in (Step.GRAVITY, Step.VERIFY) if known[step].state is StepState.RUNNING]
    # The last of what holds for a step is what it says: a damaged file before a full disk before a cable.
    if trouble.devices:
        ready = [Step.EXPORT] if known[Step.EXPORT].state is StepState.READY else []
        found.update(dict.fromkeys((Step.DEVICES, *recording, *ready), trouble.devices))
    if trouble.disk:
        found.update(dict.fromkeys((*working, Step.EXPORT), trouble.disk))
    begun = standing.state.setting(PROBE_DRAFT)
    mesh = standing.state.input_with(str(begun.get("mesh"))) if isinstance(begun, dict) else None
    files = {step: standing.broken(*kinds) for step, kinds in _RESTS_ON.items()}
    files[Step.PROBE] = files[Step.PROBE] or trouble.behind(standing.state, mesh)
    return found | {step: why for step, why in files.items() if why}


_RESTS_ON = {
    Step.GRAVITY: ("calibration",),
    Step.PROBE: ("probe",),
    Step.REGIONS: ("regions",),
    Step.VERIFY: ("verification", "calibration", "probe"),
    Step.EXPORT: _MADE_OF,
}
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


def _gravity(standing: Standing) -> tuple[StepState, str]:
    standingd = standing.of("calibration")
    if standingd.found is None:
        if not standing.state.setting(SENSOR):
            return StepState.LOCKED, message("Choose the devices first.")
        return StepState.READY, message(
            "Hold the tool still in about six orientations; the next one is always shown."
        )
    if standingd.state is CheckState.STALE:
        return StepState.STALE, message(f"{arg(standingd.why)} Calibrate again.")
    if standingd.state is CheckState.FAILED:
        return StepState.FAILED, message(f"The calibration was refused. {arg(standingd.why)} Recalibrate.")
    usable = (
        message(" It is usable, but not good.")
        if standing.verdict("calibration").get("level") == "usable"
        else ""
    )
    return StepState.DONE, message(f"Calibrated on {arg(standingd.day)}.{arg(usable)}")


def _probe(standing: Standing) -> tuple[StepState, str]:
    standingd, draft = standing.of("probe"), standing.state.setting(PROBE_DRAFT)
    if standingd.found is None:
        if draft:
            return StepState.READY, message("In preparation: continue where you left off, then use it.")
        return StepState.READY, message("Choose the probe's mesh, align it and simplify it.")
    if standingd.state is CheckState.STALE:
        return StepState.STALE, message(f"{arg(standingd.why)} Prepare it again.")
    begun = message(" Another one is in preparation: use it, or undo it.") if draft else ""
    return StepState.DONE, message(f"Prepared on {arg(standingd.day)}.{arg(begun)}")


class RegionsState(StrEnum):
    """How the regions that are kept relate to the probe."""

    NONE = "none"  # nothing is kept
    PLANNED = "planned"  # kept; there is no probe yet, it takes them along when it is made
    WAITING = "waiting"  # kept, but the probe does not have them yet
    APPLIED = "applied"


def regions_state(state: State) -> RegionsState:
    """Say whether the newest probe has the regions that the session keeps."""
    kept, made = state.newest("regions"), state.made("probe")
    if kept is None:
        return RegionsState.NONE
    if made is None:
        return RegionsState.PLANNED
    return RegionsState.APPLIED if made.action.inputs.get("regions") == kept.content else RegionsState.WAITING


def _regions(standing: Standing) -> tuple[StepState, str]:
    match regions_state(standing.state):
        case RegionsState.NONE if standing.of("probe").found is None:
            return StepState.LOCKED, message("Prepare the probe first.")
        case RegionsState.NONE:
            return StepState.READY, message(
                "Optional: paint where contacts are preferred, or continue with Verify."
            )
        case RegionsState.WAITING:
            words = message("The regions are painted but not applied to the probe yet: apply them.")
            return StepState.STALE, words
        case RegionsState.PLANNED:
            return StepState.DONE, message("Painted. The regions are applied when the probe is prepared.")
    return StepState.DONE, message("Painted and applied to the probe.")


def _verify(standing: Standing) -> tuple[StepState, str]:
    standingd = standing.of("verification")
    if standingd.found is None:
        return StepState.READY, message("Touch the markers to check that contacts are correct.")
    if standingd.state is CheckState.STALE:
        return StepState.STALE, message(f"{arg(standingd.why)} Verify again.")
    why = standingd.why or standing.figures
    if standingd.state is CheckState.FAILED:
        return StepState.FAILED, message(f"Not passed. {arg(why)} Correct the cause, then verify again.")
    return StepState.DONE, message(f"Passed: {arg(why)}.") if why else message(
        f"Verified on {arg(standingd.day)}."
    )


def _export(standing: Standing) -> tuple[StepState, str]:
    parts = [standing.of(kind) for kind in ("calibration", "probe", "verification")]
    if parts[-1].found is None:
        return StepState.LOCKED, message("Verify first. For trials, an unverified bundle can be exported.")
    exported = standing.state.setting(RESULTS)
    if not exported:
        return StepState.READY, message("Review the bundle, then export it.")
    if exported != dict(results_of(standing.state)):
        return StepState.STALE, message("Results have changed since the last export: export again.")
    for part in parts:
        if part.state is CheckState.STALE:
            return StepState.STALE, message(f"{arg(part.why)} Repeat that, then export again.")
    return StepState.DONE, message("The latest results are exported.")


def _missing(standing: Standing) -> str:
    """Return what has to be done before contacts can be found; empty: nothing."""
    calibration, probe = standing.of("calibration"), standing.of("probe")
    if calibration.found is None:
        if probe.found is None:
            return message("Calibrate gravity and prepare the probe first.")
        return message("Calibrate gravity first.")
    if standing.verdict("calibration").get("level") == "refuse":
        return message("The calibration was refused: recalibrate gravity first.")
    return "" if probe.found is not None else message("Prepare the probe first.")


def why_locked(state: State, *kinds: str) -> str:
    """Say what is missing before touches can be located, of some kinds or of all; empty: nothing."""
    missing = [kind for kind in kinds or ("calibration", "probe") if state.newest(kind) is None]
    if not missing:
        return ""
    steps = {
        "calibration": message("calibrate in step 2, Gravity"),
        "probe": message("prepare the probe in step 3, Probe"),
    }
    todo = join(message(", and "), (steps[kind] for kind in missing))
    return message(
        f"A contact cannot be located without {arg(join(message(' and '), missing))}: {arg(todo)}."
    )


# ---- the checklist of an export --------------------------------------------------------------------


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


def checklist(
    folder: Path, state: State, stale: Stale, trouble: SessionTrouble = NO_TROUBLE
) -> tuple[CheckItem, ...]:
    """Say how everything stands that a bundle rests on; reads files, see `read_facts`."""
    standing = Standing(state, stale, read_facts(folder, state), trouble)
    checks = [
        _line(
            standing,
            message("Known weight"),
            "known_weight",
            Step.GRAVITY,
            message("Hang a known weight on the tool."),
        ),
        _line(
            standing,
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
        _sensor_line(standing),
        _line(standing, message("Calibration"), "calibration", Step.GRAVITY, calibrate),
        _line(standing, message("Probe"), "probe", Step.PROBE, message("Prepare the probe's mesh.")),
        _regions_line(standing),
        _line(standing, message("Verification"), "verification", Step.VERIFY, touch),
        *checks,
        _line(standing, message("Report"), "report", Step.VERIFY, report),
    )


def _line(standing: Standing, name: str, kind: str, step: Step, remedy: str) -> CheckItem:
    """Return the line of the newest result of a kind."""
    standingd = standing.of(kind)
    state = standingd.state
    if standingd.found is None and state is CheckState.MISSING:
        words = remedy
    elif standingd.found is None:
        words = message(f"It was rejected. {arg(standingd.why)} {arg(remedy)}").strip()
    elif standingd.broken:
        words = standingd.broken
    elif state is CheckState.STALE:
        words = message(f"{arg(standingd.why)} Repeat it.")
    elif kind in _CHECKS:
        outcome, words = standing.fact(kind, "outcome"), str(standing.fact(kind, "sentence") or "")
        if outcome == "failed":
            state, words = CheckState.FAILED, words or message(f"The check failed. {arg(remedy)}")
        elif outcome != "passed":
            state = CheckState.MISSING
    elif kind == "calibration" and state is CheckState.FAILED:
        words = message("The calibration was refused: recalibrate.")
    elif kind == "verification":
        if state is CheckState.FAILED:
            words = message(
                f"Not passed: {arg(join('; ', standingd.reasons) or message('see its report'))}. Verify again."
            )
        else:
            words = message(f"Passed: {arg(standing.figures)}.") if standing.figures else "Passed."
    else:
        words = message(f"Made on {arg(standingd.day)}.")
    return CheckItem(name, state, words, step)


def _sensor_line(standing: Standing) -> CheckItem:
    name, state = message("Sensor"), standing.state
    if standing.trouble.devices:
        return CheckItem(name, CheckState.FAILED, standing.trouble.devices, Step.DEVICES)
    known = [state.setting(key) for key in ("config.serial", SERIAL)]
    known = [each for each in known if each]
    known += sorted({each.sensor for each in state.current_inputs.values() if each.sensor})
    if known:
        return CheckItem(name, CheckState.DONE, message(f"Serial number {arg(known[0])}."), Step.DEVICES)
    words = message("Serial number missing: the bundle would say 'unknown'. Enter it below.")
    return CheckItem(name, CheckState.MISSING, words, Step.DEVICES)


def _regions_line(standing: Standing) -> CheckItem:
    if broken := standing.broken("regions"):
        return CheckItem(message("Regions"), CheckState.FAILED, broken, Step.REGIONS)
    given = standing.fact("probe", "regions")
    count = len(given) if isinstance(given, list) else 0
    state = CheckState.DONE
    if count:
        words = message(f"The probe has {arg(regions_in_words(count))}.")
    elif standing.state.newest("regions") is not None:
        state = CheckState.MISSING
        words = message("Regions are painted but not applied to the probe yet: apply them.")
    else:
        state = CheckState.OPTIONAL
        words = message("No priority regions: all candidates are equal. That is fine for most probes.")
    return CheckItem(message("Regions"), state, words, Step.REGIONS)


def regions_in_words(count: int) -> str:
    """Say how many regions a probe has."""
    if count == 1:
        return message("one priority region")
    return message(f"{arg(count)} priority regions") if count else message("no priority regions")


def results_of(state: State) -> Mapping[str, str]:
    """Return kind -> content of the newest results that a bundle is made of: what an export is an export of."""
    found = {kind: state.newest(kind) for kind in _MADE_OF}
    return {kind: each.content for kind, each in found.items() if each is not None}


def broken_behind(state: State, trouble: SessionTrouble) -> str:
    """Return what is wrong with a file behind any of the results that a bundle is made of; empty: nothing."""
    return Standing(state, {}, {}, trouble).broken(*_MADE_OF)


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
