"""The header of a PLY file: which elements follow, how many rows of which properties each."""

import re
from dataclasses import dataclass, replace

from contactbench.pipeline.errors import MeshError, arg, join, message

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
