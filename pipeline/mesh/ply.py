"""
PLY, binary and text, with an integer property `region` per facet.

A PLY header says how many rows of which properties follow. It is read first, so that an absurd number is
refused before anything is allocated for it.
"""

import io
import re
import struct
from array import array
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import MeshError, arg, join, message
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask
from contactbench.pipeline.mesh.parse import (
    NUMBER,
    RawMesh,
    broken,
    decimal_points,
    plain_text,
    points,
    refuse_too_many,
)
from contactbench.pipeline.mesh.polygons import strip_triangles, triangulate

# `save_probe` writes it; merging or cleaning such a mesh again could renumber what a session refers to.
SETTLED = "contactbench probe 1"

# Numbers of regions follow it.
UNTOUCHABLE = "untouchable regions"

INDICES = "vertex_indices"

# Integers per facet that have a meaning here.
LABELS = ("region", "invented")

# Strips of triangles, each ended by -1, take the place of the facets in files of some scanners.
STRIPS = "tristrips"

INTEGERS = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "int64": "i8", "uint64": "u8",
}  # fmt: skip
KINDS = INTEGERS | {"float16": "f2", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}

ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}

_END = re.compile(rb"(?<=[\r\n])end_header[ \t]*(?:\r\n|\r|\n)")
# Real headers take a few hundred bytes; one of megabytes is no header.
_LONGEST = 2**16


@dataclass(frozen=True)
class Property:
    """
    One column of an element.

    Attributes
    ----------
    name : str
    kind : str
        Type of its numbers, as PLY names it.
    count_kind : str or None
        Type of the number that says how many follow, of a list.
    """

    name: str
    kind: str
    count_kind: str | None = None

    @property
    def fewest_bytes(self) -> int:
        """What a row of it takes at least, in a binary body."""
        return int(KINDS[self.count_kind or self.kind][1:])


@dataclass(frozen=True)
class Element:
    """Rows of the same properties; a facet's indices go by one name, whichever of two the file uses."""

    name: str
    count: int
    properties: tuple[Property, ...]


@dataclass(frozen=True)
class PlyHeader:
    """
    What a PLY header announces.

    Attributes
    ----------
    order : {"", "<", ">"}
        Byte order of the body; empty for text.
    elements : tuple of Element
        Those with rows, in the order of the body.
    settled : bool
        Written by `save_probe`.
    length : int
        Bytes of the header; the body follows.
    untouchable : tuple of int
        Regions that nothing can touch; only of a file that `save_probe` wrote.
    notes : tuple of str
        What was left out, in sentences.
    """

    order: str
    elements: tuple[Element, ...]
    settled: bool
    length: int
    untouchable: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def contents(self) -> str:
        """What is announced, in words."""
        return join(
            ", ",
            (message(f"{arg(element.count)} rows of '{arg(element.name)}'") for element in self.elements),
        )


def read_header(data: bytes) -> PlyHeader:
    """
    Read and check the header of a PLY file.

    Parameters
    ----------
    data : bytes
        The whole file.

    Returns
    -------
    PlyHeader
        With vertices that have numbers x, y and z, and facets that have a list of indices.

    Raises
    ------
    MeshError
        Not a PLY header, or one without vertices or facets, or with properties of an unsuitable type.
    """
    if not re.match(rb"ply[ \t]*[\r\n]", data):
        raise MeshError(
            "the first line is not 'ply': this is not a PLY file, choose another or export it again."
        )
    end = _END.search(data, 0, _LONGEST)
    if end is None:
        raise MeshError("the PLY header has no 'end_header' line: the file is cut short, export it again.")
    lines = re.split(r"\r\n|\r|\n", data[: end.start()].decode("latin-1"))[1:]
    order, settled = None, False
    untouchable: set[int] = set()
    elements: list[tuple[str, int, list[Property]]] = []
    for number, line in enumerate(lines, start=2):
        match line.split():
            case ["format", kind, "1.0" | "1.1"] if kind in ORDERS:
                order = ORDERS[kind]
            case ["element", name, count] if re.fullmatch("[0-9]{1,18}", count):
                elements.append((name, int(count), []))
            case ["property", *rest] if elements and (found := _property(rest, elements[-1][0])):
                elements[-1][2].append(found)
            case ["comment", "untouchable", "regions", *ranks] if settled and _are_ranks(ranks):
                untouchable.update(map(int, ranks))
            case ["comment" | "obj_info", *words] if not (settled and words[:2] == UNTOUCHABLE.split()):
                settled = settled or " ".join(words) == SETTLED
            case []:
                pass
            case _:
                raise MeshError(
                    f"line {arg(number)} of the PLY header, {arg(line[:60])!r}, cannot be used: export the file again."
                )
    if order is None:
        raise MeshError("the PLY header has no 'format' line: the file is damaged, export it again.")
    # Elements without rows take no bytes.
    rows = tuple(Element(name, count, _told_apart(columns)) for name, count, columns in elements if count)
    notes: list[str] = []
    if not settled:
        rows = tuple(_without_labels(element, notes) for element in rows)
    _check(rows)
    return PlyHeader(order, rows, settled, end.end(), tuple(sorted(untouchable)), tuple(notes))


