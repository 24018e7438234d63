"""How fast the parsers are on bytes in memory, beside a bare unpacking of the same bytes by NumPy."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.soak import SUBJECTS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.soak import Subject

_PIECE = 4096  # what a line hands over at most
_ROUNDS = 3

# NumPy takes the numbers out of frames that stand back to back; it looks for no header and checks no sum.
_LAYOUTS = {
    "sri": np.dtype([("head", "V6"), ("values", "<f4", 6), ("end", "V1")]),
    "sri-crc32": np.dtype([("head", "V6"), ("values", "<f4", 6), ("end", "V4")]),
    "bota": np.dtype([("head", "V3"), ("values", "<f4", 6), ("end", "V10")]),
    "robotiq": np.dtype([("head", "V2"), ("values", "<i2", 6), ("end", "V2")]),
    "rdt": np.dtype([("head", "V12"), ("values", ">i4", 6)]),
}
PROTOCOLS = tuple(_LAYOUTS)


@dataclass(frozen=True)
class Speed:
    """One protocol's speeds on the same bytes."""

    protocol: str
    parser: float  # From bytes to samples, bytes/s
    unpacking: float  # From bytes to an array of float64, bytes/s
    frame_bytes: int


def parse_speed(protocol: str, frames: int, seed: int = 0) -> Speed:
    """Measure one parser on intact frames; the fastest of three rounds."""
    subject = SUBJECTS[protocol]
    made = _frames(subject, frames, seed)
    data = b"".join(made)
    size = _PIECE if protocol != "rdt" else subject.frame_bytes
    pieces = [data[start : start + size] for start in range(0, len(data), size)]
    parser = min(_parse(subject, pieces, frames) for _ in range(_ROUNDS))
    layout = _LAYOUTS[protocol]
    unpacking = min(_unpack(data, layout, frames) for _ in range(_ROUNDS))
    return Speed(protocol, len(data) / parser, len(data) / unpacking, subject.frame_bytes)


def _frames(subject: Subject, count: int, seed: int) -> list[bytes]:
    readings = np.random.default_rng(seed).normal(0, 10, (count, 6)).astype("<f4")
    return [subject.frame(number, row.tobytes()) for number, row in enumerate(readings)]


def _parse(subject: Subject, pieces: Sequence[bytes], frames: int) -> float:
    parser = subject.parser()
    began = time.perf_counter()
    samples = sum(len(parser.feed(piece, 1e-3 * number)) for number, piece in enumerate(pieces))
    took = time.perf_counter() - began
    if samples != frames:
        raise RuntimeError(f"{samples} samples of {frames} intact frames")
    return took


def _unpack(data: bytes, layout: np.dtype[np.void], frames: int) -> float:
    began = time.perf_counter()
    values = np.frombuffer(data, dtype=layout)["values"].astype(np.float64)
    took = time.perf_counter() - began
    if values.shape != (frames, 6):
        raise RuntimeError(f"{len(values)} rows of {frames} intact frames")
    return max(took, 1e-9)
