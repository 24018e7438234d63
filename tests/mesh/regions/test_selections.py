"""Facets chosen by place, direction and connection; growing, shrinking, smoothing, mirroring."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions import (
    FacetGraph,
    RegionError,
    component,
    facing,
    flood,
    grow,
    half_space,
    in_box,
    mirror,
    shrink,
    smooth,
)


def polar(ball: FacetGraph) -> np.ndarray:
    """Distance of each centroid from the pole along the sphere of 50 mm, m."""
    return 0.05 * np.arccos(ball.centroids[:, 2] / np.linalg.norm(ball.centroids, axis=1))


def test_a_box_in_its_own_frame(cube: FacetGraph) -> None:
    R_SB, p_SB_S = Rotation.from_euler("z", 90, degrees=True).as_matrix(), np.array([0.0, 0.0, 0.02])
    chosen = in_box(cube, [0.0, -np.inf, -0.001], [np.inf, np.inf, 0.001], R_SB=R_SB, p_SB_S=p_SB_S)
    # x of the box is y of S; the slab is the top side.
    expected = (cube.centroids[:, 1] >= 0) & (np.abs(cube.centroids[:, 2] - 0.02) <= 0.001)
    assert 0 < np.count_nonzero(expected) < cube.facet_count / 6
    assert chosen.tolist() == expected.tolist()


def test_half_spaces_are_complements_but_for_the_plane(cube: FacetGraph) -> None:
    one = half_space(cube, [0, 0, 0.003], [1, 2, 3])
    other = half_space(cube, [0, 0, 0.003], [-1, -2, -3])
    assert (one | other).all()
    assert np.count_nonzero(one & other) < 10
    assert one[cube.centroids @ [1, 2, 3] > 0.0091].all()


def test_facing(cube: FacetGraph) -> None:
    assert np.count_nonzero(facing(cube, [0, 0, 5], 0.1)) == cube.facet_count / 6
    assert np.count_nonzero(facing(cube, [0, 0, 1], math.pi / 2)) == cube.facet_count * 5 / 6
    assert facing(cube, [0, 1, 0], math.pi).all()


def test_a_flood_stops_at_creases(cube: FacetGraph) -> None:
    face = int(cube.pick([[0.0, 0.0, 0.02]])[0][0])
    side = flood(cube, face, math.radians(45))
    assert side.tolist() == facing(cube, [0, 0, 1], 0.1).tolist()
    assert flood(cube, face, math.radians(91)).all()
    half = flood(cube, face, math.radians(91), within=half_space(cube, [0, 0, 0], [0, 0, 1]))
    assert 0 < np.count_nonzero(half) < cube.facet_count


def test_components() -> None:
    parts = [trimesh.creation.icosphere(1, radius=0.01).apply_translation([x, 0, 0]) for x in (0, 0.05)]
    both = trimesh.util.concatenate(parts)
    graph = FacetGraph(Probe.from_arrays(both.vertices, both.faces))
    assert np.flatnonzero(component(graph, 3)).tolist() == list(range(80))
    assert np.flatnonzero(component(graph, 100)).tolist() == list(range(80, 160))


def test_growing_by_a_distance_is_exact_on_a_sphere(ball: FacetGraph) -> None:
    cap = polar(ball) <= 0.02
    wider, narrower = grow(ball, cap, distance=0.01), shrink(ball, cap, distance=0.01)
    assert (wider >= cap).all()
    assert (narrower <= cap).all()
    # The border is a zigzag of facets: it lies up to a facet beyond 20 mm.
    assert wider[polar(ball) <= 0.029].all()
    assert not wider[polar(ball) >= 0.034].any()
    assert narrower[polar(ball) <= 0.008].all()
    assert not narrower[polar(ball) >= 0.012].any()


@pytest.mark.parametrize("rings", [1, 3])
def test_rings_grow_by_shared_vertices_and_shrink_is_their_dual(ball: FacetGraph, rings: int) -> None:
    cap = polar(ball) <= 0.02
    grown = grow(ball, cap, rings=rings)
    expected = cap.copy()
    for _ in range(rings):
        used = set(ball.probe.faces[expected].ravel().tolist())
        expected = np.array([bool(used & set(face)) for face in ball.probe.faces.tolist()])
    assert grown.tolist() == expected.tolist()
    assert shrink(ball, cap, rings=rings).tolist() == (~grow(ball, ~cap, rings=rings)).tolist()


def test_an_open_rim_is_no_border_to_shrink_from() -> None:
    mesh = trimesh.creation.box(extents=(0.04, 0.04, 0.04)).subdivide().subdivide().subdivide()
    top = mesh.triangles_center[:, 2] > 0.0199
    graph = FacetGraph(Probe.from_arrays(mesh.vertices, mesh.faces[top]))
    everything = np.ones(graph.facet_count, dtype=bool)
    assert shrink(graph, everything, rings=2).all()
    assert shrink(graph, everything, distance=0.005).all()
    assert not grow(graph, ~everything, rings=2).any()


def test_smoothing_removes_specks_fills_holes_and_keeps_the_area(
    ball: FacetGraph, rng: np.random.Generator
) -> None:
    cap = polar(ball) <= 0.03
    noisy = cap ^ (rng.uniform(size=ball.facet_count) < 0.05)
    smoothed = smooth(ball, noisy, 4)
    areas = ball.probe.areas
    assert areas[smoothed].sum() == pytest.approx(areas[cap].sum(), rel=0.03)
    assert np.count_nonzero(smoothed ^ cap) < 0.08 * np.count_nonzero(cap)

    def components(mask: np.ndarray) -> int:
        left, count = mask.copy(), 0
        while left.any():
            left &= ~component(ball, int(np.argmax(left)), within=mask)
            count += 1
        return count

    assert components(noisy) > 50
    assert components(smoothed) == 1
    assert components(~smoothed) == 1


def test_smoothing_a_narrow_band_keeps_its_area(ball: FacetGraph) -> None:
    band = np.abs(ball.centroids[:, 2]) < 0.003
    smoothed = smooth(ball, band, 5)
    assert ball.probe.areas[smoothed].sum() == pytest.approx(ball.probe.areas[band].sum(), rel=0.03)
    assert np.abs(ball.centroids[smoothed, 2]).max() < 0.008


def test_smoothing_respects_other_regions(ball: FacetGraph) -> None:
    cap = polar(ball) <= 0.02
    allowed = ~cap & (ball.centroids[:, 0] > 0)
    smoothed = smooth(ball, cap, 2, allowed=allowed)
    assert not smoothed[~cap & ~allowed].any()


@pytest.mark.parametrize("empty", [True, False])
def test_smoothing_nothing_or_everything(ball: FacetGraph, empty: bool) -> None:
    mask = np.full(ball.facet_count, not empty)
    assert smooth(ball, mask, 2).tolist() == mask.tolist()


def test_mirroring_a_symmetric_mesh_is_exact_and_its_own_inverse(plate: FacetGraph) -> None:
    mask = in_box(plate, [0.005, -0.01, 0], [0.02, 0.01, 1])
    there = mirror(plate, mask, [2, 0, 0])
    assert len(there.unmatched) == 0
    assert "every one has a counterpart" in there.sentence
    expected = in_box(plate, [-0.02, -0.01, 0], [-0.005, 0.01, 1])
    assert there.mask.tolist() == expected.tolist()
    assert mirror(plate, there.mask, [1, 0, 0]).mask.tolist() == mask.tolist()


def test_mirroring_keeps_to_its_side_of_a_wall(plate: FacetGraph) -> None:
    # Larger than the wall is thick, so that the other side would be in reach.
    mask = half_space(plate, [0, 0, 0.0004], [0, 0, 1])
    there = mirror(plate, mask, [1, 0, 0], tolerance=0.003)
    assert there.mask.tolist() == mask.tolist()


def test_what_has_no_counterpart_is_told(plate: FacetGraph) -> None:
    mask = in_box(plate, [0.005, -0.01, 0], [0.02, 0.01, 1])
    there = mirror(plate, mask, [1, 0, 0], [0.03, 0, 0])
    assert there.unmatched.tolist() == np.flatnonzero(mask).tolist()
    assert not there.mask.any()
    assert "no counterpart" in there.sentence


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda g: in_box(g, [0, 0, 0], [1, 1, 0]), "below the high one"),
        (lambda g: in_box(g, [0, 0, math.nan], [1, 1, 1]), "three numbers"),
        (lambda g: in_box(g, [0, 0], [1, 1]), "three numbers"),
        (lambda g: in_box(g, "abc", [1, 1, 1]), "three numbers"),
        (lambda g: in_box(g, [0, 0, 0], [1, 1, 1], R_SB=2 * np.eye(3)), "not a rotation"),
        (lambda g: half_space(g, [0, 0, 0], [0, 0, 0]), "no direction"),
        (lambda g: half_space(g, [0, 0, math.inf], [0, 0, 1]), "three numbers"),
        (lambda g: facing(g, [0, 0, 1], 4.0), "not an angle"),
        (lambda g: flood(g, -1, 0.5), "does not exist"),
        (lambda g: flood(g, 0, math.nan), "not an angle"),
        (lambda g: grow(g, np.zeros(g.facet_count, bool)), "give the distance"),
        (lambda g: grow(g, np.zeros(g.facet_count, bool), rings=1, distance=1.0), "give the distance"),
        (lambda g: shrink(g, np.zeros(g.facet_count, bool), rings=-1), "not a valid distance"),
        (lambda g: shrink(g, np.zeros(g.facet_count, bool), distance=math.inf), "not a valid distance"),
        (lambda g: smooth(g, np.zeros(g.facet_count, bool), 0), "give the distance"),
        (lambda g: mirror(g, np.zeros(g.facet_count, bool), [1, 0, 0], tolerance=0.0), "tolerance"),
    ],
)
def test_wrong_arguments_are_refused(cube: FacetGraph, call: Any, message: str) -> None:
    with pytest.raises(RegionError, match=message):
        call(cube)
