"""The work on a probe's mesh: what is chosen, and what comes of it before anything ends in the session.

The probe that is being prepared, in the session at every stage: its mesh, and all that is chosen of it.

A draft changes no result: what is in use stays so until the draft itself is used. It is one setting, so that undoing a
stage is putting back the value before, and the mesh's file is an input of a kind of its own.
"""

import tempfile
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.files import File, NamedFile
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.engines import NOBODY, Monitor
from contactbench.pipeline.mesh.inspect import Inspection, inspect
from contactbench.pipeline.mesh.parse import Reading
from contactbench.pipeline.mesh.sidecar import ProbeFile, encode_probe_file
from contactbench.pipeline.preparation.alignment.alignment import Alignment, from_json
from contactbench.pipeline.preparation.alignment.flange import align_axes, align_flange, find_mounting_face
from contactbench.pipeline.preparation.alignment.points import align_points
from contactbench.pipeline.preparation.alignment.touches.align import align_touches
from contactbench.pipeline.preparation.alignment.touches.fit import read_touches
from contactbench.pipeline.preparation.ladder.compare import ExpectedTouches
from contactbench.pipeline.preparation.ladder.ladder import Ladder
from contactbench.pipeline.preparation.ladder.measure import measure_ladder
from contactbench.pipeline.preparation.prepare import (
    Dense,
    Preparation,
    alignment_of,
    dense_of,
    import_mesh,
    place,
    prepared,
    put_on,
)
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.session.actions import Record
from contactbench.pipeline.session.files import digest_of
from contactbench.pipeline.session.recompute import ProbeParameters, companions_of, inputs_of
from contactbench.pipeline.session.state import MESH, Input
from contactbench.pipeline.session.why import PROBE_DRAFT
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.regions_session import PROBE, PROBE_FILE, REGIONS, recipe_of

_PORTION = 2**20
# Of the time that taking a mesh needs: copying it, and looking at it.
_COPIED = 0.1
_REMEMBERED = 2  # meshes: the one that is prepared, and what an undo goes back to
ALIGNMENT, ALIGNMENT_FILE = "alignment", "alignment.json"


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh file that was taken: the session's own, or a copy, so that nobody changes it under the work."""

    file: NamedFile  # With what belongs to it
    inspection: Inspection
    original: ProbeFile  # As the file has it, m
    sha256: str  # Of the file

    @property
    def companions(self) -> dict[str, Path]:
        """Name -> file beside it."""
        return {name: path for name, path in self.file.beside.items() if name != self.file.name}

    @property
    def outline(self) -> NDArray[np.float64]:
        """(k, 2) convex outline as seen along the shortest extent, m about its middle; the longest comes first."""
        from scipy.spatial import ConvexHull

        probe = self.original.probe
        along = np.argsort(-np.ptp(probe.bounds, axis=0))[:2]
        flat = (probe.vertices - probe.bounds.mean(axis=0))[:, along]
        return np.asarray(flat[ConvexHull(flat, qhull_options="QJ").vertices])

    @property
    def tessellated(self) -> bool:
        """Whether it was made of a STEP file, with a tolerance."""
        history = self.original.history
        return len(history) == 1 and "tolerance_mm" in history[0]["parameters"]

    @property
    def unit_asked(self) -> bool:
        """Whether a person has to say what the numbers are."""
        guess = self.inspection.unit
        return guess is not None and not guess.certain


@dataclass(frozen=True)
class ProbePlan:
    """What is chosen: as the options of ``contactbench probe prepare``, lengths in mm."""

    units: str = "auto"
    tolerance: float = 1e3 * Reading.tolerance  # Of a STEP file
    # How openings are closed, the largest first; empty: only those of an open mesh
    close: tuple[str, ...] = ()
    # alpha, gap: Size of the outer surface's facets, and what counts as a gap; None: by the size of the probe
    alpha: float | None = None
    gap: float | None = None
    alignment: Alignment | None = None  # None: the mesh stays in its own frame
    facets: int | None = None  # facets, max_deviation, max_contact_error: The target: one of them, or none
    max_deviation: float | None = None
    max_contact_error: float | None = None
    engine: str = "auto"
    region_ratio: float = 1.0  # Facets per area in the regions over that outside
    painted: bool = True  # Whether the session's regions go on it

    @property
    def parameters(self) -> dict[str, Any]:
        """What a session's computation is told: everything that is not as usual."""
        usual = ProbePlan()
        told = (each.name for each in fields(self) if each.name not in {"alignment", "painted"})
        return {
            name: list(value) if isinstance(value := getattr(self, name), tuple) else value
            for name in told
            if getattr(self, name) != getattr(usual, name)
        }

    @property
    def given(self) -> ProbeParameters:
        """The same, checked. SessionError: something is not as it should be."""
        return ProbeParameters.checked({**self.parameters, "name": PROBE_FILE})


