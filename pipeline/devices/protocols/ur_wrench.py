"""
A UR's own force/torque sensor, over RTDE.

``ft_raw_wrench`` is the measurement without the controller's zero and payload, N and N·m; ``actual_TCP_force`` has both
taken off, and so is no use here. Source: Universal Robots, "Real-Time Data Exchange (RTDE) Guide", robot controller
outputs. Only robots with a sensor in the flange (e-Series, UR20, UR30) have one; an older controller says NOT_FOUND,
which ends the connection with the reason.
"""

from contactbench.pipeline.devices.protocols import ur_rtde
from contactbench.pipeline.devices.protocols.commands import Command, check_rate
from contactbench.pipeline.devices.protocols.parser import Counters, SensorDriver, SensorParser
from contactbench.pipeline.devices.protocols.ur_rtde import OutputRecipe, PacketKind, PacketReader, RtdeError
from contactbench.pipeline.devices.sample import WrenchSample

CLOCK, WRENCH = "timestamp", "ft_raw_wrench"
VARIABLES = (CLOCK, WRENCH)
_TYPES = b"DOUBLE,VECTOR6D"
_ABSURD = 1e5  # N or N·m


class UrWrenchParser(SensorParser):
    """For data packets of a clock and a raw wrench; it raises RtdeError where the controller has none."""

    def __init__(self) -> None:
        self._reader = PacketReader()
        self._recipe: OutputRecipe | None = None
        self._frames = self._refused = self._duplicates = 0
        self._last: float | None = None

    @property
    def pending(self) -> int:  # type: ignore[override]
        """Bytes that wait for the rest of their packet."""
        return self._reader.pending

    @property
    def counters(self) -> Counters:
        """As `Parser`; what is no data of the recipe counts as a bad checksum."""
        return Counters(
            frames=self._frames,
            bad_checksums=self._refused,
            skipped_bytes=self._reader.skipped_bytes,
            duplicates=self._duplicates,
        )

    def reset(self) -> None:
        """As `Parser`; the recipe is agreed anew."""
        self._reader.reset()
        self._recipe, self._last = None, None

    def feed(self, data: bytes, time: float) -> list[WrenchSample]:
        """
        As `Parser`.

        Raises
        ------
        RtdeError
            The controller does not have the wrench.
        """
        samples = []
        for packet in self._reader.feed(data):
            if packet.kind is PacketKind.OUTPUTS:
                self._recipe = OutputRecipe.agreed(packet, VARIABLES)
            elif packet.kind is PacketKind.DATA and (sample := self._sample(packet, time)) is not None:
                samples.append(sample)
        return samples

    def _sample(self, packet: ur_rtde.Packet, time: float) -> WrenchSample | None:
        try:
            values = {} if self._recipe is None else self._recipe.values(packet)
        except RtdeError:
            values = {}
        wrench, clock = values.get(WRENCH, ()), values.get(CLOCK, ())
        if len(wrench) != 6 or len(clock) != 1 or max(map(abs, wrench)) > _ABSURD:
            self._refused += 1
            return None
        self._frames += 1
        if clock[0] == self._last:
            self._duplicates += 1
            return None
        self._last = clock[0]
        fx, fy, fz, mx, my, mz = wrench
        return WrenchSample(time, (fx, fy, fz), (mx, my, mz), device_time=clock[0])


def wrench_driver(rate_hz: float) -> SensorDriver:
    """
    Return what streams the raw wrench.

    Raises
    ------
    ProtocolError
        The rate is not one that the controller can have.
    """
    rate = check_rate("UR", rate_hz, ur_rtde.LOWEST_RATE, ur_rtde.HIGHEST_RATE)
    start = (
        Command(ur_rtde.version_request(), ur_rtde.packet(PacketKind.VERSION, b"\x01")),
        Command(ur_rtde.outputs_request(rate, VARIABLES), _TYPES),
        Command(ur_rtde.start_request(), ur_rtde.packet(PacketKind.START, b"\x01")),
    )
    return SensorDriver(UrWrenchParser(), start, (Command(ur_rtde.pause_request()),), rate)
