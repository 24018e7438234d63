"""
What a table of sessions says: trends, what is due, and what stands out.

Trends are of one sensor with one tool. The slope is the median of the slopes between two sessions (Theil 1950, Sen
1968), which a few wrong sessions do not move; whether there is one, the test of Mann and Kendall says by the signs of
these slopes, with Bonferroni's correction for the number of trends that are looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from contactbench.pipeline.fleet.row import AXES

Array = NDArray[np.float64]

_YEAR_S = 365.25 * 86_400.0
_NORMAL = 1.4826  # the standard deviation of a normal distribution over its median absolute deviation
FEWEST = 8  # sessions, for a trend or an outlier
_CHANCE = 0.01  # of telling any trend at all where there is none
# Robust standard deviations, times 1 + 8 / n for a series of n: of normal numbers about one in 4000 is beyond.
OUTLIER, _FEW = 6.0, 8.0
_ALL_PAIRS = 300  # beyond, each session is compared with the one half the series later


@dataclass(frozen=True)
class Quantity:
    """A column that is watched."""

    column: str
    title: str
    unit: str
    scale: float  # from the column to the unit
    least: float  # in the unit: scatter below this is none, whatever the series says
    sigma: str = ""  # column of its standard deviation


def _vector(name: str, title: str, si: str, unit: str, scale: float, least: float) -> tuple[Quantity, ...]:
    return tuple(
        Quantity(f"{name}_{axis}_{si}", f"{title} {axis}", unit, scale, least, f"{name}_sigma_{axis}_{si}")
        for axis in AXES
    )


QUANTITIES = (
    *_vector("force_bias", "force bias", "N", "N", 1.0, 0.01),
    *_vector("torque_bias", "torque bias", "Nm", "mN·m", 1e3, 0.5),
    Quantity("mass_kg", "mass", "g", 1e3, 0.5, "mass_sigma_kg"),
    *_vector("centre", "centre of mass", "m", "mm", 1e3, 0.05),
    Quantity("error_mean_m", "verification error", "mm", 1e3, 0.01),
    Quantity("temperature_C", "temperature", "°C", 1.0, 0.2),
)


@dataclass(frozen=True)
class Trend:
    """How a quantity of one sensor with one tool changes, in the quantity's unit."""

    sensor: str
    tool: str
    quantity: str
    unit: str
    sessions: int
    median: float
    newest: float
    per_year: float
    spread: float  # robust standard deviation about the trend
    chance: float  # of as clear a trend where there is none
    drifts: bool


@dataclass(frozen=True)
class DueCalibration:
    """A sensor with a tool whose calibration is due, or soon is."""

    sensor: str
    tool: str
    place: str
    due: str  # ISO 8601; empty: it was never calibrated, or nobody can tell
    days: int  # until then; below 0: since
    sentence: str


@dataclass(frozen=True)
class Outlier:
    """A session that stands out, and why."""

    place: str
    sensor: str
    tool: str
    reason: str  # the quantity; or refused, failed, stale, future
    sentence: str


@dataclass(frozen=True)
class DueRules:
    """When a calibration is due."""

    today: date
    max_age: int = 365  # days
    soon: int = 30  # days ahead


@dataclass(frozen=True)
class FleetFindings:
    """What a table says."""

    trends: tuple[Trend, ...]
    due: tuple[DueCalibration, ...]
    outliers: tuple[Outlier, ...]


def judge(table: Any, rules: DueRules) -> FleetFindings:
    """
    Judge a table.

    Parameters
    ----------
    table : pyarrow.Table
        Of `contactbench.pipeline.fleet.row`.
    rules : DueRules
    """
    columns = _Columns(table)
    groups = columns.groups()
    series = [
        found
        for rows in groups
        for quantity in QUANTITIES
        if (found := _Series.of(columns, rows, quantity)) is not None
    ]
    limit = _CHANCE / max(len(series), 1)
    trends = tuple(each.trend(limit) for each in series)
    outliers = [
        outlier
        for each, trend in zip(series, trends, strict=True)
        for outlier in each.outliers(drifts=trend.drifts)
    ]
    due = [each for rows in groups if (each := _due(columns, rows, rules)) is not None]
    return FleetFindings(
        trends,
        tuple(sorted(due, key=lambda each: (each.days, each.sensor, each.tool))),
        (*_facts(columns, rules), *outliers),
    )


