"""Gains: the highest that leave the wanted margins, and a file that bundle export takes."""

import json
import math

import numpy as np
import pytest

from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.config.runtime.settings_file import with_file
from contactbench.pipeline.control.gains import WantedMargins, rows_of, settings_content, spread_of, tune
from contactbench.pipeline.control.margins import AXES, loop_of, margins
from contactbench.pipeline.control.settings import USUAL_MODULUS, Variant, settings_of
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.gain_trials import foundation_of, run


@pytest.mark.parametrize("variant", list(Variant))
@pytest.mark.parametrize("probe", ["linear", "t-shape"])
def test_margins_are_kept_on_all_tissue(probe, variant):
    foundation = foundation_of(probe)
    tuned = tune(foundation, USUAL_MODULUS, variant=variant)
    for modulus in spread_of(USUAL_MODULUS, 5.0):
        for axis in AXES:
            assert tuned.wanted.kept(margins(loop_of(tuned.settings, foundation, modulus, axis))), (
                modulus,
                axis,
            )


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
