"""What an inspection finds in meshes whose defects are known."""

import json

import numpy as np
import pytest
import trimesh
from contact_cases import REAL_PROBES, bundled
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh.shell import housings

from contactbench.pipeline.mesh import MeshError, Probe
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.mesh.inspect import Inspection, inspect
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.shell import make_shell
from contactbench.pipeline.mesh.sidecar import ProbeFile, save_probe_file

BOX = trimesh.creation.box(extents=(0.06, 0.04, 0.02))


def arrays(mesh: trimesh.Trimesh) -> tuple[np.ndarray, np.ndarray]:
    return np.array(mesh.vertices), np.array(mesh.faces)


def joined(*meshes: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0, *(len(v) for v, _ in meshes)])
    return (
        np.vstack([v for v, _ in meshes]),
        np.vstack([f + start for (_, f), start in zip(meshes, starts, strict=False)]),
    )


def look(vertices, faces, name: str = "mesh", samples: int = 2000, **options) -> Inspection:
    probe = Probe.from_arrays(vertices, faces, name=name, check_size=False)
    return inspect(probe, samples=samples, **options)


def texts(found: Inspection, level: str) -> str:
    return " ".join(finding.text for finding in found.findings if finding.level == level)


def housing(wall: float = 0.002) -> tuple[np.ndarray, np.ndarray]:
    """A closed box with a closed cavity whose facets face into it, as they should."""
    inner = trimesh.creation.box(extents=np.array([0.06, 0.04, 0.02]) - 2 * wall)
    return joined(arrays(BOX), (np.array(inner.vertices), np.array(inner.faces)[:, ::-1]))


# ---------------------------------------------------------------- sound meshes


def test_a_sound_box():
    found = look(*arrays(BOX), name="box")
    assert found.sound
    assert texts(found, "fault") == texts(found, "doubt") == ""
    np.testing.assert_allclose(found.extents_m, (0.06, 0.04, 0.02))
    np.testing.assert_allclose(found.centre_m, 0, atol=1e-15)
    assert found.size_m == pytest.approx(0.06)
    assert found.area_m2 == pytest.approx(2 * (0.06 * 0.04 + 0.06 * 0.02 + 0.04 * 0.02))
    assert found.volume_m3 == pytest.approx(0.06 * 0.04 * 0.02)
    assert (found.euler, found.genus, found.part_count, found.hole_count) == (2, 0, 1, 0)
    assert found.edges.shortest_m == pytest.approx(0.02)
    assert found.edges.longest_m == pytest.approx(np.hypot(0.06, 0.04))
    assert found.slivers.smallest_angle_deg == pytest.approx(np.degrees(np.arctan2(0.02, 0.06)))
    seen = found.visibility
    assert seen.hidden_share == seen.turned_share == seen.two_sided_share == seen.double_wall_share == 0.0
    assert found.facts[0] == "box: 12 facets, 8 vertices, one part."
    assert "60.0 x 40.0 x 20.0 mm" in found.facts[1]
    assert "48.0 cm³" in found.facts[1]


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_bundled_probes_have_nothing_to_say(name):
    found = inspect(bundled(name, 2000), samples=2000)
    assert [f for f in found.findings if f.level != "note"] == []
    assert found.genus == 0
    assert found.volume_m3 == pytest.approx(100e-6, rel=0.2)


def test_torus_has_a_handle():
    found = look(*arrays(trimesh.creation.torus(major_radius=0.05, minor_radius=0.01)))
    assert (found.euler, found.genus) == (0, 1)
    assert any("1 handle" in fact for fact in found.facts)
    assert found.sound


def test_far_from_the_origin_nothing_changes():
    vertices, faces = housing()
    near, far = look(vertices, faces), look(vertices + [3.0, -2.0, 1.0], faces)
    assert far.volume_m3 == pytest.approx(near.volume_m3, rel=1e-9)
    assert far.visibility.hidden_share == pytest.approx(near.visibility.hidden_share, abs=1e-3)


# ---------------------------------------------------------------- openings


