import json
import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from benchmarks.bundle_example import example_config

from contactbench.pipeline.config.runtime.options import ExportOptions, with_file
from contactbench.pipeline.control.controller import Controller
from contactbench.pipeline.control.inverse import CartesianMount
from contactbench.pipeline.control.margins import (
    AXES,
    LoopModel,
    WantedMargins,
    loop_of,
    margins,
    response,
    rows_of,
    settings_content,
    spread_of,
    tune,
    weak_loops,
)
from contactbench.pipeline.control.settings import (
    USUAL_MODULUS,
    ControlSettings,
    Foundation,
    Variant,
    controller_of,
    settings_of,
)
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.study.gain_trials import foundation_of, run


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
        mine = replace(settings, variant=variant)
        for modulus, axis in product(moduli, AXES):
            found = margins(loop_of(mine, foundation, modulus, axis))
            assert found.stable, (variant, axis)
            assert found.gain > 2.0, (variant, axis)
            assert found.phase > np.radians(25), (variant, axis)
    mine = replace(settings, variant=Variant.PLAIN)
    _, usual, stiff = (margins(loop_of(mine, foundation, modulus, "force")).gain for modulus in moduli)
    assert stiff < usual / 3, "the plain one pays for stiff tissue"


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


# ---- gains: the highest that leave the wanted margins, and a file that bundle export takes -------


@pytest.mark.parametrize("variant", list(Variant))
@pytest.mark.parametrize("probe", ["linear", "t-shape"])
def test_margins_are_kept_on_all_tissue(probe, variant):
    foundation = foundation_of(probe)
    tuned = tune(foundation, USUAL_MODULUS, variant=variant)
    for modulus in spread_of(USUAL_MODULUS, 5.0):
        for axis in AXES:
            found = margins(loop_of(tuned.settings, foundation, modulus, axis))
            assert tuned.wanted.kept(found), (modulus, axis)


def test_a_higher_gain_would_leave_less():
    foundation, wanted = foundation_of("linear"), WantedMargins()
    tuned = tune(foundation, USUAL_MODULUS, variant=Variant.PLAIN, wanted=wanted)
    assert tuned.reached["force"] == "the margins"
    faster = tune(
        foundation,
        USUAL_MODULUS,
        variant=Variant.PLAIN,
        wanted=WantedMargins(gain=wanted.gain / 1.3, phase=wanted.phase / 1.3),
    )
    assert faster.settings.force_gain > 1.05 * tuned.settings.force_gain


def test_what_cannot_be_had_is_said():
    with pytest.raises(InputError, match="the spread of stiffness"):
        tune(foundation_of("linear"), USUAL_MODULUS, variant=Variant.PLAIN, wanted=WantedMargins(gain=90.0))


@pytest.mark.parametrize(
    "wrong", [{"gain": 1.0}, {"phase": 0.0}, {"phase": 2.0}, {"spread": 0.5}, {"fastest": 99.0}]
)
def test_impossible_wishes_are_refused(wrong):
    with pytest.raises(InputError, match="tuning"):
        WantedMargins(**wrong)


def test_rows_are_sorted_by_stiffness():
    foundation = foundation_of("convex")
    rows = rows_of(tune(foundation, USUAL_MODULUS), foundation, 3)
    force = [row.stiffness for row in rows if row.axis == "force"]
    assert len(rows) == 9
    assert force == sorted(force)


def test_config_export_takes_the_gains():
    tuned = tune(foundation_of("convex"), USUAL_MODULUS, variant=Variant.PLAIN)
    data = json.dumps(settings_content(tuned.settings)).encode()
    settings = with_file(ExportOptions(), data, "gains.json")
    assert settings_of(settings.controller, settings.limits) == tuned.settings


def test_trials_hold_and_files_are_written(tmp_path):
    told = []
    result = run("t-shape", stiffness=3000.0, progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 3), (2, 3), (3, 3)]
    assert result.report.passed
    usual = result.report.figures[4].subject
    assert float(usual.removesuffix(" N/m").replace(",", "")) == pytest.approx(3000.0, rel=0.05)
    result.write(tmp_path)
    assert {each.name for each in tmp_path.iterdir()} == {
        "gains.json",
        "gains.csv",
        "margins.csv",
        "margins.png",
        "tuning.md",
    }
    assert json.loads(json.dumps(result.to_json(), allow_nan=False))["passed"]


@pytest.mark.parametrize(
    "wrong",
    [{"probe": "none"}, {"scene": "none"}, {"force": 0.0}, {"stiffness": -1.0}, {"stiffness": math.nan}],
)
def test_impossible_arguments_are_refused(wrong):
    with pytest.raises(InputError):
        run(**wrong)


def test_spread_is_even_in_the_logarithm():
    np.testing.assert_allclose(spread_of(2.0, 4.0, 3), [0.5, 2.0, 8.0])


def test_a_bundle_is_told_which_of_its_loops_has_too_little():
    config = example_config(500)
    assert weak_loops(config) == []
    given = settings_of(config.model.controller, config.model.limits)
    assert weak_loops(config, replace(given, variant="plain")) == []
    ((said, left),) = weak_loops(config, replace(given, angle_gains=(30.0, 6.0)))
    assert (said[:19], left.stable) == ("Controller, about x", True)
    part = controller_of(replace(given, force_gain=60.0))
    config = replace(config, model=config.model.model_copy(update={"controller": part}))
    with pytest.raises(InputError, match=r"would swing\. Controller, force"):
        Controller.from_config(config, CartesianMount(), np.zeros(6))
