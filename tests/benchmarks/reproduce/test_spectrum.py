"""Spectra and the cut-off they suggest."""

import numpy as np
import pytest
from benchmarks.reproduce.spectrum import spectrum, suggest_cutoff
from scipy import signal

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import LowPass

RATE = 200.0


def motion(rng, seconds, band=10.0, rate=RATE, size=5e-3, channels=3):
    """Contact locations, m, that move with all frequencies up to `band`, Hz."""
    count = int(seconds * rate)
    waves = np.fft.rfft(rng.standard_normal((count, channels)), axis=0)
    waves[np.fft.rfftfreq(count, 1 / rate) > band] = 0
    path = np.fft.irfft(waves, count, axis=0)
    return size * path / path.std(axis=0)


def hum(seconds, amplitude, hz=50.02):
    return amplitude * np.sin(2 * np.pi * hz * np.arange(int(seconds * RATE)) / RATE)[:, None]


def test_the_spectrum_is_welchs():
    samples = 5 + np.random.default_rng(9).standard_normal((8000, 6)).cumsum(axis=0)
    found = spectrum(samples, RATE)
    frequencies, density = signal.welch(samples, RATE, nperseg=400, axis=0)
    np.testing.assert_allclose(found.frequencies, frequencies)
    np.testing.assert_allclose(found.density, density, rtol=1e-9)
    assert found.resolution == 1.0
    assert found.segments == 39


def test_degrees_of_freedom_are_those_of_white_noise():
    noise = np.random.default_rng(10).standard_normal((4000, 200))
    found = spectrum(noise, RATE)
    inner = found.density[2:-2]
    assert inner.mean() == pytest.approx(2 / RATE, rel=0.01)
    assert 2 * (inner.mean() / inner.std()) ** 2 == pytest.approx(found.degrees_of_freedom, rel=0.03)


def test_segments_with_missing_samples_are_left_out():
    samples = np.random.default_rng(11).standard_normal((8000, 2))
    whole = spectrum(samples[4000:], RATE)
    samples[:4000:350] = np.nan
    found = spectrum(samples, RATE)
    assert found.segments == whole.segments
    np.testing.assert_allclose(found.density, whole.density)


def test_too_short_recordings_are_refused_with_the_seconds_needed():
    assert spectrum(np.zeros((450, 1)), RATE).segments == 8
    with pytest.raises(InputError, match=r"2\.25 s or more at 200 Hz"):
        spectrum(np.zeros((449, 1)), RATE)
    with pytest.raises(InputError, match=r"14\.4 s or more at 20 Hz"):
        suggest_cutoff(np.zeros((100, 1)), 20)
    holed = np.zeros((4000, 2))
    holed[::200, 1] = np.nan
    with pytest.raises(InputError, match="only 0 stretches of 2 s have no missing sample"):
        spectrum(holed, RATE)
    with pytest.raises(InputError, match="spectrum: rate"):
        spectrum(holed, 0)


@pytest.mark.parametrize(
    ("seconds", "sigma", "lowest", "highest"),
    [(3, 5e-4, 10, 14), (10, 5e-5, 11, 13), (10, 5e-4, 10, 11.5), (60, 5e-4, 10.5, 11.5), (60, 1e-2, 9, 11)],
)
@pytest.mark.parametrize("told", [True, False])
def test_the_band_of_a_motion_is_found(seconds, sigma, lowest, highest, told):
    for seed in range(50):
        rng = np.random.default_rng(seed)
        path = motion(rng, seconds)
        seen = path + sigma * rng.standard_normal(path.shape)
        found = suggest_cutoff(seen, RATE, [sigma] * 3 if told else None)
        assert found.has_signal
        assert lowest <= found.cutoff_hz <= highest
        assert found.lines_hz == ()
        np.testing.assert_allclose(found.noise_sigma, sigma, rtol=1e-12 if told else 0.16)
    low_pass = LowPass(found.cutoff_hz, RATE)
    assert f"lags by {1e3 * low_pass.delay:.3g} ms" in found.explanation
    assert f"Above {found.cutoff_hz:.3g} Hz the spectrum cannot be told from noise." in found.explanation
    assert ("estimated" in found.explanation) != told


