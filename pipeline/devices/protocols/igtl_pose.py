"""One tracked body of an OpenIGTLink server as flange samples, and an emulated tracker that serves one."""

import struct
from collections.abc import Iterable, Mapping
from typing import ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.options import Option
from contactbench.pipeline.devices.options import name as read_name
from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.devices.protocols.device_model import WIRE_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.igtl import IgtlError, MessageReader
from contactbench.pipeline.devices.protocols.parser import Counters, Parser
from contactbench.pipeline.devices.reconnecting_stream import ParsedPoses, ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.stream import OnChange, OnFlanges
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import arg, message

_MOST_NAMES = 20
_GUESSED_HZ = 30.0  # trackers give 20 to 250 poses a second


class BodyStream(Parser[FlangeSample]):
    """
    Bytes of a server to poses of one body, which plays the flange: E is the body, the base B is the tracker.

    Parameters
    ----------
    body : str or None
        Its name; None: the server's only one.

    Attributes
    ----------
    names : list of str
        Bodies heard of, at most twenty.
    """

    def __init__(self, body: str | None = None) -> None:
        self._body = body
        self._reader = MessageReader()
        self._refused = self._repeated = 0
        self._stamp: float | None = None
        self.names: list[str] = []
        self._trouble = ""

    @property
    def counters(self) -> Counters:
        """What was seen so far; a pose that is none counts as damaged."""
        seen = self._reader.counters
        return Counters(
            frames=seen.frames,
            bad_checksums=seen.bad_checksums + self._refused,
            skipped_bytes=seen.skipped_bytes,
            duplicates=self._repeated,
        )

    @property
    def pending(self) -> int:  # type: ignore[override]
        """Bytes that wait for the rest of their message."""
        return self._reader.pending

    def begin(self) -> None:
        """As `Parser`: half a message may be one that is never completed."""
        self.reset()

    def reset(self) -> None:
        """Forget half a message, after the line was lost."""
        self._reader.reset()
        self._stamp, self._trouble = None, ""

    def feed(self, data: bytes, time: float) -> list[FlangeSample]:
        """
        Take bytes as they arrive, cut anywhere.

        A message with the time stamp of the one before is the same measurement again, and dropped.

        Parameters
        ----------
        data : bytes
            Any bytes: what is no message is skipped and counted.
        time : float
            When the last of them arrived, seconds of the host's monotonic clock.

        Raises
        ------
        IgtlError
            The server has several bodies, and none was chosen.
        """
        samples: list[FlangeSample] = []
        for packet in self._reader.feed(data):
            try:
                poses = igtl.poses_of(packet)
            except IgtlError as error:
                self._trouble = str(error)
                self._refused += 1
                continue
            for pose in poses:
                if not self._is_wanted(pose.body):
                    continue
                self._trouble = ""
                if packet.time is not None and packet.time == self._stamp:
                    self._repeated += 1
                    continue
                self._stamp = packet.time
                samples.append(FlangeSample(time, pose.R_TB, pose.p_TB_T, device_time=packet.time))
        return samples

    def troubles(self) -> dict[str, str]:
        """Return why the last pose that came is none, or that the body was not heard of, by kind."""
        if self._trouble:
            return {"pose": self._trouble}
        if self._body is None or not self.names or self._body in self.names:
            return {}
        return {
            "body": message(
                f"The server sends no body {arg(self._body)!r}, only {arg(', '.join(self.names))}: correct"
                " ?device= in the address, or bring the body in sight."
            )
        }

    def _is_wanted(self, name: str) -> bool:
        if name not in self.names and len(self.names) < _MOST_NAMES:
            self.names.append(name)
        if self._body is None and len(self.names) > 1:
            raise IgtlError(
                f"OpenIGTLink: the server sends several bodies ({arg(', '.join(self.names))}): add ?device=NAME to the"
                " address."
            )
        return self._body in (None, name)


# ---- emulated: a tracker that streams one body ---------------------------------------------------

BODY = "Probe"
"""The body of an emulated tracker."""


class IgtlModel(Model):
    """A tracker; its signal is the body's position (m) and orientation (rotation vector, rad) in the tracker's frame.

    It sends TRANSFORM by itself, and QTDATA once it is asked for that.
    """

    name = "igtl"
    rest: ClassVar[Six] = (0.1, -0.2, 0.9, 0.3, -0.4, 1.1)
    swing: ClassVar[Six] = (0.02, 0.02, 0.02, 0.2, 0.2, 0.2)
    swing_hz = 0.2
    own_rate = 60.0
    faults = WIRE_FAULTS | {Fault.WRONG_RATE, Fault.CLOCK_JUMP}

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._lists = False
        self.streaming = True

    def restart(self) -> None:
        """Come up again, and stream at once."""
        super().restart()
        self._lists = False
        self.streaming = True

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one message; its clock begins in November 2023."""
        R, p = Rotation.from_rotvec(reading.values[3:]).as_matrix(), np.array(reading.values[:3])
        stamp = 1_700_000_000_000_000_000 + round(1e9 * moment.clock)
        if self._lists:
            content = igtl.listed(BODY, igtl.quaternion_pose(R, p))
            return igtl.pack(igtl.QTDATA, "Tracker", stamp, content)
        return igtl.pack(igtl.TRANSFORM, BODY, stamp, igtl.transform(R, p))

    def _step(self) -> list[bytes]:
        whole = igtl.first_message(self._pending)
        if whole is None:
            return []
        kind, size = whole
        packet = self._take(size)
        if kind == igtl.START_QTDATA and size == len(igtl.start_qtdata(1.0)):
            self.rate = 1e3 / max(1, struct.unpack_from(">i", packet, size - 36)[0])
            self._lists = True
            self._obey(packet)
            return [igtl.pack(igtl.ANSWER_QTDATA, "Tracker", 0, b"\0")]
        if kind == igtl.STOP_QTDATA:
            self._lists = False
            self._obey(packet)
            return []
        self._refuse(packet)
        return []


class IgtlDriver(Driver):
    """A tracker that serves OpenIGTLink."""

    scheme, title = "igtl", message("OpenIGTLink tracker")
    ways = (Way(Carrier.TCP, port=18_944),)
    options: ClassVar[Mapping[str, Option]] = {
        "device": Option("Name of the tracked body, where the server sends several.", read_name)
    }
    emulated = IgtlModel

    def poses(
        self, address: DeviceAddress, on_samples: OnFlanges, on_change: OnChange = None
    ) -> ReconnectingStream[FlangeSample]:
        """As `Driver`."""
        rate = address.rate  # without one the server is expected to stream
        return ParsedPoses(
            address,
            BodyStream(address.options["device"]),
            on_samples,
            on_change,
            start=b"" if rate is None else igtl.start_qtdata(rate),
            stop=b"" if rate is None else igtl.pack(igtl.STOP_QTDATA, "", 0, b""),
            guess=_GUESSED_HZ,
        )
