"""What a verification measured: plain values, in SI inside and in the units of their names in JSON."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import Any

SCHEMA, VERSION = "contactbench.verification", 1

Vector = tuple[float, float, float]
Interval = tuple[float, float]


class Cause(StrEnum):
    """What can make a contact point wrong."""

    ALIGNMENT = "alignment"
    GRAVITY = "gravity"
    NOISE = "noise"
    MESH = "mesh"
    TORSION = "torsion"
    MARKERS = "markers"


@dataclass(frozen=True)
class TouchFigure:
    """
    One touch, accepted or not.

    Attributes
    ----------
    number : int
        Of the touch, from 1, in the order of time.
    start_s, time_s : float
        When the probe was touched, and when the protocol decided; the recording's clock.
    accepted : bool
    reason : str
        Why it was rejected; empty if it was not.
    marker : str or None
        The marker that was touched; None: unknown.
    repeat : int or None
        Which touch of that marker it is, from 1; only accepted ones are counted.
    force_N : float
        |F|, mean over the samples, or the largest that was reached if no samples were taken.
    window_N : (low, high) or None
        The force window that it was in.
    angle_deg : float or None
        Between -F and the outward normal at the marker.
    point_mm, error_mm : (3,) or None
        Where it was located, and that minus the marker, S.
    distance_mm : float or None
        Length of `error_mm`.
    predicted_mm : float or None
        √trace of the point's covariance: what noise and calibration explain.
    torque_arm_mm : float or None
        Local torque over force, k / |F|.
    """

    number: int
    start_s: float
    time_s: float
    accepted: bool
    reason: str
    marker: str | None
    repeat: int | None
    force_N: float
    window_N: Interval | None = None
    angle_deg: float | None = None
    point_mm: Vector | None = None
    error_mm: Vector | None = None
    distance_mm: float | None = None
    predicted_mm: float | None = None
    torque_arm_mm: float | None = None


@dataclass(frozen=True)
class Summary:
    """
    The errors of some touches, mm.

    Attributes
    ----------
    name : str
        Which touches: a marker, a repeat, a force window, a range of angles.
    touches : int
    mean_mm, sd_mm, max_mm, p95_mm, rms_mm : float; the SD may be None
        Of |e|; there is no SD of one touch.
    bias_mm : (3,)
        Mean error vector, S.
    scatter_mm : float
        Root of the mean squared distance from that mean, n - 1 in the denominator; None: one touch.
    """

    name: str
    touches: int
    mean_mm: float
    sd_mm: float | None
    max_mm: float
    p95_mm: float
    rms_mm: float
    bias_mm: Vector
    scatter_mm: float | None


@dataclass(frozen=True)
class Intervals:
    """
    Bootstrap confidence intervals, mm; those of the bias hold all three at once.

    Attributes
    ----------
    level : float
    resamples, seed : int
    mean_mm, scatter_mm : (low, high)
    bias_mm : three of (low, high)
    """

    level: float
    resamples: int
    seed: int
    mean_mm: Interval
    scatter_mm: Interval
    bias_mm: tuple[Interval, Interval, Interval]


@dataclass(frozen=True)
class Times:
    """Time of one solve, measured call by call on the verified wrenches."""

    count: int
    median_s: float
    p99_s: float


@dataclass(frozen=True)
class ForceAccuracy:
    """
    |F| minus a reference sensor's force over the accepted touches.

    Attributes
    ----------
    touches : int
        That have a reference.
    mean_N, sd_N, max_N : float
        Of the difference; the largest is of its size. An SD of one touch is 0.
    rms_percent : float
        Rms of the difference over the larger of the two forces, %.
    of : int
        Accepted touches.
    """

    touches: int
    mean_N: float
    sd_N: float
    max_N: float
    rms_percent: float
    of: int = 0


@dataclass(frozen=True)
class Share:
    """
    How much of the squared error a cause explains.

    Attributes
    ----------
    cause : Cause
    share : float
        From 0 to 1; all together are 1.
    evidence : float
        Gain of log likelihood by allowing for the cause; that of noise is 0, it is always allowed for.
    """

    cause: Cause
    share: float
    evidence: float


@dataclass(frozen=True)
class Diagnosis:
    """
    What to fix first.

    Attributes
    ----------
    first : Cause
    text : str
        One paragraph.
    shares : tuple of Share
        Largest first.
    noise_scale : float
        Scatter that is left over what was predicted.
    """

    first: Cause
    text: str
    shares: tuple[Share, ...]
    noise_scale: float


@dataclass(frozen=True)
class Refined:
    """
    Alignment corrected on half of the markers, judged on the others.

    Attributes
    ----------
    fitted, judged : tuple of str
        Markers.
    turn_deg, shift_mm : (3,)
        The correction p_new = R p_old + shift of the probe in S; a rotation vector.
    fitted_before_mm, fitted_after_mm, judged_before_mm, judged_after_mm : float
        Mean |e|.
    helps : bool
        The other half is better by a tenth at least.
    """

    fitted: tuple[str, ...]
    judged: tuple[str, ...]
    turn_deg: Vector
    shift_mm: Vector
    fitted_before_mm: float
    fitted_after_mm: float
    judged_before_mm: float
    judged_after_mm: float
    helps: bool


@dataclass(frozen=True)
class ModelError:
    """
    What the wrench's model leaves out, as found: drift, cable, hysteresis, mount; standard deviations of a component.

    Attributes
    ----------
    force_N, torque_Nm : float
        To be told to the solver: larger than the true one in four cases of five, and never under a least value.
    likely_force_N, likely_torque_Nm : float
        As likely too large as too small.
    most_force_N, most_torque_Nm : float
        Upper 95 % bound.
    draws : float
        As how many touches that know nothing of each other the accepted ones count.
    """

    force_N: float
    torque_Nm: float
    likely_force_N: float
    likely_torque_Nm: float
    most_force_N: float
    most_torque_Nm: float
    draws: float


@dataclass(frozen=True)
class Verdict:
    """
    Whether the limits are kept.

    Attributes
    ----------
    passed : bool
    reasons : tuple of str
        Why not; empty when it passed.
    notes : tuple of str
        What it says nothing about, passed or not.
    """

    passed: bool
    reasons: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Unresolved:
    """
    Settled touches without a marker: ambiguous, implausible, far from every marker, or nowhere on the probe.

    Attributes
    ----------
    touches : int
    settled : int
        These, and the accepted ones.
    share : float
        From 0 to 1.
    """

    touches: int
    settled: int
    share: float


@dataclass(frozen=True)
class Limits:
    """What a verification must keep: mean and largest |e|, m, and the p99 of the time of a solve, s."""

    mean_m: float = 0.001
    max_m: float = 0.002
    p99_s: float = 0.001


@dataclass(frozen=True)
class Verification:
    """
    The whole of it. The same input gives the same object, `times` apart.

    Attributes
    ----------
    touches : tuple of TouchFigure
        All, rejected ones too.
    rejected : dict of str to int
        How many for which reason.
    per_marker, per_repeat, per_force, per_angle : tuple of Summary
        Of accepted touches.
    overall : Summary or None
        None: no touch was accepted, and nor are there the figures below.
    ci : Intervals or None
        None: fewer than five touches, or markers.
    ratio : float or None
        Rms error over what noise and calibration predict.
    times : Times or None
        None: not measured.
    force : ForceAccuracy or None
        None: there was no reference.
    verdict : Verdict
    diagnosis : Diagnosis or None
        None: too few touches.
    alignment_refined : Refined or None
        None: too few markers.
    missing : tuple of str
        Markers with fewer accepted touches than wanted; of several force windows, with the window.
    limits : Limits
    settings : dict
        All that the figures depend on beside the data.
    sources : dict of str to str
        SHA-256 of each input, by role.
    warnings : tuple of str
    unresolved : Unresolved or None
        None: no touch settled.
    model_error : ModelError or None
        None: too few markers.
    """

    touches: tuple[TouchFigure, ...]
    rejected: dict[str, int]
    per_marker: tuple[Summary, ...]
    per_repeat: tuple[Summary, ...]
    per_force: tuple[Summary, ...]
    per_angle: tuple[Summary, ...]
    overall: Summary | None
    ci: Intervals | None
    ratio: float | None
    times: Times | None
    force: ForceAccuracy | None
    verdict: Verdict
    diagnosis: Diagnosis | None
    alignment_refined: Refined | None
    missing: tuple[str, ...]
    limits: Limits
    settings: dict[str, Any]
    sources: dict[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    unresolved: Unresolved | None = None
    model_error: ModelError | None = None

    @property
    def bias_mm(self) -> Vector | None:
        """Mean error vector in S: what all touches share."""
        return None if self.overall is None else self.overall.bias_mm

    @property
    def scatter_mm(self) -> float | None:
        """What is left of the errors without it, rms."""
        return None if self.overall is None else self.overall.scatter_mm

    def to_json(self) -> dict[str, Any]:
        """Return plain data."""
        bias = None if self.bias_mm is None else list(self.bias_mm)
        parts = {"bias_mm": bias, "scatter_mm": self.scatter_mm}
        plain: dict[str, Any] = json.loads(json.dumps({**asdict(self), **parts}, allow_nan=False))
        return {"schema": SCHEMA, "version": VERSION, **plain}

    def to_bytes(self) -> bytes:
        """Return the JSON file, UTF-8."""
        return (json.dumps(self.to_json(), indent=1, allow_nan=False) + "\n").encode()
