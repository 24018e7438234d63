"""How every step of a session stands, in a state and a sentence that says what to do next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.workbench.export import RESULTS
from contactbench.pipeline.workbench.export_checklist import (
    content_of,
    day_of,
    figures_of,
    results_of,
    verdict_of,
)
from contactbench.pipeline.workbench.regions_session import Standing, standing
from contactbench.pipeline.workbench.steps import Step, StepState, StepStatus

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from contactbench.pipeline.session import State
    from contactbench.pipeline.session.state import Input, Result

    Stale = Mapping[tuple[str, str], tuple[str, ...]]

SENSOR, POSES, SERIAL, MOUNT = "devices.sensor", "devices.poses", "devices.serial", "devices.mount"


@dataclass(frozen=True)
class Facts:
    """What the files of a session's newest results say, as far as it decides how steps stand."""

    calibration: str = ""  # "good", "usable", "refuse", or empty: there is none, or it cannot be read
    calibration_why: str = ""  # The first reason of its verdict
    passed: bool | None = None  # Whether the verification did; None: there is none
    passed_why: str = ""  # The first reason why not, or the figures


def read_facts(folder: Path, state: State) -> Facts:
    """Read what a session's small JSON files say; what cannot be read is left out: whoever needs it says why."""
    calibration, verification = (
        {} if found is None else content_of(folder, found)
        for found in map(state.newest, ("calibration", "verification"))
    )
    fit, judged = verdict_of(calibration), verdict_of(verification)
    passed = judged.get("passed")
    return Facts(
        str(fit.get("level", "")),
        _first(fit),
        passed if isinstance(passed, bool) else None,
        _first(judged) or figures_of(verification),
    )


def _first(verdict: Mapping[str, Any]) -> str:
    reasons = verdict.get("reasons")
    return str(reasons[0]) if isinstance(reasons, list) and reasons else ""


# ---- the steps -------------------------------------------------------------------------------------


