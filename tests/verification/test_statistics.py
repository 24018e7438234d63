import numpy as np
import pytest

from contactbench.pipeline.verification.statistics import intervals, summarise, summarise_by

ERRORS = np.array([[1.0, 0, 0], [1.0, 2.0, 0], [1.0, -2.0, 0]]) / 1e3


def test_bias_and_scatter_are_told_apart():
    found = summarise("all", ERRORS)
    assert found.bias_mm == pytest.approx((1.0, 0.0, 0.0))
    assert found.scatter_mm == pytest.approx(2.0)  # (4 + 4) / (3 - 1)
    assert found.mean_mm == pytest.approx((1 + 2 * np.sqrt(5)) / 3)
    assert found.max_mm == pytest.approx(np.sqrt(5))
    assert found.rms_mm == pytest.approx(np.sqrt(11 / 3))


def test_one_touch_has_no_spread():
    found = summarise("one", ERRORS[:1])
    assert (found.sd_mm, found.scatter_mm, found.mean_mm) == (None, None, pytest.approx(1.0))


def test_groups_keep_the_order_of_the_names_and_leave_out_empty_ones():
    groups = summarise_by(["b", "a", "b"], ["a", "b", "c"], ERRORS)
    assert [(group.name, group.touches) for group in groups] == [("a", 1), ("b", 2)]


def test_intervals_hold_the_figures_and_are_repeatable():
    errors = np.random.default_rng(1).normal(2e-4, 5e-4, (40, 3))
    found = intervals(errors, seed=3)
    assert found == intervals(errors, seed=3)
    assert found != intervals(errors, seed=4)
    told = summarise("all", errors)
    assert found.mean_mm[0] < told.mean_mm < found.mean_mm[1]
    assert found.scatter_mm[0] < told.scatter_mm < found.scatter_mm[1]
    for value, (low, high) in zip(told.bias_mm, found.bias_mm, strict=True):
        assert low < value < high


def test_more_touches_narrow_the_intervals():
    rng = np.random.default_rng(1)
    few, many = (intervals(rng.normal(0, 5e-4, (n, 3))) for n in (20, 500))
    assert np.ptp(many.scatter_mm) < 0.5 * np.ptp(few.scatter_mm)


def test_touches_that_are_all_alike_give_finite_intervals():
    found = intervals(np.tile(ERRORS[1], (5, 1)))
    assert np.isfinite([*found.mean_mm, *found.scatter_mm, *np.ravel(found.bias_mm)]).all()


def test_touches_of_one_marker_do_not_count_as_many():
    rng = np.random.default_rng(2)
    markers = np.repeat(np.arange(17), 5)
    errors = rng.normal(0, 5e-4, (17, 3))[markers] + rng.normal(0, 1e-4, (85, 3))
    alone, together = intervals(errors), intervals(errors, groups=markers)
    assert together == intervals(errors, groups=[f"m{each}" for each in markers])
    for few, many in zip(alone.bias_mm, together.bias_mm, strict=True):
        assert np.ptp(many) > 1.6 * np.ptp(few)


def test_one_touch_of_each_marker_is_as_if_there_were_no_markers():
    errors = np.random.default_rng(2).normal(0, 5e-4, (20, 3))
    assert intervals(errors, groups=np.arange(20)) == intervals(errors)


def test_fewer_than_five_markers_have_no_interval():
    errors = np.random.default_rng(2).normal(0, 5e-4, (20, 3))
    assert intervals(errors, groups=np.arange(20) % 4) is None
    assert intervals(errors, groups=np.arange(20) % 5) is not None
    assert intervals(errors[:4]) is None


def test_the_interval_of_the_bias_holds_all_three_at_once():
    """Of 400 normal errors: 2.39 standard errors to each side, where 1.96 would hold each component alone."""
    errors = np.random.default_rng(4).normal(0.0, [2e-4, 5e-4, 9e-4], (400, 3))
    sides = 0.5 * np.ptp(intervals(errors).bias_mm, axis=1) / (1e3 * errors.std(axis=0) / np.sqrt(400))
    assert sides == pytest.approx([2.39] * 3, abs=0.12)
