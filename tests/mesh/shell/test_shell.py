"""From a hollow, open, doubled mesh to its outside."""

import manifold3d
import numpy as np
import pytest
import trimesh
from contact_cases import bundled
from mesh.shell.housings import HEIGHT, LENGTH, MOUTH, WALL, WIDTH, box, housing

from contactbench.pipeline.kernel import SurfaceIndex, crossings
from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe, load_probe
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.mesh.probe import label_parts
from contactbench.pipeline.mesh.shell import Closing, make_shell, outside
from contactbench.pipeline.mesh.shell.shell import _wanted
from contactbench.pipeline.mesh.triangles import directions as fibonacci
from contactbench.pipeline.mesh.triangles import join

pytest.importorskip("pymeshlab", reason="the outer shell is wrapped by pymeshlab (extra 'meshlab')")

ALPHA, GAP, ROUGH = 0.002, 0.004, {"alpha": 0.002, "coarse": 0.004}


@pytest.fixture(scope="module")
def closed():
    with pytest.MonkeyPatch.context() as patch:
        sewn, once = [], outside._sewn
        patch.setattr(outside, "_sewn", lambda *args: sewn.append(1) or once(*args))
        shell = make_shell(housing(), Closing.AUTO, alpha=ALPHA, coarse=GAP)
    assert len(sewn) == 1, "the mesh is sewn once"
    return shell


def test_a_sliver_that_would_lose_its_area_when_the_probe_is_placed_is_joined():
    vertices, faces = box([-0.03, -0.02, 0.0], [0.03, 0.02, 0.05])
    a, b, c = faces[0]
    (other,) = (k for k in range(1, len(faces)) if {a, b} < set(faces[k].tolist()))
    (d,) = set(faces[other].tolist()) - {a, b}
    middle = (vertices[a] + vertices[b]) / 2
    along = (vertices[c] - middle) / np.linalg.norm(vertices[c] - middle)
    m, n = len(vertices), len(vertices) + 1
    cut = [[a, m, n], [a, n, c], [m, b, n], [n, b, c], [b, m, d], [m, a, d]]
    kept = [k for k in range(len(faces)) if k not in (0, other)]
    probe = Probe.from_arrays(
        np.vstack((vertices, middle, middle + 4e-15 * along)), np.vstack((faces[kept], cut)).astype(np.int32)
    )
    T = np.eye(4)
    T[2, 3] = 0.25
    with pytest.raises(MeshError, match="zero area"):
        Probe.from_arrays(probe.vertices + T[:3, 3], probe.faces)
    shell = make_shell(probe, alpha=ALPHA, coarse=GAP).probe
    placed = Probe.from_arrays(shell.vertices + T[:3, 3], shell.faces)
    assert placed.health.watertight
    assert len(placed.faces) < len(probe.faces)


# ---- a hollow housing ------------------------------------------------------------------------------


