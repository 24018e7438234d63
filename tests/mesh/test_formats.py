"""What is particular to one format, above all what trimesh by itself would read wrongly without a word."""

import re
import struct
import time

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe
from contactbench.pipeline.mesh import load_probe as load_any

TETRAHEDRON = ["0 0 0", "50 0 0", "0 50 0", "0 0 50"]
OUTWARD = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def load_probe(path) -> Probe:
    """Numbers up to 50 could be centimetres too."""
    return load_any(path, "mm")


def refuse(path, message: str) -> None:
    with pytest.raises(MeshError, match=message) as caught:
        load_probe(path)
    assert str(path) in str(caught.value)


# ---------------------------------------------------------------- STL


def stl_text(names: tuple[str, ...] = ("part",), newline: str = "\n") -> str:
    lines = []
    for n, name in enumerate(names):
        lines.append(f"solid {name}")
        for facet in OUTWARD:
            lines += ["  facet normal 0 0 0", "    outer loop"]
            points = [[float(x) + 100 * n for x in TETRAHEDRON[i].split()] for i in facet]
            lines += [f"      vertex {x:e} {y:E} {z:g}" for x, y, z in points]
            lines += ["    endloop", "  endfacet"]
        lines.append(f"endsolid {name}")
    return newline.join(lines) + newline


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize(
    "name", ["", "SOLIDWORKS part", "vertex 1 2 3", "facet normal", "endsolid loop", "\xb5"]
)
def test_stl_text_with_any_name(write, newline, name):
    probe = load_probe(write("a.stl", stl_text((name,), newline)))
    assert (len(probe.faces), len(probe.vertices)) == (4, 4)
    assert probe.health.sentences == ()


def test_stl_solids_become_one_mesh(write):
    with pytest.warns(MeshWarning, match="2 separate parts"):
        probe = load_probe(write("a.stl", stl_text(("solid one", "solid two"))))
    assert len(probe.faces) == 8
    assert probe.vertices[probe.faces[:4]].max() == pytest.approx(0.05)
    assert probe.health.outward is True


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "vertex 5.000000e+01 0.000000E+00 0\n",
            "vertex 5.0 0.0\n",
            "the facet on line 2 .*must be three 'vertex",
        ),
        ("vertex 5.000000e+01 0.000000E+00 0\n", "vertex 5,0 0,0 0\n", "the facet on line 2 "),
        ("vertex 5.000000e+01 0.000000E+00 0\n", "vertex 5.0x 0.0 0\n", "the facet on line 2 "),
        ("      vertex 5.000000e+01 0.000000E+00 0\n", "", "the facet on line 2 "),
        ("  endfacet\n", "", "the facet on line 2 "),
        ("5.000000e+01", "nan", r"vertex \d is .* not finite"),
        ("5.000000e+01", "1e999", r"vertex \d is .* not finite"),
        ("5.000000e+01", "1e20", r"vertices: row \d .* is impossibly far away"),
    ],
)
def test_stl_text_that_is_damaged(write, old, new, message):
    refuse(write("a.stl", stl_text().replace(old, new, 1)), message)


def test_stl_text_without_facets(write):
    refuse(write("a.stl", "solid nothing\nendsolid nothing\n"), "the STL text holds no facets")


def test_stl_text_whose_last_solid_is_cut_off(write):
    # trimesh returns the first solid and says nothing.
    text = stl_text(("one", "two"))
    refuse(write("a.stl", text[: int(len(text) * 0.8)]), "ends within a facet: it is cut short")


@pytest.mark.parametrize(
    "change",
    [
        lambda text: " ".join(text.split()),
        lambda text: text.replace("\n", "\n\n").replace(" ", "\t"),
        lambda text: text.replace(" normal 0 0 0", ""),
        lambda text: text.replace("normal 0 0 0", "normal -nan(ind) 1.#QNAN 0"),
        lambda text: text.replace("normal 0 0 0\n    outer loop", "normal 0 0 0 outer loop"),
        lambda text: "\n\n" + text + "\0" * 100,
        lambda text: text[text.index("facet") :],
        lambda text: text.replace("endloop", "endloop\n color 1 0.5 0"),
        lambda text: text.replace("outer loop", "outerloop"),
        lambda text: "\ufeff" + text,
        lambda text: text.encode("utf-16"),
    ],
)
def test_stl_text_however_it_is_laid_out(write, change):
    probe = load_probe(write("a.stl", change(stl_text())))
    assert corners(probe) == corners(load_probe(write("b.stl", stl_text())))


