"""What damage and chance do to protocols: random bytes, and streams with one byte in a hundred damaged."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress
from dataclasses import dataclass
from time import process_time
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.devices.protocols.bota import BotaParser
from contactbench.pipeline.devices.protocols.checksums import crc16_modbus, crc16_x25, sum8
from contactbench.pipeline.devices.protocols.elfin import ElfinError, ReplyReader, read_position
from contactbench.pipeline.devices.protocols.igtl_pose import BodyStream
from contactbench.pipeline.devices.protocols.kunwei import KunweiParser
from contactbench.pipeline.devices.protocols.line import LineWrenches
from contactbench.pipeline.devices.protocols.line_layout import OPTIONS, Layout
from contactbench.pipeline.devices.protocols.parser import ProtocolError
from contactbench.pipeline.devices.protocols.rdt import ATI_TYPICAL, RdtParser
from contactbench.pipeline.devices.protocols.robotiq import RobotiqParser
from contactbench.pipeline.devices.protocols.robotous import RobotousParser
from contactbench.pipeline.devices.protocols.sri import Layout as SriLayout
from contactbench.pipeline.devices.protocols.sri import SriParser, Trailer
from contactbench.pipeline.devices.protocols.ur_pose import UrStream
from contactbench.pipeline.devices.protocols.ur_rtde import (
    Packet,
    PacketKind,
    PacketReader,
    RtdeError,
    packet,
)
from contactbench.pipeline.devices.protocols.ur_wrench import UrWrenchParser
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.protocols.parser import SensorParser
    from contactbench.pipeline.devices.sample import WrenchSample

_LAYOUTS = {Trailer.SUM: SriLayout(Trailer.SUM), Trailer.CRC32: SriLayout(Trailer.CRC32)}


@dataclass(frozen=True, slots=True)
class Subject:
    """One sensor protocol under trial."""

    parser: Callable[[], SensorParser]  # Makes a fresh parser
    # Makes an intact frame from its number and 24 bytes of payload (Robotiq takes the first 12)
    frame: Callable[[int, bytes], bytes]
    payload_at: int  # Where in a frame the payload begins
    payload_bytes: int
    # A false frame begins at one place in 2 to this power of random bytes; None without a checksum
    false_bits: int | None
    lines: bool = False  # frames are lines of text: of any length, as long as they make sense

    @property
    def frame_bytes(self) -> int:
        """Length of a frame."""
        return len(self.frame(0, bytes(24)))


def _sri(number: int, payload: bytes, trailer: Trailer) -> bytes:
    head = struct.pack(">HHH", 0xAA55, _LAYOUTS[trailer].package_length, number & 0xFFFF)
    if trailer is Trailer.SUM:
        return head + payload + bytes([sum8(payload)])
    return head + payload + struct.pack("<I", zlib.crc32(payload))


def _sri_sum(number: int, payload: bytes) -> bytes:
    return _sri(number, payload, Trailer.SUM)


def _sri_crc(number: int, payload: bytes) -> bytes:
    return _sri(number, payload, Trailer.CRC32)


def _bota(number: int, payload: bytes) -> bytes:
    body = bytes(2) + payload + struct.pack("<If", number * 1000 & 0xFFFFFFFF, 31.5)
    return b"\xaa" + body + struct.pack("<H", crc16_x25(body))


def _robotiq(number: int, payload: bytes) -> bytes:  # noqa: ARG001 (the protocol has no number)
    body = b"\x20\x4e" + payload[:12]
    return body + struct.pack("<H", crc16_modbus(body))


def _rdt(number: int, payload: bytes) -> bytes:
    return struct.pack(">3I", number & 0xFFFFFFFF, number & 0xFFFFFFFF, 0) + payload


def _kunwei(number: int, payload: bytes) -> bytes:  # noqa: ARG001 (the protocol has no number)
    return b"\x48\xaa" + payload + b"\x0d\x0a"


def _robotous(number: int, payload: bytes) -> bytes:  # noqa: ARG001 (the protocol has no number)
    field = b"\x0b" + payload[:12] + bytes(3)
    return b"\x55" + field + bytes([sum8(field)]) + b"\xaa"


def _hundredths(payload: bytes) -> list[str]:
    return [f"{value / 100:8.2f}" for value in struct.unpack("<6h", payload[:12])]


def _columns(number: int, payload: bytes) -> bytes:
    return f"{number:10d},{','.join(_hundredths(payload))}\n".encode()


def _json(number: int, payload: bytes) -> bytes:
    return f'{{"n":{number:10d},"f":[{",".join(_hundredths(payload))}]}}\n'.encode()


def _line(fields: str) -> LineWrenches:
    options = {**dict.fromkeys(OPTIONS), "fields": OPTIONS["fields"].read(fields)}
    parser = LineWrenches(Layout.of(options), datagrams=False)
    parser.feed(b"\n", 0.0)  # what comes before a line's end is not believed
    return parser


SUBJECTS = {
    "sri": Subject(SriParser, _sri_sum, 6, 24, 40),
    "sri-crc32": Subject(lambda: SriParser(_LAYOUTS[Trailer.CRC32]), _sri_crc, 6, 24, 64),
    "bota": Subject(BotaParser, _bota, 3, 24, 24),
    "robotiq": Subject(RobotiqParser, _robotiq, 2, 12, 32),
    "kunwei": Subject(KunweiParser, _kunwei, 2, 24, 32),
    "robotous": Subject(RobotousParser, _robotous, 2, 12, 32),
    "line": Subject(lambda: _line("n,fx,fy,fz,mx,my,mz"), _columns, 11, 53, 64, lines=True),
    "line-json": Subject(
        lambda: _line("n:n,fx:f.0,fy:f.1,fz:f.2,mx:f.3,my:f.4,mz:f.5"), _json, 21, 53, 64, lines=True
    ),
    "rdt": Subject(lambda: RdtParser(ATI_TYPICAL), _rdt, 12, 24, None),
}
ROBOTS = ("elfin", "ur", "ur-wrench", "igtl")
PROTOCOLS = (*SUBJECTS, *ROBOTS)

_FRAGMENTS = {
    "elfin": [
        b"ReadActPos",
        *(
            b",OK,",
            b",Fail,",
            b"errorcmd,",
            b",;",
            b";",
            b",",
            b"20011",
            b"nan",
            b"-1e999",
            b"9" * 30,
            b"0,1" * 9,
        ),
        b"ReadActPos,OK," + b"1.5," * 12 + b";",
        b"ReadRobotState,OK," + b"0," * 12 + b";",
    ],
    "ur": [
        *(packet(kind) for kind in PacketKind),
        *(packet(PacketKind.DATA, b"\x01" + filler * 104) for filler in (b"\x00", b"\x7f", b"\xff", b"\x3f")),
        *(b"\x00", b"\x00\x6c", b"\x00\x6cU\x01", b"\x0f\xffM", b"\xff\xffU"),
    ],
}

_TRANSFORM = igtl.pack(igtl.TRANSFORM, "Probe", 10**18, igtl.transform(np.eye(3), np.ones(3)))
_FRAGMENTS["igtl"] = [
    _TRANSFORM,
    *(_TRANSFORM[:cut] for cut in (2, 14, 42, 57, 58, 70)),
    _TRANSFORM[58:],
    *(
        struct.pack(">H12s20sIIQQ", version, kind, b"Probe", 1, 0, size, 0)
        for version in (1, 2)
        for kind in (b"TRANSFORM", b"QTDATA", b"IMAGE")  # an image is skipped unread: a short one
        for size in (0, 48, 3_200, 60_000 if kind != b"IMAGE" else 7, 2**63)
    ),
    igtl.pack(igtl.QTDATA, "", 1, b"\xff" * 50),
    *(igtl.pack(kind, "Probe", 1, b"\x7f\xc0\0\0" * 12) for kind in (igtl.TRANSFORM, igtl.POSITION)),
]

_LONGEST_CHUNK = 300
_BLOCK = 1 << 16
_PAUSE = 1e-3
_RECOVERED = 0.95
_HOUR_S, _RATE_HZ, _AT_ONCE = 3600, 1000.0, 10
_MOST_OF_AN_HOUR_S = 1800.0  # half of one core
_SIGMAS = 5.0  # how far above the chance expected false frames may be


class SoakError(AssertionError):
    """A parser broke one of its promises: a fault of the program, not of its input."""


@dataclass(frozen=True, slots=True)
class DamageReport:
    """What came of a stream with damaged bytes."""

    frames: int  # Frames sent
    intact: int  # Of them without a damaged byte
    recovered: int  # Intact frames whose samples came out
    false_frames: int  # Samples with a payload that was never sent


def run(
    count: int = 10_000_000,
    frames: int = 50_000,
    *,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Feed each parser random bytes, a stream with one byte in a hundred damaged, and one as it should be."""
    if count < 1 or frames < 1:
        raise InputError("give numbers of bytes and frames above 0.")
    figures = []
    for protocol in PROTOCOLS:
        progress(f"{protocol}: {count:,} random bytes")
        false, expected = soak(protocol, count, seed)
        most = None if expected is None else expected + _SIGMAS * max(expected, 1e-3) ** 0.5
        figures.append(Figure(protocol, "false frames in random bytes", false, most=most))
        if protocol in SUBJECTS:
            progress(f"{protocol}: {frames:,} frames at 1 kHz")
            hour = _HOUR_S * _RATE_HZ / frames * pace(protocol, frames, seed)
            figures.append(Figure(protocol, "time for an hour at 1 kHz", hour, "s", most=_MOST_OF_AN_HOUR_S))
        if expected is None:
            continue
        progress(f"{protocol}: {frames:,} frames, 1 % of the bytes damaged")
        hurt = damage(protocol, frames, seed)
        share = hurt.recovered / max(hurt.intact, 1)
        figures.append(Figure(protocol, "intact frames recovered", share, least=_RECOVERED))
    notes = ("False frames: chance makes as many as the checksum lets through; SRI's sum is one byte.",)
    settings = {"bytes": count, "frames": frames, "seed": seed}
    return StudyReport("Protocols under damage", settings, tuple(figures), notes)


