"""Facets chosen by place, direction and connection; growing, shrinking, smoothing, mirroring."""

import math
import warnings
from typing import Any

import numpy as np
import pytest
import trimesh
from mesh.regions.conftest import as_probe, centroids
from scipy.spatial.transform import Rotation

from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe
from contactbench.pipeline.mesh.colours import PALETTE
from contactbench.pipeline.mesh.probe import connected
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
from contactbench.pipeline.mesh.regions.region import (
    MOST_REGIONS,
    Region,
    RegionError,
    RegionSet,
    free_colour,
    free_name,
)
from contactbench.pipeline.mesh.regions.selections import (
    flood,
    grow,
    half_space,
    in_box,
    mirror,
    shrink,
    smooth,
)
from contactbench.pipeline.mesh.regions.transfer import carry_labels, transfer
from contactbench.pipeline.mesh.soundness import check_soundness


def polar(ball: FacetGraph) -> np.ndarray:
    """Distance of each centroid from the pole along the sphere of 50 mm, m."""
    return 0.05 * np.arccos(centroids(ball.probe)[:, 2] / np.linalg.norm(centroids(ball.probe), axis=1))


def parts(graph: FacetGraph, mask: np.ndarray) -> int:
    return len(np.unique(connected(graph.facet_count, *graph.pairs[mask[graph.pairs].all(axis=1)].T)[mask]))


def test_a_box_in_its_own_frame_cuts_at_its_sides(cube: FacetGraph) -> None:
    R_SB, p_SB_S = Rotation.from_euler("z", 90, degrees=True).as_matrix(), np.array([0.0, 0.0, 0.02])
    low, high = [0.0012, -np.inf, -0.001], [np.inf, np.inf, 0.001]
    chosen = in_box(cube, low, high, R_SB=R_SB, p_SB_S=p_SB_S)
    # x of the box is y of S; the slab is the top side and 1 mm of three others.
    assert chosen.area == pytest.approx(0.0188 * 0.04 + 0.001 * (0.04 + 2 * 0.0188), rel=1e-5)
    corners = chosen.probe.vertices[chosen.probe.faces]
    assert corners[chosen.mask, :, 1].min() > 0.0012 - 1e-6
    assert corners[chosen.mask, :, 2].min() > 0.019 - 1e-6
    assert check_soundness(chosen.probe.vertices, chosen.probe.faces).sound


def test_half_spaces_are_complements(cube: FacetGraph) -> None:
    one = half_space(cube, [0, 0, 0.003], [1, 2, 3])
    other = half_space(FacetGraph(one.probe), [0, 0, 0.003], [-1, -2, -3])
    assert one.area + other.area == pytest.approx(6 * 0.04**2, rel=1e-12)
    assert not (one.mask[other.origin] & other.mask).any()
    heights = one.probe.vertices[one.probe.faces] @ [1, 2, 3] - 0.009
    assert heights[one.mask].min() > -1e-6
    assert heights[~one.mask].max() < 1e-6


def test_a_plane_cuts_coarse_facets_where_it_runs() -> None:
    graph = FacetGraph(as_probe(trimesh.creation.box(extents=(0.06, 0.04, 0.001))))
    tip = half_space(graph, [0.0287, 0, 0], [1, 0, 0])
    assert tip.area == pytest.approx(2 * 0.0013 * 0.041 + 0.04 * 0.001, rel=0.01)


def test_a_flood_stops_at_creases(cube: FacetGraph) -> None:
    face = int(cube.pick([[0.0, 0.0, 0.02]])[0][0])
    assert flood(cube, face, math.radians(45)).tolist() == (cube.probe.normals[:, 2] > 0.9).tolist()
    assert flood(cube, face, math.radians(91)).all()


def test_components() -> None:
    parts = [trimesh.creation.icosphere(1, radius=0.01).apply_translation([x, 0, 0]) for x in (0, 0.05)]
    both = trimesh.util.concatenate(parts)
    graph = FacetGraph(Probe.from_arrays(both.vertices, both.faces))
    assert np.flatnonzero(flood(graph, 3, np.pi)).tolist() == list(range(80))
    assert np.flatnonzero(flood(graph, 100, np.pi)).tolist() == list(range(80, 160))


