"""One way to open any source of samples: devices, recordings, files of poses, typed poses, the virtual bench."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.pose_source import PacedPoses, PoseTrackError, file_track, still_track
from contactbench.pipeline.devices.reconnecting_stream import SensorStream, poses_from
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import Source, SourceStream, Stream
from contactbench.pipeline.devices.url import STEPWISE, DeviceAddress, Protocol
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.recording.messages import FLANGE_TOPIC, WRENCH_TOPIC, DeviceInfo, RecordingInfo
from contactbench.pipeline.recording.replay import Player
from contactbench.pipeline.simulation.virtual.world import World, world_at

__all__ = ["Pair", "PoseTrackError", "Stream", "open_pair", "open_poses", "open_sensor"]

from contactbench.pipeline.devices.pose_source import Track
from contactbench.pipeline.devices.stream import Health

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from types import TracebackType

    from contactbench.pipeline.simulation.virtual.bench import VirtualBench

    OnWrenches = Callable[[Sequence[WrenchSample]], None]
    OnFlanges = Callable[[Sequence[FlangeSample]], None]
    OnChange = Callable[[Health], None] | None


# ---- one source --------------------------------------------------------------------------------


def open_sensor(
    address: DeviceAddress | str, on_samples: OnWrenches, on_change: OnChange = None
) -> Stream[WrenchSample]:
    """
    Return the wrenches of the device or recording at an address, not yet started.

    Parameters
    ----------
    address : DeviceAddress or str
    on_samples : callable
        Gets every batch of samples, oldest first, in the stream's thread; it must be quick and not raise.
    on_change : callable, optional
        Told when the state or the findings changed, in the same thread.

    Raises
    ------
    AddressError, ProtocolError
        It gives no wrenches, or the rate does not fit.
    RecordingError
        The recording cannot be read, or has no wrenches.
    """
    where = _parsed(address)
    _check_kinds(where, None)
    if where.protocol in _SHARED:
        return _player_or_world(where, WrenchSample).stream(where, WrenchSample, on_samples, on_change)
    return SensorStream(where, on_samples, on_change)


def open_poses(
    address: DeviceAddress | str, on_samples: OnFlanges, on_change: OnChange = None
) -> Stream[FlangeSample]:
    """
    Return the poses of the robot, recording, file or typed pose at an address, not yet started.

    Parameters
    ----------
    address : DeviceAddress or str
    on_samples, on_change
        As for `open_sensor`.

    Raises
    ------
    AddressError
        It gives no poses.
    RecordingError, PoseTrackError
        The file cannot be read, or has no poses.
    InputError
        Joints need MuJoCo, which is not installed.
    """
    where = _parsed(address)
    _check_kinds(None, where)
    if where.protocol in _SHARED:
        return _player_or_world(where, FlangeSample).stream(where, FlangeSample, on_samples, on_change)
    if where.protocol in _TRACKS:
        source = PacedPoses(_TRACKS[where.protocol](where))
        return SourceStream(where, source, FlangeSample, on_samples, on_change, judged=False)
    return poses_from(where, on_samples, on_change)


def _player_or_world(where: DeviceAddress, kind: type) -> Player | World:
    if where.protocol is Protocol.VIRTUAL:
        return world_at(where)
    return Player(where, None) if kind is WrenchSample else Player(None, where)


_TRACKS: Mapping[str, Callable[[DeviceAddress], Track]] = {
    Protocol.STILL: still_track,
    Protocol.POSES: file_track,
}


# ---- a sensor with a source of poses -----------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Pair:
    """
    A sensor and, where there is one, a source of poses, on one clock.

    Attributes
    ----------
    sensor : Stream
    poses : Stream or None
    """

    sensor: Stream[WrenchSample]
    poses: Stream[FlangeSample] | None

    @property
    def streams(self) -> tuple[Stream[Any], ...]:
        """Those that there are, the sensor first."""
        return (self.sensor,) if self.poses is None else (self.sensor, self.poses)

    @property
    def source(self) -> Source | None:
        """What the wrenches come from; None: a device, on the host's monotonic clock."""
        return self.sensor.source if isinstance(self.sensor, SourceStream) else None

    @property
    def player(self) -> Player | None:
        """The player of the recording that they come from; None: they come from elsewhere."""
        return self.source if isinstance(self.source, Player) else None

    @property
    def bench(self) -> VirtualBench | None:
        """The virtual bench that the wrenches come from, to be told what to do."""
        return self.source.bench if isinstance(self.source, World) else None

    @property
    def stepwise(self) -> bool:
        """Whether samples come only when `step` asks for them."""
        return self.source is not None and self.source.stepwise

    @property
    def finished(self) -> bool:
        """Whether all that has an end is at it; never for a device alone."""
        ending = [stream for stream in self.streams if stream.address.protocol in _FINITE]
        return bool(ending) and all(stream.done.is_set() for stream in ending)

    def step(self, count: int = 1) -> int:
        """Give the next samples of a stepwise replay or bench; returns how many of `count` there were.

        Raises
        ------
        RuntimeError
            It does not go by steps.
        """
        if isinstance(self.sensor, SourceStream):
            return self.sensor.step(count)
        raise RuntimeError(
            message("only a replay or a virtual bench can be stepped: open it with ?speed=step")
        )

    def now(self) -> float:
        """Return the present time on the samples' clock, s."""
        return time.monotonic() if self.source is None else self.source.time

    @property
    def healths(self) -> dict[str, Health]:
        """How the streams are: that of the sensor, and that of the robot where there is one."""
        return dict(zip(("sensor", "robot"), (stream.health for stream in self.streams), strict=False))

    def about(self, note: str = "", serial: str | None = None) -> RecordingInfo:
        """Return the description of a recording of these streams, on their clock; `serial`: of the sensor, if told."""
        known = {} if self.player is None else self.player.devices
        sensor = _described(self.sensor, DeviceInfo("wrench", WRENCH_TOPIC, ""), known.get("wrench"))
        devices = [sensor if serial is None else replace(sensor, serial=serial)]
        if self.poses is not None:
            devices.append(
                _described(self.poses, DeviceInfo("flange", FLANGE_TOPIC, ""), known.get("flange"))
            )
        if self.player is None:
            return RecordingInfo(time.time_ns(), self.now(), tuple(devices), note=note)
        source = self.player.replay.info
        return RecordingInfo(source.started_ns, source.clock, tuple(devices), note=note)

    def start(self) -> Pair:
        """Begin both."""
        for stream in self.streams:
            stream.start()
        return self

    def stop(self) -> None:
        """End both."""
        for stream in self.streams:
            stream.stop()

    def __enter__(self) -> Pair:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()


