"""
3MF, the 3D manufacturing format: a zip archive with one XML model that states its unit.

The archive is unpacked in pieces with a limit, document types (and with them entities) are refused, and nothing
but the archive's models is opened: the one that says what is built, and those it takes parts from.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from array import array
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.parse import RawMesh, points, refuse_too_many

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy.typing as npt

    from contactbench.pipeline.mesh.load import Units

_MODEL = "3d/3dmodel.model"
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/"

# What an extension adds that a model requires is part of its shape, but for these: parts in several models, colours,
# and names for triangles.
_READ = ("/3dmanufacturing/production/", "/3dmanufacturing/material/", "/3dmanufacturing/trianglesets/")

# Objects of these types carry the part while it is printed, and are broken off.
_SUPPORTS = ("support", "solidsupport")

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


@dataclass(frozen=True)
class _Placed:
    """An object by its number and the path of its model, empty for the model that places it, and where it goes."""

    path: str
    name: str
    transform: _Transform


@dataclass
class _Object:
    kind: str
    coordinates: array[float] = field(default_factory=lambda: array("d"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    components: list[_Placed] = field(default_factory=list)


@dataclass
class _Model:
    unit: str = "millimeter"
    objects: dict[str, _Object] = field(default_factory=dict)
    items: list[_Placed] = field(default_factory=list)
    current: _Object | None = None
    spaces: dict[str, str] = field(default_factory=dict)
    unprinted: int = 0


@dataclass
class _Package:
    """An archive, its entries and the models read so far by their path, and how many bytes may still be unpacked."""

    archive: zipfile.ZipFile
    entries: dict[str, zipfile.ZipInfo]
    left: int
    models: dict[str, _Model] = field(default_factory=dict)
    supports: int = 0

    def model(self, path: str) -> _Model:
        key = _key(path)
        if key not in self.models:
            self.models[key] = _parse(self, key)
        return self.models[key]


def read_threemf(data: bytes) -> RawMesh:
    """
    Read the content of a 3MF file: every item of its build, placed as the build says, as one mesh.

    Supports and items that are not to be printed are left out, which is told. Materials, colours, and beams and slices
    that the file does not require, are not looked at.

    Raises
    ------
    MeshError
        Not a 3MF archive, damaged, unpacking to more than it may, without facets, or with an extension required that is
        not read.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = {_key(entry.filename): entry for entry in archive.infolist()}
            limit = min(_LARGEST_MODEL, _MOST_GROWTH * len(data) + 2**20)
            return _build(_Package(archive, entries, limit))
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
            f"this is not a readable 3MF archive ({arg(str(error)[:_QUOTED])}): copy or export it again."
        ) from error


