"""From a mesh file to a probe that a sensor can be used with: all steps in one go."""

import hashlib
import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal

import numpy as np

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File, as_file, files_beside
from contactbench.pipeline.mesh import MeshWarning, Probe
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.mesh.engines import NOBODY, Monitor
from contactbench.pipeline.mesh.load import Units, probe_of, read_mesh
from contactbench.pipeline.mesh.parse import Reading
from contactbench.pipeline.mesh.regions.exchange import (
    decode_json,
    load_regions,
    mesh_hash,
    parse_json,
    read_limited,
)
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet
from contactbench.pipeline.mesh.regions.transfer import RegionReport, compare, transfer
from contactbench.pipeline.mesh.shell import Closing, Shell, make_shell
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file, sidecar_of
from contactbench.pipeline.mesh.simplify import (
    Count,
    MaxDeviation,
    MaxError,
    Simplified,
    Target,
    check_ratio,
    simplify,
)
from contactbench.pipeline.mesh.soundness import Soundness, check_soundness
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentError,
    apply,
    from_angles,
    load_alignment,
)
from contactbench.pipeline.preparation.cache import encode, made_once
from contactbench.pipeline.preparation.ladder.compare import ContactReference, ExpectedTouches, Statistic
from contactbench.pipeline.preparation.ladder.ladder import Goal
from contactbench.pipeline.settings import (
    PlaceSettings,
    ProbeSettings,
    ShellSettings,
    SimplifySettings,
    metres,
)
from contactbench.pipeline.shown import Shown

# Vertices that are the same but for the rounding of an alignment there and back, m.
_SAME_M = 1e-9
# A target, and how it is written into a probe's history where that is not plain to see.
Chosen = tuple[Target, dict[str, Any] | None]

# Shares of the work: reading, of what the outer surface takes; the outer surface, of all.
_READ, _DENSE = 0.02, 0.7


@dataclass(frozen=True, eq=False)
class Dense:
    """A mesh file's outer surface, before it is aligned and has fewer facets."""

    content: ProbeFile  # as it lies in the mesh's own frame
    shell: Shell  # what was done


@dataclass(frozen=True, eq=False, repr=False)
class Preparation(Shown):
    """A prepared probe, and what was done."""

    content: ProbeFile  # the probe, its regions and its history: for `save_probe_file`
    shell: Shell
    simplified: Simplified
    soundness: Soundness  # of the result, compared with the shell, as if it came from a stranger
    carried: tuple[RegionReport, ...] = ()  # what simplification did to the area of each region

    def facts(self) -> dict[str, str]:
        """As `Shown.facts`."""
        first = {"ready": "yes" if self.ready else "no", "facets": f"{len(self.content.probe.faces):,}"}
        return first | {str(number): sentence for number, sentence in enumerate(self.sentences[:6], 1)}

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
        said = [] if self.ready else [message("NOT READY: ") + " ".join(self.faults)]
        said += self.simplified.sentences[:1] if self.simplified.short else ()
        said += self.content.notes
        said += (sentence for sentence in self.shell.sentences if sentence not in self.faults)
        said += self.simplified.sentences
        said += (report.sentence for report in self.carried)
        said += self.content.region_warnings
        if self.content.frame != "S":
            said.append(message("The mesh is in its own frame: align it with the sensor before use."))
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


def prepared(
    inputs: Mapping[str, File], given: ProbeSettings, *, monitor: Monitor = NOBODY, remember: bool = False
) -> Preparation:
    """
    Read a mesh file, close it, align it, and give it as few facets as the target allows.

    Parameters
    ----------
    inputs : mapping of role to path
        ``mesh``; ``alignment``, if it is not the mount of the settings: what ``contactbench probe align --save``
        wrote; ``regions``, painted on the aligned outer surface: see `put_on`.
    given : ProbeSettings
    monitor : Monitor
    remember : bool
        See `dense_of`.

    Raises
    ------
    InputError
        The settings contradict each other or the inputs, or a step cannot be done.
    Cancelled
        The caller cancelled.
    """
    if given.mount is not None and "alignment" in inputs:
        raise InputError("the mount in the settings and the alignment contradict each other: give only one.")
    target, alignment = target_of(given), alignment_of(given, inputs.get("alignment"))
    dense = dense_of(
        inputs["mesh"],
        given,
        aligned_later=alignment is not None,
        remember=remember,
        monitor=monitor.part(0.0, _DENSE),
    )
    painted = inputs.get("regions")
    placed = place(dense, alignment, None if painted is None else partial(put_on, file=painted))
    monitor.check()
    wanted, stated = target(placed.probe)

    def fewer() -> tuple[ProbeFile, Simplified, tuple[RegionReport, ...]]:
        return simplify_step(
            placed, wanted, stated=stated, region_ratio=given.region_ratio, monitor=monitor.part(_DENSE, 1.0)
        )

    kinds = (ProbeFile, Simplified, tuple[RegionReport, ...])
    content, simplified, carried = (
        made_once(lambda: _said_of(placed, given), fewer, kinds) if remember else fewer()
    )
    monitor.tell(1.0)
    made, whole = content.probe, placed.probe
    soundness = simplified.soundness or check_soundness(
        made.vertices, made.faces, (whole.vertices, whole.faces), invented=made.invented
    )
    return Preparation(content, dense.shell, simplified, soundness, carried)


