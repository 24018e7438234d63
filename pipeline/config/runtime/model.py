"""
The schema of a runtime config: everything a controller needs to compensate, filter and locate, in any language.

One JSON object, ``contactbench.json``. Every number is SI and finite, and every field is present; ``null`` means that
there is no value. The name of a number states its meaning and unit: ``force_bias_N``.
R_WS turns S into W (v_W = R_WS v_S).
"""

from typing import Annotated, Any, Final, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    create_model,
    model_serializer,
)

from contactbench.pipeline.gates import absent_gates, gate_forms
from contactbench.pipeline.touch_settings import Scene, TorsionWay

SCHEMA: Final = "contactbench.runtime"
VERSION: Final = 4

# Wide enough for every device there is, narrow enough that no square overflows and no unit is mistaken unnoticed.
_Number = Annotated[float, Field(ge=-1e9, le=1e9)]
_Positive = Annotated[float, Field(gt=0, le=1e9)]
_NotNegative = Annotated[float, Field(ge=0, le=1e9)]
_Short = Annotated[float, Field(ge=0, le=0.1)]
_TwoPositive = Annotated[list[_Positive], Field(min_length=2, max_length=2)]
_TwoNotNegative = Annotated[list[_NotNegative], Field(min_length=2, max_length=2)]
_Three = Annotated[list[_Number], Field(min_length=3, max_length=3)]
_ThreePositive = Annotated[list[_Positive], Field(min_length=3, max_length=3)]
_ThreeSigmas = Annotated[list[_NotNegative], Field(min_length=3, max_length=3)]
_Four = Annotated[list[_Number], Field(min_length=4, max_length=4)]
_Six = Annotated[list[_Number], Field(min_length=6, max_length=6)]
_Matrix6 = Annotated[list[_Six], Field(min_length=6, max_length=6)]
_Twelve = Annotated[list[_Number], Field(min_length=12, max_length=12)]
_Matrix12 = Annotated[list[_Twelve], Field(min_length=12, max_length=12)]
_Count = Annotated[int, Field(ge=0, le=2**31 - 1)]
_Text = Annotated[str, Field(max_length=1_000)]
_Hash = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
# A name in the bundle, never a path out of it.
_File = Annotated[str, Field(pattern="^[A-Za-z0-9][A-Za-z0-9._-]{0,99}$")]
_Time = Annotated[str, Field(pattern="^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z$")]


class ConfigPart(BaseModel):
    """A JSON object: every field named, of its own type, finite."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True)

    @model_serializer(mode="wrap")
    def _as_ever(self, written: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Leave out later fields, the only ones with a default, where they have it: as before there were any."""
        later = {
            name: field.default for name, field in type(self).model_fields.items() if not field.is_required()
        }
        return {
            name: value for name, value in written(self).items() if name not in later or value != later[name]
        }


class UnitsPart(ConfigPart):
    """The only units used, written down so that no reader has to guess."""

    force: Literal["N"]
    torque: Literal["N*m"]
    length: Literal["m"]
    time: Literal["s"]
    angle: Literal["rad"]


class FramesPart(ConfigPart):
    """
    The frames.

    W is the frame of the calibration's orientations, normally the robot's base; it need not be level. The direction
    of gravity in W was measured (``gravity_W_N``); ``world.down_W`` states its expected direction. A controller must
    give its orientations in the same frame.

    ``quaternion_ES`` (w, x, y, z) turns S into the flange E, so that R_WS = R_WE R_ES; null: the calibration's
    orientations were the sensor's own, and the controller gives R_WS itself.
    """

    sensor: Literal["S"]
    world: Literal["W"]
    rotation: Literal["R_WS: v_W = R_WS v_S"]
    wrench: Literal["what the tissue does to the probe, about the origin of S"]
    quaternion_ES: _Four | None


class WorldPart(ConfigPart):
    """
    The declared direction of down in W, a unit vector.

    (0, 0, -1) for an upright robot, (0, 0, 1) for one that hangs from the ceiling.
    """

    down_W: _Three


class SensorPart(ConfigPart):
    """
    The sensor that this config belongs to; it is wrong for any other.

    ``unknown``: not given. ``rate_Hz`` is in readings per second; at another rate the filters act at another frequency.
    """

    model: _Text
    serial: _Text
    rate_Hz: _Positive


class GravityPart(ConfigPart):
    """
    As GravityModel: a still sensor reads F = R_SW g + F0, M = L x (R_SW g) + M0.

    ``covariance`` is of gravity_W_N, force_bias_N, centre_of_mass_S_m, torque_bias_Nm, in this order.
    """

    gravity_W_N: _Three
    force_bias_N: _Three
    centre_of_mass_S_m: _Three
    torque_bias_Nm: _Three
    covariance: _Matrix12


