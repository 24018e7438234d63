"""From a recording of touches on markers to a verification."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.budget import BudgetRow, BudgetSource, input_row, parameter_rows
from contactbench.pipeline.calibration.model import prediction_jacobian
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.contact.following import follow_words
from contactbench.pipeline.errors import InputError, arg, capitalised, message
from contactbench.pipeline.kernel import Zero
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.preparation.alignment.alignment import across
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM
from contactbench.pipeline.verification.causes import TouchEvidence, sensitivities
from contactbench.pipeline.verification.diagnosis import FEWEST_TOUCHES, diagnose, refine
from contactbench.pipeline.verification.figures import (
    ModelError,
    Times,
    TouchFigure,
    TouchZero,
    Verification,
    VerificationLimits,
)
from contactbench.pipeline.verification.markers import MarkerSet, TouchLocator, with_normals
from contactbench.pipeline.verification.model_error import PLACEMENT_M, measure_model_error
from contactbench.pipeline.verification.protocol import (
    ProtocolSettings,
    Touch,
    TouchProtocol,
    Why,
    measured_noise,
    rate_of,
    resting,
)
from contactbench.pipeline.verification.reference import force_accuracy
from contactbench.pipeline.verification.source import TouchRecording
from contactbench.pipeline.verification.statistics import FEWEST, intervals, summarise, summarise_by, vector
from contactbench.pipeline.verification.verdict import VerdictCase, checks, crowded, missing, unresolved

_ANGLES = (7.5, 22.5, 37.5, 52.5)  # degrees: borders of the ranges that are told apart
_SOLVES = 20_000
_FORCE, _TORQUE = slice(0, 3), slice(3, 6)


@dataclass(frozen=True)
class VerifySettings:
    """
    How to verify.

    Attributes
    ----------
    protocol : ProtocolSettings
    limits : VerificationLimits
    noise_force, noise_torque : float or None
        Standard deviation of a sample, N and N·m; None: measured within the touches.
    resamples, seed : int
        Of the bootstrap.
    mount : (3,), optional
        Angles that the orientations of a flange were turned by, degrees about fixed x, y, z: only kept with the result.
    left_out : mapping of str to str
        Marker -> why it need not be touched, such as that nothing reaches it. Touches of it count nevertheless.
    follow : bool
        The zero follows: what is read between touches is taken off, here and by a runtime.
    """

    protocol: ProtocolSettings = field(default_factory=ProtocolSettings)
    limits: VerificationLimits = field(default_factory=VerificationLimits)
    noise_force: float | None = None
    noise_torque: float | None = None
    resamples: int = 2000
    seed: int = 0
    mount: tuple[float, float, float] | None = None
    left_out: Mapping[str, str] = field(default_factory=dict)
    follow: bool = False

    def __post_init__(self) -> None:
        if (self.noise_force is None) != (self.noise_torque is None):
            raise InputError("noise of force and torque: give both or neither.")
        limits = (self.limits.mean_m, self.limits.max_m, self.limits.p99_s)
        if not all(0 < limit < 1e3 for limit in limits):
            raise InputError(f"limits {arg(limits)}: give positive numbers.")
        if not 100 <= self.resamples <= 1_000_000 or self.seed < 0:
            raise InputError("bootstrap: give 100 to 1,000,000 resamples and a seed of at least 0.")
        if unexplained := [name for name, why in self.left_out.items() if not why.strip()]:
            raise InputError(f"skipped: give the reason for skipping {arg(', '.join(unexplained))}.")


def find_touches(
    recording: TouchRecording, placing: TouchLocator, settings: ProtocolSettings | None = None
) -> list[Touch]:
    """Return every touch of a compensated recording, accepted or rejected."""
    protocol = TouchProtocol(placing, settings)
    events = protocol.feed(recording.times, recording.wrenches, recording.R_WS, recording.saturated)
    # The last word on a press counts: one that was accepted may be withdrawn before it is released.
    last = {
        event.touch.start: event.touch for event in (*events, *protocol.finish()) if event.touch is not None
    }
    return list(last.values())


def verify(
    probe: Probe,
    model: GravityModel,
    markers: MarkerSet,
    recording: TouchRecording,
    settings: VerifySettings | None = None,
    *,
    reference: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
    times: Times | None = None,
    timed: bool = False,
    sources: dict[str, str] | None = None,
    faults: tuple[str, ...] = (),
    mesh_deviation: float | None = None,
) -> Verification:
    """
    Find the touches of a recording, and judge the contact points.

    Parameters
    ----------
    probe : Probe
        S.
    model : GravityModel
    markers : MarkerSet
        On the probe; where exactly they are is what the contacts are compared with.
    recording : TouchRecording
        Raw.
    settings : VerifySettings, optional
    reference : (times, forces), optional
        Of a reference sensor, s and N, on the recording's clock.
    times : Times, optional
        Of solves, measured before.
    timed : bool
        Measure them now; only then two runs differ.
    sources : dict, optional
        SHA-256 of the inputs, by role: kept with the result.
    faults : tuple of str
        Why nothing verified with these inputs may pass, in sentences.
    mesh_deviation : float, optional
        Root mean square between the probe and the surface that it was made of, m; for the uncertainty budget.

    Raises
    ------
    MarkerError
        A marker is off the probe.
    InputError
        Nothing touched the probe.
    """
    settings = settings or VerifySettings()
    placed, heights = with_normals(markers, probe)
    compensated = recording.compensated(model, follow=settings.follow)
    stated = None
    if settings.noise_force is not None and settings.noise_torque is not None:
        stated = settings.noise_force, settings.noise_torque
    noise, correlation, said = measured_noise(compensated, settings.protocol, stated)
    placing = TouchLocator(probe, placed, model, noise, settings.protocol.samples, correlation)
    touches = find_touches(compensated, placing, settings.protocol)
    if not touches:
        raise InputError(
            f"the recording contains no touch: |F| never reaches {arg(settings.protocol.touch_N):g} N."
            " Check that it is the right recording, and that the calibration belongs to it."
        )
    zeros = recording.zeros_at(model, [touch.start for touch in touches]) if settings.follow else []
    evidence = _evidence(
        touches, placed, heights, noise, model, settings.protocol.samples, stated is None, zeros
    )
    if timed and len(evidence.errors):
        times = time_solves(placing, evidence.wrenches)
    figures, rate = _figures(touches, placed, zeros), rate_of(recording.times)
    force = None
    if reference is not None:
        force, doubts = force_accuracy(touches, *reference)
        said += doubts
    said += _sentences(figures, compensated, settings.protocol, rate)
    names = placed.names
    if strangers := sorted(set(settings.left_out) - set(names)):
        raise InputError(f"skipped: there are no markers {arg(', '.join(strangers))}: correct the names.")
    accepted = [figure for figure in figures if figure.accepted]
    kept = np.array([each.accepted for each in figures if _tells(each)], dtype=bool)
    every, evidence = evidence, evidence.only(kept)
    errors, enough = evidence.errors, len(accepted) >= FEWEST
    overall = summarise("all", errors) if accepted else None
    protocol, wanted = settings.protocol, [name for name in names if name not in settings.left_out]
    close, hopeless = (None, False) if protocol.order else crowded(placed, settings.limits)
    case = VerdictCase(
        overall,
        unresolved(figures, settings.limits),
        missing(figures, wanted, protocol.windows, protocol.repeats),
        len({figure.marker for figure in accepted}),
        settings.limits,
        (*faults, close) if close and hopeless else faults,
        dict(sorted(Counter(figure.reason for figure in figures if not figure.accepted).items())),
        settings.left_out,
    )
    left, verdict = measure_model_error(evidence, model), case.judged(times)
    windows = [_span(window) for window in protocol.windows]
    angles = [_ANGLE_NAMES[int(np.searchsorted(_ANGLES, each.angle_deg or 0.0))] for each in accepted]
    repeats = sorted({figure.repeat or 0 for figure in accepted})
    return Verification(
        touches=figures,
        rejected=case.rejected,
        per_marker=summarise_by([f.marker for f in accepted], names, errors),
        per_repeat=summarise_by([f.repeat for f in accepted], [str(each) for each in repeats], errors),
        per_force=summarise_by([_span(f.window_N or (0.0, 0.0)) for f in accepted], windows, errors),
        per_angle=summarise_by(angles, _ANGLE_NAMES, errors),
        overall=overall,
        ci=intervals(errors, groups=evidence.markers, resamples=settings.resamples, seed=settings.seed)
        if enough
        else None,
        ratio=_ratio(accepted),
        times=times,
        force=force,
        verdict=verdict,
        diagnosis=diagnose(every, not any(case.errors()), names, verdict.passed)
        if len(every.errors) >= FEWEST_TOUCHES
        else None,
        alignment_refined=refine(evidence, placing.solver, placed),
        missing=case.missing,
        limits=settings.limits,
        settings=_plain(settings, placing, rate),
        sources=dict(sorted((sources or {}).items())),
        warnings=(*recording.warnings, *said, *([message(f"{arg(capitalised(close))}.")] if close else [])),
        unresolved=case.unresolved,
        model_error=left,
        budget=_budget(evidence, model.covariance, left, mesh_deviation) if accepted else (),
    )


def time_solves(placing: TouchLocator, wrenches: NDArray[np.float64]) -> Times:
    """Time single solves of wrenches (n, 6), over and over, as a controller would call them."""
    many = np.ascontiguousarray(np.resize(wrenches, (_SOLVES, 6)))
    seconds = 1e-9 * np.asarray(placing.solver.time_each(many))
    return Times(len(seconds), float(np.median(seconds)), float(np.percentile(seconds, 99)))


def _sentences(
    figures: tuple[TouchFigure, ...],
    recording: TouchRecording,
    protocol: ProtocolSettings,
    rate: float | None,
) -> list[str]:
    at_rest = None if rate is None else resting(recording, protocol, rate)
    followed = [] if recording.zero is None else [follow_words(recording.zero), _seen(figures)]
    return [*checks(figures), *([] if at_rest is None else [at_rest]), *followed]


def _seen(figures: tuple[TouchFigure, ...]) -> str:
    """Say whether the zero was seen since the touch before each one."""
    before, unseen, longest = -np.inf, [], 0.0
    for each in figures:
        seen = None if each.zero is None else each.zero.seen_s
        if seen is None or each.start_s - seen < before:
            unseen.append(str(each.number))
        else:
            longest = max(longest, seen)
        before = each.start_s
    if not unseen:
        return message(f"The zero was seen before every touch, at most {arg(longest):.1f} s before.")
    return message(
        f"The zero was not seen just before {arg(len(unseen))} of {arg(len(figures))} touches"
        f" ({arg(', '.join(unseen))}): lift the probe clear for half a second before each."
    )


# ---- from touches to figures -------------------------------------------------------------------


def _evidence(
    touches: list[Touch],
    markers: MarkerSet,
    heights: NDArray[np.float64],
    noise: WrenchNoise,
    model: GravityModel,
    samples: int,
    measured: bool,
    zeros: list[Zero],
) -> TouchEvidence:
    rows = [
        (row, t.located, t.placed.marker)
        for row, t in enumerate(touches)
        if t.why in (None, Why.IMPLAUSIBLE) and t.located and t.placed
    ]
    starts = [touches[row].start for row, *_ in rows]
    taken = [np.zeros(6) if (off := zeros[row].taken) is None else off for row, *_ in rows if zeros]
    found, places = [each for _, each, _ in rows], np.array([marker for *_, marker in rows], dtype=np.intp)
    points = np.array([each.point for each in found]).reshape(-1, 3)
    return TouchEvidence(
        errors=points - markers.points[places],
        markers=places,
        points=markers.points[places],
        normals=markers.normals[places],
        facets=np.array([each.normal for each in found]).reshape(-1, 3),
        heights=heights[places],
        wrenches=np.array([each.wrench for each in found]).reshape(-1, 6),
        R_WS=np.array([each.R_WS for each in found]).reshape(-1, 3, 3),
        torques=np.array([each.torque for each in found]),
        noise=noise.covariance / samples,
        theta=model.vector,
        measured=measured,
        starts=np.array(starts),
        taken=np.array(taken) if taken else None,
    )


def _tells(figure: TouchFigure) -> bool:
    """Tell whether a touch has a row in the evidence."""
    return figure.accepted or (figure.reason == Why.IMPLAUSIBLE and figure.marker is not None)


def _figures(touches: list[Touch], markers: MarkerSet, zeros: list[Zero]) -> tuple[TouchFigure, ...]:
    counts: Counter[str] = Counter()
    figures = []
    for number, touch in enumerate(touches, 1):
        known = repeat = None
        if touch.placed is not None and (touch.why is None or not touch.placed.far):
            known = markers[touch.placed.marker]
        if touch.why is None and known is not None:
            counts[known.name] += 1
            repeat = counts[known.name]
        figures.append(
            TouchFigure(
                number=number,
                start_s=touch.start,
                time_s=touch.time,
                accepted=touch.why is None,
                reason=str(touch.why or ""),
                marker=None if known is None else known.name,
                repeat=repeat,
                force_N=touch.force,
                window_N=touch.window,
                zero=_zero(zeros[number - 1]) if zeros else None,
                **({} if known is None else _where(touch, known.point_S, known.normal_S)),
            )
        )
    return tuple(figures)


def _zero(told: Zero) -> TouchZero:
    return TouchZero(None, None) if told.taken is None else TouchZero(tuple(told.taken.tolist()), told.seen)


def _where(touch: Touch, point: NDArray[np.float64], normal: NDArray[np.float64]) -> dict[str, Any]:
    located = touch.located
    if located is None:
        return {}
    F = located.wrench[:3]
    size = float(np.linalg.norm(F))
    error = 1e3 * (located.point - point)
    return {
        "angle_deg": float(np.degrees(np.arccos(np.clip(-F @ normal / size, -1.0, 1.0)))),
        "point_mm": vector(1e3 * located.point),
        "error_mm": vector(error),
        "distance_mm": float(np.linalg.norm(error)),
        "predicted_mm": float(1e3 * np.sqrt(np.trace(located.covariance))),
        "torque_arm_mm": 1e3 * located.torque / size,
        "covariance_mm2": tuple((1e6 * located.covariance[np.triu_indices(3)]).tolist()),
        "confidence": located.confidence if np.isfinite(located.confidence) else None,
        "rivals_mm": tuple(vector(1e3 * np.asarray(each)) for each in located.rivals),
    }


def _ratio(accepted: list[TouchFigure]) -> float | None:
    """Return the rms error over the rms of what was predicted."""
    predicted = sum((figure.predicted_mm or 0.0) ** 2 for figure in accepted)
    found = sum((figure.distance_mm or 0.0) ** 2 for figure in accepted)
    return float(np.sqrt(found / predicted)) if predicted > 0 else None


_ANGLE_NAMES = tuple(
    f"{low:g} to {high:g}°" for low, high in zip((0.0, *_ANGLES), (*_ANGLES, 90.0), strict=True)
)


def _span(window: tuple[float, float]) -> str:
    return message(f"{arg(window[0]):g} to {arg(window[1]):g} N")


def _plain(settings: VerifySettings, placing: TouchLocator, rate: float | None) -> dict[str, Any]:
    """Return the settings without the limits, which stand beside them, and with what was found or is fixed."""
    plain = asdict(settings)
    del plain["limits"]
    # As before there were such things: the same inputs give the same bytes.
    for later in ("left_out", "follow"):
        if not plain[later]:
            del plain[later]
    noise = np.sqrt(np.diag(placing.noise.covariance)).tolist()
    gates = {name: _finite(value) for name, value in placing.solver.gates.told().items()}
    touch = placing.solver.model
    floor = np.sqrt(np.diag(touch.model_error.covariance)).tolist()
    assumed = {"torsion_arm_m": touch.torsion_arm, "model_error": floor}
    return {**plain, "noise": noise, "rate_Hz": rate, "filters": [], "gates": gates, "assumed": assumed}


def _finite(value: Any) -> Any:
    """Return numbers for JSON, which knows no infinity: None is a limit that there is not."""
    numbers = np.asarray(value, dtype=object)
    if numbers.ndim:
        return [_finite(each) for each in numbers.tolist()]
    return value if value is None or isinstance(value, bool | str) or np.isfinite(value) else None


def _budget(
    evidence: TouchEvidence,
    covariance: NDArray[np.float64],
    error: ModelError | None,
    mesh_deviation: float | None,
) -> tuple[BudgetRow, ...]:
    """
    Return the budget of the distance between located point and marker: root mean square over the touches.

    Noise, bias, mass, centre of mass and their correlation together are the `predicted_mm` of the touches; the model's
    error is the one that a bundle of this verification allows for.

    Parameters
    ----------
    evidence : TouchEvidence
        Accepted touches, at least one.
    covariance : (12, 12)
        Of the calibration's parameters.
    error : ModelError or None
        None: it was not measured, and the default is assumed.
    mesh_deviation : float or None
        Root mean square between the mesh and the surface that it was made of, m; None: nobody knows.
    """
    points = evidence.points + evidence.errors
    normals = evidence.normals if evidence.facets is None else evidence.facets
    J = sensitivities(points, normals, evidence.wrenches[:, :3])
    by_parameter = J @ prediction_jacobian(evidence.R_WS.transpose(0, 2, 1), evidence.theta)
    if error is None:
        force, torque, kind = DEFAULT_FORCE_N, DEFAULT_TORQUE_NM, "B"
    else:
        force, torque, kind = error.force_N, error.torque_Nm, "A"
    sides = across(evidence.normals).transpose(0, 2, 1)
    mesh = BudgetRow(BudgetSource.MESH, "", 0.0)
    if mesh_deviation is not None:
        along, variance = evidence.along[:, :, None], np.array([[mesh_deviation**2]])
        mesh = input_row(BudgetSource.MESH, "B", along, variance, "mm", 1e3)
    noise, seen = evidence.noise, "A" if evidence.measured else "B"
    return (
        input_row(BudgetSource.NOISE_FORCE, seen, J[:, :, _FORCE], noise[_FORCE, _FORCE], "N", 1.0),
        input_row(BudgetSource.NOISE_TORQUE, seen, J[:, :, _TORQUE], noise[_TORQUE, _TORQUE], "mN·m", 1e3),
        *parameter_rows(by_parameter, covariance),
        BudgetRow(BudgetSource.MOUNT, "", 0.0),
        mesh,
        input_row(BudgetSource.MARKERS, "B", sides, PLACEMENT_M**2 * np.eye(2), "mm", 1e3),
        input_row(BudgetSource.MODEL_FORCE, kind, J[:, :, _FORCE], force**2 * np.eye(3), "N", 1.0),
        input_row(BudgetSource.MODEL_TORQUE, kind, J[:, :, _TORQUE], torque**2 * np.eye(3), "mN·m", 1e3),
    )