def alignment_of(given: PlaceSettings, file: File | None) -> Alignment | None:
    """Return where a mesh is put: as the file says, or else the mount; None: it stays in its own frame."""
    if file is not None:
        return load_alignment(file)
    return None if given.mount is None else from_angles(list(given.mount[:3]), list(given.mount[3:]))


def place(
    dense: Dense, alignment: Alignment | None, painted: Callable[[ProbeFile], ProbeFile] | None = None
) -> ProbeFile:
    """Move the outer surface into the sensor frame, if there is an alignment, and let `painted` put regions on it."""
    content = dense.content if alignment is None else align_step(dense.content, alignment)
    return content if painted is None else painted(content)


# ---- the outer surface --------------------------------------------------------------------------


def dense_of(
    mesh: File,
    given: ShellSettings,
    *,
    aligned_later: bool = False,
    remember: bool = False,
    monitor: Monitor = NOBODY,
) -> Dense:
    """
    Make the outer surface of a mesh file: most of the time that a probe takes.

    Parameters
    ----------
    mesh : path
        With its JSON file beside it, if it is contactbench's.
    given : ShellSettings
    aligned_later : bool
        Refuse a mesh that is aligned already.
    remember : bool
        Whether one that was made before from the same bytes, name and settings will do, also by another process, see
        `made_once`. Who checks results makes all of them anew.
    monitor : Monitor
    """

    def make() -> tuple[ProbeFile, Shell]:
        return _closed(mesh, given, monitor, aligned_later=aligned_later)

    kinds = (ProbeFile, Shell)
    made = Dense(*(made_once(lambda: _key(mesh, given), make, kinds, held=True) if remember else make()))
    if aligned_later:  # found, or made for a mesh that stays where it is
        refuse_aligned(made.content, again=False)
    return made


def _closed(
    mesh: File, given: ShellSettings, monitor: Monitor, *, aligned_later: bool
) -> tuple[ProbeFile, Shell]:
    """Read a mesh file and make its outer surface."""
    content = import_mesh(mesh, given.units, given.tolerance / 1000, monitor.part(0.0, _READ))
    if aligned_later:
        refuse_aligned(content, again=False)
    # What is wrong with the file is mended below, and said by the shell; how its unit was found is not.
    notes = tuple(note for note in content.notes if note not in content.probe.health.sentences)
    monitor.tell(_READ)
    content, shell = shell_step(
        content,
        given.close,
        alpha=metres(given.alpha),
        gap=metres(given.gap),
        monitor=monitor.part(_READ, 1.0),
    )
    return replace(content, notes=notes), shell


def _key(mesh: File, given: ShellSettings) -> tuple[object, ...]:
    # Only a regular file has a hash; of others the reader says what is wrong.
    files = (each for each in (mesh, sidecar_of(mesh)) if each.is_file())
    hashes = tuple(hashlib.sha256(each.read_bytes()).hexdigest() for each in files)
    return ("dense", mesh.name, hashes, *(getattr(given, each) for each in ShellSettings.model_fields))


def _said_of(placed: ProbeFile, given: ProbeSettings) -> tuple[object, ...]:
    """Return what decides the probe with fewer facets: the outer surface in its place, and the settings."""
    return ("simplified", hashlib.sha256(encode("", (placed,))).hexdigest(), given.model_dump(mode="json"))


# ---- the steps from a mesh file to a probe, each written down in its history ---------------------


