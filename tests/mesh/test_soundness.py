"""Whether a finished mesh can be trusted: each defect by itself, and shapes that only look defective."""

import json
from itertools import product

import numpy as np
import pytest
from contact_cases import ball, bundled

from contactbench.pipeline.mesh.soundness import OVERLAP, TOUCHING, check_soundness

CUBE = 0.01 * np.array(list(product((0.0, 1.0), repeat=3)))
CUBE_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
     [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], dtype=np.int32
)  # fmt: skip


def cube(shift=(0.0, 0.0, 0.0), size=1.0, inwards=False):
    return CUBE * size + shift, CUBE_FACES[:, ::-1] if inwards else CUBE_FACES


def joined(*meshes):
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes[:-1]])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + start for (_, faces), start in zip(meshes, starts, strict=True)]).astype(
            np.int32
        ),
    )


def prism(outline, length, layers=1):
    """Closed prism along y over a convex outline (k, 2) in x and z, counterclockwise seen from -y."""
    count = len(outline)
    y = np.linspace(0, length, layers + 1)
    rings = [np.column_stack((outline[:, 0], np.full(count, each), outline[:, 1])) for each in y]
    faces = []
    for layer, i in product(range(layers), range(count)):
        a, b = layer * count + i, layer * count + (i + 1) % count
        faces += [[a, b, b + count], [a, b + count, a + count]]
    last = layers * count
    for i in range(1, count - 1):
        faces += [[0, i + 1, i], [last, last + i, last + i + 1]]
    return np.concatenate(rings), np.array(faces, dtype=np.int32)


def sentence_of(mesh, *others, **more):
    found = check_soundness(*mesh, *others, **more)
    assert not found.sound
    assert len(found.faults) == 1, found.faults
    assert found.to_json()["sentences"] == list(found.sentences)
    return found, found.faults[0]


@pytest.mark.parametrize("away", [0.0, 10.0])
def test_sound_shapes(away):
    probe = ball(320)
    for mesh in ((probe.vertices + away, probe.faces), cube((away, 0, 0))):
        found = check_soundness(*mesh, mesh)
        assert found.sound
        assert found.sentences == ()
        assert found.largest_deviation_deg == pytest.approx(0, abs=1e-5)
    assert found.volume_m3 == pytest.approx(1e-6, rel=1e-12 if away == 0 else 1e-9)
    assert json.loads(json.dumps(found.to_json()))["sound"] is True
    assert check_soundness(*cube()).largest_deviation_deg is None


def test_simplified_probes_stay_close_to_their_originals_normals():
    fine, coarse = bundled("t-shape", 5000), bundled("t-shape", 500)
    found = check_soundness(coarse.vertices, coarse.faces, (fine.vertices, fine.faces))
    assert found.sound
    assert 5 < found.largest_deviation_deg < 45


def test_an_open_mesh():
    vertices, faces = cube()
    found, sentence = sentence_of((vertices, faces[1:]))
    assert "open (edges at a hole or gap: 3)" in sentence
    assert found.to_json()["closed"] is False


def test_a_facet_turned_over():
    vertices, faces = cube()
    faces = faces.copy()
    faces[3] = faces[3, ::-1]
    assert "disagree" in sentence_of((vertices, faces))[1]


def test_one_of_two_parts_is_inside_out():
    found, sentence = sentence_of(joined(cube(size=3.0), cube((0.1, 0, 0), inwards=True)))
    assert "Separate parts are inside out (parts: 1)" in sentence
    assert found.inward_parts == 1


def test_parts_beside_each_other_are_sound():
    found = check_soundness(*joined(cube(), cube((0.0102, 0, 0)), cube((0.0, 0.02, 0))))
    assert found.sound
    assert found.health.components == 3
    assert found.volume_m3 == pytest.approx(3e-6)


