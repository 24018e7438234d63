"""The benchmark of prepared meshes: its own eyes first, then small shapes end to end."""

from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest

from . import shapes
from .contact_error import draw_touches, locate
from .prepared_meshes import _judge, measure, run_command
from .solids import Box, Mesh, blocks, box, capsule, joined
from .solver.exact import _cross, _dot, _minus
from .stranger import crossings, look, normal_deviations, read_prepared

# Those of up to some thousand facets: the others take seconds each.
_LARGE = {
    "missing-lens", "open-skin", "missing-facets", "thin-ring", "thin-tube", "ring", "unsewn", "pipe", "housing",
}  # fmt: skip
_SMALL = [n for n in shapes.names() if n not in _LARGE and "scan" not in n and "bundled" not in n]


def _mesh(*triangles):
    points, index = np.unique(np.reshape(triangles, (-1, 3)).astype(float), axis=0, return_inverse=True)
    return Mesh(points, index.reshape(-1, 3).astype(np.int32))


def _clipped(triangle, other):
    """Cut one triangle by the plane and the sides of the other, with fractions: what is left is what they share."""
    a, b, c = ([Fraction(int(x)) for x in p] for p in other)
    polygon = [[Fraction(int(x)) for x in p] for p in triangle]
    normal = _cross(_minus(b, a), _minus(c, a))
    walls = [(a, normal), (a, [-x for x in normal])]
    walls += [(p, _cross(normal, _minus(q, p))) for p, q in ((a, b), (b, c), (c, a))]
    for point, inward in walls:
        heights = [_dot(_minus(p, point), inward) for p in polygon]
        kept = []
        for k, (p, h) in enumerate(zip(polygon, heights, strict=True)):
            q, g = polygon[k - 1], heights[k - 1]
            if g * h < 0:
                kept.append([x + (y - x) * g / (g - h) for x, y in zip(q, p, strict=True)])
            if h >= 0:
                kept.append(p)
        polygon = kept
    return {tuple(p) for p in polygon}


def _inside(point, triangle):
    a, b, c = ([int(x) for x in p] for p in triangle)
    normal = _cross(_minus(b, a), _minus(c, a))
    return all(_dot(_minus(point, p), _cross(normal, _minus(q, p))) > 0 for p, q in ((a, b), (b, c), (c, a)))


def test_crossings_are_those_of_rational_arithmetic():
    rng = np.random.default_rng(0)
    seen = set()
    for _ in range(1500):
        triangles = rng.integers(0, 4, (2, 3, 3))
        if rng.random() < 0.3:
            triangles[..., 2] = 0
        mesh = _mesh(*triangles)
        if (mesh.areas == 0).any():
            continue
        shared = {tuple(map(Fraction, map(int, p))) for p in triangles[0]} & {
            tuple(map(Fraction, map(int, p))) for p in triangles[1]
        }
        more = _clipped(*triangles) - shared
        # Two shared corners share the edge between them, of which clipping gives only the ends.
        crossing, touching = crossings(mesh)
        assert bool(len(crossing) + len(touching)) == (bool(more) or len(shared) == 3), triangles
        # Where the insides meet, the middle of all that is shared is inside both.
        together = _clipped(*triangles)
        middle = [sum(axis) / len(together) for axis in zip(*together, strict=True)]
        assert bool(len(crossing)) == (bool(together) and all(_inside(middle, t) for t in triangles)), (
            triangles
        )
        seen.add((len(shared), len(crossing), len(touching)))
    assert {(0, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0), (1, 1, 0), (1, 0, 1), (2, 0, 0), (2, 1, 0)} <= seen


def test_boxes_find_every_near_pair():
    mesh = joined(capsule(8, 30, 16), capsule(8, 30, 16).moved(5.3, 2.1, 1.7))
    crossing, touching = crossings(mesh)
    found = {frozenset(p) for p in [*crossing.tolist(), *touching.tolist()]}
    own = len(mesh.faces) // 2
    assert found
    assert all(min(pair) < own <= max(pair) for pair in found)
    low, high = mesh.corners.min(axis=1), mesh.corners.max(axis=1)
    for i, j in combinations(range(0, len(mesh.faces), 7), 2):
        if (low[i] <= high[j]).all() and (low[j] <= high[i]).all():
            pair = Mesh(mesh.vertices, mesh.faces[[i, j]])
            assert (frozenset((i, j)) in found) == bool(sum(map(len, crossings(pair))))


