"""Files as other programs write them, or read them however odd they are: none is refused, all give the same surface."""

import io
import struct
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshWarning, load_probe, save_probe

pymeshlab = pytest.importorskip("pymeshlab")

BALL = trimesh.creation.icosphere(subdivisions=2, radius=40.0)
BALL.vertices = np.round(BALL.vertices * 1024) / 1024
V, F = BALL.vertices, BALL.faces
BOX = np.array([(x, y, z) for x in (0.0, 80.0) for y in (0.0, 60.0) for z in (0.0, 40.0)])
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
MIXED = [QUADS[0][:3], [QUADS[0][0], *QUADS[0][2:]], *QUADS[1:]]


def rows(values, row: str) -> str:
    return "".join(row.format(*line) for line in np.asarray(values).tolist())


# ---------------------------------------------------------------- written by trimesh


def coloured() -> trimesh.Trimesh:
    mesh = BALL.copy()
    mesh.visual.vertex_colors = np.random.default_rng(0).integers(0, 255, (len(V), 4), dtype=np.uint8)
    return mesh


def painted() -> trimesh.Trimesh:
    mesh = BALL.copy()
    mesh.visual.face_colors = np.random.default_rng(0).integers(0, 255, (len(F), 4), dtype=np.uint8)
    return mesh


def textured() -> trimesh.Trimesh:
    mesh = BALL.copy()
    mesh.visual = trimesh.visual.TextureVisuals(uv=np.random.default_rng(0).random((len(V), 2)))
    return mesh


def doubled_scene() -> trimesh.Scene:
    made = trimesh.Scene()
    metres = BALL.copy()
    metres.apply_scale(1e-3)
    made.add_geometry(metres, node_name="one", geom_name="ball")
    return made


def exported(mesh, kind: str, **options) -> bytes:
    made = mesh.export(file_type=kind, **options)
    return made.encode() if isinstance(made, str) else made


TRIMESH: dict[str, Callable[[], bytes]] = {
    "binary.stl": lambda: exported(BALL, "stl"),
    "text.stl": lambda: exported(BALL, "stl_ascii"),
    "binary.ply": lambda: exported(BALL, "ply"),
    "text.ply": lambda: exported(BALL, "ply", encoding="ascii"),
    "vertex normals.ply": lambda: exported(BALL, "ply", vertex_normal=True),
    "vertex colours.ply": lambda: exported(coloured(), "ply"),
    "face colours.ply": lambda: exported(painted(), "ply"),
    "vertex colours text.ply": lambda: exported(coloured(), "ply", encoding="ascii"),
    "plain.obj": lambda: exported(BALL, "obj"),
    "normals.obj": lambda: exported(BALL, "obj", include_normals=True),
    "vertex colours.obj": lambda: exported(coloured(), "obj", include_color=True),
    "texture.obj": lambda: exported(textured(), "obj", include_texture=False),
    "few digits.obj": lambda: exported(BALL, "obj", digits=12),
    "plain.off": lambda: exported(BALL, "off"),
    "few digits.off": lambda: exported(BALL, "off", digits=12),
    "metres.glb": lambda: doubled_scene().export(file_type="glb"),
    "colours.glb": lambda: coloured().apply_scale(1e-3).export(file_type="glb"),
    "normals.glb": lambda: BALL.copy().apply_scale(1e-3).export(file_type="glb", include_normals=True),
}


# ---------------------------------------------------------------- written by pymeshlab


def from_meshlab(
    folder: Path, name: str, quads: bool = False, filters: tuple[str, ...] = (), **options
) -> bytes:
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(V, F))
    for step in filters:
        meshes.apply_filter(step)
    if quads:
        meshes.apply_filter("meshing_tri_to_quad_by_smart_triangle_pairing")
    file = folder / name
    meshes.save_current_mesh(str(file), **options)
    return file.read_bytes()


_COLOUR = ("compute_scalar_by_discrete_curvature_per_vertex", "compute_color_from_scalar_per_vertex")
_FACE = ("compute_color_by_function_per_face",)
_WEDGE = ("compute_texcoord_parametrization_triangle_trivial_per_wedge",)

