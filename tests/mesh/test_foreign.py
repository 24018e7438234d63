"""Formats that a library reads in a process of its own: VTK, DAE and STEP."""

import gzip

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe
from contactbench.pipeline.mesh import load_probe as load_any
from contactbench.pipeline.mesh.engines import stop_engines
from contactbench.pipeline.mesh.inspect import inspect
from contactbench.pipeline.preparation.prepare import import_mesh

from .step_files import Step

BOX = np.array([(x, y, z) for x in (0, 80) for y in (0, 60) for z in (0, 40)])
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


@pytest.fixture(scope="module", autouse=True)
def _stop():
    yield
    stop_engines()


def load_probe(path) -> Probe:
    probe = load_any(path)
    assert probe.health.sentences == ()
    return probe


def refuse(path, words: str) -> None:
    with pytest.raises(MeshError, match=words) as caught:
        load_any(path)
    assert str(path) in str(caught.value)


def flat(rows) -> str:
    return " ".join(str(number) for row in rows for number in row)


# ---------------------------------------------------------------- VTK


LEGACY = (
    "# vtk DataFile Version 3.0\nbox\nASCII\nDATASET POLYDATA\n"
    f"POINTS 8 float\n{flat(BOX)}\nPOLYGONS 6 30\n{flat([4, *quad] for quad in QUADS)}\n"
)
STRIPS = [[0, 1, 2, 3, 6, 7, 4, 5], [7, 3, 5, 1, 4, 0, 6, 2]]
XML = (
    '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0"><PolyData>'
    '<Piece NumberOfPoints="8" NumberOfPolys="6"><Points><DataArray type="Float32" NumberOfComponents="3"'
    f' format="ascii">{flat(BOX)}</DataArray></Points><Polys><DataArray type="Int64" Name="connectivity"'
    f' format="ascii">{flat(QUADS)}</DataArray><DataArray type="Int64" Name="offsets" format="ascii">'
    "4 8 12 16 20 24</DataArray></Polys></Piece></PolyData></VTKFile>"
)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.vtk", LEGACY),
        ("a.vtp", XML),
        (
            "a.vtk",
            LEGACY.partition("POLYGONS")[0] + f"TRIANGLE_STRIPS 2 18\n{flat([8, *s] for s in STRIPS)}\n",
        ),
    ],
)
def test_vtk(write, name, text):
    pytest.importorskip("vtkmodules")
    probe = load_probe(write(name, text))
    assert (len(probe.vertices), len(probe.faces), probe.health.watertight) == (8, 12, True)
    assert probe.bounds.tolist() == [[0, 0, 0], [0.08, 0.06, 0.04]]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            LEGACY.replace("POLYDATA", "UNSTRUCTURED_GRID"),
            "damaged, or holds no surface.*You can also export the part",
        ),
        (LEGACY[:-20], "damaged"),
        (LEGACY.replace("POINTS 8", "POINTS 99999999999"), "announces 99999999999 numbers, more than its"),
        (LEGACY.replace("6 30", "6 2147483648"), "announces 2147483648 numbers, more than its"),
        (LEGACY.replace("4 0 1 3 2", "4 0 1 3 9"), "refers to vertex 9"),
        (LEGACY.replace("4 0 1 3 2", "-4 0 1 3 2"), "damaged|holds no facets"),
        (XML.replace("PolyData", "ImageData"), "damaged, or holds no surface"),
        (XML.replace('NumberOfPoints="8"', 'NumberOfPoints="99999999999"'), "damaged|died"),
        (XML[:-60], "damaged"),
    ],
)
def test_vtk_that_is_damaged_or_hostile(write, text, words):
    pytest.importorskip("vtkmodules")
    refuse(write("a.vtk", text), words)


# ---------------------------------------------------------------- DAE


