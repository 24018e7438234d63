"""What a recording says of the sensor: its noise, its rest, its clock."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.verification.touch_location import memory, sample_noise

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.verification.press import ProtocolSettings
    from contactbench.pipeline.verification.source import TouchRecording

_CORRELATED = 2.0  # times the variance of a mean of white noise
_BLOCK_S, _STILL_N, _FEWEST_BLOCKS = 0.1, 0.1, 3


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
        said.append(
            message(
                f"Neighbouring samples are correlated (the sensor filters): {arg(tau):.0f} samples count as"
                " one, and the noise of means is increased accordingly."
            )
        )
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
    """Return runs of samples (n, 6) with the probe pressed, and those without."""
    forces = np.linalg.norm(recording.wrenches[:, :3], axis=1)
    pressed = forces >= min(low for low, _ in protocol.windows)
    # Some recordings hold nothing but presses, so a pause parts them too.
    paused = np.diff(recording.times) > protocol.gap_s
    runs = np.split(recording.wrenches, np.flatnonzero(np.diff(pressed) | paused) + 1)
    runs = [run[1:-1] for run in runs if len(run) > 5 and np.isfinite(run).all()]
    sizes = [np.linalg.norm(run[:, :3], axis=1) for run in runs]
    pushed = [run for run, size in zip(runs, sizes, strict=True) if size[0] >= protocol.touch_N]
    free = [run for run, size in zip(runs, sizes, strict=True) if size.max() < protocol.touch_N]
    return pushed, free
