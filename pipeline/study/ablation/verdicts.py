"""From the rows: what to model and what to leave out, and from where on each choice matters."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.ablation import effects, location_choices, scenery, sensor_choices
from contactbench.pipeline.study.ablation.records import ANYWHERE, SCENES

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Row = dict[str, Any]
CHOICES = (*effects.CHOICES, *scenery.CHOICES)
MATTERS = 0.05  # of the error without it
_SIGMAS, ANSWERS = 2.0, 1e-3
_LEAST_MM = 0.05  # that a scene must move a contact by
LOSES = f"{location_choices.GATE}: touches lost"
_FREE = 0.02  # of what is without it, at most
NOISE = "filtered"


@dataclass(frozen=True)
class Bought:
    """What a choice buys in one scene, over all probes and repetitions; mm."""

    choice: str
    scene: str
    # without, made: mean error without it, and with it. Of the scene's own choices: how far the contact is
    # off without it, and what the scene does not know itself.
    without: float
    made: float
    # bought, sigma: mean difference, and its standard error
    bought: float
    sigma: float
    answers: float  # by how much the share of touches grows that are located without a gross miss
    models: bool  # whether to model it there


@dataclass(frozen=True)
class Cost:
    """Time without a choice and with it, µs, the middle of all probes, and of what."""

    choice: str
    per: str
    without: float
    made: float

    @property
    def more(self) -> float:
        """What it adds, µs; negative where it saves."""
        return self.made - self.without

    @property
    def free(self) -> bool:
        """Whether it costs nothing that counts."""
        return self.more <= _FREE * self.made


@dataclass(frozen=True)
class Crossing:
    """Where a choice begins to matter, along something that is varied."""

    # choice, varied, at: of what, and with what mesh and noise
    choice: str
    varied: str
    at: str
    probe: str
    # in the unit of `varied`, where it buys `MATTERS` of the error; None: nowhere in the range
    where: float | None
    above: bool  # whether it matters above it, or below; nowhere or everywhere: at the end of the range
    always: bool  # it matters over the whole range

    @property
    def words(self) -> str:
        """It in words."""
        if self.always:
            return "everywhere"
        if self.where is None:
            return "nowhere"
        return f"{'from' if self.above else 'below'} {self.where:.2g}"


@dataclass(frozen=True)
class ChoiceVerdict:
    """All that is known of a choice, in short."""

    choice: str
    scenes: tuple[Bought, ...]
    cost: Cost | None

    @property
    def verdict(self) -> str:
        """Model it, leave it out, or where."""
        need = [each.scene for each in self.scenes if each.models]
        if self.scenes and len(need) == len(self.scenes):
            return "model it"
        if need:
            return f"model it in {', '.join(need)}"
        return "keep it: no cost" if self.cost and self.cost.free else "leave it out"

    @property
    def sentence(self) -> str:
        """It as a line for a terminal."""
        most = max(self.scenes, key=lambda each: each.bought, default=None)
        buys = "" if most is None else f"buys up to {most.bought:.2g} mm ({most.scene})"
        costs = "" if self.cost is None else f", costs {self.cost.more:+.3g} µs {self.cost.per}"
        return f"{self.choice}: {self.verdict}; {buys}{costs}."

    def to_json(self) -> dict[str, Any]:
        """Return plain data."""
        return {**asdict(self), "verdict": self.verdict}


def about_choices(rows: Sequence[Row]) -> list[ChoiceVerdict]:
    """Return what the rows say of every choice that they have something of."""
    found = []
    for choice in CHOICES:
        scenes = tuple(
            bought(choice, scene, rows) for scene in (ANYWHERE, *SCENES) if _there(choice, scene, rows)
        )
        if scenes:
            found.append(ChoiceVerdict(choice, scenes, cost_of(choice, rows)))
    return found


def bought(choice: str, scene: str, rows: Iterable[Row], noise: str = NOISE) -> Bought:
    """Sum up the rows of a choice in a scene."""
    if choice in scenery.CHOICES:
        mine = [r for r in rows if (r["kind"], r["choice"], r.get("scene")) == ("scenery", choice, scene)]
        moved, floor = _mean(mine, "mean_mm"), _mean(mine, "floor_mm")
        spread = float(np.std([r["mean_mm"] for r in mine]) / np.sqrt(len(mine)))
        return Bought(choice, scene, moved, floor, moved - floor, spread, 0.0, moved - floor > _LEAST_MM)
    mine = [
        r
        for r in rows
        if (r["kind"], r["choice"], r.get("scene"), r.get("noise")) == ("effect", choice, scene, noise)
    ]
    without, made, gain = (_mean(mine, name) for name in ("without_mean_mm", "made_mean_mm", "bought_mm"))
    sigma = float(np.sqrt(np.nansum([r["bought_se_mm"] ** 2 for r in mine])) / len(mine))
    answers = located_more(mine)
    matters = gain > MATTERS * without and gain > _SIGMAS * sigma
    return Bought(choice, scene, without, made, gain, sigma, answers, bool(matters or answers >= ANSWERS))


def cost_of(choice: str, rows: Iterable[Row]) -> Cost | None:
    """Return what a choice costs; None if nothing was measured."""
    mine = [r for r in rows if r["kind"] == "cost" and r["choice"] == choice]
    if mine:
        return Cost(choice, str(mine[0]["per"]), *(_mean(mine, name) for name in ("without_us", "made_us")))
    simulated = [r for r in rows if r["kind"] == "scenery" and r["choice"] == choice]
    if not simulated:
        return None
    times = (_mean(simulated, name) for name in ("without_us", "made_us"))
    return Cost(choice, "a simulated ms", *times)


def crossings(rows: Sequence[Row]) -> list[Crossing]:
    """Return where every choice begins to matter, along each curve, for each probe."""
    groups: dict[tuple[Any, ...], dict[float, list[Row]]] = {}
    for row in rows:
        if row["kind"] != "curve":
            continue
        noise = None if row["x_name"] == "noise" else row["noise_times"]
        key = (row["choice"], row["x_name"], row["facets"], noise, row["probe"])
        groups.setdefault(key, {}).setdefault(row["x"], []).append(row)
    found = []
    for (choice, varied, facets, noise, probe), by_x in groups.items():
        xs = sorted(by_x)
        level, values = MATTERS, [share_of(by_x[x]) for x in xs]
        if choice == location_choices.GATE:  # what it can do to a touch is to lose it
            choice, level, values = LOSES, ANSWERS, [-located_more(by_x[x]) for x in xs]
        at = f"{facets:,} facets" + ("" if noise is None else f", noise {noise_name(noise)}")
        found.append(Crossing(choice, varied, at, probe, *crossing(xs, values, level)))
    return found


def share_of(rows: Sequence[Row]) -> float:
    """Return the share of the error that a choice takes away, over repetitions."""
    without = _mean(rows, "without_mean_mm")
    return _mean(rows, "bought_mm") / without if without > 0 else 0.0


def located_more(rows: Sequence[Row]) -> float:
    """Return by how much the share of touches grows that are located without doubt and without a gross miss."""
    return float(np.mean([_located(row, "made") - _located(row, "without") for row in rows]))


def crossing(
    xs: Sequence[float], values: Sequence[float], level: float = MATTERS
) -> tuple[float | None, bool, bool]:
    """
    Return where values pass a level for good, whether they lie above it after that, and whether they always do.

    Parameters
    ----------
    xs : sequence of float
        Ascending; interpolated between their logarithms, but for 0.
    """
    over = np.array(values) >= level
    if over.all():
        return None, True, True
    if not over.any():
        return None, True, False
    above = bool(over[-1])
    # From the end on which it matters: the first place where it does not any more.
    order = range(len(xs) - 1, 0, -1) if above else range(len(xs) - 1)
    step = -1 if above else 1
    for i in order:
        if over[i] and not over[i + step]:
            a, b = sorted((i, i + step))
            part = (level - values[a]) / (values[b] - values[a])
            if xs[a] > 0:
                return float(xs[a] * (xs[b] / xs[a]) ** part), above, False
            return float(xs[a] + part * (xs[b] - xs[a])), above, False
    # Only somewhere in the middle: named by where it begins.
    return float(xs[int(np.argmax(over))]), True, False


def noise_name(times: float) -> str:
    """Return the name of a noise, times that of one sensor_choices."""
    return next((name for name, value in effects.NOISES.items() if value == times), f"{times:g}")


def unit_of(choice: str) -> str:
    """Return what a choice of reading is varied by, with its usual amount; empty for the others."""
    if choice not in sensor_choices.CHOICES:
        return ""
    return f"{sensor_choices.USUAL[choice]:g} {sensor_choices.UNITS[choice]}"


def _located(row: Row, which: str) -> float:
    return float(row[f"{which}_sure"] * (1 - _or_zero(row[f"{which}_gross"])))


def _or_zero(value: float | None) -> float:
    return 0.0 if value is None or np.isnan(value) else value


def _mean(rows: Sequence[Row], name: str) -> float:
    return float(np.nanmean([row[name] for row in rows]))


def _there(choice: str, scene: str, rows: Iterable[Row]) -> bool:
    return any(
        r["kind"] in ("effect", "scenery") and (r["choice"], r["scene"]) == (choice, scene) for r in rows
    )
