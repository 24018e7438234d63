"""The emulated devices, one per protocol, without their lines."""

from contactbench.pipeline.devices.emulate.models.bota import BotaModel, bota_frame
from contactbench.pipeline.devices.emulate.models.elfin import ElfinModel
from contactbench.pipeline.devices.emulate.models.model import Model, Quirk
from contactbench.pipeline.devices.emulate.models.rdt import RdtModel, rdt_record
from contactbench.pipeline.devices.emulate.models.robotiq import RobotiqModel, robotiq_frame
from contactbench.pipeline.devices.emulate.models.sri import SriModel, sri_frame
from contactbench.pipeline.devices.emulate.models.ur import UrModel, rtde_packet

__all__ = [
    "BotaModel",
    "ElfinModel",
    "Model",
    "Quirk",
    "RdtModel",
    "RobotiqModel",
    "SriModel",
    "UrModel",
    "bota_frame",
    "rdt_record",
    "robotiq_frame",
    "rtde_packet",
    "sri_frame",
]