@pytest.mark.parametrize("inwards", [False, True])
def test_parts_inside_another(inwards):
    """Also where the ray from one of them meets its neighbour inside the same body first."""
    towards = np.array([0.573, 0.681, 0.456])
    inner = [cube(0.02 + 0.012 * k * towards / 0.6, 0.5, inwards) for k in range(3)]
    body = cube(size=9.0)
    beside = cube((0.2, 0, 0))
    found, sentence = sentence_of(joined(*inner[:2], body, beside, inner[2]))
    assert "inside the body (parts: 3)" in sentence
    assert found.inward_parts == 0
    assert set((found.nested_facets // 12).tolist()) == {0, 1, 4}


def test_parts_inside_one_that_is_inside_out():
    found = check_soundness(
        *joined(cube((0.02, 0.02, 0.02)), cube(size=9.0, inwards=True), cube((0.2, 0, 0)))
    )
    assert found.nested_facets.tolist() == list(range(12))
    assert found.inward_parts == 1


def test_a_vertex_with_two_fans():
    vertices, faces = joined(cube(), cube(CUBE[7]))
    faces[faces == 8] = 7
    found, sentence = sentence_of((vertices, faces))
    assert "single points (vertices: 1)" in sentence
    assert found.pinched_vertices.tolist() == [7]
    for turned in range(len(faces)):
        some = faces.copy()
        some[turned] = some[turned, ::-1]
        assert check_soundness(vertices, some).pinched_vertices.tolist() == [7]


@pytest.mark.parametrize("corner", range(8))
def test_bodies_that_touch_in_a_corner(corner):
    """The same place, but each cube has its own vertex: told, and no fault."""
    found = check_soundness(*joined(cube(), cube(2 * CUBE[corner] - 0.01)))
    assert found.sound
    assert found.sentences[0].startswith("Facets touch")
    assert found.touching > 0
    assert len(found.facets_of(TOUCHING)) > 1


def test_an_edge_of_four_facets():
    vertices, faces = joined(cube(), cube(CUBE[6]))
    faces[faces == 8], faces[faces == 9] = 6, 7
    found, sentence = sentence_of((vertices, faces))
    assert "More than two facets meet at an edge (edges: 1)" in sentence
    assert len(found.pinched_vertices) == 0


def test_bodies_that_cross():
    found, sentence = sentence_of(joined(cube(), cube((0.003, 0.004, 0.005))))
    assert f"cut through each other (pairs: {found.crossing})" in sentence
    assert found.crossing > 0
    assert found.nested_parts == 0


def test_bodies_that_lie_on_each_other():
    found, sentence = sentence_of(joined(cube(), cube((0.01, 0.002, 0.003))))
    assert f"on top of each other (pairs: {found.overlapping})" in sentence
    assert set(found.facets_of(OVERLAP)) == {2, 3, 12, 13}


def test_a_mesh_twice_is_told_once():
    vertices, faces = cube()
    found = check_soundness(vertices, np.concatenate((faces, faces)))
    assert found.overlapping == 12
    assert not any("on top" in sentence for sentence in found.faults)
    assert any("occur more than once (surplus: 12)" in sentence for sentence in found.faults)


def test_a_facet_without_area():
    vertices, faces = cube()
    vertices = np.concatenate((vertices, [(vertices[0] + vertices[3]) / 2]))
    # The diagonal of one side has a vertex on the one hand only: the gap is filled by a facet without area.
    faces = np.concatenate((faces[1:], [[0, 1, 8], [8, 1, 3], [0, 8, 3]])).astype(np.int32)
    found, sentence = sentence_of((vertices, faces), (vertices, faces))
    assert "no area (facets: 1)" in sentence
    assert found.flat_facets.tolist() == [13]
    assert np.isnan(found.normal_deviation_deg[13])


def folded_ball():
    """A ball one vertex of which was pulled over an edge of its ring: a facet is turned over, hardly displaced."""
    probe = ball(320)
    vertices = probe.vertices.copy()
    corner = int(probe.faces[7, 0])
    a, b = vertices[probe.faces[7, 1]], vertices[probe.faces[7, 2]]
    vertices[corner] += 1.3 * ((a + b) / 2 - vertices[corner])
    return probe, vertices


def test_a_facet_turned_over_by_a_moved_vertex():
    probe, vertices = folded_ball()
    found = check_soundness(vertices, probe.faces, (probe.vertices, probe.faces))
    assert 7 in found.folded_facets
    assert len(found.folded_facets) <= 3
    assert found.normal_deviation_deg[7] > 120
    assert any("turned against the original surface" in fault for fault in found.faults)
    # Seen by itself it need not be wrong: it is not thin.
    assert len(check_soundness(vertices, probe.faces).folded_facets) == 0


def test_an_original_that_faces_inwards_counts_both_ways():
    """Its own mistakes are not the result's."""
    probe = ball(320)
    found = check_soundness(probe.vertices, probe.faces, (probe.vertices, probe.faces[:, ::-1]))
    assert found.sound
    assert found.largest_deviation_deg == pytest.approx(0, abs=1e-5)
    some = probe.faces.copy()
    some[:40] = some[:40, ::-1]
    assert check_soundness(probe.vertices, probe.faces, (probe.vertices, some)).sound


def test_what_is_invented_is_not_compared():
    probe, vertices = folded_ball()
    invented = np.zeros(len(probe.faces), dtype=bool)
    turned = check_soundness(vertices, probe.faces, (probe.vertices, probe.faces)).folded_facets
    invented[turned] = True
    found = check_soundness(vertices, probe.faces, (probe.vertices, probe.faces), invented=invented)
    assert len(found.folded_facets) == 0
    assert np.array_equal(np.flatnonzero(np.isnan(found.normal_deviation_deg)), turned)


def wedge(tip):
    """A blade of 40 mm, 8 mm wide, 1 mm thick at its back, the edge at x = 8 mm cut off to `tip` metres."""
    outline = [[0.0, 0.0005], [0.0, -0.0005]]
    outline += [[0.008, 0.0]] if tip == 0 else [[0.008 - 8 * tip, -tip / 2], [0.008 - 8 * tip, tip / 2]]
    return prism(np.array(outline)[::-1], 0.04, layers=5)


def test_the_edge_of_a_blade_is_no_fold():
    """Its facets are 173 degrees apart; simplified, its edge may be cut off square."""
    sharp, cut = wedge(0.0), wedge(5e-6)
    for mesh in (sharp, cut):
        assert check_soundness(*mesh).sound
        for original in (sharp, cut):
            found = check_soundness(*mesh, original)
            assert found.sound, found.faults
            assert found.largest_deviation_deg < 31


def test_the_end_of_a_crack_is_no_fold():
    """Its walls are 178 degrees apart, and one is short."""
    outline = [[5, 5], [5.02, 10], [10, 10], [10, 0], [0, 0], [0, 5.3], [4.99, 5.3]]
    found = check_soundness(*prism(1e-3 * np.array(outline), 0.01))
    assert (found.faults, found.folded_facets.tolist()) == ((), [])


@pytest.mark.parametrize("which", [0, 1, -2, -1])
@pytest.mark.parametrize("lift", [0.0, 2e-4])
def test_a_blades_facet_turned_over_is_a_fold(lift, which):
    """The other side of the blade has the same normal, but lies too far off to be what the facet stands for."""
    blade = wedge(0.0)
    vertices, faces = blade
    facet = [f for f in faces if np.ptp(vertices[f, 1]) > 0 and np.ptp(vertices[f, 0]) > 0.001][which]
    # A vertex of its plane that lies over its longest side: of the three facets that replace it one is turned over.
    sides = np.linalg.norm(vertices[np.roll(facet, -1)] - vertices[facet], axis=1)
    facet = np.roll(facet, 1 - np.argmax(sides))
    a, b, c = vertices[facet]
    up = np.cross(b - a, c - a)
    beyond = a + 0.53 * (b - a) + 0.53 * (c - a) + lift * up / np.linalg.norm(up)
    split = [[facet[i], facet[(i + 1) % 3], len(vertices)] for i in range(3)]
    keep = ~np.isin(faces, facet).all(axis=1)
    made = np.concatenate((vertices, [beyond])), np.concatenate((faces[keep], split)).astype(np.int32)
    found = check_soundness(*made, blade)
    assert found.folded_facets.tolist() == [len(faces)]
    assert found.largest_deviation_deg > 120


def test_the_tip_of_a_needle_may_be_cut_off():
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))

    def needle(cut):
        base = ring * 0.0005
        side = [[i, (i + 1) % 24, 24] for i in range(24)]
        if cut == 0:
            vertices, top = np.array([[0, 0, 0.03]]), np.array(side)
        else:
            vertices = ring * 0.0005 * cut + [0, 0, 0.03 * (1 - cut)]
            top = np.array(
                [[i, (i + 1) % 24, 24 + (i + 1) % 24] for i in range(24)]
                + [[i, 24 + (i + 1) % 24, 24 + i] for i in range(24)]
                + [[24, 24 + i, 25 + i] for i in range(1, 23)]
            )
        floor = np.array([[0, i + 1, i] for i in range(1, 23)])
        return np.concatenate((base, vertices)), np.concatenate((top, floor)).astype(np.int32)

    for cut in (0.001, 0.1):
        found = check_soundness(*needle(cut), needle(0.0))
        assert found.sound, found.faults
        assert found.largest_deviation_deg < 10