_SHARED = (Protocol.REPLAY, Protocol.VIRTUAL)
_FINITE = (*_SHARED, Protocol.POSES)


def open_pair(
    sensor: DeviceAddress | str,
    poses: DeviceAddress | str | None,
    on_wrenches: OnWrenches,
    on_flanges: OnFlanges,
    on_sensor_change: OnChange = None,
    on_poses_change: OnChange = None,
) -> Pair:
    """
    Return a sensor and a source of poses on one clock, not yet started.

    The same recording given for both is read once: samples come in the order in which they were recorded. A
    pose that stands still or a file of poses beside a recording is put on the recording's clock, from its
    first wrench on; the file's speed is then in recorded seconds.

    Parameters
    ----------
    sensor, poses : DeviceAddress or str
        Where they are; None: no poses.
    on_wrenches, on_flanges, on_sensor_change, on_poses_change : callable
        As for `open_sensor`.

    Raises
    ------
    AddressError
        An address does not give what it is asked for, or the two are on different clocks.
    ProtocolError, RecordingError, PoseTrackError, InputError
        As `open_sensor` and `open_poses`.
    """
    where = _parsed(sensor)
    beside = None if poses is None else _parsed(poses)
    _check_kinds(where, beside)
    if beside is not None:
        _check_clock(where, beside)
    if where.protocol is not Protocol.REPLAY:
        first = open_sensor(where, on_wrenches, on_sensor_change)
        return Pair(first, None if beside is None else open_poses(beside, on_flanges, on_poses_change))
    track = _TRACKS[beside.protocol](beside) if beside is not None and beside.protocol in _TRACKS else None
    player = Player(where, beside, track)
    wrenches = player.stream(where, WrenchSample, on_wrenches, on_sensor_change)
    if beside is None:
        return Pair(wrenches, None)
    return Pair(wrenches, player.stream(beside, FlangeSample, on_flanges, on_poses_change))


def _parsed(address: DeviceAddress | str) -> DeviceAddress:
    return DeviceAddress.parse(address) if isinstance(address, str) else address


def _check_kinds(sensor: DeviceAddress | None, poses: DeviceAddress | None) -> None:
    if sensor is not None and not sensor.gives_wrenches:
        raise AddressError(
            f"address {arg(str(sensor))!r}: not a force/torque sensor: give the address of a sensor or"
            " of a recording."
        )
    if poses is not None and not poses.gives_poses:
        raise AddressError(
            f"address {arg(str(poses))!r}: it provides no poses: give the address of a robot, a"
            " recording, poses:///file.csv or still://?rpy=0,0,0."
        )


def _check_clock(sensor: DeviceAddress, poses: DeviceAddress) -> None:
    virtual = [address.protocol is Protocol.VIRTUAL for address in (sensor, poses)]
    stepped = any(
        address.protocol is Protocol.VIRTUAL and address.speed == STEPWISE for address in (sensor, poses)
    )
    if (stepped or all(virtual)) and str(sensor) != str(poses):
        raise AddressError(
            f"address {arg(str(poses))!r}: not the sensor's bench or clock: give {arg(str(sensor))!r} for both."
        )
    recorded = [address.protocol is Protocol.REPLAY for address in (sensor, poses)]
    if poses.protocol in _TRACKS or not any(recorded):
        return
    if not all(recorded):
        raise AddressError(
            f"address {arg(str(poses))!r}: a recording and a device have different clocks: give the"
            " same recording for sensor and poses, still:// or poses:// beside it, or two"
            " devices."
        )
    if Path(sensor.path) != Path(poses.path) or sensor.speed != poses.speed:
        raise AddressError(
            f"address {arg(str(poses))!r}: sensor and poses must come from the same recording at the same speed: give"
            f" {arg(str(replace(sensor, topic=poses.topic)))!r} here."
        )


def _described(stream: Stream[Any], plain: DeviceInfo, known: DeviceInfo | None) -> DeviceInfo:
    """Return who gave samples: for a recording, also what it knew of them."""
    if known is None:
        rate = stream.address.rate
        if plain.kind == "flange" and stream.address.bench is not None:
            rate = stream.address.bench.pose_rate
        return replace(plain, address=str(stream.address), rate=rate)
    return replace(known, topic=plain.topic, address=str(stream.address))
