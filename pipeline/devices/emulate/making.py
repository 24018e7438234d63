"""An emulator by the name of a protocol."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pipeline.devices.emulate.emulator import Emulator
from pipeline.devices.emulate.lines import DeviceLine, PtyLine, TcpServerLine, UdpServerLine
from pipeline.devices.emulate.models import BotaModel, ElfinModel, RdtModel, RobotiqModel, SriModel, UrModel
from pipeline.devices.emulate.script import EmulatorError
from pipeline.devices.emulate.signals import SYNTHETIC, constant, sine
from pipeline.devices.url import Carrier, Protocol

if TYPE_CHECKING:
    from pipeline.devices.emulate.models import Model
    from pipeline.devices.emulate.script import Fault, Script
    from pipeline.devices.emulate.signals import Signal, Six

_CARRIERS: dict[Protocol, tuple[Carrier, ...]] = {
    Protocol.SRI: (Carrier.SERIAL, Carrier.TCP),
    Protocol.BOTA: (Carrier.SERIAL,),
    Protocol.ROBOTIQ: (Carrier.SERIAL,),
    Protocol.RDT: (Carrier.UDP,),
    Protocol.ELFIN: (Carrier.TCP,),
    Protocol.UR: (Carrier.TCP,),
}
_MODELS: dict[Protocol, type[SriModel | BotaModel | RobotiqModel | RdtModel | ElfinModel | UrModel]] = {
    Protocol.SRI: SriModel,
    Protocol.BOTA: BotaModel,
    Protocol.ROBOTIQ: RobotiqModel,
    Protocol.RDT: RdtModel,
    Protocol.ELFIN: ElfinModel,
    Protocol.UR: UrModel,
}
EMULATED = tuple(_CARRIERS)
JOINTS: Six = (0.3, -0.4, 1.1, 0.5, -0.7, 0.9)
"""Where an emulated robot stands unless it is told otherwise, rad."""


def emulator(
    protocol: Protocol | str,
    carrier: Carrier | str | None = None,
    *,
    port: int = 0,
    rate: float | None = None,
    signal: Signal | None = None,
    script: Script | None = None,
    seed: int = 0,
    profile: str = "ati",
) -> Emulator:
    """Make an emulated device, not yet started.

    Parameters
    ----------
    protocol : Protocol
    carrier : Carrier or None
        The protocol's first one if none is given.
    port : int
        Of TCP and UDP, on the loopback interface; 0: any free one.
    rate : float or None
        Frames per second until a command changes it.
    signal, script, seed
        As for `Emulator`; without a signal a constant one.
    profile : str
        Of RDT.

    Raises
    ------
    EmulatorError
        There is no such device, carrier, port or fault.

    Examples
    --------
    >>> with emulator("sri", "tcp") as device:
    ...     device.url.startswith("sri+tcp://127.0.0.1:")
    True
    """
    if protocol not in list(EMULATED):
        raise EmulatorError(f"device {str(protocol)!r}: there are {', '.join(EMULATED)}.")
    kind = Protocol(protocol)
    carriers = _CARRIERS[kind]
    if carrier is not None and carrier not in list(carriers):
        raise EmulatorError(f"{kind} over {carrier}: it speaks over {', '.join(carriers)}.")
    model: Model = RdtModel(rate, profile) if kind is Protocol.RDT else _MODELS[kind](rate)
    if script is not None:
        script.check(model.faults, model.name)
    over = Carrier(carrier or carriers[0])
    query = f"?profile={profile}" if kind is Protocol.RDT else ""
    return Emulator(
        model,
        _line(over, kind, port),
        f"{kind}+{over}",
        signal=signal or constant(JOINTS if kind in (Protocol.ELFIN, Protocol.UR) else SYNTHETIC),
        script=script,
        seed=seed,
        query=query,
    )


def swinging(protocol: Protocol | str) -> Signal:
    """Return a signal to look at: a slow sine of each channel about the constant one."""
    if protocol in (Protocol.ELFIN, Protocol.UR):
        return sine((0.2,) * 6, 0.2, JOINTS)
    return sine((5.0, 5.0, 5.0, 0.2, 0.2, 0.2), 0.5, SYNTHETIC)


def possible_faults(protocol: Protocol | str) -> frozenset[Fault]:
    """Return the faults that the emulated device of a protocol can have."""
    return _MODELS[Protocol(protocol)].faults


def _line(carrier: Carrier, protocol: Protocol, port: int) -> DeviceLine:
    if carrier is Carrier.SERIAL:
        return PtyLine(protocol.value)
    return UdpServerLine(port) if carrier is Carrier.UDP else TcpServerLine(port)