class DriftPart(ConfigPart):
    """
    How fast the bias changed at the end of the calibration, N/s and N·m/s, each with its standard deviation.

    A later reading has this much more bias per second than stated in ``gravity``, if the drift continues.
    """

    force_Nps: _Three
    torque_Nmps: _Three
    force_sigma_Nps: _ThreeSigmas
    torque_sigma_Nmps: _ThreeSigmas


class ZeroPart(ConfigPart):
    """
    The age of the bias.

    ``measured``: the end of the calibration's poses, as far as its file states it; null: unknown. ``drift`` is null if
    the poses showed none. ``follow``: a runtime subtracts what it reads in moments without touch; absent: it does not.
    """

    measured: _Time | None
    drift: DriftPart | None
    follow: bool = False


class NoisePart(ConfigPart):
    """
    The uncertainty of a wrench.

    ``force_N`` and ``torque_Nm`` are of one reading. ``orientation_rad``: of one pose of the calibration, about each
    axis; null: not stated. ``wrench_covariance`` is of a compensated, filtered wrench (N², N²·m, N²·m²), the
    calibration's share included, on average over all orientations. The runtime adds the squares of
    ``touch.model_error`` to its diagonal.
    """

    force_N: _ThreeSigmas
    torque_Nm: _ThreeSigmas
    orientation_rad: Annotated[float, Field(ge=0, le=0.5)] | None
    wrench_covariance: _Matrix6


class KalmanPart(ConfigPart):
    """
    As KalmanFilter: each channel a random walk seen through white noise.

    ``kalman`` is the paper's fixed one, which lags; ``adaptive`` starts anew where a change is beyond the noise of a
    reading. ``per_sample`` adds Q and R per sample regardless of time; otherwise both belong to ``tuned_rate_Hz`` and
    scale with time.
    """

    kind: Literal["kalman", "adaptive"]
    rate_Hz: _Positive
    q: _Positive
    r: _Positive
    tuned_rate_Hz: _Positive
    per_sample: bool


class LowPassPart(ConfigPart):
    """As LowPass: a Butterworth filter of the contact point, given as the sections that the runtime uses."""

    kind: Literal["lowpass"]
    rate_Hz: _Positive
    cutoff_Hz: _Positive
    order: Annotated[int, Field(ge=1, le=8)]
    sections: Annotated[list[_Six], Field(min_length=1, max_length=4)]


class FiltersPart(ConfigPart):
    """Filters of the compensated wrench, and of the contact point."""

    wrench: KalmanPart | None
    location: LowPassPart | None


class ModelErrorPart(ConfigPart):
    """
    Standard deviation of the error that drift, cable, hysteresis and mount leave in a wrench, by axis of S.

    ``measured``: by the verification; otherwise it is the default.
    """

    force_N: Annotated[list[Annotated[float, Field(ge=0, le=100)]], Field(min_length=3, max_length=3)]
    torque_Nm: Annotated[list[Annotated[float, Field(ge=0, le=10)]], Field(min_length=3, max_length=3)]
    measured: bool


class TouchModelPart(ConfigPart):
    """
    As TouchModel: the model of a touch beside the sensor's noise.

    ``torsion_arm_m`` is one standard deviation of the local torque over the force. ``mesh_deviation_m`` is the root
    mean square between mesh and surface, ``mesh_curved`` whether facets stand for a curved surface.
    ``torsion``: whether the arm is learned while a touch is followed; without it, it is fixed, as the answers of older
    test vectors and verifications are. ``scene``: what is touched, where somebody has said so; ``torsion_arm_m`` is
    then its own.
    """

    torsion_arm_m: _Short
    model_error: ModelErrorPart
    mesh_deviation_m: _Short
    mesh_curved: bool
    torsion: TorsionWay = "fixed"
    scene: Scene | None = None


class MotionPart(ConfigPart):
    """
    Compensation of the tool's inertia, if poses have positions.

    ``window_s``: time window of the positions from which the acceleration is estimated. ``gyration_m``: the tool's
    approximate radius of gyration about its centre of mass; the effect of its rotation is not subtracted, but added
    to the uncertainty.
    """

    window_s: Annotated[float, Field(ge=0.02, le=2)]
    gyration_m: Annotated[float, Field(ge=0, le=1)]


class StreamsPart(ConfigPart):
    """
    How poses are matched to samples, and when a stream is unhealthy.

    The orientation at a sample lies between the poses around it, no more than ``pose_gap_s`` apart; after the last pose
    it is extrapolated with the last twist, for at most ``pose_ahead_s``. After ``silence_s`` without a sample the
    sensor is silent. ``frozen_probability``: a run of equal readings less probable than this counts as a frozen sensor.
    """

    pose_gap_s: Annotated[float, Field(gt=0, le=10)]
    pose_ahead_s: Annotated[float, Field(ge=0, le=10)]
    silence_s: Annotated[float, Field(gt=0, le=10)]
    frozen_probability: Annotated[float, Field(ge=1e-30, le=1e-3)]
    motion: MotionPart | None