def soak(protocol: str, count: int, seed: int) -> tuple[int, float | None]:
    """
    Feed random bytes, cut at random; for robots, mixed with pieces of the protocol.

    Return how many frames were found, none of which was one, and how many chance makes; None without a checksum.
    """
    rng = np.random.default_rng(seed)
    if protocol in SUBJECTS:
        return _soak_sensor(SUBJECTS[protocol], count, rng)
    robots = {"elfin": _elfin_feed, "ur": _ur_feed, "ur-wrench": _ur_wrench_feed, "igtl": _igtl_feed}
    if protocol not in robots:
        raise ProtocolError(f"soak: there is no protocol {protocol!r}; known: {', '.join(PROTOCOLS)}.")
    feed = robots[protocol]()
    fragments = _FRAGMENTS[protocol.partition("-")[0]]
    return sum(feed(chunk) for chunk in _fragment_chunks(fragments, count, rng)), None


def damage(protocol: str, frames: int, seed: int, *, share: float = 0.01) -> DamageReport:
    """Feed a stream of frames, a share of its bytes damaged, cut at random."""
    if protocol not in SUBJECTS:
        raise ProtocolError(f"soak: there is no sensor protocol {protocol!r}; known: {', '.join(SUBJECTS)}.")
    subject, rng = SUBJECTS[protocol], np.random.default_rng(seed)
    stream = _stream(subject, frames, rng)
    hit = rng.random(stream.shape) < share
    damaged = np.where(hit, stream ^ rng.integers(1, 256, stream.shape, dtype=np.uint8), stream)
    payload = slice(subject.payload_at, subject.payload_at + subject.payload_bytes)
    sent = {row.tobytes() for row in stream[:, payload]}
    whole = {row.tobytes() for row in stream[~hit.any(axis=1), payload]}
    # A datagram is never cut.
    chunks = (row.tobytes() for row in damaged) if protocol == "rdt" else _cut(damaged.tobytes(), rng)
    watch = _Watch(subject)
    got = {_payload(subject, sample) for chunk in chunks for sample in watch.feed(chunk)}
    intact = int((~hit.any(axis=1)).sum())
    return DamageReport(frames, intact, len(got & whole), len(got - sent))