MESHLAB = {
    "a binary.stl": {},
    "a text.stl": {"binary": False},
    "a coloured.stl": {"filters": _FACE, "colormode": True, "save_face_color": True},
    "a binary.ply": {},
    "a text.ply": {"binary": False},
    "a coloured.ply": {"filters": _COLOUR, "save_vertex_color": True, "save_vertex_quality": True},
    "a face coloured.ply": {"filters": _FACE, "save_face_color": True},
    "a wedge.ply": {"filters": _WEDGE, "save_wedge_texcoord": True},
    "a wedge text.ply": {"filters": _WEDGE, "save_wedge_texcoord": True, "binary": False},
    "a plain.obj": {},
    "a normals.obj": {"save_vertex_normal": True},
    "a coloured.obj": {"filters": _COLOUR, "save_vertex_color": True},
    "a wedge.obj": {"filters": _WEDGE, "save_wedge_texcoord": True},
    "a plain.off": {},
    "a coloured.off": {"filters": _COLOUR, "save_vertex_color": True},
    "a face coloured.off": {"filters": _FACE, "save_face_color": True},
    "a quads.obj": {"quads": True},
    "a quads.off": {"quads": True},
    "a quads.ply": {"quads": True},
    "a quads text.ply": {"quads": True, "binary": False},
    "a part.3mf": {},
}


# ---------------------------------------------------------------- made by hand, the ball or a box


