"""Which facets cross, touch or overlap: against a decision in rational arithmetic that works quite differently."""

from fractions import Fraction
from itertools import combinations, product

import numpy as np
import pytest
from contact_cases import ball

from contactbench.pipeline.kernel import crossings

CROSSING, TOUCHING, OVERLAP = range(3)
TURN = np.linalg.qr(np.arange(9).reshape(3, 3) + np.eye(3))[0]


def exactly(point):
    return tuple(Fraction(float(x)) for x in point)


def less(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def clip(polygon, normal, offset):
    """Keep the part of a convex polygon (or segment, or point) in space where normal . x >= offset."""
    kept = []
    for i, here in enumerate(polygon):
        there = polygon[(i + 1) % len(polygon)]
        h, t = dot(normal, here) - offset, dot(normal, there) - offset
        if h >= 0:
            kept.append(here)
        if h * t < 0:
            kept.append(tuple(a + (b - a) * h / (h - t) for a, b in zip(here, there, strict=True)))
    return list(dict.fromkeys(kept))


def normal_of(triangle):
    a, b, c = triangle
    return cross(less(b, a), less(c, a))


def inside(point, triangle):
    """Return whether a point of the triangle's plane is strictly inside it."""
    n = normal_of(triangle)
    return all(
        dot(cross(less(triangle[(i + 1) % 3], triangle[i]), less(point, triangle[i])), n) > 0
        for i in range(3)
    )


def in_prism(polygon, triangle):
    """Clip a convex polygon by the three planes through a triangle's sides, across its own plane."""
    n = normal_of(triangle)
    for i in range(3):
        across = cross(n, less(triangle[(i + 1) % 3], triangle[i]))
        polygon = clip(polygon, across, dot(across, triangle[i]))
    return polygon


def in_plane(polygon, triangle):
    n = normal_of(triangle)
    above = clip(polygon, n, dot(n, triangle[0]))
    return clip(above, tuple(-x for x in n), -dot(n, triangle[0]))


def expected(vertices, first, second):
    """Return the kind of meeting of two facets, None for none, from the convex set that they have in common."""
    s, t = ([exactly(vertices[i]) for i in facet] for facet in (first, second))
    if not any(normal_of(s)) or not any(normal_of(t)):
        return None
    common = in_prism(in_plane(s, t), t)
    shared = [exactly(vertices[i]) for i in set(first) & set(second)]
    if len(shared) == 2:
        a, b = shared
        beyond = [p for p in common if any(cross(less(b, a), less(p, a)))]
    else:
        beyond = [p for p in common if len(shared) == 3 or p not in shared]
    if not beyond:
        return None
    if any(any(cross(less(b, a), less(c, a))) for a, b, c in combinations(common, 3)):
        return OVERLAP
    middle = tuple(sum(p[k] for p in common) / len(common) for k in range(3))
    return CROSSING if inside(middle, s) and inside(middle, t) else TOUCHING


def passes(kinds, faces, vertices):
    """Turn touching pairs into crossings where an edge lies in a facet and the surface goes on beyond it."""
    stands = {}
    for (f, g), kind in kinds.items():
        for one, other in ((f, g), (g, f)) if kind == TOUCHING else ():
            t = [exactly(vertices[i]) for i in faces[other]]
            n = normal_of(t)
            side = [dot(n, less(exactly(vertices[i]), t[0])) for i in faces[one]]
            if side.count(0) != 2:
                continue
            (apex,) = (i for i in range(3) if side[i] != 0)
            p, q = (exactly(vertices[faces[one][(apex + k) % 3]]) for k in (1, 2))
            part = in_prism([p, q], t)
            if len(part) < 2 or not inside(tuple((a + b) / 2 for a, b in zip(*part[:2], strict=True)), t):
                continue
            edge = frozenset(int(faces[one][(apex + k) % 3]) for k in (1, 2))
            stands.setdefault((edge, other), []).append((side[apex] > 0, (f, g)))
    for found in stands.values():
        if len({above for above, _ in found}) == 2:
            kinds.update(dict.fromkeys((pair for _, pair in found), CROSSING))
    return kinds


def brute_force(vertices, faces):
    kinds = {}
    for f, g in combinations(range(len(faces)), 2):
        kind = expected(vertices, faces[f], faces[g])
        if kind is not None:
            kinds[f, g] = kind
    return passes(kinds, faces, vertices)


def found_in(vertices, faces):
    pairs, kinds, count, complete = crossings(
        np.ascontiguousarray(vertices, dtype=float), np.ascontiguousarray(faces, dtype=np.int32)
    )
    assert complete
    assert count.tolist() == np.bincount(kinds, minlength=3).tolist()
    assert pairs.tolist() == sorted(pairs.tolist())
    return {(f, g): kind for (f, g), kind in zip(pairs.tolist(), kinds.tolist(), strict=True)}


def facets(rng, count, used):
    return np.array([rng.choice(used, 3, replace=False) for _ in range(count)], dtype=np.int32)


@pytest.mark.parametrize("size", [1, 2, 3])
@pytest.mark.parametrize("flat", [False, True])
def test_small_grids_where_everything_is_degenerate(size, flat):
    """Few vertices on a small grid: same places, three in a row, edges through vertices, all in one plane."""
    rng = np.random.default_rng([size, flat])
    seen = set()
    for _ in range(30):
        vertices = rng.integers(0, size + 1, (7, 3)).astype(float)
        if flat:
            vertices = vertices @ rng.integers(-2, 3, (3, 3)) * [1, 1, 0] @ rng.integers(-2, 3, (3, 3))
        faces = facets(rng, 5, 7)
        expect = brute_force(vertices, faces)
        assert found_in(vertices, faces) == expect, (vertices.tolist(), faces.tolist())
        seen |= set(expect.values())
    assert seen == ({TOUCHING, OVERLAP} if flat else {CROSSING, TOUCHING, OVERLAP})


@pytest.mark.parametrize("shift", [0.0, 1e-17, 3e-16, 1e-9])
def test_floats_next_to_degenerate(shift):
    """Grids that were turned and moved: what was in one plane is so but for the last digits, or is so no more."""
    rng = np.random.default_rng(7)
    for _ in range(30):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        vertices = rng.integers(0, 3, (7, 3)) @ turn * rng.choice([1e-3, 0.1, 1.0]) + rng.choice(
            [0.0, 0.3, 100.0]
        )
        vertices += shift * rng.normal(size=vertices.shape)
        faces = facets(rng, 5, 7)
        assert found_in(vertices, faces) == brute_force(vertices, faces), (vertices.tolist(), faces.tolist())


def test_a_vertex_that_is_off_by_the_last_bit():
    """A vertex on a slanted plane, one step of the last bit above, one below: three different answers."""
    plane = [[0.1, 0.1, 0.1], [0.7, 0.1, 0.4], [0.1, 0.9, 0.2], [0.4, 0.4, 9.0], [0.41, 0.45, 9.0]]
    answers = []
    a, b, c = (exactly(p) for p in plane[:3])
    n = cross(less(b, a), less(c, a))
    height = float((dot(n, a) - n[0] * Fraction(0.25) - n[1] * Fraction(0.25)) / n[2])
    for z in (np.nextafter(height, 1), np.nextafter(height, 0)):
        vertices = np.array([*plane, [0.25, 0.25, z]])
        answers.append(found_in(vertices, [[0, 1, 2], [3, 4, 5]]))
        assert answers[-1] == brute_force(vertices, [[0, 1, 2], [3, 4, 5]])
    assert answers == [{}, {(0, 1): CROSSING}]


def test_an_edge_in_a_plane_that_passes_a_vertex_by_the_last_bit():
    rng = np.random.default_rng(13)
    seen = set()
    for _ in range(80):
        plane = rng.random((5, 2))
        share = rng.random()
        beside = share * plane[0] + (1 - share) * plane[1]
        # Away from the first facet, which lies on the other side of its edge 0 1.
        over = 2 * beside - plane[2]
        plane[3:] = over + 0.01 * (plane[3:] - over)
        vertices = np.pad(np.concatenate((plane, [beside])), ((0, 0), (0, 1)))
        faces = [[0, 1, 2], [3, 4, 5]]
        found = found_in(vertices, faces)
        assert found == brute_force(vertices, faces), vertices.tolist()
        seen.add(found.get((0, 1)))
    assert seen == {None, OVERLAP}


@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 2, 0), (2, 0, 1)])
def test_neighbours_far_thinner_than_rounding(axes):
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0], [0.5, -1e-9, 0], [0.5, 2e-9, 0]])[:, axes]
    assert found_in(vertices, [[0, 1, 2], [0, 1, 3]]) == {}
    assert found_in(vertices, [[0, 1, 2], [0, 1, 4]]) == {(0, 1): OVERLAP}


