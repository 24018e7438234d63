"""Spectra and the cut-off they suggest."""

import numpy as np
import pytest
from benchmarks.reproduce.spectrum import spectrum, suggest_cutoff
from scipy import signal

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import LowPass

RATE = 200.0


def motion(rng, seconds, band=10.0, size=5e-3, channels=3):
    """Contact locations, m, that move with all frequencies up to `band`, Hz."""
    count = int(seconds * RATE)
    waves = np.fft.rfft(rng.standard_normal((count, channels)), axis=0)
    waves[np.fft.rfftfreq(count, 1 / RATE) > band] = 0
    path = np.fft.irfft(waves, count, axis=0)
    return size * path / path.std(axis=0)


def test_the_spectrum_is_welchs_and_its_degrees_of_freedom_those_of_white_noise():
    noise = np.random.default_rng(10).standard_normal((8000, 200))
    found = spectrum(noise, RATE)
    frequencies, density = signal.welch(noise, RATE, nperseg=400, axis=0)
    np.testing.assert_allclose(found.frequencies, frequencies)
    np.testing.assert_allclose(found.density, density, rtol=1e-9)
    assert (found.resolution, found.segments) == (1.0, 39)
    inner = found.density[2:-2]
    assert inner.mean() == pytest.approx(2 / RATE, rel=0.01)
    assert 2 * (inner.mean() / inner.std()) ** 2 == pytest.approx(found.degrees_of_freedom, rel=0.03)


def test_segments_with_missing_samples_are_left_out_and_too_few_are_refused():
    samples = np.random.default_rng(11).standard_normal((8000, 2))
    whole = spectrum(samples[4000:], RATE)
    samples[:4000:350] = np.nan
    found = spectrum(samples, RATE)
    assert found.segments == whole.segments
    np.testing.assert_allclose(found.density, whole.density)
    samples[::200, 1] = np.nan
    with pytest.raises(InputError, match="only 0 stretches of 2 s have no missing sample"):
        spectrum(samples, RATE)


@pytest.mark.parametrize(
    ("seconds", "sigma", "lowest", "highest"),
    [
        (6, 5e-4, 10, 12.5),
        (10, 5e-5, 11, 13),
        (10, 5e-4, 10, 11.5),
        (60, 5e-4, 10.5, 11.5),
        (60, 1e-2, 9, 11),
    ],
)
def test_the_band_of_a_motion_is_found(seconds, sigma, lowest, highest):
    for seed in range(50):
        rng = np.random.default_rng(seed)
        path = motion(rng, seconds)
        found = suggest_cutoff(path + sigma * rng.standard_normal(path.shape), RATE, np.full(3, sigma))
        assert lowest <= found.cutoff_hz <= highest
    assert f"lags by {1e3 * LowPass(found.cutoff_hz, RATE).delay:.3g} ms" in found.explanation
    assert f"Above {found.cutoff_hz:.3g} Hz the spectrum cannot be told from noise." in found.explanation


def test_noise_alone_is_not_taken_for_signal():
    alarms = 0
    for seed in range(300):
        noise = np.random.default_rng(seed).standard_normal((1200, 6))
        found = suggest_cutoff(noise, RATE, np.ones(6))
        alarms += "Nothing stands out of the noise" not in found.explanation
    assert alarms <= 4  # of 300, at a risk of 1 in 1000 each
    assert found.cutoff_hz == spectrum(noise, RATE).resolution


def test_signal_up_to_nyquist_needs_no_filter_and_wrong_noise_is_doubted():
    noise = np.random.default_rng(12).standard_normal((4000, 2))
    found = suggest_cutoff(noise, RATE, np.array([0.1, 2.0]))
    assert found.cutoff_hz is None
    assert "no filter is suggested" in found.explanation
    for sigma, doubted in [(0.6, True), (0.85, False), (1.2, False), (1.6, True)]:
        assert (
            "is noise_sigma right?" in suggest_cutoff(noise, RATE, np.full(2, sigma)).explanation
        ) is doubted
    # However long the recording, noise told a little too small must not make everything a signal.
    long = np.random.default_rng(16).standard_normal((240_000, 1))
    assert "Nothing stands out" in suggest_cutoff(long, RATE, np.array([0.9])).explanation