def test_growing_by_a_distance_is_exact_on_a_sphere(ball: FacetGraph) -> None:
    disc = half_space(ball, [0, 0, 0.05 * math.cos(0.4)], [0, 0, 1])
    graph = FacetGraph(disc.probe)
    for changed, angle in (
        (grow(graph, disc.mask, distance=0.01), 0.6),
        (shrink(graph, disc.mask, distance=0.01), 0.2),
    ):
        assert changed.area == pytest.approx(2 * np.pi * 0.05**2 * (1 - math.cos(angle)), rel=0.025)
        corners = changed.probe.vertices[changed.probe.faces]
        away = np.arccos(corners[:, :, 2] / np.linalg.norm(corners, axis=2))
        assert away[changed.mask].max() < angle + 0.004
        assert away[~changed.mask].min() > angle - 0.004
        assert (
            changed.touched.tolist()
            == np.isin(np.arange(graph.facet_count), changed.origin[changed.mask]).tolist()
        )


@pytest.mark.parametrize("rings", [1, 3])
def test_rings_grow_by_shared_vertices_and_shrink_is_their_dual(ball: FacetGraph, rings: int) -> None:
    cap = polar(ball) <= 0.02
    grown = grow(ball, cap, rings=rings).mask
    expected = cap.copy()
    for _ in range(rings):
        used = set(ball.probe.faces[expected].ravel().tolist())
        expected = np.array([bool(used & set(face)) for face in ball.probe.faces.tolist()])
    assert grown.tolist() == expected.tolist()
    assert shrink(ball, cap, rings=rings).mask.tolist() == (~grow(ball, ~cap, rings=rings).mask).tolist()


def test_an_open_rim_is_no_border_to_shrink_from() -> None:
    mesh = trimesh.creation.box(extents=(0.04, 0.04, 0.04)).subdivide().subdivide().subdivide()
    top = mesh.triangles_center[:, 2] > 0.0199
    graph = FacetGraph(Probe.from_arrays(mesh.vertices, mesh.faces[top]))
    everything = np.ones(graph.facet_count, dtype=bool)
    assert shrink(graph, everything, rings=2).mask.all()
    assert shrink(graph, everything, distance=0.005).mask.all()
    assert not grow(graph, ~everything, rings=2).mask.any()


def test_smoothing_removes_specks_fills_holes_and_keeps_the_area(
    ball: FacetGraph, rng: np.random.Generator
) -> None:
    cap = polar(ball) <= 0.03
    noisy = cap ^ (rng.uniform(size=ball.facet_count) < 0.05)
    smoothed = smooth(ball, noisy, 4)
    areas = ball.probe.areas
    assert areas[smoothed].sum() == pytest.approx(areas[cap].sum(), rel=0.03)
    assert np.count_nonzero(smoothed ^ cap) < 0.08 * np.count_nonzero(cap)

    assert parts(ball, noisy) > 50
    assert parts(ball, smoothed) == 1
    assert parts(ball, ~smoothed) == 1


def test_smoothing_a_narrow_band_keeps_its_area(ball: FacetGraph) -> None:
    band = np.abs(centroids(ball.probe)[:, 2]) < 0.003
    smoothed = smooth(ball, band, 5)
    assert ball.probe.areas[smoothed].sum() == pytest.approx(ball.probe.areas[band].sum(), rel=0.03)
    assert np.abs(centroids(ball.probe)[smoothed, 2]).max() < 0.008


def test_smoothing_respects_other_regions(ball: FacetGraph) -> None:
    cap = polar(ball) <= 0.02
    allowed = ~cap & (centroids(ball.probe)[:, 0] > 0)
    assert not smooth(ball, cap, 2, allowed=allowed)[~cap & ~allowed].any()


@pytest.mark.parametrize("empty", [True, False])
def test_smoothing_nothing_or_everything(ball: FacetGraph, empty: bool) -> None:
    mask = np.full(ball.facet_count, not empty)
    assert smooth(ball, mask, 2).tolist() == mask.tolist()


def test_mirroring_keeps_the_area_and_is_its_own_inverse(plate: FacetGraph) -> None:
    box = in_box(plate, [0.005, -0.01, 0], [0.02, 0.01, 1])
    plate, mask = FacetGraph(box.probe), box.mask
    there = mirror(plate, mask, [2, 0, 0])
    assert "every facet has a counterpart" in there.sentence
    moments = plate.probe.areas[mask] @ centroids(plate.probe)[mask]
    for image, side in (there, -1), (mirror(FacetGraph(there.probe), there.mask, [1, 0, 0]), 1):
        assert image.probe.areas[image.mask].sum() == pytest.approx(plate.probe.areas[mask].sum(), rel=5e-3)
        found = image.probe.areas[image.mask] @ centroids(image.probe)[image.mask] * [side, 1, 1]
        assert found == pytest.approx(moments, abs=3e-8)


