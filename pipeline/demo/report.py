"""What the demo found: as data, as tables, and in sentences."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from pipeline.demo.compare import ALL

if TYPE_CHECKING:
    from pathlib import Path

    from rich.table import Table

    from pipeline.demo.compare import MethodErrors
    from pipeline.demo.gravity import GravityResult
    from pipeline.demo.housing import MeshResult

# Noise alone gives a mean error of 0.9 times the bound, and the facets add little; a wrong sign, frame or unit
# gives many times it. The mean, because one rare wrong facet would rule the root mean square of few touches.
LIMIT = 1.3

_OURS = "contactbench"
_HEADINGS = ("mean", "p95", "max", "× bound", "answered", "ambiguous", "µs")


@dataclass(frozen=True)
class ProbeResult:
    """One probe.

    Attributes
    ----------
    probe : str
        Its name.
    facets, region_facets : int
        Of the mesh, and of its contact region.
    errors : tuple of MethodErrors
        Every method on every part.
    gravity : GravityResult
        How its gravity calibration did.
    mesh : MeshResult or None
        How the preparation of its mesh did; None where it could not be done, and a note says why.
    """

    probe: str
    facets: int
    region_facets: int
    errors: tuple[MethodErrors, ...]
    gravity: GravityResult
    mesh: MeshResult | None

    @property
    def ours(self) -> MethodErrors:
        """How contactbench did over all touches."""
        return next(row for row in self.errors if (row.method, row.where) == (_OURS, ALL))

    @property
    def verified(self) -> bool:
        """Whether mesh and gravity are right, and contactbench's mean error is at most 1.3 times the noise bound."""
        prepared = self.mesh is None or self.mesh.verified
        return prepared and self.gravity.verified and self.located

    @property
    def located(self) -> bool:
        """Whether the mean error of contactbench is at most 1.3 times the noise bound."""
        ours = self.ours
        return (
            ours.mean_mm is not None and ours.bound_mm is not None and ours.mean_mm <= LIMIT * ours.bound_mm
        )


@dataclass(frozen=True)
class DemoReport:
    """Everything that the demo found.

    Attributes
    ----------
    out : Path
        The folder with the files.
    touches, seed : int
        Touches per probe, and the seed of chance.
    force_noise, torque_noise : float
        Standard deviations of the simulated sensor, N and N·m.
    probes : tuple of ProbeResult
    picture : Path or None
        None when it could not be drawn; a note says why.
    notes : tuple of str
        What was left out, and how to get it.
    """

    out: Path
    touches: int
    seed: int
    force_noise: float
    torque_noise: float
    probes: tuple[ProbeResult, ...]
    picture: Path | None
    notes: tuple[str, ...]

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
            rows = [row for row in result.errors if row.where == ALL]
            for row in rows:
                first = result.probe if row is rows[0] else ""
                style = "bold" if row.method == _OURS else ""
                table.add_row(first, row.method, *_cells(row), style=style, end_section=row is rows[-1])
        return table

    def csv_rows(self) -> tuple[tuple[str, ...], list[tuple[object, ...]]]:
        """Return columns and rows of errors.csv; times are left out, because they differ from run to run."""
        names = ("method", "where", "touches", "mean_mm", "p95_mm", "max_mm", "bound_mm", "over_bound")
        shares = ("answered", "ambiguous")
        rows = [
            (result.probe, *(getattr(row, name) for name in (*names, *shares)))
            for result in self.probes
            for row in result.errors
        ]
        return ("probe", *names, *shares), rows

    def markdown(self) -> str:
        """Return the content of errors.md."""
        headings = ("probe", "touches", "method", *_HEADINGS)
        lines = ["# Errors against the known truth", "", *(f"{line}  " for line in self.sentences()[:-1]), ""]
        lines += [_line(headings), _line(["---"] * 3 + ["---:"] * len(_HEADINGS))]
        for result in self.probes:
            for row in result.errors:
                lines.append(_line((result.probe, f"{row.touches:,} {row.where}", row.method, *_cells(row))))
        return "\n".join([*lines, "", _CAPTION, ""])

    def sentences(self) -> list[str]:
        """Return what was done and found, for people."""
        names = ", ".join(result.probe for result in self.probes)
        done = (
            f"Simulated {self.touches:,} touches of 8 to 10 N on each probe ({names}), with"
            f" {self.force_noise:g} N and {self.torque_noise:g} N·m of sensor noise, and located them."
        )
        prepared = [result.mesh.sentence(result.probe) for result in self.probes if result.mesh is not None]
        weighed = [result.gravity.sentence(result.probe) for result in self.probes]
        return [
            done,
            *prepared,
            *weighed,
            *map(_verdict, self.probes),
            *self.notes,
            f"The files are in {self.out}.",
        ]


_CAPTION = (
    "mean, p95 and max are errors in mm, of touches answered without doubt. × bound is their root mean square"
    " over what noise and calibration would give. Only contactbench and scan ever say ambiguous; iterative"
    " knows the contact face only. µs is the median time of one compiled solve."
)


def _verdict(result: ProbeResult) -> str:
    ours = result.ours
    if ours.mean_mm is None or ours.over_bound is None:
        return f"{result.probe}: FAILED, not one touch was located without doubt."
    found = f"{result.probe}: mean error {ours.mean_mm:.2f} mm, {ours.over_bound:.2f} times the noise bound"
    if result.located:
        return f"{found}."
    return f"{found}. FAILED: even the mean is more than {LIMIT:g} times the {ours.bound_mm:.2f} mm of noise."


def _cells(row: MethodErrors) -> list[str]:
    lengths = [_number(value) for value in (row.mean_mm, row.p95_mm, row.max_mm, row.over_bound)]
    shares = [f"{100 * share:.1f} %" for share in (row.answered, row.ambiguous)]
    return [*lengths, *shares, _number(row.median_us)]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _line(cells: tuple[str, ...] | list[str]) -> str:
    return "| " + " | ".join(cells) + " |"
