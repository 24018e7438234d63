"""Spectra of recordings, and the cut-off frequency that they suggest."""

from dataclasses import dataclass
from math import ceil, pi, sqrt

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray
from scipy.signal import get_window
from scipy.stats import chi2

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering.lowpass import LowPass
from contactbench.pipeline.filtering.rows import Floats, as_rows, positive

_SEGMENT_SECONDS = (
    2.0  # lines 1 Hz apart are told apart: enough for hands and robots, and a minute gives 59 of them
)
_SHORTEST_SECONDS = 0.5
_SHORTEST_SAMPLES = 64
_FEWEST_SEGMENTS = 8
_RISK = 1e-3  # of noise alone being taken for signal anywhere in the recording
_LEAST_RATIO = 1.5  # no prediction of noise is better than a fifth of its standard deviation
_NO_ROOM = 0.9  # of the Nyquist frequency: a filter above would remove next to nothing
_MAINS = (50.0, 60.0)
_HARMONICS = (1, 2, 3)
_MOTION = 20.0  # Hz: below, a line may be motion as well as mirrored hum, and counts
_MAINS_TOLERANCE = 0.004  # 0.2 Hz in 50 Hz: a grid under stress


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power spectral density by Welch's method: the mean over half-overlapping Hann windows."""

    frequencies: Floats  # Hz, from 0 to half the rate
    density: Floats  # One-sided density of each channel, unit²/Hz: it integrates to the variance
    resolution: float  # Hz: lines nearer to each other than this merge, and slower motion is not seen
    segments: int  # How many segments were averaged

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
    # Whether anything was found above the noise; if not, `cutoff_hz` is the lowest that can be resolved
    has_signal: bool
    lines_hz: tuple[float, ...]  # Isolated lines of mains hum, Hz, which were left out of account
    noise_sigma: tuple[float, ...]  # Standard deviation of the noise of each channel, given or estimated
    explanation: str  # All this in plain sentences