def strip(*corners):
    """A facet by itself, or two for four corners."""
    return np.array(corners, dtype=float), np.array(
        [[0, 1, 2], [0, 2, 3]][: len(corners) - 2], dtype=np.int32
    )


FLOOR = strip([-0.02, -0.02, 0], [0.02, -0.02, 0], [0.02, 0.02, 0], [-0.02, 0.02, 0])


def test_a_facet_that_hangs_over_an_edge_turned_over():
    """Normals of both sides of the edge are near, but it has neither of them nor one between."""
    vertices, faces = cube()
    facet = next(f for f in faces if (vertices[f, 2] == 0.01).all() and (vertices[f, 0] == 0.01).sum() == 2)
    facet = np.roll(facet, -int(np.argmin(vertices[facet, 0])))
    a, b, c = vertices[facet]
    split = [[facet[i], facet[(i + 1) % 3], 8] for i in range(3)]
    keep = ~np.isin(faces, facet).all(axis=1)
    made = (
        np.concatenate((vertices, [a + 0.53 * (b - a) + 0.53 * (c - a)])),
        np.concatenate((faces[keep], split)),
    )
    found = check_soundness(*made, (vertices, faces))
    assert found.folded_facets.tolist() == [12]
    assert found.normal_deviation_deg[12] > 80