@dataclass(frozen=True, eq=False)
class ProbePreview:
    """What a plan gives."""

    plan: ProbePlan
    mesh: Mesh
    placed: ProbeFile  # The outer surface with all its facets, where it will be
    done: Preparation  # The probe, and what was done
    regions: str  # Content of the session's regions that are on it; empty: none
    deviation: NDArray[np.float64]  # (n,) float64; Distance of each vertex of `placed` from the probe, m


class ProbeWork:
    """
    The way from a mesh file to a probe. Everything that takes long may be called in any thread, one at a time.

    Parameters
    ----------
    desk : Desk
    """

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self._scratch = tempfile.TemporaryDirectory(prefix="contactbench-")
        self._number = count()
        self._taken: OrderedDict[tuple[str, str, float], Mesh] = OrderedDict()  # what was seen last

    def close(self) -> None:
        """Remove the copies."""
        self._scratch.cleanup()

    def _place(self) -> Path:
        return Path(self._scratch.name) / str(next(self._number))

    # ---- the mesh --------------------------------------------------------------------------------

    def take(
        self,
        file: File,
        units: str = "auto",
        monitor: Monitor = NOBODY,
        *,
        tolerance: float = ProbePlan.tolerance,
    ) -> Mesh:
        """
        Find out all about a mesh file; as ``contactbench probe inspect``. One that is not the session's is copied.

        Raises
        ------
        InputError
            It is no mesh that can be used; the sentence says why.
        Cancelled
        """
        found = _inspected(file, units, tolerance / 1000, monitor.part(_COPIED, 1.0))
        kept = file if isinstance(file, NamedFile) else self._copied(file, monitor)
        original = import_mesh(kept, _units(units), tolerance / 1000, monitor.part(1.0, 1.0))
        return Mesh(kept, found, original, digest_of(kept)[0])

    def _copied(self, file: Path, monitor: Monitor) -> NamedFile:
        """Copy a file, and what belongs to it."""
        copies = {name: self._place() for name in (file.name, *companions_of(file))}
        for name, copy in copies.items():
            _copy(file.with_name(name), copy, monitor)
        return NamedFile(copies[file.name], file.name, copies)

    def restore(self, monitor: Monitor = NOBODY) -> tuple[Mesh, ProbePlan] | None:
        """Return the mesh and the plan of the session's probe; None: there is no mesh yet."""
        state = self.desk.state
        recipe = recipe_of(state)
        if recipe is None or "mesh" not in recipe.inputs:  # a probe that came from elsewhere says not how
            return None
        wanted = {role: sha for role, sha in recipe.inputs.items() if role in {"mesh", "alignment"}}
        files = inputs_of(self.desk.folder, state, wanted)
        given = ProbeParameters.checked({**recipe.parameters, "name": PROBE_FILE})
        known = {each.name for each in fields(ProbePlan)} & set(ProbeParameters.model_fields)
        alignment = alignment_of(given, files.get("alignment"))
        plan = ProbePlan(alignment=alignment, **{name: getattr(given, name) for name in known})
        return self.take(files["mesh"], plan.units, monitor, tolerance=plan.tolerance), plan

    def kept(self, content: str, plan: ProbePlan, monitor: Monitor = NOBODY) -> Mesh:
        """
        Return a mesh that the session keeps, as a plan reads it.

        Parameters
        ----------
        content : str
            `Input.content` of it. What was taken or asked for last is not looked at again.
        plan : ProbePlan
        monitor : Monitor

        Raises
        ------
        SessionError
            The session does not hold it, or it cannot be read.
        """
        key = (content, plan.units, plan.tolerance)
        known = self._taken.get(key)
        if known is None:
            mesh = inputs_of(self.desk.folder, self.desk.state, {"mesh": content})["mesh"]
            known = self.take(mesh, plan.units, monitor, tolerance=plan.tolerance)
            self._taken[key] = known
        self._taken.move_to_end(key)
        while len(self._taken) > _REMEMBERED:
            self._taken.popitem(last=False)
        return known

    # ---- what comes of it ------------------------------------------------------------------------

    def shell(self, mesh: Mesh, plan: ProbePlan, monitor: Monitor = NOBODY) -> Dense:
        """Make the outer surface, or give the one that was made before; as ``contactbench probe shell``."""
        return dense_of(mesh.file, plan.given, remember=True, monitor=monitor)

    def placed(self, mesh: Mesh, plan: ProbePlan, monitor: Monitor = NOBODY) -> ProbeFile:
        """Return the outer surface where the plan puts it, with the session's regions; see `shell`."""
        dense = self.shell(mesh, plan, monitor)
        files, _ = self._regions(plan)
        return place(dense, plan.alignment, partial(put_on, file=files[REGIONS]) if files else None)

    def ladder(self, mesh: Mesh, plan: ProbePlan, monitor: Monitor = NOBODY) -> Ladder:
        """Measure what fewer facets cost and save; as ``contactbench probe ladder``."""
        placed = self.placed(mesh, plan, monitor.part(0.0, 0.5))
        given = plan.given
        return measure_ladder(
            placed.probe,
            ExpectedTouches(force=given.forces),
            region_ratio=given.region_ratio,
            monitor=monitor.part(0.5, 1.0),
        )

    def preview(self, mesh: Mesh, plan: ProbePlan, monitor: Monitor = NOBODY) -> ProbePreview:
        """Prepare the probe as the session will, and measure how far it is from the outer surface."""
        inputs, regions = self._regions(plan)
        inputs["mesh"] = mesh.file
        if plan.alignment is not None:
            placed_by = self._place()
            placed_by.write_text(plan.alignment.to_json(), encoding="utf-8")
            inputs[ALIGNMENT] = NamedFile(placed_by, ALIGNMENT_FILE)
        done = prepared(inputs, plan.given, remember=True, monitor=monitor)
        placed = self.placed(mesh, plan)
        probe = done.content.probe
        distance, _, _ = SurfaceIndex(probe.vertices, probe.faces).closest(placed.probe.vertices)
        return ProbePreview(plan, mesh, placed, done, regions, distance)

    def _regions(self, plan: ProbePlan) -> tuple[dict[str, File], str]:
        """Return the session's regions as a file, and their content; neither where there are none."""
        state = self.desk.state
        kept = state.newest(REGIONS)
        if kept is None or not plan.painted:
            return {}, ""
        return {**inputs_of(self.desk.folder, state, {REGIONS: kept.content})}, kept.content


