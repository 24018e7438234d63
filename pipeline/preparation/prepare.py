"""All steps in one go: from the file to a probe that a sensor can be used with."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.mesh.shell import Closing
from contactbench.pipeline.mesh.soundness import check_soundness
from contactbench.pipeline.preparation.steps import (
    align_step,
    import_mesh,
    refuse_aligned,
    shell_step,
    simplify_step,
)

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from contactbench.pipeline.mesh.regions import RegionReport
    from contactbench.pipeline.mesh.shell import Shell
    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.mesh.simplify import Engine, Simplified, Target
    from contactbench.pipeline.mesh.soundness import Soundness
    from contactbench.pipeline.mesh.units import Units
    from contactbench.pipeline.preparation.alignment import Alignment

    Chosen = tuple[Target, Mapping[str, Any] | None]

# Shares of the work: reading, wrapping, simplifying.
_READ, _WRAPPED = 0.02, 0.7


@dataclass(frozen=True, eq=False)
class Dense:
    """A mesh file's outer surface, before it is aligned and has fewer facets."""

    content: ProbeFile  # as it lies in the mesh's own frame
    shell: Shell  # what was done


@dataclass(frozen=True, eq=False)
class Preparation:
    """A prepared probe, and what was done."""

    content: ProbeFile  # the probe, its regions and its history: for `save_probe_file`
    shell: Shell
    simplified: Simplified
    soundness: Soundness  # of the result, compared with the shell, as if it came from a stranger
    carried: tuple[RegionReport, ...] = ()  # what simplification did to the area of each region

    @property
    def ready(self) -> bool:
        """Whether the shell and the result are closed, 2-manifold and outward, and cross and fold nowhere."""
        return not self.faults

    @property
    def faults(self) -> tuple[str, ...]:
        """What makes the result unfit, in words."""
        return (
            *self.shell.faults,
            *(fault for fault in self.soundness.faults if fault not in self.shell.faults),
        )

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was done and what to know about it, in words."""
        frame = (
            ()
            if self.content.frame == "S"
            else ("The mesh is in its own frame: align it with the sensor before it is used.",)
        )
        wrong = () if self.ready else ("NOT READY: " + " ".join(self.faults),)
        short = self.simplified.sentences[:1] if self.simplified.short else ()
        said = (
            *wrong,
            *short,
            *self.content.notes,
            *(sentence for sentence in self.shell.sentences if sentence not in self.faults),
            *self.simplified.sentences,
            *(report.sentence for report in self.carried),
            *frame,
        )
        return tuple(dict.fromkeys(said))

    def to_json(self) -> dict[str, Any]:
        """Give the whole history and the sentences as plain values."""
        return {
            "frame": self.content.frame,
            "facets": len(self.content.probe.faces),
            "soundness": self.soundness.to_json(),
            "history": [dict(step) for step in self.content.history],
            "sentences": list(self.sentences),
        }


def make_dense(
    path: str | os.PathLike[str],
    units: Units | Literal["auto"] = "auto",
    closings: Closing | Sequence[Closing] = Closing.AUTO,
    *,
    alpha: float | None = None,
    gap: float | None = None,
    aligned_later: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Dense:
    """
    Read a mesh file and close it: the steps that take long, and do not depend on the others.

    Parameters
    ----------
    path, units, closings, alpha, gap, progress, cancelled
        See `prepare`.
    aligned_later : bool
        Refuse a mesh that is aligned already before the work is done.

    Raises
    ------
    MeshError, AlignmentError, EngineError, Cancelled
        See the steps.
    """
    content = import_mesh(path, units)
    if aligned_later:
        refuse_aligned(content, again=False)
    notes = tuple(note for note in content.notes if note not in content.probe.health.sentences)
    if progress is not None:
        progress(_READ)
    content, shell = shell_step(
        content, closings, alpha=alpha, gap=gap, progress=_part(progress, _READ, 1.0), cancelled=cancelled
    )
    # What was wrong with the file is mended by now, and said by the shell; how its unit was found is not.
    return Dense(replace(content, notes=notes), shell)


def place(
    dense: Dense, alignment: Alignment | None, painted: Callable[[ProbeFile], ProbeFile] | None = None
) -> ProbeFile:
    """
    Move the outer surface into the sensor frame, and put regions on it.

    Parameters
    ----------
    dense : Dense
    alignment : Alignment or None
        None: it stays in its own frame.
    painted : callable, optional
        Takes the aligned shell and gives it with its regions; see `contactbench.pipeline.preparation.painted`.
    """
    content = dense.content if alignment is None else align_step(dense.content, alignment)
    return content if painted is None else painted(content)


def prepare(
    path: str | os.PathLike[str],
    units: Units | Literal["auto"] = "auto",
    closings: Closing | Sequence[Closing] = Closing.AUTO,
    *,
    alpha: float | None = None,
    gap: float | None = None,
    alignment: Alignment | None = None,
    target: Callable[[ProbeFile], Chosen],
    engine: Engine = "auto",
    region_ratio: float = 1.0,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Preparation:
    """
    Read a mesh file, close it, align it, and give it as few facets as the target allows.

    Parameters
    ----------
    path : str or path
    units : {"auto", "mm", "m", "cm", "in"}
    closings : Closing or sequence of Closing
        See `make_shell`.
    alpha, gap : float, optional
        Metres; see `make_shell`.
    alignment : Alignment, optional
        Left out, the mesh stays in its own frame P.
    target : callable
        Takes the aligned shell and gives the target, and how to write it down; see `simplify_step`.
    engine, region_ratio
        See `simplify`.
    progress, cancelled : callable, optional
        As everywhere: the share that is done, and whether to stop.

    Returns
    -------
    Preparation

    Raises
    ------
    MeshError, AlignmentError, EngineError, Cancelled
        See the steps.
    """
    dense = make_dense(
        path,
        units,
        closings,
        alpha=alpha,
        gap=gap,
        aligned_later=alignment is not None,
        progress=_part(progress, 0.0, _WRAPPED),
        cancelled=cancelled,
    )
    return finish(
        dense,
        place(dense, alignment),
        target,
        engine=engine,
        region_ratio=region_ratio,
        progress=_part(progress, _WRAPPED, 1.0),
        cancelled=cancelled,
    )


def finish(
    dense: Dense,
    placed: ProbeFile,
    target: Callable[[ProbeFile], Chosen],
    *,
    engine: Engine = "auto",
    region_ratio: float = 1.0,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Preparation:
    """
    Give the outer surface as few facets as the target allows: the last step of `prepare`.

    Parameters
    ----------
    dense : Dense
    placed : ProbeFile
        What `place` made of it.
    target, engine, region_ratio, progress, cancelled
        See `prepare`.
    """
    if cancelled is not None and cancelled():
        raise Cancelled("the preparation was cancelled: nothing was written.")
    wanted, stated = target(placed)
    content, simplified, carried = simplify_step(
        placed,
        wanted,
        stated=stated,
        engine=engine,
        region_ratio=region_ratio,
        progress=progress,
        cancelled=cancelled,
    )
    made, whole = content.probe, placed.probe
    soundness = simplified.soundness or check_soundness(
        made.vertices, made.faces, (whole.vertices, whole.faces), invented=made.invented
    )
    return Preparation(content, dense.shell, simplified, soundness, carried)


def _part(
    progress: Callable[[float], None] | None, low: float, high: float
) -> Callable[[float], None] | None:
    """Return what takes the progress of a part of the work."""
    if progress is None:
        return None
    return lambda share: progress(low + share * (high - low))
