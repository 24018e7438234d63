"""Markers: on the true surface, apart from one another, where a tip reaches."""

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.virtual.markers import markers, markers_on


@pytest.mark.parametrize(("name", "count"), [("t-shape", 17), ("linear", 15), ("convex", 15)])
def test_markers_lie_apart_on_the_true_surface(name, count):
    points = markers(name)
    feet, normals, distance = assets.surface(name).project(points)
    assert points.shape == (count, 3)
    assert np.abs(distance).max() < 1e-9
    assert np.abs(feet - points).max() < 1e-9
    assert pdist(points[5:]).min() > 0.012
    # The first five are on the acoustic face, from left to right, the third in its middle.
    assert (normals[:5, 2] > 0.85).all()
    assert (np.diff(points[:5, 0]) > 0.006).all()
    np.testing.assert_allclose(points[2, :2], 0.0, atol=1e-4)
    # The others are on the head's sides: none looks down to the flange.
    assert (points[5:, 2] > points[:, 2].max() - 0.040).all()
    assert (np.abs(normals[5:, 2]) < 0.85).all()


def test_they_are_the_same_on_every_call_and_cannot_be_changed():
    markers.__globals__["_marked"].cache_clear()
    first = markers("linear")
    markers.__globals__["_marked"].cache_clear()
    assert np.array_equal(first, markers("linear"))
    with pytest.raises(ValueError, match="read-only"):
        first[0] = 0.0


def test_any_probe_has_markers():
    points = markers_on(Probe.from_arrays(*assets.make("convex", 4000)), 9)
    assert points.shape == (9, 3)
    assert np.abs(assets.surface("convex").project(points)[2]).max() < 1e-4


def test_what_has_none_is_said():
    with pytest.raises(InputError, match=r"no probe 'axe': choose one of t-shape"):
        markers("axe")
    vertices, faces = assets.make("linear", 2000)
    with pytest.raises(InputError, match="at least 5"):
        markers_on(Probe.from_arrays(vertices, faces), 4)
