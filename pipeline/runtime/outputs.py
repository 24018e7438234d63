"""
The outputs of ``contactbench run``, each declared once.

The command takes its options from here, the window its rows, the documentation its table.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module

from contactbench.pipeline.errors import RunError, arg, message
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.runtime.outlet import OutletTarget, OutputContext


@dataclass(frozen=True)
class Output:
    """Where contacts can go."""

    name: str
    """Of its option, and in a session's settings."""
    target: str
    """Module in this package, and what it has that opens the output: called with an address and `OutputContext`."""
    metavar: str
    """How an address is written."""
    text: str
    """What it does, one sentence."""
    title: str = ""
    """Its row in the window; empty: only the command has it."""
    usual: str = ""
    """The address that the window offers."""
    extra: str = ""
    """The extra that installs the package it needs; empty: none."""
    effort: float = 0.0
    """Processor time of a contact, in those of `contact_schema`: a measure of how fast Python is here."""

    @property
    def help(self) -> str:
        """Help of its option."""
        return f"{self.text.removesuffix('.')} (extra {self.extra})." if self.extra else self.text

    def open(self, address: str, context: OutputContext) -> OutletTarget:
        """
        Open it; the package that it needs is imported only now.

        Raises
        ------
        RunError
            It is no address, one on other machines without leave, or in use; or the package is not installed.
        OutputError
            Its file exists, or cannot be made.
        """
        module, _, maker = self.target.partition(":")
        try:
            made = getattr(import_module(f"contactbench.pipeline.runtime.{module}"), maker)
        except ModuleNotFoundError as error:
            package = (error.name or "").partition(".")[0]
            raise RunError(
                f"--{arg(self.name)} needs {arg(package)}, which is not installed: {arg(remedy(self.extra))}."
            ) from error
        target: OutletTarget = made(address, context)
        return target


OUTPUTS = {
    each.name: each
    for each in (
        Output(
            "igtl",
            "igtl_target:IgtlTarget",
            "HOST:PORT",
            message("Serve contacts there to OpenIGTLink clients, such as 3D Slicer."),
            title=message("OpenIGTLink (3D Slicer)"),
            usual="127.0.0.1:18944",
            effort=3.0,
        ),
        Output(
            "foxglove",
            "foxglove_target:FoxgloveTarget",
            "HOST:PORT",
            message("Serve contacts and a picture there to Foxglove."),
            title="Foxglove",
            usual="127.0.0.1:8765",
            extra="live",
            effort=1.8,
        ),
        Output(
            "dds",
            "dds_target:DdsTarget",
            "DOMAIN",
            message("Publish contacts in this DDS domain, and wrenches that ROS 2 takes."),
            title=message("ROS 2, DDS domain"),
            usual="0",
            extra="live",
            effort=3.0,
        ),
        Output(
            "mqtt",
            "mqtt_target:MqttTarget",
            "HOST:PORT/TOPIC",
            message("Publish contacts to this MQTT broker."),
            title=message("MQTT broker and topic"),
            usual="127.0.0.1:1883/contactbench",
            extra="live",
            effort=5.0,
        ),
        Output(
            "udp",
            "targets:UdpTarget",
            "HOST:PORT",
            message("Send each contact there as a UDP datagram."),
            title="UDP",
            usual="127.0.0.1:9000",
            effort=2.7,
        ),
        # Files come last: one that is made although another output cannot be opened would be in the way.
        Output(
            "out", "targets:line_target", "FILE|-", message("New file for the lines; - is standard output.")
        ),
        Output("mcap", "targets:McapTarget", "PATH", message("New MCAP file for the contacts.")),
    )
}
"""By name, in the order in which they are listed and opened."""


def open_outputs(addresses: Mapping[str, str], context: OutputContext) -> dict[str, OutletTarget]:
    """
    Open outputs, in the order of `OUTPUTS`: all of them or none; by name.

    Parameters
    ----------
    addresses : mapping
        By the names of outputs.
    context : OutputContext

    Raises
    ------
    RunError, OutputError
        As `Output.open`.
    """
    targets: dict[str, OutletTarget] = {}
    try:
        for name, output in OUTPUTS.items():
            if name in addresses:
                targets[name] = output.open(addresses[name], context)
    except BaseException:
        for target in targets.values():
            target.close()
        raise
    return targets