@pytest.mark.parametrize("form", ["{:.6f}", "{:e}", "{:.3f}"])
def test_decimal_commas_are_read_and_told(write, form):
    name = "part, of 1,5 or 2.5"
    text = re.sub(
        r"vertex (\S+) (\S+) (\S+)",
        lambda found: "vertex " + " ".join(form.format(float(x)).replace(".", ",") for x in found.groups()),
        stl_text((name,)),
    )
    with pytest.warns(MeshWarning, match="decimal commas, which were read as decimal points"):
        probe = load_probe(write("a.stl", text))
    assert corners(probe) == corners(load_probe(write("b.stl", stl_text())))


@pytest.mark.parametrize("row", ["1,234 5,678 9,012", "1,5,2 3", "1.234,5 2 3", "1,5 2.5 3"])
def test_commas_that_may_be_something_else_are_refused(write, row):
    refuse(
        write("a.obj", OBJ + f"v {row}\n" + FACETS), "line 5 .* has the number '1.*,.*', whose comma may be"
    )


def test_commas_are_named_in_every_text(write, ply_text):
    said = "has the number '50,000', whose comma may be a decimal point or a thousands separator"
    refuse(write("a.obj", (OBJ + FACETS).replace("50 ", "50,000 ")), f"line 2 .* {said}")
    refuse(
        write("a.off", "OFF\n4 4 0\n" + "50,000 50,000 50,000\n" * 4 + "3 0 1 2\n" * 4), f"line 3 .* {said}"
    )
    refuse(write("a.ply", ply_text(["50,000 50,000 50,000"] * 4, TRIANGLES)), f"row 0 .* {said}")
    refuse(write("a.stl", stl_text().replace("5.000000e+01", "50,000")), f"facet on line 2 .* {said}")
    # Colours with points beside coordinates with commas.
    refuse(
        write("b.obj", OBJ + "v 1,2500 2,5000 3,0 0.5 0.5 0.5\n" + FACETS),
        "line 5 .* has the number '1,2500'",
    )


def binary_stl(mesh: trimesh.Trimesh, count: int | None = None, header: bytes = b"") -> bytes:
    data = bytearray(mesh.export(file_type="stl"))
    data[: len(header)] = header
    if count is not None:
        data[80:84] = struct.pack("<I", count)
    return bytes(data)


@pytest.mark.parametrize("header", [b"", b"solid "])
def test_binary_stl_with_an_absurd_count(ball, write, header):
    data = binary_stl(ball, 2**32 - 1, header)
    refuse(write("a.stl", data), "announces 4294967295 facets, which take 214748364834 bytes.*cut short")


def test_binary_stl_with_whole_facets_after_its_end(ball, write):
    with pytest.warns(
        MeshWarning, match="announces 100 facets, but 220 more complete facets follow and were also read"
    ):
        probe = load_probe(write("a.stl", binary_stl(ball, 100) + b"\1\2"))
    assert (len(probe.faces), probe.health.watertight) == (320, True)


@pytest.mark.parametrize("tail", [b"\0" * 100, b" " * 50, b"made by hand, as every file of this is" * 5])
def test_binary_stl_with_other_things_after_its_end(ball, write, tail):
    with pytest.warns(MeshWarning, match=rf"were left out \(bytes: {len(tail)}\)"):
        assert len(load_probe(write("a.stl", binary_stl(ball) + tail)).faces) == 320


def test_binary_stl_whose_count_was_never_written(ball, write):
    with pytest.warns(MeshWarning, match="announces no facets, but the file has room for 320"):
        assert len(load_probe(write("a.stl", binary_stl(ball, 0))).faces) == 320
    refuse(write("b.stl", binary_stl(ball, 0) + b"1"), "the STL file holds no facets")


def test_binary_stl_without_facets(write):
    refuse(write("a.stl", b"\0" * 84), "the STL file holds no facets")


def test_short_stl(write):
    refuse(write("a.stl", b"\1" * 83), "83 bytes are too few for an STL file")


# ---------------------------------------------------------------- OBJ

OBJ = "".join(f"v {row}\n" for row in TETRAHEDRON)
FACETS = "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in OUTWARD)