def test_mirroring_keeps_to_its_side_of_a_wall(plate: FacetGraph) -> None:
    # Larger than the wall is thick, so that the other side would be in reach.
    mask = centroids(plate.probe)[:, 2] > 0.0004
    there = mirror(plate, mask, [1, 0, 0], tolerance=0.003)
    assert there.mask.tolist() == mask[there.origin].tolist()


def test_what_has_no_counterpart_is_told(plate: FacetGraph) -> None:
    mask = np.abs(centroids(plate.probe) - [0.012, 0, 0.0005]).max(axis=1) < 0.007
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


# ---- regions carried from one mesh to another ----------------------------------------------------


def sphere(level: int, turn: float = 0.0) -> Probe:
    mesh = trimesh.creation.icosphere(level, radius=0.05)
    mesh.apply_transform(trimesh.transformations.rotation_matrix(turn, [1, 2, 3]))
    return Probe.from_arrays(mesh.vertices, mesh.faces)


def caps(probe: Probe) -> RegionSet:
    z = centroids(probe)[:, 2]
    labels = np.where(z > 0.03, 1, np.where(z < -0.02, 2, 0)).astype(np.int32)
    return RegionSet((Region("top", "#e69f00"), Region("bottom", "#56b4e9")), labels)


@pytest.mark.parametrize(("old", "new"), [(4, 3), (3, 4), (4, 4)])
def test_a_sphere_meshed_anew(old: int, new: int) -> None:
    one, other = sphere(old), sphere(new, 0.3)
    regions = caps(one)
    result = transfer(regions, one, other)
    assert result.regions.regions == regions.regions
    assert result.unmatched == 0
    other = result.regions.mesh(other)
    assert other.health.watertight
    truth = caps(other).labels
    edge = 0.005 * 2 ** (4 - min(old, new))
    z = centroids(other)[:, 2]
    inner = (np.abs(z - 0.03) > edge) & (np.abs(z + 0.02) > edge)
    assert np.count_nonzero(inner) > len(z) / 5
    assert result.regions.labels[inner].tolist() == truth[inner].tolist()
    for rank, part in enumerate(result.report, 1):
        assert part.before == pytest.approx(one.areas[regions.labels == rank].sum())
        assert part.after == pytest.approx(other.areas[result.regions.labels == rank].sum())
        assert abs(part.change) < 0.03
        assert 0 <= part.lost < 0.03 * part.before
        assert 0 <= part.gained < 0.03 * part.before


def test_the_same_mesh_renumbered_is_exact(rng: np.random.Generator) -> None:
    old = sphere(3)
    regions = caps(old)
    vertices, facets = rng.permutation(len(old.vertices)), rng.permutation(len(old.faces))
    number = np.argsort(vertices)
    new = Probe.from_arrays(old.vertices[vertices], np.roll(number[old.faces[facets]], 1, axis=1))
    result = transfer(regions, old, new)
    assert result.regions.labels.tolist() == regions.labels[facets].tolist()
    assert [(part.lost, part.gained) for part in result.report] == [(0, 0), (0, 0)]
    assert result.warnings == ()


def test_a_thin_wall_does_not_take_the_other_side(plate: FacetGraph) -> None:
    """The new mesh is 0.7 mm lower than the old wall of 1 mm: the nearest facets are often the wrong side's."""
    old = plate.probe
    labels = np.where(old.normals[:, 2] > 0.5, 1, np.where(old.normals[:, 2] < -0.5, 2, 0)).astype(np.int32)
    new = (old.vertices - np.array([0, 0, 0.0007]), old.faces)
    carried, unmatched = carry_labels((old.vertices, old.faces), labels, new)
    flat = np.abs(old.normals[:, 2]) > 0.5
    assert carried[flat].tolist() == labels[flat].tolist()
    assert unmatched == 0


def test_a_region_that_vanished_is_told() -> None:
    old, labels = sphere(4), np.zeros(len(sphere(4).faces), dtype=np.int32)
    new = Probe.from_arrays(0.4 * old.vertices, old.faces)
    labels[7] = 1
    with pytest.warns(MeshWarning, match="speck .* vanished"):
        result = transfer(RegionSet((Region("speck", "#000000"),), labels), old, new, reach=0.02)
    (part,) = result.report
    assert part.vanished
    assert part.lost == part.before > 0
    assert "VANISHED" in part.sentence
    assert part.to_json()["after_mm2"] == 0


