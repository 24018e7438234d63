"""Which facets a tip can reach: by true distance, however large they are."""

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.scenes.indenter import TipPress, TouchScene
from contactbench.pipeline.simulation.scenes.physics import TrueSurface, facets_near, triangle_distances

_SIZE, _BASE = np.array([0.06, 0.03, 0.06]), 0.06


@pytest.fixture(scope="module")
def box() -> TrueSurface:
    """A box of twelve facets, each wider than a tip's patch."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0, 1)]) * _SIZE
    faces = [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]  # fmt: skip
    return TrueSurface(Probe.from_arrays(corners + [0, 0, _BASE], np.array(faces), name="box"))


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.02, 0.01), (-0.02, -0.01), (0.02, -0.01), (0.0285, 0.0135)])
def test_a_facet_wider_than_the_patch_is_touched_in_its_middle_and_near_its_corner(
    box: TrueSurface, place: tuple[float, float]
) -> None:
    marker = np.array([*place, _BASE + _SIZE[2]])
    scene = TouchScene(box, marker)
    scene.press(TipPress(9))
    moment = scene.settle()
    assert moment is not None
    assert moment.force == pytest.approx(9, abs=1e-3)
    assert np.linalg.norm(moment.centroid_S - marker) < 2e-5


def test_the_side_that_is_touched_wins_where_several_share_a_corner(box: TrueSurface) -> None:
    corner = np.array([0.03, 0.015, 0.12])
    for axis in range(3):
        outward = np.eye(3)[axis]
        point = corner - 0.001 + 0.001 * outward  # on one side, 1 mm from two others
        normals = box.probe.normals[facets_near(box, point, 0.005)]
        np.testing.assert_allclose(normals, np.broadcast_to(outward, normals.shape), atol=1e-9)


def test_a_point_off_the_surface_is_refused(box: TrueSurface) -> None:
    with pytest.raises(InputError, match="no surface within 5 mm"):
        facets_near(box, np.array([0.0, 0.0, 0.2]), 0.005)


def test_distances_are_those_to_the_closest_of_many_points_of_each_triangle() -> None:
    rng = np.random.default_rng(1)
    corners, point = rng.normal(size=(60, 3, 3)), rng.normal(size=3)
    grid = np.array([(a, b) for a in np.linspace(0, 1, 301) for b in np.linspace(0, 1, 301) if a + b <= 1])
    shares = np.column_stack([grid, 1 - grid.sum(axis=1)])
    sampled = [np.linalg.norm(shares @ corner - point, axis=1).min() for corner in corners]
    np.testing.assert_allclose(triangle_distances(point, corners), sampled, atol=2e-3)


def test_a_needle_of_a_triangle_has_a_distance() -> None:
    corners = np.array([[[0.0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 0, 0], [0, 0, 0], [0, 0, 0]]])
    np.testing.assert_allclose(triangle_distances(np.array([1.5, 3.0, 0]), corners), [3.0, np.hypot(1.5, 3)])