def corners(probe) -> list[list[list[float]]]:
    return (probe.vertices[probe.faces] * 1000).round(9).tolist()


def test_obj_facets_keep_their_order_over_groups_and_materials(write):
    lines = FACETS.splitlines()
    mixed = (
        "mtllib none.mtl\n"
        + OBJ
        + "\n".join(
            f"o part{i}\ng side{i}\nusemtl colour{i % 2}\ns off\n{line}" for i, line in enumerate(lines)
        )
    )
    assert corners(load_probe(write("a.obj", mixed))) == corners(load_probe(write("b.obj", OBJ + FACETS)))


@pytest.mark.parametrize("form", ["{0}/{0}", "{0}//{0}", "{0}/{0}/{0}", "{0}/", "{0}//"])
def test_obj_texture_and_normal_indices_are_ignored(write, form):
    extra = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n" + "vn 0 0 1\n" * 4
    facets = "".join("f " + " ".join(form.format(i + 1) for i in facet) + "\n" for facet in OUTWARD)
    probe = load_probe(write("a.obj", OBJ + extra + facets))
    assert corners(probe) == corners(load_probe(write("b.obj", OBJ + FACETS)))


def test_obj_hexagon_beside_textured_triangles(write):
    # Both kinds of line hold six numbers; trimesh takes them for the same kind.
    ring = [(50, 0), (25, 43), (-25, 43), (-50, 0), (-25, -43), (25, -43)]
    text = "".join(f"v {x} {y} 0\n" for x, y in ring) + "v 0 0 50\nvt 0 0\nf 6 5 4 3 2 1\n"
    text += "".join(f"f {i + 1}/1 {(i + 1) % 6 + 1}/1 7/1\n" for i in range(6))
    probe = load_probe(write("a.obj", text))
    assert len(probe.faces) == 10
    assert probe.health.sentences == ()


def test_obj_negative_indices_count_back_from_where_they_stand(write):
    # trimesh counts back from the end of the file.
    first = OBJ + "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n"
    moved = "".join(
        f"v {100 + int(row.split()[0])} {row.split()[1]} {row.split()[2]}\n" for row in TETRAHEDRON
    )
    with pytest.warns(MeshWarning, match="2 separate parts"):
        probe = load_probe(write("a.obj", first + moved + first[len(OBJ) :]))
    assert probe.health.watertight
    assert probe.vertices[probe.faces[:4]].max() == pytest.approx(0.05)


def test_obj_with_comments_continuations_colours_and_weights(write):
    text = "# head\n" + OBJ.replace("v 0 0 0\n", "v 0 0 0 1.0 # weight\n").replace(
        "v 50 0 0", "v 50 0 0 1 0.5 0.5"
    )
    probe = load_probe(write("a.obj", text + FACETS.replace("f 1 3 2", "f 1 \\\n3 2 # bottom")))
    assert corners(probe) == corners(load_probe(write("b.obj", OBJ + FACETS)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (OBJ, "holds no facets"),
        (FACETS, "line 1 .* refers to a vertex that does not exist .the file has 0"),
        (OBJ + FACETS + "f 1 2 9\n", "line 9 .* refers to a vertex that does not exist .the file has 4"),
        (OBJ + FACETS + "f -1 -2 -9\n", "line 9 .* refers to a vertex that does not exist"),
        (OBJ + FACETS + "f 0 1 2\n", r"line 9 .* without valid vertex numbers \(counted from 1\)"),
        (OBJ + FACETS + "f\n", "line 9 .* without valid vertex numbers"),
        (OBJ + FACETS + "f 1 2 x\n", "line 9 .* without valid vertex numbers"),
        (OBJ + FACETS + "f 1 2 3.0\n", "line 9 .* without valid vertex numbers"),
        (OBJ + FACETS + "f 1 2 99999999999999999999999\n", "line 9 .* without valid vertex numbers"),
        (OBJ + FACETS + "f 1 2 99999999999999999\n", "line 9 .* refers to a vertex that does not exist"),
        (OBJ + "v 1 2\n" + FACETS, "line 5 .* is a vertex without three numbers"),
        (OBJ + "v 1 2 3x\n" + FACETS, "line 5 .* is a vertex without three numbers"),
        (OBJ.replace("50 0 0", "inf 0 0") + FACETS, "vertex 2 is .* not finite"),
    ],
)
def test_obj_that_is_damaged(write, text, message):
    refuse(write("a.obj", text), message)


