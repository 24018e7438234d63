"""What a person says of an export, as plain values: options of the command, and settings ``config.*`` of a session."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from contactbench.pipeline.config.runtime.build import RobotNames
from contactbench.pipeline.config.runtime.errors import ConfigError
from contactbench.pipeline.config.runtime.model import ControllerPart, LimitsPart
from contactbench.pipeline.config.runtime.mounts import mount_of_angles
from contactbench.pipeline.contact import Gates, WrenchNoise
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.pipeline.config.runtime.bench import ExportSettings

KIND, SERIAL = "config", "devices.serial"
_GIVE_PAIR = message("Give both --noise-force and --noise-torque, or neither.")

_Number = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]
_Positive = Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)]
_Arm = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)]
_Name = Annotated[str, Field(min_length=1, max_length=200)]
_Three = tuple[_Number, _Number, _Number]
_Six = tuple[_Positive, _Positive, _Positive, _Positive, _Positive, _Positive]


class ExportOptions(BaseModel):
    """As the options of ``contactbench bundle export``; None: what the session or the files know."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    sensor: _Name = "unknown"  # Its model
    serial: _Name | None = None
    rate: _Positive | None = None  # Readings a second, Hz
    mount: _Three | None = None  # Angles of the sensor in the flange about the fixed x, y, z, degrees
    # Standard deviation of one reading, N and N·m; both or none
    noise_force: _Positive | None = None
    noise_torque: _Positive | None = None
    cutoff: _Positive | None = None  # Low-pass of the contact point, Hz
    no_filter: bool = False  # The wrench is left unfiltered
    saturation: _Six | None = None  # Where the channels end, N and N·m
    region_only: bool = False  # Contacts outside every region are refused
    accept_by_region: bool = True  # Contacts that are sure only because of the regions are accepted
    torsion_arm_mm: _Arm = 1.0  # Usual local torque over the force
    # What a controller must never exceed, N and N·m
    max_force: _Positive = 30.0
    max_torque: _Positive = 3.0
    # Gains, as the part ``controller`` of a file that ``contactbench bench control tune`` writes
    controller: ControllerPart | None = None
    # S, W and the sensor, as the robot description names them; without the last ``ros2.yaml`` has a placeholder
    sensor_frame: _Name = "ft_sensor"
    world_frame: _Name = "base_link"
    sensor_name: _Name | None = None
    operator: _Name | None = None  # Who is answerable

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> ExportOptions:
        """Return options; ConfigError, with the first that is wrong."""
        try:
            return cls.model_validate(dict(values))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            where = ".".join(map(str, first["loc"])) or "options"
            raise ConfigError(
                f"--{arg(where.replace('_', '-'))} ({arg(KIND)}.{arg(where)}): {arg(first['msg'])}: correct it."
            ) from None

    @classmethod
    def stored(cls, settings: Mapping[str, Any], given: Mapping[str, Any] | None = None) -> ExportOptions:
        """
        Return what a session's settings say, and what was given instead.

        Parameters
        ----------
        settings : mapping
            Key -> object with the attribute ``value``, as `State.settings`; null is as if it was never set. Of keys
            that are not ``config.*`` only the device's serial number counts.
        given : mapping, optional
            Option -> value that counts more.

        Raises
        ------
        ConfigError
            A value is out of its range.
        """
        own = {
            key.removeprefix(f"{KIND}."): setting.value
            for key, setting in settings.items()
            if key.startswith(f"{KIND}.") and setting.value is not None
        }
        device = settings.get(SERIAL)
        if device is not None and device.value:
            own.setdefault("serial", device.value)
        return cls.checked({**own, **(given or {})})

    def settings(self) -> ExportSettings:
        """Return them as an export takes them; ConfigError where two contradict each other."""
        from contactbench.pipeline.config.runtime.bench import ExportSettings

        noise = None
        if (self.noise_force is None) != (self.noise_torque is None):
            raise ConfigError(_GIVE_PAIR)
        if self.noise_force is not None and self.noise_torque is not None:
            noise = WrenchNoise(self.noise_force, self.noise_torque)
        gates = Gates(region_only=self.region_only, accept_by_region=self.accept_by_region)
        if self.saturation is not None:
            gates = replace(gates, saturation=self.saturation)
        return ExportSettings(
            sensor=self.sensor,
            serial=self.serial,
            rate=self.rate,
            noise=noise,
            smoothed=not self.no_filter,
            cutoff=self.cutoff,
            mount=mount_of_angles(self.mount),
            gates=gates,
            torsion_arm=self.torsion_arm_mm / 1e3,
            limits=LimitsPart(
                max_force_N=self.max_force,
                max_torque_Nm=self.max_torque,
                max_speed_mps=None,
                max_turn_radps=None,
            ),
            controller=self.controller,
            operator=self.operator,
            names=RobotNames(self.sensor_frame, self.world_frame, self.sensor_name),
        )
