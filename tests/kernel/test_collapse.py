"""Edges are collapsed to the count, in the order of the quadric error, and never so that the surface suffers."""

import numpy as np
import pytest
import trimesh
from contact_cases import bundled

from contactbench.pipeline.kernel import collapse_edges, crossings
from contactbench.pipeline.mesh.probe import measure_health
from contactbench.pipeline.mesh.soundness import check_soundness

Mesh = tuple[np.ndarray, np.ndarray]


def _collapsed(mesh: Mesh, wanted: tuple[int, int], second: np.ndarray | None = None) -> Mesh:
    groups = np.zeros(len(mesh[1]), dtype=np.bool_) if second is None else second
    return collapse_edges(mesh[0], mesh[1], wanted, groups, lambda _fraction: None)[:2]


def _mesh(made: trimesh.Trimesh) -> Mesh:
    return np.ascontiguousarray(made.vertices, dtype=np.float64), np.ascontiguousarray(
        made.faces, dtype=np.int32
    )


def _ball(level: int = 4) -> Mesh:
    return _mesh(trimesh.creation.icosphere(level, radius=50.0))


def _fine_box(size: tuple[float, float, float], level: int = 4) -> Mesh:
    made = trimesh.creation.box(size)
    for _ in range(level):
        made = made.subdivide()
    return _mesh(made)


def _sound(mesh: Mesh) -> bool:
    health = measure_health(*mesh)
    return health.watertight and health.outward is True and not crossings(*mesh)[2].any()


@pytest.mark.parametrize("count", [8, 20, 100, 1000])
def test_a_ball_keeps_its_shape_to_the_fewest_facets(count: int) -> None:
    made = _collapsed(_ball(), (count, 0))
    assert len(made[1]) == count
    assert _sound(made)
    assert len(np.unique(made[1])) == len(made[0]) == count // 2 + 2
    # What the best inscribed polyhedra of that many facets reach, and half as much again.
    off = np.abs(np.linalg.norm(made[0][made[1]].mean(axis=1), axis=1) - 50).max()
    assert off < 1.5 * 50 * 8 / count + 1
    # Facets cut the ball as much as they stand off it; from the quadrics alone it is 4 / count less.
    assert trimesh.Trimesh(*made).volume == pytest.approx(trimesh.Trimesh(*_ball()).volume, rel=2 / count)


def test_a_tetrahedron_is_the_least() -> None:
    made = _collapsed(_ball(2), (0, 0))
    assert len(made[1]) == 4
    assert _sound(made)


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_no_facet_turns_against_the_surface(name: str) -> None:
    probe = bundled(name, 20_000)
    size = probe.size / 100
    for count in (300, 1000, 4000):
        vertices, faces = _collapsed((probe.vertices / size, probe.faces), (count, 0))
        assert len(faces) <= count
        found = check_soundness(vertices * size, faces, (probe.vertices, probe.faces))
        assert found.sound
        assert found.largest_deviation_deg < 60


def test_a_rough_surface_does_not_cross_itself() -> None:
    """Spikes as long as the facets are wide: neighbours at one vertex can cross as well as facets far apart."""
    vertices, faces = _ball()
    rough = vertices * (1 + 0.07 * np.random.default_rng(3).standard_normal(len(vertices)))[:, None]
    assert _sound((rough, faces))
    for count in (3000, 1000, 300):
        assert _sound(_collapsed((rough, faces), (count, 0))), count


def test_flat_sides_cost_nothing() -> None:
    made = _collapsed(_fine_box((100.0, 60.0, 0.3)), (12, 0))
    assert len(made[1]) == 12
    assert _sound(made)
    assert trimesh.Trimesh(*made).volume == pytest.approx(100 * 60 * 0.3, rel=1e-9)


def test_two_sheets_that_nearly_touch_never_cross() -> None:
    """Waves in step, 0.05 apart: simplified apart from each other, crests of one reach through the other."""
    side = np.linspace(-50, 50, 61)
    x, y = (each.ravel() for each in np.meshgrid(side, side))
    height = 2 * np.sin(x / 4) * np.cos(y / 5)
    grid = np.arange(61 * 61).reshape(61, 61)
    a, b, c, d = (each.ravel() for each in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]))
    top = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    rim = np.concatenate([grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]])
    after, below = np.roll(rim, -1), 61 * 61
    wall = np.concatenate(
        [np.column_stack([after, rim, rim + below]), np.column_stack([after, rim + below, after + below])]
    )
    vertices = np.vstack([np.column_stack([x, y, height]), np.column_stack([x, y, height - 0.05])])
    faces = np.concatenate([top, top[:, ::-1] + below, wall]).astype(np.int32)
    assert _sound((vertices, faces))
    for count in (2000, 1000, 500, 300):
        made = _collapsed((vertices, faces), (count, 0))
        assert _sound(made), count
        assert len(made[1]) <= 1.5 * count


def test_a_tube_stays_a_tube() -> None:
    made = _collapsed(_mesh(trimesh.creation.torus(30, 8, major_sections=80, minor_sections=40)), (100, 0))
    assert len(made[1]) == 100
    assert _sound(made)
    assert len(made[0]) == len(made[1]) // 2  # Euler: one handle
    fewest = _collapsed(made, (0, 0))
    assert _sound(fewest)
    assert len(fewest[0]) == len(fewest[1]) // 2


