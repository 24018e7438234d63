"""Plain geometry of triangles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.mesh import triangles
from contactbench.pipeline.mesh.triangles import first_alike

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
