"""An emulator by the name of a protocol."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.devices.emulate.emulator import LOG, Emulator
from contactbench.pipeline.devices.emulate.lines import DeviceLine, PtyLine, TcpServerLine, UdpServerLine
from contactbench.pipeline.devices.emulate.models import (
    BotaModel,
    ElfinModel,
    RdtModel,
    RobotiqModel,
    SriModel,
    UrModel,
)
from contactbench.pipeline.devices.emulate.script import EmulatorError
from contactbench.pipeline.devices.emulate.signals import SYNTHETIC, constant, sine
from contactbench.pipeline.devices.url import Carrier, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.devices.emulate.models import Model, Quirk
    from contactbench.pipeline.devices.emulate.script import Fault, Script
    from contactbench.pipeline.devices.emulate.signals import Signal, Six

_CARRIERS: dict[Protocol, tuple[Carrier, ...]] = {
    Protocol.SRI: (Carrier.SERIAL, Carrier.TCP),
    Protocol.BOTA: (Carrier.SERIAL,),
    Protocol.ROBOTIQ: (Carrier.SERIAL,),
    Protocol.RDT: (Carrier.UDP,),
    Protocol.ELFIN: (Carrier.TCP,),
    Protocol.UR: (Carrier.TCP,),
}
_MODELS: dict[Protocol, type[SriModel | BotaModel | RobotiqModel | ElfinModel]] = {
    Protocol.SRI: SriModel,
    Protocol.BOTA: BotaModel,
    Protocol.ROBOTIQ: RobotiqModel,
    Protocol.ELFIN: ElfinModel,
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
    quirks: Iterable[Quirk | str] = (),
    tool: Six | None = None,
    log: int = LOG,
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
    signal, script, seed, log
        As for `Emulator`; without a signal a constant one.
    profile : str
        Of RDT.
    quirks : iterable of Quirk
        What this one does and others of its kind do not.
    tool : six floats or None
        Of UR: the active tool frame in the flange frame, m and a rotation vector in rad; None: the flange.

    Raises
    ------
    EmulatorError
        There is no such device, carrier, port, quirk or fault.

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
    model = _model(kind, rate, profile, quirks, tool)
    if script is not None:
        script.check(model.faults, model.name)
    over = Carrier(carrier or carriers[0])
    # It has no page to ask for its counts, as an ATI sensor has.
    counts = "&cpf=1000000&cpt=1000000" if profile == "ati" else ""
    query = f"?profile={profile}{counts}" if kind is Protocol.RDT else ""
    return Emulator(
        model,
        _line(over, kind, port),
        f"{kind}+{over}",
        signal=signal or constant(JOINTS if kind in (Protocol.ELFIN, Protocol.UR) else SYNTHETIC),
        script=script,
        seed=seed,
        query=query,
        log=log,
    )


def _model(
    kind: Protocol, rate: float | None, profile: str, quirks: Iterable[Quirk | str], tool: Six | None
) -> Model:
    if tool is not None and kind is not Protocol.UR:
        raise EmulatorError(f"tool {tool}: {kind} has none: leave it out.")
    if kind is Protocol.RDT:
        return RdtModel(rate, profile, quirks)
    if kind is Protocol.UR:
        return UrModel(rate, quirks, tool=tool or (0.0,) * 6)
    return _MODELS[kind](rate, quirks)


def swinging(protocol: Protocol | str) -> Signal:
    """Return a signal to look at: a slow sine of each channel about the constant one."""
    if protocol in (Protocol.ELFIN, Protocol.UR):
        return sine((0.2,) * 6, 0.2, JOINTS)
    return sine((5.0, 5.0, 5.0, 0.2, 0.2, 0.2), 0.5, SYNTHETIC)


def possible_faults(protocol: Protocol | str) -> frozenset[Fault]:
    """Return the faults that the emulated device of a protocol can have."""
    kind = Protocol(protocol)
    if kind is Protocol.RDT:
        return RdtModel.faults
    return UrModel.faults if kind is Protocol.UR else _MODELS[kind].faults


def _line(carrier: Carrier, protocol: Protocol, port: int) -> DeviceLine:
    if carrier is Carrier.SERIAL:
        return PtyLine(protocol.value)
    return UdpServerLine(port) if carrier is Carrier.UDP else TcpServerLine(port)