def test_each_group_keeps_its_share() -> None:
    ball = _ball()
    upper = ball[0][ball[1]].mean(axis=1)[:, 2] > 25
    made = _collapsed(ball, (200, 600), upper)
    assert 797 <= len(made[1]) <= 800
    assert _sound(made)
    assert np.count_nonzero(made[0][made[1]].mean(axis=1)[:, 2] > 25) == pytest.approx(600, abs=30)


def test_no_label_is_lost_whatever_the_count() -> None:
    """A square and a strip on a ball, simplified as far as it goes, and again from there."""
    (vertices, faces), nowhere = _ball(), lambda faces: np.zeros(len(faces), dtype=bool)
    _, y, z = vertices[faces].mean(axis=1).T / np.abs(vertices).max()
    labels = np.where(z > 0.95, 1, np.where((np.abs(y) < 0.1) & (z < 0), 2, 0)).astype(np.int32)
    before = _areas(vertices, faces, labels)
    for _ in range(2):
        vertices, faces, kept = collapse_edges(
            vertices, faces, (4, 0), nowhere(faces), lambda _: None, labels
        )
        labels = labels[kept]
        assert len(faces) > 20
        assert _sound((vertices, faces))
        np.testing.assert_allclose(_areas(vertices, faces, labels)[1:] / before[1:], 1, atol=0.12)


def _areas(vertices: np.ndarray, faces: np.ndarray, labels: np.ndarray) -> np.ndarray:
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return np.bincount(labels, np.linalg.norm(np.cross(b - a, c - a), axis=1), 3)


def test_an_open_surface_keeps_its_rim() -> None:
    ball = _ball()
    bowl = (ball[0], np.ascontiguousarray(ball[1][ball[0][ball[1]].mean(axis=1)[:, 2] < 10]))
    vertices, faces = _collapsed(bowl, (300, 0))
    assert len(faces) <= 300
    health = measure_health(vertices, faces)
    assert health.components == 1
    assert health.nonmanifold_edges == 0
    edges, uses = np.unique(
        np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0, return_counts=True
    )
    rim = np.unique(edges[uses == 1])
    assert 8 < len(rim) < 80
    assert np.abs(vertices[rim, 2] - 10).max() < 4


def test_a_band_is_not_pinched() -> None:
    band = trimesh.creation.cylinder(40, 10, sections=60)
    band = trimesh.Trimesh(
        band.vertices, band.faces[np.abs(band.face_normals[:, 2]) < 0.5], process=False
    ).subdivide()
    band.remove_unreferenced_vertices()
    vertices, faces = _collapsed(_mesh(band), (0, 0))
    assert 6 <= len(faces) < len(band.faces)
    found = check_soundness(vertices, faces)
    assert len(found.pinched_vertices) == 0
    assert found.health.nonmanifold_edges == 0
    assert found.health.components == 1


def test_vertices_where_three_facets_meet_stay() -> None:
    ball = _ball(3)
    fin = np.vstack([ball[1], [ball[1][0, 0], ball[1][0, 1], len(ball[0])]]).astype(np.int32)
    vertices, faces = _collapsed((np.vstack([ball[0], [0.0, 0.0, 90.0]]), fin), (20, 0))
    for corner in ball[0][ball[1][0, :2]]:
        assert np.abs(vertices - corner).max(axis=1).min() == 0
    assert measure_health(vertices, faces).nonmanifold_edges == 1


def test_progress_rises_and_ends_the_work_by_raising() -> None:
    told: list[float] = []
    ball = _ball(5)
    none = np.zeros(len(ball[1]), dtype=np.bool_)
    collapse_edges(*ball, (100, 0), none, told.append)
    assert told == sorted(told)
    assert len(told) > 1

    def stop(fraction: float) -> None:
        raise KeyError(fraction)

    with pytest.raises(KeyError):
        collapse_edges(*ball, (100, 0), none, stop)


def test_what_is_no_mesh_is_refused() -> None:
    vertices, faces = _ball(1)
    none = np.zeros(len(faces), dtype=np.bool_)

    def nothing(_fraction: float) -> None: ...

    with pytest.raises(ValueError, match="row 0 refers to a vertex"):
        collapse_edges(vertices, faces + np.int32(len(vertices)), (8, 0), none, nothing)
    holed, flat = vertices.copy(), faces.copy()
    holed[3, 1], flat[0] = np.nan, flat[0, 0]
    with pytest.raises(ValueError, match="row 3 is not within"):
        collapse_edges(holed, faces, (8, 0), none, nothing)
    with pytest.raises(ValueError, match="row 0 has no area"):
        collapse_edges(vertices, flat, (8, 0), none, nothing)
    with pytest.raises(ValueError, match="second"):
        collapse_edges(vertices, faces, (8, 0), none[1:], nothing)
    with pytest.raises(ValueError, match="wanted"):
        collapse_edges(vertices, faces, (-1, 0), none, nothing)