def _inspected(file: File, units: str, tolerance: float, monitor: Monitor) -> Inspection:
    try:
        return inspect(file, _units(units), tolerance=tolerance, monitor=monitor)
    except MemoryError as error:
        raise InputError(f"{arg(file)}: not enough memory: export the part with fewer facets.") from error


def _copy(file: Path, target: Path, monitor: Monitor) -> None:
    try:
        with file.open("rb") as source, target.open("wb") as copy:
            while chunk := source.read(_PORTION):
                monitor.check()
                copy.write(chunk)
    except OSError as error:
        target.unlink(missing_ok=True)
        raise InputError(
            f"{arg(file)}: it cannot be copied ({arg(error)}): check the file and the free disk space."
        ) from error


def _units(units: str) -> Any:
    return units  # `inspect` and `import_mesh` refuse one that they do not know


def commit(session: Session, preview: ProbePreview) -> Record:
    """
    Put a prepared probe, and what it was made from, into a session; for `Desk.do`.

    As ``contactbench session add SESSION MESH --kind mesh``, the same of the alignment, and ``contactbench session
    compute SESSION probe probe.ply --set ...`` do, with the same bytes.
    """
    files = encode_probe_file(preview.done.content, PROBE_FILE)
    session.check_writable()
    inputs = {"mesh": _mesh(session, preview.mesh)}
    if preview.plan.alignment is not None:
        inputs[ALIGNMENT] = _alignment(session, preview.plan.alignment.to_json())
    if preview.regions:
        inputs["regions"] = preview.regions
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return session.add_result(PROBE, PROBE_FILE, files, inputs, preview.plan.parameters, created=now)