def test_open_box():
    found = look(BOX.vertices, BOX.faces[~np.isclose(BOX.face_normals[:, 2], 1.0)])
    assert found.hole_count == 1
    hole = found.holes[0]
    assert (hole.edges, hole.perimeter_m) == (4, pytest.approx(0.2))
    assert hole.widest_m == pytest.approx(np.hypot(0.06, 0.04))
    np.testing.assert_allclose(hole.centre_m, (0, 0, 0.01), atol=1e-12)
    assert (found.genus, found.volume_m3) == (None, None)
    assert found.visibility.two_sided_share > 0.9
    assert "has 1 hole. It is 72 mm wide" in texts(found, "fault")


def test_holes_come_widest_first():
    tube = trimesh.creation.cylinder(radius=0.02, height=0.1, sections=64)
    vertices, faces = arrays(tube)
    vertices[vertices[:, 2] > 0, :2] *= 0.5
    caps = np.abs(tube.face_normals[:, 2]) > 0.9
    found = look(vertices, faces[~caps])
    widths = [hole.widest_m for hole in found.holes]
    np.testing.assert_allclose(widths, [0.04, 0.02], rtol=1e-9)
    assert "The 2 widest are 40 mm, 20 mm wide" in texts(found, "fault")


def test_a_long_rim_is_measured_within_a_hundredth():
    ring = trimesh.creation.cylinder(radius=0.03, height=0.02, sections=1200)
    found = look(ring.vertices, ring.faces[np.abs(ring.face_normals[:, 2]) < 0.5])
    assert all(0.0594 <= hole.widest_m <= 0.06 + 1e-12 for hole in found.holes)


def test_unsewn_seams_are_told_from_holes():
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=0.04)
    top = mesh.triangles_center[:, 2] > 0
    halves = [(np.array(mesh.vertices), mesh.faces[half]) for half in (top, ~top)]
    found = look(*joined(*halves))
    rim = found.holes[0].edges
    assert (found.hole_count, found.seam_vertices) == (2, 2 * rim)
    assert found.coincident_vertices >= rim
    assert f"Seams are not joined: {2 * rim} vertices" in texts(found, "doubt")
    apart = look(*joined(halves[0], (halves[1][0] - [0, 0, 0.001], halves[1][1])))
    assert apart.seam_vertices == 0


def test_soup_is_counted_not_drowned_in():
    mesh = trimesh.creation.icosphere(subdivisions=4, radius=0.04)
    soup = mesh.triangles.reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3)
    found = look(*soup)
    assert found.hole_count == found.part_count == len(mesh.faces)
    assert (len(found.holes), len(found.parts)) == (100, 200)
    assert found.coincident_vertices == 3 * len(mesh.faces) - len(mesh.vertices)
    assert found.visibility.hidden_share == 0.0


# ---------------------------------------------------------------- hidden walls


def test_hollow_housing():
    found = look(*housing())
    inner = 2 * (0.056 * 0.036 + 0.056 * 0.016 + 0.036 * 0.016)
    assert found.visibility.hidden_share == pytest.approx(inner / found.area_m2, abs=0.005)
    assert [part.hidden_share for part in found.parts] == [0.0, 1.0]
    # Along the edges the way inwards stays within the wall beside it.
    assert found.visibility.double_wall_share == pytest.approx(inner / BOX.area, abs=0.02)
    assert found.visibility.wall_m == pytest.approx(0.002, rel=0.01)
    assert found.volume_m3 == pytest.approx(0.06 * 0.04 * 0.02 - 0.056 * 0.036 * 0.016)
    assert found.visibility.turned_share == 0.0
    assert "(1 of the 2 parts entirely)" in texts(found, "fault")
    assert "typically 2 mm thick" in texts(found, "fault")


def test_a_solid_part_inside_is_hidden_and_no_wall():
    core = trimesh.creation.box(extents=(0.01, 0.01, 0.005))
    found = look(*joined(arrays(BOX), arrays(core)))
    assert [part.hidden_share for part in found.parts] == [0.0, 1.0]
    assert found.visibility.double_wall_share < 0.01