def import_mesh(
    path: str | os.PathLike[str],
    units: Units | Literal["auto"] = "auto",
    tolerance: float = Reading.tolerance,
    monitor: Monitor = NOBODY,
) -> ProbeFile:
    """
    Read a mesh file of any kind; one that contactbench wrote brings its regions and its history.

    Parameters
    ----------
    path : str or path
    units : {"auto", "mm", "m", "cm", "in"}
        See `load_probe`. Not asked for a file that contactbench wrote: it is in metres.
    tolerance, monitor
        See `read_mesh`.

    Returns
    -------
    ProbeFile
        Its notes say how the unit was found, where that is not certain, and what is wrong with the mesh.

    Raises
    ------
    MeshError
        See `load_probe`.
    """
    file = as_file(path)
    read = read_mesh(file, units, tolerance=tolerance, monitor=monitor)
    if read.raw.settled:
        known = load_probe_file(file)
        if known.history:
            return known
        # Saved by hand, or its JSON file was lost: in metres all the same.
        return replace(known, history=(_origin(file, known, {"units": "m"}, ""),))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        probe = probe_of(file, read)
    notes = (*read.notes, *read.raw.axes, *probe.health.sentences)
    found = ProbeFile(probe, RegionSet.from_labels(probe.region), notes=notes)
    reason = "" if read.guess is None else read.guess.reason
    told = {"units": read.units} | ({"tolerance_mm": 1e3 * tolerance} if read.suffix == ".step" else {})
    return replace(found, history=(_origin(file, found, told, reason),))


def shell_step(
    content: ProbeFile,
    closings: str | Sequence[str],
    *,
    alpha: float | None = None,
    gap: float | None = None,
    monitor: Monitor = NOBODY,
) -> tuple[ProbeFile, Shell]:
    """Make the outer shell; lengths in metres; see `make_shell` for the rest and for what it raises."""
    shell = make_shell(content.probe, closings, alpha=alpha, coarse=gap, monitor=monitor)
    asked = [closings] if isinstance(closings, str) else closings
    parameters = {
        "closings": [Closing(each).value for each in asked] or [Closing.AUTO.value],
        "alpha_mm": None if alpha is None else 1e3 * alpha,
        "gap_mm": None if gap is None else 1e3 * gap,
    }
    return content.after("shell", shell.probe, parameters, shell.to_json()), shell


def align_step(content: ProbeFile, alignment: Alignment, *, again: bool = False) -> ProbeFile:
    """
    Move the probe from the mesh's frame P to the sensor frame S.

    Parameters
    ----------
    content : ProbeFile
    alignment : Alignment
    again : bool
        Move a probe that is in S already: then the alignment is a correction within S.

    Raises
    ------
    AlignmentError
        The probe is in S already, and `again` was not said.
    MeshError
        See `Alignment.place`.
    """
    refuse_aligned(content, again=again)
    parameters: dict[str, Any] = {"method": alignment.method.value, "T_SP_m": alignment.T_SP.tolist()}
    result = {
        "sigmas_mm": None if alignment.sigmas_mm is None else alignment.sigmas_mm.tolist(),
        "sigmas_deg": None if alignment.sigmas_deg is None else alignment.sigmas_deg.tolist(),
        "residual_mm": None if alignment.residual_m is None else 1e3 * alignment.residual_m,
        "warnings": list(alignment.warnings),
    }
    return content.after("align", alignment.place(content.probe), parameters, result, frame="S")


def refuse_aligned(content: ProbeFile, *, again: bool) -> None:
    """
    Refuse to align what is aligned.

    Raises
    ------
    AlignmentError
    """
    if content.frame == "S" and not again:
        raise AlignmentError(
            "the probe is already in the sensor frame and would be moved twice. Start from the"
            " mesh before alignment, or mark this as a correction (again)."
        )


def simplify_step(
    content: ProbeFile,
    target: Target,
    *,
    stated: Mapping[str, Any] | None = None,
    region_ratio: float = 1.0,
    monitor: Monitor = NOBODY,
) -> tuple[ProbeFile, Simplified, tuple[RegionReport, ...]]:
    """
    Give the probe fewer facets.

    Parameters
    ----------
    content : ProbeFile
    target : Target
    stated : mapping, optional
        How to write the target down; left out for a `Count` or a `MaxDeviation`.
    region_ratio, monitor
        See `simplify`, also for what it raises.

    Returns
    -------
    ProbeFile
    Simplified
    tuple of RegionReport
        What became of the area of each region.
    """
    done = simplify(content.probe, target, region_ratio=region_ratio, monitor=monitor)
    parameters = {
        **(_target(target) if stated is None else stated),
        "engine": "auto",
        "region_ratio": region_ratio,
    }
    carried = compare(content.regions, content.probe, done.probe)
    result = {
        "facets": done.count,
        "engine": done.engine,
        "deviation": done.deviation.to_json(),
        "regions": {str(rank): part.to_json() for rank, part in done.regions.items()},
        "carried": [report.to_json() for report in carried],
        "steps": list(done.steps),
    }
    regions = RegionSet(content.regions.regions, done.probe.region)
    return content.after("simplify", done.probe, parameters, result, regions=regions), done, carried