def _mesh(session: Session, mesh: Mesh) -> str:
    """Make a mesh the one in use, unless it is; return its content."""
    known = session.state.mesh
    same = (
        known is not None
        and known.name == mesh.file.name
        and known.file.sha256 == mesh.sha256
        and set(known.companions) == set(mesh.companions)
    )
    if not same:
        session.add_input(mesh.file, MESH, companions=mesh.companions)
    used = session.state.mesh
    assert used is not None  # noqa: S101  (it was just added)
    return used.content


def _alignment(session: Session, text: str) -> str:
    known = session.state.current_inputs.get((ALIGNMENT, ALIGNMENT_FILE))
    if known is None or (session.folder / known.file.path).read_bytes() != text.encode():
        session.add_input(text.encode(), ALIGNMENT, name=ALIGNMENT_FILE)
    return session.state.current_inputs[ALIGNMENT, ALIGNMENT_FILE].content


# ---- what fewer facets cost -----------------------------------------------------------------------


@dataclass(frozen=True)
class TradePoint:
    """One number of facets."""

    facets: int
    error_mm: float  # What 95 % of the contacts move less than, against all facets, mm
    solve_us: float  # Median time of a solve, µs
    loop_us: float  # The same of the paper's loop over all facets, µs
    advised: bool = False  # The fewest facets that will do: the knee


@dataclass(frozen=True)
class Trade:
    """A chart of speed against error."""

    points: tuple[TradePoint, ...]  # By facets, ascending; the last has all of them
    allowed_mm: float  # Largest error that will do, mm
    reason: str  # What to take and why

    @property
    def advised(self) -> int:
        """Facets to take."""
        return next((point.facets for point in self.points if point.advised), self.points[-1].facets)


def trade_of(ladder: Ladder) -> Trade:
    """Return a ladder's chart; rungs on which no touch could be compared are left out."""
    points = [
        TradePoint(
            rung.facets,
            1e3 * rung.judged.noisy.p95,
            0.0 if rung.speed is None else rung.speed.contactbench.median / 1e3,
            0.0 if rung.speed is None else rung.speed.algorithm1.median / 1e3,
            rung is ladder.recommended,
        )
        for rung in ladder.rungs
        if rung.judged.noisy.p95 is not None
    ]
    return Trade(tuple(points), 1e3 * ladder.recommendation.limit, ladder.recommendation.reason)


# ---- the probe that is being prepared ------------------------------------------------------------


DRAFT, DRAFT_MESH = PROBE_DRAFT, "draft-mesh"
_LISTS = ("close",)


@dataclass(frozen=True)
class ProbeDraft:
    """What is being prepared."""

    mesh: str  # `Input.content` of its mesh
    name: str  # Of the mesh's file
    plan: ProbePlan


def draft_of(state: State) -> ProbeDraft | None:
    """
    Return the draft of a session; None: there is none.

    Raises
    ------
    InputError
        What the session says of it makes no sense.
    """
    value = state.setting(DRAFT)
    if value is None:
        return None
    try:
        mesh, given = str(value["mesh"]), dict(value["plan"])
        known = state.input_with(mesh)
        name = "" if known is None else known.name
        chosen: dict[str, Any] = {key: tuple(each) if key in _LISTS else each for key, each in given.items()}
        placed = value.get("alignment")
        alignment = None if placed is None else from_json(str(placed).encode(), f"{DRAFT}.alignment")
        plan = ProbePlan(alignment=alignment, painted=bool(value.get("painted", True)), **chosen)
        _ = plan.given  # refused as a computation would
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{arg(DRAFT)}: the draft cannot be read ({arg(error)}): choose the mesh again."
        ) from error
    return ProbeDraft(mesh, name, plan)