def test_a_thin_fin_is_no_double_wall():
    fin = trimesh.creation.box(extents=(0.001, 0.03, 0.1))
    fin.apply_translation([0, 0, 0.06])
    assert look(*joined(arrays(BOX), arrays(fin))).visibility.double_wall_share < 0.02


def test_behind_a_small_hole_the_inner_wall_is_sheltered():
    outer, inner = (trimesh.creation.icosphere(subdivisions=4, radius=r) for r in (0.04, 0.038))
    cap = 0.97  # a hole of about 10 mm radius
    shells = [
        (np.array(m.vertices), np.array(m.faces)[m.triangles_center[:, 2] < cap * r][:, ::turn])
        for m, r, turn in ((outer, 0.04, 1), (inner, 0.038, -1))
    ]
    found = look(*joined(*shells))
    seen = found.visibility
    assert seen.hidden_share + seen.sheltered_share == pytest.approx(0.47, abs=0.05)
    assert "narrow openings" in texts(found, "doubt")


# ---------------------------------------------------------------- sides


def test_inside_out():
    found = look(BOX.vertices, BOX.faces[:, ::-1])
    assert "inside out" in texts(found, "fault")
    assert found.visibility.turned_share == 1.0
    assert found.volume_m3 == pytest.approx(-0.06 * 0.04 * 0.02)


def test_a_turned_part_beside_a_sound_one():
    vertices, faces = arrays(BOX)
    found = look(*joined((vertices, faces), (0.5 * vertices + [0.1, 0, 0], faces[:, ::-1])))
    assert found.visibility.turned_share == pytest.approx(0.2, abs=0.01)
    assert [part.turned_share for part in found.parts] == [0.0, 1.0]
    assert "20 % of the area show their back to the outside, 1 whole part among them" in texts(found, "fault")


def test_one_turned_facet():
    faces = BOX.faces.copy()
    faces[0] = faces[0, ::-1]
    found = look(BOX.vertices, faces)
    assert "Neighbouring facets disagree" in texts(found, "fault")
    assert found.visibility.turned_share == pytest.approx(BOX.area_faces[0] / BOX.area, abs=0.01)


def test_disagreement_that_is_hidden_is_a_doubt():
    vertices, faces = arrays(trimesh.creation.box(extents=(0.02, 0.02, 0.01)))
    faces[0] = faces[0, ::-1]
    found = look(*joined(arrays(BOX), (vertices, faces)))
    assert "All visible facets face outwards; only hidden ones disagree" in texts(found, "fault")


