"""What the ``region`` commands share: their arguments, loading, saving, and saying what became of the regions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from contactbench.pipeline.commands.options import numbers
from contactbench.pipeline.console import print_json, running_command, say

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.regions import FacetGraph, RegionModel
    from contactbench.pipeline.mesh.regions.undo_file import KeptSteps

MeshArgument = Annotated[
    Path, typer.Argument(metavar="MESH", help="Probe, .ply in metres in S; names are in the .json beside it.")
]
RegionArgument = Annotated[str, typer.Argument(metavar="REGION", help="Name of a region, or its priority.")]


class Session:
    """
    The regions of one probe on disk, while a command edits them.

    Attributes
    ----------
    mesh : Path
    probe : Probe
    model : RegionModel
    """

    def __init__(self, mesh: Path) -> None:
        from contactbench.pipeline.mesh.regions import RegionModel
        from contactbench.pipeline.mesh.sidecar import load_probe_file

        self.mesh = mesh
        self._content = load_probe_file(mesh)
        for note in self._content.notes:
            say(f"warning: {note}", "yellow")
        self.probe = self._content.probe
        self.model: RegionModel = RegionModel(self._content.regions)
        self._graph: FacetGraph | None = None

    @property
    def graph(self) -> FacetGraph:
        """The probe's facets and their neighbours."""
        from contactbench.pipeline.mesh.regions import FacetGraph

        if self._graph is None:
            self._graph = FacetGraph(self.probe)
        return self._graph

    def rank(self, region: str) -> int:
        """Return the rank of a region given by name or, where none has that name, by rank; InputError if neither."""
        names = [known.name for known in self.model.regions]
        if (
            region not in names
            and region.isascii()
            and region.isdigit()
            and 0 < int(region[:9]) <= len(names)
        ):
            return int(region[:9])
        return self.model.rank_of(region)

    def name(self, rank: int) -> str:
        """Return the name of the region of a rank."""
        return self.model.regions[rank - 1].name

    def mask(self, rank: int) -> NDArray[np.bool_]:
        """Return the facets of one rank, (m,)."""
        mask: NDArray[np.bool_] = self.model.labels == rank
        return mask

    def finish(self, changed: int | None, as_json: bool, **facts: Any) -> None:
        """Save, and say how many facets changed and what there is now."""
        self.save({} if changed is None else {"changed": changed})
        if changed is not None:
            say(f"{changed:,} of {len(self.probe.faces):,} facets changed.")
            facts = {"changed": changed, **facts}
        show(self.mesh, self.probe, self.model, as_json, **facts)

    def finish_selection(self, changed: int, why_not: str, as_json: bool, **facts: Any) -> None:
        """Finish what had facets chosen; where none changed, that is wrong: say why, write nothing, exit code 1."""
        if changed:
            return self.finish(changed, as_json, **facts)
        say(f"Nothing changed: {why_not}.", "yellow")
        show(self.mesh, self.probe, self.model, as_json, changed=0, **facts)
        raise typer.Exit(1)

    def save(self, result: dict[str, Any]) -> None:
        """Write the probe with the model's regions, and the command that made them into its history, if it did."""
        from contactbench.pipeline.mesh.regions.undo_file import KeptStep
        from contactbench.pipeline.mesh.sidecar import save_probe_file

        text = self.model.undo_text
        if text is None:
            say("The regions are like that already: nothing was written.")
            return
        regions = self.model.snapshot()
        areas = (1e6 * regions.areas(self.probe.areas)).round(3).tolist()
        content = self._content.after(
            "region",
            self.probe.with_region(regions.labels),
            _command(),
            {**result, "areas_mm2": areas},
            regions=regions,
        )
        steps = self._steps()  # before anything is written: it may refuse
        save_probe_file(content, self.mesh)
        steps.done.append(KeptStep.of(text, content.history[-1], self._content.regions, self.probe))
        steps.undone.clear()
        self._keep(steps)

    def turn(self, way: Literal["undo", "redo"], as_json: bool) -> None:
        """Undo or redo a step, with what it left in the history, and say which; exit code 1: there is none."""
        from contactbench.pipeline.mesh.regions.undo_file import KeptStep
        from contactbench.pipeline.mesh.sidecar import save_probe_file

        steps, history = self._steps(), self._content.history
        taken, given = (steps.done, steps.undone) if way == "undo" else (steps.undone, steps.done)
        if not taken:
            why = ": something else has changed the probe since" if steps.changed else ""
            say(f"There is nothing to {way}{why}.", "yellow")
            raise typer.Exit(1)
        step = taken.pop()
        given.append(KeptStep.of(step.text, step.entry, self._content.regions, self.probe))
        regions = step.regions(self.probe)
        changed = int((regions.labels != self.model.labels).sum())
        content = replace(
            self._content,
            probe=self.probe.with_region(regions.labels, regions.untouchable),
            regions=regions,
            history=history[:-1] if way == "undo" else (*history, step.entry),
        )
        save_probe_file(content, self.mesh)
        self._keep(steps)
        self.model.replace_all(regions)
        word = "undone" if way == "undo" else "redone"
        say(f"{word}: {step.text}. {changed:,} of {len(self.probe.faces):,} facets changed.")
        show(self.mesh, self.probe, self.model, as_json, **{word: step.text}, changed=changed)

    def _steps(self) -> KeptSteps:
        from contactbench.pipeline.mesh.regions.undo_file import load_steps
        from contactbench.pipeline.mesh.sidecar import sidecar_of

        return load_steps((self.mesh, sidecar_of(self.mesh)))

    def _keep(self, steps: KeptSteps) -> None:
        from contactbench.pipeline.mesh.regions.undo_file import save_steps
        from contactbench.pipeline.mesh.sidecar import sidecar_of

        save_steps(steps, (self.mesh, sidecar_of(self.mesh)))


