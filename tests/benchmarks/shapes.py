"""Mesh files as people send them, with the outside that a finger can touch known of each; millimetres."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets

from .solids import (
    Box,
    Mesh,
    arc,
    blocks,
    box,
    capsule,
    compact,
    globe,
    joined,
    lathe,
    rolled_up,
    single,
    split_long,
    torus,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from .solids import Floats

_STL_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
REAL = Path(__file__).parents[3] / "shared" / "data" / "probes"


@dataclass(frozen=True, eq=False)
class Shape:
    """A file to prepare, and what is true of it."""

    name: str
    file: Mesh | bytes  # What is written, as binary STL where it is a mesh
    outside: Mesh  # All that can be touched: touches are drawn on it, and the result should lie on it
    # The closed body behind it, where it is known: contacts on it err as little as they can
    solid: Mesh | None
    closed: bool = True  # The file says all about its outside, so nothing need be invented
    # `outside` is no more than the outside, and faces out; otherwise it is the file, inner walls and all
    known: bool = True
    suffix: str = ".stl"
    partly: bool = False  # `outside` is only a part of the outside
    oriented: bool = True  # The file's own facets face out, where they are outside
    body: bool = True  # Something can be made of it; otherwise it must be refused, in words

    def write(self, folder: Path) -> Path:
        """Write the file into a folder."""
        path = folder / (self.name + self.suffix)
        path.write_bytes(self.file if isinstance(self.file, bytes) else stl(self.file))
        return path


def stl(mesh: Mesh) -> bytes:
    """Give a mesh as a binary STL file."""
    records = np.zeros(len(mesh.faces), _STL_FACET)
    records["corners"] = mesh.corners
    return bytes(80) + np.uint32(len(records)).tobytes() + records.tobytes()


def obj(vertices: Floats, polygons: list[list[int]]) -> bytes:
    """Give polygons as an OBJ file."""
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices.tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in polygon) for polygon in polygons]
    return "\n".join([*lines, ""]).encode()


def ply(vertices: Floats, polygons: list[list[int]]) -> bytes:
    """Give polygons as a binary PLY file; a list of two lengths is what many programs write."""
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(polygons)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    faces = b"".join(bytes([len(p)]) + np.array(p, "<i4").tobytes() for p in polygons)
    return header.encode() + vertices.astype("<f4").tobytes() + faces


_SHAPES: dict[str, Callable[[], Shape]] = {}


def _shape(make: Callable[[], Shape]) -> Callable[[], Shape]:
    _SHAPES[make.__name__.strip("_").replace("_", "-")] = make
    return make


def _sound(mesh: Mesh, **more: object) -> Shape:
    """Describe a mesh that needs nothing."""
    return replace(Shape("", mesh, mesh, mesh), **more)  # type: ignore[arg-type]


def names() -> tuple[str, ...]:
    """List all shapes that can be made here."""
    return tuple(name for name in _SHAPES if not name.startswith("real-") or REAL.is_dir())


@cache
def make(name: str) -> Shape:
    """Make a shape."""
    return replace(_SHAPES[name](), name=name)


# --- thin parts -----------------------------------------------------------------------------------------------------


@_shape
def needle() -> Shape:
    """1 mm thick, 60 mm long, with a tip, on a hub."""
    hub = [(0, 0), (6, 0), *((6, z) for z in (5, 10)), (6, 15), (3, 18), (0.5, 20)]
    shaft = [(0.5, z) for z in range(22, 76, 2)]
    return _sound(lathe([*hub, *shaft, (0.25, 78), (0, 80)], 48))


@_shape
def blade() -> Shape:
    """A scalpel: 0.3 mm of steel, sharpened to 0.03 mm, in a handle of 4 mm."""
    mesh = blocks(
        Box((-5, 5), (-2, 2), (0, 70)), Box((-4, 4), (-0.15, 0.15), (70, 105)), steps=(1.0, 4.0, 2.5)
    )

    def ground(p: Floats) -> Floats:
        p = p.copy()
        steel = p[:, 2] > 70
        # Sharpened over the last 2 mm of the edge, and slanted towards the tip.
        thin = np.clip((4 - p[:, 0]) / 2, 0.1, 1)
        p[steel, 1] *= thin[steel]
        p[steel, 2] -= (0.6 * (p[:, 0] + 4) * (p[:, 2] - 70) / 35)[steel]
        return p

    return _sound(mesh.warped(ground))


@_shape
def fin() -> Shape:
    """A round body with a fin of 0.8 mm, 12 mm high."""
    width = np.degrees(0.8 / 15)
    flat = blocks(
        Box((0, 360), (0.5, 15), (0, 80)),
        Box((90 - width / 2, 90 + width / 2), (15, 27), (20, 60)),
        steps=(6, 15, 5),
        around=True,
    )
    # As thick at its top as at its foot.
    points = flat.vertices.copy()
    above = points[:, 1] > 15
    points[above, 0] = 90 + (points[above, 0] - 90) * 15 / points[above, 1]
    return _sound(rolled_up(Mesh(points, flat.faces)))


@_shape
def comb() -> Shape:
    """Ribs of 0.8 mm with gaps of 0.8 mm on a plate."""
    ribs = [Box((x, x + 0.8), (5, 25), (10, 16)) for x in np.arange(2, 38, 1.6).tolist()]
    return _sound(blocks(Box((0, 40), (0, 30), (0, 10)), *ribs, step=5))


@_shape
def cone() -> Shape:
    """A sharp tip."""
    return _sound(lathe([(0, 0), (15, 0), *((15 - 15 * z / 60, z) for z in range(5, 60, 5)), (0, 60)], 60))


# --- holes that are meant ---------------------------------------------------------------------------------------------


@_shape
def pipe() -> Shape:
    """Open at both ends, with a wall of 2 mm: a ring, not a vessel."""
    heights = np.linspace(0, 80, 17).tolist()
    return _sound(lathe([*((16, z) for z in heights), *((14, z) for z in heights[::-1])], 72))


@_shape
def thin_tube() -> Shape:
    """A cannula of 3 mm with a wall of 0.25 mm."""
    heights = np.linspace(0, 70, 36).tolist()
    return _sound(lathe([*((1.5, z) for z in heights), *((1.25, z) for z in heights[::-1])], 36))


@_shape
def ring() -> Shape:
    """A torus."""
    return _sound(torus(25, 8))


@_shape
def thin_ring() -> Shape:
    """A hoop of wire, 1.6 mm thick."""
    return _sound(torus(20, 0.8, 120))


@_shape
def grooves() -> Shape:
    """Grooves of 1, 2, 3 and 4 mm, 3 mm deep, in a plate."""
    cuts, x = [], 5.0
    for width in (1, 2, 3, 4):
        cuts.append(Box((x, x + width), (0, 40), (9, 12), air=True))
        x += width + 5
    return _sound(blocks(Box((0, x), (0, 40), (0, 12)), *cuts, step=5))


@_shape
def slots() -> Shape:
    """Slots of 1, 2, 3 and 4 mm right through a plate."""
    cuts, x = [], 5.0
    for width in (1, 2, 3, 4):
        cuts.append(Box((x, x + width), (8, 32), (0, 12), air=True))
        x += width + 5
    return _sound(blocks(Box((0, x), (0, 40), (0, 12)), *cuts, step=5))


@_shape
def round_grooves() -> Shape:
    """Grooves of 1, 2, 3 and 4 mm all round a rod."""
    profile, z = [(0.0, 0.0), (14.0, 0.0)], 8.0
    for width in (1, 2, 3, 4):
        profile += [(14, z), (12, z), (12, z + width), (14, z + width)]
        z += width + 8
    return _sound(lathe([*profile, (14, z), (0, z)], 72))


@_shape
def cable_channel() -> Shape:
    """A blind hole of 6 mm, 40 mm deep, from below: meant, and closed."""
    heights = np.linspace(0, 90, 19).tolist()
    bore = [(3.0, z) for z in np.linspace(40, 0, 9).tolist()]
    return _sound(lathe([(0, 40), *bore, *((15, z) for z in heights), *arc(15, (0, 90), 0, 90, 12)[1:]], 60))


@_shape
def undercut() -> Shape:
    """A T-slot: what lies under its lips sees hardly any sky."""
    return _sound(
        blocks(
            Box((0, 40), (0, 60), (0, 20)),
            Box((17, 23), (0, 60), (14, 20), air=True),
            Box((12, 28), (0, 60), (8, 14), air=True),
            step=4,
        )
    )


# --- letters ----------------------------------------------------------------------------------------------------------

_LETTERS = {
    "E": ("11111", "10000", "11110", "10000", "11111"),
    "C": ("11111", "10000", "10000", "10000", "11111"),
    "H": ("10001", "10001", "11111", "10001", "10001"),
    "O": ("11111", "10001", "10001", "10001", "11111"),
}


def _letters(at: tuple[float, float], stroke: float, across: tuple[float, float], *, air: bool) -> list[Box]:
    """Write ECHO along x and z; `across` is how far it reaches in y; all letters share the grid's lines."""
    found = []
    for number, letter in enumerate("ECHO"):
        for row, bits in enumerate(_LETTERS[letter]):
            for column, bit in enumerate(bits):
                if bit == "1":
                    x, z = at[0] + stroke * (6 * number + column), at[1] + stroke * (4 - row)
                    found.append(Box((x, x + stroke), across, (z, z + stroke), air))
    return found


