"""A tracked body as the source of poses: an optical or magnetic tracker that serves OpenIGTLink."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.devices.protocols.igtl_pose import BodyStream
from contactbench.pipeline.devices.reconnecting_stream import ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.transport import line_to
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.devices.protocols import Counters
    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.devices.transport import Line
    from contactbench.pipeline.devices.url import DeviceAddress

_GUESSED_HZ = 30.0  # trackers give 20 to 250 poses a second


class TrackerPoses(ReconnectingStream[FlangeSample]):
    """
    One body's poses. The body plays the flange, and the tracker the robot's base.

    Without a rate in the address nothing is sent: the server is expected to stream. With one, QTDATA is asked for.

    Parameters
    ----------
    address : DeviceAddress
        Its ``device`` names the body.
    on_samples, on_change
        As for `ReconnectingStream`.
    """

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: Callable[[Sequence[FlangeSample]], None],
        on_change: Callable[[Health], None] | None = None,
        *,
        line: Line | None = None,
    ) -> None:
        self._bodies = BodyStream(address.options["device"])
        self._clock = SampleClock(address.rate)
        watch = Watch(address.rate or _GUESSED_HZ, rate_known=address.rate is not None)
        super().__init__(address, line or line_to(address), watch, on_samples, on_change)

    def _begin(self) -> None:
        self._bodies.reset()
        if self.address.rate is not None:
            self._line.write(igtl.start_qtdata(self.address.rate))

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        return self._clock.stamp(self._bodies.feed(data, arrived))

    def _end(self) -> None:
        if self.address.rate is not None:
            self._line.write(igtl.pack(igtl.STOP_QTDATA, "", 0, b""))

    def _reset(self) -> None:
        self._bodies.reset()
        self._clock.forget()

    def _counters(self) -> Counters:
        return self._bodies.counters

    def _troubles(self) -> dict[str, str]:
        if self._bodies.trouble:
            return {"pose": self._bodies.trouble}
        wanted, names = self.address.options["device"], self._bodies.names
        if wanted is None or not names or wanted in names:
            return {}
        return {
            "body": message(
                f"The server sends no body {arg(wanted)!r}, only {arg(', '.join(names))}: correct ?device="
                " in the address, or bring the body in sight."
            )
        }
