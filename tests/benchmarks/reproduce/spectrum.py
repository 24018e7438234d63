"""Spectra of recordings, and the cut-off frequency that they suggest."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.signal import welch
from scipy.stats import chi2

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering.lowpass import LowPass
from contactbench.pipeline.filtering.rows import Floats

_SEGMENT_S = (
    2.0  # lines 1 Hz apart are told apart: enough for hands and robots, and a minute gives 59 of them
)
_FEWEST_SEGMENTS = 8
_RISK = 1e-3  # of noise alone being taken for signal anywhere in the recording
_LEAST_RATIO = 1.5  # no prediction of noise is better than a fifth of its standard deviation
_NO_ROOM = 0.9  # of the Nyquist frequency: a filter above would remove next to nothing


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power spectral density by Welch's method: the mean over half-overlapping Hann windows."""

    frequencies: Floats  # Hz, from 0 to half the rate
    density: Floats  # One-sided density of each channel, unit²/Hz: it integrates to the variance
    segments: int  # How many segments were averaged

    @property
    def resolution(self) -> float:
        """Hz: lines nearer to each other than this merge, and slower motion is not seen."""
        return float(2 * self.frequencies[1])

    @property
    def degrees_of_freedom(self) -> float:
        """Of the chi-square distribution of a density: 2 a segment, less what the overlap has in common.

        The squared correlation of neighbours is (1/6)² for half-overlapping Hann windows (Welch 1967).
        """
        return 2 * self.segments / (1 + 2 * (1 - 1 / self.segments) / 36)


@dataclass(frozen=True)
class CutoffSuggestion:
    """A cut-off frequency for a low-pass of order 2, and why."""

    # Above it the spectrum of no channel can be told from noise, Hz; None: filter nothing
    cutoff_hz: float | None
    explanation: str  # In plain sentences


def spectrum(samples: Floats, rate: float) -> Spectrum:
    """Return the power spectral density of a recording (n, c) of at least 6 s, in any unit; NaN: missing.

    Segments last 2 s, less in recordings under 9 s, so that there are 8 of them. Those with a missing sample are
    left out: to bridge a gap would take power from high frequencies. InputError: too few are whole.
    """
    reach = (_FEWEST_SEGMENTS + 1) / 2  # lengths of a segment that so many half-overlapping ones cover
    length = min(round(_SEGMENT_S * rate), int(len(samples) / reach)) // 2 * 2
    segments = sliding_window_view(samples, length, axis=0)[:: length // 2]
    whole = segments[np.isfinite(segments).all(axis=(1, 2))]
    if len(whole) < _FEWEST_SEGMENTS:
        raise InputError(
            f"spectrum: only {len(whole)} stretches of {length / rate:.3g} s have no missing sample, and"
            f" {_FEWEST_SEGMENTS} are needed; record {reach * length / rate:.3g} s without gaps"
        )
    frequencies, density = welch(whole, rate, nperseg=length)
    return Spectrum(frequencies, density.mean(axis=0).T, len(whole))


def suggest_cutoff(samples: Floats, rate: float, noise_sigma: Floats) -> CutoffSuggestion:
    """Suggest the frequency above which a recording is nothing but noise, as a cut-off for `LowPass`.

    A frequency carries signal where the density exceeds that of white noise, 2 sigma² / rate, by more than
    chance: the chi-square quantile of Welch's estimate with a risk of 0.001 for all frequencies and channels
    together, and a factor of 1.5 at least, as predictions of noise are no better.

    Parameters
    ----------
    samples : (n, c)
        Regular samples, any unit, not yet filtered (a filter makes noise that is not white); NaN where missing.
    rate : float
        Samples a second, Hz.
    noise_sigma : (c,)
        Standard deviation of the white noise of each channel, in its unit: by propagation of errors (the root mean
        square over the recording).
    """
    found = spectrum(samples, rate)
    floor = 2 * noise_sigma**2 / rate
    dof = found.degrees_of_freedom
    threshold = max(_LEAST_RATIO, float(chi2.isf(_RISK / found.density[1:-1].size, dof)) / dof)
    above = found.density / floor > threshold
    above[[0, -1]] = False  # 0 Hz, where the mean was taken away, and Nyquist, which varies more
    cutoffs = [_channel_cutoff(found, marked) for marked in above.T]
    known = [hz for hz in cutoffs if hz is not None]
    cutoff = max(known) if len(known) == len(cutoffs) else None
    return CutoffSuggestion(cutoff, _explained(rate, cutoff, bool(above.any()), _doubts(found, floor)))


def _channel_cutoff(found: Spectrum, above: NDArray[np.bool_]) -> float | None:
    if not above.any():
        return found.resolution
    cutoff = float(found.frequencies[np.flatnonzero(above)[-1] + 1])
    return None if cutoff > _NO_ROOM * found.frequencies[-1] else cutoff


def _doubts(found: Spectrum, floor: Floats) -> str:
    """Return what the upper half of the spectrum has against the noise; its median does not see a few lines."""
    upper = found.frequencies[:-1] >= found.frequencies[-1] / 2
    dof = found.degrees_of_freedom
    # The median of chi-square is a little under its mean.
    ratio = np.median(found.density[:-1][upper], axis=0) / (float(chi2.median(dof)) / dof) / floor
    worst = float(ratio[np.argmax(np.abs(np.log(np.maximum(ratio, 1e-300))))])
    if 0.5 <= worst <= 2:
        return ""
    return (
        f"In the upper half of the spectrum the standard deviation is {sqrt(worst):.2g} times that of the noise"
        " given: is noise_sigma right?"
    )


def _explained(rate: float, cutoff: float | None, has_signal: bool, doubts: str) -> str:
    if cutoff is None:
        sentences = ["The spectrum stays above the noise up to half the rate: no filter is suggested."]
    else:
        low_pass = LowPass(cutoff, rate)
        finding = f"Above {cutoff:.3g} Hz the spectrum cannot be told from noise."
        if not has_signal:
            finding = (
                f"Nothing stands out of the noise; a cut-off of {cutoff:.3g} Hz is the lowest resolved here."
            )
        removed, lag = 100 * (1 - low_pass.noise_left), 1e3 * low_pass.delay
        effect = f"takes away {removed:.0f} % of the noise and lags by {lag:.3g} ms"
        sentences = [finding, f"A low-pass of order 2 there {effect}."]
    return " ".join([*sentences, doubts]).strip()