@_shape
def letters_sunk() -> Shape:
    """Letters of 1 mm strokes, 0.6 mm deep, in a round handle."""
    stroke = 1.0
    degrees = np.degrees(stroke / 15)
    cuts = [
        Box(
            (40 + degrees * (b.x[0] - 40) / stroke, 40 + degrees * (b.x[1] - 40) / stroke), b.y, b.z, air=True
        )
        for b in _letters((40, 50), stroke, (14.4, 15), air=True)
    ]
    body = Box((0, 360), (0.5, 15), (0, 80))
    return _sound(rolled_up(blocks(body, *cuts, steps=(5, 15, 4), around=True)))


def _plate_with_letters() -> tuple[Box, list[Box]]:
    return Box((0, 40), (0, 12), (0, 30)), _letters((8, 12), 1.0, (11, 12.8), air=False)


@_shape
def letters_raised() -> Shape:
    """Letters that stand out by 0.8 mm, of one piece with their plate."""
    plate, letters = _plate_with_letters()
    return _sound(blocks(plate, *letters, step=4))


@_shape
def letters_on_top() -> Shape:
    """The same letters, each a solid of its own that reaches into the plate, as CAD programs export them."""
    plate, letters = _plate_with_letters()
    solid = blocks(plate, *letters, step=4)
    several = [blocks(*(b for b in letters if 8 + 6 * i <= b.x[0] < 13 + 6 * i)) for i in range(4)]
    return Shape("", joined(blocks(plate), *several), solid, solid)