# ---------------------------------------------------------------- PLY

TRIANGLES = [f"3 {a} {b} {c}" for a, b, c in OUTWARD]
INDICES = "list uchar int vertex_indices"


@pytest.mark.parametrize("kind", ["char", "uchar", "short", "uint8", "int32", "uint"])
def test_ply_region_may_stand_anywhere_and_be_any_integer(write, ply_text, kind):
    rows = [f"255 {i} {row} 0.5 2 7 8" for i, row in enumerate(TRIANGLES)]
    properties = (
        "uchar red",
        f"{kind} region",
        "list uchar int vertex_index",
        "float quality",
        "list uchar int extra",
    )
    probe = load_probe(write("a.ply", ply_text(TETRAHEDRON, rows, face_properties=properties)))
    assert probe.region.tolist() == [0, 1, 2, 3]


def test_ply_polygons_share_their_region(write, ply_text):
    vertices = ["0 0 0", "50 0 0", "50 50 0", "0 50 0", "25 25 40"]
    rows = ["4 3 2 1 0 7", "3 0 1 4 1", "3 1 2 4 2", "3 2 3 4 3", "3 3 0 4 4"]
    text = ply_text(vertices, rows, face_properties=(INDICES, "int region"))
    probe = load_probe(write("a.ply", text))
    assert probe.region.tolist() == [7, 7, 1, 2, 3, 4]
    assert probe.health.sentences == ()


def test_ply_region_survives_leaving_facets_out(ball, write, ply_text):
    rows = [f"3 {a} {b} {c} {i}" for i, (a, b, c) in enumerate(ball.faces.tolist())]
    rows.insert(100, "3 5 5 6 9999")
    vertices = [" ".join(map(repr, row)) for row in ball.vertices.tolist()]
    text = ply_text(vertices, rows, face_properties=(INDICES, "int region"))
    with pytest.warns(MeshWarning, match=r"left out \(facets: 1\)"):
        probe = load_probe(write("a.ply", text))
    assert probe.region.tolist() == list(range(320))


def test_ply_with_edges_and_other_elements(write, ply_text):
    before = (
        "element thing 2\nproperty list uchar int numbers\nproperty float x\nelement none 0\nproperty int a\n"
    )
    text = ply_text(TETRAHEDRON, TRIANGLES, before=before, rows_before=("2 1 2 0.5", "0 0.25"))
    text = text.replace(
        "end_header", "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header"
    )
    assert len(load_probe(write("a.ply", text + "0 1\n")).faces) == 4


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("corners", [3, 4])
def test_ply_binary_of_either_byte_order(write, order, corners):
    box = trimesh.creation.box(extents=(60, 40, 20))
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    polygons = quads if corners == 4 else np.asarray(box.faces)
    region = np.arange(len(polygons))
    rows = np.zeros(len(polygons), [("r", order + "u2"), ("n", "u1"), ("i", order + "u4", (corners,))])
    rows["r"], rows["n"], rows["i"] = region, corners, polygons
    encoding = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = (
        f"ply\r\nformat {encoding} 1.0\r\nelement vertex 8\r\nproperty float x\r\nproperty float y\r\n"
        f"property float z\r\nelement face {len(polygons)}\r\nproperty ushort region\r\n"
        "property list uchar uint vertex_indices\r\nend_header\r\n"
    )
    data = head.encode() + np.asarray(box.vertices).astype(order + "f4").tobytes() + rows.tobytes()
    probe = load_probe(write("a.ply", data))
    assert probe.region.tolist() == np.repeat(region, corners - 2).tolist()
    assert probe.areas.sum() == pytest.approx(2e-6 * (60 * 40 + 60 * 20 + 40 * 20))
    assert probe.health.watertight


def test_ply_binary_with_a_wrong_list_length_inside(ball, write):
    # trimesh uses the first row's length for all and ignores the others.
    data = bytearray(ball.export(file_type="ply"))
    data[-13 * 7] = 4
    refuse(write("a.ply", bytes(data)), "the file does not contain: it is damaged or cut short")


@pytest.mark.parametrize("count", [-1, 0, 2, 200])
def test_ply_binary_with_a_wrong_first_list_length(ball, write, count):
    data = bytearray(ball.export(file_type="ply"))
    data[-13 * 320] = count % 256
    refuse(write("a.ply", bytes(data)), "cut short|refers to vertex")


