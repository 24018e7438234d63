"""The outer hull of a soup of facets, cut where they cross and closed where they leave holes."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from mesh.shell.housings import box
from scipy.spatial.transform import Rotation

from contactbench.pipeline.kernel import crossings
from contactbench.pipeline.mesh import MeshWarning, Probe
from contactbench.pipeline.mesh.load import load_probe
from contactbench.pipeline.mesh.probe import edge_table, measure_health
from contactbench.pipeline.mesh.shell.outside import find_outside, outer_hull, sew_up, unite
from contactbench.pipeline.mesh.shell.result import HULL, Shell
from contactbench.pipeline.mesh.shell.shell import _tidied
from contactbench.pipeline.mesh.shell.tidy import (
    cut_crossings,
    distinct,
    holes,
    open_edges,
    sew,
    without_slivers,
)
from contactbench.pipeline.mesh.soundness import check_soundness
from contactbench.pipeline.mesh.triangles import join

pytest.importorskip("igl", reason="facets are cut by CGAL through libigl (extra 'meshlab')")


def soup(*bodies):
    return join(bodies)


def outside_of(vertices, faces):
    found = find_outside(sew_up(vertices, faces, smallest=0.5, spacing=0.1).cut())
    return found and found[0]


def volume(vertices, faces):
    corners = vertices[faces]
    return np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6


UNIT = box([0, 0, 0], [1, 1, 1])


@pytest.mark.parametrize(
    ("other", "whole"),
    [
        (box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5]), 2 - 0.125),  # through each other
        (box([1, 0.2, 0.2], [1.5, 0.7, 0.7]), 1.125),  # standing on a face
        (box([0.2, 0.2, 0.2], [0.5, 0.5, 0.5]), 1.0),  # inside
        (box([0.2, 0.2, 0.5], [0.5, 0.5, 1.0]), 1.0),  # inside, and flush with a face
        (box([1, 1, 0], [2, 2, 1]), 2.0),  # an edge in common
        (box([1, 1, 1], [2, 2, 2]), 2.0),  # a corner in common
        (box([1.01, 0, 0], [2, 1, 1]), 1.99),  # beside
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_two_bodies_become_their_union_to_the_digit(other, whole, turned):
    vertices, faces = soup(UNIT, (other[0], other[1][:, ::-1] if turned else other[1]))
    found = outside_of(vertices, faces)
    health = measure_health(found.vertices, found.faces)
    assert health.watertight
    assert health.winding_consistent
    assert health.nonmanifold_edges == 0
    assert volume(found.vertices, found.faces) == pytest.approx(whole, abs=1e-8)
    assert not crossings(found.vertices, found.faces)[2][[0, 2]].any()
    assert (found.born >= 0).all()


@pytest.mark.parametrize(
    "faces",
    [
        UNIT[1][:, ::-1],
        np.concatenate((UNIT[1], UNIT[1])),
        np.concatenate((UNIT[1], UNIT[1][:, ::-1])),
        np.where(np.arange(12)[:, None] % 3 == 0, UNIT[1][:, ::-1], UNIT[1]),
    ],
)
def test_winding_and_repeats_do_not_matter(faces):
    hull = outer_hull(
        *distinct(UNIT[0], np.ascontiguousarray(faces, dtype=np.int32), np.arange(len(faces)))[:2]
    )
    assert len(hull.faces) == 12
    assert volume(hull.vertices, hull.faces) == pytest.approx(1)


def test_a_sheet_is_no_body():
    vertices, faces = UNIT
    hull = outer_hull(vertices, faces[:-1])
    assert len(hull.faces) == 0
    assert len(hull.sheets) == 11


def test_a_hole_is_closed_on_its_own_rim():
    vertices, faces = UNIT
    found = outside_of(vertices, faces[:-1])
    assert len(found.faces) == 12
    assert np.count_nonzero(found.born < 0) == 1
    assert len(found.holes) + found.small_holes == 1
    hidden = outside_of(*soup(UNIT, box([0.2, 0.2, 0.2], [0.9, 0.9, 0.9], open_top=True)))
    assert len(hidden.faces) == 12
    assert (hidden.holes, hidden.small_holes) == ((), 0)
    assert volume(found.vertices, found.faces) == pytest.approx(1)


def test_seams_are_sewn_and_an_edge_split_where_another_ends_on_it():
    vertices, faces = UNIT
    corners = vertices[faces].reshape(-1, 3) + np.random.default_rng(0).uniform(-2e-5, 2e-5, (36, 3))
    found = outside_of(corners, np.arange(36, dtype=np.int32).reshape(-1, 3))
    assert len(found.faces) == 12
    assert (found.born >= 0).all()
    # One side in two halves: a T-junction in the middle of an edge.
    a, b, c = faces[0]
    middle = (vertices[a] + vertices[b]) / 2
    split = np.concatenate((faces[1:], [[a, 8, c], [8, b, c]])).astype(np.int32)
    sewn = sew(np.vstack((vertices, middle)), split, np.arange(13), 1e-4)
    assert len(open_edges(sewn[1], len(sewn[0]))) == 0


def test_rims_are_walked_round_once():
    vertices, faces = UNIT
    assert [sorted(loop.tolist()) for loop in holes(faces[:-2], len(vertices))] == [[4, 5, 6, 7]]
    assert holes(faces, len(vertices)) == []


def test_cutting_leaves_facets_that_meet_nothing_alone():
    vertices, faces = soup(UNIT, box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5]), box([5, 5, 5], [6, 6, 6]))
    cut = cut_crossings(vertices, faces)
    assert cut.left == 0
    assert np.count_nonzero(cut.born >= 24) == 12
    assert edge_table(cut.faces, len(cut.vertices)).uses.min() == 2
    areas = np.linalg.norm(
        np.cross(*(cut.vertices[cut.faces[:, k]] - cut.vertices[cut.faces[:, 0]] for k in (1, 2))), axis=1
    )
    whole = np.linalg.norm(np.cross(*(vertices[faces[:, k]] - vertices[faces[:, 0]] for k in (1, 2))), axis=1)
    assert np.bincount(cut.born, areas) == pytest.approx(whole, rel=1e-7)


def slanted_bars(count):
    """Bars through each other near one point, each turned at random."""
    rng = np.random.default_rng(7)
    bars = []
    for _ in range(count):
        turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        vertices, faces = box([-0.05, -0.06, -1], [0.05, 0.06, 1])
        bars.append((vertices @ (turn * np.sign(np.linalg.det(turn))).T, faces))
    return bars


def test_bodies_that_cross_are_united_and_facets_that_meet_nothing_stay():
    bars = slanted_bars(12)
    vertices, faces = soup(*((v, f[:, ::-1] if number == 3 else f) for number, (v, f) in enumerate(bars)))
    made = unite(vertices, faces)
    assert made.left == 0
    assert edge_table(made.faces, len(made.vertices)).uses.tolist() == [2] * (3 * len(made.faces) // 2)
    # The twelve times two ends cross nothing, and are as they were, the inverted bar's too.
    for v, f in bars:
        for end in (f[:2], f[-2:]):
            assert {tuple(corner) for corner in v[end].reshape(-1, 3)} <= set(map(tuple, made.vertices))
    third = np.isin(made.born, np.arange(36, 48))
    normals = np.cross(*(vertices[faces[:, k]] - vertices[faces[:, 0]] for k in (1, 2)))
    pieces = np.cross(*(made.vertices[made.faces[:, k]] - made.vertices[made.faces[:, 0]] for k in (1, 2)))
    assert (np.einsum("ij,ij->i", pieces, normals[made.born])[third] > 0).all()
    found = outside_of(vertices, faces)
    assert found.turned == 12
    assert not crossings(found.vertices, found.faces)[2].any()


def test_a_union_that_crosses_in_needles_is_cut_there():
    rod, rng = trimesh.creation.cylinder(0.01, 0.05, sections=24), np.random.default_rng(5)
    lying, whole = Rotation.from_euler("x", 90, degrees=True), Rotation.random(random_state=5)
    turns = [whole * Rotation.from_euler("z", np.pi / 8 * k + 2e-8 * rng.normal()) * lying for k in range(8)]
    rods = [(turn.apply(rod.vertices).astype(np.float32).astype(float), rod.faces) for turn in turns]
    made = unite(*soup(*rods))
    assert (made.left, made.bodies) == (0, 8)


def test_what_is_no_set_of_bodies_that_meet_is_not_united():
    across = soup(UNIT, box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5]))
    assert unite(*soup(UNIT, box([5, 5, 5], [6, 6, 6]))) is None
    assert unite(across[0], across[1][1:]) is None
    assert unite(*across) is not None


@pytest.mark.parametrize("wrong", ["crosses itself", "is wound two ways"])
def test_a_body_that_is_no_solid_is_made_one_before_it_is_united(wrong):
    vertices, faces = (each.copy() for each in UNIT)
    if wrong == "crosses itself":
        vertices[0] = [2, 2, 2]  # through the opposite corner
    else:
        faces[:2] = faces[:2, ::-1]
    both = soup((vertices, faces), box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5]))
    found, cut = outside_of(*both), cut_crossings(*both)
    by_facets = outer_hull(cut.vertices, cut.faces)
    assert found.bodies == 2
    assert volume(found.vertices, found.faces) == pytest.approx(volume(by_facets.vertices, by_facets.faces))


def test_a_body_goes_on_across_an_edge_in_which_others_touch_it():
    """The top of the box hangs together with its sides by edges only that have four facets."""
    beside = [box([x, y, 1], [x + 1, y + 1, 2]) for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    found = outside_of(*soup(UNIT, *beside, box([0.2, 0.2, -0.5], [0.7, 0.7, 0.5])))
    assert (found.bodies, volume(found.vertices, found.faces)) == (6, pytest.approx(5.125))


def test_random_crossing_bodies_enclose_what_any_of_them_does():
    rng = np.random.default_rng(3)
    for _ in range(4):
        bodies = []
        for _ in range(4):
            vertices, faces = box(*np.sort(rng.uniform(0, 1, (2, 3)), axis=0))
            turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
            bodies.append((vertices @ (turn * np.sign(np.linalg.det(turn))).T, faces))
        found = outside_of(*soup(*bodies))
        points = rng.uniform(-1.5, 1.5, (400, 3))
        inside = np.zeros(len(points), dtype=bool)
        for vertices, faces in bodies:
            normals = np.cross(*(vertices[faces[:, k]] - vertices[faces[:, 0]] for k in (1, 2)))
            heights = np.einsum("pfi,fi->pf", points[:, None] - vertices[faces[:, 0]], normals)
            inside |= (heights < 0).all(axis=1)
        corners = found.vertices[found.faces][None] - points[:, None, None]
        lengths = np.linalg.norm(corners, axis=3)
        a, b, c = (corners[:, :, k] for k in range(3))
        x, y, z = (lengths[:, :, k] for k in range(3))
        over = np.einsum("pfi,pfi->pf", a, np.cross(b, c))
        under = x * y * z + (a * b).sum(2) * z + (b * c).sum(2) * x + (c * a).sum(2) * y
        winding = np.arctan2(over, under).sum(axis=1) / (2 * np.pi)
        assert np.array_equal(winding > 0.5, inside)


# ---- slivers that cutting leaves are joined to what lies beside them -----------------------------


WIDTH = 1e-3
VERTICES, FACES = box([0, 0, 0], [1, 1, 1])


def inserted(point):
    """The unit box with a point put into its first facet, as three facets in its place; the last ones."""
    a, b, c = FACES[0]
    new = np.array([[a, b, 8], [b, c, 8], [c, a, 8]], dtype=np.int32)
    return np.concatenate((VERTICES, [point])), np.concatenate((FACES[1:], new))


A, B, C = VERTICES[FACES[0]]


@pytest.mark.parametrize(
    "point",
    [
        A + 1e-5 * (B - A) + 1e-6 * (C - A),  # beside a corner: needles
        0.5 * (A + B) + 1e-6 * (C - A),  # beside an edge: a facet with hardly any height
        0.5 * (A + B) - 1e-6 * (C - A),  # on its other side: folded over
        0.5 * (A + B) + 1e-5 * np.array([0, 0, 1]),  # and steep
    ],
)
def test_a_sliver_goes_and_the_surface_stays(point):
    vertices, faces = inserted(point)
    sliver = np.array([len(faces) - 3])
    tidy, of = without_slivers(vertices, faces, sliver, WIDTH)
    health = measure_health(vertices, tidy)
    assert health.watertight
    assert health.winding_consistent
    assert len(of) == len(tidy) == len(FACES)
    assert volume(vertices, tidy) == pytest.approx(1, abs=1e-4)
    assert check_soundness(vertices, tidy, (VERTICES, FACES)).sound


def test_what_is_wider_stays():
    vertices, faces = inserted(0.5 * (A + B) + 0.1 * (C - A))
    tidy, of = without_slivers(vertices, faces, np.arange(len(faces)), WIDTH)
    assert np.array_equal(tidy, faces)
    assert np.array_equal(of, np.arange(len(faces)))


def test_a_shell_that_folds_in_a_sliver_only_is_mended_and_says_what_is_invented():
    vertices, faces = inserted(0.5 * (A + B) - 2e-6 * (C - A) + 1e-5 * np.array([0, 0, 1]))
    base = Probe.from_arrays(VERTICES, FACES, check_size=False)
    invented = np.zeros(len(faces), dtype=bool)
    invented[0] = True
    made = Probe.from_arrays(vertices, faces, invented=invented, check_size=False)
    found = check_soundness(vertices, faces, (VERTICES, FACES), invented=invented)
    assert not found.sound
    shell = _tidied(replace(Shell(made, HULL, ()), soundness=found), base)
    assert shell.soundness.sound
    assert shell.probe.invented.sum() == 1
    assert shell.probe.areas[shell.probe.invented] == pytest.approx(0.5)


def test_a_real_probe_is_cut_whatever_its_unit_rounds(real_file):
    with pytest.warns(MeshWarning):
        probe = load_probe(real_file, "mm")
    inches = (probe.vertices / 0.0254).astype(np.float32)
    sewn = sew_up(0.0254 * inches.astype(float), probe.faces, smallest=1e-3, spacing=6e-4)
    assert cut_crossings(sewn.vertices, sewn.faces).left == 0