# --- several solids in one file ---------------------------------------------------------------------------------------


@_shape
def two_near() -> Shape:
    """Two halves 0.2 mm apart."""
    mesh = joined(box((0, 30), (0, 20), (0, 29.9), 5), box((0, 30), (0, 20), (30.1, 60), 5))
    return _sound(mesh)


@_shape
def overlapping_boxes() -> Shape:
    """Two bars through each other."""
    a, b = Box((0, 20), (0, 20), (0, 80)), Box((-30, 50), (5, 15), (60, 72))
    solid = blocks(a, b, step=6)
    return Shape("", joined(blocks(a, step=7), blocks(b, step=9)), solid, solid)


@_shape
def overlapping_rounds() -> Shape:
    """A round head through a bar at a slant: the facets cross anyhow."""
    head = globe(3000, lambda d: d * [24, 14, 12]).moved(3.3, 1.7, 78.1)
    bar = capsule(9, 70, 60)
    # What is in the other body cannot be touched.
    in_bar = _inside_capsule(head, 9, 70)
    at = (bar.corners - [3.3, 1.7, 78.1]) / [24, 14, 12]
    in_head = (np.linalg.norm(at, axis=2) < 1.05).any(axis=1)
    return Shape("", joined(bar, head), joined(bar.chosen(~in_head), head.chosen(~in_bar)), None, partly=True)


def _inside_capsule(mesh: Mesh, radius: float, length: float) -> np.ndarray:
    along = np.clip(mesh.corners[..., 2], 0, length)
    axis = np.stack([np.zeros_like(along), np.zeros_like(along), along], -1)
    return np.asarray((np.linalg.norm(mesh.corners - axis, axis=2) < radius * 1.05).any(axis=1))


