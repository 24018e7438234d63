"""Files for the programs that compensate gravity, each in the consumer's own convention.

This is the project's convention, which the exports translate (S sensor, W world, SI):

    F = R_SW g_W + F0,    M = L_S x (R_SW g_W) + M0

``ros2_control``: names, types and formulas as in the sources of ros2_controllers from 4.16.0 to the releases in
`CHECKED`, and of kinematics_interface with its KDL plugin as of 2025. The broadcaster has offsets from 4.16.0 on and
multipliers from 4.25.0 on; an older one ignores them. ``docs/ros.md`` has the table of releases.

``force_torque_tools`` (KTH, ROS 1): as in the sources behind release 1.2 (2018) and those of May 2021, which negate the
imu reading. ``ft_tools_ros2`` (University of Strasbourg): as in the sources of September 2025. Both pick their own keys
from one file.

The text is YAML 1.1 in ASCII. Every number carries a decimal point, every string is quoted: ROS 2 refuses an
int where it wants a double, and a list that mixes the two.

ros2_control takes a weight along z of W, and nothing else. Of a robot that stands it is positive, of one that hangs
negative; on a wall or a tilted base there is no such weight, and the admittance controller's part is left out.
The other two are given the vector, whatever way is down.
"""

from __future__ import annotations

import re
import textwrap
from typing import TYPE_CHECKING

import numpy as np

from contactbench import __version__
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    DOWN_W,
    FORCE_BIAS,
    GRAVITY,
    STANDARD_GRAVITY,
    TORQUE_BIAS,
    GravityModel,
    length,
)
from contactbench.pipeline.config.vertical import down_along_z, residual_of, vertical_residual
from contactbench.pipeline.errors import InputError, arg, capitalised, message

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.config.vertical import VerticalResidual

# Of ros2_controllers, for Jazzy, Kilted, and Lyrical and Rolling: read, not run.
CHECKED = ("4.42.1", "5.17.0", "6.9.0")

# What every version of tf, the robot description and a YAML string in quotes agree upon. tf2 refuses a
# leading slash.
_FRAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.\-]*(/[A-Za-z0-9_.\-]+)*", re.ASCII)
_NODE = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)
# Node names are keys; these would be read as a truth value or as nothing.
_YAML_WORDS = {"y", "n", "yes", "no", "on", "off", "true", "false", "null"}
_LONGEST = 200
_FT_TOOLS_GRAVITY = 9.81  # m/s², of ft_tools_ros2
_MOST_BYTES, _MOST_NUMBER = 2**16, 1e6
_AGAIN = message("calibrate with that tool again, or use the file as it wrote it.")
_NOT_GIVEN = message("(not given)")  # no name: the bracket is none of its characters