DAE = f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="box"><mesh>
<source id="p"><float_array id="pa" count="24">{flat(BOX / 20)}</float_array><technique_common>
<accessor source="#pa" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="6"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4 4 4 4 4 4</vcount><p>{flat(QUADS)}</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><translate>0 0 10</translate><node><scale>0.5 1 1</scale>
<instance_geometry url="#box"/></node></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.mark.parametrize(("metre", "up"), [("0.0254", "Z"), ("0.3048", "Y"), ("0.01", "X")])
def test_dae_has_its_unit_and_its_places(write, metre, up):
    pytest.importorskip("collada")
    read = import_mesh(write("a.dae", DAE.replace("0.0254", metre).replace("Z_UP", f"{up}_UP")))
    assert [f"{up.lower()} axis points up" in note for note in read.notes] == [True] * (up != "Z")
    assert (len(read.probe.vertices), len(read.probe.faces), read.probe.health.watertight) == (8, 12, True)
    assert read.probe.bounds == pytest.approx(float(metre) * np.array([[0, 0, 10], [2, 3, 12]]), rel=1e-6)


def test_dae_without_a_unit_is_in_metres_where_that_can_be(write):
    pytest.importorskip("collada")
    with pytest.warns(MeshWarning, match="defined in metres, but 3 m is impossible"):
        load_any(write("a.dae", DAE.replace('<unit name="inch" meter="0.0254"/>', "")))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<vcount>4 4 4", "<vcount>4 4 9", "pycollada|DAE"),
        (f"<p>{QUADS[0][0]} {QUADS[0][1]}", "<p>0 99", "pycollada|refers to vertex 99"),
        ("<vertices", "<vertices_", "pycollada refused 'read DAE'"),
        ("</COLLADA>", "", "pycollada refused 'read DAE'.*You can also export the part"),
        ('url="#box"', 'url="#none"', "holds no facets"),
        ("<float_array", "<floats", "pycollada refused"),
    ],
)
def test_dae_that_is_damaged(write, old, new, words):
    pytest.importorskip("collada")
    assert old in DAE
    refuse(write("a.dae", DAE.replace(old, new, 1)), words)


# ---------------------------------------------------------------- STEP


@pytest.fixture
def reader(tmp_path, monkeypatch):
    """A module in the place of cascadio, which brings 99 MB: its code decides what is read."""

    def make(code: str) -> None:
        (tmp_path / "cascadio.py").write_text(code, "utf-8")
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        stop_engines()

    yield make
    stop_engines()


@pytest.mark.parametrize(
    ("unit", "words"),
    [("CONVERSION_BASED_UNIT('INCH',#2)", "drawn in inches, was"), ("SI_UNIT($,.METRE.)", "in metres, was")],
)
def test_step_is_tessellated_in_millimetres(write, reader, unit, words):
    placed = trimesh.Scene()
    placed.add_geometry(trimesh.creation.box((0.08, 0.06, 0.04)), transform=np.diag([2.0, 1, 1, 1]))
    glb = write("a.glb", placed.export(file_type="glb"))
    reader(
        "def load(data, kind, tolerance, angle, use_parallel):\n"
        "    assert (kind, round(tolerance, 6), round(angle, 2), use_parallel) == ('step', 0.009, 0.21, False)\n"
        f"    return open({str(glb)!r}, 'rb').read() if data.startswith(b'ISO') else b''\n"
    )
    text = (
        f"ISO-10303-21; /*#8*/\n#1=(LENGTH_UNIT()NAMED_UNIT(*){unit});#2=(PLANE_ANGLE_UNIT());\n"
        "#3=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#1,#2)));\nEND-ISO-10303-21;\n"
    )
    refuse(write("a.step", text.replace("#3=", "#2=")), "several of its entities have the same number")
    with pytest.warns(MeshWarning, match=r"entities that it does not hold \(1\)"):
        load_any(write("a.step", text.replace("#1,", "#7,")))
    with pytest.warns(
        MeshWarning, match=words + " tessellated to 0.02 mm and 12° and read in millimetres, with each"
    ):
        probe = load_any(write("a.stl", text))
    assert probe.bounds * 1e3 == pytest.approx(np.array([[-80, -30, -20], [80, 30, 20]]))
    refuse(
        write("a.step", "X" + text), "a STEP file: cascadio refused 'read STEP': it is damaged.*also export"
    )


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (
            "raise ImportError('there is none')",
            r"\(there is none\): pip install 'contactbench\[step\]'.*also export",
        ),
        ("import os\ndef load(*a, **k): os.abort()", "cascadio died .SIGABRT. on 'read STEP'; nothing else"),
        ("def load(*a, **k): return b'glTF'", "ends within its header"),
    ],
)
def test_step_without_its_reader_or_with_a_broken_one(write, reader, code, words):
    reader(code)
    refuse(write("a.step", f"ISO-10303-21;\n/* {code} */\nEND-ISO-10303-21;"), words)