def keep_draft(session: Session, mesh: Mesh, plan: ProbePlan) -> Record | None:
    """
    Keep what is being prepared; None: the session has the very same.

    Parameters
    ----------
    session : Session
        Open for writing.
    mesh : Mesh
        Its file becomes an input, unless the session has it.
    plan : ProbePlan
    """
    known = _known(session.state, mesh)
    if known is None:
        session.add_input(mesh.file, DRAFT_MESH, name=mesh.file.name, companions=mesh.companions)
        known = session.state.current_inputs[DRAFT_MESH, mesh.file.name]
    value: dict[str, Any] = {
        "mesh": known.content,
        "plan": plan.parameters,
        "alignment": None if plan.alignment is None else plan.alignment.to_json(),
        "painted": plan.painted,
    }
    return None if session.state.setting(DRAFT) == value else session.set_parameter(DRAFT, value)


def use_draft(session: Session, preview: ProbePreview) -> Record:
    """Make a prepared probe the session's, as `commit` does: it is a draft no more."""
    record = commit(session, preview)
    if session.state.setting(DRAFT) is not None:
        session.set_parameter(DRAFT, None)
    return record


def _known(state: State, mesh: Mesh) -> Input | None:
    """Return the session's own copy of a mesh with what belongs to it; None: there is none."""
    beside = {name: digest_of(path)[0] for name, path in mesh.companions.items()}
    for each in reversed(state.inputs):
        there = {name: ref.sha256 for name, ref in each.companions.items()}
        if (each.name, each.file.sha256, there) == (mesh.file.name, mesh.sha256, beside):
            return each
    return None


# ---- the ways to say where the mesh lies ---------------------------------------------------------


FEWEST_PAIRS = 3


def back_to_mesh(points_S: ArrayLike, alignment: Alignment | None) -> NDArray[np.float64]:
    """Return places on what is shown (n, 3) or (3,), m, in the mesh's own frame P."""
    points = np.asarray(points_S, dtype=np.float64)
    if alignment is None:
        return points
    moved: NDArray[np.float64] = (points - alignment.p_SP_S) @ alignment.R_SP
    return moved


def by_points(pairs: Sequence[tuple[NDArray[np.float64], NDArray[np.float64]]]) -> Alignment:
    """
    Align by places picked on the mesh; as ``contactbench probe align --points``.

    Parameters
    ----------
    pairs : sequence of ((3,), (3,))
        A place in the mesh's frame, and where it lies in the sensor frame, m.
    """
    if len(pairs) < FEWEST_PAIRS:
        raise InputError(
            f"{arg(len(pairs))} points are picked, but {arg(FEWEST_PAIRS)} are needed: pick another one, far"
            " from these."
        )
    return align_points([point_P for point_P, _ in pairs], [point_S for _, point_S in pairs])


def by_flange(
    probe_P: Probe, facet: int, toward_P: NDArray[np.float64] | None, clock_deg: float, offset_mm: float
) -> Alignment:
    """Align by the face that sits on the sensor; as ``contactbench probe align --flange-face``."""
    face = find_mounting_face(probe_P, facet)
    return align_flange(face, offset=offset_mm / 1e3, toward_P=toward_P, clock_deg=clock_deg)


def by_axes(probe_P: Probe, offset_mm: float) -> Alignment:
    """Align by the shape; as ``contactbench probe align --axes``."""
    return align_axes(probe_P, offset=offset_mm / 1e3).alignment


def by_touches(
    probe_P: Probe, file: Path, mount: Alignment | None, progress: Callable[[float], None] | None = None
) -> tuple[Alignment, tuple[str, ...]]:
    """
    Align by touches of marked points; as ``contactbench probe align --touches``.

    Parameters
    ----------
    probe_P : Probe
    file : path
        CSV; see `read_touches`.
    mount : Alignment or None
        Where the mesh lies by now; None: any of the four places that its shape suggests.
    progress : callable, optional

    Returns
    -------
    Alignment
    tuple of str
        Why to take it, or rather not.
    """
    starts = align_axes(probe_P).alternatives if mount is None else mount.T_SP
    found = align_touches(probe_P, read_touches(file), starts, progress=progress)
    return found.fitted, tuple(found.reasons)


def numbers_of(alignment: Alignment | None) -> tuple[float, ...]:
    """Return x, y, z in mm and the angles about the fixed axes x, y, z in degrees; zeros for none."""
    if alignment is None:
        return (0.0,) * 6
    angles = Rotation.from_matrix(alignment.R_SP).as_euler("xyz", degrees=True)
    return (*(float(v) for v in 1e3 * alignment.p_SP_S), *(float(v) for v in angles))