def _target(target: Target) -> dict[str, Any]:
    if isinstance(target, Count):
        return {"facets": target.facets}
    if isinstance(target, MaxDeviation):
        return {"max_deviation_mm": 1e3 * target.metres}
    return {"max_error": target.limit}


def _origin(file: File, content: ProbeFile, told: dict[str, Any], reason: str) -> dict[str, Any]:
    """Write down where the history begins: the file, by its content."""
    size = np.ptp(content.probe.bounds, axis=0)
    step = content.after(
        "import",
        content.probe,
        {
            "file": file.name,
            "sha256": hashlib.sha256(file.read_bytes()).hexdigest(),
            **told,
            "beside": sidecar_of(file).exists(),
        },
        {"why_units": reason, "size_mm": [round(1e3 * float(x), 6) for x in size]},
    ).history[-1]
    return dict(step)


# ---- how many facets to keep: a number, within a deviation, or where contacts are found ----------


# A tenth of a millimetre: a fifth or less of what noise does to a touch of 10 N, so that nobody will see it.
DEFAULT_LIMIT = 1e-4
# Times the limit: the surface itself may not move further anywhere, or letters and ribs that hold less than a twentieth
# of the touches would vanish.
_FARTHEST = 3.0
# A contact takes about as long on fewer facets, but thin and engraved parts would lose their shape.
_ENOUGH = 2_000


def target_of(given: SimplifySettings) -> Callable[[Probe], Chosen]:
    """
    Return what gives the target for a full mesh; what makes no sense is refused here, before the work.

    Raises
    ------
    InputError
        More than one target was given, or a number is out of its range.
    """
    if sum(each is not None for each in (given.facets, given.max_deviation, given.max_contact_error)) > 1:
        raise InputError("--facets, --max-deviation and --max-contact-error: give only one of them.")
    check_ratio(given.region_ratio)
    if given.facets is not None:
        count = Count(given.facets)
        return lambda _: (count, None)
    if given.max_deviation is not None:
        deviation = MaxDeviation(given.max_deviation / 1000)
        return lambda _: (deviation, None)
    limit, expected = metres(given.max_contact_error), ExpectedTouches(force=given.forces)
    limit = DEFAULT_LIMIT if limit is None else limit
    Goal(limit)  # refuses what is no limit
    return lambda probe: contact_target(probe, limit, expected)


def contact_target(
    probe: Probe, limit: float = DEFAULT_LIMIT, expected: ExpectedTouches | None = None
) -> tuple[MaxError, dict[str, Any]]:
    """
    Return the target of the fewest facets that hardly move a contact, and how it is written into a probe's history.

    Parameters
    ----------
    probe : Probe
        The full mesh.
    limit : float
        How far 95 % of the contacts may move, m.
    expected : ExpectedTouches, optional
        Noise, forces and friction to expect.

    Raises
    ------
    LadderError
        The mesh settles too few touches.
    """
    expected = expected or ExpectedTouches()
    stated = {
        "max_contact_error_mm": round(1e3 * limit, 6),
        "statistic": "p95",
        "forces_N": list(expected.force),
        "touches": expected.count,
    }
    measure = contact_error_criterion(probe, expected)
    return MaxError(measure, limit, farthest=_FARTHEST * limit, enough=_ENOUGH), stated


