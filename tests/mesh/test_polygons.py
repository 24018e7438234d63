"""Polygons that are not convex, in every format that has polygons."""

import numpy as np
import pytest

from contactbench.pipeline.mesh import MeshError, MeshWarning, load_probe
from contactbench.pipeline.mesh.polygons import Polygons, strip_triangles, triangulate

ELL = [(0, 0), (80, 0), (80, 20), (20, 20), (20, 60), (0, 60)]
ELL_AREA = 80 * 20 + 20 * 40
# A frame: the outline goes to its hole and back by the same way.
FRAME = [(0, 0), (80, 0), (80, 80), (0, 80), (0, 0), (20, 20), (20, 60), (60, 60), (60, 20), (20, 20)]
STAR = [
    (r * np.cos(t), r * np.sin(t))
    for t, r in zip(np.linspace(0, 2 * np.pi, 40, endpoint=False), [40, 15] * 20, strict=True)
]


def prism(outline, height: float = 30.0) -> tuple[np.ndarray, list[list[int]]]:
    """A prism of a closed outline, its ends one polygon each, facing outwards."""
    places = {point: i for i, point in enumerate(dict.fromkeys(outline))}
    n = len(places)
    vertices = np.array([(*p, z) for z in (0.0, height) for p in places])
    ring = [places[point] for point in outline]
    steps = list(zip(ring, ring[1:] + ring[:1], strict=True))
    walls = [[a, b, b + n, a + n] for a, b in steps if (b, a) not in steps]
    return vertices, [ring[::-1], [i + n for i in ring], *walls]


def as_obj(vertices, polygons) -> str:
    return "".join("v {!r} {!r} {!r}\n".format(*v) for v in vertices.tolist()) + "".join(
        "f " + " ".join(str(i + 1) for i in p) + "\n" for p in polygons
    )


def as_off(vertices, polygons) -> str:
    rows = ["{!r} {!r} {!r}".format(*v) for v in vertices.tolist()]
    rows += [" ".join(map(str, [len(p), *p])) for p in polygons]
    return f"OFF\n{len(vertices)} {len(polygons)} 0\n" + "\n".join(rows)


def as_ply(vertices, polygons, order: str) -> bytes:
    kind = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}[order]
    head = (
        f"ply\nformat {kind} 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\n"
        f"property uchar red\nproperty double z\nelement face {len(polygons)}\nproperty list uchar float extra\n"
        "property int region\nproperty list uchar int vertex_indices\nproperty uchar flags\nend_header\n"
    )
    if not order:
        rows = ["{!r} {!r} 9 {!r}".format(*v) for v in vertices.tolist()]
        rows += [
            " ".join(map(str, [k % 3, *[0.5] * (k % 3), k, len(p), *p, 1])) for k, p in enumerate(polygons)
        ]
        return (head + "\n".join(rows)).encode()
    points = np.zeros(len(vertices), [("xy", order + "f8", 2), ("red", "u1"), ("z", order + "f8")])
    points["xy"], points["z"] = vertices[:, :2], vertices[:, 2]
    body = b""
    for k, p in enumerate(polygons):
        body += bytes([k % 3]) + np.zeros(k % 3, order + "f4").tobytes() + np.array(k, order + "i4").tobytes()
        body += bytes([len(p)]) + np.array(p, order + "i4").tobytes() + b"\1"
    return head.encode() + points.tobytes() + body


FORMATS = {
    "a.obj": as_obj,
    "a.off": as_off,
    "text.ply": lambda v, p: as_ply(v, p, ""),
    "little.ply": lambda v, p: as_ply(v, p, "<"),
    "big.ply": lambda v, p: as_ply(v, p, ">"),
}


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("turn", [0, 1, 2, 3, 4, 5])
@pytest.mark.parametrize("outline", [ELL, FRAME, STAR], ids=["ell", "frame", "star"])
def test_a_prism_of_an_outline_that_is_not_convex(write, name, outline, turn):
    outline = outline[turn:] + outline[:turn]
    vertices, polygons = prism(outline)
    tilt = np.linalg.qr(np.random.default_rng(turn).normal(size=(3, 3)))[0]
    tilt *= np.sign(np.linalg.det(tilt))
    probe = load_probe(write(name, FORMATS[name](vertices @ tilt.T, polygons)), "mm")
    x, y = np.array(outline, float).T
    area = abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
    assert probe.health.sentences == ()
    ends = np.abs(probe.normals @ tilt[:, 2]) > 0.5
    assert probe.areas[ends].sum() == pytest.approx(2e-6 * area, rel=1e-9)
    # The facets of one end all face its way: none is folded over.
    assert sorted(set(np.round(probe.normals[ends] @ tilt[:, 2], 6))) == [-1, 1]
    if name.endswith("ply"):
        assert probe.region[ends].tolist() == [0] * (len(outline) - 2) + [1] * (len(outline) - 2)


def test_the_ell_of_46_square_centimetres_is_not_55(write):
    vertices, polygons = prism(ELL)
    probe = load_probe(write("a.obj", as_obj(vertices, polygons)), "mm")
    assert probe.areas[np.abs(probe.normals[:, 2]) > 0.5].sum() == pytest.approx(2e-6 * ELL_AREA)


@pytest.mark.parametrize("turn", range(4))
def test_a_dart_is_cut_at_its_notch(turn):
    dart = np.array([(0, 0, 0), (40, 0, 0), (10, 10, 0), (0, 40, 0)], float)
    done = triangulate(dart, np.roll(np.arange(4), turn), np.array([4]))
    assert all({0, 2} <= set(row) for row in done.faces.tolist())
    assert done.notes == ()