def statuses(
    state: State,
    stale: Stale,
    running: Iterable[Step],
    connected: bool,
    failed: Mapping[Step, str],
    facts: Facts | None = None,
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
    facts : Facts, optional
        As `read_facts` says; left out, results are taken to be good.
    """
    judge = _Judge(state, stale, connected, facts or Facts())
    known = {
        Step.DEVICES: judge.devices(),
        Step.GRAVITY: judge.gravity(),
        Step.PROBE: judge.probe(),
        Step.REGIONS: judge.regions(),
        Step.VERIFY: judge.verify(),
        Step.EXPORT: judge.export(),
    }
    for step, why in failed.items():
        # What is done holds, whatever went wrong afterwards; its page says so.
        if known[step].state in {StepState.READY, StepState.LOCKED}:
            known[step] = StepStatus(StepState.FAILED, why)
    for step in running:
        known[step] = StepStatus(StepState.RUNNING, _GOING_ON[step])
    return known


_GOING_ON = {
    Step.DEVICES: "The devices are being tried.",
    Step.GRAVITY: "A calibration is being recorded.",
    Step.PROBE: "The probe is being prepared.",
    Step.REGIONS: "The regions are being put on the probe.",
    Step.VERIFY: "A verification is being recorded.",
    Step.EXPORT: "A bundle is being written.",
}


class _Judge:
    def __init__(self, state: State, stale: Stale, connected: bool, facts: Facts) -> None:
        self._state, self._stale, self._connected, self._facts = state, stale, connected, facts
        self._calibration, self._probe, self._verification = (
            self._newest(kind) for kind in ("calibration", "probe", "verification")
        )

    def _newest(self, kind: str) -> Result | Input | None:
        """Return what a step gave; None also for what somebody undid or rejected: it is to be done again."""
        found = self._state.newest(kind)
        return None if found is None or found.rejected else found

    def _why_stale(self, found: Result | Input) -> str | None:
        reasons = self._stale.get(found.slot, ())
        return reasons[0] if reasons else None

    def devices(self) -> StepStatus:
        sensor, poses = self._state.setting(SENSOR), self._state.setting(POSES)
        if not sensor:
            words = "Choose the sensor and where its orientation comes from, then test the connection."
            return StepStatus(StepState.READY, words)
        name = _device_name(str(sensor))
        if not self._connected:
            return StepStatus(StepState.DONE, f"Chosen: {name}. It is not connected: connect it to measure.")
        words = f"Connected: {name}."
        if not poses:
            words += " Nothing tells its orientation: gravity cannot be calibrated without."
        return StepStatus(StepState.DONE, words)

    def gravity(self) -> StepStatus:
        found = self._calibration
        if found is None:
            if not self._state.setting(SENSOR):
                return StepStatus(StepState.LOCKED, "Choose the devices first.")
            words = "Hold the tool still in about six orientations; the next one is shown."
            return StepStatus(StepState.READY, words)
        if why := self._why_stale(found):
            return StepStatus(StepState.STALE, f"{why} Calibrate again.")
        why = self._facts.calibration_why
        if self._facts.calibration == "refuse":
            return StepStatus(StepState.FAILED, f"The calibration was refused. {why} Calibrate again.")
        usable = " It is usable, not good." if self._facts.calibration == "usable" else ""
        return StepStatus(StepState.DONE, f"Calibrated on {day_of(found)}.{usable}")

    def probe(self) -> StepStatus:
        found = self._probe
        if found is None:
            return StepStatus(
                StepState.READY, "Choose the probe's mesh, put it where it is, and simplify it."
            )
        if why := self._why_stale(found):
            return StepStatus(StepState.STALE, f"{why} Prepare it again.")
        return StepStatus(StepState.DONE, f"Prepared on {day_of(found)}.")

    def regions(self) -> StepStatus:
        where = standing(self._state)
        if self._probe is None and where is Standing.NONE:
            return StepStatus(StepState.LOCKED, "Prepare the probe first.")
        if where is Standing.NONE:
            words = "Not needed: paint where contacts are preferred, or go on to Verify."
            return StepStatus(StepState.READY, words)
        if where is Standing.WAITING:
            words = "The regions are painted, but the probe does not have them yet: apply them."
            return StepStatus(StepState.STALE, words)
        if where is Standing.PLANNED:
            return StepStatus(StepState.DONE, "Painted. The probe gets them when it is prepared.")
        return StepStatus(StepState.DONE, "Painted, and on the probe.")

    def verify(self) -> StepStatus:
        if missing := self._missing():
            return StepStatus(StepState.LOCKED, missing)
        found = self._verification
        if found is None:
            return StepStatus(StepState.READY, "Touch the markers: that shows whether contacts are right.")
        if why := self._why_stale(found):
            return StepStatus(StepState.STALE, f"{why} Verify again.")
        why = self._facts.passed_why
        if self._facts.passed is False:
            return StepStatus(
                StepState.FAILED, f"It did not pass. {why} See what to mend, then verify again."
            )
        return StepStatus(StepState.DONE, f"Passed: {why}." if why else f"Verified on {day_of(found)}.")

    def export(self) -> StepStatus:
        if missing := self._missing():
            return StepStatus(StepState.LOCKED, missing)
        if self._verification is None:
            return StepStatus(
                StepState.LOCKED, "Verify first; for trials, an unverified bundle can be written."
            )
        exported = self._state.setting(RESULTS)
        if not exported:
            return StepStatus(StepState.READY, "See what is in the bundle, then export it.")
        if exported != dict(results_of(self._state)):
            words = "Something was computed anew since the last export: export again."
            return StepStatus(StepState.STALE, words)
        if old := [each for each in self._parts() if self._why_stale(each)]:
            return StepStatus(StepState.STALE, f"{self._why_stale(old[0])} Do that again, then export again.")
        return StepStatus(StepState.DONE, "The newest results are exported.")

    def _parts(self) -> list[Result | Input]:
        return [each for each in (self._calibration, self._probe, self._verification) if each is not None]

    def _missing(self) -> str:
        """Return what has to be done before contacts can be found; empty: nothing."""
        if self._calibration is None and self._probe is None:
            return "Calibrate gravity and prepare the probe first."
        if self._calibration is None:
            return "Calibrate gravity first."
        if self._facts.calibration == "refuse":
            return "The calibration was refused: calibrate gravity again first."
        return "" if self._probe is not None else "Prepare the probe first."


def _device_name(address: str) -> str:
    scheme = address.partition("://")[0]
    return {"virtual": "the virtual bench", "replay": "a recording"}.get(scheme, address.partition("?")[0])
