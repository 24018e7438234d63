"""What a sweep varies, and the cells that this makes."""

from __future__ import annotations

import hashlib
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from contactbench import __version__, assets
from contactbench.pipeline.contact.methods import METHODS
from contactbench.pipeline.contact.touch_model import WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.simulation.sensor_model import PRESETS
from contactbench.pipeline.simulation.touches import Sampled

_MOST_CELLS = 1_000_000

Facets = Annotated[int, Field(ge=20, le=2_000_000)]
Force = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=0, lt=90, allow_inf_nan=False)]
Arm = Annotated[float, Field(ge=0, le=0.1, allow_inf_nan=False)]


@dataclass(frozen=True)
class Cell:
    """One combination of everything that is varied."""

    method: str  # of `contactbench.pipeline.contact.methods.METHODS`
    probe: str  # name of a bundled probe, or path of a prepared one
    facets: int  # asked for; what there is may differ by a few
    force: float  # |F|, N
    angle: float  # between the force and the normal, degrees
    torsion: float  # standard deviation of the torque about the normal over |F|, m
    # noise, filter: of `NOISES` and `FILTERS`
    noise: str
    filter: str
    touches: int
    seed: int  # of the plan
    times: bool  # whether they are measured, too

    @property
    def key(self) -> str:
        """What it is known by: a hash of all that it is and of who computes it, 16 hexadecimal digits."""
        return _hash(asdict(self) | {"probe": identity(self.probe), "version": __version__})

    @property
    def touch_seed(self) -> int:
        """Seed of the touches: the same for all methods, meshes, noises and filters, so that they are paired."""
        drawn = ("force", "angle", "torsion", "touches", "seed")
        values = {name: getattr(self, name) for name in drawn}
        return int(_hash(values | {"probe": identity(self.probe)}), 16)


def label(probe: str) -> str:
    """Return what a probe is called: its name, or that of its file wherever it lies."""
    return probe if probe in assets.PROBE_NAMES else Path(probe).name


@lru_cache
def identity(probe: str) -> str:
    """Return what a probe is known by everywhere: its name, for a file with a hash of what is in it; InputError."""
    if probe in assets.PROBE_NAMES:
        return probe
    try:
        content = Path(probe).read_bytes()
    except (OSError, ValueError) as error:
        known = ", ".join(assets.PROBE_NAMES)
        raise InputError(
            f"{probe}: the probe cannot be read ({error}): give one of {known}, or a prepared .ply."
        ) from error
    return f"{label(probe)}#{hashlib.sha256(content).hexdigest()[:16]}"