@_shape
def touching_boxes() -> Shape:
    """Two boxes that share a whole face."""
    a, b = Box((0, 30), (0, 20), (0, 40)), Box((0, 30), (0, 20), (40, 70))
    solid = blocks(a, b, step=10)
    return Shape("", joined(blocks(a, step=10), blocks(b, step=10)), solid, solid)


@_shape
def standing_box() -> Shape:
    """A box that stands on the middle of a larger one's face."""
    a, b = Box((0, 40), (0, 30), (0, 30)), Box((12, 27), (9, 21), (30, 70))
    solid = blocks(a, b, step=8)
    return Shape("", joined(blocks(a, step=8), blocks(b, step=5)), solid, solid)


@_shape
def cubes_on_an_edge() -> Shape:
    """Two cubes that share one edge, which four facets have."""
    return _sound(blocks(Box((0, 30), (0, 30), (0, 40)), Box((30, 60), (30, 60), (0, 40)), step=10))


@_shape
def cubes_on_a_corner() -> Shape:
    """Two cubes that share one vertex."""
    mesh = joined(box((0, 30), (0, 30), (0, 30), 10), box((30, 60), (30, 60), (30, 60), 10))
    points, index = np.unique(mesh.vertices, axis=0, return_inverse=True)
    return _sound(Mesh(points, index.reshape(-1)[mesh.faces].astype(np.int32)))


@_shape
def nested_cubes() -> Shape:
    """A cube in a cube, both facing out: the inner one cannot be touched."""
    outer = box((0, 50), (0, 50), (0, 60), 10)
    return Shape("", joined(outer, box((15, 35), (15, 35), (15, 40), 5)), outer, outer)


@_shape
def sealed_hollow() -> Shape:
    """A wall of 2 mm round nothing: the inside faces in, and cannot be touched."""
    outer = capsule(15, 70, 60)
    return Shape("", joined(outer, capsule(13, 70, 60).flipped()), outer, outer)


@_shape
def inner_parts() -> Shape:
    """A hollow body with a board and three screws in it."""
    outer = capsule(18, 80, 60)
    hollow = capsule(16, 80, 60).flipped()
    board = box((-10, 10), (-0.8, 0.8), (5, 75), 6)
    screws = [capsule(1.5, 12, 16).moved(6, 5, z) for z in (10, 35, 60)]
    return Shape("", joined(outer, hollow, board, *screws), outer, outer)


@_shape
def many_overlaps() -> Shape:
    """Sixteen slanted bars through a ball, and through each other."""
    ball = globe(1500, lambda d: d * 18)
    rng = np.random.default_rng(7)
    bars = []
    for _ in range(16):
        turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))
        bars.append(box((-2, 2), (-2.5, 2.5), (-26, 26), 4).warped(lambda p, turn=turn: p @ turn.T))
    # Ends that reach out of the ball are outside, but where bars cross: touches are drawn on the ends only.
    ends = [bar.chosen((np.linalg.norm(bar.corners, axis=2) > 22).all(axis=1)) for bar in bars]
    return Shape("", joined(ball, *bars), joined(*ends), None, partly=True)


@_shape
def nearly_coplanar() -> Shape:
    """Two bars of one width through each other; one is turned by a hundredth of a degree."""
    a, b = box((0, 20), (0, 20), (0, 80), 10), box((-30, 50), (0, 20), (50, 70), 10)
    turn = np.radians(0.01)

    def turned(p: Floats) -> Floats:
        x, y, z = (p - [10, 10, 60]).T
        moved = np.column_stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z])
        return moved + [10, 10, 60]

    solid = blocks(Box((0, 20), (0, 20), (0, 80)), Box((-30, 50), (0, 20), (50, 70)), step=10)
    return Shape("", joined(a, b.warped(turned)), solid, solid)


@_shape
def one_part_inverted() -> Shape:
    """Two bars through each other, one of them inside out."""
    a, b = Box((0, 20), (0, 20), (0, 80)), Box((-30, 50), (5, 15), (60, 72))
    solid = blocks(a, b, step=6)
    return Shape("", joined(blocks(a, step=7), blocks(b, step=9).flipped()), solid, solid, oriented=False)


