"""What a sweep varies, and the cells that this makes."""

from __future__ import annotations

import hashlib
import tomllib
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from pipeline.contact.methods import METHODS
from pipeline.errors import InputError
from pipeline.study.sweep.noise import FILTERS, NOISES

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
        Of `pipeline.contact.methods.METHODS`.
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
        """What it is known by: a hash of all that it is, 16 hexadecimal digits."""
        return _hash(asdict(self))

    @property
    def touch_seed(self) -> int:
        """Seed of the touches: the same for all methods, meshes, noises and filters, so that they are paired."""
        drawn = ("probe", "force", "angle", "torsion", "touches", "seed")
        return int(_hash({name: value for name, value in asdict(self).items() if name in drawn}), 16)

    @property
    def group(self) -> tuple[str, int]:
        """What cells must have in common to share a mesh: probe and facets."""
        return self.probe, self.facets


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

    @field_validator("*")
    @classmethod
    def _once(cls, values: Any) -> Any:
        if isinstance(values, tuple) and len(set(values)) < len(values):
            raise ValueError("something is named twice")
        return values

    def cells(self) -> tuple[Cell, ...]:
        """Return all cells, those that share a mesh together; InputError if they are too many."""
        if (count := len(self)) > _MOST_CELLS:
            raise InputError(
                f"{self.name}: {count:,} cells are more than {_MOST_CELLS:,}: vary less at once."
            )
        return tuple(self._all())

    def __len__(self) -> int:
        count = 1
        for name in _VARIED:
            count *= len(getattr(self, name))
        return count

    def _all(self) -> Iterator[Cell]:
        for probe, facets, force, angle, torsion, noise, way, method in product(
            *(getattr(self, name) for name in _VARIED)
        ):
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
            raise InputError(f"{where}: {field}: {first['msg']}: correct it.") from error


_VARIED = ("probes", "facets", "forces", "angles", "torsions", "noises", "filters", "methods")


def _plain(stem: str) -> str:
    kept = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in stem.lower())
    return kept if kept[:1].isalpha() else f"s-{kept}"
