"""A fleet as one HTML page that needs nothing beside itself; the same table, the same day: the same bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench import __version__
from contactbench.pipeline.page import moment, render

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import datetime

    from contactbench.pipeline.fleet.judge import FleetFindings
    from contactbench.pipeline.fleet.row import Skipped

_MOST_ROWS, _MOST_GROUPS = 100, 6
_NOBODY = "unknown"
_UNNAMED = "serial number missing"


def fleet_html(table: Any, findings: FleetFindings, skipped: Sequence[Skipped], created: datetime) -> str:
    """
    Return the page.

    Parameters
    ----------
    table : pyarrow.Table
        Sorted by sensor, tool and time.
    findings : FleetFindings
    skipped : sequence of Skipped
    created : datetime
        With a time zone.
    """
    overdue = sum(each.days < 0 or not each.due for each in findings.due)
    unusual = {each.place for each in findings.outliers}
    drifting = [each for each in findings.trends if each.drifts]
    level, word, meaning = _verdict(overdue, len(unusual), len(findings.due))
    return render(
        __package__,
        title="Fleet",
        created=moment(created),
        tool=f"contactbench {__version__}",
        level=level,
        word=word,
        meaning=meaning,
        tiles=[
            (f"{table.num_rows:,}", "sessions in the table", False),
            (f"{_sensors(table):,}", "sensors with a tool", False),
            (f"{overdue:,}", "are due for recalibration", overdue > 0),
            (f"{len(unusual):,}", "sessions stand out", bool(unusual)),
            (f"{len(drifting):,}", "quantities drift", bool(drifting)),
        ],
        due=findings.due[:_MOST_ROWS],
        outliers=findings.outliers[:_MOST_ROWS],
        trends=sorted(
            findings.trends, key=lambda each: (not each.drifts, each.chance, each.sensor, each.tool)
        )[:_MOST_ROWS],
        skipped=skipped[:_MOST_ROWS],
        more={
            name: max(0, len(found) - _MOST_ROWS)
            for name, found in (
                ("due", findings.due),
                ("outliers", findings.outliers),
                ("trends", findings.trends),
                ("skipped", skipped),
            )
        },
        groups=_groups(table, findings),
        nobody=_NOBODY,
        unnamed=_UNNAMED,
    )


def _verdict(overdue: int, unusual: int, due: int) -> tuple[str, str, str]:
    if overdue:
        return "refuse", "Recalibrate", "Calibrations are due: the first table says which."
    if unusual:
        return "usable", "Look", "Sessions stand out: the second table says why."
    if due:
        return "usable", "Soon due", "Calibrations will be due soon."
    return "good", "In order", "Nothing is due, and no session stands out."


def _names(table: Any) -> list[tuple[str, str]]:
    return list(zip(table["sensor"].to_pylist(), table["tool"].to_pylist(), strict=True))


def _sensors(table: Any) -> int:
    """Count sensors with a tool; without a serial number, each session is one."""
    names = _names(table)
    return len({name for name in names if name[0]}) + sum(not name[0] for name in names)


def _groups(table: Any, findings: FleetFindings) -> list[dict[str, str]]:
    """Return the pictures: first of groups with something unusual, then of those with many sessions."""
    import pyarrow.compute as pc

    from contactbench.pipeline.fleet.figures import draw_group

    table = table.filter(pc.is_valid(table["calibrated"]))
    unusual = {each.place for each in findings.outliers}
    notable = {(each.sensor, each.tool) for each in findings.outliers}
    notable |= {(each.sensor, each.tool) for each in findings.trends if each.drifts}
    rows: dict[tuple[str, str], list[int]] = {}
    for row, name in enumerate(_names(table)):
        rows.setdefault(name, []).append(row)
    shown = sorted(
        (name for name in rows if name[0] and len(rows[name]) > 1),
        key=lambda n: (n not in notable, -len(rows[n]), n),
    )
    found = []
    for number, name in enumerate(shown[:_MOST_GROUPS]):
        part = table.take(rows[name])
        marked = [place in unusual for place in part["place"].to_pylist()]
        found.append(
            {
                "sensor": name[0],
                "tool": name[1] or _NOBODY,
                "sessions": f"{part.num_rows:,}",
                "svg": draw_group(part, marked, f"g{number}-"),
            }
        )
    return found
