import numpy as np
import pytest

from contactbench.pipeline.contact.patch import spread
from contactbench.pipeline.control.settings import (
    USUAL_MODULUS,
    ControlSettings,
    Foundation,
    Variant,
    for_tool,
)
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import model_of


@pytest.mark.parametrize("name", ["convex", "linear", "t-shape"])
def test_the_defaults_of_a_probe_give_the_loops_the_wanted_gains(name):
    foundation = Foundation(model_of(name, 1000))
    settings = ControlSettings.for_probe(foundation, force_gain=5.0, angle_gains=(3.0, 4.0))
    press = foundation.at(7.0, USUAL_MODULUS)
    assert press.stiffness / settings.force_damping == pytest.approx(5.0)
    assert settings.force_mass / settings.force_damping == pytest.approx(0.04)
    gains = 7.0 * np.array([press.gain_y, press.gain_x]) / settings.angle_damping
    settling = np.divide(settings.angle_inertia, settings.angle_damping)
    # A wide face gets what is wanted; a narrow one less, and more mass.
    assert (gains <= np.array([3.0, 4.0]) * (1 + 1e-9)).all()
    assert (settling >= 0.04 - 1e-9).all()
    assert (gains * settling < 0.26).all()
    if name == "t-shape":
        assert gains[1] == pytest.approx(4.0)
    if name == "linear":
        assert gains[0] < 2.0
        assert settling[0] > 0.1
    # What comes while it stops, on tissue five times stiffer.
    assert settings.approach_speed * 0.05 * 5 * press.stiffness <= 0.6 * 7.0 + 1e-9


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"force_mass": 0.0}, "force_mass"),
        ({"angle_damping": (0.1, np.nan)}, "angle_damping"),
        ({"period": -0.02}, "period"),
        ({"max_speed": np.inf}, "max_speed"),
        ({"desired_force": 25.0}, "80 % of the limit of 30 N"),
        ({"desired_force": 0.5}, "must be above 0.7 N"),
        ({"variant": "Plain"}, "variant is Plain: give one of plain, aware"),
        ({"max_tilt": 1.6}, "max_tilt"),
        ({"max_tilt": np.inf}, "max_tilt"),
        ({"max_tilt": 0.0}, "max_tilt"),
    ],
)
def test_what_cannot_be_is_refused(wrong, says):
    with pytest.raises(InputError, match=says):
        ControlSettings(**wrong)


def test_a_heavy_tool_is_turned_more_slowly_and_a_light_one_as_usual():
    usual = ControlSettings()
    assert for_tool(usual, 0.45, 0.08) == usual
    slow = for_tool(usual, 0.8, 0.12)
    share = usual.smoothing / slow.smoothing
    assert 0.6 < share < 0.95
    assert slow.angle_gains == pytest.approx((6.0 * share, 6.0 * share))
    assert slow.bandwidth == pytest.approx((20.0, 13.0 * share, 13.0 * share))
    assert slow.settling == pytest.approx(usual.settling / share)
    assert slow.force_gain == usual.force_gain
    assert for_tool(usual, 0.8, -0.12) == slow, "a centre of mass beyond the tip swings as well"


def test_what_may_be_nothing_may():
    assert ControlSettings(variant="plain").variant is Variant.PLAIN
    ControlSettings(probing=0.0, taring=0.0, servo_lag=0.0, gyration=0.0, attempts=0)


# ----  --------------------------------------------------------------------------------------------


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
    press = Foundation(probe).at(7.0, USUAL_MODULUS)
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
