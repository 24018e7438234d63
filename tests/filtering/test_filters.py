"""Filters against their formulas, live against offline, and the suggested cut-off against recordings made up."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import signal

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter, LowPass

RATE = 200.0
NUMBERS = st.one_of(
    st.floats(-1e6, 1e6, allow_subnormal=False), st.sampled_from([np.nan, np.inf, -np.inf, 0.0, 1e-9])
)
SAMPLES = st.tuples(st.integers(1, 40), st.integers(1, 3)).flatmap(
    lambda shape: arrays(np.float64, shape, elements=NUMBERS)
)
FILTERS = {"kalman": KalmanFilter, "kalman per sample": partial(KalmanFilter, 500, q=1e-4, per_sample=True)}


def recording(seed=0, count=3000, channels=6, missing=0.0):
    rng = np.random.default_rng(seed)
    samples = rng.standard_normal((count, channels)).cumsum(axis=0) + 5
    samples[rng.random((count, channels)) < missing] = np.nan
    return samples


def step_response(kalman, times, late=5.0):
    """Answer to a step at time 0 long after the start, by linear interpolation on a common grid."""
    answer = kalman.filter((times > 0).astype(float)[:, None], times + late)[:, 0]
    return np.interp(np.linspace(0.02, 0.5, 200), times, answer)


# ---- Kalman filter: the figures --------------------------------------------------------------------


def test_the_figures_of_the_paper():
    figures = KalmanFilter().figures()
    assert figures.predicted_variance == pytest.approx((1e-6 + (1e-12 + 8e-10) ** 0.5) / 2, rel=1e-12)
    assert figures.gain == pytest.approx(0.06826, abs=1e-5)
    assert figures.delay == pytest.approx(0.0683, abs=1e-4)
    assert figures.noise_left == pytest.approx(0.188, abs=5e-4)


def test_extreme_variances_neither_overflow_nor_vanish():
    for q, r in [(1e-200, 1e200), (1e200, 1e-200), (1e300, 1e300), (1e-300, 1e-300)]:
        figures = KalmanFilter(q=q, r=r).figures()
        assert 0 < figures.gain <= 1
        assert np.isfinite([figures.delay, figures.noise_left]).all()


def test_the_variance_settles_at_the_predicted_figures():
    kalman = KalmanFilter()
    kalman.update_block(np.zeros((2000, 1)))
    assert kalman.variance[0] + 1e-6 == pytest.approx(kalman.figures().predicted_variance, rel=1e-12)


def test_white_noise_is_reduced_as_told():
    noise = np.random.default_rng(1).standard_normal((400_000, 3))
    kalman = KalmanFilter()
    left = kalman.filter(noise)[2000:].std(axis=0)
    # 400,000 samples that are correlated over some 28 make 14,000 independent ones: 0.6 % each, so 3 % is 5 sigma.
    np.testing.assert_allclose(left, kalman.figures().noise_left, rtol=0.03)


def test_a_step_is_followed_in_the_time_constant():
    times = np.arange(-400, 400) / RATE
    figures = KalmanFilter().figures()
    answer = KalmanFilter().filter((times > -1e-9).astype(float)[:, None])[:, 0]
    expected = 1 - (1 - figures.gain) ** (times[400:] * RATE + 1)
    np.testing.assert_allclose(answer[400:], expected, atol=1e-9)


def test_the_start_is_the_mean_while_the_state_is_unknown():
    # With hardly any process noise the best estimate is the mean of all samples, its variance R / n.
    samples = np.random.default_rng(2).standard_normal((50, 2))
    kalman = KalmanFilter(q=1e-15, r=1.0)
    answers = kalman.update_block(samples)
    np.testing.assert_allclose(answers, samples.cumsum(axis=0) / np.arange(1, 51)[:, None], atol=1e-10)
    np.testing.assert_allclose(kalman.variance, 1 / 50, rtol=1e-10)


# ---- Kalman filter: time ---------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [50.0, 200.0, 1000.0])
def test_every_rate_gives_the_same_physical_filter(rate):
    times = np.arange(-5 * rate, rate) / rate
    answer = KalmanFilter(rate).filter((times >= 0).astype(float)[:, None], times)[:, 0]
    slope = np.polyfit(
        times[5 * int(rate) :][: int(0.3 * rate)], np.log1p(-answer[5 * int(rate) :])[: int(0.3 * rate)], 1
    )
    assert -1 / slope[0] == pytest.approx(0.0708, abs=3e-4)


def test_per_sample_is_another_filter_at_another_rate():
    fixed = KalmanFilter(1000, per_sample=True)
    samples = recording()
    np.testing.assert_array_equal(fixed.filter(samples), KalmanFilter().filter(samples))
    assert not np.array_equal(KalmanFilter(1000).filter(samples), KalmanFilter().filter(samples))


@pytest.mark.parametrize("per_sample", [False, True])
def test_a_third_of_the_samples_missing(per_sample):
    """Lost samples slow the response by 20 %, not by the 43 % that not knowing the time costs."""
    rng = np.random.default_rng(3)
    regular = np.arange(-1000, 200) / RATE
    kalman = KalmanFilter(per_sample=per_sample)
    responses = [step_response(kalman, regular[rng.random(1200) > 0.3]) for _ in range(100)]
    grid = np.linspace(0.02, 0.5, 200)
    rises = 1 - np.exp(-grid[:, None] / (0.0707 * np.array([1, 0.7**-0.5, 1 / 0.7])))
    misses = abs(np.mean(responses, axis=0)[:, None] - rises).max(axis=0)
    assert misses.argmin() == (2 if per_sample else 1)
    assert misses.min() < 0.03
    assert (misses[0] < 0.09) != per_sample


@pytest.mark.parametrize(("rate", "missing"), [(50.0, 0.3), (200.0, 0.0), (1000.0, 0.3)])
def test_the_variance_is_true(rate, missing):
    """On a random walk seen through white noise, the squared error over the variance told is 1 on average."""
    rng = np.random.default_rng(4)
    kalman = KalmanFilter(rate, q=4e-5)
    figures = kalman.figures()
    truth = rng.normal(0, figures.q**0.5, (600, 500)).cumsum(axis=0)
    seen = truth + rng.normal(0, figures.r**0.5, truth.shape)
    seen[rng.random(600) < missing] = np.nan
    kalman.update_block(seen)
    ratio = (kalman.state - truth[-1]) ** 2 / kalman.variance
    assert ratio.mean() == pytest.approx(1, abs=5 * (2 / 500) ** 0.5)


def test_a_missing_sample_is_a_longer_step():
    samples = recording(missing=0.0)
    lost = np.random.default_rng(5).random(len(samples)) < 0.3
    lost[0] = False
    times = np.arange(len(samples)) / RATE
    kept = KalmanFilter().filter(samples[~lost], times[~lost])
    holed = np.where(lost[:, None], np.nan, samples)
    np.testing.assert_allclose(KalmanFilter().filter(holed)[~lost], kept, rtol=1e-10)


def test_after_a_gap_the_next_sample_weighs_more():
    kalman = KalmanFilter()
    kalman.update_block(np.zeros((500, 1)))
    before = kalman.variance[0]
    kalman.update_block(np.full((200, 1), np.nan))
    assert kalman.variance[0] == pytest.approx(before + 200e-6, rel=1e-12)
    expected = (before + 201e-6) / (before + 201e-6 + 2e-4)
    assert kalman.update([1.0])[0] == pytest.approx(expected, rel=1e-12)


# ---- Kalman filter that follows changes ------------------------------------------------------------

SIGMA = np.array([0.05] * 3 + [0.002] * 3)


@pytest.mark.parametrize("rate", [100.0, 200.0, 1000.0])
@pytest.mark.parametrize(("noise", "hertz"), [(1, 0), (2, 0), (3, 0), (1, 5), (1, 12), (1, 35)])
def test_at_rest_it_is_as_quiet_as_the_fixed_one(rate, noise, hertz):
    """Also where noise is larger than declared, or the bench vibrates by 6 sigma."""
    rng = np.random.default_rng(9)
    times = np.arange(round(15 * rate)) / rate
    samples = 5 + noise * rng.normal(0, SIGMA, (len(times), 6))
    samples += 6 * SIGMA * np.sin(2 * np.pi * hertz * times)[:, None]
    after = times > 1
    following, fixed = (
        each.filter(samples)[after].std(axis=0)
        for each in (KalmanFilter(rate, sigma=SIGMA), KalmanFilter(rate))
    )
    assert np.sqrt(np.mean((following / fixed) ** 2)) <= 1.1
    if (noise, hertz) == (1, 0):
        np.testing.assert_array_equal(following, fixed)


@pytest.mark.parametrize("rate", [100.0, 200.0, 1000.0])
def test_it_follows_a_step_from_the_second_sample_on_and_a_slow_change_closely(rate):
    rng = np.random.default_rng(10)
    times = np.arange(round(4 * rate)) / rate
    truth = np.where(times < 1, 0, 4.0) + 2 * np.clip(times - 2, 0, 1)  # 2 N/s, and as many N·m/s
    samples = truth[:, None] + rng.normal(0, SIGMA, (len(times), 6))
    error = abs(KalmanFilter(rate, sigma=SIGMA).filter(samples) - truth[:, None]) / SIGMA
    step = round(rate)
    assert error[step].min() > 10
    assert error[step + 1 : 2 * step].max() < 5
    slow = KalmanFilter(rate).filter(samples) - truth[:, None]
    assert error[2 * step :].max() < 0.2 * abs(slow / SIGMA)[2 * step :].max()


def test_what_follows_changes_holds_over_lost_rows_and_starts_from_a_state():
    live = KalmanFilter(sigma=SIGMA)
    live.reset(np.full(6, 3.0))
    answers = live.update_block([[3.0] * 6, [np.nan] + [3.0] * 5, [3.0] * 6])
    np.testing.assert_allclose(answers, 3.0, rtol=1e-14)
    assert (live.variance < 2e-4).all()
    with pytest.raises(InputError, match=r"KalmanFilter\.sigma"):
        KalmanFilter(sigma=[0.05, 0, 1, 1, 1, 1])


# ---- both filters ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("missing", [0.0, 0.3])
def test_live_and_offline_agree_to_the_last_bit(name, missing):
    samples = recording(missing=missing)
    offline = FILTERS[name]().filter(samples)
    live = FILTERS[name]()
    np.testing.assert_array_equal([live.update(sample) for sample in samples], offline)
    blocks = FILTERS[name]()
    parts = [blocks.update_block(part) for part in np.split(samples, [1, 2, 700, 700, 2999])]
    np.testing.assert_array_equal(np.vstack(parts), offline)
    np.testing.assert_array_equal(live.filter(samples), offline)  # the live state does not matter ...
    np.testing.assert_array_equal(live.update(samples[0]), blocks.update(samples[0]))  # ... nor is it changed


def test_live_and_offline_agree_with_irregular_times():
    samples = recording(6, count=3000, channels=2, missing=0.01)
    times = np.random.default_rng(7).uniform(0.001, 0.02, len(samples)).cumsum()
    live = KalmanFilter()
    steps = np.diff(times, prepend=times[0] - 1)
    answers = [live.update(sample, dt) for sample, dt in zip(samples, steps, strict=True)]
    np.testing.assert_array_equal(KalmanFilter().filter(samples, times), answers)


@settings(deadline=None)
@given(samples=SAMPLES)
@pytest.mark.parametrize("name", FILTERS)
def test_any_samples_are_filtered_alike_live_and_offline_and_channel_by_channel(name, samples):
    offline = FILTERS[name]().filter(samples)
    live = FILTERS[name]()
    np.testing.assert_array_equal([live.update(sample) for sample in samples], offline)
    alone = [FILTERS[name]().filter(samples[:, [c]])[:, 0] for c in range(samples.shape[1])]
    np.testing.assert_array_equal(np.column_stack(alone), offline)
    started = np.isfinite(samples).cumsum(axis=0) > 0
    np.testing.assert_array_equal(np.isfinite(offline), started)


@settings(deadline=None)
@given(samples=SAMPLES)
def test_the_kalman_answer_stays_between_the_samples_seen(samples):
    for answer, channel in zip(KalmanFilter().filter(samples).T, samples.T, strict=True):
        for i in np.flatnonzero(np.isfinite(answer)):
            seen = channel[: i + 1][np.isfinite(channel[: i + 1])]
            slack = 1e-13 * abs(seen).max()
            assert seen.min() - slack <= answer[i] <= seen.max() + slack


@pytest.mark.parametrize("name", FILTERS)
def test_a_run_of_nan_is_held_and_does_not_poison(name):
    samples = recording(8, count=500)
    samples[200:260, :3] = [[np.nan, np.inf, -np.inf]]
    answers = FILTERS[name]().filter(samples)
    assert np.isfinite(answers).all()
    np.testing.assert_array_equal(answers[200:260, :3], np.broadcast_to(answers[199, :3], (60, 3)))
    np.testing.assert_array_equal(answers[:, 3:], FILTERS[name]().filter(samples[:, 3:]))


@pytest.mark.parametrize("name", FILTERS)
def test_there_is_no_transient_from_zero(name):
    answers = FILTERS[name]().filter(np.full((300, 2), [7.0, -1e5]))
    np.testing.assert_allclose(answers, np.full((300, 2), [7.0, -1e5]), rtol=1e-12)


@pytest.mark.parametrize("name", FILTERS)
def test_reset_forgets_and_channels_may_not_change(name):
    live = FILTERS[name]()
    live.update([1.0, 2.0])
    with pytest.raises(InputError, match=r"3 channels after 2; call reset\(\)"):
        live.update([1.0, 2.0, 3.0])
    live.reset()
    np.testing.assert_allclose(live.update([1.0, 2.0, 3.0]), [1, 2, 3], rtol=1e-14)
    with pytest.raises(InputError, match="one sample is a row"):
        live.update(5.0)
    with pytest.raises(InputError, match=r"samples\[:, None\]"):
        live.filter(np.zeros(5))
    assert live.filter(np.zeros((0, 3))).shape == (0, 3)


def test_reset_to_a_state():
    kalman = KalmanFilter()
    assert kalman.state is None
    kalman.reset([3.0, 4.0])
    np.testing.assert_array_equal(kalman.state, [3, 4])
    np.testing.assert_array_equal(kalman.variance, [2e-4, 2e-4])
    np.testing.assert_allclose(kalman.update([4.0, np.nan]), [3 + 2.01 / 4.01, 4], rtol=1e-12)
    with pytest.raises(InputError, match="state must be finite"):
        kalman.reset([np.nan, 0.0])
    kalman.reset()
    kalman.update([np.nan, 1.0])
    np.testing.assert_array_equal(kalman.state, [np.nan, 1])
    np.testing.assert_array_equal(kalman.variance, [np.inf, 2e-4])


@pytest.mark.parametrize(
    ("times", "what"),
    [
        ([0, 1, 1, 2], r"times\[2\] is 1\.0 s after 1\.0 s"),
        ([0, 1, 0.5, 2], r"times\[2\] is 0\.5 s after 1\.0 s"),
        ([np.nan, 1, 2, 3], r"times\[0\] is nan s:"),
        ([0, 1, 2, np.inf], r"times\[3\] is inf s after 2\.0 s"),
    ],
)
def test_times_must_increase(times, what):
    with pytest.raises(InputError, match=what):
        KalmanFilter().filter(np.zeros((4, 2)), times)


def test_wrong_numbers_are_refused():
    for keyword in ("rate", "q", "r", "tuned_rate"):
        for value in (0, -1, np.nan, np.inf):
            with pytest.raises(InputError, match=rf"KalmanFilter\.{keyword}"):
                KalmanFilter(**{keyword: value})
    for dt in (0.0, -0.1, np.nan, np.inf):
        with pytest.raises(InputError, match="every dt"):
            KalmanFilter().update([1.0], dt)
    with pytest.raises(InputError, match=r"dt has shape \(2,\)"):
        KalmanFilter().update_block(np.zeros((3, 1)), [0.1, 0.1])
    with pytest.raises(InputError, match="one per sample, 3"):
        KalmanFilter().filter(np.zeros((3, 1)), [0.0, 1.0])
    for cutoff in (0.0, -1.0, 100.0, 250.0, np.nan):
        with pytest.raises(InputError, match="half the rate, 100 Hz"):
            LowPass(cutoff, 200)
    with pytest.raises(InputError, match=r"LowPass\.rate"):
        LowPass(1, -200)
    for order in (0, 1.5):
        with pytest.raises(InputError, match=r"LowPass\.order"):
            LowPass(1, 200, order)


# ---- low-pass --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("cutoff", "order"), [(10, 1), (10, 2), (10, 5), (90, 1), (90, 2), (90, 5)])
def test_delay_of_the_low_pass(cutoff, order):
    _, delay = signal.group_delay(signal.butter(order, cutoff, fs=RATE), w=[1e-3 * cutoff], fs=RATE)
    assert LowPass(cutoff, RATE, order).delay == pytest.approx(delay[0] / RATE, rel=1e-3)


def test_a_ramp_is_followed_by_the_delay():
    ramp, low = np.arange(4000)[:, None] / RATE, KalmanFilter(RATE)
    assert (ramp - low.filter(ramp))[-1, 0] == pytest.approx(low.figures().delay, rel=1e-6)
