"""What a sweep varies, and the cells that this makes."""

from __future__ import annotations

import hashlib
import tomllib
from collections import Counter
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from contactbench import __version__, assets
from contactbench.pipeline.contact.methods import METHODS
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.sweep.noise import FILTERS, NOISES

if TYPE_CHECKING:
    from collections.abc import Iterator

_MOST_CELLS = 1_000_000

Facets = Annotated[int, Field(ge=20, le=2_000_000)]
Force = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=0, lt=90, allow_inf_nan=False)]
Arm = Annotated[float, Field(ge=0, le=0.1, allow_inf_nan=False)]


@dataclass(frozen=True)
class Cell:
    """
    One combination of everything that is varied.

    Attributes
    ----------
    method : str
        Of `contactbench.pipeline.contact.methods.METHODS`.
    probe : str
        Name of a bundled probe, or path of a prepared one.
    facets : int
        Asked for; what there is may differ by a few.
    force : float
        |F|, N.
    angle : float
        Between the force and the normal, degrees.
    torsion : float
        Standard deviation of the torque about the normal over |F|, m.
    noise, filter : str
        Of `NOISES` and `FILTERS`.
    touches : int
    seed : int
        Of the plan.
    """

    method: str
    probe: str
    facets: int
    force: float
    angle: float
    torsion: float
    noise: str
    filter: str
    touches: int
    seed: int

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


class Plan(BaseModel):
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

    @field_validator("methods", "noises", "filters")
    @classmethod
    def _known(cls, values: tuple[str, ...], info: Any) -> tuple[str, ...]:
        known = {"methods": METHODS, "noises": NOISES, "filters": FILTERS}[info.field_name]
        for value in values:
            if value not in known:
                raise ValueError(f"{value!r} is none of {', '.join(known)}")
        return values

    @field_validator("most_facets")
    @classmethod
    def _methods(cls, values: dict[str, int]) -> dict[str, int]:
        for name in values:
            if name not in METHODS:
                raise ValueError(f"{name!r} is none of {', '.join(METHODS)}")
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
                yield Cell(method, probe, facets, force, angle, torsion, noise, way, self.touches, self.seed)

    @classmethod
    def read(cls, file: Path) -> Plan:
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
    def of(cls, values: dict[str, Any], where: str = "study") -> Plan:
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
