"""``contactbench probe markers ...``: points on a probe to be touched."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.commands.options import ProbeOption, refuse_overwriting
from contactbench.pipeline.console import Noun, answer, say

markers_app = Noun("Make markers for a probe, and move them onto its surface.")


MarkersOut = Annotated[Path, typer.Option(help="Table to write: name,x_mm,y_mm,z_mm, sensor frame.")]


@markers_app.command(example="probe markers generate probe.ply --all --count 17 --out markers.csv")
def generate(
    probe: Path,
    /,
    out: MarkersOut,
    region: int | None = None,
    all_: bool = False,
    count: int = 17,
    grid: float | None = None,
) -> None:
    """Place markers on a probe, spread evenly or on a grid; every call gives the same ones.

    Parameters
    ----------
    probe
        The probe, aligned with the sensor.
    region
        Only on the region with this rank.
    all_
        Anywhere on the probe.
    count
        Number of markers, spread evenly.
    grid
        Instead: markers on a grid of this pitch, mm.
    """
    if (region is None) != all_:
        raise typer.BadParameter("give either --region N or --all.")
    refuse_overwriting(out, [probe])
    from contactbench.pipeline.verification import grid_markers, spread_markers
    from contactbench.pipeline.verification.result import load_surface

    surface = load_surface(probe)
    made = (
        spread_markers(surface, count, region) if grid is None else grid_markers(surface, grid / 1e3, region)
    )
    made.save(out)
    say(f"{len(made)} markers written to {out}.", "green")
    answer({"markers": len(made), "file": str(out)})


@markers_app.command(example="probe markers snap measured.csv --probe probe.ply --out markers.csv")
def snap(markers: Path, /, probe: ProbeOption, out: MarkersOut, limit: float = 5.0) -> None:
    """Move markers to the nearest points of a probe's surface, and print how far each moved.

    Parameters
    ----------
    markers
        CSV file: name,x_mm,y_mm,z_mm.
    limit
        Refuse markers farther from the surface, mm.
    """
    refuse_overwriting(out, [markers, probe])
    from contactbench.pipeline.verification import load_markers
    from contactbench.pipeline.verification import snap as snapped
    from contactbench.pipeline.verification.result import load_surface

    found = snapped(load_markers(markers), load_surface(probe), limit / 1e3)
    found.markers.save(out)
    moved = dict(zip(found.markers.names, (1e3 * found.distances).tolist(), strict=True))
    for name, distance in moved.items():
        say(f"{name}: moved by {distance:.3f} mm")
    answer({"markers": len(moved), "file": str(out), "moved_mm": moved})