def contact_error_criterion(
    full: Probe,
    expected: ExpectedTouches | None = None,
    statistic: Statistic = "p95",
    *,
    failed: float = Goal.failed,
) -> Callable[[Probe], float]:
    """
    Make the measure for `MaxError`: how far a simplified mesh moves the contacts.

    Parameters
    ----------
    full : Probe
        The full mesh.
    expected : ExpectedTouches, optional
        The noise, forces and friction that it will feel.
    statistic : {"mean", "p95", "max"}
        Of the distances between the answers on the two meshes.
    failed : float
        Share of the touches settled on the full mesh that may be lost, doubtful or jump.

    Returns
    -------
    callable
        Takes a simplified mesh and returns its added contact error on the priority regions, or on the whole probe
        when there are none, m; infinite when more touches fail.

    Raises
    ------
    LadderError
        The full mesh settles too few touches.
    """
    reference = ContactReference(full, expected or ExpectedTouches())

    def measure(probe: Probe) -> float:
        noisy = reference.compare(probe)[0].noisy
        value = noisy.statistic(statistic)
        return math.inf if value is None or noisy.failed_share > failed else value

    return measure


def put_on(content: ProbeFile, file: File) -> ProbeFile:
    """
    Give an aligned shell the regions of a file.

    Parameters
    ----------
    content : ProbeFile
        The shell, aligned or not.
    file : path
        Regions as ``contactbench probe regions export`` writes them, JSON or CSV. Regions of another surface are
        carried over if that one lies in a PLY file beside it.

    Returns
    -------
    ProbeFile
        Its history says what became of them.

    Raises
    ------
    RegionError
        The file is no such file, or for a surface that is not there; or nothing of the regions lies on this one.
    """
    regions, carried = painted_regions(content, file)
    probe = regions.mesh(content.probe)
    result = {
        "facets": int(np.count_nonzero(regions.labels)),
        "areas_mm2": (1e6 * regions.areas(probe.areas)).round(3).tolist(),
        "carried": [report.to_json() for report in carried],
    }
    parameters = {"command": "painted", "file": file.name}
    return content.after("region", probe, parameters, result, regions=replace(regions, cut=None))


def painted_regions(content: ProbeFile, file: File) -> tuple[RegionSet, tuple[RegionReport, ...]]:
    """Return the regions of a file on a shell, and what carrying them over did to each; see `put_on`."""
    if file.suffix.lower() == ".csv":
        return load_regions(file, content.probe), ()
    try:
        return decode_json(read_limited(file), content.probe), ()
    except RegionError as error:
        surface = _surface_beside(file)
        if surface is None:
            raise RegionError(
                f"{arg(file)}: {arg(error)} Or give the mesh that they were painted on as a companion of the file."
            ) from error
    return _carried(decode_json(read_limited(file), surface.probe), surface, content, file)


def _surface_beside(file: File) -> ProbeFile | None:
    """Return the surface that the regions of a file are for, if a PLY file beside it holds it."""
    mesh = parse_json(read_limited(file)).get("mesh")
    wanted = mesh.get("sha256") if isinstance(mesh, dict) else None
    for other in files_beside(file, ".ply"):
        found = load_probe_file(other)
        if mesh_hash(found.probe) == wanted:
            return found
    return None


def _carried(
    regions: RegionSet, old: ProbeFile, new: ProbeFile, file: File
) -> tuple[RegionSet, tuple[RegionReport, ...]]:
    T: Floats = np.eye(4)
    if _painted_on(old.history) == _painted_on(new.history):
        # The same mesh: what was painted is a place on it, wherever it lies in S by now.
        T = _placed(new) @ np.linalg.inv(_placed(old))
    before, after = apply(T, old.probe.vertices), new.probe.vertices
    if np.array_equal(old.probe.faces, new.probe.faces) and np.allclose(before, after, rtol=0, atol=_SAME_M):
        cut = regions.cut
        return replace(regions, cut=cut and replace(cut, points=apply(T, cut.points))), ()
    painted = regions.mesh(old.probe)
    there = painted.cut((apply(T, painted.vertices), painted.faces), np.arange(len(painted.faces)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # what vanished is told by its report
        moved = transfer(regions, there, new.probe)
    if regions.labels.any() and not moved.regions.labels.any():
        raise RegionError(
            f"{arg(file)}: none of the regions lies on this surface: they were painted on another mesh,"
            " or in another place. Paint them again, or leave them out."
        )
    return moved.regions, moved.report


def _painted_on(history: Sequence[Mapping[str, Any]]) -> object:
    """Return what says which file the history begins with; never equal for an unknown one."""
    first = history[0] if history else {}
    return first.get("parameters", {}).get("sha256") or object()


def _placed(content: ProbeFile) -> Floats:
    """Return T_SP, (4, 4): every alignment of its history."""
    T: Floats = np.eye(4)
    for step in content.history:
        if step["step"] == "align":
            T = np.array(step["parameters"]["T_SP_m"]) @ T
    return T