def test_a_sheet_with_one_side_is_called_a_sheet():
    n = 80
    turn = np.repeat(np.linspace(0, 2 * np.pi, n, endpoint=False), 2)
    across = np.tile([-0.01, 0.01], n)
    radius = 0.03 + across * np.cos(turn / 2)
    vertices = np.column_stack((radius * np.cos(turn), radius * np.sin(turn), across * np.sin(turn / 2)))
    quads = [[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(n - 1)] + [[2 * n - 2, 2 * n - 1, 0, 1]]
    found = look(vertices, [triangle for a, b, c, d in quads for triangle in ([a, b, c], [a, c, d])])
    assert "The mesh is an open sheet" in texts(found, "fault")
    assert "Neighbouring facets disagree" in texts(found, "fault")
    assert "hidden" not in texts(found, "fault")


# ---------------------------------------------------------------- facets and vertices


def test_duplicate_and_back_to_back_facets():
    faces = np.vstack(
        (BOX.faces, BOX.faces[[0]], BOX.faces[[1]][:, [1, 2, 0]], BOX.faces[[2, 3, 4]][:, ::-1])
    )
    found = look(BOX.vertices, faces)
    assert (found.health.duplicate_facets, found.back_to_back) == (2, 3)
    assert "2 facets are duplicates of another" in texts(found, "fault")
    assert "3 facets stand back to back" in texts(found, "fault")
    # Repeated facets have edges of more than two, and lie on each other: it is said once what they are.
    assert "More than two facets meet" not in " ".join(found.sentences)
    assert "lie on top of each other" not in " ".join(found.sentences)


def test_a_doubled_shell_is_not_inside_out():
    found = look(BOX.vertices, np.vstack((BOX.faces, BOX.faces[:, ::-1])))
    assert found.back_to_back == 12
    assert found.visibility.turned_share == 0
    assert not found.sound
    assert "inside out" not in " ".join(found.sentences)
    assert "12 facets stand back to back" in texts(found, "fault")


def test_a_copy_just_beneath_is_called_that():
    inner = BOX.vertices * (1 - 1e-5)
    found = look(*joined(arrays(BOX), (inner, np.array(BOX.faces))))
    assert "The surface is doubled" in texts(found, "fault")
    assert "hollow" not in texts(found, "fault")


def test_closed_parts_beside_each_other_are_no_fault():
    vertices, faces = arrays(BOX)
    found = look(*joined((vertices, faces), (vertices + [0.07, 0, 0], faces)))
    assert found.sound
    assert not found.clear
    assert "2 separate parts (60 x 40 x 20 mm, 60 x 40 x 20 mm); none lies inside" in texts(found, "doubt")
    assert "needs a single body" in texts(found, "doubt")
    assert "--gap" in texts(found, "doubt")
    speck = look(*joined((vertices, faces), (0.05 * vertices + [0.07, 0, 0], faces)))
    assert speck.clear
    assert "2 separate parts (60 x 40 x 20 mm, 3 x 2 x 1 mm). All but the largest are specks" in texts(
        speck, "note"
    )
    assert not look(*joined((vertices, faces), (0.5 * vertices, faces))).sound


def test_parts_that_meet_in_a_point_or_lie_on_each_other_are_faults():
    vertices, faces = arrays(BOX)
    beside = look(*joined((vertices, faces), (0.5 * vertices + [0.045, 0.003, 0.002], faces)))
    assert beside.soundness.overlapping > 0
    assert "Facets lie on top of each other" in texts(beside, "fault")
    one = trimesh.Trimesh(*joined((vertices, faces), (vertices + [0.06, 0.04, 0.02], faces)))
    pinched = look(one.vertices, one.faces)
    assert "meets itself in single points (vertices: 1)" in texts(pinched, "fault")


def bottle() -> trimesh.Trimesh:
    """A box with a mouth that is narrower than the cavity behind it."""
    mouth = trimesh.creation.box(extents=(0.004, 0.004, 0.02))
    mouth.apply_translation([0, 0, 0.01])
    inside = trimesh.creation.box(extents=(0.056, 0.036, 0.016))
    return trimesh.boolean.difference([BOX, mouth, inside])


def tube() -> trimesh.Trimesh:
    return trimesh.creation.annulus(r_min=0.001, r_max=0.0013, height=0.06, sections=16)


def test_mouths_are_counted_as_the_preparation_does():
    pytest.importorskip("pymeshlab", reason="mouths are found on a wrap by pymeshlab (extra 'meshlab')")
    found, prepared = inspect(housings.housing(), samples=2000), make_shell(housings.housing())
    assert found.mouths == tuple(each.opening.sentence for each in prepared.openings)
    assert len(found.mouths) == 1
    assert prepared.left_open in texts(found, "fault")


def test_a_mouth_into_a_cavity_is_a_fault_and_a_tube_is_not():
    pytest.importorskip("manifold3d")
    with_mouth = look(*arrays(bottle()))
    assert with_mouth.soundness.sound
    assert not with_mouth.sound
    assert "The probe is hollow" in texts(with_mouth, "fault")
    open_at_both_ends = look(*arrays(tube()))
    assert open_at_both_ends.visibility.double_wall_share > 0.5
    assert open_at_both_ends.sound
    assert "The probe is hollow" in texts(open_at_both_ends, "doubt")
    assert not open_at_both_ends.clear
    assert "closed space" not in " ".join(open_at_both_ends.sentences)


def test_what_sees_little_of_the_outside_is_told_with_its_share():
    vertices, faces = arrays(BOX)
    found = look(*joined((vertices, faces), (vertices + [0, 0, 0.0207], faces)))
    share = found.visibility.sheltered_share
    assert share > 0.1
    assert f"{100 * share:.0f} % of the area has a view of the outside only through narrow openings" in texts(
        found, "doubt"
    )


def test_a_file_whose_shell_was_made_is_not_sent_back_for_one(tmp_path):
    probe = Probe.from_arrays(*arrays(tube()))
    made = ProbeFile(probe, RegionSet.from_labels(probe.region)).after("shell", probe, {}, {})
    save_probe_file(made, tmp_path / "made.ply")
    found = inspect(tmp_path / "made.ply", samples=2000)
    assert found.shell_made
    assert found.clear
    assert "has little or no view of the outside" in texts(found, "note")
    (tmp_path / "made.json").unlink()
    assert not inspect(tmp_path / "made.ply", samples=2000).shell_made
    # A made shell that is not sound is a fault all the same.
    holed = Probe.from_arrays(probe.vertices, probe.faces[1:])
    save_probe_file(made.after("shell", holed, {}, {}), tmp_path / "holed.ply")
    assert not inspect(tmp_path / "holed.ply", samples=2000).sound


@settings(max_examples=15, derandomize=True, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), kind=st.integers(0, 5))
def test_never_sound_where_the_check_has_faults(seed, kind):
    random = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=0.05)
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    one = random.integers(len(faces))
    match kind:
        case 0:
            faces = np.delete(faces, one, axis=0)
        case 1:
            faces[one] = faces[one, ::-1]
        case 2:
            faces = np.vstack((faces, faces[[one]]))
        case 3:
            faces = np.vstack((faces, faces[[one], ::-1]))
        case 4:
            vertices[random.integers(len(vertices))] *= -random.random() - 0.5
        case _:
            vertices, faces = joined((vertices, faces), (vertices + random.normal(0, 0.03, 3), faces))
    found = look(vertices, faces, samples=200)
    assert found.sound <= found.soundness.sound
    assert found.soundness.sound or texts(found, "fault")