def test_a_sound_solid_is_sound_and_each_spoilt_one_is_not():
    whole = capsule(8, 30, 16)
    assert look(whole) == replace(look(whole), parts=1, touching=0)
    assert look(whole).sound
    turned = whole.faces.copy()
    turned[5] = turned[5, ::-1]
    assert look(whole.chosen(np.arange(len(whole.faces)) != 5)).open_edges == 3
    assert look(Mesh(whole.vertices, turned)).bad_edges == 3
    assert look(whole.flipped()).inward == 1
    assert look(joined(whole, capsule(2, 5, 16).moved(0, 0, 10))).buried == 1
    assert look(joined(whole, whole.moved(20, 0, 0))).parts == 2
    assert look(joined(whole, whole.moved(20, 0, 0))).sound
    assert look(shapes.make("cubes-on-an-edge").solid).bad_edges == 4
    assert look(shapes.make("cubes-on-a-corner").solid).bad_vertices == 1


def test_a_turned_facet_stands_out_and_a_sharp_edge_does_not():
    whole = blocks(Box((0, 20), (0, 20), (0, 40)), Box((9, 10), (20, 30), (5, 35)), step=2)
    assert normal_deviations(whole, whole).max() < 1
    turned = whole.faces.copy()
    turned[7] = turned[7, ::-1]
    found = normal_deviations(Mesh(whole.vertices, turned), whole)
    assert found[7] > 89
    assert np.delete(found, 7).max() < 1


@pytest.mark.parametrize("name", _SMALL)
def test_every_shape_but_the_largest_is_what_it_says(name):
    shape = shapes.make(name)
    assert shape.outside.size < 160
    if shape.solid is not None and name not in ("cubes-on-an-edge", "cubes-on-a-corner"):
        vertices, index = np.unique(shape.solid.vertices, axis=0, return_inverse=True)
        seen = look(Mesh(vertices, index.reshape(-1)[shape.solid.faces].astype(np.int32)))
        assert seen.sound, seen.words()
        assert seen.touching == 0


def test_touches_come_along_lines_that_meet_nothing_on_their_way():
    shape = shapes.make("grooves")
    touches = draw_touches(shape, 500)
    out = -touches.forces / np.linalg.norm(touches.forces, axis=1, keepdims=True)
    points = touches.points + 1e-4 * touches.normals
    a, b, c = np.moveaxis(shape.solid.corners, 1, 0)
    for point, way in zip(points, out, strict=True):
        across = np.cross(way, c - a)
        scale = np.einsum("ni,ni->n", b - a, across)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = np.einsum("ni,ni->n", point - a, across) / scale
            turned = np.cross(point - a, b - a)
            v, t = turned @ way / scale, np.einsum("ni,ni->n", c - a, turned) / scale
        assert not ((u > 0) & (v > 0) & (u + v < 1) & (t > 0)).any()


def test_touches_are_within_the_friction_cone_and_a_wrong_place_is_seen():
    shape = shapes.make("doubled")
    touches = draw_touches(shape, 500)
    cosines = -np.einsum("ni,ni->n", touches.forces, touches.normals) / np.linalg.norm(touches.forces, axis=1)
    assert (cosines > np.cos(np.radians(31))).all()
    right = locate(shape.solid, touches, shape.outside)
    assert right.over_bound < 1.1
    assert right.astray == 0
    assert locate(shape.solid.moved(3, 0, 0), touches, shape.outside).over_bound > 2 * right.over_bound


@pytest.mark.parametrize("name", ["doubled", "overlapping-boxes"])
def test_small_shapes_reach_their_figures(name, tmp_path):
    row = measure(shapes.make(name), tmp_path)
    assert row.prepared.exit == 0, row.prepared.words
    assert row.faults == ()


def test_a_closed_box_keeps_its_facets(tmp_path):
    solid = box((0, 30), (0, 20), (0, 60), 10)
    shape, out = shapes.Shape("box", solid, solid, solid), tmp_path / "shell.ply"
    run_command(["probe", "shell", shape.write(tmp_path), "--units", "mm", "--out", out])
    shell = _judge(shape, read_prepared(out))
    assert (shell.facets, shell.invented, shell.back_mm) == (len(solid.faces), 0, pytest.approx(0, abs=1e-9))
