"""
The limits that decide when an answer is given, declared once.

From these fields come the options of commands, the part ``gates`` of a bundle, the struct of the kernel with the tables
that fill it (``packaging/declarations.py`` writes them) and the table of the documentation.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, erfc, exp, inf, isinf, log, radians, sqrt
from operator import gt, neg, not_
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import Field, ValidationError

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.knobs import Row, Settings, first_fault, knob

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    import numpy as np
    from numpy.typing import NDArray

BEHIND_M = 0.003  # along the force: nearer surfaces are one, seen through the noise

_Least0 = Annotated[float, Field(ge=0)]
_Odds = Annotated[float, Field(ge=1, le=1e9)]
_Limit = Annotated[float, Field(gt=0)]


def _same(value: Any) -> Any:
    return value


@dataclass(frozen=True)
class Way:
    """How a kind of limit is written in a bundle, and what the kernel makes of it."""

    part: Any  # Its type in a bundle
    name: str = "value"  # What the loader's table calls it: enum `From` of the kernel
    to_stored: Callable[[Any], Any] = _same
    of_stored: Callable[[Any], Any] = _same
    to_kernel: Callable[[Any], Any] = _same


def _cost(odds: float) -> float:
    """Return what so many to one are worth in d2."""
    return 2 * log(odds)


def _misfit(probability: float) -> float:
    from statistics import NormalDist  # slow to import, and seldom needed

    return NormalDist().inv_cdf(1 - probability / 2) ** 2


def _probability(misfit: float) -> float:
    return min(max(erfc(sqrt(misfit / 2)), 1e-9), 0.5)


def _numbers(value: Any) -> tuple[Any, ...]:
    return value if isinstance(value, tuple) else (value,)


def _unless_0(value: float) -> float:
    return value or inf


_NUMBER = Way(Annotated[float, Field(ge=0, le=1e9)], to_stored=float)
_COUNT = Way(Annotated[int, Field(ge=0, le=2**31 - 1)])
_FLAG = Way(bool)
_ODDS = Way(_Odds, "odds", to_stored=float, to_kernel=_cost)
_ANGLE = Way(
    Annotated[float, Field(gt=0, lt=1.5708)], "angle", radians, degrees, lambda angle: cos(radians(angle))
)
_CHANCE = Way(Annotated[float, Field(ge=0.45, le=37.4)], "value", _misfit, _probability, _misfit)
_LIMITS = Way(
    Annotated[list[Annotated[float, Field(gt=0, le=1e9)] | None], Field(min_length=6, max_length=6)],
    "value",
    lambda limits: [None if isinf(limit) else float(limit) for limit in limits],
    lambda limits: tuple(inf if limit is None else limit for limit in limits),
)


@dataclass(frozen=True)
class Form:
    """
    What a limit is called in a bundle and, if that is another name, in the kernel.

    A `later` one came when there were bundles already: they have it only where it is not what it means where there is
    none, `absent` or the default, so that those of before read and are written as ever. `lax` grows with how much a
    limit lets through; None: it decides nothing about one touch alone.
    """

    stored: str
    held: str = ""
    way: Way = _NUMBER
    later: bool = False
    absent: Any = None
    lax: Callable[[Any], Any] | None = None


_DEPTH = Form("depth_distance_m", later=True, absent=0.0, lax=_unless_0)
SigmaMax = Annotated[_Least0, Row("Largest sigma", (0.0, 50.0), 1, 0.5)]


def sigma_max_knob(default: float = 0.0) -> Any:
    """Return the field of the gate of nearness, m: what is looked at asks for none, what is acted on for some."""
    return knob(
        default,
        "Reason uncertain when the largest standard deviation of the point is more than this. 0: not asked.",
        unit="mm",
        scale=1000,
        none="" if default else "not asked",
        why="In an analysis every answer states its own. A bundle is acted on: an export asks for 2 mm, for then 95 %"
        " of the accepted points are off by less than 5 mm, and that is as far as one place reaches.",
    )


class GateSettings(Settings):
    """The gates as they are given: lengths in m, odds as "so many to one"."""

    min_force: Annotated[_Least0, Form("min_force_N", lax=neg)] = knob(
        0.5,
        "Reason low_force below this force.",
        unit="N",
        why="With 0.05 N of noise the force direction is then known to 6 degrees and the point to about 15 mm;"
        " below it, an answer would be pure noise.",
    )
    friction_angle: Annotated[
        float, Field(gt=0, lt=90), Form("friction_angle_rad", "cos_friction", _ANGLE, lax=_same)
    ] = knob(
        75.0,
        "Reason tangential beyond this angle to the normal.",
        unit="degrees",
        why="Friction would have to exceed 3.7, and the noise bound is already four times that of a perpendicular"
        " touch.",
    )
    ambiguity_distance: Annotated[_Least0, Form("ambiguity_distance_m", lax=_same)] = knob(
        0.005,
        "Reason ambiguous when another likely place is this far away, or 4.5 standard deviations if that is more.",
        unit="mm",
        scale=1000,
        why="Smaller distances lie within the scatter of a light touch and do not disturb a controller.",
    )
    implausible_probability: Annotated[
        float, Field(ge=1e-9, le=0.5), Form("implausible_misfit", "implausible_misfit", _CHANCE, lax=neg)
    ] = knob(
        0.001,
        "Reason implausible if a touch leaves a misfit that chance alone reaches with at most this probability.",
        why="Chi-square with one degree of freedom: d2 over 10.8.",
    )
    rival_odds: Annotated[_Odds, Form("rival_odds", "rival_cost", _ODDS, lax=neg)] = knob(
        100.0, "Reason ambiguous unless the likeliest place is this many times likelier than any other."
    )
    region_odds: _Odds = knob(
        1000.0,
        "Odds of a touch in the region of highest priority relative to elsewhere; each further region has a tenth of"
        " it, at least 10.",
    )
    untouchable_odds: _Odds = knob(
        1000.0, "A touch of an untouchable facet is less likely than any other by this factor."
    )
    first_odds: Annotated[_Odds, Form("first_odds", "behind_cost", _ODDS, lax=_same)] = knob(
        exp(2.0),
        "Odds that the first surface on the line of force is touched rather than one behind it.",
        none="7.4",
        why="e squared, enough to decide between equals, too little to hide an ambiguity.",
    )
    follow_odds: Annotated[_Odds, Form("follow_odds", "follow_cost", _ODDS)] = knob(
        1000.0, "When tracking: odds that a touch stays near the previous one rather than jumps."
    )
    follow_distance: Annotated[_Least0, Form("follow_distance_m")] = knob(
        0.010,
        "When tracking: prefer places this near the last contact.",
        unit="mm",
        scale=1000,
        why="At 200 Hz a probe sliding at 1 m/s moves 5 mm, and a light touch scatters by 5 mm.",
    )
    recent_samples: Annotated[int, Field(ge=0, lt=2**63), Form("recent_samples", way=_COUNT)] = knob(
        20,
        "When tracking: forget the last contact after this many samples in a row without an accepted one.",
        why="0.1 s at 200 Hz, shorter than any deliberate lift and touch.",
    )
    max_age: Annotated[_Least0, Form("max_age_s")] = knob(
        0.1,
        "Reason stale when a sample is older; when tracking, a longer gap starts anew.",
        unit="s",
        why="Five control cycles of a 50 Hz robot.",
    )
    saturation: Annotated[
        tuple[_Limit, _Limit, _Limit, _Limit, _Limit, _Limit], Form("saturation", way=_LIMITS, lax=_same)
    ] = knob(
        (inf, inf, inf, inf, inf, inf),
        "Reason saturated when a channel reaches this.",
        unit="N, N·m",
        none="none",
        metavar="FX,FY,FZ,MX,MY,MZ",
        why="Take it from the sensor's data sheet: a clipped channel looks like any other number.",
    )
    region_only: Annotated[bool, Form("region_only", way=_FLAG, lax=not_)] = knob(
        False,
        "Refuse contacts outside every region of the mesh.",
        none="anywhere",
        option="--region-only/--anywhere",
        why="Regions are a preference among candidates, not a fence.",
    )
    accept_by_region: Annotated[bool, Form("accept_by_region", way=_FLAG, lax=_same)] = knob(
        True,
        "Accept, and follow when tracking, contacts whose place is certain only because of the regions of the mesh.",
        none="accept",
        option="--accept-by-region/--no-accept-by-region, /--not-by-region",
        why="Declaring a region states that touches are expected there. A press along the probe's axis is rarely"
        " certain without it, because the line of force also meets the shoulder of the flange.",
    )
    sigma_max: Annotated[SigmaMax, Form("sigma_max_m", later=True, lax=_unless_0)] = sigma_max_knob()
    depth_distance: Annotated[_Least0, _DEPTH] = knob(
        0.002,
        "Two places, too, where one lies this far off the other's plane along the force, and half of what it is away in"
        " that plane. 0: not asked.",
        unit="mm",
        scale=1000,
        why="Noise moves a touch along the force only as far as its own surface leads: a wall behind a plate is another"
        " place. Nearer surfaces are told in the covariance.",
    )


class Gates(GateSettings):
    """
    Limits and odds behind the reason codes; lengths in m, force in N, odds as "so many to one".

    A touch is judged by d2, its misfit to the wrench, in standard deviations squared. Odds are in the same unit: odds
    of o to 1 are worth 2 ln(o). InputError: a limit is out of range.
    """

    if not TYPE_CHECKING:

        def __init__(self, **given):
            try:
                super().__init__(**given)
            except ValidationError as error:
                where, what = first_fault(error)
                raise InputError(f"Gates.{arg(where)}: {arg(what)}: correct it.") from None

    @property
    def implausible_misfit(self) -> float:
        """d2 that chance exceeds with `implausible_probability`: a normal variable's quantile, squared."""
        return _misfit(self.implausible_probability)

    def bonus(self, region: NDArray[np.int32], untouchable: Iterable[int] = ()) -> NDArray[np.float64]:
        """
        Return 2 ln(odds) of a touch on each facet.

        Parameters
        ----------
        region : (m,) int32
            Number of each facet's region, 0 for none.
        untouchable : iterable of int
            Numbers of the untouchable regions.
        """
        import numpy as np

        count = int(region.max(initial=0))
        return np.array([0.0, *(_cost(odds) for odds in self.odds(count, untouchable))])[region]

    def odds(self, count: int, untouchable: Iterable[int] = ()) -> list[float]:
        """Return the odds of a touch in each of `count` regions, numbered from 1, relative to one elsewhere."""
        hidden = set(untouchable)
        odds, listed = self.region_odds, []
        for number in range(1, count + 1):
            if number in hidden:
                listed.append(1 / self.untouchable_odds)
            else:
                listed.append(odds)
                odds = max(odds / 10, min(odds, 10.0))
        return listed

    def kernel_values(self) -> dict[str, Any]:
        """Return the argument `gates` of :class:`contactbench.pipeline.kernel.Solver`."""
        return {form.held or name: form.way.to_kernel(getattr(self, name)) for name, form in gate_forms()}

    def told(self) -> dict[str, Any]:
        """Return them as a file tells them: a later one only where it is not what a bundle without it means."""
        absent = absent_gates()
        names = [name for name in GateSettings.model_fields if name != "ambiguity_distance"]
        names.insert(names.index("region_odds"), "ambiguity_distance")  # where verifications always had it
        told = {name: getattr(self, name) for name in names}
        return {name: told[name] for name in names if name not in absent or told[name] != absent[name]}

    def stored(self) -> dict[str, Any]:
        """Return them as a bundle holds them, SI; the odds of regions are in the regions themselves."""
        return {form.stored: form.way.to_stored(getattr(self, name)) for name, form in gate_forms()}

    def more_than(self, told: Mapping[str, Any]) -> Iterator[str]:
        """Name the limits that let touches through which they did not as a file tells them, with both values."""
        known = {name: told[name] for name in GateSettings.model_fields if name in told}
        if "saturation" in known:
            known["saturation"] = tuple(inf if limit is None else limit for limit in known["saturation"])
        other = Gates(**{**absent_gates(), **known})
        for name, form in gate_forms():
            here, there = getattr(self, name), getattr(other, name)
            if form.lax and any(map(gt, _numbers(form.lax(here)), _numbers(form.lax(there)))):
                yield _worded(name, here, there)
        for name in ("region_odds", "untouchable_odds"):
            if getattr(self, name) != getattr(other, name):
                yield _worded(name, getattr(self, name), getattr(other, name))

    @classmethod
    def of_stored(cls, values: Any, **others: Any) -> Self:
        """
        Return gates from what a bundle holds.

        Parameters
        ----------
        values
            With an attribute for each name in a bundle.
        **others
            Gates that no bundle holds.

        Raises
        ------
        InputError
            A number is out of its range.
        """
        told = {name: form.way.of_stored(getattr(values, form.stored)) for name, form in gate_forms()}
        return cls(**told, **others)


def gate_forms() -> Iterator[tuple[str, Form]]:
    """Yield the gates that the kernel has: name and form."""
    for name, field in GateSettings.model_fields.items():
        yield from ((name, each) for each in field.metadata if isinstance(each, Form))


def absent_gates() -> dict[str, Any]:
    """Return what a bundle means that does not have a later gate: name of the gate -> value."""
    usual = Gates()
    return {
        name: getattr(usual, name) if form.absent is None else form.absent
        for name, form in gate_forms()
        if form.later
    }


def _worded(name: str, *values: Any) -> str:
    """Say a limit and two values of it as people read them, and not as a file keeps them."""
    about: Any = GateSettings.model_fields[name].json_schema_extra
    one, other = (f"{about['scale'] * each:g}" if isinstance(each, float) else each for each in values)
    unit = f" {about['unit']}" if about["unit"] else ""
    return f"{name.replace('_', ' ')} {one}{unit} ({other}{unit})"