def spectrum(samples: ArrayLike, rate: float) -> Spectrum:
    """Return the power spectral density of a recording.

    Segments last 2 s, less in recordings under 9 s (so that there are 8 of them), but 0.5 s and 64 samples at
    least. Segments with a missing sample are left out: to bridge a gap would take power from high frequencies.

    Parameters
    ----------
    samples : array_like (n, c)
        Regular samples, any unit, not yet filtered; NaN for what is missing.
    rate : float
        Samples a second, Hz.

    Raises
    ------
    InputError
        The recording, or what is left between gaps, is too short: the message says how many seconds it takes.
    """
    rate = positive("spectrum: rate", rate)
    rows = as_rows("spectrum", samples)
    shortest = max(ceil(_SHORTEST_SECONDS * rate), _SHORTEST_SAMPLES)
    reach = (_FEWEST_SEGMENTS + 1) / 2  # lengths of a segment that so many half-overlapping ones cover
    if len(rows) < reach * shortest:
        raise InputError(
            f"spectrum: {len(rows) / rate:.3g} s are too short; record {reach * shortest / rate:.3g} s or more at"
            f" {rate:g} Hz"
        )
    length = max(shortest, min(round(_SEGMENT_SECONDS * rate), int(len(rows) / reach))) // 2 * 2
    starts = np.arange(0, len(rows) - length + 1, length // 2)
    gaps = np.concatenate([[0], np.cumsum(~np.isfinite(rows).all(axis=1))])
    starts = starts[gaps[starts + length] == gaps[starts]]
    if starts.size < _FEWEST_SEGMENTS:
        raise InputError(
            f"spectrum: only {starts.size} stretches of {length / rate:.3g} s have no missing sample, and"
            f" {_FEWEST_SEGMENTS} are needed; record {reach * length / rate:.3g} s without gaps"
        )
    density = np.column_stack([_density(channel, starts, length, rate) for channel in rows.T])
    return Spectrum(
        np.arange(length // 2 + 1, dtype=np.float64) * (rate / length),
        density,
        2 * rate / length,
        int(starts.size),
    )


def _density(channel: Floats, starts: NDArray[np.intp], length: int, rate: float) -> Floats:
    segments = sliding_window_view(channel, length)[starts]
    window = get_window("hann", length)
    transform = np.fft.rfft((segments - segments.mean(axis=1, keepdims=True)) * window, axis=1)
    density: Floats = np.mean(np.abs(transform) ** 2, axis=0) / (rate * np.sum(window**2))
    density[1:-1] *= 2  # the negative frequencies, which 0 and Nyquist do not have
    return density


def suggest_cutoff(
    samples: ArrayLike, rate: float, noise_sigma: float | ArrayLike | None = None
) -> CutoffSuggestion:
    """Suggest the frequency above which a recording is nothing but noise, as a cut-off for `LowPass`.

    A frequency carries signal where the density exceeds that of white noise, 2 sigma² / rate, by more than
    chance: the chi-square quantile of Welch's estimate with a risk of 0.001 for all frequencies and channels
    together, and a factor of 1.5 at least, as predictions of noise are no better. Isolated lines at 50 or 60 Hz
    and their second and third harmonics, also mirrored into the band, do not count.

    Parameters
    ----------
    samples : array_like (n, c)
        Regular samples, any unit, not yet filtered (a filter makes noise that is not white); NaN where missing.
    rate : float
        Samples a second, Hz.
    noise_sigma : float or array_like (c,), optional
        Standard deviation of the white noise of each channel, in its unit: of the sensor, or of the contact
        location by propagation of errors (the root mean square over the recording). Quantisation in steps q
        adds q²/12 to its square. Default: the median of the upper half of the spectrum is noise.

    Raises
    ------
    InputError
        As for `spectrum`; or `noise_sigma` has a wrong shape or is not positive and finite.
    """
    rows = as_rows("suggest_cutoff", samples)
    found = spectrum(rows, rate)
    upper = _upper_half(found)
    if noise_sigma is None:
        # A channel that never changes has no spectrum: the rounding of its mean must not look like a signal.
        size = np.abs(np.where(np.isfinite(rows), rows, 0)).max(axis=0)
        floor = np.maximum(upper, 2 * (8 * np.finfo(float).eps * size) ** 2 / rate + np.finfo(float).tiny)
        doubts = _doubts_of_estimate(found)
    else:
        floor = 2 * _checked_sigma(noise_sigma, rows.shape[1]) ** 2 / rate
        doubts = _doubts_of_prediction(upper / floor)
    above = found.density / floor > _threshold(found)
    above[[0, -1]] = False  # 0 Hz, where the mean was taken away, and Nyquist, which varies more
    lines: set[float] = set()
    for channel, marked in zip((found.density / floor).T, above.T, strict=True):
        lines.update(_take_lines(found.frequencies, channel, marked))
    cutoffs = tuple(_channel_cutoff(found, marked) for marked in above.T)
    known = [hz for hz in cutoffs if hz is not None]
    cutoff = max(known) if len(known) == len(cutoffs) else None
    return _suggestion(
        rate, cutoff, bool(above.any()), tuple(sorted(lines)), np.sqrt(floor * rate / 2), doubts
    )


def _checked_sigma(noise_sigma: float | ArrayLike, channels: int) -> Floats:
    sigma = np.asarray(noise_sigma, dtype=np.float64)
    if sigma.shape not in {(), (channels,)}:
        raise InputError(
            f"noise_sigma: give one number or {channels}, one per channel, not shape {sigma.shape}"
        )
    if not np.all(np.isfinite(sigma) & (sigma > 0)):
        raise InputError(
            f"noise_sigma: standard deviations must be positive and finite, not {noise_sigma!r}; None estimates"
            " them from the recording"
        )
    return np.broadcast_to(sigma, (channels,))


def _threshold(found: Spectrum) -> float:
    """Return how many times the noise a density must be to count as signal."""
    tests = found.density[1:-1].size
    dof = found.degrees_of_freedom
    return max(_LEAST_RATIO, float(chi2.isf(_RISK / tests, dof)) / dof)


def _upper_half(found: Spectrum, start: float = 0.5, end: float = 1.0) -> Floats:
    """Return the noise density (c,) if there is nothing else from `start` to `end`, shares of Nyquist.

    The median, unlike the mean, does not see a few lines; that of chi-square is a little under its mean.
    """
    share = found.frequencies / found.frequencies[-1]
    dof = found.degrees_of_freedom
    middle: Floats = np.median(found.density[(share >= start) & (share < end)], axis=0)
    return middle / (float(chi2.median(dof)) / dof)


def _take_lines(frequencies: Floats, ratio: Floats, above: NDArray[np.bool_]) -> list[float]:
    """Strike isolated lines of mains hum from `above`, in place, and return their frequencies, Hz."""
    lines, step, rate = [], frequencies[1], 2 * frequencies[-1]
    for nominal in (mains * harmonic for mains in _MAINS for harmonic in _HARMONICS):
        seen = abs(nominal - rate * round(nominal / rate))  # mirrored at multiples of Nyquist
        if seen < _MOTION:
            continue
        near = np.flatnonzero(above & (np.abs(frequencies - seen) <= _MAINS_TOLERANCE * nominal + step))
        if not near.size:
            continue
        peak = int(near[np.argmax(ratio[near])])
        # A pure line seen through a Hann window falls with the cube of the distance, and rises above the noise
        # up to here; 0.85 is the least of it that the nearest bin shows. Beyond, noise must follow.
        width = 3 + int((sqrt(ratio[peak]) / (0.85 * pi)) ** (1 / 3))
        below, beyond = max(peak - width, 0), peak + width + 1
        if not above[max(below - 2, 0) : below].any() and not above[beyond : beyond + 2].any():
            above[below:beyond] = False
            lines.append(round(float(seen), 6))
    return lines


def _channel_cutoff(found: Spectrum, above: NDArray[np.bool_]) -> float | None:
    if not above.any():
        return found.resolution
    cutoff = float(found.frequencies[np.flatnonzero(above)[-1] + 1])
    return None if cutoff > _NO_ROOM * found.frequencies[-1] else cutoff


def _doubts_of_estimate(found: Spectrum) -> str:
    text = f"The noise was estimated: all above {found.frequencies[-1] / 2:.3g} Hz was taken for noise."
    if np.any(_upper_half(found, 0.5, 0.75) > _LEAST_RATIO * _upper_half(found, 0.75, 1.0)):
        text += " But the spectrum still falls there, so that this noise may be too large and the cut-off too low."
    return text


def _doubts_of_prediction(ratio: Floats) -> str:
    worst = float(ratio[np.argmax(np.abs(np.log(np.maximum(ratio, 1e-300))))])
    if 0.5 <= worst <= 2:
        return ""
    return (
        f"In the upper half of the spectrum the standard deviation is {sqrt(worst):.2g} times that of the noise"
        " given: is noise_sigma right?"
    )


def _suggestion(
    rate: float,
    cutoff: float | None,
    has_signal: bool,
    lines: tuple[float, ...],
    sigma: Floats,
    doubts: str,
) -> CutoffSuggestion:
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
    if lines:
        sentences.append(f"Mains hum is not counted: {', '.join(f'{hz:g} Hz' for hz in lines)}.")
    text = " ".join([*sentences, doubts]).strip()
    return CutoffSuggestion(cutoff, has_signal, lines, tuple(map(float, sigma)), text)