def ros2_yaml(
    model: GravityModel,
    *,
    sensor_frame: str,
    world_frame: str,
    sensor_name: str | None = None,
    broadcaster: str = "force_torque_sensor_broadcaster",
    admittance: str = "admittance_controller",
    down_W: ArrayLike = DOWN_W,
) -> str:
    """Return parameters for ros2_control's force_torque_sensor_broadcaster and admittance_controller.

    The broadcaster publishes ``(reading + offset) * multiplier``, axis by axis: the offset is minus the bias.

    The admittance controller removes no bias. It rotates the reading into its fixed world frame and
    subtracts a weight that points along -z there; in the sensor frame, with ``w = (0, 0, -CoG.force)``:

        F - R_SW w,    M - pos x (R_SW w)

    Then it smooths, by ``ft_sensor.filter_coefficient``, which is not written here. ``CoG.pos`` is only
    rotated, by the rotation of ``gravity_compensation.frame.id``; that frame's origin plays no part, so the
    position counts from where the torque counts, the sensor origin. The frame written is therefore the
    sensor's own. (``external``, seen in old example files, is no parameter.)

    ``fixed_world_frame`` has to be a link of the kinematics chain. It enters as the rotation that forward
    kinematics gives for it, R_BW, where R_WB is meant. Both are the identity when it is the base B of the
    chain itself, which is why the file recommends that; turned about the vertical or by half a turn, it
    works too. Where W hangs upside down, its base stays the frame, and ``CoG.force`` is negative. Where down is
    not along z of W, the part of the admittance controller is left out: no frame makes its formula right.

    Parameters
    ----------
    model : GravityModel
    sensor_frame : str
        Frame S that the readings are in, as the robot description names it.
    world_frame : str
        Frame W, against which the calibration's orientations were given.
    sensor_name : str, optional
        The sensor as the ros2_control tag of the robot description names it. The broadcaster reads it, and does
        not start without; the admittance controller reads what the broadcaster exports. None: the file has
        comments in both places, for a person to fill in.
    broadcaster, admittance : str
        Names of the two controllers, with namespace if they have one.
    down_W : array_like (3,)
        Unit vector: where down is in W.

    Returns
    -------
    str
        YAML. The warnings of `vertical_residual` stand in it as comments; the verdict on the calibration
        does not: look at it first.

    Raises
    ------
    InputError
        A name has characters that the consumers do not take, or gravity points up.
    """
    _check(_FRAME, "ros2_yaml", sensor_frame=sensor_frame, world_frame=world_frame)
    if sensor_name is not None:
        _check(_FRAME, "ros2_yaml", sensor_name=sensor_name)
    _check(_NODE, "ros2_yaml", broadcaster=broadcaster, admittance=admittance)
    if broadcaster == admittance:
        raise InputError(
            f"ros2_yaml: broadcaster and admittance are both {arg(admittance)!r}: name two nodes"
        )
    vertical_residual(model, down_W)  # refuses gravity that points up
    # The exported interfaces carry the node's name without its namespace.
    source = f"{broadcaster.rsplit('/', 1)[-1]}/{sensor_name or _PLACEHOLDER}"
    along_z, vertical = down_along_z(down_W), None
    if along_z is not None:
        weight = max(along_z * float(model.gravity_W[2]), 0.0)
        vertical = residual_of(model, weight, (0.0, 0.0, along_z))
    return _document(
        *_head(
            "ros2_control",
            sensor_frame,
            sensor_frame=sensor_frame,
            world_frame=world_frame,
            sensor_name=sensor_name or _NOT_GIVEN,
            broadcaster=broadcaster,
            admittance=admittance,
        ),
        *_ROS2_NOTES,
        *([] if vertical is None else _warn("WARNING: ", vertical)),
        f"{_key(broadcaster)}:",
        "  ros__parameters:",
        *_sensor_lines(sensor_name),
        f"    frame_id: {_text(sensor_frame)}",
        "    # ADDED to the reading: minus the bias. N and N*m.",
        "    offset:",
        *_axes("force", -model.force_bias, _sigma(model, FORCE_BIAS)),
        *_axes("torque", -model.torque_bias, _sigma(model, TORQUE_BIAS)),
        "    # Applied after the offset; the calibration holds for 1.0 only.",
        "    multiplier:",
        *_axes("force", np.ones(3)),
        *_axes("torque", np.ones(3)),
        *_without_admittance(admittance, down_W)
        if along_z is None or vertical is None
        else (
            f"{_key(admittance)}:",
            "  ros__parameters:",
            "    ft_sensor:",
            "      # This controller removes no bias. It has to read what the broadcaster exports (start that",
            "      # one first), not the sensor itself. Mind the CAUTION above.",
            f"      {'' if sensor_name else '# '}name: {_text(source)}",
            "      frame:",
            f"        id: {_text(sensor_frame)}",
            *_BASE[along_z > 0],
            "    fixed_world_frame:",
            "      frame:",
            f"        id: {_text(world_frame)}",
            "    gravity_compensation:",
            "      frame:",
            f"        id: {_text(sensor_frame)}",
            "      CoG:",
            "        # From the sensor origin, in the frame above, m.",
            *_sigma_comment("        ", _sigma(model, CENTRE_OF_MASS)),
            f"        pos: {_list(model.centre_of_mass_S)}",
            "        # Weight, N (not kg), taken along -z of fixed_world_frame.",
            *_HANGING[along_z < 0 :],
            *_sigma_comment("        ", _sigma(model, GRAVITY)[2:]),
            f"        force: {yaml_number(-along_z * vertical.weight)}",
        ),
    )


