"""Rows and duels: errors paired with ours, and who counts as faster and more accurate."""

import numpy as np
import pytest

from contactbench.pipeline.study.rivals.rows import (
    BATCH,
    FAMILY,
    OURS,
    RAY,
    SURE,
    WRENCH,
    Contender,
    duels,
    erred,
    known,
    missing,
    timed,
)

MM = 1e-3


def test_errors_are_paired_where_both_answer():
    error, ours = MM * np.array([2.0, np.nan, 4.0]), MM * np.array([1.0, 1.0, 2.0])
    row = erred("a", "x", "s", "c", error, ours)
    assert row["answered"] == pytest.approx(2 / 3)
    assert (row["mean_mm"], row["max_mm"]) == pytest.approx((3.0, 4.0))
    assert (row["worse_mm"], row["common_mm"], row["ours_common_mm"]) == pytest.approx((1.5, 3.0, 1.5))
    assert row["worse_se_mm"] == pytest.approx(0.5)


def test_nothing_answered_is_no_error_of_0():
    row = erred("a", "x", "s", "c", np.array([np.nan]), np.array([MM]))
    assert row["answered"] == 0
    assert np.isnan(row["mean_mm"])


def test_times_are_medians_of_rounds_with_their_spread():
    row = timed("a", "x", "s", "m", [1.0, 2.0, 30.0])
    assert (row["median_us"], row["rounds"]) == (2.0, 3)
    assert row["low_us"] < 2.0 < row["high_us"]


def test_versions_and_what_is_missing_are_said():
    here, away = Contender("NumPy", "numpy"), Contender("that", "no-such-package-anywhere")
    assert known("a", here)["version"] == np.__version__
    assert missing("a", away, ImportError("x"))["note"] == "not installed: pip install contactbench[rivals]"
    assert "libfoo" in missing("a", here, ImportError("libfoo.so: no such file"))["note"]


def rows_of(theirs, ours, us, mode=WRENCH, contender="x"):
    noise = np.random.default_rng(0).normal(0, 1e-3, 200)
    theirs, ours = MM * (theirs + noise), MM * (ours + noise)
    made = [erred(FAMILY, each, "linear", "filtered", error, ours, facets=500)
            for each, error in ((OURS, ours), (contender, theirs))]  # fmt: skip
    made += [timed(FAMILY, OURS, "linear", WRENCH, [1.0], facets=500)]
    return [*made, timed(FAMILY, contender, "linear", mode, [us], facets=500)]


@pytest.mark.parametrize(
    ("theirs", "us", "mode", "faster", "better"),
    [
        (0.5, 0.5, WRENCH, True, True),
        (0.5, 2.0, WRENCH, False, True),
        (2.0, 0.5, WRENCH, True, False),
        (0.99, 0.99, WRENCH, False, False),
        (0.5, 0.5, RAY, True, True),
        (0.5, 0.5, BATCH, False, True),
    ],
    ids=[
        "both",
        "slower",
        "worse",
        "by less than 2 %",
        "a ray alone counts",
        "a batch has none to compare with",
    ],
)
def test_who_beats_whom(theirs, us, mode, faster, better):
    [duel] = duels(rows_of(theirs, 1.0, us, mode))
    assert (duel.faster, duel.better, duel.beats) == (faster, better, faster and better)
    assert "linear, 500 facets" in duel.words


def test_who_answers_less_is_not_more_accurate():
    rows = rows_of(0.5, 1.0, 0.5)
    rows[1]["answered"] = 0.9
    [duel] = duels(rows)
    assert not duel.better


def test_rounding_is_no_accuracy():
    rows = rows_of(1.0, 1.0, 0.5)
    rows[1] |= {"worse_mm": -1e-12, "worse_se_mm": 1e-14, "common_mm": 1e-13, "ours_common_mm": 1e-12}
    [duel] = duels(rows)
    assert not duel.better


def test_our_own_subsets_are_no_rivals():
    assert duels(rows_of(0.5, 1.0, 0.5, contender=SURE)) == []
