"""
What a person chooses for a step, declared once.

A command takes its options from these fields, a session its parameters, a form its rows: one name, one range, one
default, one sentence. Lengths are in mm and angles in degrees, as people say them. Nothing here takes long to import.
"""

from __future__ import annotations

import math
from datetime import date
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BeforeValidator, Field

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.gates import Gates, SigmaMax, sigma_max_knob
from contactbench.pipeline.knobs import NotNegative, Number, Positive, Row, Settings, Three, knob

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# How well orientations are known by what gives them, degrees: 1 sigma about each axis.
ORIENTATION_NOISE_DEG = {"robot": 0.05, "tracker": 0.2, "hand": 0.5}


def metres(millimetres: float | None) -> float | None:
    """Return a length in metres; None stays None."""
    return None if millimetres is None else millimetres / 1000


def mount_rotation(degrees: Three | None) -> NDArray[np.float64] | None:
    """Return R_ES (3, 3) of angles about the fixed axes x, y, z; None stays None."""
    from scipy.spatial.transform import Rotation

    if degrees is None:
        return None
    R: NDArray[np.float64] = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    return R


# ---- orientations ------------------------------------------------------------------------------


class RobotMaker(StrEnum):
    """Whose robot is told what it carries."""

    UR = "ur"
    FRANKA = "franka"
    KUKA = "kuka"
    ABB = "abb"
    DOOSAN = "doosan"


class PayloadSettings(Settings):
    """What a calibration does not know of the load on a robot's flange E; mm and kg."""

    robot: RobotMaker = knob(RobotMaker.UR, "Whose controller is to be told.")
    sensor_at: Three = knob(
        (0.0, 0.0, 0.0), "The sensor's origin in the flange's frame, mm.", metavar="X,Y,Z"
    )
    sensor_body: tuple[NotNegative, Number, Number, Number] = knob(
        (0.0, 0.0, 0.0, 0.0),
        "Mass of the sensor with its adapters, kg, and its centre of mass in the flange's frame, mm.",
        metavar="KG,X,Y,Z",
    )


class MountSettings(Settings):
    """How the sensor is mounted."""

    mount: Three | None = knob(
        None,
        "Orientations are those of the flange; the sensor is turned on it by these angles about"
        " the fixed axes x, then y, then z of the flange, degrees.",
        metavar="RX,RY,RZ",
    )

    @property
    def R_ES(self) -> NDArray[np.float64] | None:
        """(3, 3) orientation of the sensor on the flange; None: nobody said."""
        return mount_rotation(self.mount)


class OrientationSettings(MountSettings):
    """How orientations in a table are written."""

    euler: str | None = knob(
        None,
        "Orientation is rx,ry,rz: angles about these axes, in the order of the columns; xyz:"
        " fixed axes, ZYX: rotating axes.",
        metavar="ORDER",
    )
    rotation_vector: bool = knob(False, "Orientation is rx,ry,rz: axis times angle.")
    components: Literal["wxyz", "xyzw", "rows", "columns"] | None = knob(
        None,
        "What q1 to q4 (or q0 to q3) are: wxyz or xyzw; what the first letter of rxx to rzz names: rows of the matrix,"
        " or columns, the axes.",
    )
    radians: bool = knob(False, "Angles are in rad, not degrees.")
    inverse: bool = knob(False, "Orientations turn world into sensor components (R_SW).")


class JointsSettings(Settings):
    """Whose joints give an orientation."""

    robot: str | None = knob(
        None,
        "Orientation is that of a robot's flange, by joints j1, j2, ...: elfin3, or a URDF or MJCF file.",
        metavar="NAME|FILE",
    )


class PosesSettings(JointsSettings, OrientationSettings):
    """How orientations in a table are written, also as the joints of a robot."""


def _delay(value: object) -> object:
    try:
        return value if value in (None, "auto") else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise ValueError(message("give seconds, or auto")) from None


class DelaySettings(Settings):
    """How a recording's wrenches are put beside its poses."""

    delay: Annotated[Number | Literal["auto"] | None, BeforeValidator(_delay)] = knob(
        None,
        "Delay of a wrench after its pose in a recording of both; auto: estimated from the"
        " motion. A doubtful estimate is reported but not applied [0].",
        metavar="SECONDS|auto",
    )