def _command() -> dict[str, Any]:
    """Return the command that runs and its parameters, as JSON values; of files the name only."""
    command, parameters = running_command()
    given = {
        name: value.name if isinstance(value, Path) else value
        for name, value in parameters.items()
        if name not in ("mesh", "old", "new", "as_json") and value not in (None, False, [], ())
    }
    return {"command": command, **given}


def show(mesh: Path, probe: Probe, model: RegionModel, as_json: bool, **facts: Any) -> None:
    """Print the regions: as a table for people, or as one JSON object."""
    snapshot = model.snapshot()
    areas = 1e6 * snapshot.areas(probe.areas)
    counts = [len(snapshot.faces_of(rank)) for rank in range(1, len(snapshot.regions) + 1)]
    if as_json:
        rows = [
            {
                "priority": rank,
                "name": region.name,
                "colour": region.colour,
                "untouchable": region.untouchable,
                "facets": count,
                "area_mm2": float(area),
            }
            for rank, (region, count, area) in enumerate(zip(snapshot.regions, counts, areas, strict=True), 1)
        ]
        print_json({"mesh": str(mesh), "facets": len(probe.faces), **facts, "regions": rows})
        return
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None)
    for title, justify in (("", "right"), ("region", "left"), ("colour", "left")):
        table.add_column(title, justify="right" if justify == "right" else "left")
    table.add_column("facets", justify="right")
    table.add_column("mm²", justify="right")
    table.add_column("%", justify="right")
    table.add_column("")
    whole = 1e6 * float(probe.areas.sum())
    for rank, (region, count, area) in enumerate(zip(snapshot.regions, counts, areas, strict=True), 1):
        share = f"{100 * area / whole:.1f}"
        mark = "untouchable" if region.untouchable else ""
        table.add_row(str(rank), region.name, region.colour, f"{count:,}", f"{area:.1f}", share, mark)
    Console(markup=False).print(table)


def metres(text: str, option: str) -> NDArray[np.float64]:
    """Return x,y,z (3,) in metres from millimetres on the command line; typer.BadParameter if it is not that."""
    import numpy as np

    return np.array(numbers(text, 3, option)) / 1000