def test_slivers():
    # A needle of 50 x 0.05 mm: aspect 1000, angle 0.057 degrees.
    vertices = [[0, 0, 0], [0.05, 0, 0], [0.025, 0.00005, 0], [0.025, 0.02, 0]]
    found = look(vertices, [[0, 1, 2], [0, 2, 3], [2, 1, 3]])
    assert found.slivers.count == 1
    assert found.slivers.worst_aspect == pytest.approx(1000)
    assert found.slivers.smallest_angle_deg == pytest.approx(np.degrees(np.arctan(0.002)), rel=1e-6)
    assert "slivers with an angle under 1°; the worst is 1,000 times longer than high" in " ".join(
        found.sentences
    )


@settings(max_examples=10, derandomize=True, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1), keep=st.floats(0.2, 1), flip=st.floats(0, 1), scale=st.floats(1e-3, 1e3)
)
def test_any_mesh_gives_finite_numbers(seed, keep, flip, scale):
    random = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=0.05)
    faces = mesh.faces[random.random(len(mesh.faces)) < keep]
    faces = np.where(random.random(len(faces))[:, None] < flip, faces[:, ::-1], faces)
    if not len(faces):
        return
    found = look(scale * mesh.vertices, faces, samples=200)
    content = json.loads(json.dumps(found.to_json(), allow_nan=False))
    shares = [value for key, value in content["visibility"].items() if key.endswith("share")]
    assert all(0 <= share <= 1 + 1e-9 for share in shares)
    assert sum(part["facets"] for part in content["parts"]) == len(faces)
    assert sum(part["area_m2"] for part in content["parts"]) == pytest.approx(content["area_m2"])
    assert sum(hole["edges"] for hole in content["holes"]) == found.health.boundary_edges
    assert content["sound"] == (not any(f["level"] == "fault" for f in content["findings"]))


# ---------------------------------------------------------------- files, work in progress, the library


def test_file_with_surplus_vertices(tmp_path):
    vertices, faces = arrays(BOX)
    lines = [f"v {x * 2e3} {y * 2e3} {z * 2e3}" for x, y, z in [*vertices.tolist(), [1, 2, 3], vertices[0]]]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    path = tmp_path / "box.obj"
    path.write_text("\n".join(lines), encoding="utf-8")
    found = inspect(path, samples=200)
    assert (found.file.vertices, found.file.facets, found.file.surplus_vertices) == (10, 12, 2)
    assert "2 vertices in the file were double or unused" in texts(found, "note")
    assert found.name == "box"
    assert found.unit.units == "mm"
    assert any("120 mm is a probe" in fact for fact in found.facts)