def _build(package: _Package) -> RawMesh:
    root = _root(package)
    model = package.model(root)
    if model.unit not in _UNITS:
        raise MeshError(f"the 3MF model states the unknown unit {arg(model.unit[:40])!r}: export it again.")
    copies: list[tuple[_Object, _Transform]] = []
    for item in model.items:
        _collect(package, root, item, (np.eye(3), np.zeros(3)), copies, depth=0)
    refuse_too_many(sum(len(part.corners) // 3 for part, _ in copies))
    return replace(_join(copies, model.unit), notes=tuple(_notes(package, model)))


def _notes(package: _Package, model: _Model) -> Iterator[str]:
    if package.supports:
        yield message(f"Supports of the 3MF file were left out (objects: {arg(package.supports)}).")
    if model.unprinted:
        yield message(
            f"Items that the 3MF file marks as not printed were left out (items: {arg(model.unprinted)})."
        )
    others = sorted({other.unit for other in package.models.values()} - {model.unit})
    if others:
        yield message(
            f"Parts of the 3MF file state another unit ({arg(', '.join(others)[:_QUOTED])}) than its build"
            f" ({arg(model.unit)}), whose unit was used for all: check their size."
        )


def _parse(package: _Package, path: str) -> _Model:
    # Costs a command that reads no 3MF nothing. Document types are refused, so there are no entities.
    from xml.parsers import expat

    model = _Model()
    parser = expat.ParserCreate(namespace_separator="\n")
    parser.StartDoctypeDeclHandler = _refuse_doctype
    parser.StartNamespaceDeclHandler = lambda prefix, space: model.spaces.setdefault(
        prefix or "", space or ""
    )
    parser.StartElementHandler = lambda name, attributes: _start(model, name, attributes)
    with package.archive.open(_entry(package, path)) as stream:
        try:
            while piece := stream.read(_PIECE):
                package.left -= len(piece)
                if package.left < 0:
                    raise MeshError(
                        "the 3MF archive unpacks to far more than a model needs: export it again."
                    )
                parser.Parse(piece, False)
            parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise MeshError(f"the 3MF model is not valid XML ({arg(error)}): export it again.") from error
    return model


def _key(path: str) -> str:
    return path.lower().lstrip("/")


def _root(package: _Package) -> str:
    """Find the model that says what is built: the usual one, or the only one."""
    models = [name for name in package.entries if name.endswith(".model")]
    return models[0] if len(models) == 1 else _MODEL


def _entry(package: _Package, path: str) -> zipfile.ZipInfo:
    entry = package.entries.get(path)
    if entry is None:
        if path == _MODEL:
            raise MeshError(
                "the archive has no 3D/3dmodel.model: it is not a 3MF file, or is one for"
                " printers only. Export the part again."
            )
        raise MeshError(
            f"the 3MF archive lacks the model {arg(path[:60])!r} that it takes parts from: export it again."
        )
    # Others can be made to unpack to any amount in one read.
    if entry.flag_bits & 1 or entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise MeshError(
            "the 3MF model is encrypted or packed in an unusual way: export it again, unprotected."
        )
    return entry


def _refuse_doctype(*_: object) -> None:
    raise MeshError("the 3MF model declares a document type, which is not allowed: export it again.")


def _start(model: _Model, name: str, attributes: dict[str, str]) -> None:
    space, _, tag = name.rpartition("\n")
    if space and not space.startswith(_CORE):
        return
    try:
        _element(model, tag, attributes)
    except KeyError as error:
        raise MeshError(f"a <{arg(tag)}> of the 3MF model has no {arg(error)}: export it again.") from error
    except (ValueError, OverflowError) as error:
        if isinstance(error, MeshError):
            raise
        raise MeshError(
            f"a <{arg(tag)}> of the 3MF model has no number ({arg(str(error)[:_QUOTED])}): export it again."
        ) from error


def _element(model: _Model, tag: str, attributes: dict[str, str]) -> None:
    match tag:
        case "model":
            model.unit = attributes.get("unit", "millimeter").lower()
            _refuse_required(model, attributes.get("requiredextensions", ""))
        case "object":
            model.current = model.objects.setdefault(
                attributes["id"], _Object(attributes.get("type", "model"))
            )
        case "vertex" if model.current:
            model.current.coordinates.extend(float(attributes[axis]) for axis in "xyz")
        case "triangle" if model.current:
            model.current.corners.extend(int(attributes[corner]) for corner in ("v1", "v2", "v3"))
        case "component" if model.current:
            model.current.components.append(_placed(attributes))
        case "item" if attributes.get("printable") in ("0", "false"):
            model.unprinted += 1
        case "item":
            model.items.append(_placed(attributes))
        case _:
            pass


def _refuse_required(model: _Model, prefixes: str) -> None:
    for prefix in prefixes.split():
        space = model.spaces.get(prefix, prefix)
        if not any(known in space for known in _READ):
            raise MeshError(
                f"the 3MF file needs the extension {arg(space[:_QUOTED])!r}, which is not supported:"
                " export the part as plain triangles, as 3MF or STL."
            )


def _placed(attributes: dict[str, str]) -> _Placed:
    numbers = np.array([float(word) for word in attributes.get("transform", "").split()])
    if not len(numbers):
        numbers = np.array([1.0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0])
    if numbers.shape != (12,) or not (np.abs(numbers) < 1e9).all():
        raise MeshError("a transform of the 3MF model is not twelve finite numbers: export it again.")
    # A part of another model of the archive is named with that model's path, of the production extension.
    path = next((value for key, value in attributes.items() if key.rpartition("\n")[2] == "path"), "")
    # Written for rows: p' = p A + t.
    return _Placed(path, attributes["objectid"], (numbers[:9].reshape(3, 3), numbers[9:]))


def _collect(
    package: _Package,
    model: str,
    placed: _Placed,
    above: _Transform,
    copies: list[tuple[_Object, _Transform]],
    depth: int,
) -> None:
    """List every copy of a mesh that an item stands for, with where it goes."""
    model = placed.path or model
    part = package.model(model).objects.get(placed.name)
    if part is None:
        raise MeshError(
            f"the 3MF model places the object {arg(placed.name[:40])!r}, which it does not contain: export"
            " it again."
        )
    if part.kind in _SUPPORTS:
        package.supports += 1
        return
    (A, t), (B, s) = above, placed.transform
    transform = (B @ A, s @ A + t)
    copies.append((part, transform))
    if depth > _DEEPEST or len(copies) > _MOST_COPIES:
        raise MeshError("the 3MF model nests or repeats its objects too often: export the probe alone.")
    for inner in part.components:
        _collect(package, model, inner, transform, copies, depth + 1)


def _join(copies: list[tuple[_Object, _Transform]], unit: str) -> RawMesh:
    stated, factor = _UNITS[unit]
    vertices, faces, start = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], 0
    for part, (A, t) in copies:
        corners = np.frombuffer(part.corners, dtype=np.int64).reshape(-1, 3)
        placed = points(part.coordinates)
        if len(corners) and (corners.min() < 0 or corners.max() >= len(placed)):
            raise MeshError(
                "a triangle of the 3MF model refers to a vertex that does not exist: export it again."
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
