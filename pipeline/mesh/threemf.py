"""
3MF, the 3D manufacturing format: a zip archive with one XML model that states its unit.

The archive is unpacked in pieces with a limit, document types (and with them entities) are refused, and nothing
outside the archive's one model is opened.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from array import array
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import RawMesh, points, refuse_too_many

if TYPE_CHECKING:
    import numpy.typing as npt

    from pipeline.mesh.units import Units

_MODEL = "3d/3dmodel.model"
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/"

# Models shrink to a tenth; a file that grows more than this is made to fill a memory.
_MOST_GROWTH = 100
_LARGEST_MODEL = 2**29
_PIECE = 2**18

# A probe is one part or a few; nested copies of copies can ask for more than any memory holds.
_MOST_COPIES = 1000
_DEEPEST = 8

# What Python says of a value repeats the value, which may be a megabyte.
_QUOTED = 100

# The unit of the numbers that are handed on, and what to multiply with for it.
_UNITS: Final[dict[str, tuple[Units, float]]] = {
    "micron": ("mm", 0.001), "millimeter": ("mm", 1.0), "centimeter": ("cm", 1.0),
    "inch": ("in", 1.0), "foot": ("in", 12.0), "meter": ("m", 1.0),
}  # fmt: skip

_Transform = tuple["npt.NDArray[np.float64]", "npt.NDArray[np.float64]"]


@dataclass
class _Object:
    coordinates: array[float] = field(default_factory=lambda: array("d"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    components: list[tuple[str, _Transform]] = field(default_factory=list)


@dataclass
class _Model:
    unit: str = "millimeter"
    objects: dict[str, _Object] = field(default_factory=dict)
    items: list[tuple[str, _Transform]] = field(default_factory=list)
    current: _Object | None = None


def read_threemf(data: bytes) -> RawMesh:
    """
    Read the content of a 3MF file: every item of its build, placed as the build says, as one mesh.

    Materials, colours, beams and slices are not looked at.

    Parameters
    ----------
    data : bytes
        The whole file.

    Returns
    -------
    RawMesh
        Facets in the order of the build; `stated` is the unit.

    Raises
    ------
    MeshError
        Not a 3MF archive, damaged, unpacking to more than it may, split over several model files, or without
        facets.
    """
    try:
        model = _parse(data)
    except MeshError:
        raise
    # ValueError and LookupError: names and encodings in words that Python does not know.
    except (
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        OSError,
        NotImplementedError,
        ValueError,
        LookupError,
    ) as error:
        raise MeshError(
            f"this is not a readable 3MF archive ({str(error)[:_QUOTED]}): copy or export it again."
        ) from error
    if model.unit not in _UNITS:
        raise MeshError(f"the 3MF model states the unknown unit {model.unit[:40]!r}: export it again.")
    copies: list[tuple[_Object, _Transform]] = []
    for name, transform in model.items:
        _collect(model, name, transform, copies, depth=0)
    refuse_too_many(sum(len(part.corners) // 3 for part, _ in copies))
    return _join(copies, model.unit)


def _parse(data: bytes) -> _Model:
    # Costs a command that reads no 3MF nothing. Document types are refused, so there are no entities.
    from xml.parsers import expat

    model = _Model()
    parser = expat.ParserCreate(namespace_separator="\n")
    parser.StartDoctypeDeclHandler = _refuse_doctype
    parser.StartElementHandler = lambda name, attributes: _start(model, name, attributes)
    limit = min(_LARGEST_MODEL, _MOST_GROWTH * len(data) + 2**20)
    with zipfile.ZipFile(io.BytesIO(data)) as archive, archive.open(_model_entry(archive)) as stream:
        read = 0
        try:
            while piece := stream.read(_PIECE):
                read += len(piece)
                if read > limit:
                    raise MeshError("the 3MF archive unpacks to far more than a model takes: it is refused.")
                parser.Parse(piece, False)
            parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise MeshError(f"the 3MF model is not sound XML ({error}): export it again.") from error
    return model


def _model_entry(archive: zipfile.ZipFile) -> zipfile.ZipInfo:
    for entry in archive.infolist():
        if entry.filename.lower().lstrip("/") == _MODEL:
            # Others can be made to unpack to any amount in one read.
            if entry.flag_bits & 1 or entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise MeshError(
                    "the 3MF model is encrypted or packed in an unusual way: export it again, unprotected."
                )
            return entry
    raise MeshError(
        "the archive holds no 3D/3dmodel.model: this is not a 3MF file, or one for printers only."
    )


def _refuse_doctype(*_: object) -> None:
    raise MeshError("the 3MF model declares a document type, which no 3MF model does: it is refused.")


def _start(model: _Model, name: str, attributes: dict[str, str]) -> None:
    space, _, tag = name.rpartition("\n")
    if space and not space.startswith(_CORE):
        return
    try:
        _element(model, tag, attributes)
    except KeyError as error:
        raise MeshError(f"a <{tag}> of the 3MF model has no {error}: export it again.") from error
    except (ValueError, OverflowError) as error:
        if isinstance(error, MeshError):
            raise
        raise MeshError(
            f"a <{tag}> of the 3MF model holds no number ({str(error)[:_QUOTED]}): export it again."
        ) from error


def _element(model: _Model, tag: str, attributes: dict[str, str]) -> None:
    match tag:
        case "model":
            model.unit = attributes.get("unit", "millimeter").lower()
        case "object":
            model.current = model.objects.setdefault(attributes["id"], _Object())
        case "vertex" if model.current:
            model.current.coordinates.extend(float(attributes[axis]) for axis in "xyz")
        case "triangle" if model.current:
            model.current.corners.extend(int(attributes[corner]) for corner in ("v1", "v2", "v3"))
        case "component" if model.current:
            model.current.components.append(_placed(attributes))
        case "item":
            model.items.append(_placed(attributes))
        case _:
            pass


def _placed(attributes: dict[str, str]) -> tuple[str, _Transform]:
    if any(key.rpartition("\n")[2] == "path" for key in attributes):
        raise MeshError(
            "the 3MF model is split over several model files: export it again from the CAD program as one, or as"
            " STL."
        )
    numbers = np.array([float(word) for word in attributes.get("transform", "").split()])
    if not len(numbers):
        numbers = np.array([1.0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0])
    if numbers.shape != (12,) or not (np.abs(numbers) < 1e9).all():
        raise MeshError("a transform of the 3MF model is not twelve finite numbers: export it again.")
    # Written for rows: p' = p A + t.
    return attributes["objectid"], (numbers[:9].reshape(3, 3), numbers[9:])


def _collect(
    model: _Model, name: str, transform: _Transform, copies: list[tuple[_Object, _Transform]], depth: int
) -> None:
    """List every copy of a mesh that an item stands for, with where it goes."""
    part = model.objects.get(name)
    if part is None:
        raise MeshError(f"the 3MF model places the object {name[:40]!r}, which it does not hold.")
    copies.append((part, transform))
    if depth > _DEEPEST or len(copies) > _MOST_COPIES:
        raise MeshError("the 3MF model nests or repeats its objects too often: export the probe alone.")
    A, t = transform
    for inner, (B, s) in part.components:
        _collect(model, inner, (B @ A, s @ A + t), copies, depth + 1)


def _join(copies: list[tuple[_Object, _Transform]], unit: str) -> RawMesh:
    stated, factor = _UNITS[unit]
    vertices, faces, start = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], 0
    for part, (A, t) in copies:
        corners = np.frombuffer(part.corners, dtype=np.int64).reshape(-1, 3)
        placed = points(part.coordinates)
        if len(corners) and (corners.min() < 0 or corners.max() >= len(placed)):
            raise MeshError(
                "a triangle of the 3MF model refers to a vertex that is not there: export it again."
            )
        # A number that overflows here is refused, with its row, like every other infinity.
        with np.errstate(over="ignore", invalid="ignore"):
            vertices.append((placed @ A + t) * factor)
        # A mirror turns the facets' outer side in.
        faces.append((corners if np.linalg.det(A) >= 0 else corners[:, ::-1]) + start)
        start += len(placed)
    if not sum(map(len, faces)):
        raise MeshError("the 3MF model builds no triangles: export the part again, as a surface.")
    return RawMesh(np.concatenate(vertices), np.concatenate(faces), stated=stated)