def test_a_step_that_moved_is_the_same_step():
    """What is nearest to it by now is the floor, but the step it was is near."""
    wall = strip([0, 0, 0], [0, 0.01, 0], [0, 0.01, 5e-6], [0, 0, 5e-6])
    moved = wall[0] + [4e-6, 0, 0], wall[1]
    assert check_soundness(*moved, joined(FLOOR, wall)).largest_deviation_deg < 1e-3
    assert check_soundness(*moved, FLOOR).largest_deviation_deg == pytest.approx(90)


def test_a_long_facet_that_fits_at_one_end():
    long = strip([0, 0, 0], [0, 0.018, 0], [0, 0, 2e-5])
    wall = strip([0, 0.011, 0], [0, 0.018, 0], [0, 0.018, 1e-4], [0, 0.011, 1e-4])
    assert check_soundness(*long, joined(FLOOR, wall)).largest_deviation_deg < 1e-3


def test_a_plane_through_a_rough_surface():
    """Teeth of 40 degrees, half as far apart as what counts as near: their mean is the plane."""
    pitch = 2e-5
    x = np.arange(-50, 51) * pitch
    z = np.where(np.arange(101) % 2 == 0, -0.5, 0.5) * pitch * np.tan(np.radians(40))
    rim = np.stack([np.column_stack((x, np.full(101, y), z)) for y in (-0.02, 0.02)], axis=1).reshape(-1, 3)
    quads = 2 * np.arange(100)[:, None]
    faces = np.concatenate((quads + [0, 2, 3], quads + [0, 3, 1])).astype(np.int32)
    # All its corners in the middle of a tooth's side, so that it misses the surface nowhere that is looked at.
    plane = strip(*([(i + 0.5) * pitch, y, 0] for i, y in ((-36, -0.01), (36, -0.01), (0, 0.01))))
    size = np.array([[0.0, 0, 0], [1e-5, 0, 0], [0, 0.04, 0]])
    away = size + [0.0, -0.02, 0.0], np.array([[0, 1, 2]], dtype=np.int32)
    assert check_soundness(*joined(plane, away), (rim, faces)).normal_deviation_deg[0] < 1