def test_points_on_a_side_keep_the_neighbours_closed(write):
    # A box whose top has points on its sides, beside its first corner too, that the walls have as corners.
    vertices = np.array(
        [(0, 0, 0), (80, 0, 0), (80, 60, 0), (0, 60, 0), (0, 0, 30), (40, 0, 30), (80, 0, 30), (80, 60, 30)]
        + [(0, 60, 30), (0, 30, 30)],
        float,
    )
    polygons = [
        [3, 2, 1, 0],
        [4, 5, 6, 7, 8, 9],
        [0, 1, 6, 5, 4],
        [1, 2, 7, 6],
        [2, 3, 8, 7],
        [3, 0, 4, 9, 8],
    ]
    for turn in range(6):
        top = polygons[1][turn:] + polygons[1][:turn]
        turned = [polygons[0], top, *polygons[2:]]
        probe = load_probe(write("a.obj", as_obj(vertices, turned)), "mm")
        assert probe.health.sentences == ()
        assert len(probe.faces) == 16


def test_warped_polygons_of_a_saddle_stay_closed():
    t = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    r = np.where(np.arange(24) % 2, 15.0, 40.0)
    saddle = np.column_stack((r * np.cos(t), r * np.sin(t), 0.05 * r * np.cos(2 * t)))
    faces = triangulate(saddle, np.arange(24), np.array([24])).faces
    a, b, c = np.moveaxis(saddle[faces], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()
    edges = {(int(x), int(y)) for row in faces for x, y in zip(row, np.roll(row, -1), strict=True)}
    assert {(x, y) for x, y in edges if (y, x) not in edges} == {(k, (k + 1) % 24) for k in range(24)}


@pytest.mark.parametrize("turn", range(4))
def test_a_bent_quad_is_cut_along_its_shorter_diagonal(turn):
    bent = np.array([(0, -30, 0), (40, 0, 9), (0, 30, 0), (-40, 0, 9)], float)
    faces = triangulate(bent, np.roll(np.arange(4), turn), np.array([4])).faces
    assert all({0, 2} <= set(row) for row in faces.tolist())


def test_what_cannot_be_covered_is_told():
    square = np.array([(0, 0, 0), (40, 0, 0), (40, 40, 0), (0, 40, 0)], float)
    bow = triangulate(square, np.array([0, 2, 1, 3]), np.array([4]))
    assert bow.notes == ("Polygons cross themselves, so their triangles overlap (polygons: 1).",)
    five = np.array([(np.cos(a), np.sin(a), 0.0) for a in np.arange(5) * 4 * np.pi / 5])
    pentagram = triangulate(five, np.arange(5), np.array([5]))
    assert pentagram.notes == bow.notes
    assert len(pentagram.faces) == 3


def test_corners_named_twice_and_too_few_of_them():
    square = np.array([(0, 0, 0), (40, 0, 0), (40, 40, 0), (0, 40, 0)], float)
    corners = np.array([0, 1, 1, 2, 0, 1, 2, 0, 2, 3, 0, 1, 0, 0, 1, 1])
    done = triangulate(square, corners, np.array([4, 4, 2, 1, 5]))
    assert done.faces.tolist() == [[0, 1, 2], [1, 2, 0]]
    assert done.polygon.tolist() == [0, 1]
    assert done.notes == ("Polygons of fewer than three corners were left out (polygons: 3).",)


def test_more_work_than_a_second_is_refused():
    chance = np.random.default_rng(0)
    points = np.column_stack((chance.random((20_000, 2)), np.zeros(20_000)))
    with pytest.raises(MeshError, match="non-convex polygons have 20000 corners, too many to triangulate"):
        triangulate(points, np.arange(20_000), np.array([20_000]))


def test_a_missing_vertex_is_named_by_its_line():
    polygons = Polygons("OBJ")
    polygons.add([0, 1, 2, 3], 7)
    polygons.add([0, 1, 4], 9)
    with pytest.raises(MeshError, match=r"line 9 of the OBJ text .*the file has 4"):
        polygons.finish(np.zeros((4, 3)))


def test_strips():
    corners, strip = np.array([0, 1, 2, 3, 4, 5, 6, 7]), np.array([0, 0, 0, 0, 1, 1, 3, 3])
    assert strip_triangles(corners, strip).tolist() == [[0, 1, 2], [2, 1, 3]]
    assert strip_triangles(corners[:2], strip[:2]).shape == (0, 3)


@pytest.mark.parametrize("order", ["", "<"])
def test_ply_of_strips(write, order):
    lists = [[0, 1, 2, 3, -1, 2, 3, 0], [3, 1, 0]]
    kind = "binary_little_endian" if order else "ascii"
    head = (
        f"ply\nformat {kind} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
    ).encode()
    points = np.array([(0, 0, 0), (0, 50, 0), (50, 0, 0), (0, 0, 50)], "<f4")
    if order:
        body = points.tobytes() + b"".join(np.array([len(x), *x], "<i4").tobytes() for x in lists)
    else:
        rows = [*points.tolist(), *([len(x), *x] for x in lists)]
        body = "\n".join(" ".join(f"{value:g}" for value in row) for row in rows).encode()
    probe = load_probe(write("a.ply", head + body), "mm")
    assert (len(probe.faces), probe.health.sentences) == (4, ())


def test_polygons_of_two_corners_are_told(write):
    vertices, polygons = prism(ELL)
    with pytest.warns(MeshWarning, match=r"fewer than three corners were left out \(polygons: 1\)"):
        load_probe(write("a.obj", as_obj(vertices, polygons) + "f 1 2\n"), "mm")