def ft_calib_yaml(
    model: GravityModel, *, com_frame: str, child_frame: str = "gripper_com", down_W: ArrayLike = DOWN_W
) -> str:
    """Return the calibration file of KTH's force_torque_tools, which its gravity_compensation node loads.

    With ``a_S`` the gravity vector, rotated by tf from the frame of the imu message into that of the wrench,
    the node computes, torques about the sensor origin:

        F - bias_F - m a_S,    M - bias_M - p x (m a_S)

    There is no world frame and no constant of gravity in the node: direction and size of ``a`` are those of
    ``linear_acceleration`` in the imu topic. Release 1.2 takes the message as it is, so it has to point
    down; an accelerometer at rest reads upwards, and versions from 2021 on negate it. A node that publishes a
    constant instead, as is usual without an imu, can carry the calibration's own gravity vector; the file gives
    it for both signs.

    Parameters
    ----------
    model : GravityModel
    com_frame : str
        Frame that the centre of mass is given in: the sensor frame S, as in the header of the raw wrench.
    child_frame : str
        What the node calls the centre of mass when it publishes it to tf; it does not start without.
    down_W : array_like (3,)
        Unit vector: where down is in W.

    Returns
    -------
    str
        YAML.

    Raises
    ------
    InputError
        A name has characters that tf does not take, or the load has no weight that points down: the node
        takes no mass of zero.
    """
    _check(_FRAME, "ft_calib_yaml", com_frame=com_frame, child_frame=child_frame)
    if com_frame == child_frame:
        raise InputError(
            f"ft_calib_yaml: com_frame and child_frame are both {arg(com_frame)!r}: tf needs two names"
        )
    if vertical_residual(model, down_W).weight == 0:
        raise InputError(
            "ft_calib_yaml: the load has no weight that points down, and gravity_compensation takes no mass of"
            " zero. Subtract the bias alone, or calibrate with the load mounted."
        )
    down = STANDARD_GRAVITY * model.gravity_W / length(model.gravity_W)
    vertical = residual_of(model, model.mass * STANDARD_GRAVITY, down_W)
    where = (
        "z up"
        if down_along_z(down_W) == -1
        else message(f"down in it is {arg(_list(np.asarray(down_W, dtype=np.float64)))}")
    )
    return _document(
        *_head(
            "KTH gravity_compensation (force_torque_tools)",
            com_frame,
            com_frame=com_frame,
            child_frame=child_frame,
        ),
        "# The node takes gravity from linear_acceleration in its imu topic, m/s^2, turned by tf. To give it",
        f"# the gravity of this calibration, publish in the world frame of the calibration ({where}):",
        f"#   {_list(down)}  release 1.2 and older: taken as it is, pointing down",
        f"#   {_list(-down)}  versions that negate the reading first",
        "# The wrong one of the two doubles the weight instead of removing it.",
        *_warn(message("WARNING, should the topic carry the vertical of that frame instead: "), vertical),
        "# SUBTRACTED from the reading: the bias itself. Force, N, then torque, N*m.",
        *_sigma_comment("", np.concatenate([_sigma(model, FORCE_BIAS), _sigma(model, TORQUE_BIAS)])),
        f"bias: {_list([*model.force_bias, *model.torque_bias])}",
        f"# kg: the weight over {STANDARD_GRAVITY} m/s^2.",
        *_sigma_comment("", np.array([model.mass_sigma])),
        f"gripper_mass: {yaml_number(model.mass)}",
        f"gripper_com_frame_id: {_text(com_frame)}",
        f"gripper_com_child_frame_id: {_text(child_frame)}",
        "# x y z from the sensor origin, m, then roll pitch yaw, rad: without meaning for a point.",
        *_sigma_comment("", _sigma(model, CENTRE_OF_MASS)),
        f"gripper_com_pose: {_list([*model.centre_of_mass_S, 0.0, 0.0, 0.0])}",
    )


def ft_tools_yaml(model: GravityModel) -> str:
    """Return the calibration file of ft_tools_ros2, whose keys force_torque_tools ignores, and the other way round.

    It computes what `ft_calib_yaml` says, with ``a`` from its parameter ``gravity_in_reference_frame``.
    """
    return _document(
        "# For ft_tools_ros2, with its parameter gravity_in_reference_frame in the calibration's world frame:",
        f"#   {_list(_FT_TOOLS_GRAVITY * model.gravity_W / (length(model.gravity_W) or 1.0))}",
        "# kg: the weight over the size of that. The offsets are SUBTRACTED: the bias itself, N and N*m.",
        f"mass: {yaml_number(length(model.gravity_W) / _FT_TOOLS_GRAVITY)}",
        f"sensor_frame_to_com: {_list(model.centre_of_mass_S)}",
        f"force_offset: {_list(model.force_bias)}",
        f"torque_offset: {_list(model.torque_bias)}",
    )