def test_ply_binary_with_an_absurd_list_length(ball, write):
    head, _, body = ball.export(file_type="ply").partition(b"end_header\n")
    vertices, faces = body[: 12 * len(ball.vertices)], np.asarray(ball.faces)
    rows = np.zeros(len(faces), [("n", "<u4"), ("i", "<i4", (3,))])
    rows["n"], rows["i"] = 2**32 - 1, faces
    head = head.replace(b"list uchar int", b"list uint int")
    refuse(write("a.ply", head + b"end_header\n" + vertices + rows.tobytes()), "announces 4294967295 numbers")


@pytest.mark.parametrize("element", ["vertex", "face"])
@pytest.mark.parametrize("count", ["4000000000", "999999999999999999"])
def test_ply_with_an_absurd_count(ball, encode, write, element, count):
    for name in ("binary.ply", "text.ply"):
        head, mark, body = encode(ball, name).partition(b"end_header\n")
        number = len(ball.vertices if element == "vertex" else ball.faces)
        head = head.replace(f"element {element} {number}".encode(), f"element {element} {count}".encode())
        refuse(write(name, head + mark + body), f"header announces .*{count[:9]}.*the file is.* cut short")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ply\n", "plywood\n", "the first line is not 'ply'"),
        ("end_header\n", "", "has no 'end_header' line"),
        ("format ascii 1.0\n", "", "has no 'format' line"),
        ("ascii 1.0", "ascii 9.9", "line 2 of the PLY header, 'format ascii 9.9', cannot be used"),
        ("format ascii", "format morse", "line 2 of the PLY header"),
        ("element vertex 4", "element vertex four", "line 4 of the PLY header"),
        ("element vertex 4", "element vertex -4", "line 4 of the PLY header"),
        ("property double x", "property quaternion x", "line 5 of the PLY header"),
        ("property double x\n", 2 * "property double x\n", "has no property, or the same one twice"),
        ("50 0 0\n", "50 0\n0 ", "row 1 of the PLY element 'vertex'"),
        ("element face", "element vertex", "has no property, or the same one twice|names an element twice"),
        ("property double z\n", "", "no vertices with a number 'z'"),
        ("property double z\n", "property list uchar double z\n", "no vertices with a number 'z'"),
        ("element vertex 4", "element point 4", "no vertices with a number 'x'"),
        ("element face 4", "element cell 4", "holds no facets"),
        (f"property {INDICES}", "property list uchar float vertex_indices", "is not a list of integers"),
        (f"property {INDICES}", "property int vertex_indices", "is not a list of integers"),
        (f"property {INDICES}", "property list uchar int corners", "holds no facets"),
        ("element vertex 4\n", "", "line 4 of the PLY header"),
        ("50 0 0\n", "50 0\n", "row 1 of the PLY element 'vertex'"),
        ("50 0 0\n", "50 0 0 0\n", "row 1 of the PLY element 'vertex'"),
        ("50 0 0\n", "50 0 zero\n", "row 1 of the PLY element 'vertex'"),
        ("50 0 0\n", "", "announces 4 rows of 'vertex', 4 rows of 'face', but 7 rows follow"),
        ("50 0 0\n", "50 0 0\n50 0 0\n", "row 0 of the PLY element 'face' does not contain the numbers"),
        ("50 0 0\n", "50 0 nan\n", "vertex 2 is .* not finite"),
        ("3 0 1 3", "3 0 1 4", "faces: row 1 refers to vertex 4"),
        ("3 0 1 3", "3 0 1 -1", "faces: row 1 refers to vertex -1"),
        ("3 0 1 3", "3 0 1 3.5", "row 1 of the PLY element 'face'"),
        ("3 0 1 3", "3 0 1 1e3", "row 1 of the PLY element 'face'"),
        ("3 0 1 3", "3 0 1 nan", "row 1 of the PLY element 'face'"),
        ("3 0 1 3", "3 0 1 99999999999999999999", "row 1 of the PLY element 'face'"),
        ("3 0 1 3", "3 0 1 9999999999", "faces: row 1 refers to vertex"),
        ("3 0 1 3", "4 0 1 3", "row 1 of the PLY element 'face'"),
        ("50 0 0", "1e300 0 0", "vertices: row 1 .* is impossibly far away"),
        ("3 0 1 3", "2 0 1 3", "row 1 of the PLY element 'face'"),
        ("3 0 1 3", "-3 0 1 3", "row 1 of the PLY element 'face'"),
        ("3 0 1 3", "999999999999999 0 1 3", "row 1 of the PLY element 'face'"),
    ],
)
def test_ply_that_is_damaged(write, ply_text, old, new, message):
    text = ply_text(TETRAHEDRON, TRIANGLES)
    assert old in text
    refuse(write("a.ply", text.replace(old, new, 1)), message)