@_shape
def clam_shells() -> Shape:
    """A housing of two hollow halves, each closed, with a parting gap of 0.1 mm."""
    outside = box((-15, 15), (-12, 12), (0, 80), 5)
    lower = blocks(Box((-15, 15), (-12, -0.05), (0, 80)), Box((-13, 13), (-10, 0), (2, 78), air=True), step=5)
    upper = blocks(Box((-15, 15), (0.05, 12), (0, 80)), Box((-13, 13), (0, 10), (2, 78), air=True), step=5)
    return Shape("", joined(lower, upper), outside, outside, closed=False)


@_shape
def vented() -> Shape:
    """A hollow body with a vent of 1 mm: closed as a surface, but no finger gets in."""
    outer = [*((15.0, z) for z in np.linspace(0, 70, 15).tolist()), *arc(15, (0, 70), 0, 90, 14)[1:]]
    inner = [*arc(12, (0, 70), 90, 0, 12), *((12.0, z) for z in np.linspace(65, 5, 13).tolist()), (12.0, 3.0)]
    solid = lathe([(0.0, 0.0), (0.5, 0.0), *outer], 60)
    vent = np.linalg.norm(solid.corners[..., :2], axis=2).max(axis=1) < 0.6
    vent &= (solid.corners[..., 2] == 0).all(axis=1)
    skin = lathe([*inner, (0.5, 3.0), (0.5, 0.0), *outer], 60)
    return Shape("", skin, solid.chosen(~vent), solid, closed=False)


# --- spoilt on the way ------------------------------------------------------------------------------------------------


def _bar() -> Mesh:
    """Make a bar with a head, neither round nor convex."""
    return capsule(12, 70, 48).warped(
        lambda p: p * np.column_stack([1 + 0.6 / (1 + np.exp((60 - p[:, 2]) / 3)), np.ones((len(p), 2))])
    )


@_shape
def doubled() -> Shape:
    """Every facet twice."""
    mesh = _bar()
    return Shape("", Mesh(mesh.vertices, np.repeat(mesh.faces, 2, axis=0)), mesh, mesh)


@_shape
def flipped() -> Shape:
    """All facets face in."""
    mesh = _bar()
    return Shape("", mesh.flipped(), mesh, mesh, oriented=False)


@_shape
def some_flipped() -> Shape:
    """Every twentieth facet faces in."""
    mesh = _bar()
    faces = mesh.faces.copy()
    faces[::20] = faces[::20, ::-1]
    return Shape("", Mesh(mesh.vertices, faces), mesh, mesh, oriented=False)


@_shape
def back_to_back() -> Shape:
    """Every facet, and once more the other way round."""
    mesh = _bar()
    return Shape("", joined(mesh, mesh.flipped()), mesh, mesh, oriented=False)


@_shape
def missing_facets() -> Shape:
    """Eight single facets and two patches are missing."""
    mesh = split_long(_bar(), 3.0)
    rng = np.random.default_rng(1)
    keep = np.ones(len(mesh.faces), bool)
    keep[rng.choice(len(keep), 8, replace=False)] = False
    middles = mesh.corners.mean(axis=1)
    for centre in middles[rng.choice(len(middles), 2, replace=False)]:
        keep &= np.linalg.norm(middles - centre, axis=1) > 4
    return Shape("", mesh.chosen(keep), mesh.chosen(keep), mesh, closed=False)