@pytest.mark.parametrize("told", [True, False])
def test_noise_alone_is_not_taken_for_signal(told):
    alarms = 0
    for seed in range(300):
        noise = np.random.default_rng(seed).standard_normal((1000, 6))
        found = suggest_cutoff(noise, RATE, 1.0 if told else None)
        alarms += found.has_signal
    assert alarms <= 4  # of 300, at a risk of 1 in 1000 each
    assert found.cutoff_hz == spectrum(noise, RATE).resolution
    assert "Nothing stands out of the noise" in found.explanation


def test_signal_up_to_nyquist_needs_no_filter():
    rng = np.random.default_rng(12)
    found = suggest_cutoff(rng.standard_normal((4000, 2)), RATE, [0.1, 2.0])
    assert found.cutoff_hz is None
    assert "no filter is suggested" in found.explanation
    assert "9.6 times that of the noise given" in found.explanation


def test_pure_motion_without_noise():
    path = motion(np.random.default_rng(13), 30)
    assert 10 < suggest_cutoff(path, RATE, 1e-6).cutoff_hz < 25
    found = suggest_cutoff(path, RATE)
    assert found.cutoff_hz > 10
    assert "the spectrum still falls there" in found.explanation
    still = suggest_cutoff(np.full((2000, 2), 0.1234), RATE)
    assert not still.has_signal


@pytest.mark.parametrize("told", [True, False])
@pytest.mark.parametrize("amplitude", [5e-5, 1e-3, 0.1])
def test_mains_hum_does_not_drive_the_cutoff(amplitude, told):
    for seed in range(10):
        rng = np.random.default_rng(seed)
        path = motion(rng, 60) + 1e-4 * rng.standard_normal((12_000, 3))
        plain = suggest_cutoff(path, RATE, 1e-4 if told else None)
        found = suggest_cutoff(path + hum(60, amplitude) * [[1, 0.3, 0]], RATE, 1e-4 if told else None)
        assert found.lines_hz == (50,)
        assert found.cutoff_hz == pytest.approx(plain.cutoff_hz, abs=0.5)
        assert "Mains hum is not counted: 50 Hz" in found.explanation


def test_only_isolated_lines_of_the_mains_are_hum():
    rng = np.random.default_rng(14)
    noise = 1e-4 * rng.standard_normal((12_000, 1))
    assert suggest_cutoff(noise + hum(60, 1e-3, 37), RATE, 1e-4).cutoff_hz == 38  # a bin off, and one above
    many = noise + hum(60, 1e-3, 60) + hum(60, 1e-3, 120) + hum(60, 1e-3, 50)
    assert suggest_cutoff(many, RATE, 1e-4).lines_hz == (50, 60, 80)  # 120 Hz is mirrored at 100 Hz
    fast = suggest_cutoff(motion(rng, 60, band=60, channels=1) + noise + hum(60, 1e-3), RATE, 1e-4)
    assert fast.lines_hz == ()
    assert 60 < fast.cutoff_hz < 65


@pytest.mark.parametrize("step", [2e-4, 1e-3])
def test_quantised_recordings(step):
    for seed in range(20):
        rng = np.random.default_rng(seed)
        path = motion(rng, 30) + 2e-4 * rng.standard_normal((6000, 3))
        rounded = step * np.round(path / step)
        for sigma in (None, (4e-8 + step**2 / 12) ** 0.5):
            assert 10 < suggest_cutoff(rounded, RATE, sigma).cutoff_hz < 12


def test_wrong_noise_is_refused_or_doubted():
    noise = np.random.default_rng(15).standard_normal((2000, 2))
    for wrong in (0.0, -1.0, np.nan, [1.0, np.inf]):
        with pytest.raises(InputError, match="must be positive and finite"):
            suggest_cutoff(noise, RATE, wrong)
    with pytest.raises(InputError, match="one number or 2, one per channel"):
        suggest_cutoff(noise, RATE, [1.0, 1.0, 1.0])
    for sigma, doubted in [(0.6, True), (0.85, False), (1.2, False), (1.6, True)]:
        assert ("is noise_sigma right?" in suggest_cutoff(noise, RATE, sigma).explanation) == doubted
    # However long the recording, noise told a little too small must not make everything a signal.
    long = np.random.default_rng(16).standard_normal((240_000, 1))
    assert not suggest_cutoff(long, RATE, 0.9).has_signal