def alone() -> str:
    (step := Step(inches=True)).cylinder(1, 4)
    return str(step)


def placed() -> str:
    step = Step()
    disc, rod = step.cylinder(40, 20), step.cylinder(10, 60)
    spots = step.axes((0, 0, 50), z=(0, 0, -1)), step.axes((0, 0, 200), z=(1, 0, 0), x=(0, 1, 0))
    step.assembly((disc, step.frame), (disc, spots[0]), (rod, spots[1]))
    return str(step)


@pytest.mark.parametrize(
    ("made", "unit", "bounds", "parts", "volume"),
    [
        (alone, "inches", [[-25.4, -25.4, 0], [25.4, 25.4, 101.6]], 1, 4 * np.pi * 25.4**3),
        (placed, "millimetres", [[-40, -40, 0], [60, 40, 210]], 3, 70_000 * np.pi),
    ],
)
def test_step_as_cascadio_reads_it(write, made, unit, bounds, parts, volume):
    pytest.importorskip("cascadio")
    file = write("a.stp.gz", gzip.compress(made().encode()))
    content = import_mesh(file)
    said = " ".join(content.notes)
    assert f"drawn in {unit}, was tessellated to 0.02 mm" in said
    assert not any(word in said for word in ("damaged", "points up"))
    found = inspect(file, tolerance=1e-6)
    assert "tessellated to 0.001 mm" in " ".join(each.text for each in found.findings)
    assert (found.soundness.sound, found.health.watertight, found.part_count) == (True, True, parts)
    assert content.probe.bounds * 1e3 == pytest.approx(np.array(bounds), abs=0.02)
    assert found.volume_m3 * 1e9 == pytest.approx(volume, rel=1e-3)
    assert len(content.probe.faces) <= found.facets


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5])
def test_step_keeps_its_tolerance(write, tolerance):
    pytest.importorskip("cascadio")
    file = write("a.step", alone())
    assert import_mesh(file, tolerance=tolerance).history[0]["parameters"]["tolerance_mm"] == 1e3 * tolerance
    # A chord with a gap of s takes 4/3 s/r of the disc.
    lost = 1 - inspect(file, tolerance=tolerance).volume_m3 / (4 * np.pi * 0.0254**3)
    assert 0.05 < lost / (4 / 3 * tolerance / 0.0254) < 1


@pytest.mark.parametrize("name", ["a.step", "a.vtk", "a.vtp", "a.dae"])
def test_a_file_that_is_cut_short_is_refused_by_its_name(write, name):
    pytest.importorskip("vtkmodules")
    whole = {"a.step": alone(), "a.vtk": LEGACY, "a.vtp": XML, "a.dae": DAE}[name]
    # The last number of a line may go without a trace.
    for length in np.linspace(1, len(whole) - 20, 24).astype(int):
        refuse(write(name, whole[:length]), "damaged|cut short|holds no|too few|refused|is no|none of")