def read_ft_calib(file: Path, down_W: ArrayLike = DOWN_W) -> GravityModel:
    """Read the calibration file of force_torque_tools or ft_tools_ros2; nothing is known of its uncertainty.

    Parameters
    ----------
    file : path
        YAML; the keys say whose it is. KTH's ``gripper_com_pose`` must be given in the sensor frame.
    down_W : array_like (3,)
        Unit vector: where down is in W, which these files do not say.

    Raises
    ------
    InputError
        It cannot be read, is of neither tool, or a value is missing, no number, or impossible.
    """
    given = _fields(file)

    def numbers(key: str, count: int) -> NDArray[np.float64]:
        if key not in given:
            raise InputError(f"{arg(file)}: {arg(key)} is missing: {arg(_AGAIN)}")
        try:
            found = np.array([float(each) for each in given[key]])
        except ValueError:
            found = np.empty(0)
        if len(found) != count or not (np.abs(found) < _MOST_NUMBER).all():
            what = "a number" if count == 1 else message(f"{arg(count)} numbers")
            raise InputError(f"{arg(file)}: {arg(key)} is not {arg(what)} of a plausible size: {arg(_AGAIN)}")
        return found

    if "mass" in given:
        weight = numbers("mass", 1) * _FT_TOOLS_GRAVITY
        centre, bias = (
            numbers("sensor_frame_to_com", 3),
            [numbers("force_offset", 3), numbers("torque_offset", 3)],
        )
    elif "gripper_mass" in given:
        weight = numbers("gripper_mass", 1) * STANDARD_GRAVITY
        centre, bias = numbers("gripper_com_pose", 6)[:3], np.split(numbers("bias", 6), 2)
    else:
        raise InputError(
            f"{arg(file)}: neither mass nor gripper_mass is there: choose the calibration file of ft_tools_ros2 or"
            " force_torque_tools."
        )
    if weight < 0:
        raise InputError(
            f"{arg(file)}: the mass is negative: the tool calibrated with gravity upside down."
            f" {arg(capitalised(_AGAIN))}"
        )
    if not (weight.any() or np.any(bias)):
        raise InputError(f"{arg(file)}: mass and offsets are zero, as before a calibration: {arg(_AGAIN)}")
    return GravityModel(weight * np.asarray(down_W), bias[0], centre, bias[1])


def _fields(file: Path) -> dict[str, list[str]]:
    """Return the words below each key of a flat YAML file, whether its lists are written in brackets or in lines."""
    try:
        with file.open("rb") as stream:
            text = stream.read(_MOST_BYTES).decode()
    except (OSError, ValueError) as error:
        raise InputError(f"{arg(file)}: it cannot be read ({arg(error)}): choose a YAML file.") from error
    found: dict[str, list[str]] = {}
    words: list[str] = []
    for line in text.splitlines():
        key, colon, rest = re.sub(r"(^|\s)#.*", "", line).rstrip().partition(":")
        if colon and not key[:1].isspace():
            if key in found:
                raise InputError(f"{arg(file)}: {arg(ascii(key)[:60])} is there twice: {arg(_AGAIN)}")
            words = found[key] = []
        words += re.sub(r"[\[\],]", " ", rest if colon else key).split()
    return {key: [word for word in words if word != "-"] for key, words in found.items()}


# ---- YAML ----------------------------------------------------------------------------------------


def yaml_number(value: float) -> str:
    """Return a YAML 1.1 float that reads back as exactly `value`: always with a point, as ``1.0e-05``.

    Raises
    ------
    InputError
        The value is not finite.
    """
    if not np.isfinite(value):
        raise InputError(f"yaml_number: {arg(value)} is not finite; a consumer would act on it")
    digits = repr(float(value) + 0.0)  # + 0.0: no -0.0
    mantissa, e, exponent = digits.partition("e")
    return f"{mantissa if '.' in mantissa else mantissa + '.0'}{e}{exponent}"


def _list(values: Iterable[float]) -> str:
    return f"[{', '.join(yaml_number(value) for value in values)}]"


def _axes(name: str, values: Iterable[float], sigmas: Iterable[float] = ()) -> list[str]:
    lines = [f"        {axis}: {yaml_number(value)}" for axis, value in zip("xyz", values, strict=True)]
    return [f"      {name}:", *_sigma_comment("        ", sigmas), *lines]


