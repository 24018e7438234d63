import numpy as np
import pytest

from contactbench.pipeline.contact.footprint import spread
from contactbench.pipeline.control.settings import USUAL_MODULUS, Foundation
from contactbench.pipeline.simulation.marker_touches import model_of


@pytest.fixture(scope="module", params=["convex", "linear", "t-shape"])
def probe(request):
    return model_of(request.param, 2000)


def brute(probe, depth, modulus, about=None, tilt=0.0):
    """Force and centroid of a bed of springs, turned by `tilt` about an axis through the tip."""
    places, _, area = spread(probe, 3000)
    surface = np.array([0.0, 0.0, probe.vertices[:, 2].max() - depth])
    normal = np.array([0.0, 0.0, 1.0])
    if about == "y":
        normal = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    if about == "x":
        normal = np.array([0.0, -np.sin(tilt), np.cos(tilt)])
    deep = np.maximum((places - surface) @ normal, 0.0)
    return modulus * area * deep.sum(), deep @ places / deep.sum()


def test_force_and_stiffness_are_those_of_a_sum_over_the_face(probe):
    foundation = Foundation(probe)
    press = foundation.at(7.0, USUAL_MODULUS)
    force, centroid = brute(probe, press.depth, USUAL_MODULUS)
    assert force == pytest.approx(7.0, rel=0.03)
    more, _ = brute(probe, press.depth + 2e-4, USUAL_MODULUS)
    less, _ = brute(probe, press.depth - 2e-4, USUAL_MODULUS)
    assert press.stiffness == pytest.approx((more - less) / 4e-4, rel=0.05)
    assert (press.x, press.y) == pytest.approx(centroid[:2], abs=3e-4)


@pytest.mark.parametrize(("about", "axis"), [("y", 0), ("x", 1)])
def test_a_tilt_moves_the_place_by_the_gain(probe, about, axis):
    press = Foundation(probe).at(7.0, USUAL_MODULUS)
    small = 0.004
    (_, one), (_, other) = (brute(probe, press.depth, USUAL_MODULUS, about, tilt) for tilt in (small, -small))
    moved = (one - other)[axis] / (2 * small)
    # Tissue that is turned about +y is nearer at +x; about +x, at -y.
    gain = press.gain_x if about == "y" else -press.gain_y
    assert moved == pytest.approx(gain, rel=0.1)


def test_a_stiffness_tells_the_modulus_it_was_made_with(probe):
    foundation = Foundation(probe)
    for modulus in (1.5e6, 3e6, 15e6):
        stiffness = foundation.at(7.0, modulus).stiffness
        # On the edge of the curved faces the table is coarse, nothing else.
        assert foundation.modulus_of(7.0, stiffness) == pytest.approx(modulus, rel=0.15)


def test_beyond_its_table_it_stays_at_its_end(probe):
    foundation = Foundation(probe)
    deepest = foundation.at(1e6, 1e3)
    assert deepest == foundation.at(1e7, 1e3)
    assert 0.011 < deepest.depth < 0.012
    assert (foundation.axes > 0).all()