class CapturesSettings(DelaySettings, PosesSettings):
    """How still poses are found in a recording."""


# ---- calibration -------------------------------------------------------------------------------


def _orientation_noise(value: object) -> object:
    if value is None or value in ORIENTATION_NOISE_DEG:
        return None if value is None else ORIENTATION_NOISE_DEG[str(value)]
    try:
        degrees = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        degrees = math.nan
    if not 0 <= degrees < 180:
        raise ValueError(
            message(f"give degrees, at least 0, or one of {arg(', '.join(ORIENTATION_NOISE_DEG))}")
        )
    return degrees


class NoiseSettings(Settings):
    """How well poses are known; what is left out is estimated from them."""

    noise_force: Number | None = knob(
        None, "Standard deviation of a pose's mean force, N [estimated from the poses]."
    )
    noise_torque: Number | None = knob(None, "The same for its torque, N·m; give both or neither.")
    orientation_noise: Annotated[Number | None, BeforeValidator(_orientation_noise)] = knob(
        None,
        "Uncertainty of the orientations, 1 sigma about each axis: degrees, or their source"
        " (robot 0.05, tracker 0.2, hand 0.5) [estimated from the poses].",
        metavar="DEGREES|robot|tracker|hand",
    )

    @property
    def orientation_sigma(self) -> float | None:
        """About each axis, rad; None: it is estimated from the poses."""
        return None if self.orientation_noise is None else math.radians(self.orientation_noise)


class DownSettings(Settings):
    """Where gravity points."""

    down: Three = knob(
        (0.0, 0.0, -1.0),
        "Direction of gravity in the world frame of the orientations, of any length; 0,0,1 for a"
        " robot that hangs from the ceiling and reports poses in its base frame.",
        metavar="X,Y,Z",
    )

    @property
    def down_W(self) -> tuple[float, float, float]:
        """The same as a unit vector in W; InputError if it has no direction."""
        length = math.hypot(*self.down)
        if not length > 0:
            raise InputError("--down has no direction: give the direction of gravity, such as 0,0,-1.")
        x, y, z = self.down
        return x / length, y / length, z / length


class TaskSettings(Settings):
    """The touches that a calibration is for."""

    tip: Three = knob(
        (0.0, 0.0, 100.0), "Where the probe will be touched, mm in the sensor frame.", metavar="X,Y,Z"
    )
    contact_force: Number = knob(10.0, "Force of those touches, N.")


class CalibrationSettings(PosesSettings, NoiseSettings, DownSettings, TaskSettings):
    """How a calibration is made from still poses."""

    estimate_mount: bool = knob(
        False, "Orientations are those of the flange, and the rotation of the sensor on it is unknown."
    )

    @property
    def R_ES(self) -> NDArray[np.float64] | None:
        """(3, 3) orientation of the sensor on the flange; None: nobody said. InputError if it is to be estimated."""
        if self.mount is not None and self.estimate_mount:
            raise InputError("--mount and --estimate-mount contradict each other: give only one.")
        return super().R_ES


# ---- checks of a calibration -------------------------------------------------------------------


class WeightSettings(PosesSettings):
    """How a known weight is judged."""

    mass: Positive = knob(text="Mass of the weight, kg.")
    mass_sigma: NotNegative = knob(
        0.0, "Standard uncertainty of the mass, kg; half of a certificate's U (k = 2)."
    )
    certificate: str = knob("", "Number of the weight's certificate.")
    gravity: Number | None = knob(None, "Local acceleration of free fall, m/s² [9.80665 ± 0.015].")
    limit: Positive = knob(1.0, "Largest scale error that passes, %.")
    reach: Positive = knob(500.0, "Largest plausible distance of the weight's string from the sensor, mm.")


class TouchSettings(PosesSettings):
    """How a press on a known point is judged."""

    point_sigma: NotNegative = knob(2.0, "Accuracy of hitting the point, 1 sigma, mm.")
    limit: Positive = knob(5.0, "Largest error that passes, mm.")