def _text(value: str) -> str:
    return f'"{value}"'  # the characters were checked: none needs an escape


def _key(name: str) -> str:
    return _text(name) if name.lower() in _YAML_WORDS else name


def _check(pattern: re.Pattern[str], where: str, **names: str) -> None:
    for name, value in names.items():
        if len(value) > _LONGEST:
            raise InputError(
                f"{arg(where)}: {arg(name)} has {arg(len(value))} characters: give a name of at most {arg(_LONGEST)}."
            )
        if not pattern.fullmatch(value):
            dots, more = "", message(", none starting with a digit")
            if pattern is _FRAME:
                dots, more = " . -", message(", and no / in front, which tf2 refuses")
            raise InputError(
                f"{arg(where)}: {arg(name)} {arg(value)!r} is no name that every consumer takes: letters,"
                f" digits and _{arg(dots)}, in parts with one / between{arg(more)}"
            )


# ---- comments ------------------------------------------------------------------------------------


def _document(*lines: str) -> str:
    return "\n".join(lines) + "\n"


def _head(consumer: str, frame: str, **facts: str) -> list[str]:
    return [
        f"# Gravity calibration for {consumer}.",
        f"# tool: contactbench {__version__}",
        *(f"# {name}: {value}" for name, value in facts.items()),
        f"# Forces in N, torques in N*m about the origin of {_text(frame)}, lengths in m, all in that frame.",
        "# What remains after compensation is what the tissue does to the probe.",
    ]


def _warn(before: str, vertical: VerticalResidual) -> list[str]:
    return [
        f"# {line}"
        for warning in vertical.warnings
        for line in textwrap.wrap(before + warning, 98, break_long_words=False)
    ]


_PLACEHOLDER = "SENSOR_NAME"
_ROS2_NOTES = (
    "# This is a FRAGMENT, not a complete file: merge it into the robot's controller parameters, as",
    "# docs/ros.md of contactbench describes.",
    f"# Checked against the sources of ros2_controllers {', '.join(CHECKED)}. Needs 4.16.0 or newer:",
    "# older broadcasters ignore the offset.",
    "# CAUTION: the broadcasters of ros2_controllers 4.42.0, 4.42.1, 5.17.0 and 6.9.0 publish the reading",
    "# with offset and multiplier, but what they export to other controllers stays as it was when they were",
    "# configured. Do not chain admittance_controller to them: it would take a constant for the reading,",
    "# and move the robot. Earlier ones export what they publish.",
)


# Of a robot that stands, and of one that hangs.
_BASE = (
    (
        "    # z up. Make it the base of the kinematics chain (kinematics.base): a frame tilted against that",
        "    # base, as on a wall, is used the wrong way round.",
    ),
    (
        "    # z down. Make it the base of the kinematics chain (kinematics.base): a frame tilted against that",
        "    # base is used the wrong way round. A level frame with z up would need the weight above 0.",
    ),
)
_HANGING = (
    "        # Negative on purpose: this robot hangs from the ceiling, and its weight points along +z.",
)


def _sensor_lines(sensor_name: str | None) -> list[str]:
    if sensor_name is not None:
        return [f"    sensor_name: {_text(sensor_name)}"]
    return [
        "    # FILL IN the sensor's name in the ros2_control tag of the robot description, here and in",
        "    # ft_sensor.name below: the broadcaster does not start without it.",
        f"    # sensor_name: {_text(_PLACEHOLDER)}",
    ]


def _without_admittance(admittance: str, down_W: ArrayLike) -> tuple[str, ...]:
    return (
        f"# NO {admittance}: it takes the weight along z of the base of its kinematics chain,",
        "# and this robot is on a wall or a tilted base: down in the calibration's world frame is",
        f"#   {_list(np.asarray(down_W, dtype=np.float64))}",
        "# No fixed_world_frame makes that right. Compensate with contactbench's own runtime.",
    )


def _sigma(model: GravityModel, part: slice) -> NDArray[np.float64]:
    """Return 1 sigma of some parameters."""
    sigmas: NDArray[np.float64] = np.sqrt(np.maximum(np.diag(model.covariance)[part], 0.0))
    return sigmas


def _sigma_comment(indent: str, sigmas: Iterable[float]) -> list[str]:
    """Return a comment line, or none where nothing is known."""
    values = list(sigmas)
    return [f"{indent}# 1 sigma: {', '.join(f'{value:.2g}' for value in values)}"] if any(values) else []