def ignored(label: str) -> str:
    """Say that a property of somebody else's file, which has the name of one of ours, is left alone."""
    return message(f"The PLY face property '{arg(label)}' was not written by contactbench and was ignored.")


def _told_apart(columns: list[Property]) -> tuple[Property, ...]:
    """Name properties anew that have the name of one before and mean nothing here."""
    names = [column.name for column in columns]
    return tuple(
        replace(column, name=f"{column.name} {place}")
        if column.name in names[:place] and column.name not in (*"xyz", INDICES, *LABELS)
        else column
        for place, column in enumerate(columns)
    )


def _without_labels(element: Element, notes: list[str]) -> Element:
    """Name facet properties anew that cannot be labels of ours, and say so."""
    columns = list(element.properties)
    for place, column in enumerate(columns):
        if element.name == "face" and column.name in LABELS and not _is_label(column):
            columns[place] = replace(column, name=f"{column.name} {place}")
            notes.append(ignored(column.name))
    return replace(element, properties=tuple(columns))


def _is_label(column: Property) -> bool:
    return column.count_kind is None and column.kind in INTEGERS


def _are_ranks(words: list[str]) -> bool:
    return bool(words) and all(re.fullmatch("[1-9][0-9]{0,8}", word) for word in words)


def _property(words: list[str], element: str) -> Property | None:
    match words:
        case ["list", count_kind, kind, name] if count_kind in INTEGERS and kind in KINDS:
            same = element in ("face", STRIPS) and name in (INDICES, "vertex_index")
            return Property(INDICES if same else name, kind, count_kind)
        case [kind, name] if kind in KINDS:
            return Property(name, kind)
        case _:
            return None


def _check(elements: tuple[Element, ...]) -> None:
    """Refuse a header without vertices and facets, or with properties of an unsuitable type."""
    for element in elements:
        names = {prop.name for prop in element.properties}
        if not names or len(names) != len(element.properties):
            raise MeshError(
                f"the PLY element '{arg(element.name)}' has no property, or the same one twice: export"
                " the file again."
            )
    found = {element.name: {p.name: p for p in element.properties} for element in elements}
    if len(found) != len(elements):
        raise MeshError("the PLY header names an element twice: export the file again.")
    for axis in "xyz":
        prop = found.get("vertex", {}).get(axis)
        if prop is None or prop.count_kind:
            raise MeshError(
                f"the PLY file has no vertices with a number '{arg(axis)}': export it again as a mesh."
            )
    facets = found.get("face") or found.get(STRIPS, {})
    corners = facets.get(INDICES) or facets.get("vertex_index")
    if corners is None:
        raise MeshError("the PLY file holds no facets (a point cloud?): export it again as a surface.")
    if not corners.count_kind or corners.kind not in INTEGERS:
        raise MeshError("the PLY property 'vertex_indices' is not a list of integers: export the file again.")
    for name in LABELS:
        _check_label(facets.get(name))


def _check_label(prop: Property | None) -> None:
    if prop is not None and not _is_label(prop):
        use = message("0 for no region, 1 for the first priority") if prop.name == "region" else "0 or 1"
        raise MeshError(
            f"the PLY face property '{arg(prop.name)}' is {arg('a list' if prop.count_kind else prop.kind)}: save it as"
            f" int, {arg(use)}."
        )