def pace(protocol: str, frames: int, seed: int) -> float:
    """Return the time for parsing, timing and watching frames that come ten at a time, 1000 a second; s."""
    subject = SUBJECTS[protocol]
    stream = _stream(subject, frames, np.random.default_rng(seed))
    parser, clock, watch = subject.parser(), SampleClock(_RATE_HZ), Watch(_RATE_HZ)
    started = process_time()  # not that of others on this machine
    for first in range(0, frames, _AT_ONCE):
        now = (first + _AT_ONCE) / _RATE_HZ
        batch = stream[first : first + _AT_ONCE]
        chunks = [row.tobytes() for row in batch] if protocol == "rdt" else [batch.tobytes()]
        samples = [sample for chunk in chunks for sample in parser.feed(chunk, now)]
        watch.see(clock.stamp(samples))
        watch.count(now, parser.counters, batch.size)
    seconds = process_time() - started
    if watch.samples < frames:
        raise SoakError(f"{watch.samples} of {frames} frames came out")
    return seconds


class _Watch:
    """A sensor parser, watched."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._parser = subject.parser()
        self._fed = 0

    @property
    def frames(self) -> int:
        return self._parser.counters.frames

    def feed(self, chunk: bytes) -> list[WrenchSample]:
        samples = self._parser.feed(chunk, self._fed * _PAUSE)
        self._fed += len(chunk)
        counters, pending = self._parser.counters, self._parser.pending
        if self._subject.lines:
            return samples
        if pending >= self._subject.frame_bytes:
            raise SoakError(f"{pending} bytes wait for a frame of {self._subject.frame_bytes}")
        known = counters.frames * self._subject.frame_bytes + counters.skipped_bytes + pending
        if known != self._fed:
            raise SoakError(f"{self._fed} bytes were fed, {known} are accounted for")
        return samples


def _soak_sensor(subject: Subject, count: int, rng: np.random.Generator) -> tuple[int, float | None]:
    watch = _Watch(subject)
    for chunk in _random_chunks(count, rng):
        watch.feed(chunk)
    return watch.frames, None if subject.false_bits is None else count / 2**subject.false_bits


def _elfin_feed() -> Callable[[bytes], int]:
    reader = ReplyReader()

    def feed(chunk: bytes) -> int:
        replies = reader.feed(chunk)
        for reply in replies:
            with suppress(ElfinError):
                read_position(reply)
        if reader.pending > 2048:
            raise SoakError(f"{reader.pending} bytes wait for the end of an answer")
        return len(replies)

    return feed


def _ur_feed() -> Callable[[bytes], int]:
    reader, stream = PacketReader(), _running_ur()

    def feed(chunk: bytes) -> int:
        with suppress(RtdeError):
            stream.feed(chunk, 0.0)
        found: list[Packet] = reader.feed(chunk)
        if max(reader.pending, stream.pending) > 4096:
            raise SoakError(f"{reader.pending} bytes wait for the end of a packet")
        return len(found)

    return feed


def _ur_wrench_feed() -> Callable[[bytes], int]:
    parser = UrWrenchParser()
    agreed = packet(PacketKind.OUTPUTS, b"\x01DOUBLE,VECTOR6D")

    def feed(chunk: bytes) -> int:
        try:
            found = len(parser.feed(agreed + chunk, 0.0))
        except RtdeError:
            parser.reset()
            return 0
        if parser.pending > 4096:
            raise SoakError(f"{parser.pending} bytes wait for the end of a packet")
        return found

    return feed


def _igtl_feed() -> Callable[[bytes], int]:
    bodies = BodyStream("Probe")

    def feed(chunk: bytes) -> int:
        before = bodies.counters.frames
        samples = bodies.feed(chunk, 0.0)
        if bodies.pending > 16_384:
            raise SoakError(f"{bodies.pending} bytes wait for the end of a message")
        if not all(np.isfinite(each.R_BE).all() and np.isfinite(each.p_BE_B).all() for each in samples):
            raise SoakError("a pose is not finite")
        return bodies.counters.frames - before

    return feed


def _running_ur() -> UrStream:
    stream = UrStream(125.0)
    stream.start()
    stream.feed(packet(PacketKind.VERSION, b"\x01"), 0.0)
    stream.feed(packet(PacketKind.OUTPUTS, b"\x01DOUBLE,VECTOR6D,VECTOR6D,VECTOR6D"), 0.0)
    stream.feed(packet(PacketKind.START, b"\x01"), 0.0)
    return stream


def _stream(subject: Subject, frames: int, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Return (frames, bytes): payloads of a sensor's size, with header bytes inside many of them."""
    numbers = rng.normal(0, 10, (frames, 6)).astype("<f4")
    payloads = numbers.view(np.uint8).reshape(frames, 24)
    for header in (b"\xaa\x55\x00\x1b", b"\xaa", b"\x20\x4e"):
        rows = rng.random(frames) < 0.1
        payloads[rows, : len(header)] = np.frombuffer(header, np.uint8)
    frame_list = (subject.frame(n, row.tobytes()) for n, row in enumerate(payloads))
    return np.frombuffer(b"".join(frame_list), np.uint8).reshape(frames, subject.frame_bytes)


