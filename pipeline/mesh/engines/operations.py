"""The operations as functions: they check the mesh on the way in and what the library made of it on the way out."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, TypedDict, Unpack

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.engines.child import run
from contactbench.pipeline.mesh.engines.libraries import EngineError, Library, Operation
from contactbench.pipeline.mesh.gltf import read_gltf
from contactbench.pipeline.mesh.monitor import Monitor
from contactbench.pipeline.mesh.parse import MERGE, RawMesh, Reading, up
from contactbench.pipeline.mesh.polygons import triangulate
from contactbench.pipeline.mesh.probe import check_faces, check_vertices, extent
from contactbench.pipeline.mesh.triangles import merge_vertices

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

    from contactbench.pipeline.mesh.arrays import Floats, Ints, Surface
    from contactbench.pipeline.mesh.load import Units

# Text of this size takes a gigabyte when it is parsed, and a CAD file more.
_LARGEST_FILE = 2**27
_PATIENCE_S, _PATIENCE_S_MB = 240.0, 5.0  # for any file, and for each megabyte
_HEAD = 2**12
_INSTEAD = message(
    "You can also export the part as 3MF, or as STL in millimetres, with a tolerance of 0.01 mm."
)
# As far as neighbouring facets of a STEP file's curved surfaces turn.
_TURN_DEG = 12
# Of the tolerance: Open CASCADE keeps the distance along edges, and on spheres exceeds it 2.1 times.
_KEPT = 0.45
_END = b"END-ISO-10303-21"  # comes last in a STEP file; some programs write a line or two after it
# What a STEP file calls units of length. The units in use are named by number, and one may be made of another.
_STEP_UNITS = {
    "MILLI": message("millimetres"), "": message("metres"), "CENTI": message("centimetres"),
    "MICRO": message("micrometres"), "INCH": message("inches"), "FOOT": message("feet"),
}  # fmt: skip
_USED = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([#\d,\s]*)\)")
_LENGTH = re.compile(rb"#(\d+)\s*=\s*(\([^;=]*\bLENGTH_UNIT\b[^;=]*);")
_WORDS = re.compile(rb"'[^']*'|/\*.*?\*/", re.S)
_UNIT = re.compile(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'|SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.")
_ANNOUNCED = re.compile(
    rb"^(?:POINTS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS)[ \t]+(\d{1,18})(?:[ \t]+(\d{1,18}))?", re.M
)
_UNITS: Final[dict[float, Units]] = {1.0: "m", 0.01: "cm", 0.001: "mm", 0.0254: "in"}


class Control(TypedDict, total=False):
    """`monitor` and `timeout_s` of `run`; every operation takes them."""

    monitor: Monitor
    timeout_s: float | None


def alpha_wrap(
    vertices: npt.ArrayLike, faces: npt.ArrayLike, alpha: float, offset: float, **control: Unpack[Control]
) -> Surface:
    """
    Wrap a mesh, however broken, in a closed, orientable, manifold surface (Portaneri et al. 2022, CGAL).

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    alpha : float
        Gaps narrower than this are bridged, in the vertices' unit; above 0. The result's facets are of
        about this size, so the time grows with its inverse square.
    offset : float
        How far outside the mesh the wrap lies, in the same unit; above 0.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`; also for lengths that are not above 0.
    """
    _refuse_unless_positive(alpha=alpha, offset=offset)
    result = run(
        Operation.ALPHA_WRAP, _checked(vertices, faces), {"alpha": alpha, "offset": offset}, **control
    )
    return _mesh(Operation.ALPHA_WRAP, result)


def cut_along_crossings(
    vertices: npt.ArrayLike, faces: npt.ArrayLike, **control: Unpack[Control]
) -> tuple[Floats, Ints, Ints]:
    """
    Cut facets along the lines where they cross or touch others, exactly (CGAL, by libigl).

    New vertices are rounded to doubles, so that pieces may cross again by that much.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32
        Some may have no area after rounding.
    born : (l,) int32
        The facet that each is a piece of.

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`.
    """
    arrays = _checked(vertices, faces)
    result = run(Operation.CUT, arrays, {}, **control)
    new_vertices, new_faces = _mesh(Operation.CUT, result)
    born = result.get("born")
    right = born is not None and born.dtype == np.int32 and born.shape == (len(new_faces),)
    if born is None or not right or born.min() < 0 or born.max() >= len(arrays["faces"]):
        raise EngineError(
            f"{arg(Library.CGAL)} did not report which original facets its facets come from: use another mesh."
        )
    return new_vertices, new_faces, born


def read_dae(data: bytes, reading: Reading) -> RawMesh:
    """
    Read the content of a COLLADA file; the geometry of its scene becomes one mesh, as the nodes place it.

    Skins, lines and materials are not looked at.

    Raises
    ------
    MeshError
        pycollada is missing, or finds it damaged or without facets.
    """
    arrays = _read(Operation.READ_DAE, "DAE", data, reading)
    metre, skipped, axis = arrays["told"].tolist()
    left_out = message(
        f"Parts of the DAE file that are damaged or of an unknown kind were left out (parts: {arg(skipped):.0f})."
    )
    raw = _raw("DAE", arrays)
    raw = replace(raw, notes=(*raw.notes, *(left_out,) * bool(skipped)), axes=up("xyz"[int(axis)]))
    if not metre or metre in _UNITS:
        return replace(raw, stated=_UNITS.get(metre))
    return replace(raw, vertices=raw.vertices * metre, stated="m")


def read_vtk(data: bytes, reading: Reading) -> RawMesh:
    """
    Read the content of a VTK file, of the old kind or XML (VTP), that holds a surface of polygons.

    Raises
    ------
    MeshError
        vtk is missing, or finds no surface in it.
    """
    # VTK makes room for all that a file announces.
    announced = max(
        (int(number) for found in _ANNOUNCED.findall(data) for number in found if number), default=0
    )
    if announced > len(data):
        raise MeshError(
            f"this is a VTK file, but it announces {arg(announced)} numbers, more than its {arg(len(data))} bytes can"
            f" hold: it is cut short or damaged. {arg(_INSTEAD)}"
        )
    return _raw("VTK", _read(Operation.READ_VTK, "VTK", data, reading))


def read_step(data: bytes, reading: Reading) -> RawMesh:
    """
    Read the content of a STEP file, tessellated, in millimetres; the parts of an assembly lie where it places them.

    Raises
    ------
    MeshError
        cascadio is missing, or finds it damaged or without solids and surfaces.
    """
    if _END not in data[-_HEAD:].upper():
        raise MeshError(
            f"this is a STEP file, but it is cut short or damaged (it does not end with {arg(_END.decode())}): copy or"
            " export it again."
        )
    torn = _torn(data)
    wanted_mm = 1e3 * reading.tolerance
    fields = {"tolerance": _KEPT * wanted_mm, "angle": math.radians(_TURN_DEG)}
    made = _read(Operation.READ_STEP, "STEP", data, reading, **fields)["file"].tobytes()
    try:
        raw = read_gltf(made)
    except MeshError as error:
        raise MeshError(f"the STEP file gave no usable surface: {arg(error)} {arg(_INSTEAD)}") from error
    # Each face has vertices of its own, and at a pole, facets that are lines.
    faces = check_faces(raw.faces, len(raw.vertices))
    vertices, faces = merge_vertices(raw.vertices, faces, MERGE * extent(raw.vertices, faces))
    a, b, c = faces.T
    kept = faces[(a != b) & (b != c) & (c != a)].astype(np.int64)
    drawn = ", ".join(_units_of(data)) or message("an unknown unit")
    note = message(
        f"The STEP file, drawn in {arg(drawn)}, was tessellated to {arg(wanted_mm):g} mm and {arg(_TURN_DEG)}° and read"
        " in millimetres, with each part where its assembly places it."
    )
    return replace(raw, vertices=vertices * 1000, faces=kept, stated="mm", notes=(note, *torn), axes=())


def _torn(data: bytes) -> tuple[str, ...]:
    """Say that a STEP file refers to what it does not hold; MeshError if a number stands for two things."""
    plain = _WORDS.sub(b"", data)
    entities = re.findall(rb"#(\d+)\s*=", plain)
    held = set(entities)
    if len(held) < len(entities):
        raise MeshError(
            "this is a STEP file, but several of its entities have the same number, so it is damaged: copy or export"
            " it again."
        )
    missing = len({*re.findall(rb"#(\d+)", plain)} - held)
    told = message(
        f"The STEP file is damaged: it refers to entities that it does not hold ({arg(missing)}). Parts or faces may be"
        " missing: export it again."
    )
    return (told,) if missing else ()


def _units_of(data: bytes) -> list[str]:
    """Name the units of length that a STEP file is drawn in."""
    used = {number for each in _USED.findall(data) for number in re.findall(rb"\d+", each)}
    found = (_UNIT.search(entity) for number, entity in _LENGTH.findall(data) if number in used)
    words = {(each[1] or each[2] or b"").decode("latin-1").upper() for each in found if each}
    return [_STEP_UNITS.get(word, word.lower()) for word in sorted(words)]


@lru_cache(maxsize=1)
def _read(
    operation: Operation, kind: str, data: bytes, reading: Reading, **fields: float
) -> dict[str, npt.NDArray[Any]]:
    """Let a library read a file, in its own process; the last is kept: a mesh is looked at before it is used."""
    if len(data) > _LARGEST_FILE:
        raise MeshError(f"the file has more than {arg(_LARGEST_FILE // 2**20)} MiB: export the part as STL.")
    try:
        return run(
            operation,
            {"file": np.frombuffer(data, np.int8)},
            fields,
            monitor=reading.monitor,
            timeout_s=_PATIENCE_S + _PATIENCE_S_MB * len(data) / 2**20,
        )
    except EngineError as error:
        raise MeshError(f"this is a {arg(kind)} file: {arg(error)} {arg(_INSTEAD)}") from error


def _raw(kind: str, arrays: Mapping[str, npt.NDArray[Any]]) -> RawMesh:
    vertices, corners, sizes = arrays["vertices"], arrays["corners"], arrays["sizes"]
    if not len(sizes) or sizes.min() < 0 or sizes.sum() != len(corners):
        raise MeshError(f"the {arg(kind)} file holds no facets: export the part again, as a surface.")
    done = triangulate(vertices, corners.astype(np.int64), sizes.astype(np.int64))
    return RawMesh(vertices, done.faces, notes=done.notes)


def _checked(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> dict[str, npt.NDArray[Any]]:
    points = check_vertices(vertices)
    return {"vertices": points, "faces": check_faces(faces, len(points))}


def _refuse_unless_positive(**lengths: float) -> None:
    for name, value in lengths.items():
        # not >, so that NaN is refused too.
        if not 0 < value < float("inf"):
            raise EngineError(f"{arg(name)} is {arg(value):g}: give a length above 0.")


def _mesh(operation: Operation, result: dict[str, npt.NDArray[Any]]) -> Surface:
    """Believe nothing: the libraries pass NaN on, and a heap they damaged may hold anything."""
    vertices, faces = result.get("vertices"), result.get("faces")
    match vertices, faces:
        case np.ndarray(ndim=2, shape=(_, 3)) as points, np.ndarray(ndim=2, shape=(count, 3)) as triangles:
            right = (
                points.dtype == np.float64 and triangles.dtype == np.int32 and bool(np.isfinite(points).all())
            )
            if right and count and triangles.min() >= 0 and triangles.max() < len(points):
                return points, triangles
    raise EngineError(
        f"{arg(operation.library)} produced no usable mesh from '{arg(operation)}': repair the mesh first,"
        " or use another engine."
    )
