"""What a session's verification says: read from its result, made from the raw recording."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.recompute import compute, newest_inputs
from contactbench.pipeline.verification.figures import ModelError
from contactbench.pipeline.workbench.verify_settings import KIND, REPORT, RESULT, parameters_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.workbench.verify_touches import TouchView

_SAME_MM = 0.05


@dataclass(frozen=True)
class MarkerOutcome:
    """Of one marker, mm."""

    name: str
    touches: int
    mean_mm: float
    max_mm: float
    bias_mm: tuple[float, float, float]


@dataclass(frozen=True)
class Outcome:
    """
    A verification, as it is shown.

    Attributes
    ----------
    passed : bool
    reasons, notes, warnings : tuple of str
        Why not; what it says nothing about; what to know of the recording.
    diagnosis : str
        What to fix first; empty: too few touches.
    touches : int
        Accepted.
    mean_mm, sd_mm, p95_mm, max_mm : float or None
    low_mm, high_mm : float or None
        The mean is between them, 95 %.
    ratio : float or None
        Error over what noise and calibration explain.
    mean_limit_mm, max_limit_mm : float
    rejected : tuple of (reason, count)
    markers : tuple of MarkerOutcome
    report : Path or None
    differs : str
        What was another while it was live; empty: nothing.
    stale : str
        Why it no longer holds; empty: it does.
    model_error : str
        What the model leaves out of the wrench, and what to do about it.
    """

    passed: bool
    reasons: tuple[str, ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    diagnosis: str
    touches: int
    mean_mm: float | None
    sd_mm: float | None
    p95_mm: float | None
    max_mm: float | None
    low_mm: float | None
    high_mm: float | None
    ratio: float | None
    mean_limit_mm: float
    max_limit_mm: float
    rejected: tuple[tuple[str, int], ...]
    markers: tuple[MarkerOutcome, ...]
    report: Path | None
    differs: str = ""
    stale: str = ""
    model_error: str = ""

    def with_difference(self, words: str) -> Outcome:
        """Return it with what was another while it was live."""
        return replace(self, differs=words)


def outcome_of(
    folder: Path,
    state: State,
    stale: Mapping[tuple[str, str], tuple[str, ...]],
    live: TouchView | None = None,
) -> Outcome | None:
    """
    Read a session's verification; None: there is none.

    Parameters
    ----------
    folder : Path
    state : State
    stale : mapping
        As `Session.stale` says.
    live : TouchView, optional
        What was seen while it was recorded.

    Raises
    ------
    InputError
        It cannot be read.
    """
    found = state.current_results.get((KIND, RESULT))
    if found is None:
        return None
    file = folder / found.file.path
    try:
        content = json.loads(file.read_bytes())
        outcome = _read(content, _report(folder, state, found.known_as))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{file}: the verification cannot be read ({error}): see `contactbench session verify`."
        ) from error
    reasons = stale.get(found.slot, ())
    return replace(
        outcome, differs="" if live is None else differs(outcome, live), stale=" ".join(reasons[:1])
    )


def _report(folder: Path, state: State, verification: set[str]) -> Path | None:
    found = state.current_results.get(("report", REPORT))
    if found is None or not set(found.action.inputs.values()) & verification:
        return None
    return folder / found.file.path


def _read(content: dict[str, Any], report: Path | None) -> Outcome:
    from contactbench.pipeline.verification.model_error import model_error_words

    verdict, overall = content["verdict"], content.get("overall") or {}
    interval = (content.get("ci") or {}).get("mean_mm") or (None, None)
    diagnosis, left = content.get("diagnosis") or {}, content.get("model_error")
    return Outcome(
        passed=bool(verdict["passed"]),
        reasons=tuple(verdict["reasons"]),
        notes=tuple(verdict.get("notes", ())),
        warnings=tuple(content.get("warnings", ())),
        diagnosis=str(diagnosis.get("text", "")),
        touches=int(overall.get("touches", 0)),
        mean_mm=overall.get("mean_mm"),
        sd_mm=overall.get("sd_mm"),
        p95_mm=overall.get("p95_mm"),
        max_mm=overall.get("max_mm"),
        low_mm=interval[0],
        high_mm=interval[1],
        ratio=content.get("ratio"),
        mean_limit_mm=1e3 * float(content["limits"]["mean_m"]),
        max_limit_mm=1e3 * float(content["limits"]["max_m"]),
        rejected=tuple((str(why), int(count)) for why, count in content.get("rejected", {}).items()),
        markers=tuple(
            MarkerOutcome(
                str(each["name"]),
                int(each["touches"]),
                float(each["mean_mm"]),
                float(each["max_mm"]),
                (float(each["bias_mm"][0]), float(each["bias_mm"][1]), float(each["bias_mm"][2])),
            )
            for each in content.get("per_marker", ())
        ),
        report=report,
        model_error=model_error_words(None if left is None else ModelError(**left)),
    )


def differs(outcome: Outcome, live: TouchView) -> str:
    """Say what the raw recording gave otherwise than what was seen while it was made; empty: nothing."""
    if live.mean_mm is None or outcome.mean_mm is None:
        if live.accepted == outcome.touches:
            return ""
        return (
            f"Live, {live.accepted} touches were accepted; the recording gives {outcome.touches}."
            " The recording counts."
        )
    same_count = live.accepted == outcome.touches
    if same_count and abs(live.mean_mm - outcome.mean_mm) <= _SAME_MM:
        return ""
    return (
        f"Live, {live.accepted} touches were accepted with a mean error of {live.mean_mm:.2f} mm; the recording gives"
        f" {outcome.touches} with {outcome.mean_mm:.2f} mm, because its noise is known as a whole. The recording"
        " counts."
    )


def judge_recording(
    session: Session,
    recording: str,
    given: Mapping[str, Any] | None = None,
    used: Mapping[str, str] | None = None,
) -> None:
    """
    Compute verification and report from a recording of the session, with the session's settings.

    As ``contactbench session compute SESSION verification verification.json --input recording=NAME``, with ``--set``
    for each parameter, and then ``report report.html``.

    Parameters
    ----------
    session : Session
        Open for writing.
    recording : str
        Its name.
    given : mapping, optional
        Parameters that count more than the session's settings, such as the order in which markers were asked for.
    used : mapping, optional
        Role -> hash of what was touched with, where that is not the newest.

    Raises
    ------
    InputError
        The recording holds no touch, or something is missing.
    """
    parameters = parameters_of(session.state, given)
    inputs = newest_inputs(session.state, KIND, {"recording": recording})
    compute(session, KIND, RESULT, {**inputs, **(used or {})}, parameters)
    compute(session, "report", REPORT, newest_inputs(session.state, "report"), {})