_ABSENT = absent_gates()
_later = {form.stored: form.way.to_stored(_ABSENT[name]) for name, form in gate_forms() if name in _ABSENT}
_gate_fields: dict[str, Any] = {
    form.stored: (form.way.part, _later.get(form.stored, ...)) for _, form in gate_forms()
}
_Gates: Any = create_model("_Gates", __base__=ConfigPart, **_gate_fields)


class GatesPart(_Gates):  # type: ignore[misc]
    """
    As Gates; null means no limit. Odds are stated as so many to one; a runtime uses 2 ln(odds).

    ``implausible_misfit``: d2, in standard deviations squared, beyond which no touch explains a wrench.
    ``saturation``: where Fx, Fy, Fz (N), Mx, My, Mz (N·m) of a raw reading end. Without limits a reading at the end of
    its range looks like a touch: give them, or pass NaN for samples that the sensor itself flags.
    """


class ProbePart(ConfigPart):
    """The mesh: binary PLY in S, metres, with the priority of each facet in the property ``region``."""

    file: _File
    name: _Text
    facets: Annotated[int, Field(ge=4, le=2_000_000)]
    vertices: Annotated[int, Field(ge=4, le=2_000_000)]
    bounds_S_m: Annotated[list[_Three], Field(min_length=2, max_length=2)]


class RegionPart(ConfigPart):
    """
    A region.

    ``odds``: how much more likely a touch there is than elsewhere; below 1 if it is ``untouchable``, because something
    covers it.
    """

    rank: Annotated[int, Field(ge=1, le=1_000)]
    name: _Text
    colour: Annotated[str, Field(pattern="^#[0-9a-f]{6}$")]
    facets: _Count
    odds: Annotated[float, Field(ge=1e-9, le=1e9)]
    untouchable: bool


class PlanesPart(ConfigPart):
    """
    The facets as planes in priority order, for controllers that run the loop of Cao et al. (2023) themselves.

    Those of untouchable regions come last. The columns nx, ny, nz, d are those of n . p + d = 0 as the paper prints
    it: n points outwards, d in m.
    """

    file: _File
    count: _Count


class ForceGainsPart(ConfigPart):
    """
    Along S's z axis: ``M`` x'' + ``D`` x' + ``K`` x = error in N.

    ``gain_per_s`` is the rate at which the aware variant approaches the wanted force, for any tissue stiffness.
    """

    mass_kg: _Positive
    damping_Nspm: Annotated[_Positive, Field(description="N*s/m")]
    stiffness_Npm: Annotated[_NotNegative, Field(description="N/m")]
    gain_per_s: _Positive


class AngleGainsPart(ConfigPart):
    """
    About S's x and y axes, in this order: ``M`` a'' + ``D`` a' + ``K`` a = error in N·m.

    The error is the wanted force times the offset of the contact. ``gain_per_s`` is the rate at which the aware
    variant turns towards the estimated tilt, and ``settling_s`` its mass over damping.
    """

    inertia: Annotated[_TwoPositive, Field(description="N*m*s²/rad")]
    damping: Annotated[_TwoPositive, Field(description="N*m*s/rad")]
    stiffness: Annotated[_TwoNotNegative, Field(description="N*m/rad")]
    gain_per_s: _TwoPositive
    settling_s: _Positive


class LeadPart(ConfigPart):
    """
    Parameters with which the aware variant estimates the tissue's motion, for feed-forward.

    ``bandwidth_per_s``: of the place, the tilt about x, the tilt about y. ``lean_rad`` and ``lean_s``: angle by which
    friction tilts the tissue's force, and its duration.
    """

    bandwidth_per_s: _ThreePositive
    smoothing_s: _Positive
    lean_rad: _Positive
    lean_s: _Positive


class TouchPart(ConfigPart):
    """Approach, loss of contact and retraction; ``probing_m``: depth of the press that measures stiffness, 0: none."""

    approach_speed_mps: _Positive
    approach_travel_m: _Positive
    retract_speed_mps: _Positive
    retract_travel_m: _Positive
    touch_force_N: _Positive
    low_force_N: _Positive
    ramp_s: _Positive
    probing_m: _NotNegative
    attempts: _Count


class ToolPart(ConfigPart):
    """
    Properties of sensor and tool beside the calibration.

    ``left_force_N`` and ``left_torque_Nm`` are the remaining bias of the sensor; ``taring_s`` is the waiting time in
    the air before each run, 0: none; ``gyration_m`` is the tool's radius of gyration about its centre of
    mass, 0: unknown.
    """

    left_force_N: _Positive
    left_torque_Nm: _Positive
    taring_s: _NotNegative
    gyration_m: _NotNegative


