"""Filtering contacts: the noise that was predicted, the lag of theory, and the same bytes twice."""

import json
from pathlib import Path

import numpy as np
import pytest
from benchmarks.reproduce import filter as filtering
from benchmarks.reproduce.filter import FilterResult, report_of


@pytest.fixture(scope="module")
def result() -> FilterResult:
    return filtering.measure("t-shape", seconds=6.0, seed=2)


def test_the_floor_of_the_spectrum_is_the_noise_predicted(result: FilterResult) -> None:
    assert report_of(result).passed
    low = result.spectra["no noise"].density[-10:]
    assert (low < 0.05 * result.spectra["located"].density[-10:]).all()


def test_filters_take_noise_and_lag_as_theory_says(result: FilterResult) -> None:
    by_name = {one.name: one for one in result.filtered}
    raw, low = by_name["none"], by_name["low-pass 10 Hz"]
    assert low.noise < 0.6 * raw.noise
    for one in result.filtered:
        assert one.lag == pytest.approx(one.predicted_lag, abs=0.012)
    kalman = by_name["Kalman filter of wrenches"]
    assert kalman.lag > 2 * low.lag


def test_the_first_figures_hold_lag_and_noise_together(result: FilterResult) -> None:
    figures = {one.name: one for one in report_of(result).figures}
    raw, low, kalman = result.filtered[:3]
    assert report_of(result).figures[0].measured == raw.rms
    assert figures["after over before, lag included"].measured == low.rms / raw.rms
    assert figures["after over before, lag included, Kalman filter"].measured == kalman.rms / raw.rms
    # Lag is harm: what is left with it is more than what is left without.
    assert low.rms > low.noise
    assert figures["after over before, lag taken out"].measured < low.rms / raw.rms


def test_few_samples_in_doubt_do_not_stop_the_spectrum() -> None:
    points = np.column_stack([np.arange(100.0), -np.arange(100.0)])
    some = points.copy()
    some[[10, 50]] = np.nan
    np.testing.assert_allclose(filtering._bridged(some), points)
    some[60:70] = np.nan
    assert np.isnan(filtering._bridged(some)[[10, 50]]).all()


def test_without_noise_the_centre_of_the_tissue_is_found(result: FilterResult) -> None:
    off = np.linalg.norm(result.slide.quiet_mm - result.slide.true_mm, axis=1)
    assert np.nanmedian(off) < 1.0


def test_the_command_writes_and_prints(
    result: FilterResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, benchmark
) -> None:
    monkeypatch.setattr(filtering, "measure", lambda *_args, **_options: result)
    done = benchmark("reproduce-filter", "--write", tmp_path, "--json")
    assert done.exit_code == 0
    assert json.loads(done.stdout)["passed"]
    assert {f.name for f in tmp_path.iterdir()} == {"report.md", "filters.csv", "spectrum.csv"}