def test_what_is_far_away_belongs_to_nothing() -> None:
    old = sphere(3)
    new = Probe.from_arrays(old.vertices + [0.01, 0, 0], old.faces)
    with pytest.warns(MeshWarning, match="no part of the old surface near"):
        result = transfer(caps(old), old, new)
    assert result.unmatched > 100
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        assert transfer(caps(old), old, new, reach=0.02).unmatched < result.unmatched


def test_an_empty_region_did_not_vanish() -> None:
    probe = sphere(1)
    result = transfer(RegionSet((Region("a", "#000000"),), np.zeros(80, dtype=np.int32)), probe, probe)
    assert not result.report[0].vanished
    assert np.isnan(result.report[0].change)
    assert "empty before" in result.report[0].sentence


def test_regions_of_another_mesh_are_refused() -> None:
    with pytest.raises(RegionError, match="for 5 facets, but the old mesh has 80"):
        transfer(RegionSet.empty(5), sphere(1), sphere(1))


# ---- regions as values ---------------------------------------------------------------------------


def test_names_and_colours_are_normalised() -> None:
    assert Region("  Le\u0301ns ", "#E69F00") == Region("L\u00e9ns", "#e69f00")


@pytest.mark.parametrize("name", ["", "   ", "x" * 65, "a\nb", "a\x00b", "\u202eevil", "\ud800"])
def test_names_that_cannot_be_shown_are_refused(name: str) -> None:
    with pytest.raises(RegionError, match="name"):
        Region(name, "#000000")


@pytest.mark.parametrize("colour", ["", "red", "#12345", "#1234567", "#12345g", "#123456\n", " #123456"])
def test_colours_that_are_none_are_refused(colour: str) -> None:
    with pytest.raises(RegionError, match="#rrggbb"):
        Region("a", colour)


def test_labels_must_be_ranks() -> None:
    one = (Region("a", "#000000"),)
    with pytest.raises(RegionError, match="facet 2 has the region 2, but there are 1"):
        RegionSet(one, np.array([0, 1, 2], dtype=np.int32))
    with pytest.raises(MeshError, match="row 0 is -1"):
        RegionSet(one, np.array([-1], dtype=np.int32))
    with pytest.raises(RegionError, match="two regions are called 'a'"):
        RegionSet(one + one, np.zeros(3, dtype=np.int32))


def test_a_set_does_not_follow_the_array_it_was_made_of() -> None:
    labels = np.array([0, 1], dtype=np.int32)
    made = RegionSet((Region("a", "#000000"),), labels)
    labels[:] = 0
    assert made.labels.tolist() == [0, 1]
    assert not made.labels.flags.writeable


def test_labels_alone_get_names_and_colours() -> None:
    made = RegionSet.from_labels([0, 3, 1], [Region("Lens", PALETTE[0])])
    assert [region.name for region in made.regions] == ["Lens", "Region 2", "Region 3"]
    assert [region.colour for region in made.regions] == list(PALETTE[:3])
    with pytest.raises(RegionError, match="at most 255"):
        RegionSet.from_labels([MOST_REGIONS + 1])


def test_free_names_and_colours() -> None:
    taken = [Region("Region 3", PALETTE[1]), Region("x", PALETTE[0])]
    assert free_name(taken) == "Region 4"
    assert free_colour(taken) == PALETTE[2]
    every = [Region(str(number), colour) for number, colour in enumerate(PALETTE)]
    assert free_colour(every) == PALETTE[0]


def test_areas_and_ranks() -> None:
    made = RegionSet.from_labels([0, 1, 2, 1], [Region("a", "#000000"), Region("b", "#000000")])
    np.testing.assert_allclose(made.areas(np.array([1.0, 2.0, 4.0, 8.0])), [10, 4])
    assert RegionSet.empty(4).areas(np.ones(4)).shape == (0,)
    assert made.rank_of(" b ") == 2
    with pytest.raises(RegionError, match="choose one of: a, b"):
        made.rank_of("c")


def test_ranks_that_nothing_can_touch() -> None:
    regions = (Region("Lens", "#e69f00"), Region("Clamp", "#000000", untouchable=True))
    made = RegionSet.from_labels([0, 2, 4, 3], regions, untouchable=(1, 4))
    # What is known of a region counts more than what the labels' file says of its number.
    assert made.untouchable == (2, 4)
    assert RegionSet.from_labels([1]).untouchable == ()
