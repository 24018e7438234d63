"""What a recording says about itself: its clock, the devices, who wrote it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

from contactbench import __version__
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

WRENCH_TOPIC, FLANGE_TOPIC, EVENT_TOPIC = "/wrench", "/flange", "/events"

ABOUT_RECORD = "contactbench.recording"
DEVICE_RECORD = "contactbench.device"
FORMAT = 2
ARRIVALS_ONLY = 1  # until this one, `time` of a device was the arrival

_CENTURIES = 1e10  # s; what 64 bits of nanoseconds hold
LATEST = 1e15  # s; on any clock: differences and sums of such times stay finite

DeviceKind = Literal["wrench", "flange"]


@dataclass(frozen=True, slots=True)
class DeviceInfo:
    """Where a topic's samples come from."""

    kind: DeviceKind
    topic: str  # where its samples are in the recording
    address: str  # as it was opened, an URL
    # model, serial: empty where unknown
    model: str = ""
    serial: str = ""
    rate: float | None = None  # nominal, Hz


@dataclass(frozen=True, slots=True)
class RecordingInfo:
    """What a recording says about itself."""

    started_ns: int  # Unix time of the start, ns
    clock: float  # the samples' clock at that moment, s: it ties their times to the calendar
    devices: tuple[DeviceInfo, ...] = ()
    tool: str = f"contactbench {__version__}"  # who wrote it
    note: str = ""

    @classmethod
    def now(cls, devices: Iterable[DeviceInfo] = (), note: str = "") -> RecordingInfo:
        """Return the description of a recording that starts now, on the host's monotonic clock."""
        return cls(time.time_ns(), time.monotonic(), tuple(devices), note=note)

    def topics(self, kind: DeviceKind) -> tuple[str, ...]:
        """Return the topics of one kind of samples; the usual one where no device names another."""
        named = tuple(dict.fromkeys(device.topic for device in self.devices if device.kind == kind))
        return named or ((WRENCH_TOPIC,) if kind == "wrench" else (FLANGE_TOPIC,))

    def log_time(self, moment: float) -> int:
        """
        Return the Unix time of a moment of the samples' clock, ns.

        Raises
        ------
        ValueError
            It is before 1970 or after 2200, or not a time.
        """
        since = moment - self.clock
        near = abs(since) < _CENTURIES and abs(moment) <= LATEST
        nanoseconds = self.started_ns + round(since * 1e9) if near else -1
        if not 0 <= nanoseconds < 2**63:
            raise ValueError(
                message(f"{arg(moment)} s on the samples' clock is no time near the start of the recording")
            )
        return nanoseconds


def about_record(info: RecordingInfo) -> dict[str, str]:
    """Return the metadata record that describes a recording."""
    return {
        "format": str(FORMAT),
        "tool": info.tool,
        "started_ns": str(info.started_ns),
        "clock": repr(float(info.clock)),
        "note": info.note,
    }


def device_record(device: DeviceInfo) -> dict[str, str]:
    """Return the metadata record that describes a device."""
    return {
        "kind": device.kind,
        "topic": device.topic,
        "address": device.address,
        "model": device.model,
        "serial": device.serial,
        "rate": "" if device.rate is None else repr(float(device.rate)),
    }


def read_about(values: Mapping[str, str]) -> RecordingInfo:
    """
    Return what a metadata record says.

    Raises
    ------
    KeyError, ValueError
        It is damaged.
    """
    started, clock = int(values["started_ns"]), float(values["clock"])
    if not 0 <= started < 2**63 or not abs(clock) <= LATEST:
        raise ValueError(message("the start is no time"))
    return RecordingInfo(started, clock, (), values["tool"], values["note"])


def read_device(values: Mapping[str, str]) -> DeviceInfo:
    """
    Return what a metadata record says.

    Raises
    ------
    KeyError, ValueError
        It is damaged.
    """
    kinds: dict[str, DeviceKind] = {known: known for known in get_args(DeviceKind)}
    if values["kind"] not in kinds:
        raise ValueError(message(f"no kind of device: {arg(values['kind'])!r}"))
    rate = float(values["rate"]) if values["rate"] else None
    if rate is not None and not 0 < rate < math.inf:
        raise ValueError(message(f"no rate: {arg(rate)}"))
    return DeviceInfo(
        kinds[values["kind"]], values["topic"], values["address"], values["model"], values["serial"], rate
    )
