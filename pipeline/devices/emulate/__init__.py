"""Wire-exact emulated devices on real lines, with scripted faults."""

from contactbench.pipeline.devices.emulate.emulator import Emulator, Sent
from contactbench.pipeline.devices.emulate.making import EMULATED, JOINTS, emulator, possible_faults, swinging
from contactbench.pipeline.devices.emulate.models import Quirk
from contactbench.pipeline.devices.emulate.script import EmulatorError, Fault, FaultEvent, Script
from contactbench.pipeline.devices.emulate.signals import (
    SYNTHETIC,
    Moment,
    Reading,
    Signal,
    Six,
    constant,
    recorded,
    sine,
)

__all__ = [
    "EMULATED",
    "JOINTS",
    "SYNTHETIC",
    "Emulator",
    "EmulatorError",
    "Fault",
    "FaultEvent",
    "Moment",
    "Quirk",
    "Reading",
    "Script",
    "Sent",
    "Signal",
    "Six",
    "constant",
    "emulator",
    "possible_faults",
    "recorded",
    "sine",
    "swinging",
]
