import numpy as np
import pytest

from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Foundation, for_tool
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


@pytest.mark.parametrize("angle", [1.6, np.inf, 0.0])
def test_a_tilt_must_end_somewhere(angle):
    with pytest.raises(InputError, match="max_tilt"):
        ControlSettings(max_tilt=angle)


def test_what_may_be_nothing_may():
    ControlSettings(probing=0.0, taring=0.0, servo_lag=0.0, gyration=0.0, attempts=0)
