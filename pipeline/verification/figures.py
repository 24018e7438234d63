"""What a verification measured: plain values, in SI inside and in the units of their names in JSON."""

import json
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import Any

from contactbench.pipeline.calibration.budget import BudgetRow, combined_mm
from contactbench.pipeline.shown import Shown

SCHEMA, VERSION = "contactbench.verification", 1

Vector = tuple[float, float, float]
Interval = tuple[float, float]


class ErrorCause(StrEnum):
    """What can make a contact point wrong."""

    ALIGNMENT = "alignment"
    GRAVITY = "gravity"
    NOISE = "noise"
    MESH = "mesh"
    TORSION = "torsion"
    MARKERS = "markers"
    MOUNT = "mount"
    SENSOR = "sensor"
    DRIFT = "drift"  # that a zero that follows has left


@dataclass(frozen=True)
class TouchZero:
    """The zero that follows, as a touch began."""

    taken: tuple[float, ...] | None  # (6,) N and N·m: what was taken off; None: nothing yet
    seen_s: float | None  # How long before it was last seen


@dataclass(frozen=True)
class TouchFigure:
    """One touch, accepted or not."""

    number: int  # Of the touch, from 1, in the order of time
    # When the probe was touched, and when the protocol decided; the recording's clock
    start_s: float
    time_s: float
    accepted: bool
    reason: str  # Why it was rejected; empty if it was not
    marker: str | None  # The marker that was touched; None: unknown
    repeat: int | None  # Which touch of that marker it is, from 1; only accepted ones are counted
    force_N: float  # |F|, mean over the samples, or the largest that was reached if no samples were taken
    window_N: Interval | None = None  # (low, high) the force window that it was in
    angle_deg: float | None = None  # Between -F and the outward normal at the marker
    # (3,) where it was located, and that minus the marker, S
    point_mm: Vector | None = None
    error_mm: Vector | None = None
    distance_mm: float | None = None  # Length of `error_mm`
    predicted_mm: float | None = None  # √trace of the point's covariance: what noise and calibration explain
    torque_arm_mm: float | None = None  # Local torque over force, k / |F|
    # Of the point, S: xx, xy, xz, yy, yz, zz; files of before do not have it, nor the two below
    covariance_mm2: tuple[float, float, float, float, float, float] | None = None
    confidence: float | None = None  # 1 / (1 + odds of its rivals), no probability; None: not known
    rivals_mm: tuple[Vector, ...] = ()  # Other places that explain the wrench, the likeliest first
    zero: TouchZero | None = None  # None: the zero does not follow


@dataclass(frozen=True)
class Summary:
    """The errors of some touches, mm."""

    name: str  # Which touches: a marker, a repeat, a force window, a range of angles
    touches: int
    # Of |e|; there is no SD of one touch
    mean_mm: float
    sd_mm: float | None
    max_mm: float
    p95_mm: float
    rms_mm: float
    bias_mm: Vector  # (3,) mean error vector, S
    # Root of the mean squared distance from that mean, n - 1 in the denominator; None: one touch
    scatter_mm: float | None


@dataclass(frozen=True)
class Intervals:
    """Bootstrap confidence intervals, mm; those of the bias hold all three at once."""

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
    """|F| minus a reference sensor's force over the accepted touches."""

    touches: int  # That have a reference
    # Of the difference; the largest is of its size. An SD of one touch is 0.
    mean_N: float
    sd_N: float
    max_N: float
    rms_percent: float  # Rms of the difference over the larger of the two forces, %
    of: int = 0  # Accepted touches


@dataclass(frozen=True)
class Share:
    """How much of the squared error a cause explains."""

    cause: ErrorCause
    share: float  # From 0 to 1; all together are 1
    # Gain of log likelihood by allowing for the cause; that of noise is 0, it is always allowed for
    evidence: float


@dataclass(frozen=True)
class DriftTaken:
    """Drift that a zero that follows took off the touches, root mean squares."""

    force_N: float
    torque_Nm: float
    moved_mm: float  # By how much it would have moved the contacts
    evidence: float  # Log of the odds, as the errors tell, that it was rightly taken off


