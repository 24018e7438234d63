from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.control.margins import AXES, LoopModel, loop_of, margins, response, sweep
from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Foundation, Variant
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import model_of


@pytest.fixture(scope="module")
def foundation():
    return Foundation(model_of("t-shape", 1000))


def test_a_slow_loop_is_an_integrator():
    w = np.array([0.1, 1.0])
    L = response(LoopModel(gain=2.0, settling=1e-4), w)
    np.testing.assert_allclose(np.abs(L), 2.0 / w, rtol=0.01)
    found = margins(LoopModel(gain=2.0, settling=1e-4))
    assert found.stable
    assert found.crossover == pytest.approx(2.0, rel=0.05)
    assert found.phase > np.radians(75)


def simulated(loop, seconds=8.0):
    """The loop step by step in time, from 1 away: does it come to rest? Written anew, without the model's algebra."""
    T, n = loop.period, round(seconds / loop.period)
    u = np.array([0.25, 0.5, 0.75, 1.0])
    p, v, speed = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0
    r = np.exp(-T / loop.settling)
    for _ in range(n):
        a, g = v[-2] * T, v[-1] * T
        path = p[-2] + a * (u - 2 * u**2 + u**3) + g * (2 * u**2 - u**3)
        sensed = path.mean() + loop.inertia * (v[-1] - v[-2]) / T
        wanted = loop.gain * loop.ratio * (1.0 - sensed)
        mean = wanted + (speed - wanted) * (1 - r) * loop.settling / T
        speed = wanted + (speed - wanted) * r
        v.append(mean)
        p.append(p[-1] + T * mean)
        if abs(p[-1]) > 1e3:
            return False
    return max(abs(np.array(p[-50:]) - 1.0)) < 0.05


@pytest.mark.parametrize("settling", [0.01, 0.04, 0.1])
@pytest.mark.parametrize("inertia", [0.0, 0.0005])
def test_it_says_where_a_plain_loop_begins_to_swing(settling, inertia):
    loop = LoopModel(gain=6.0, settling=settling, inertia=inertia)
    limit = 6.0 * margins(loop).gain
    assert simulated(replace(loop, gain=0.9 * limit))
    assert not simulated(replace(loop, gain=1.1 * limit))
    assert not margins(replace(loop, gain=1.1 * limit)).stable
    assert margins(replace(loop, gain=1.1 * limit)).gain == pytest.approx(1 / 1.1, rel=0.02)


def test_a_later_arm_has_less():
    found = [margins(LoopModel(gain=6.0, settling=0.04, lag=lag)) for lag in (0.0, 0.03, 0.06)]
    assert found[0].gain > found[1].gain > found[2].gain
    assert found[0].phase > found[1].phase > found[2].phase


def test_a_wrong_stiffness_costs_the_aware_variant_its_margin():
    right = LoopModel(gain=6.0, settling=0.04, bandwidth=20.0)
    assert margins(right).gain == pytest.approx(margins(replace(right, bandwidth=0.0)).gain, rel=0.1)
    assert margins(replace(right, ratio=3.0)).gain < 0.6 * margins(right).gain
    assert not margins(replace(right, ratio=0.1)).stable


def test_the_defaults_have_margin_on_tissue_five_times_softer_and_stiffer(foundation):
    settings = ControlSettings.for_probe(foundation)
    moduli = [0.2 * USUAL_MODULUS, USUAL_MODULUS, 5 * USUAL_MODULUS]
    for variant in Variant:
        rows = sweep(replace(settings, variant=variant), foundation, moduli)
        assert len(rows) == len(moduli) * len(AXES)
        for _, axis, found in rows:
            assert found.stable, (variant, axis)
            assert found.gain > 2.0, (variant, axis)
            assert found.phase > np.radians(25), (variant, axis)
    plain = {
        modulus: found.gain
        for modulus, axis, found in sweep(replace(settings, variant=Variant.PLAIN), foundation, moduli)
        if axis == "force"
    }
    assert plain[moduli[2]] < plain[moduli[1]] / 3, "the plain one pays for stiff tissue"


def test_a_modulus_taken_wrongly_is_what_the_aware_variant_divides_by(foundation):
    settings = ControlSettings.for_probe(foundation)
    loop = loop_of(settings, foundation, USUAL_MODULUS, "force", assumed=5 * USUAL_MODULUS)
    real, taken = (
        foundation.at(settings.desired_force, each).stiffness for each in (USUAL_MODULUS, 5 * USUAL_MODULUS)
    )
    assert loop.ratio == pytest.approx(real / taken)
    assert loop.ratio < 0.5
    assert loop_of(settings, foundation, USUAL_MODULUS, "force").ratio == 1.0


@pytest.mark.parametrize("wrong", [{"modulus": 0.0}, {"modulus": np.nan}, {"modulus": 3e6, "unknown": 2.0}])
def test_what_cannot_be_is_refused(foundation, wrong):
    with pytest.raises(InputError, match="margins"):
        loop_of(ControlSettings(), foundation, axis="force", **wrong)