class _Columns:
    """A table as arrays: numbers with NaN for None, times in s."""

    def __init__(self, table: Any) -> None:
        self._table = table
        self.sensor, self.tool, self.place, self.session, self.due_unreadable = (
            self.values(name) for name in ("sensor", "tool", "place", "session", "due_unreadable")
        )
        self._numbers: dict[str, Array] = {}
        self.time = self.numbers("calibrated")
        self.due: list[date | None] = self.values("due")

    def values(self, name: str) -> list[Any]:
        found: list[Any] = self._table[name].to_pylist()
        return found

    def numbers(self, name: str) -> Array:
        if name not in self._numbers:
            column = self._table[name]
            since_1970 = name == "calibrated"  # which the table has in µs
            column = column.cast("int64") if since_1970 else column
            numbers = np.asarray(column.cast("float64").to_numpy(), dtype=np.float64)
            self._numbers[name] = 1e-6 * numbers if since_1970 else numbers
        return self._numbers[name]

    def groups(self) -> list[NDArray[np.intp]]:
        """
        Return the rows of each sensor with each tool, by time; rows without a time come last.

        Without a serial number nobody knows whether two sessions are of one sensor: each is alone.
        """
        names = np.array(
            [
                f"{sensor or chr(0) + session}\0{tool}"
                for sensor, session, tool in zip(self.sensor, self.session, self.tool, strict=True)
            ]
        )
        if not len(names):
            return []
        order = np.lexsort((self.time, names))
        return np.split(order, np.flatnonzero(names[order][1:] != names[order][:-1]) + 1)