def read_ply(data: bytes) -> RawMesh:
    """
    Read the content of a PLY file; polygons become triangles that share their polygon's region.

    Raises
    ------
    MeshError
        Not a PLY file, cut short, without facets, or with properties of an unsuitable type.
    """
    header = read_header(data)
    body = read_binary(header, data) if header.order else read_text(header, data)
    labels, notes = body.labels, header.notes + body.notes
    if not header.settled:
        foreign = [name for name, values in labels.items() if not _may_be_ours(name, values)]
        labels = {name: values for name, values in labels.items() if name not in foreign}
        notes += tuple(map(ignored, foreign))
    return RawMesh(
        body.vertices,
        body.faces,
        labels.get("region"),
        settled=header.settled,
        invented=labels.get("invented"),
        stated="m" if header.settled else None,
        untouchable=header.untouchable,
        notes=notes,
    )


def _may_be_ours(name: str, values: Longs) -> bool:
    most = np.iinfo(np.int32).max if name == "region" else 1
    return bool(((values >= 0) & (values <= most)).all())


def encode_ply(
    vertices: Floats,
    faces: Ints,
    region: Ints,
    invented: Mask,
    colours: npt.NDArray[np.uint8],
    untouchable: tuple[int, ...] = (),
) -> bytes:
    """
    Encode a mesh as binary little-endian PLY.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres in S; written as double, so nothing is rounded.
    faces : (m, 3) int32
        Vertex indices.
    region : (m,) int32
        Priority per facet, written as the property `region`.
    invented : (m,) bool
        Facets that the original did not hold, written as the property `invented`, 0 or 1.
    colours : (m, 3) uint8
        Red, green, blue per facet: for viewers, ignored when the file is read.
    untouchable : tuple of int
        Regions that nothing can touch, written as a comment of the header.

    Returns
    -------
    bytes
        The whole file.
    """
    fields = [("count", "u1"), ("vertex_indices", "<i4", (3,)), ("region", "<i4"), ("invented", "u1")]
    rows = np.empty(len(faces), dtype=[*fields, ("colour", "u1", (3,))])
    rows["count"], rows["vertex_indices"], rows["region"] = 3, faces, region
    rows["invented"], rows["colour"] = invented, colours
    hidden = " ".join([f"comment {UNTOUCHABLE}", *map(str, untouchable)]) + "\n" if untouchable else ""
    header = (
        f"ply\nformat binary_little_endian 1.0\ncomment {SETTLED}\ncomment metres\n{hidden}"
        f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty int region\n"
        "property uchar invented\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    )
    return header.encode("ascii") + vertices.astype("<f8").tobytes() + rows.tobytes()


# ---- the rows of a PLY file, binary and text -----------------------------------------------------


_ONE_NUMBER = re.compile(NUMBER)
_ONE_INTEGER = re.compile(rb"[+-]?\d{1,18}")
_ROW = re.compile(rb"^[^\n]+", re.M)


@dataclass(frozen=True, eq=False)
class PlyBody:
    """
    What the rows hold.

    Attributes
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
        Polygons as triangles; indices may be out of range.
    labels : dict of (m,) int64
        For each of `LABELS` that the file has.
    notes : tuple of str
        What was repaired or left out, in sentences.
    """

    vertices: Floats
    faces: Longs
    labels: dict[str, Longs]
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Lists:
    """The lists of a property, one after another, and how long each is."""

    values: Longs
    sizes: Longs


def _body(
    vertices: Floats, facets: _Lists, labels: dict[str, Longs], strips: bool, notes: tuple[str, ...]
) -> PlyBody:
    if strips:
        return PlyBody(vertices, _from_strips(facets), {}, notes)
    refuse_too_many(int(np.maximum(facets.sizes - 2, 0).sum()))
    done = triangulate(vertices, facets.values, facets.sizes)
    labels = {name: values[done.polygon] for name, values in labels.items()}
    return PlyBody(vertices, done.faces, labels, notes + done.notes)


def _from_strips(lists: _Lists) -> Longs:
    refuse_too_many(len(lists.values))
    # A list may hold several strips, with -1 between them.
    among = lists.values >= 0
    strip = np.repeat(np.arange(len(lists.sizes)), lists.sizes) + np.cumsum(~among)
    return strip_triangles(lists.values[among], strip[among])


# ---- binary ------------------------------------------------------------------------------------------


def read_binary(header: PlyHeader, data: bytes) -> PlyBody:
    """
    Read a binary body.

    Parameters
    ----------
    header : PlyHeader
        Of the file.
    data : bytes
        The whole file.

    Raises
    ------
    MeshError
        Fewer bytes than announced, or lists that the file cannot hold.
    """
    _refuse_short(header, len(data))
    blocks: dict[str, Mapping[str, Any]] = {}
    at = header.length
    for element in header.elements:
        blocks[element.name], at = _read_element(header, element, data, at)
    vertex, strips = blocks["vertex"], "face" not in blocks
    with np.errstate(invalid="ignore"):  # a signalling NaN; it is refused with its row later
        vertices = np.column_stack([vertex[axis].astype(np.float64) for axis in "xyz"])
    facets = blocks[STRIPS if strips else "face"]
    labels = {name: facets[name].astype(np.int64) for name in LABELS if name in facets}
    left = len(data) - at
    notes = (
        ()
        if not left
        else (message(f"Bytes after the last row of the PLY file were left out (bytes: {arg(left)})."),)
    )
    return _body(vertices, facets[INDICES], labels, strips, notes)


def _read_element(
    header: PlyHeader, element: Element, data: bytes, at: int
) -> tuple[Mapping[str, npt.NDArray[Any] | _Lists], int]:
    """Read the rows that begin at a byte: what each property of use holds, and where they end."""
    dtype = _row_type(header, element, data, at)
    end = at + element.count * dtype.itemsize
    if end <= len(data):
        block = np.frombuffer(data, dtype, element.count, at)
        if all(
            np.all(block[f"{p.name} count"] == dtype[p.name].shape[0])
            for p in element.properties
            if p.count_kind
        ):
            return _even(element, block), end
    elif not any(prop.count_kind for prop in element.properties):
        raise _short(header, end - header.length, len(data))
    return _uneven(header, element, data, at)


def _even(element: Element, block: npt.NDArray[Any]) -> dict[str, npt.NDArray[Any] | _Lists]:
    found: dict[str, npt.NDArray[Any] | _Lists] = {}
    for prop in element.properties:
        if prop.count_kind is None:
            found[prop.name] = block[prop.name]
        elif prop.name == INDICES:
            size = block[prop.name].shape[1]
            found[prop.name] = _Lists(block[prop.name].astype(np.int64).ravel(), np.full(len(block), size))
    return found


def _uneven(
    header: PlyHeader, element: Element, data: bytes, at: int
) -> tuple[dict[str, npt.NDArray[Any] | _Lists], int]:
    """Read rows whose lists differ in length, so that each row tells where the next begins."""
    found: dict[str, array[Any]] = {}
    plan = []
    for prop in element.properties:
        kind = np.dtype(KINDS[prop.kind])
        count = (
            struct.Struct(header.order + np.dtype(KINDS[prop.count_kind]).char) if prop.count_kind else None
        )
        kept = None
        if prop.name in ((INDICES,) if count else (*LABELS, *"xyz")):
            kept = found[prop.name] = array("q" if count else "d")
        plan.append((count, kind.char, kind.itemsize, kept))
    sizes = array("q")
    for _ in range(element.count):
        for count, char, width, kept in plan:
            length = 1
            if count:
                if at + count.size > len(data):
                    raise _short(header, at + count.size - header.length, len(data))
                (length,) = count.unpack_from(data, at)
                at += count.size
            end = at + length * width
            if length < 0 or end > len(data):
                raise _absurd(element, length) if count else _short(header, end - header.length, len(data))
            if kept is not None:
                kept.extend(struct.unpack_from(f"{header.order}{length}{char}", data, at))
                if count:
                    sizes.append(length)
            at = end
    columns: dict[str, npt.NDArray[Any] | _Lists] = {
        name: np.frombuffer(kept) for name, kept in found.items()
    }
    if INDICES in found:
        refuse_too_many(len(found[INDICES]) // 4)
        columns[INDICES] = _Lists(np.frombuffer(found[INDICES], np.int64), np.frombuffer(sizes, np.int64))
    return columns, at


def _refuse_short(header: PlyHeader, size: int) -> None:
    needed = sum(e.count * sum(p.fewest_bytes for p in e.properties) for e in header.elements)
    if needed > size - header.length:
        raise _short(header, needed, size)


def _short(header: PlyHeader, needed: int, size: int) -> MeshError:
    return MeshError(
        f"the PLY header announces {arg(header.contents)}, at least {arg(needed)} bytes, but"
        f" {arg(size - header.length)} follow: the file is cut short, copy or export it again."
    )


def _absurd(element: Element, length: int) -> MeshError:
    return MeshError(
        f"a list of the PLY element '{arg(element.name)}' announces {arg(length)} numbers that the file does"
        " not contain: it is damaged or cut short, copy or export it again."
    )


def _row_type(header: PlyHeader, element: Element, data: bytes, at: int) -> np.dtype[Any]:
    """Type of one row, with lists as long as in the first row, which begins at a byte of the file."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    begin = at
    for prop in element.properties:
        kind = np.dtype(header.order + KINDS[prop.kind])
        if prop.count_kind is None:
            fields.append((prop.name, kind.str))
            begin += kind.itemsize
            continue
        count = np.dtype(header.order + KINDS[prop.count_kind])
        if begin + count.itemsize > len(data):
            raise _short(header, begin + count.itemsize - header.length, len(data))
        length = int(np.frombuffer(data, count, 1, begin)[0])
        begin += count.itemsize + length * kind.itemsize
        # Refused before a type is made of it: those have limits of their own.
        if length < 0 or begin > len(data):
            raise _absurd(element, length)
        fields += [(f"{prop.name} count", count.str), (prop.name, kind.str, (length,))]
    return np.dtype(fields)


# ---- text --------------------------------------------------------------------------------------------


def read_text(header: PlyHeader, data: bytes) -> PlyBody:
    """
    Read a text body.

    Parameters
    ----------
    header : PlyHeader
        Of the file.
    data : bytes
        The whole file.

    Raises
    ------
    MeshError
        Fewer rows than announced, or a row that does not hold the numbers it should.
    """
    body, notes = decimal_points(plain_text(data[header.length :]), _ROW)
    announced = sum(element.count for element in header.elements)
    rows = sum(1 for _ in _rows(body))
    if rows != announced and (laid_out := _one_a_row(header, body)) is not None:
        body, rows = laid_out, announced
    if rows < announced:
        raise MeshError(
            f"the PLY header announces {arg(header.contents)}, but {arg(rows)} rows follow it: the file is cut short or"
            " damaged, copy or export it again."
        )
    if rows > announced:
        notes += (
            message(
                f"Rows after the last that the PLY header announces were left out (rows: {arg(rows - announced)})."
            ),
        )
    strips = all(element.name != "face" for element in header.elements)
    coordinates, corners, sizes = array("d"), array("q"), array("q")
    labels = {name: array("q") for name in LABELS}
    stream = _rows(body)
    facets = 0
    for element in header.elements:
        fields_of = _RowReader(element)
        for number, row in zip(range(element.count), stream, strict=False):
            if element.name == "vertex":
                fields = fields_of(row, number)
                coordinates.extend((float(fields["x"][0]), float(fields["y"][0]), float(fields["z"][0])))
            elif element.name == (STRIPS if strips else "face"):
                fields = fields_of(row, number)
                corners.extend(map(int, fields[INDICES]))
                sizes.append(len(fields[INDICES]))
                for name in LABELS:
                    labels[name].extend(map(int, fields.get(name, ())))
                facets += max(len(fields[INDICES]) - 2, 0)
                refuse_too_many(facets)
        notes += fields_of.notes
    present = {name: np.frombuffer(values, np.int64) for name, values in labels.items() if values}
    lists = _Lists(np.frombuffer(corners, np.int64), np.frombuffer(sizes, np.int64))
    return _body(points(coordinates), lists, present, strips, notes)


def _rows(body: bytes) -> Iterator[bytes]:
    return (row for row in io.BytesIO(body) if not row.isspace())


def _one_a_row(header: PlyHeader, body: bytes) -> bytes | None:
    """Lay out rows that stand on other lines than usual; None unless the numbers are just as many as announced."""
    words = (word for row in _rows(body) for word in row.split())
    out = bytearray()
    for element in header.elements:
        for _ in range(element.count):
            row: list[bytes] = []
            for prop in element.properties:
                length = 1
                if prop.count_kind:
                    row += islice(words, 1)
                    if not row or not _ONE_INTEGER.fullmatch(row[-1]):
                        return None
                    length = max(int(row[-1]), 0)
                before = len(row)
                row += islice(words, length)
                if len(row) - before != length:
                    return None
            out += b" ".join(row) + b"\n"
    return bytes(out) if next(words, None) is None else None


def _is_integer(prop: Property) -> bool:
    """Whether only an integer will do in a text: numbers that nobody looks at may be written in any way."""
    return prop.kind in INTEGERS and prop.name in (INDICES, *LABELS)


class _RowReader:
    """Numbers per property of one text row after another, triangles quickly."""

    def __init__(self, element: Element) -> None:
        self._element = element
        # A row with a list may be as long as one that is damaged.
        self._surplus = 0 if any(prop.count_kind for prop in element.properties) else None
        self._places: dict[str, slice] = {}
        self._quick: re.Pattern[bytes] | None = None
        parts: list[bytes] = []
        place = 0
        for prop in element.properties:
            if prop.count_kind and prop.name != INDICES:
                return
            length = 3 if prop.count_kind else 1
            number = rb"([+-]?\d{1,18})" if _is_integer(prop) else rb"(" + NUMBER + rb")"
            parts += [rb"3"] * bool(prop.count_kind) + [number] * length
            self._places[prop.name] = slice(place, place + length)
            place += length
        self._quick = re.compile(rb"\s*" + rb"\s+".join(parts) + rb"\s*")

    def __call__(self, row: bytes, number: int) -> dict[str, Sequence[bytes]]:
        match = self._quick and self._quick.fullmatch(row)
        if match and not self._surplus:
            self._surplus = 0
            groups = match.groups()
            return {name: groups[place] for name, place in self._places.items()}
        words = row.split()
        fields, used = _fields(self._element, words, number)
        if self._surplus is None:
            self._surplus = len(words) - used
        # As many in every row are a column that the header forgot; in one row they are damage.
        if self._surplus != len(words) - used:
            raise _bad_row(self._element, words, number)
        return fields

    @property
    def notes(self) -> tuple[str, ...]:
        """What was left out, in sentences."""
        if not self._surplus:
            return ()
        name, count = self._element.name, self._surplus
        return (
            message(
                f"Rows of the PLY element '{arg(name)}' end in numbers that the header does not list; these"
                f" were left out (per row: {arg(count)})."
            ),
        )


def _fields(element: Element, row: list[bytes], number: int) -> tuple[dict[str, Sequence[bytes]], int]:
    """Numbers per property of one text row, and how many of its words they take."""
    fields: dict[str, Sequence[bytes]] = {}
    position = 0
    for prop in element.properties:
        length = 1
        if prop.count_kind:
            counted = row[position : position + 1]
            if not counted or not _ONE_INTEGER.fullmatch(counted[0]):
                raise _bad_row(element, row, number)
            length = int(counted[0])
            position += 1
        values = row[position : position + max(length, 0)]
        position += length
        pattern = _ONE_INTEGER if _is_integer(prop) else _ONE_NUMBER
        if len(values) != length or not all(map(pattern.fullmatch, values)):
            raise _bad_row(element, row, number)
        fields[prop.name] = values
    return fields, position


def _bad_row(element: Element, row: list[bytes], number: int) -> MeshError:
    return broken(
        message(f"row {arg(number)} of the PLY element '{arg(element.name)}'"),
        b" ".join(row),
        message(
            f"row {arg(number)} of the PLY element '{arg(element.name)}' does not contain the numbers that the"
            " header announces: the file is damaged, export it again."
        ),
    )