@dataclass(frozen=True)
class ErrorDiagnosis:
    """What to fix first."""

    first: ErrorCause
    text: str  # One paragraph
    shares: tuple[Share, ...]  # Largest first
    noise_scale: float  # Scatter that is left over what was predicted
    drift: DriftTaken | None = None  # None: the zero does not follow


@dataclass(frozen=True)
class Refined:
    """Alignment corrected on half of the markers, judged on the others."""

    # Markers
    fitted: tuple[str, ...]
    judged: tuple[str, ...]
    # (3,) the correction p_new = R p_old + shift of the probe in S; a rotation vector
    turn_deg: Vector
    shift_mm: Vector
    # Mean |e|
    fitted_before_mm: float
    fitted_after_mm: float
    judged_before_mm: float
    judged_after_mm: float
    helps: bool  # The other half is better by a tenth at least


@dataclass(frozen=True)
class ModelError:
    """What the wrench's model leaves out, as found: drift, cable, hysteresis, mount; standard deviations."""

    # To be told to the solver: larger than the true one in four cases of five, and never under a least value
    force_N: float
    torque_Nm: float
    # As likely too large as too small
    likely_force_N: float
    likely_torque_Nm: float
    # Upper 95 % bound
    most_force_N: float
    most_torque_Nm: float
    draws: float  # As how many touches that know nothing of each other the accepted ones count


@dataclass(frozen=True)
class VerificationVerdict:
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
    """Settled touches without a marker: ambiguous, implausible, far from every marker, or nowhere on the probe."""

    touches: int
    settled: int  # These, and the accepted ones
    share: float  # From 0 to 1


@dataclass(frozen=True)
class VerificationLimits:
    """What a verification must keep: mean and largest |e|, m, and the p99 of the time of a solve, s."""

    mean_m: float = 0.001
    max_m: float = 0.002
    p99_s: float = 0.001


@dataclass(frozen=True, repr=False)
class Verification(Shown):
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
    verdict : VerificationVerdict
    diagnosis : ErrorDiagnosis or None
        None: too few touches.
    alignment_refined : Refined or None
        None: too few markers.
    missing : tuple of str
        Markers with fewer accepted touches than wanted; of several force windows, with the window.
    limits : VerificationLimits
    settings : dict
        All that the figures depend on beside the data.
    sources : dict of str to str
        SHA-256 of each input, by role.
    warnings : tuple of str
    unresolved : Unresolved or None
        None: no touch settled.
    model_error : ModelError or None
        None: too few markers.
    budget : tuple of BudgetRow
        What the errors should come to; empty: no touch was accepted, or the file is of before.
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
    verdict: VerificationVerdict
    diagnosis: ErrorDiagnosis | None
    alignment_refined: Refined | None
    missing: tuple[str, ...]
    limits: VerificationLimits
    settings: dict[str, Any]
    sources: dict[str, str] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    unresolved: Unresolved | None = None
    model_error: ModelError | None = None
    budget: tuple[BudgetRow, ...] = ()

    def facts(self) -> dict[str, str]:
        """As `Shown.facts`."""
        errors = self.overall
        return {
            "passed": ". ".join(["yes" if self.verdict.passed else "no", *self.verdict.reasons]),
            "touches": f"{len(self.touches)}, {sum(self.rejected.values())} rejected",
            "errors": "none"
            if errors is None
            else f"{errors.mean_mm:.2f} mm mean, {errors.max_mm:.2f} mm largest",
        }

    @property
    def combined_mm(self) -> float | None:
        """Combined standard uncertainty of the errors, mm; None: there is no budget."""
        return combined_mm(self.budget) if self.budget else None

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
        # Only where the zero follows: without, the same bytes as ever.
        for part, name in (
            *((touch, "zero") for touch in plain["touches"]),
            (plain["diagnosis"] or {}, "drift"),
        ):
            if part.get(name) is None:
                part.pop(name, None)
        return {"schema": SCHEMA, "version": VERSION, **plain}

    def to_bytes(self) -> bytes:
        """Return the JSON file, UTF-8."""
        return (json.dumps(self.to_json(), indent=1, allow_nan=False) + "\n").encode()
