"""Plain geometry of triangles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.mesh import triangles
from contactbench.pipeline.mesh.triangles import cross_products, first_alike, vertex_normals

_NUMBERS = st.sampled_from([0.0, -0.0, 1.0, 1.0 + 2**-52, -1.0, 1e-300, 1e300])


@given(st.lists(st.tuples(_NUMBERS, _NUMBERS, _NUMBERS), min_size=1, max_size=40))
def test_each_row_has_the_first_one_that_is_equal(rows):
    found = first_alike(np.array(rows))
    assert found.tolist() == [next(k for k, other in enumerate(rows) if other == row) for row in rows]


@pytest.mark.parametrize("kind", [np.int32, np.float64])
def test_rows_that_only_look_alike_are_told_apart(kind, monkeypatch):
    rows = np.random.default_rng(0).integers(0, 30, (2_000, 3)).astype(kind)
    usual = first_alike(rows)
    # Every row has the same number now, so rows themselves are compared.
    monkeypatch.setattr(triangles, "_MIXER", np.uint64(0))
    np.testing.assert_array_equal(first_alike(rows), usual)
    np.testing.assert_array_equal(rows[usual], rows)


def test_normals_of_vertices_are_those_of_areas_not_of_facets():
    # The side at the back of the corner is cut in two: it counts by its area all the same.
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0], [0, 0.5, 0.5], [9, 9, 9]])
    faces = np.array([[0, 2, 1], [0, 4, 2], [0, 3, 4]], dtype=np.int32)
    normals = vertex_normals(cross_products(vertices, faces), faces, len(vertices))
    assert normals[0] == pytest.approx(-np.array([1, 0, 1]) / np.sqrt(2))
    assert normals[1] == pytest.approx([0, 0, -1])
    assert normals[5] == pytest.approx([0, 0, 0])
