"""The outputs that other programs connect to or are sent, by the option that asks for one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.runtime.errors import RunError

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.recording import RecordingInfo
    from contactbench.pipeline.runtime.outlet import OutletTarget

    Open = Callable[[str, RuntimeConfig, RecordingInfo, bool], OutletTarget]


def network_target(
    option: str, address: str, config: RuntimeConfig, about: RecordingInfo, *, remote: bool = False
) -> OutletTarget:
    """
    Open one output; the package that it needs is imported only now.

    Parameters
    ----------
    option : str
        One of `NETWORK_TARGETS`.
    address : str
        As the option's help says.
    config : RuntimeConfig
        Its probe is shown where an output has a picture.
    about : RecordingInfo
        Ties the samples' clock to the calendar.
    remote : bool
        Whether other machines may take part: nothing is encrypted or signed.

    Raises
    ------
    RunError
        It is no address, one on other machines without leave, or in use; or the extra ``live`` is not installed.
    """
    try:
        return NETWORK_TARGETS[option](address, config, about, remote)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        raise RunError(
            f"--{arg(option)} needs {arg(package)}, which is not installed: {arg(remedy('live'))}."
        ) from error


def _udp(address: str, _config: RuntimeConfig, _about: RecordingInfo, remote: bool) -> OutletTarget:
    from contactbench.pipeline.runtime.targets import UdpTarget

    return UdpTarget(address, remote=remote)


def _igtl(address: str, _config: RuntimeConfig, about: RecordingInfo, remote: bool) -> OutletTarget:
    from contactbench.pipeline.runtime.igtl_target import IgtlTarget

    return IgtlTarget(address, about, remote=remote)


def _foxglove(address: str, config: RuntimeConfig, about: RecordingInfo, remote: bool) -> OutletTarget:
    from contactbench.pipeline.runtime.foxglove_target import FoxgloveTarget

    return FoxgloveTarget(address, config.probe, about, remote=remote)


def _dds(domain: str, _config: RuntimeConfig, about: RecordingInfo, remote: bool) -> OutletTarget:
    from contactbench.pipeline.runtime.dds_target import DdsTarget

    return DdsTarget(domain, about, remote=remote)


def _mqtt(address: str, _config: RuntimeConfig, about: RecordingInfo, remote: bool) -> OutletTarget:
    from contactbench.pipeline.runtime.mqtt_target import MqttTarget

    return MqttTarget(address, about, remote=remote)


NETWORK_TARGETS: dict[str, Open] = {
    "udp": _udp,
    "igtl": _igtl,
    "foxglove": _foxglove,
    "dds": _dds,
    "mqtt": _mqtt,
}
