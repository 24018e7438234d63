"""Verdicts: where a curve crosses, what is worth modelling, and how it is said."""

import pytest

from contactbench.pipeline.study.ablation import location_choices, scenery, sensor_choices, verdicts
from contactbench.pipeline.study.ablation.verdicts import (
    Bought,
    ChoiceVerdict,
    Cost,
    about_choices,
    bought,
    crossing,
    crossings,
)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([0.0, 0.0, 0.10, 0.2], (pytest.approx(10**0.5), True, False)),
        ([0.2, 0.10, 0.0, 0.0], (pytest.approx(10**0.5), False, False)),
        ([0.2, 0.1, 0.1, 0.1], (None, True, True)),
        ([0.0, 0.01, 0.02, 0.0], (None, True, False)),
        ([0.0, 0.2, 0.0, 0.1], (pytest.approx(10**1.5), True, False)),
    ],
    ids=["rising", "falling", "always", "never", "the last rise counts"],
)
def test_a_crossing_is_where_it_matters_for_good(values, expected):
    assert crossing([0.1, 1.0, 10.0, 100.0], values) == expected


def test_a_crossing_from_zero_is_not_on_a_logarithm():
    where, above, always = crossing([0.0, 1.0], [0.0, 0.1])
    assert (where, above, always) == (pytest.approx(0.5), True, False)


def row(**more):
    values = {
        "kind": "effect",
        "choice": location_choices.LOCAL_TORQUE,
        "scene": "touch",
        "probe": "linear",
        "noise": "filtered",
        "without_mean_mm": 1.0,
        "made_mean_mm": 0.8,
        "bought_mm": 0.2,
        "bought_se_mm": 0.01,
        "without_sure": 1.0,
        "made_sure": 1.0,
        "without_gross": 0.0,
        "made_gross": 0.0,
    }
    return values | more


@pytest.mark.parametrize(
    ("change", "models"),
    [
        ({}, True),
        ({"bought_mm": 0.04}, False),
        ({"bought_se_mm": 0.15}, False),
        ({"bought_mm": -0.2}, False),
        ({"bought_mm": 0.0, "without_sure": 0.99}, True),
        ({"bought_mm": 0.0, "without_gross": 0.01}, True),
        ({"bought_mm": 0.0, "without_gross": None}, False),
    ],
    ids=[
        "it matters",
        "too little",
        "may be chance",
        "it harms",
        "more sure",
        "fewer gross misses",
        "no miss",
    ],
)
def test_what_is_worth_modelling(change, models):
    assert bought(location_choices.LOCAL_TORQUE, "touch", [row(**change)]).models is models


def test_a_scene_that_moves_the_contact_is_worth_modelling():
    mine = {"kind": "scenery", "choice": scenery.PHANTOM, "scene": "press", "without_us": 1.0, "made_us": 9.0}
    found = bought(scenery.PHANTOM, "press", [mine | {"mean_mm": 5.0, "floor_mm": 0.1}])
    assert (found.without, found.made, found.models) == (5.0, 0.1, True)
    assert not bought(scenery.PHANTOM, "press", [mine | {"mean_mm": 0.11, "floor_mm": 0.1}]).models
    assert verdicts.cost_of(scenery.PHANTOM, [mine]) == Cost(scenery.PHANTOM, "a simulated ms", 1.0, 9.0)


def need(scene, models):
    return Bought("it", scene, 1.0, 0.5, 0.5, 0.0, 0.0, models)


@pytest.mark.parametrize(
    ("scenes", "cost", "said"),
    [
        ((need("touch", True), need("arm", True)), 1.0, "model it"),
        ((need("touch", True), need("arm", False)), 1.0, "model it in touch"),
        ((need("touch", False),), 1.0, "leave it out"),
        ((need("touch", False),), -1.0, "keep it: no cost"),
    ],
)
def test_verdicts_in_words(scenes, cost, said):
    verdict = ChoiceVerdict("it", scenes, Cost("it", "a solve", 2.0, 2.0 + cost))
    assert verdict.verdict == said
    assert f"it: {said}; buys up to 0.5 mm" in verdict.sentence
    assert verdict.to_json()["verdict"] == said


def test_about_choices_takes_only_what_is_there():
    [found] = about_choices([row(), row(scene="arm", bought_mm=0.0)])
    assert [each.scene for each in found.scenes] == ["touch", "arm"]
    assert found.cost is None
    assert found.verdict == "model it in touch"


def test_crossings_are_by_probe_mesh_and_noise_and_the_gate_loses():
    def point(choice, x, **more):
        about = {"kind": "curve", "choice": choice, "x_name": "torsion, mm", "x": x, "facets": 500}
        return row(**about, noise_times=1.0, **more)

    rows = [point(location_choices.LOCAL_TORQUE, x, bought_mm=b) for x, b in ((0.1, 0.0), (1.0, 0.1))]
    rows += [point(location_choices.GATE, x, made_sure=s) for x, s in ((0.1, 1.0), (1.0, 0.99))]
    torque, gate = crossings(rows)
    assert torque.words == "from 0.32"
    assert torque.at == "500 facets, noise one reading"
    assert gate.choice == verdicts.LOSES
    assert gate.words.startswith("from 0.1")


def test_what_a_reading_is_varied_by_is_named():
    assert verdicts.unit_of(sensor_choices.DRIFT) == "4 K"
    assert verdicts.unit_of(location_choices.GATE) == ""