@_shape
def unsewn() -> Shape:
    """Patches that were never sewn: along their seams the points are 2 µm apart."""
    mesh = split_long(_bar(), 4.0)
    heights = mesh.corners[..., 2].mean(axis=1)
    angles = np.arctan2(*mesh.corners.mean(axis=1)[:, 1::-1].T)
    patch = (heights // 15).astype(int) * 6 + ((angles + np.pi) // (np.pi / 3)).astype(int)
    rng = np.random.default_rng(2)
    patches = [compact(mesh.chosen(patch == number)) for number in np.unique(patch)]
    return Shape(
        "",
        joined(*(p.warped(lambda v: v + rng.uniform(-0.001, 0.001, v.shape)) for p in patches)),
        mesh,
        mesh,
    )


@_shape
def t_junctions() -> Shape:
    """A box whose sides were meshed each for itself: points of one lie on the edges of the other."""
    solid = box((0, 30), (0, 20), (0, 80))
    fine, coarse = box((0, 30), (0, 20), (0, 80), 3.0), box((0, 30), (0, 20), (0, 80), 7.0)
    top, rest = _facing(fine, 2), _facing(coarse, 2)
    return Shape("", joined(compact(fine.chosen(top)), compact(coarse.chosen(~rest))), solid, solid)


def _facing(mesh: Mesh, axis: int) -> np.ndarray:
    crosses = mesh.crosses
    return np.asarray(np.abs(crosses[:, axis]) > 0.99 * np.linalg.norm(crosses, axis=1))


@_shape
def slivers() -> Shape:
    """Facets ten thousand times longer than high, as CAD kernels make along fillets."""
    mesh = _bar()
    faces, vertices = [], [mesh.vertices]
    rng = np.random.default_rng(3)
    chosen = np.zeros(len(mesh.faces), bool)
    chosen[rng.choice(len(chosen), 200, replace=False)] = True
    a, b, c = mesh.faces[chosen].T
    middle = 0.5 * (mesh.vertices[a] + mesh.vertices[b])
    new = len(mesh.vertices) + np.arange(len(a), dtype=np.int32)
    vertices.append(single(middle + 1e-4 * (mesh.vertices[c] - middle)))
    faces = [
        mesh.faces[~chosen],
        np.stack([a, b, new], 1),
        np.stack([b, c, new], 1),
        np.stack([c, a, new], 1),
    ]
    return Shape("", Mesh(np.concatenate(vertices), np.concatenate(faces)), mesh, mesh)


@_shape
def zero_area() -> Shape:
    """2.6 % of the facets have no area: two of their corners are one point."""
    mesh = _bar()
    extra = mesh.faces[:: len(mesh.faces) // max(1, int(0.026 * len(mesh.faces)))]
    flat = extra[:, [0, 1, 1]]
    return Shape("", joined(mesh.soup(), Mesh(mesh.vertices, flat).soup()), mesh, mesh)


@_shape
def trailing_bytes() -> Shape:
    """Four bytes more than an STL file should have."""
    mesh = _bar()
    return Shape("", stl(mesh) + b"\0\0\0\0", mesh, mesh)


@_shape
def doubled_apart() -> Shape:
    """Every facet twice, the second time 5 µm further out: exported twice with other settings."""
    mesh = _bar()
    return Shape("", joined(mesh, mesh.warped(lambda p: (p - [0, 0, 35]) * 1.0001 + [0, 0, 35])), mesh, mesh)


@_shape
def spindle() -> Shape:
    """A skin that passes through itself: a ring too fat for its hole, as turned profiles give."""
    angles = np.radians(np.linspace(0, 360, 33)[:-1])
    profile = [(12 + 16 * np.cos(a), 40 + 16 * np.sin(a)) for a in angles.tolist()]
    mesh = lathe(profile, 60)
    outer = mesh.chosen((np.linalg.norm(mesh.corners[..., :2], axis=2) > 0.5).all(axis=1) & _outward(mesh))
    return Shape("", mesh, outer, None, partly=True)


def _outward(mesh: Mesh) -> np.ndarray:
    """Tell which facets face away from the axis or along it, beyond the lens in the middle of a spindle."""
    middles = mesh.corners.mean(axis=1)
    return np.asarray(np.abs(np.linalg.norm(middles[:, :2], axis=1) - 12) < 17) & (
        np.einsum("ni,ni->n", mesh.crosses[:, :2], middles[:, :2])
        > -0.2 * np.linalg.norm(mesh.crosses, axis=1)
    )


@_shape
def far_away() -> Shape:
    """A metre from the file's origin, so that its digits are coarser."""
    return _sound(_bar().moved(1000, -700, 900))


# --- polygons ---------------------------------------------------------------------------------------------------------


@_shape
def l_prism() -> Shape:
    """An L whose ends are one concave polygon each, the first corner chosen so that a fan of it leaves the L."""
    outline = np.array([(0, 0), (40, 0), (40, 10), (10, 10), (10, 30), (0, 30)], float)[[1, 2, 3, 4, 5, 0]]
    n, height = len(outline), 60.0
    vertices = np.concatenate([np.column_stack([outline, np.full(n, z)]) for z in (0.0, height)])
    ring = list(range(n))
    polygons = [ring[::-1], [i + n for i in ring], *([i, (i + 1) % n, (i + 1) % n + n, i + n] for i in ring)]
    solid = blocks(Box((0, 40), (0, 10), (0, 60)), Box((0, 10), (0, 30), (0, 60)), step=10)
    return Shape("", obj(vertices, polygons), solid, solid, suffix=".obj")


@_shape
def mixed_polygons() -> Shape:
    """Triangles and quads in one binary PLY."""
    mesh = box((0, 30), (0, 20), (0, 80), 10)
    half = len(mesh.faces) // 2
    quads = np.column_stack([mesh.faces[:half], mesh.faces[half:, 2]])
    polygons = quads[::2].tolist()
    for quad in quads[1::2].tolist():
        polygons += [quad[:3], [quad[0], quad[2], quad[3]]]
    return Shape("", ply(mesh.vertices, polygons), mesh, mesh, suffix=".ply")


@_shape
def star() -> Shape:
    """A prism over a star of seven points: concave at every second corner."""
    angles = np.pi * np.arange(14) / 7
    radius = np.where(np.arange(14) % 2, 9.0, 20.0)
    outline = single(np.column_stack([radius * np.cos(angles), radius * np.sin(angles)]))
    n = len(outline)
    vertices = np.concatenate([np.column_stack([outline, np.full(n, z)]) for z in (0.0, 50.0)])
    ring = list(range(n))
    sides = [[i, (i + 1) % n, (i + 1) % n + n, i + n] for i in ring]
    polygons = [ring[::-1], [i + n for i in ring], *sides]
    # The star round its middle, which sees all of it.
    middle = np.array([[0, 0, 0], [0, 0, 50.0]])
    caps = [[i, 2 * n, (i + 1) % n] for i in ring] + [[i + n, (i + 1) % n + n, 2 * n + 1] for i in ring]
    walls = [t for a, b, c, d in sides for t in ([a, b, c], [a, c, d])]
    caps = [[c, b, a] for a, b, c in [[i, (i + 1) % n, 2 * n] for i in ring]] + caps[n:]
    solid = Mesh(np.concatenate([vertices, middle]), np.array(caps + walls, np.int32))
    return Shape("", obj(vertices, polygons), solid, solid, suffix=".obj")


# --- housings and scans -----------------------------------------------------------------------------------------------


@_shape
def housing() -> Shape:
    """A thick wall with a mouth of 12 mm for the cable."""
    heights = np.linspace(0, 80, 21).tolist()
    outer = [*((16.0, z) for z in heights), *arc(16, (0, 80), 0, 90, 16)[1:]]
    inner = [*arc(13, (0, 80), 90, 0, 14), *((13.0, z) for z in heights[-2:0:-1]), (13.0, 3.0), (6.0, 3.0)]
    solid = lathe([(0, 0), (6.0, 0.0), *outer], 72)
    middles = solid.corners.mean(axis=1)
    mouth = (middles[:, 2] < 1e-9) & (np.linalg.norm(middles[:, :2], axis=1) < 6)
    return Shape("", lathe([*inner, (6.0, 0.0), *outer], 72), solid.chosen(~mouth), solid, closed=False)


@_shape
def open_skin() -> Shape:
    """A skin without thickness, open at the flange."""
    solid = _bundled("convex", 8_000)
    low = (solid.corners[..., 2] < 0.5).all(axis=1)
    return Shape("", solid.chosen(~low), solid.chosen(~low), solid, closed=False)


@_shape
def missing_lens() -> Shape:
    """A skin of which the lens is missing: a long hole with a round rim."""
    solid = _bundled("linear", 12_000)
    middles = solid.corners.mean(axis=1)
    lens = (middles[:, 2] > solid.vertices[:, 2].max() - 2.5) & (np.abs(middles[:, 0]) < 15)
    return Shape("", solid.chosen(~lens), solid.chosen(~lens), solid, closed=False)


def _scanned(facets: int, noise: float) -> Mesh:
    """Make a grip with waves; noise along the normal that is alike within some points."""
    rng = np.random.default_rng(4)
    waves = rng.standard_normal((40, 3)) * 60
    phases = rng.uniform(0, 2 * np.pi, 40)

    def shape(d: Floats) -> Floats:
        bumpy = np.sin(d @ waves.T + phases).sum(axis=1) / np.sqrt(20) if noise else 0.0
        wide = 1 + 0.25 * np.sin(3 * d[:, 2])
        return d * [20, 14, 55] * wide[:, None] + (noise * np.asarray(bumpy))[..., None] * d

    return globe(facets, shape)


def _holed(mesh: Mesh, count: int, radius: tuple[float, float]) -> Mesh:
    rng = np.random.default_rng(5)
    middles = mesh.corners.mean(axis=1)
    keep = np.ones(len(middles), bool)
    for centre, r in zip(middles[rng.choice(len(middles), count)], rng.uniform(*radius, count), strict=True):
        keep &= np.linalg.norm(middles - centre, axis=1) > r
    return compact(mesh.chosen(keep))


@_shape
def scan() -> Shape:
    """20,000 facets, 0.05 mm of noise, six holes."""
    solid = _scanned(20_000, 0.05)
    holed = _holed(solid, 6, (1.0, 4.0))
    return Shape("", holed, holed, solid, closed=False)


@_shape
def scan_1m() -> Shape:
    """A million facets, 0.02 mm of noise, twelve holes."""
    solid = _scanned(1_000_000, 0.02)
    holed = _holed(solid, 12, (0.5, 4.0))
    return Shape("", holed, holed, solid, closed=False)


@_shape
def folded_scan() -> Shape:
    """A scan whose facets fold over each other in places: points moved by more than the facets are long."""
    solid = _scanned(20_000, 0.0)
    rng = np.random.default_rng(6)
    moved = solid.vertices.copy()
    chosen = rng.choice(len(moved), 60, replace=False)
    moved[chosen] += rng.normal(0, 0.8, (60, 3))
    return Shape("", Mesh(single(moved), solid.faces), solid, solid)


# --- hopeless ---------------------------------------------------------------------------------------------------------


@_shape
def sheet() -> Shape:
    """A flat sheet: no body."""
    plate = box((0, 60), (0, 40), (0, 5), 5)
    top = plate.chosen((plate.corners[..., 2] == 5).all(axis=1))
    return Shape("", top, top, None, closed=False, body=False)


@_shape
def moebius() -> Shape:
    """A band with one side."""
    u, v = np.linspace(0, 2 * np.pi, 121)[:-1], np.linspace(-8, 8, 9)
    angle, across = (g.ravel() for g in np.meshgrid(u, v, indexing="ij"))
    radius = 30 + across * np.cos(angle / 2)
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), across * np.sin(angle / 2)])
    i, j = (g.ravel() for g in np.meshgrid(np.arange(120), np.arange(8), indexing="ij"))
    last = i == 119
    next_low, next_high = np.where(last, 8 - j, (i + 1) * 9 + j), np.where(last, 7 - j, (i + 1) * 9 + j + 1)
    a, b = i * 9 + j, i * 9 + j + 1
    faces = np.concatenate([np.stack([a, next_low, next_high], 1), np.stack([a, next_high, b], 1)])
    band = Mesh(single(points), faces.astype(np.int32))
    return Shape("", band, band, None, closed=False, body=False)


