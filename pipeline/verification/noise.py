"""What a recording says of the sensor: its noise, its rest, its clock."""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.verification.press import ProtocolSettings
from contactbench.pipeline.verification.source import TouchRecording
from contactbench.pipeline.verification.touch_location import memory, sample_noise

_CORRELATED = 2.0  # times the variance of a mean of white noise
_BLOCK_S, _STILL_N, _FEWEST_BLOCKS = 0.1, 0.1, 3
_RAMP_S, _FEWEST_SAMPLES = 0.05, 3  # s beside a press that are no rest; samples of a run


def measured_noise(
    recording: TouchRecording, protocol: ProtocolSettings, stated: tuple[float, float] | None
) -> tuple[WrenchNoise, float, list[str]]:
    """
    Return the noise of one sample, such that a mean of n has 1/n of its variance.

    Parameters
    ----------
    recording : TouchRecording
        Compensated.
    protocol : ProtocolSettings
    stated : (force, torque), optional
        Standard deviations of a sample, N and N·m; else between neighbours while the probe is pressed.

    Returns
    -------
    WrenchNoise
    float
        By what that variance is larger than half the mean square between neighbours; 1: white noise.
    list of str
        What to know of it.
    """
    runs, rests = _runs(recording, protocol)
    # A hand trembles, and a robot swings: only what is there both at rest and pressed is the sensor's.
    known = [found for part in (runs, rests) if (found := memory(part)) is not None]
    tau, neighbours = min(known, default=(1.0, 0.0))
    correlation = tau / (1 - min(neighbours, 0.999))
    if stated is not None:
        base, growth = WrenchNoise(*stated), tau
    else:
        base, growth = (sample_noise(runs) if runs else WrenchNoise()), correlation
    said = []
    if tau > _CORRELATED:
        alike = message(
            f"Neighbouring samples are correlated (the sensor filters): {arg(tau):.0f} samples count as"
            " one, and the noise of means is increased accordingly."
        )
        said.append(alike)
    root = np.sqrt(max(growth, 1.0))
    scaled = WrenchNoise(np.asarray(base.force) * root, np.asarray(base.torque) * root)
    return scaled, max(correlation, 1.0), said


def resting(recording: TouchRecording, protocol: ProtocolSettings, rate: float) -> str | None:
    """Return a sentence if the compensated sensor reads a force while nothing is touched."""
    n = max(4, round(_BLOCK_S * rate))
    forces = recording.wrenches[: len(recording.wrenches) // n * n, :3].reshape(-1, n, 3)
    half = n // 2
    steps = np.linalg.norm(forces[:, half:].mean(axis=1) - forces[:, :half].mean(axis=1), axis=1)
    means = forces.mean(axis=1)
    sizes = np.linalg.norm(means, axis=1)
    free = (steps < _STILL_N) & (sizes < 0.5 * min(low for low, _ in protocol.windows))
    if np.count_nonzero(free) < _FEWEST_BLOCKS:
        return None
    offset = float(np.median(sizes[free]))
    if offset <= protocol.release_N:
        return None
    return message(
        f"The sensor reads {arg(offset):.1f} N with nothing touching: recalibrate, or raise the forces"
        f" at which a touch begins and ends (now {arg(protocol.touch_N):g} and {arg(protocol.release_N):g}"
        " N)."
    )


def rate_of(times: NDArray[np.float64]) -> float | None:
    """Return the usual rate of samples at times (n,), Hz, to four digits; None: there is none."""
    steps = np.diff(times)
    steps = steps[np.isfinite(steps) & (steps > 0)]
    return float(f"{1 / np.median(steps):.4g}") if len(steps) else None


def _runs(
    recording: TouchRecording, protocol: ProtocolSettings
) -> tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]]:
    """Return runs of samples (n, 6) with the probe pressed, and those at rest, without the ramps beside them."""
    forces = np.linalg.norm(recording.wrenches[:, :3], axis=1)
    # Some recordings hold nothing but presses, so a pause parts them too.
    paused = np.diff(recording.times) > protocol.gap_s

    def parted(chosen: NDArray[np.bool_], margin: int) -> list[NDArray[np.float64]]:
        parts = np.split(np.arange(len(forces)), np.flatnonzero(np.diff(chosen) | paused) + 1)
        runs = [recording.wrenches[part[margin:-margin]] for part in parts if len(part) and chosen[part[0]]]
        return [run for run in runs if len(run) > _FEWEST_SAMPLES and np.isfinite(run).all()]

    pressed = parted(forces >= min(low for low, _ in protocol.windows), 1)
    rate = rate_of(recording.times)
    ramp = 1 if rate is None else max(1, round(_RAMP_S * rate))
    return pressed, parted(forces < protocol.touch_N, ramp)