class VerificationSettings(OrientationSettings):
    """How touches of markers are judged."""

    repeats: Annotated[int, Row("Per marker", (1, 100), suffix="×")] = knob(
        1, "Accepted touches required per marker."
    )
    samples: Annotated[int, Row("Samples", (4, 10_000))] = knob(50, "Samples per touch after settling.")
    touch_force: Positive | None = knob(None, "A touch begins at this |F|, N [2, less for windows below].")
    release_force: Positive | None = knob(None, "A touch ends below this |F|, N [1, less for windows below].")
    mean_limit_mm: Annotated[Positive, Row("Mean error up to", (0.05, 50.0), 2, 0.5)] = knob(
        1.0, "Largest permitted mean error.", unit="mm", option="--limit-mean"
    )
    max_limit_mm: Annotated[Positive, Row("Single error up to", (0.05, 50.0), 2, 0.5)] = knob(
        2.0, "Largest permitted error.", unit="mm", option="--limit-max"
    )
    noise_force: Positive | None = knob(None, "Standard deviation of a sample, N [measured in the touches].")
    noise_torque: Positive | None = knob(None, "The same for a torque, N·m.")
    seed: int = knob(0, "Seed of the bootstrap.")
    follow: bool = knob(
        False,
        "Subtract what the sensor reads between touches, here and in the runtime; lift the probe clear for half a"
        " second before each touch.",
    )


# ---- reports -----------------------------------------------------------------------------------


def _iso_date(value: object) -> object:
    if not value:
        return ""
    try:
        return date.fromisoformat(str(value)).isoformat()
    except ValueError:
        raise ValueError(message("give a date as 2027-03-31")) from None


_Line = Annotated[str, Field(max_length=200)]


class ReportSettings(Settings):
    """What a report says of who measured, and with which sensor; nothing is computed from it."""

    operator: _Line = knob("", "Who measured; for the report.")
    sensor: _Line = knob("", "Model of the force/torque sensor; for the report.")
    certificate: _Line = knob("", "Number of the sensor's calibration certificate; for the report.")
    due: Annotated[_Line, BeforeValidator(_iso_date)] = knob(
        "", "Until when that certificate is valid; for the report.", metavar="YYYY-MM-DD"
    )


# ---- probe -------------------------------------------------------------------------------------


# Each with the suffixes that its files have, the usual one first.
MESH_FORMATS: dict[str, tuple[str, ...]] = {
    "STL": (".stl",), "PLY": (".ply",), "OBJ": (".obj",), "OFF": (".off",), "3MF": (".3mf",),
    "glTF": (".glb", ".gltf"), "DAE": (".dae",), "VTK": (".vtk", ".vtp"), "STEP": (".step", ".stp"),
}  # fmt: skip
_FIRST, _LAST = ", ".join([*MESH_FORMATS][:-1]), [*MESH_FORMATS][-1]
MESH_FORMATS_SAID = message(f"{arg(_FIRST)} or {arg(_LAST)}")


class MeshSettings(Settings):
    """How a mesh file is read."""

    units: Literal["auto", "mm", "m", "cm", "in"] = knob(
        "auto", "Unit of the file's numbers; auto guesses it from the size and says why."
    )
    tolerance: Annotated[float, Field(ge=0.001, le=1), Row("STEP tolerance", (0.001, 1.0), 3, 0.005)] = knob(
        0.02, "How far facets may lie from the curved surfaces of a STEP file.", unit="mm"
    )


class ShellSettings(MeshSettings):
    """How the closed outer surface of a mesh is made."""

    close: tuple[Literal["auto", "fair", "ruled", "hull", "open"], ...] = knob(
        (),
        "How to close the openings, largest first, one entry each; the last entry applies to all"
        " others. auto: fair or ruled, by shape. fair: least bending. ruled: straight lines between the long rims."
        " hull: no dent. open: leave it. [A closed mesh: open; others: auto]",
    )
    alpha: Annotated[float | None, Row("Facet size", (0.0, 50.0), 2, none="Automatic")] = knob(
        None, "Facet size of the outer surface.", unit="mm", none="1/190 of the size"
    )
    gap: float | None = knob(None, "Gaps narrower than this are bridged, mm [1/65 of the size].")