@pytest.mark.parametrize("scale", [1e-70, 1e-40, 1e60])
def test_any_size(scale):
    """Products of three tiny or huge numbers neither vanish nor overflow."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        vertices, faces = rng.integers(0, 3, (7, 3)) * scale, facets(rng, 5, 7)
        assert found_in(vertices, faces) == brute_force(vertices, faces)


def test_tiny_beside_large():
    rng = np.random.default_rng(5)
    for _ in range(30):
        vertices = rng.integers(-1, 2, (7, 3)) * 10.0 ** rng.choice([-60, -17, -8, 0], (7, 3))
        faces = facets(rng, 5, 7)
        assert found_in(vertices, faces) == brute_force(vertices, faces), (vertices.tolist(), faces.tolist())


def test_sound_meshes_have_none():
    probe = ball(320)
    assert found_in(probe.vertices, probe.faces) == {}
    x, y = np.meshgrid(np.arange(7.0), np.arange(7.0))
    grid = np.column_stack((x.ravel(), y.ravel(), 0 * x.ravel())) @ TURN
    corner = np.arange(42).reshape(6, 7)[:, :6].ravel()
    faces = np.concatenate(
        (np.column_stack((corner, corner + 1, corner + 8)), np.column_stack((corner, corner + 8, corner + 7)))
    )
    # Exactly flat or flat but for rounding: neighbours in a plane have nothing but their edges in common.
    assert found_in(grid, faces) == {}
    assert found_in(np.round(8 * grid) / 8, faces) == brute_force(np.round(8 * grid) / 8, faces)


CUBE = np.array(list(product((0.0, 1.0), repeat=3)))
CUBE_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
     [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)  # fmt: skip


def both(first, second):
    return np.concatenate((first[0], second[0])), np.concatenate((first[1], second[1] + len(first[0])))


@pytest.mark.parametrize(
    ("move", "kinds"),
    [
        ([2.0, 0, 0], set()),
        ([1.0, 0, 0], {OVERLAP, TOUCHING}),  # face on face
        ([1.0, 1, 0.25], {TOUCHING}),  # edge on edge
        ([1.0, 1, 1], {TOUCHING}),  # corner on corner
        ([0.5, 0.25, 0.125], {CROSSING}),
    ],
)
def test_two_cubes(move, kinds):
    vertices, faces = both((CUBE, CUBE_FACES), (CUBE + move, CUBE_FACES))
    found = found_in(vertices, faces)
    assert set(found.values()) == kinds
    assert found == brute_force(vertices, faces)


def test_a_wall_that_passes_through_a_facet_at_its_own_edges_crosses_it():
    """No two facets have inner points in common there, but the surfaces go through one another."""
    wall = np.array([[x, 0.1, z] for z in (-1.0, 0.0, 1.0) for x in (-0.2, 0.2)])
    plate = np.array([[-2.0, -1.0, 0.0], [2.0, -1.0, 0.0], [0.0, 3.0, 0.0]])
    through = np.array([[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]])
    vertices, faces = both((wall, through), (plate, np.array([[0, 1, 2]])))
    found = found_in(vertices, faces)
    assert found == {(0, 4): TOUCHING, (1, 4): CROSSING, (2, 4): CROSSING, (3, 4): TOUCHING}
    assert found == brute_force(vertices, faces)
    ends_there, faces = both((wall, through[:2]), (plate, np.array([[0, 2, 1]])))
    assert set(found_in(ends_there, faces).values()) == {TOUCHING}


def test_a_fold_and_a_facet_twice():
    vertices = np.array(
        [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.3, 0.2, 0], [0.3, 0.2, 1e-300], [0.3, 0.2, 1e-70]]
    )
    assert found_in(vertices, [[0, 1, 2], [0, 1, 3]]) == {(0, 1): OVERLAP}
    assert found_in(vertices, [[0, 1, 2], [0, 1, 4]]) == {(0, 1): OVERLAP}  # below 1e-75 counts as 0
    assert found_in(vertices, [[0, 1, 2], [0, 1, 5]]) == {}
    assert found_in(vertices, [[0, 1, 2], [2, 1, 0]]) == {(0, 1): OVERLAP}


def test_facets_without_area_are_left_out():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [0.25, 0.25, 1], [0.25, 0.25, -1]])
    line = [[0, 3, 1], [4, 4, 5]]
    assert found_in(vertices, [[0, 1, 2], *line]) == {}
    assert found_in(vertices, [*line, [0, 1, 2], [4, 5, 3]]) == {(2, 3): CROSSING}


def test_three_points_on_a_slanted_line_have_no_area():
    """Exactly on it, though their differences are rounded and a cross product of those is not zero."""
    rng = np.random.default_rng(17)
    for _ in range(15):
        along = np.array([rng.integers(1, 8) * 2.0**-54, *(rng.integers(2**49, 2**50, 2) * 2.0**-50)])
        vertices = np.concatenate((np.outer(along, [1, 3, 5]), [[0.1, 0, 0], [0, 5, 1], [0.2, 1, 9]]))
        faces = [[0, 1, 2], [0, 1, 3], [3, 4, 5]]
        found = found_in(vertices, faces)
        assert found == brute_force(vertices, faces)
        assert all(0 not in pair for pair in found)


def test_turning_and_renumbering_changes_nothing():
    rng = np.random.default_rng(11)
    vertices, faces = rng.random((60, 3)), facets(rng, 60, 60)
    expect = found_in(vertices, faces)
    order = rng.permutation(60)
    again = found_in(vertices, np.roll(faces[order], 1, axis=1)[:, ::-1])
    assert {tuple(sorted((order[f], order[g]))): kind for (f, g), kind in again.items()} == expect
    assert len(expect) > 100


def test_the_list_is_bounded_and_says_so():
    rng = np.random.default_rng(2)
    vertices, faces = rng.random((120, 3)), facets(rng, 100, 120)
    whole = crossings(vertices, faces)
    pairs, kinds, count, complete = crossings(vertices, faces, limit=10)
    assert (len(pairs), len(kinds), complete, whole[3]) == (10, 10, False, True)
    assert {tuple(p) for p in pairs.tolist()} <= {tuple(p) for p in whole[0].tolist()}
    assert count.sum() < whole[2].sum()
    soup = ball(320).vertices[ball(320).faces].reshape(-1, 3)
    loose = np.arange(len(soup), dtype=np.int32).reshape(-1, 3)
    pairs, kinds, count, complete = crossings(soup, loose, limit=10)
    assert (len(pairs), set(kinds.tolist()), complete) == (10, {TOUCHING}, True)
    assert count.tolist() == crossings(soup, loose)[2].tolist()


def test_a_fan_of_needles_ends_in_bounded_time():
    """Facets that all reach one place would be compared two by two, their number squared: it gives up and says so."""
    count = 12_000
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    rim = np.column_stack((np.cos(angle), np.sin(angle), np.ones(count)))
    vertices = np.concatenate(([[0.0, 0.0, 0.0]], rim))
    number = np.arange(count)
    faces = np.column_stack((0 * number, 1 + number, 1 + (number + 1) % count)).astype(np.int32)
    _, kinds, _, complete = crossings(vertices, faces)
    assert (len(kinds), complete) == (0, False)


def test_wrong_input_is_refused():
    vertices, faces = np.eye(3), np.array([[0, 1, 2]], dtype=np.int32)
    with pytest.raises(ValueError, match="vertices: row 1 is not finite"):
        crossings(np.array([[0, 0, 0], [np.nan, 0, 0], [1, 0, 0]]), faces)
    with pytest.raises(ValueError, match="row 0 refers to a vertex that is not there"):
        crossings(vertices, np.array([[0, 1, 3]], dtype=np.int32))
    with pytest.raises(ValueError, match="row 2 is beyond 1e90"):
        crossings(vertices * [[1], [1], [1e100]], faces)
    pairs, kinds, count, complete = crossings(vertices, faces[:0])
    assert (pairs.shape, kinds.shape, count.tolist(), complete) == ((0, 2), (0,), [0, 0, 0], True)
