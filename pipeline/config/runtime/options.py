"""What an export is given: options of the command, settings ``config.*`` of a session, and a file of settings."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, PrivateAttr, ValidationError
from pydantic_core import from_json

from contactbench.pipeline.config.runtime.build import Filters, RobotNames
from contactbench.pipeline.config.runtime.canonical import fault_of
from contactbench.pipeline.config.runtime.model import (
    ConfigPart,
    ControllerPart,
    GatesPart,
    KalmanPart,
    LimitsPart,
)
from contactbench.pipeline.config.runtime.mounts import Quaternion, mount_of_angles
from contactbench.pipeline.config.runtime.values import kalman_of
from contactbench.pipeline.contact.touch_model import WrenchNoise
from contactbench.pipeline.errors import ConfigError, InputError, arg
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.filtering import KalmanFilter, LowPass
from contactbench.pipeline.gates import Gates, GateSettings
from contactbench.pipeline.knobs import first_fault

_LARGEST = 2**20
KIND, SERIAL = "config", "devices.serial"


class ExportOptions(ExportKnobs):
    """What an export needs that neither a calibration nor a probe knows."""

    # Gains, as the part ``controller`` of a file that ``contactbench bench control tune`` writes
    controller: ControllerPart | None = None
    # Of a file of settings; of a simulated sensor, by axis
    _filters: Filters | None = PrivateAttr(None)
    _noise: WrenchNoise | None = PrivateAttr(None)

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> Self:
        """Return options; ConfigError, with the first that is wrong."""
        try:
            return cls.model_validate(dict(values))
        except ValidationError as error:
            where, what = first_fault(error)
            raise ConfigError(
                f"--{arg(where.replace('_', '-'))} ({arg(KIND)}.{arg(where)}): {arg(what)}: correct it."
            ) from None

    @classmethod
    def stored(cls, settings: Mapping[str, Any], given: Mapping[str, Any] | None = None) -> Self:
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
            A value is out of its range, or two contradict each other.
        """
        own = {
            key.removeprefix(f"{KIND}."): setting.value
            for key, setting in settings.items()
            if key.startswith(f"{KIND}.") and setting.value is not None
        }
        device = settings.get(SERIAL)
        if device is not None and device.value:
            own.setdefault("serial", device.value)
        options = cls.checked({**own, **(given or {})})
        if (options.noise_force is None) != (options.noise_torque is None):
            raise ConfigError("Give both --noise-force and --noise-torque, or neither.")
        return options

    def having(
        self, parts: Mapping[str, Any], filters: Filters | None = None, noise: WrenchNoise | None = None
    ) -> Self:
        """Return options in which what is given takes the place of their own."""
        made = self.model_copy(update=dict(parts))
        made._filters, made._noise = filters or self._filters, noise or self._noise
        return made

    @property
    def noise(self) -> WrenchNoise | None:
        """Of one reading; None: the scatter within the poses of the calibration, or else `WrenchNoise`'s own."""
        if self.noise_force is None or self.noise_torque is None:
            return self._noise
        return WrenchNoise(self.noise_force, self.noise_torque)

    def filters(self, rate: float) -> Filters:
        """Return the filters, at a rate in Hz unless a file says another."""
        return self._filters or Filters(
            None if self.no_filter else KalmanFilter(rate),
            None if self.cutoff is None else LowPass(self.cutoff, rate),
            adaptive=not self.paper_filter,
        )

    @property
    def gates(self) -> Gates:
        """The gates."""
        return Gates(**{name: getattr(self, name) for name in GateSettings.model_fields})

    @property
    def limits(self) -> LimitsPart:
        """What a controller must never exceed."""
        return LimitsPart(
            max_force_N=self.max_force,
            max_torque_Nm=self.max_torque,
            max_speed_mps=self.max_speed,
            max_turn_radps=self.max_turn,
        )

    @property
    def names(self) -> RobotNames:
        """What a robot description calls S, W and the sensor."""
        return RobotNames(self.sensor_frame, self.world_frame, self.sensor_name)

    @property
    def quaternion_ES(self) -> Quaternion | None:
        """(w, x, y, z); None: the one that the calibration was made with, if there is one."""
        return mount_of_angles(self.mount)


class _LowPass(ConfigPart):
    kind: Literal["lowpass"] = "lowpass"
    rate_Hz: Annotated[float, Field(gt=0, le=1e9)]
    cutoff_Hz: Annotated[float, Field(gt=0, le=1e9)]
    order: Annotated[int, Field(ge=1, le=8)] = 2


class _Filters(ConfigPart):
    wrench: KalmanPart | None
    location: _LowPass | None


class _Settings(ConfigPart):
    controller: ControllerPart | None = None
    limits: LimitsPart | None = None
    gates: dict[str, Any] | None = None
    filters: _Filters | None = None


def with_file(options: ExportOptions, data: bytes, name: str) -> ExportOptions:
    """
    Return settings in which the parts of a file take the place of their own.

    Parameters
    ----------
    options : ExportOptions
    data : bytes
        JSON.
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        It is no JSON, or a field is unknown, missing, of the wrong type or out of its range.
    """
    given = _read(data, name)
    try:
        return options.having(_parts(given, options.gates), _filters(given.filters))
    except ValidationError as error:  # of the gates, once they are whole
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: correct it.") from None
    except InputError as error:
        raise ConfigError(f"{arg(name)}: {arg(error)}") from None


def controller_in(data: bytes, name: str) -> ControllerPart:
    """
    Return the controller of a file of settings.

    Parameters
    ----------
    data, name
        As of `with_file`.

    Raises
    ------
    ConfigError
        As of `with_file`, or there is none.
    """
    given = _read(data, name)
    if given.controller is None:
        raise ConfigError(f"{arg(name)}: it contains no controller: choose the gains.json of control tune.")
    return given.controller


def _read(data: bytes, name: str) -> _Settings:
    if len(data) > _LARGEST:
        raise ConfigError(f"{arg(name)}: larger than {arg(_LARGEST >> 20)} MiB: choose a settings file.")
    try:
        return _Settings.model_validate(from_json(data, allow_inf_nan=False))
    except ValidationError as error:
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: correct it.") from None
    except ValueError as error:
        raise ConfigError(f"{arg(name)}: not valid JSON ({arg(str(error)[:100])}): correct it.") from None


def _parts(given: _Settings, gates: Gates) -> dict[str, Any]:
    parts: dict[str, Any] = {}
    if given.controller is not None:
        parts["controller"] = given.controller
    if given.limits is not None:
        limits = given.limits
        parts |= {"max_force": limits.max_force_N, "max_torque": limits.max_torque_Nm}
        parts |= {"max_speed": limits.max_speed_mps, "max_turn": limits.max_turn_radps}
    if given.gates is not None:
        said = GatesPart.model_validate({**gates.stored(), **given.gates})
        others = {"region_odds": gates.region_odds, "untouchable_odds": gates.untouchable_odds}
        parts |= dict(Gates.of_stored(said, **others))
    return parts


def _filters(given: _Filters | None) -> Filters | None:
    if given is None:
        return None
    location = given.location
    return Filters(
        None if given.wrench is None else kalman_of(given.wrench),
        None if location is None else LowPass(location.cutoff_Hz, location.rate_Hz, location.order),
        adaptive=given.wrench is None or given.wrench.kind == "adaptive",
    )