class WatchPart(ConfigPart):
    """
    When the controller stops and retracts.

    Without a fresh sample for ``stale_s`` it stops; after ``give_up_s`` more it retracts. An arm that lags by more than
    ``following_s`` at the largest speeds does not follow. Turned by more than ``max_tilt_rad`` from its start, it
    retracts.
    """

    stale_s: _Positive
    give_up_s: _Positive
    following_s: _Positive
    max_tilt_rad: Annotated[float, Field(gt=0, lt=1.5708)]


class ControllerPart(ConfigPart):
    """
    Admittance control in force and orientation; see the control documentation.

    ``plain`` follows only force and contact position; ``aware`` also estimates the tissue's motion and feeds it
    forward. A set-point is due every ``period_s``; the arm reaches it ``servo_lag_s`` later.
    """

    variant: Literal["plain", "aware"]
    desired_force_N: _Positive
    period_s: _Positive
    servo_lag_s: _NotNegative
    force: ForceGainsPart
    angle: AngleGainsPart
    lead: LeadPart
    touch: TouchPart
    tool: ToolPart
    watch: WatchPart


class LimitsPart(ConfigPart):
    """Limits that a controller must never exceed."""

    max_force_N: _Positive
    max_torque_Nm: _Positive
    max_speed_mps: _Positive | None
    max_turn_radps: _Positive | None


class VerificationPart(ConfigPart):
    """Results measured on markers; lengths in m. ``ratio`` is the error over the noise bound."""

    touches: _Count
    markers: _Count
    mean_error_m: _NotNegative
    sd_error_m: _NotNegative
    p95_error_m: _NotNegative
    max_error_m: _NotNegative
    ratio: _NotNegative | None
    p99_time_s: _NotNegative | None
    limit_mean_m: _Positive
    limit_max_m: _Positive
    passed: bool
    diagnosis: Annotated[str, Field(max_length=10_000)]


class KnownWeightPart(ConfigPart):
    """
    A known weight that was hung on the tool, and what the compensated sensor made of it.

    ``outcome``: ``undecided`` where the uncertainty was too large to tell.
    """

    mass_kg: _Positive
    mass_sigma_kg: _NotNegative
    certificate: _Text | None
    measured_kg: _Number
    measured_sigma_kg: _NotNegative
    outcome: Literal["passed", "failed", "undecided"]
    created: _Time | None


class KnownTouchPart(ConfigPart):
    """
    A known point that was pressed, and where the contact was located; null: it was not.

    ``outcome``: as of the known weight.
    """

    point_S_m: _Three
    located_S_m: _Three | None
    error_m: _NotNegative | None
    sigma_m: _NotNegative | None
    outcome: Literal["passed", "failed", "undecided"]
    created: _Time | None


class ChecksPart(ConfigPart):
    """What no residual of a calibration shows - sign, units, scale - and a check does; null: it was not done."""

    known_weight: KnownWeightPart | None
    known_touch: KnownTouchPart | None


class SelfTestPart(ConfigPart):
    """Samples with the answers that a runtime must give; see docs/bundle.md."""

    file: _File
    samples: Annotated[int, Field(ge=1, le=100_000)]


class SourcePart(ConfigPart):
    """A file that something here was computed from."""

    role: _Text
    name: _Text
    sha256: _Hash


class ProvenancePart(ConfigPart):
    """Who, when, with what, and the hash of every other file of the bundle."""

    created: _Time
    tool: _Text
    operator: _Text
    session: _Text | None
    files: Annotated[dict[_File, _Hash], Field(min_length=1, max_length=50)]
    sources: Annotated[list[SourcePart], Field(max_length=200)]
    stale: Annotated[list[_Text], Field(max_length=100)]


class RuntimeModel(ConfigPart):
    """
    A whole config.

    ``verified`` is true only if ``verification`` passed, no check in ``checks`` failed, and nothing it rests on was
    stale at the export.
    """

    schema_: Literal["contactbench.runtime"] = Field(alias="schema")
    version: Literal[4]
    units: UnitsPart
    frames: FramesPart
    world: WorldPart
    sensor: SensorPart
    gravity: GravityPart
    zero: ZeroPart
    noise: NoisePart
    touch: TouchModelPart
    streams: StreamsPart
    filters: FiltersPart
    gates: GatesPart
    probe: ProbePart
    regions: Annotated[list[RegionPart], Field(max_length=1_000)]
    planes: PlanesPart
    controller: ControllerPart | None
    limits: LimitsPart
    verification: VerificationPart | None
    checks: ChecksPart
    self_test: SelfTestPart | None
    verified: bool
    provenance: ProvenancePart

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object."""
        return self.model_dump(mode="json", by_alias=True)