def test_uncertain_units_are_a_doubt(tmp_path):
    path = tmp_path / "box.stl"
    path.write_bytes(trimesh.Trimesh(BOX.vertices * 100, BOX.faces, process=False).export(file_type="stl"))
    found = inspect(path, samples=200)
    assert found.unit.units == "cm"
    assert "60 mm if they are centimetres" in texts(found, "doubt")
    assert not any("centimetres" in fact for fact in found.facts)
    assert found.sound
    assert not found.clear
    assert "double or unused" not in " ".join(found.sentences)
    assert inspect(path, "in", samples=200).unit is None


def test_unreadable_file_and_bad_arguments(tmp_path):
    with pytest.raises(MeshError, match=r"none\.stl: there is no such file"):
        inspect(tmp_path / "none.stl")
    with pytest.raises(MeshError, match="samples=10 are too few"):
        inspect(bundled("linear", 500), samples=10)
    with pytest.raises(MeshError, match="faces: row 0"):
        look(BOX.vertices, [[0, 0, 1]])


def test_progress_rises_to_one():
    told: list[float] = []
    inspect(bundled("linear", 500), samples=2000, monitor=Monitor(told.append))
    assert told == sorted(told)
    assert (told[0], told[-1]) == (0.0, 1.0)
    assert len(told) > 8


@pytest.mark.parametrize("after", [0, 1, 3, 6, 9])
def test_cancel_stops_it(after):
    asked = iter(range(100))
    with pytest.raises(Cancelled):
        inspect(bundled("linear", 500), monitor=Monitor(cancelled=lambda: next(asked) >= after))


def test_self_intersections():
    vertices, faces = arrays(BOX)
    found = look(*joined((vertices, faces), (vertices + [0.03, 0.013, 0.007], faces)))
    assert found.soundness.crossing > 0
    assert "Facets cut through each other (pairs:" in texts(found, "fault")
    assert not found.sound
    assert look(vertices, faces).soundness.crossing == 0


def test_bodies_that_overlap_are_not_called_hollow():
    egg = trimesh.creation.icosphere(subdivisions=4, radius=0.03)
    vertices = egg.vertices * [1, 1, 1.5]
    found = look(*joined((vertices, egg.faces), (vertices + [0.02, 0, 0], egg.faces)))
    assert found.overlapping_parts == 2
    assert "2 of the 2 parts overlap, so walls of one lie inside another" in texts(found, "fault")
    assert found.visibility.double_wall_share < 0.01
    assert "hollow" not in texts(found, "fault")
    # A housing stays hollow when a body cuts through it.
    shell, inside = arrays(BOX), (0.9 * BOX.vertices, BOX.faces[:, ::-1])
    stud = trimesh.creation.box(extents=(0.01, 0.01, 0.01))
    housing_with_stud = look(*joined(shell, inside, (stud.vertices + [0, 0, 0.012], stud.faces)))
    assert housing_with_stud.overlapping_parts > 1
    assert "The probe is hollow" in texts(housing_with_stud, "fault")


@pytest.mark.parametrize(
    ("name", "parts", "wall_mm"),
    [("convex-c5-2.stl", range(1, 9), 3.0), ("linear-l14-5.stl", range(80, 91), 2.0)],
)
def test_real_probes_are_found_hollow(name, parts, wall_mm):
    path = REAL_PROBES / name
    if not path.is_file():
        pytest.skip(f"the real probe mesh {name} is not beside the repository")
    found = inspect(path, samples=2000)
    assert not found.sound
    assert found.unit.units == "mm"
    assert found.unit.certain
    assert found.part_count in parts
    assert 0.08 < found.visibility.hidden_share < 0.3
    assert found.visibility.double_wall_share > 0.2
    assert found.visibility.wall_m == pytest.approx(wall_mm / 1e3, rel=0.2)
    assert "The probe is hollow" in texts(found, "fault")