def stl(faces=F, header: bytes = b"", count: int | None = None, attribute: int = 0) -> bytes:
    records = np.zeros(len(faces), [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    records["c"], records["a"] = V[faces], attribute
    return (
        header.ljust(80, b"\0")
        + struct.pack("<I", len(faces) if count is None else count)
        + records.tobytes()
    )


def stl_text(number: str = "{:.9g}", newline: str = "\n", name: str = "part") -> str:
    lines = [f"solid {name}"]
    for facet in V[F].tolist():
        lines += ["  facet normal 0 0 0", "    outer loop"]
        lines += ["      vertex " + " ".join(number.format(x) for x in corner) for corner in facet]
        lines += ["    endloop", "  endfacet"]
    return newline.join([*lines, f"endsolid {name}"]) + newline


def obj(vertex: str = "v {:.9g} {:.9g} {:.9g}\n", facet: str = "f {} {} {}\n", head: str = "") -> str:
    return head + rows(V, vertex) + rows(F + 1, facet)


def box_obj(polygons) -> str:
    return rows(BOX, "v {} {} {}\n") + "".join(
        "f " + " ".join(str(i + 1) for i in p) + "\n" for p in polygons
    )


def off(
    head: str = "OFF\n", vertex: str = "{:.9g} {:.9g} {:.9g}\n", facet: str = "3 {} {} {}\n", end: str = ""
) -> str:
    return head.replace("OFF\n", f"OFF\n{len(V)} {len(F)} 0\n", 1) + rows(V, vertex) + rows(F, facet) + end


def ply(polygons, order: str, end: bytes = b"", newline: str = "\n") -> bytes:
    kind = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}[order]
    head = (
        f"ply\nformat {kind} 1.0\ncomment made by hand\nobj_info odd\nelement vertex {len(BOX)}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(polygons)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).replace("\n", newline)
    if not order:
        body = rows(BOX, "{} {} {}\n") + "".join(" ".join(map(str, [len(p), *p])) + "\n" for p in polygons)
        return (head + body.replace("\n", newline)).encode() + end
    facets = b"".join(bytes([len(p)]) + np.array(p, order + "i4").tobytes() for p in polygons)
    return head.encode() + BOX.astype(order + "f4").tobytes() + facets + end


def threemf(item: int = 1, turn: str = "1 0 0 0 1 0 0 0 1 0 0 0", head: str = "", **attributes: str) -> bytes:
    core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    extra = "".join(f' {name}="{value}"' for name, value in attributes.items())
    model = (
        f'<?xml version="1.0" encoding="UTF-8"?>{head}<model unit="millimeter" xml:lang="en-US" xmlns="{core}">'
        '<metadata name="Title">a ball</metadata><resources><basematerials id="5">'
        '<base name="red" displaycolor="#FF0000"/>'
        f'</basematerials><object id="1" type="model" pid="5" pindex="0"{extra}><mesh><vertices>'
        + rows(V, '<vertex x="{:.9g}" y="{:.9g}" z="{:.9g}"/>')
        + "</vertices><triangles>"
        + rows(F, '<triangle v1="{}" v2="{}" v3="{}" pid="5" p1="0"/>')
        + '</triangles></mesh></object><object id="2" type="model"><components><component objectid="1"'
        f' transform="{turn}"/></components></object></resources><build><item objectid="{item}"/></build></model>'
    )
    types = (
        '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default'
        ' Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default'
        ' Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
    )
    relations = (
        '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Target="/3D/3dmodel.model" Id="r"'
        ' Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    )
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", types)
        archive.writestr("_rels/.rels", relations)
        archive.writestr("3D/3dmodel.model", model)
    return out.getvalue()


FLAT = np.vstack((F, [[0, 0, 1]] * 100, [[5, 6, 5]] * 100))

BY_HAND: dict[str, Callable[[], bytes | str]] = {
    "h begins with solid.stl": lambda: stl(header=b"solid made by hand"),
    "h begins with solid facet normal.stl": lambda: stl(header=b"solid facet normal outer loop vertex"),
    "h four bytes more.stl": lambda: stl() + b"\0\0\0\0",
    "h a line more.stl": lambda: stl(header=b"solid") + b"made by hand\n",
    "h attributes.stl": lambda: stl(attribute=0x8123),
    "h many flat facets.stl": lambda: stl(FLAT),
    "h crlf text.stl": lambda: stl_text(newline="\r\n"),
    "h upper case text.stl": lambda: stl_text().upper(),
    "h name with words text.stl": lambda: stl_text(name="facet vertex 1 2 3 endsolid"),
    "h exponents text.stl": lambda: stl_text("{:+.9E}"),
    "h without endsolid text.stl": lambda: stl_text().rpartition("endsolid")[0],
    "h without name text.stl": lambda: stl_text(name=""),
    "h tabs text.stl": lambda: stl_text().replace("      ", "\t\t"),
    "h crlf.obj": lambda: obj().replace("\n", "\r\n"),
    "h tabs.obj": lambda: obj("v\t{:.9g}\t{:.9g}\t{:.9g}\n", "f\t{}\t{}\t{}\n"),
    "h more blanks.obj": lambda: obj("v   {:.9g}  {:.9g}  {:.9g}  \n", "f  {} {}  {} \n"),
    "h weights.obj": lambda: obj("v {:.9g} {:.9g} {:.9g} 1.0\n"),
    "h normals only.obj": lambda: obj(facet="f {0}//{0} {1}//{1} {2}//{2}\n") + "vn 0 0 1\n" * len(V),
    "h groups.obj": lambda: obj(head="mtllib none.mtl\no ball\ng ball\ns off\nusemtl red\n"),
    "h negative indices.obj": lambda: rows(V, "v {:.9g} {:.9g} {:.9g}\n") + rows(F - len(V), "f {} {} {}\n"),
    "h lines and points.obj": lambda: obj() + "l 1 2 3\np 4\n",
    "h comments.obj": lambda: obj(head="# made by hand\n\n   # again\n"),
    "h quads.obj": lambda: box_obj(QUADS),
    "h mixed.obj": lambda: box_obj(MIXED),
    "h comments.off": lambda: off("# made by hand\nOFF\n"),
    "h counts on the first line.off": lambda: off().replace("OFF\n", "OFF ", 1),
    "h face colours.off": lambda: off(facet="3 {} {} {} 255 0 0\n"),
    "h vertex colours.off": lambda: off("COFF\n", "{:.9g} {:.9g} {:.9g} 255 0 0 255\n"),
    "h crlf.off": lambda: off().replace("\n", "\r\n"),
    "h blank lines.off": lambda: off().replace("OFF\n", "OFF\n\n", 1) + "\n\n",
    "h little quads.ply": lambda: ply(QUADS, "<"),
    "h little mixed.ply": lambda: ply(MIXED, "<"),
    "h big mixed.ply": lambda: ply(MIXED, ">"),
    "h text mixed.ply": lambda: ply(MIXED, ""),
    "h more bytes.ply": lambda: ply(MIXED, "<", b"\0\1\2\3"),
    "h more rows.ply": lambda: ply(MIXED, "", b"1 2 3\n"),
    "h crlf.ply": lambda: ply(MIXED, "", newline="\r\n"),
    "h tabs.ply": lambda: ply(MIXED, "").replace(b"0.0 ", b"0.0\t"),
    "h plain.3mf": lambda: threemf(),
    "h object attributes.3mf": lambda: threemf(partnumber="7", name="a ball"),
    "h component.3mf": lambda: threemf(2, "0 1 0 -1 0 0 0 0 1 10 20 30"),
    "h mirrored component.3mf": lambda: threemf(2, "-1 0 0 0 1 0 0 0 1 10 20 30"),
    "h comment.3mf": lambda: threemf(head="<!-- made by hand -->"),
}


def as_others_read_it(file: Path) -> list[trimesh.Trimesh]:
    """What trimesh and pymeshlab make of a file; neither where they refuse it."""
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            theirs = trimesh.load(file, process=False)
            theirs = theirs.to_mesh() if isinstance(theirs, trimesh.Scene) else theirs
            found.append(trimesh.Trimesh(theirs.vertices, theirs.faces, process=False))
        except Exception:  # noqa: BLE001, S110 - whatever they refuse with
            pass
        try:
            meshes = pymeshlab.MeshSet(verbose=False)
            meshes.load_new_mesh(str(file))
            theirs = meshes.current_mesh()
            found.append(trimesh.Trimesh(theirs.vertex_matrix(), theirs.face_matrix(), process=False))
        except Exception:  # noqa: BLE001, S110
            pass
    return [mesh for mesh in found if len(mesh.faces)]


def same_as_theirs(file: Path, told: str | None = None, close: float = 1e-5) -> None:
    units = "auto" if file.suffix in (".3mf",) else "m" if file.suffix in (".glb", ".gltf") else "mm"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        probe = load_probe(file, units)
    said = " ".join(str(warning.message) for warning in caught if warning.category is MeshWarning)
    assert (told in said) if told else not said
    others = as_others_read_it(file)
    assert others, "no other program reads it, so it tells nothing"
    scale = 1.0 if units == "m" else 1e-3
    assert probe.health.watertight
    assert any(probe.areas.sum() == pytest.approx(other.area * scale**2, rel=close) for other in others)
    np.testing.assert_allclose(probe.bounds, others[0].bounds * scale, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("name", TRIMESH)
def test_written_by_trimesh(write, name):
    same_as_theirs(write(name, TRIMESH[name]()))


@pytest.mark.parametrize("name", MESHLAB)
def test_written_by_pymeshlab(tmp_path, write, name):
    data = from_meshlab(tmp_path, name, **MESHLAB[name])
    # A quad that is bent is cut along its shorter diagonal, as the ball was; they do not.
    same_as_theirs(write(name, data), close=0.1 if "quads" in name else 1e-5)
    if "quads" in name:
        assert load_probe(tmp_path / name, "mm").areas.sum() == pytest.approx(1e-6 * BALL.area, rel=5e-3)


TOLD = {
    "h four bytes more.stl": "(bytes: 4)",
    "h a line more.stl": "(bytes: 13)",
    "h many flat facets.stl": "Facets without area were left out (facets: 200)",
    "h without endsolid text.stl": "ends before 'endsolid'",
    "h more bytes.ply": "(bytes: 4)",
    "h more rows.ply": "(rows: 1)",
}


@pytest.mark.parametrize("name", BY_HAND)
def test_made_by_hand(write, name):
    same_as_theirs(write(name, BY_HAND[name]()), TOLD.get(name))


# ---- two real probes from a public catalogue -----------------------------------------------------


def test_loads_with_one_warning(real_file):
    with pytest.warns(MeshWarning) as caught:
        probe = load_probe(real_file)
    assert len(caught) == 1
    assert 0.1 < probe.size < 0.15
    assert not probe.health.watertight
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)
    if real_file.name.startswith("linear"):
        assert probe.health.dropped_facets == 8
        assert not probe.health.winding_consistent
        assert "surface is open" in str(caught[0].message)
    else:
        assert probe.health.dropped_facets == 0
        assert probe.health.winding_consistent


def test_agrees_with_trimesh(real_file):
    with pytest.warns(MeshWarning):
        probe = load_probe(real_file)
    theirs = trimesh.load_mesh(real_file)
    assert len(probe.vertices) == len(theirs.vertices)
    assert probe.areas.sum() == pytest.approx(theirs.area * 1e-6, rel=1e-6)
    np.testing.assert_allclose(probe.bounds, theirs.bounds / 1000, rtol=1e-6)
    assert probe.health.winding_consistent == theirs.is_winding_consistent


def test_round_trip(real_file, tmp_path):
    with pytest.warns(MeshWarning):
        probe = load_probe(real_file)
    painted = probe.with_region(np.arange(len(probe.faces)) % 5)
    save_probe(painted, tmp_path / "probe.ply")
    with pytest.warns(MeshWarning):
        again = load_probe(tmp_path / "probe.ply", units="m")
    for field in ("vertices", "faces", "region"):
        assert getattr(again, field).tobytes() == getattr(painted, field).tobytes()