def test_a_hollow_housing_becomes_its_outside(closed):
    assert closed.probe.health.sentences == ()
    assert closed.how == "hull"
    vertices, faces = closed.probe.vertices, closed.probe.faces
    corners = vertices[faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume == pytest.approx(LENGTH * WIDTH * HEIGHT, rel=0.02)
    whole = SurfaceIndex(*box([-LENGTH / 2, -WIDTH / 2, 0], [LENGTH / 2, WIDTH / 2, HEIGHT]))
    distance, _, _ = whole.closest(vertices)
    assert np.percentile(distance, 95) < 1e-4
    assert not crossings(vertices, faces)[2][[0, 2]].any()


def test_the_lid_is_invented_and_nothing_else(closed):
    probe = closed.probe
    centres = probe.vertices[probe.faces].mean(axis=1)
    lid = (centres[:, 2] > HEIGHT - 1e-4) & (np.abs(centres[:, 0]) < LENGTH / 2 - WALL - ALPHA)
    lid &= np.abs(centres[:, 1]) < WIDTH / 2 - WALL - ALPHA
    assert probe.invented[lid].all()
    assert not probe.invented[centres[:, 2] < HEIGHT - ALPHA].any()
    assert closed.invented_area == pytest.approx(MOUTH, rel=0.1)
    assert any("is invented: contacts there rest on a guess" in sentence for sentence in closed.sentences)


def test_the_opening_is_measured_at_its_lip(closed):
    (only,) = closed.openings
    opening = only.opening
    assert opening.length == pytest.approx(LENGTH - 2 * WALL, abs=5e-4)
    assert opening.width == pytest.approx(WIDTH - 2 * WALL, abs=5e-4)
    assert opening.depth == pytest.approx(HEIGHT - WALL, abs=1e-3)
    assert opening.axes[2] == pytest.approx([0, 0, 1], abs=0.01)
    assert opening.centre[2] == pytest.approx(HEIGHT, abs=2e-4)
    assert only.closing is Closing.RULED  # twice as long as wide


def test_no_line_from_outside_ends_on_an_inner_wall(closed):
    directions = fibonacci(400)
    origins = np.array([0, 0, HEIGHT / 2]) + HEIGHT * directions
    targets = np.random.default_rng(5).uniform(-0.01, 0.01, (400, 3)) + [0, 0, HEIGHT / 2]
    along = targets - origins
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    reach, _ = SurfaceIndex(closed.probe.vertices, closed.probe.faces).first_hit(origins, along)
    whole = SurfaceIndex(*box([-LENGTH / 2, -WIDTH / 2, 0], [LENGTH / 2, WIDTH / 2, HEIGHT]))
    true, _ = whole.first_hit(origins, along)
    assert reach == pytest.approx(true, abs=1e-4)


@pytest.mark.parametrize("closing", [Closing.FAIR, Closing.HULL])
def test_an_arched_mouth_keeps_its_arch(closing):
    arch = 0.006
    shell = make_shell(housing(arch), closing, alpha=ALPHA, coarse=GAP)
    centres = shell.probe.vertices[shell.probe.faces].mean(axis=1)
    middle = shell.probe.invented & (np.abs(centres[:, :2]) < 0.004).all(axis=1)
    height = centres[middle, 2].mean() - HEIGHT
    # A thin plate bends both ways and so rises a little above the straight lines across.
    assert height == pytest.approx(arch, abs=1.2e-3 if closing is Closing.FAIR else 3e-4)


@pytest.mark.parametrize("closings", [(), [Closing.OPEN]])
def test_a_sound_mesh_whose_opening_stays_open_is_left_as_it_is_and_says_so(closings):
    probe = housing()
    shell = make_shell(probe, closings, alpha=ALPHA, coarse=GAP)
    assert shell.probe is probe
    (only,) = shell.openings
    assert only.closing is Closing.OPEN
    assert only.opening.length == pytest.approx(LENGTH - 2 * WALL, abs=5e-4)
    assert shell.sentences[0] == "Untouched: the mesh is closed and sound."
    assert "Openings left open: 1." in shell.sentences[-1]
    assert "--close auto" in shell.sentences[-1]


def test_a_seam_or_a_body_beside_it_is_no_reason_to_close_a_mouth():
    whole, (other, beside) = housing(), box([LENGTH / 2, -WIDTH / 2, 0], [LENGTH, 0, HEIGHT])
    a, b, c = whole.faces[0]  # cut on this side of an edge only
    seam = [*whole.faces[1:], [a, 16, c], [16, b, c]], whole.vertices[[a, b]].mean(axis=0)
    body = [*whole.faces, *np.array([1, 17, 18, 19, 5, 21, 22, 23])[beside]], other
    for faces, more in (seam, body):
        probe = Probe.from_arrays(np.vstack((whole.vertices, more)), np.array(faces, dtype=np.int32))
        assert not probe.health.watertight
        shell = make_shell(probe, alpha=ALPHA, coarse=GAP)
        assert (shell.invented_area, shell.faults, shell.openings[0].closing) == (0, (), Closing.OPEN)


def test_an_opening_left_open_is_lined():
    probe = housing()
    twice = Probe.from_arrays(probe.vertices, np.concatenate((probe.faces, [[0, 1, 9]])))  # a fin: not sound
    shell = make_shell(twice, [Closing.OPEN], alpha=ALPHA, coarse=GAP)
    assert shell.invented_area < 0.1 * shell.probe.areas.sum()
    assert shell.probe.health.sentences == ()
    assert shell.openings[0].closing is Closing.OPEN
    distance, _, _ = SurfaceIndex(shell.probe.vertices, shell.probe.faces).closest(
        np.array([[0.0, 0.0, WALL], [0.0, WIDTH / 2 - WALL, HEIGHT / 2]])
    )
    assert distance.max() < 5e-4  # the inner floor and an inner wall are still there
    own = shell.probe.vertices[shell.probe.faces[~shell.probe.invented]].mean(axis=1)
    assert SurfaceIndex(twice.vertices, twice.faces).closest(own)[0].max() <= ALPHA / 4


def test_a_mouth_that_cannot_be_closed_stays_open_unless_somebody_asked(monkeypatch):
    probe = housing()
    torn = Probe.from_arrays(probe.vertices, probe.faces[1:])
    monkeypatch.setattr("contactbench.pipeline.mesh.shell.shell._Exact._emptied", lambda *_: None)
    shell = make_shell(torn, alpha=ALPHA, coarse=GAP)
    assert (shell.how, shell.openings[-1].closing) == ("hull", Closing.OPEN)
    assert shell.invented_area == pytest.approx(LENGTH * WIDTH / 2)


def test_a_hollow_that_only_a_bore_leads_into_is_filled_though_a_slot_is_seen():
    def cube(size, at):
        return manifold3d.Manifold.cube(size).translate(at)

    solid = cube((60, 24, 100), (0, 0, 0)) - cube((56, 20, 66), (2, 2, 32)) - cube((6, 16, 25), (27, 4, -1))
    bored = (solid - manifold3d.Manifold.cylinder(3, 0.5).translate((30, 12, 97.5))).to_mesh()
    probe = Probe.from_arrays(
        1e-3 * np.asarray(bored.vert_properties[:, :3]), bored.tri_verts.astype(np.int32)
    )
    shell = make_shell(probe, [Closing.AUTO], alpha=1.5e-3, coarse=3e-3)
    assert (shell.how, shell.faults, shell.openings) == ("hull", (), ())
    assert shell.soundness.volume_m3 == pytest.approx(60e-3 * 24e-3 * 100e-3, rel=0.02)
    assert make_shell(probe, [Closing.OPEN], alpha=1.5e-3, coarse=3e-3).probe is probe


def test_two_halves_with_a_slit_between_them_are_joined_along_it():
    outer, faces = box([0, 0, 0], [0.06, 0.04, 0.05], open_top=True)
    lid = outer * [1, 1, -1] + [0, 0, 0.1002]
    halves = Probe.from_arrays(np.vstack((outer, lid)), np.vstack((faces, faces[:, ::-1] + 8)))
    shell = make_shell(halves)
    assert (shell.how, shell.faults, shell.openings) == ("hull", (), ())
    assert shell.invented_area == pytest.approx(0.2 * 0.0002)


def test_regions_of_the_original_are_carried_over():
    probe = housing()
    faces = np.flatnonzero(probe.normals[:, 1] < -0.9)  # the outer front wall, and the inner back one
    region = np.zeros(len(probe.faces), dtype=int)
    region[faces] = 1
    shell = make_shell(probe.with_region(region), Closing.AUTO, alpha=ALPHA, coarse=GAP)
    area = shell.probe.areas[shell.probe.region == 1].sum()
    assert area == pytest.approx(LENGTH * HEIGHT, rel=0.05)
    assert (shell.probe.normals[shell.probe.region == 1, 1] < -0.5).mean() > 0.95


def test_a_dent_is_part_of_the_shape():
    probe = housing(depth=0.004)
    shell = make_shell(probe, alpha=ALPHA, coarse=GAP)
    assert shell.openings == ()
    assert shell.probe is probe


# ---- meshes that need less -------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_a_mesh_that_needs_nothing_is_given_back(name):
    probe = bundled(name, 2000)
    shell = make_shell(probe)
    assert shell.probe is probe
    assert (shell.how, shell.openings) == ("unchanged", ())


def test_facets_turned_over_are_turned_back():
    probe = bundled("t-shape", 2000)
    faces = probe.faces.copy()
    faces[::3] = faces[::3, ::-1].copy()
    shell = make_shell(Probe.from_arrays(probe.vertices, faces))
    assert (shell.how, shell.turned, shell.invented_area) == ("hull", len(faces[::3]), 0)
    assert np.array_equal(
        shell.probe.vertices[shell.probe.faces].mean(axis=1), probe.vertices[probe.faces].mean(axis=1)
    )
    assert shell.probe.normals == pytest.approx(probe.normals, abs=1e-12)


def test_an_inside_out_mesh_with_a_part_within_and_repeats():
    outer, faces = box([0, 0, 0], [0.05, 0.05, 0.1])
    inner, inner_faces = box([0.02, 0.02, 0.02], [0.03, 0.03, 0.03])
    vertices = np.concatenate((outer, inner))
    all_faces = np.concatenate((faces[:, ::-1], faces[:2], inner_faces + 8)).astype(np.int32)
    shell = make_shell(Probe.from_arrays(vertices, all_faces))
    assert shell.how == "hull"
    assert shell.dropped == 2 + len(inner_faces)
    assert shell.probe.health.sentences == ()
    assert shell.invented_area == 0
    assert any(sentence.endswith("repeats): 14.") for sentence in shell.sentences)


def test_facets_turned_over_and_a_fin_do_not_matter():
    """Facets turned over, and a third one at an edge, are facets all the same."""
    probe = housing(arch=0.001)
    faces = probe.faces.copy()
    faces[::3] = faces[::3, ::-1].copy()
    # A fin that stands off the lower front edge, 135 degrees from both walls: it throws next to no shadow.
    fin = np.array([[0, 1, len(probe.vertices)]], dtype=np.int32)
    vertices = np.concatenate((probe.vertices, [[0.0, -WIDTH / 2 - 0.003, -0.003]]))
    shell = make_shell(Probe.from_arrays(vertices, np.concatenate((faces, fin))), alpha=ALPHA, coarse=GAP)
    assert len(shell.openings) == 1
    corners = shell.probe.vertices[shell.probe.faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume == pytest.approx(LENGTH * WIDTH * HEIGHT, rel=0.02)


def test_a_wide_mouth_is_closed_at_its_lip_with_the_usual_lengths():
    shell = make_shell(housing(depth=0.148, width=0.04, height=0.15), Closing.AUTO, alpha=ALPHA)
    assert shell.openings[0].opening.rim[:, 2] == pytest.approx(0.15, abs=1e-4)
    lid = shell.probe.vertices[shell.probe.faces[shell.probe.invented]].mean(axis=1)
    assert np.percentile(lid[:, 2], 5) == pytest.approx(0.15, abs=2e-4)


def test_a_tube_that_one_can_look_through_is_left_as_it_is():
    for inner in (0.004, 0.016):
        tube = trimesh.creation.annulus(inner, 0.02, 0.1, sections=48)
        probe = Probe.from_arrays(tube.vertices, tube.faces.astype(np.int32))
        assert make_shell(probe, alpha=0.006).probe is probe
    assert make_shell(probe, Closing.AUTO, alpha=0.006).invented_area > 0


def test_what_was_invented_once_stays_so():
    probe = make_shell(housing(0.001), Closing.AUTO, alpha=ALPHA, coarse=GAP).probe
    side = probe.normals[:, 1] < -0.9
    pierced = side & (
        np.linalg.norm(probe.vertices[probe.faces].mean(axis=1) - [0, -0.012, 0.05], axis=1) < 0.006
    )
    kept = ~pierced
    again = Probe.from_arrays(probe.vertices, probe.faces[kept], invented=probe.invented[kept])
    shell = make_shell(again, alpha=ALPHA, coarse=GAP)
    before = probe.areas[probe.invented].sum()
    assert shell.probe.areas[shell.probe.invented].sum() > before + 0.8 * probe.areas[pierced].sum()


# ---- what is not one part --------------------------------------------------------------------------


def beside(size, apart):
    part, faces = box([0, 0, 0], [0.03, 0.03, 0.08])
    other, other_faces = box([apart, 0, 0], [apart + size, size, size])
    return Probe.from_arrays(np.concatenate((part, other)), np.concatenate((faces, other_faces + 8)))


def test_a_speck_beside_the_part_is_left_out():
    shell = make_shell(beside(0.001, 0.05), alpha=ALPHA)
    assert shell.dropped == 12
    assert shell.probe.bounds[1, 0] == pytest.approx(0.03, abs=1e-4)
    assert shell.how == "hull"


@pytest.mark.parametrize(
    ("apart", "way", "invented"),
    [
        (0.02, "Joined exactly: 2 closed bodies", 0),  # through each other
        (0.03, "Joined exactly: 2 closed bodies", 0),  # with a face in common
        (np.nextafter(0.03, 1), "Joined exactly: 2 closed bodies", 0),  # but for rounding
        (0.03001, "Bridged: 2 bodies, over gaps of less than", 120e-6),  # 10 um apart
    ],
)
def test_closed_bodies_that_overlap_touch_or_nearly_do_become_one(apart, way, invented):
    probe = beside(0.02, apart)
    shell = make_shell(probe, alpha=ALPHA)
    assert len(np.unique(label_parts(shell.probe.faces, len(shell.probe.vertices)))) == 1
    assert shell.sentences[0].startswith(way)
    assert shell.faults == ()
    assert shell.invented_area <= invented
    corners = shell.probe.vertices[shell.probe.faces[~shell.probe.invented]].reshape(-1, 3)
    assert SurfaceIndex(probe.vertices, probe.faces).closest(corners)[0].max() < 1e-9


def test_walls_that_single_precision_keeps_apart_become_one(monkeypatch):
    monkeypatch.setattr(outside, "unite", lambda *_, **__: None)  # as where not all are bodies
    noise = np.random.default_rng(0).uniform(-1e-9, 1e-9, (3, 8, 3))
    left, right = box([0, 0, 0.009], [0.02, 0.03, 0.05]), box([0.02, 0, 0.009], [0.04, 0.03, 0.04])
    bodies = [box([0, 0, 0], [0.06, 0.03, 0.01]), left, right]
    probe = Probe.from_arrays(*join([(v + n, f) for (v, f), n in zip(bodies, noise, strict=True)]))
    shell = make_shell(probe, alpha=ALPHA)
    assert (shell.faults, shell.soundness.touching, shell.invented_area) == ((), 0, 0)
    # The outside alone: without the walls between left and right.
    assert shell.probe.areas.sum() == pytest.approx(0.0106, rel=1e-6)


@pytest.mark.parametrize(("lowest", "how"), [(0.029, "hull"), (-0.04, "wrapped")])
def test_a_wrap_reaches_no_further_than_what_is_torn(lowest, how):
    ball = trimesh.creation.icosphere(4, 0.03)
    corners, rng = ball.triangles.copy(), np.random.default_rng(0)
    torn = ball.triangles_center[:, 2] > lowest
    corners[torn] += rng.normal(0, 1e-4, corners[torn].shape)
    corners = corners[~torn | (rng.random(len(torn)) < 0.8)]
    faces = np.arange(corners.size // 3, dtype=np.int32).reshape(-1, 3)
    shell = make_shell(Probe.from_arrays(corners.reshape(-1, 3), faces), alpha=0.001, coarse=0.002)
    assert (shell.how, shell.faults) == (how, ())
    if how == "hull":
        made = shell.probe.vertices
        assert shell.sentences[0].startswith("Wrapped at 1 mm where the surface is torn")
        assert shell.invented_area < 0.1 * shell.probe.areas.sum()
        assert np.abs(np.linalg.norm(made, axis=1) - 0.03).max() < 6e-4
        assert {*map(tuple, made[made[:, 2] < 0.02])} == {
            *map(tuple, ball.vertices[ball.vertices[:, 2] < 0.02])
        }


def test_two_parts_are_refused_before_the_work():
    with pytest.raises(MeshError, match="2 parts that do not touch"):
        make_shell(beside(0.03, 0.06), alpha=ALPHA)


@pytest.mark.parametrize(("lean", "fin", "way"), [(0, False, {}), (0.3, False, ROUGH), (0.3, True, ROUGH)])
def test_a_sheet_is_refused_before_it_is_wrapped_finely(lean, fin, way, monkeypatch):
    plate = np.array([[0, 0, 0], [0.1, 0, lean * 0.1], [0.1, 0.05, lean * 0.1], [0, 0.05, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    if fin:
        body = box([-0.02, -0.02, -0.02], [0.02, 0.02, 0.02])
        plate, faces = np.concatenate((plate, body[0])), np.concatenate((faces, body[1] + 4))
    monkeypatch.setattr(
        "contactbench.pipeline.mesh.shell.shell.fine_wrap", lambda *_, **__: pytest.fail("wrapped finely")
    )
    with pytest.raises(MeshError, match="a sheet without thickness"):
        make_shell(Probe.from_arrays(plate, faces), **way)


# ---- asked for nonsense, or stopped ----------------------------------------------------------------


def test_lengths_that_make_no_sense_are_refused():
    with pytest.raises(MeshError, match="alpha must be at least"):
        make_shell(housing(), alpha=1e-6)
    with pytest.raises(MeshError, match="at most 25 mm"):
        make_shell(housing(), coarse=0.05)


def test_more_closings_than_openings_are_refused():
    with pytest.raises(MeshError, match="2 closings were given, but the mesh has 1 opening"):
        make_shell(housing(), [Closing.HULL, Closing.HULL], alpha=ALPHA, coarse=GAP)


def test_the_last_closing_counts_for_the_rest():
    assert _wanted([None] * 2, [Closing.HULL]) == [Closing.HULL] * 2
    assert _wanted([None] * 2, [Closing.HULL, Closing.OPEN]) == [Closing.HULL, Closing.OPEN]
    assert _wanted([], [Closing.FAIR]) == []


def test_it_can_be_stopped_and_tells_how_far_it_is():
    told = []
    with pytest.raises(Cancelled):
        make_shell(housing(), alpha=ALPHA, coarse=GAP, monitor=Monitor(told.append, lambda: len(told) > 5))
    assert told == sorted(told)
    assert 0 <= told[0] <= told[-1] < 1


# ---- real probes -----------------------------------------------------------------------------------


def test_a_real_probe(real_file):
    with pytest.warns(MeshWarning):
        probe = load_probe(real_file)
    shell = make_shell(probe, alpha=probe.size / 40)
    assert shell.faults == ()
    assert (shell.how, shell.why) == ("hull", "")  # slivers are no reason to wrap, nor specks to bridge
    lens = shell.openings[0]
    assert lens.opening.axes[2] == pytest.approx([0, 1, 0], abs=0.02)
    assert lens.closing is Closing.RULED
    assert not crossings(shell.probe.vertices, shell.probe.faces)[2][[0, 2]].any()
