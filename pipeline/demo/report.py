"""What the demo found: as data, as tables, and in sentences."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.demo.compare import ALL, OURS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rich.table import Table

    from contactbench.pipeline.demo.compare import MethodErrors
    from contactbench.pipeline.demo.gravity import GravityResult
    from contactbench.pipeline.demo.housing import MeshResult
    from contactbench.pipeline.demo.verification import CheckResult

# Noise alone gives a mean error of 0.9 times the bound, and the facets add little; a wrong sign, frame or unit
# gives many times it. The mean, because one rare wrong facet would rule the root mean square of few touches.
LIMIT = 1.3
# Few touches with one calibration: its error is the same in all of them and does not average out.
TOUCHED_LIMIT = 1.5

MARKERS, DRAWN = "markers", "drawn"
_HEADINGS = ("mean", "p95", "max", "× bound", "answered", "ambiguous", "µs")


@dataclass(frozen=True)
class ProbeResult:
    """One probe."""

    probe: str  # its name
    # facets, region_facets: of the mesh, and of its contact region
    facets: int
    region_facets: int
    # every method on the markers of the virtual bench; empty without MuJoCo
    touched: tuple[MethodErrors, ...]
    drawn: tuple[MethodErrors, ...]  # every method on touches drawn by formula
    gravity: GravityResult  # how its gravity calibration did
    # how the preparation of its mesh did; None where it could not be done, and a note says why
    mesh: MeshResult | None
    checked: CheckResult | None  # its verification and bundle; None without MuJoCo

    @property
    def shown(self) -> tuple[MethodErrors, ...]:
        """What a newcomer should look at: touches of markers, or drawn ones where there is no physics."""
        return self.touched or self.drawn

    @property
    def verified(self) -> bool:
        """Whether mesh, gravity and bundle are right, and contactbench is as near to the truth as noise explains."""
        prepared = self.mesh is None or self.mesh.verified
        touched = not self.touched or within(ours(self.touched), TOUCHED_LIMIT)
        checked = self.checked is None or self.checked.verified
        return prepared and self.gravity.verified and touched and within(ours(self.drawn), LIMIT) and checked


@dataclass(frozen=True)
class DemoReport:
    """Everything that the demo found."""

    out: Path  # the folder with the files
    # touches, seed: drawn touches per probe, and the seed of chance
    touches: int
    seed: int
    # force_noise, torque_noise: standard deviations of one reading of the simulated sensor, N and N·m
    force_noise: float
    torque_noise: float
    probes: tuple[ProbeResult, ...]
    picture: Path | None  # None when it could not be drawn; a note says why
    notes: tuple[str, ...]  # what was left out, and how to get it

    @property
    def verified(self) -> bool:
        """Whether every probe is verified."""
        return all(result.verified for result in self.probes)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        data = asdict(self)
        for entry, result in zip(data["probes"], self.probes, strict=True):
            entry["verified"] = result.verified
            entry["gravity"]["verified"] = result.gravity.verified
            if result.mesh is not None:
                entry["mesh"]["verified"] = result.mesh.verified
            if result.checked is not None:
                entry["checked"]["verified"] = result.checked.verified
        return {
            **data,
            "out": str(self.out),
            "picture": None if self.picture is None else str(self.picture),
            "notes": list(self.notes),
            "limit": LIMIT,
            "verified": self.verified,
        }

    def table(self) -> Table:
        """Return the table for the terminal: every method over all touches of each probe."""
        from rich.table import Table

        table = Table(box=None, pad_edge=False, caption=_CAPTION, caption_justify="left")
        for heading in ("probe", "method"):
            table.add_column(heading, no_wrap=True)
        for heading in _HEADINGS:
            table.add_column(heading, justify="right")
        for result in self.probes:
            rows = [row for row in result.shown if row.where == ALL]
            for row in rows:
                first = result.probe if row is rows[0] else ""
                style = "bold" if row.method == OURS else ""
                table.add_row(first, row.method, *_cells(row), style=style, end_section=row is rows[-1])
        return table

    def csv_rows(self) -> tuple[tuple[str, ...], list[tuple[object, ...]]]:
        """Return columns and rows of errors.csv; times are left out, because they differ from run to run."""
        names = ("method", "where", "touches", "mean_mm", "p95_mm", "max_mm", "bound_mm", "over_bound")
        shares = ("answered", "ambiguous")
        rows = [
            (result.probe, kind, *(getattr(row, name) for name in (*names, *shares)))
            for result in self.probes
            for kind, row in _rows(result)
        ]
        return ("probe", "kind", *names, *shares), rows

    def markdown(self) -> str:
        """Return the content of errors.md."""
        headings = ("probe", "touches", "method", *_HEADINGS)
        lines = ["# Errors against the known truth", "", *(f"{line}  " for line in self.sentences()[:-1]), ""]
        lines += [_line(headings), _line(["---"] * 3 + ["---:"] * len(_HEADINGS))]
        for result in self.probes:
            for kind, row in _rows(result):
                touches = f"{row.touches:,} {kind}, {row.where}"
                lines.append(_line((result.probe, touches, row.method, *_cells(row))))
        return "\n".join([*lines, "", _CAPTION, ""])

    def sentences(self) -> list[str]:
        """Return what was done and found, for people."""
        return [
            self._done(),
            *(result.mesh.sentence(result.probe) for result in self.probes if result.mesh is not None),
            *(result.gravity.sentence(result.probe) for result in self.probes),
            *map(_verdict, self.probes),
            *(result.checked.sentence(result.probe) for result in self.probes if result.checked is not None),
            *self.notes,
            f"The files are in {self.out}.",
        ]

    def _done(self) -> str:
        names = ", ".join(result.probe for result in self.probes)
        noise = f"a sensor noise of {self.force_noise:g} N and {self.torque_noise:g} N·m"
        drawn = f"{self.touches:,} points drawn on its head"
        if not all(result.touched for result in self.probes):
            return (
                f"On each probe ({names}), with {noise}: located {drawn}, each from one reading of 8 to 10 N."
            )
        return (
            f"On the virtual bench, with each probe ({names}) and {noise}: weighed the tool, pressed every marker"
            f" with 8 to 10 N, straight and at 30 degrees, filtered half a second of readings and located it; verified"
            f" that, and ran the same readings through the bundle that a robot would load; then located {drawn}, each"
            f" from one reading."
        )


def ours(errors: Sequence[MethodErrors]) -> MethodErrors:
    """Return how contactbench did over all touches."""
    return next(row for row in errors if (row.method, row.where) == (OURS, ALL))


def within(row: MethodErrors, limit: float) -> bool:
    """Tell whether the mean error is at most `limit` times the noise bound."""
    return row.mean_mm is not None and row.bound_mm is not None and row.mean_mm <= limit * row.bound_mm


_CAPTION = (
    "mean, p95 and max are errors in mm, of touches answered without doubt. × bound is their root mean square"
    " over what noise and calibration would give. Only contactbench ever says ambiguous; iterative"
    " knows the contact face only. µs is the median time of one compiled solve."
)


def _rows(result: ProbeResult) -> list[tuple[str, MethodErrors]]:
    return [*((MARKERS, row) for row in result.touched), *((DRAWN, row) for row in result.drawn)]


def _verdict(result: ProbeResult) -> str:
    parts = [(ours(result.drawn), "drawn touches", LIMIT)]
    if result.touched:
        parts.insert(0, (ours(result.touched), "touches of markers", TOUCHED_LIMIT))
    return f"{result.probe}: {'; '.join(_found(*part) for part in parts)}."


def _found(row: MethodErrors, what: str, limit: float) -> str:
    if row.mean_mm is None or row.over_bound is None:
        return f"FAILED, not one of {row.touches:,} {what} was located without doubt"
    found = f"mean error {row.mean_mm:.2f} mm over {row.touches:,} {what}, {row.over_bound:.2f} times the noise bound"
    if within(row, limit):
        return found
    return f"{found}, FAILED: even the mean is more than {limit:g} times the {row.bound_mm:.2f} mm of noise"


def _cells(row: MethodErrors) -> list[str]:
    lengths = [_number(value) for value in (row.mean_mm, row.p95_mm, row.max_mm, row.over_bound)]
    shares = [f"{100 * share:.1f} %" for share in (row.answered, row.ambiguous)]
    return [*lengths, *shares, _number(row.median_us)]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _line(cells: tuple[str, ...] | list[str]) -> str:
    return "| " + " | ".join(cells) + " |"
