"""Studies that are there by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.sweep.plan import Plan

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_ALL = ("contactbench", "algorithm1", "wrench_axis", "iterative")
# What the paper varied: its three probes, 1 to 20 N, 0 and 30 degrees, its filter, its rivals.
_PAPER = {
    "name": "paper",
    "methods": _ALL,
    "facets": (500, 2_000),
    "forces": (1.0, 2.0, 5.0, 9.0, 20.0),
    "angles": (0.0, 30.0),
    "filters": ("none", "kalman"),
    "touches": 2_000,
}
_GROWING = {
    "methods": _ALL,
    "forces": (2.0, 9.0, 20.0),
    "angles": (0.0, 30.0),
    "noises": ("none", "paper"),
    # The literal loop takes a millisecond for 20,000 facets: its law is known long before.
    "most_facets": {"algorithm1": 5_000},
}
# How time and error grow with the mesh.
_RESOLUTION = _GROWING | {
    "name": "resolution",
    "facets": (100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 300_000, 1_000_000),
    "touches": 2_000,
}
# The same in a minute: fewer meshes, forces and touches.
_QUICK = _GROWING | {
    "name": "quick",
    "facets": (100, 500, 2_000, 20_000, 300_000),
    "forces": (9.0,),
    "most_facets": {"algorithm1": 2_000},
    "touches": 500,
}
# Error against force and angle: little and much force, steep, twisted, quiet and loud.
_STEEP = {
    "name": "steep",
    "methods": ("contactbench", "algorithm1", "wrench_axis"),
    "facets": (2_000, 20_000),
    "forces": (1.0, 2.0, 5.0, 10.0, 20.0),
    "angles": (0.0, 30.0, 45.0, 60.0, 70.0),
    "torsions": (0.0003, 0.003),
    "noises": ("none", "paper"),
    "most_facets": {"algorithm1": 2_000},
    "touches": 1_000,
}
PRESETS: Mapping[str, Mapping[str, object]] = {
    str(each["name"]): each for each in (_PAPER, _RESOLUTION, _QUICK, _STEEP)
}


def preset(
    name: str, probes: Sequence[str] = (), touches: int | None = None, seed: int | None = None
) -> Plan:
    """
    Return a plan by its name.

    Parameters
    ----------
    name : str
        Of PRESETS.
    probes : sequence of str, optional
        Instead of the bundled ones.
    touches, seed : int, optional
        Instead of its own.

    Raises
    ------
    InputError
        There is none of that name, or a value is wrong.
    """
    if name not in PRESETS:
        raise InputError(f"--preset {name}: choose one of {', '.join(PRESETS)}.")
    return changed(Plan.of(dict(PRESETS[name])), probes, touches, seed)


def changed(
    plan: Plan, probes: Sequence[str] = (), touches: int | None = None, seed: int | None = None
) -> Plan:
    """Return a plan with other probes, touches or seed, where they are given; InputError."""
    values = plan.model_dump()
    given = {"probes": tuple(probes) or None, "touches": touches, "seed": seed}
    return Plan.of(values | {name: value for name, value in given.items() if value is not None})