class PlaceSettings(Settings):
    """Where a mesh is in the sensor's frame."""

    mount: tuple[Number, Number, Number, Number, Number, Number] | None = knob(
        None,
        "Pose of the mesh in S: mm, and degrees about the fixed axes x, then y, then z. Left out: the mesh stays in its"
        " own frame.",
        metavar="X,Y,Z,RX,RY,RZ",
        option="--place",
    )


class FacetSettings(MeshSettings):
    """How many facets are left."""

    facets: Annotated[int | None, Row("number of facets", (4, 2e6), step=100, start=2000)] = knob(
        None, "Facets to keep."
    )
    max_deviation: Annotated[float | None, Row("largest deviation", (0.001, 50.0), 3, 0.01, start=0.1)] = (
        knob(None, "Or: largest distance from the outer surface.", unit="mm")
    )


class LadderSettings(MeshSettings):
    """What fewer facets may do to contacts."""

    max_contact_error: Annotated[
        float | None, Row("largest contact error", (0.001, 50.0), 3, 0.01, start=0.1)
    ] = knob(None, "Or: 95 % of contacts move by less than this.", unit="mm", none="0.1")
    forces: tuple[float, float] = knob((8.0, 10.0), "Expected touch forces, N.", metavar="LOW,HIGH")
    engine: Literal["auto", "fast-simplification", "meshlab", "best"] = knob(
        "auto", "From earlier versions; has no effect.", hidden=True
    )
    region_ratio: Annotated[float, Row("Finer in regions", (1.0, 100.0), 1, suffix=": 1")] = knob(
        1.0, "Facet density inside regions relative to outside."
    )


class SimplifySettings(LadderSettings, FacetSettings):
    """How a probe is given fewer facets."""


class ProbeSettings(SimplifySettings, PlaceSettings, ShellSettings):
    """How a probe is made of a mesh file."""


# ---- heatmap -----------------------------------------------------------------------------------

Quantity = Literal["density", "force", "peak", "error", "uncertainty"]
Normalisation = Literal["contacts", "seconds", "rate"]


class ReadingSettings(MountSettings):
    """What a recording does not say itself."""

    delay: float = knob(0.0, "Delay of a wrench after its pose, s.")
    min_force: Annotated[float, Row("Touch threshold", (0.0, 100.0), 1)] = knob(
        0.5, "Force above which a touch is counted in a recording.", unit="N"
    )
    sigma_max: SigmaMax = sigma_max_knob()

    @property
    def gates(self) -> Gates:
        """By which contacts of a recording are told."""
        return Gates(min_force=self.min_force, sigma_max=self.sigma_max)


class HeatmapSettings(ReadingSettings):
    """What to show of contacts."""

    quantity: Quantity = knob("density", "Quantity to show.")
    bandwidth: float | None = knob(
        None, "Standard deviation of the Gaussian, mm [the contacts' own uncertainty, at least 1.5]."
    )
    normalisation: Normalisation = knob("contacts", "Integral of a density over the surface.", option="--per")
    marker_distance: float = knob(10.0, "A contact farther than this from every marker touched none, mm.")
    start: float | None = knob(None, "Only contacts from here on, s after the first sample.", option="--from")
    end: float | None = knob(None, "Only contacts up to here, s after the first sample.", option="--to")
    least_force: float | None = knob(None, "Only contacts with this force or more, N.", option="--force-from")
    most_force: float | None = knob(None, "Only contacts with this force or less, N.", option="--force-to")
    by_confidence: bool = knob(
        False, "Weight each contact by its confidence, 1 / (1 + the odds of every other place)."
    )
    logarithmic: bool = knob(False, "Colour by the logarithm: few contacts show beside many.")


# ---- motion control in simulation --------------------------------------------------------------


class PhantomSettings(Settings):
    """How the phantom under a virtual robot moves, and how its motion is met."""

    motion: Literal["none", "vertical", "in-plane", "out-of-plane"] = knob(
        "in-plane", "Motion of the phantom."
    )
    period: Annotated[float, Field(ge=0.5, le=1000)] = knob(10.0, "Period of that motion, s.")
    size: Annotated[float, Field(ge=0, le=30)] = knob(10.0, "Size of that motion, mm or degrees.")
    variant: Literal["plain", "aware"] | None = knob(
        None, "The paper's control, or with motion feed-forward [the bundle's]."
    )
