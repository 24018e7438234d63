"""What damage, chance and sudden death do to protocols and sessions."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from benchmarks.session_crash import kill_writers
from benchmarks.soak import PROTOCOLS, damage, soak

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, Report

if TYPE_CHECKING:
    from collections.abc import Callable

_RECOVERED = 0.95
_SIGMAS = 5.0  # how far above the chance expected false frames may be


def run_protocols(
    count: int = 10_000_000,
    frames: int = 50_000,
    *,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> Report:
    """Feed each parser random bytes, and a stream with one byte in a hundred damaged."""
    if count < 1 or frames < 1:
        raise InputError("give numbers of bytes and frames above 0.")
    figures = []
    for protocol in PROTOCOLS:
        progress(f"{protocol}: {count:,} random bytes")
        chance = soak(protocol, count, seed)
        expected = chance.expected
        most = None if expected is None else expected + _SIGMAS * max(expected, 1e-3) ** 0.5
        figures += [
            Figure(protocol, "false frames in random bytes", chance.false_frames, most=most),
            Figure(protocol, "speed", chance.bytes_fed / max(chance.seconds, 1e-9) / 1e6, "MB/s"),
        ]
        if expected is None:
            continue
        progress(f"{protocol}: {frames:,} frames, 1 % of the bytes damaged")
        hurt = damage(protocol, frames, seed)
        share = hurt.recovered / max(hurt.intact, 1)
        figures.append(Figure(protocol, "intact frames recovered", share, least=_RECOVERED))
    notes = ("False frames: chance makes as many as the checksum lets through; SRI's sum is one byte.",)
    settings = {"bytes": count, "frames": frames, "seed": seed}
    return Report("Protocols under damage", settings, tuple(figures), notes)


def run_sessions(
    kills: int = 200, *, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> Report:
    """Kill a writing process again and again, and look what is left."""
    if kills < 1:
        raise InputError("give a number of kills above 0.")
    progress(f"killing a writer {kills} times")
    with TemporaryDirectory() as folder:
        report = kill_writers(Path(folder) / "session", kills, seed=seed)
    figures = (
        Figure("session", "actions acknowledged", report.acknowledged, least=1),
        Figure("session", "lost, or half there", len(report.problems), most=0),
        Figure("session", "records cut off in the middle", report.torn),
    )
    settings = {"kills": kills, "seed": seed}
    return Report("Sessions whose writer is killed", settings, figures, report.problems)