@dataclass(frozen=True, eq=False)
class _Series:
    """A quantity of one group: by time, in the quantity's unit."""

    columns: _Columns
    rows: NDArray[np.intp]
    quantity: Quantity
    years: Array
    values: Array
    sigmas: Array

    @classmethod
    def of(cls, columns: _Columns, rows: NDArray[np.intp], quantity: Quantity) -> _Series | None:
        """Return it; None: too few sessions have it."""
        values = quantity.scale * columns.numbers(quantity.column)[rows]
        use = np.isfinite(values) & np.isfinite(columns.time[rows])
        if use.sum() < FEWEST:
            return None
        rows, values = rows[use], values[use]
        sigmas = np.zeros(len(rows))
        if quantity.sigma:
            sigmas = np.nan_to_num(quantity.scale * columns.numbers(quantity.sigma)[rows])
        years = (columns.time[rows] - columns.time[rows][0]) / _YEAR_S
        return cls(columns, rows, quantity, years, values, sigmas)

    def trend(self, limit: float) -> Trend:
        slope, chance = self._slope
        spread = self._spread(self._beside(slope))
        moved = abs(slope) * float(np.ptp(self.years))
        first = self.rows[0]
        return Trend(
            self.columns.sensor[first],
            self.columns.tool[first],
            self.quantity.title,
            self.quantity.unit,
            len(self.rows),
            float(np.median(self.values)),
            float(self.values[-1]),
            slope,
            spread,
            chance,
            chance < limit and moved > self.quantity.least,
        )

    def outliers(self, *, drifts: bool) -> Iterator[Outlier]:
        """Yield sessions far from the others; where there is a trend, far from that."""
        beside = self._beside(self._slope[0] if drifts else 0.0)
        scale = np.maximum(self._spread(beside), self.sigmas)
        limit = OUTLIER * (1.0 + _FEW / len(self.rows))
        for at in np.flatnonzero(np.abs(beside) > limit * scale):
            row, unit = self.rows[at], self.quantity.unit
            where = "the trend" if drifts else "the median"
            yield Outlier(
                self.columns.place[row],
                self.columns.sensor[row],
                self.columns.tool[row],
                self.quantity.title,
                f"The {self.quantity.title} is {self.values[at]:.4g} {unit}: {abs(beside[at]):.3g} {unit}"
                f" ({abs(beside[at]) / scale[at]:.0f} robust standard deviations) from {where} of"
                f" {len(self.rows)} sessions.",
            )

    @cached_property
    def _slope(self) -> tuple[float, float]:
        """The slope, a year, and the chance of one as clear where there is none."""
        n = len(self.values)
        if n <= _ALL_PAIRS:
            early, late = np.triu_indices(n, 1)
            variance = n * (n - 1) * (2 * n + 5) / 18.0  # of the sum of signs; Kendall 1975
        else:
            early, late = np.arange(n // 2), np.arange(n // 2) + (n + 1) // 2
            variance = float(len(early))  # no session is in two pairs; Cox and Stuart 1955
        rise, apart = self.values[late] - self.values[early], self.years[late] - self.years[early]
        use = apart > 0
        if not use.any():
            return 0.0, 1.0
        signs = abs(float(np.sign(rise[use]).sum()))
        chance = 2.0 * float(ndtr(-max(signs - 1.0, 0.0) / np.sqrt(variance)))
        return float(np.median(rise[use] / apart[use])), chance

    def _beside(self, slope: float) -> Array:
        flat = self.values - slope * self.years
        return flat - np.median(flat)

    def _spread(self, beside: Array) -> float:
        return max(_NORMAL * float(np.median(np.abs(beside))), self.quantity.least)


def _due(columns: _Columns, rows: NDArray[np.intp], rules: DueRules) -> DueCalibration | None:
    """Say whether a sensor with a tool is due, by its newest calibration and its certificate."""
    dated = rows[columns.time[rows] < _tomorrow(rules)]
    newest = int(dated[-1]) if len(dated) else int(rows[-1])
    who = (columns.sensor[newest], columns.tool[newest], columns.place[newest])
    alone = "" if columns.sensor[newest] else " Serial number missing: set devices.serial."
    if not len(dated):
        never = not np.isfinite(columns.time[rows]).any()
        what = "Never calibrated." if never else "Its only calibration has a date in the future."
        return DueCalibration(*who, "", 0, what + alone)
    if unreadable := columns.due_unreadable[newest]:
        what = f"Its certificate's date is unreadable: {unreadable[:40]!r}: set report.due as 2027-03-31."
        return DueCalibration(*who, "", 0, what + alone)
    calibrated = datetime.fromtimestamp(columns.time[newest], UTC).date()
    age = calibrated + timedelta(days=rules.max_age)
    certificate = columns.due[newest] or age
    by_certificate = certificate < age
    due = min(certificate, age)
    days = (due - rules.today).days
    if days > rules.soon:
        return None
    what = (
        f"The sensor's certificate {'ran out' if days < 0 else 'runs out'} on {due}."
        if by_certificate
        else f"Calibrated on {calibrated}; due after {rules.max_age} days, on {due}."
    )
    return DueCalibration(*who, due.isoformat(), days, what + alone)


def _tomorrow(rules: DueRules) -> float:
    """Return when the day after today begins, s: what has a later date has a wrong one."""
    return datetime.combine(rules.today + timedelta(days=1), time.min, UTC).timestamp()


def _facts(columns: _Columns, rules: DueRules) -> Iterator[Outlier]:
    """Yield the sessions whose own judgement is bad."""
    verdicts, stale, passed = (
        columns.values("verdict"),
        columns.values("stale"),
        columns.values("verification_passed"),
    )
    tomorrow = _tomorrow(rules)
    for row, place in enumerate(columns.place):
        who = (place, columns.sensor[row], columns.tool[row])
        if columns.time[row] >= tomorrow:
            yield Outlier(*who, "future", "Its calibration has a date in the future: check the clock.")
        if verdicts[row] == "refuse":
            yield Outlier(*who, "refused", "Its calibration is refused.")
        if stale[row]:
            yield Outlier(*who, "stale", "Its calibration is stale.")
        if passed[row] is False:
            yield Outlier(*who, "failed", "Its verification failed.")