# --- probes -----------------------------------------------------------------------------------------------------------


@cache
def _bundled(name: str, facets: int) -> Mesh:
    vertices, faces = assets.make(name, facets)
    return Mesh(single(1e3 * vertices), faces)


@_shape
def bundled_linear() -> Shape:
    """A bundled probe, 20,000 facets."""
    return _sound(_bundled("linear", 20_000))


@_shape
def bundled_convex() -> Shape:
    """A bundled probe, 20,000 facets."""
    return _sound(_bundled("convex", 20_000))


@_shape
def bundled_t_shape() -> Shape:
    """A bundled probe, 20,000 facets."""
    return _sound(_bundled("t-shape", 20_000))


def _real(name: str) -> Shape:
    """A real file, of which the outside is not known: what sees much of the sky."""
    content = (REAL / name).read_bytes()
    records = np.frombuffer(content, _STL_FACET, -1, 84)
    corners = records["corners"].astype(np.float64).reshape(-1, 3)
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    mesh = Mesh(vertices, index.reshape(-1, 3).astype(np.int32))
    return Shape("", content, mesh, None, closed=False, known=False)


@_shape
def real_convex() -> Shape:
    """A housing without its lens, hollow, of eight parts."""
    return _real("convex-c5-2.stl")


@_shape
def real_linear() -> Shape:
    """A housing without its lens, hollow, of ninety parts, its winding mixed."""
    return _real("linear-l14-5.stl")


__all__ = ["Shape", "make", "names", "obj", "ply", "stl"]