def _payload(subject: Subject, sample: WrenchSample) -> bytes:
    """Return the bytes on the wire that a sample stands for."""
    numbers = sample.force + sample.torque
    if subject is SUBJECTS["robotiq"]:
        scaled = [round(n * scale) for n, scale in zip(numbers, [100.0] * 3 + [1000.0] * 3, strict=True)]
        return struct.pack("<6h", *scaled)
    if subject is SUBJECTS["robotous"]:
        return struct.pack(
            ">6h", *(round(n * k) for n, k in zip(numbers, [50.0] * 3 + [2000.0] * 3, strict=True))
        )
    if subject is SUBJECTS["kunwei"]:
        return struct.pack("<6f", *(n / 9.80665 for n in numbers))
    if subject.lines:
        return ",".join(f"{n:8.2f}" for n in numbers).encode()
    if subject is SUBJECTS["rdt"]:
        return struct.pack(">6i", *(round(n * 1e6) for n in numbers))
    return struct.pack("<6f", *numbers)


def _random_chunks(count: int, rng: np.random.Generator) -> Iterator[bytes]:
    for start in range(0, count, _BLOCK):
        yield from _cut(rng.bytes(min(_BLOCK, count - start)), rng)


def _fragment_chunks(fragments: list[bytes], count: int, rng: np.random.Generator) -> Iterator[bytes]:
    """Yield `count` bytes, half of them pieces of the protocol: plain random bytes never get far into it."""
    left = count
    while left > 0:
        parts = [
            fragments[pick] if pick < len(fragments) else rng.bytes(3)
            for pick in rng.integers(0, 2 * len(fragments), _BLOCK >> 6)
        ]
        block = b"".join(parts)[:left]
        left -= len(block)
        yield from _cut(block, rng)


def _cut(data: bytes, rng: np.random.Generator) -> Iterator[bytes]:
    start = 0
    while start < len(data):
        length = int(rng.integers(1, _LONGEST_CHUNK))
        yield data[start : start + length]
        start += length