def test_between_both_sides_of_a_sheet_there_is_no_direction():
    """Normals are opposite but for rounding, which must not decide what is between them."""
    wall = strip([0, 0, 0], [0, 0.01, 0], [0, 0.01, 2e-6], [0, 0, 2e-6])
    sheet = joined(FLOOR, (FLOOR[0] - [0, 0, 1e-6], FLOOR[1][:, ::-1]))
    rng = np.random.default_rng(5)
    for _ in range(20):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        found = check_soundness(wall[0] @ turn, wall[1], (sheet[0] @ turn, sheet[1]))
        assert found.largest_deviation_deg == pytest.approx(90, abs=1e-6)


def pulled_over_its_edge(by):
    """Return a cube with a vertex beside the diagonal of a side that was pulled over it, by this share of its half."""
    vertices, faces = cube()
    middle = (vertices[1] + vertices[7]) / 2
    beside = middle + by * (vertices[5] - middle)  # over the diagonal of the facets 1 5 7 and 1 7 3
    faces = np.concatenate((faces[:11], [[1, 7, 8], [7, 3, 8], [3, 1, 8]])).astype(np.int32)
    return np.concatenate((vertices, [beside])), faces


def test_a_sliver_that_folds_back_with_or_without_an_original():
    """A vertex beside an edge that was pulled over it: the thin facet lies on its neighbour, upside down."""
    mesh = pulled_over_its_edge(0.002)
    mesh[0][8, 2] += 1e-6
    found, sentence = sentence_of(mesh)
    assert found.folded_facets.tolist() == [11]
    assert "Thin facets fold back onto their neighbours (facets: 1)" in sentence
    # That it was so before is no excuse: nobody who looks at the result alone would know.
    assert check_soundness(*mesh, mesh).folded_facets.tolist() == [11]


def test_a_fold_too_small_to_be_touched_is_told_and_no_fault():
    vertices, faces = pulled_over_its_edge(1e-5)
    vertices[8, 2] += 1e-9
    found = check_soundness(vertices, faces)
    assert (found.folded_facets.tolist(), found.faults) == ([11], ())
    assert 0 < found.folded_share < 5e-5
    assert "fold back onto their neighbours (facets: 1). No action needed" in found.sentences[-1]


def test_a_sliver_without_area_is_not_folded_as_well():
    found = check_soundness(*pulled_over_its_edge(1e-15))
    assert found.flat_facets.tolist() == [11]
    assert found.folded_facets.tolist() == []


def test_an_original_with_a_part_inside_out_says_nothing_of_sides():
    bar, other = cube(), cube()
    inverted = (0.3 * other[0] + [0.03, 0, 0], other[1][:, ::-1])
    outward = (inverted[0], other[1])
    found = check_soundness(*joined(bar, outward), joined(bar, inverted))
    assert found.sound
    assert found.largest_deviation_deg == pytest.approx(0, abs=1e-6)


def test_the_steepest_angle_can_be_chosen():
    fine, coarse = bundled("t-shape", 5000), bundled("t-shape", 500)
    found = check_soundness(coarse.vertices, coarse.faces, (fine.vertices, fine.faces), steepest_deg=15)
    assert len(found.folded_facets) == np.count_nonzero(found.normal_deviation_deg > 15) > 0


def test_too_entangled_to_check():
    rng = np.random.default_rng(1)
    found = check_soundness(rng.random((3000, 3)), np.arange(3000, dtype=np.int32).reshape(-1, 3))
    assert found.every_pair_checked is False
    assert any("too entangled" in fault for fault in found.faults)