def _hash(values: dict[str, Any]) -> str:
    text = ";".join(f"{name}={values[name]!r}" for name in sorted(values))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class SweepPlan(BaseModel):
    """
    What a sweep varies: every combination is a cell.

    Attributes
    ----------
    name : str
    methods, probes, facets, forces, angles, torsions, noises, filters : tuple
        See `Cell`; forces in N, angles in degrees, torsions in m.
    most_facets : dict
        Method -> facets above which it is left out, because it takes too long there.
    touches : int
        In each cell.
    seed : int
    times : bool
        Whether to measure them, too.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_-]{0,63}$")] = "sweep"
    methods: Annotated[tuple[str, ...], Field(min_length=1)] = ("contactbench", "algorithm1", "wrench_axis")
    probes: Annotated[tuple[str, ...], Field(min_length=1)] = ("linear", "convex", "t-shape")
    facets: Annotated[tuple[Facets, ...], Field(min_length=1)] = (2_000,)
    forces: Annotated[tuple[Force, ...], Field(min_length=1)] = (9.0,)
    angles: Annotated[tuple[Angle, ...], Field(min_length=1)] = (0.0, 30.0)
    torsions: Annotated[tuple[Arm, ...], Field(min_length=1)] = (0.0003,)
    noises: Annotated[tuple[str, ...], Field(min_length=1)] = ("paper",)
    filters: Annotated[tuple[str, ...], Field(min_length=1)] = ("none",)
    most_facets: dict[str, Facets] = Field(default_factory=dict)
    touches: Annotated[int, Field(ge=10, le=1_000_000)] = 1_000
    seed: Annotated[int, Field(ge=0, le=2**32)] = 0
    times: bool = True

    @field_validator("methods", "noises", "filters", "most_facets")
    @classmethod
    def _known(cls, values: Any, info: Any) -> Any:
        known = {"noises": NOISES, "filters": FILTERS}.get(info.field_name, METHODS)
        for value in values:
            if value not in known:
                raise ValueError(f"{value!r} is none of {', '.join(known)}")
        return values

    @field_validator("probes")
    @classmethod
    def _told_apart(cls, values: tuple[str, ...]) -> tuple[str, ...]:
        for name, count in Counter(map(label, values)).items():
            if count > 1:
                raise ValueError(f"two probes are called {name}: rename one")
        return values

    @field_validator("*")
    @classmethod
    def _once(cls, values: Any) -> Any:
        if isinstance(values, tuple) and len(set(values)) < len(values):
            raise ValueError("something is named twice")
        return values

    def cells(self) -> tuple[Cell, ...]:
        """Return all cells; InputError if they are too many, or a probe cannot be read."""
        if (count := len(self)) > _MOST_CELLS:
            raise InputError(
                f"{self.name}: {count:,} cells are more than {_MOST_CELLS:,}: vary less at once."
            )
        if not count:
            raise InputError(f"{self.name}: most_facets: it leaves no cell: allow more facets.")
        return tuple(self._all())

    def __len__(self) -> int:
        count = sum(self._wanted(method, facets) for method in self.methods for facets in self.facets)
        for name in _VARIED:
            count *= 1 if name in ("methods", "facets") else len(getattr(self, name))
        return count

    def _wanted(self, method: str, facets: int) -> bool:
        return facets <= self.most_facets.get(method, facets)

    def _all(self) -> Iterator[Cell]:
        for probe, facets, force, angle, torsion, noise, way, method in product(
            *(getattr(self, name) for name in _VARIED)
        ):
            if self._wanted(method, facets):
                drawn = self.touches, self.seed
                yield Cell(method, probe, facets, force, angle, torsion, noise, way, *drawn, self.times)

    def changed(
        self,
        probes: Sequence[str] = (),
        touches: int | None = None,
        seed: int | None = None,
        times: bool | None = None,
    ) -> SweepPlan:
        """Return it with other probes, touches, seed or times, where they are given; InputError."""
        given = {"probes": tuple(probes) or None, "touches": touches, "seed": seed, "times": times}
        return SweepPlan.of(
            self.model_dump() | {name: value for name, value in given.items() if value is not None}
        )

    def told(self) -> dict[str, Any]:
        """Return all that has a say in the results, as plain values that are the same on every machine."""
        probes = [identity(probe) for probe in self.probes]
        return (
            {"contactbench": __version__}
            | self.model_dump(mode="json", exclude={"name"})
            | {"probes": probes}
        )

    @classmethod
    def read(cls, file: Path) -> SweepPlan:
        """
        Read a plan, TOML with the names of the attributes.

        Raises
        ------
        InputError
            It cannot be read, or a field is wrong; the message names it.
        """
        try:
            values = tomllib.loads(file.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(f"{file}: the study cannot be read ({error}): give a TOML file.") from error
        return cls.of({"name": _plain(file.stem), **values}, str(file))

    @classmethod
    def of(cls, values: dict[str, Any], where: str = "study") -> SweepPlan:
        """Return the plan of plain values; InputError that names the field."""
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False)[0]
            field = ".".join(map(str, first["loc"]))
            raise InputError(
                f"{where}: {field}: {first['msg'].removeprefix('Value error, ')}: correct it."
            ) from error


_VARIED = ("probes", "facets", "forces", "angles", "torsions", "noises", "filters", "methods")


def _plain(stem: str) -> str:
    kept = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in stem.lower())
    return kept if kept[:1].isalpha() else f"s-{kept}"


def preset_plan(name: str) -> SweepPlan:
    """Return a plan that comes with contactbench, by its name; InputError if there is none of that name."""
    known = {file.stem: file for file in sorted(Path(__file__).with_name("presets").glob("*.toml"))}
    if name not in known:
        raise InputError(f"--preset {name}: choose one of {', '.join(known)}.")
    return SweepPlan.read(known[name])


# ---- the probes of a sweep: what is touched, and the mesh that it is located on ------------------


_ABOVE_M = 0.02  # of a bundled probe: what is nearer to the flange is not touched
_KEPT = 8  # meshes of a process


@dataclass(frozen=True, eq=False)
class TouchedBody:
    """A probe that is touched."""

    surface: Sampled  # as it truly is
    above: float  # only what lies higher than this is touched, z in S, m


class MeshSurface:
    """A mesh as a true surface."""

    def __init__(self, probe: Probe) -> None:
        self._corners = probe.vertices[probe.faces]
        areas = np.linalg.norm(
            np.cross(self._corners[:, 1] - self._corners[:, 0], self._corners[:, 2] - self._corners[:, 0]),
            axis=1,
        )
        self._normals = probe.normals
        self._shares = np.cumsum(areas) / areas.sum()

    def sample(self, count: int, rng: np.random.Generator) -> Sequence[Floats]:
        """Give points (count, 3), m, spread evenly by area, and outward normals (count, 3)."""
        faces = np.minimum(np.searchsorted(self._shares, rng.random(count)), len(self._shares) - 1)
        u, v = np.sqrt(rng.random(count)), rng.random(count)
        weights = np.column_stack([1 - u, u * (1 - v), u * v])
        return np.einsum("nk,nkd->nd", weights, self._corners[faces]), self._normals[faces]


@lru_cache(maxsize=_KEPT)
def body_of(name: str) -> TouchedBody:
    """Return what is touched: a bundled probe's exact surface, or the file's own mesh; InputError."""
    if name in assets.PROBE_NAMES:
        return TouchedBody(assets.surface(name), _ABOVE_M)
    probe = _file(name)
    low, high = probe.bounds
    return TouchedBody(MeshSurface(probe), float(low[2] + 0.15 * (high[2] - low[2])))


@lru_cache(maxsize=_KEPT)
def mesh_of(name: str, facets: int) -> Probe:
    """Return the mesh of about so many facets that contacts are located on; InputError."""
    if name in assets.PROBE_NAMES:
        return model_of(name, facets)
    from contactbench.pipeline.mesh.simplify import Count, simplify

    probe = _file(name)
    return probe if facets >= len(probe.faces) else simplify(probe, Count(facets)).probe


def file_facets(name: str) -> int | None:
    """Return how many facets a file has; None for a bundled probe, which can have any number; InputError."""
    return None if name in assets.PROBE_NAMES else len(_file(name).faces)


@lru_cache(maxsize=_KEPT)
def _file(name: str) -> Probe:
    content = load_probe_file(Path(name))
    if content.history and content.frame != "S":
        raise InputError(
            f"{name}: the probe is not aligned with the sensor: `contactbench probe align` does it."
        )
    return content.probe


# ---- sensors and filters of a sweep, as what they leave of the noise in a held touch -------------


# Standard deviation of one reading: Fx, Fy, Fz in N, Mx, My, Mz in N·m.
NOISES: Mapping[str, tuple[float, ...]] = {
    "none": (0.0,) * 6,
    **{name: tuple(float(x) for x in np.asarray(settings.noise)) for name, settings in PRESETS.items()},
}
# Share of the standard deviation of white noise that is left in a touch that is held long enough. Filters are linear:
# of Gaussian noise they make Gaussian noise of that share, so that it can be drawn as it is.
FILTERS: Mapping[str, float] = {
    "none": 1.0,
    "mean-10": float(1 / np.sqrt(10)),
    "mean-50": float(1 / np.sqrt(50)),
    "kalman": float(KalmanFilter().figures(200.0).noise_left),
}
_QUIETEST = np.repeat([1e-6, 1e-8], 3)  # a solver needs some noise to weigh candidates by


def deviations(noise: str, way: str) -> Floats:
    """Return the standard deviations (6,) of a filtered reading, N and N·m."""
    return FILTERS[way] * np.array(NOISES[noise])


def believed(noise: str, way: str) -> WrenchNoise:
    """Return the noise that a method is told: that of the filtered reading, a millionth of a newton at least."""
    sigmas = np.maximum(deviations(noise, way), _QUIETEST)
    return WrenchNoise(force=sigmas[:3], torque=sigmas[3:])