@pytest.mark.parametrize(
    ("kind", "value", "message"),
    [
        ("float region", "1", "face property 'region' is float: save it as int"),
        ("list uchar int region", "1 1", "face property 'region' is a list"),
        ("int region", "-2", "region: row 0 is -2"),
        ("int64 region", "3000000000", "region: row 0 is 3000000000"),
        ("int region", "3000000000", "region: row 0 is"),
        ("int invented", "7", "invented: row 0 is 7"),
        ("float invented", "1", "face property 'invented' is float: save it as int"),
    ],
)
def test_ply_with_a_bad_label(write, ply_text, kind, value, message):
    rows = [f"{row} {value}" for row in TRIANGLES]
    text = ply_text(TETRAHEDRON, rows, face_properties=(INDICES, kind))
    ours = text.replace("comment made by hand", "comment contactbench probe 1")
    refuse(write("a.ply", ours), message)
    # Of somebody else's file nobody knows what it means.
    with pytest.warns(MeshWarning, match="was not written by contactbench and was ignored"):
        probe = load_probe(write("b.ply", text))
    assert (len(probe.faces), probe.region.any(), probe.invented.any()) == (4, False, False)


def test_ply_headers_of_other_programs(write, ply_text):
    text = ply_text(TETRAHEDRON, TRIANGLES)
    twice = text.replace("property double z\n", "property double z\n" + "property uchar nx\n" * 2)
    twice = re.sub(r"(?m)^([0-9]+ [0-9]+ [0-9]+)$", r"\1 128.0 1", twice)
    for number, form in enumerate((text.replace("ascii 1.0", "ascii 1.1"), twice)):
        assert len(load_probe(write(f"{number}.ply", form)).faces) == 4


@pytest.mark.parametrize("layout", [" ", "\n"])
def test_ply_text_on_other_lines_than_usual(write, ply_text, layout):
    head, end, rows = ply_text(TETRAHEDRON, TRIANGLES).partition("end_header\n")
    probe = load_probe(write("a.ply", head + end + layout.join(rows.split())))
    assert corners(probe) == corners(load_probe(write("b.ply", head + end + rows)))
    refuse(write("c.ply", head + end + layout.join(rows.split()[:-1])), "cut short|does not contain")


def test_ply_rows_with_a_column_that_the_header_forgot(write, ply_text):
    rows = [f"{row} 7" for row in TETRAHEDRON]
    with pytest.warns(
        MeshWarning,
        match=r"Rows of the PLY element 'vertex' end in numbers that the header does not list; .* \(per row: 1\)",
    ):
        assert load_probe(write("a.ply", ply_text(rows, TRIANGLES))).size == pytest.approx(0.05)
    refuse(
        write("b.ply", ply_text([*rows[:3], rows[3] + " 7"], TRIANGLES)), "row 3 of the PLY element 'vertex'"
    )


def test_ply_comments_may_hold_any_character(write, ply_text):
    text = ply_text(TETRAHEDRON, TRIANGLES).replace("made by hand", "made by \u00c5sa\u2028on\x0bpaper")
    assert len(load_probe(write("a.ply", text)).faces) == 4


@pytest.mark.parametrize("filler", ["1" * 300_000, " " * 300_000, "\n" * 300_000, "\t\n " * 100_000])
def test_long_runs_cost_no_more_than_their_length(write, ply_text, filler):
    # Minutes, were the patterns ambiguous; milliseconds as they are.
    began = time.process_time()
    refuse(write("a.stl", stl_text().replace("vertex 5", f"vertex {filler}x5", 1)), "the facet on line 2 ")
    refuse(write("b.stl", stl_text().replace("endloop", f"{filler}x", 1)), "the facet on line 2 ")
    refuse(write("a.obj", OBJ + f"v 1 2 {filler}x\n" + FACETS), "vertex without three numbers")
    refuse(write("a.ply", ply_text([*TETRAHEDRON[:3], f"0 0 {filler}x"], TRIANGLES)), "row 3 of|rows follow")
    assert time.process_time() - began < 10


def test_ply_point_cloud(write, ply_text):
    refuse(write("a.ply", ply_text(TETRAHEDRON, [])), r"holds no facets \(a point cloud\?\)")


# ---------------------------------------------------------------- OFF


OFF_VERTICES = "0 0 0\n50 0 0\n0 50 0\n0 0 50\n"
OFF_FACETS = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
OFF = f"OFF\n4 4 6\n{OFF_VERTICES}{OFF_FACETS}"


def off_corners(path) -> list:
    probe = load_probe(path)
    assert probe.health.sentences == ()
    return corners(probe)


@pytest.mark.parametrize(
    "text",
    [
        OFF.replace("OFF\n", "OFF"),
        OFF.replace("OFF", "NCOFF").replace("50 0 0\n", "50 0 0 9 9 9 9 1 0 0\n"),
        OFF.replace("OFF\n", "off\n"),
        OFF.replace("OFF\n", "\ufeffOFF\n"),
        OFF.replace("4 4 6", "4 4"),
        OFF.replace("\n", "\r"),
        "# made by hand\n\n" + OFF.replace("\n50 0 0", " # corner\n\n  50 0 0"),
        OFF.replace("OFF", "STCNOFF").replace("50 0 0\n", "50 0 0 1 0 0 9 9 9 0 0\n"),
        OFF.replace("3 0 2 1\n", "3 0 2 1 0.5 0.5 0.5\n"),
        OFF.replace("50 0 0\n0", "50\n0\n0 0"),
        OFF.replace("\n", " "),
        OFF.replace(" ", "\n"),
    ],
)
def test_off_forms_of_the_same(write, text):
    assert off_corners(write("a.off", text)) == off_corners(write("b.off", OFF))


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [
        ("3 1 2 3\n", "3 1 2 3\n2 0 1\n", "fewer than three corners were left out .polygons: 1"),
        (
            "3 1 2 3\n",
            "3 1 2 3\nmade by hand\n",
            "the last facet of the OFF file, from line 11, was left out",
        ),
        ("50 0 0", "50,0 0 0", "decimal commas"),
    ],
)
def test_off_what_is_repaired_is_told(write, old, new, note):
    text = OFF.replace(old, new, 1)
    if "corners" in note:
        text = text.replace("4 4 6", "4 5 6")
    with pytest.warns(MeshWarning, match=note):
        assert len(load_probe(write("a.off", text)).faces) == 4


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("OFF\n", "OFF BINARY\n", "this is a binary OFF file, but only text is supported"),
        ("OFF\n", "4OFF\n", "the first line is not 'OFF'"),
        ("OFF\n", "\n", "the first line is not 'OFF'"),
        ("4 4 6", "4", "does not state its numbers"),
        ("4 4 6", "4 -4 6", "does not state its numbers"),
        ("4 4 6", "4 999999999999 6", "more than 4000000 facets"),
        ("4 4 6", "999999999999 4 6", "announces 999999999999 vertices.*cut short"),
        ("4 4 6", "4 0 6", "line 7 .* is one facet more"),
        ("4 4 6", "4 5 6", "announces 4 vertices and 5 facets.*cut short"),
        ("4 4 6", "4 3 6", "line 10 .* is one facet more"),
        ("4 4 6", "3 4 6", "line 10 .* is one facet more"),
        ("50 0 0", "50 0", "line 4 .* is not a vertex of three numbers"),
        ("50 0 0", "50,0,0 0 0", "line 4 .* has the number '50,0,0', whose comma"),
        ("50 0 0", "nan 0 0", r"vertex 2 is .* not finite"),
        ("3 0 1 3", "3 0 1 4", "line 8 .* refers to a vertex that does not exist .the file has 4"),
        ("3 0 1 3", "3 0 1 -1", "line 8 .* is not a facet that lists its vertices"),
        ("3 0 1 3", "4 0 1 3", "line 8 .* is not a facet that lists its vertices"),
        ("3 0 1 3", "999999999999999999 0 1 3", "line 8 .* is not a facet that lists its vertices"),
        (OFF_FACETS, "", "ends before them: it is cut short"),
    ],
)
def test_off_that_is_damaged(write, old, new, message):
    assert old in OFF
    refuse(write("a.off", OFF.replace(old, new, 1)), message)
