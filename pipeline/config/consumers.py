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

import re
import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from contactbench import __version__
from contactbench.pipeline.calibration.model import DOWN_W, STANDARD_GRAVITY, GravityModel, length
from contactbench.pipeline.errors import InputError, arg, capitalised, message

NO_ADMITTANCE: Final = message(
    "ros2.yaml holds only the broadcaster's offset: the admittance controller of ros2_control cannot take the weight of"
    " a tool whose robot is on a wall or a tilted base."
)
# The cosine of some 5 degrees: further from z of W, a weight along z is the wrong weight.
_ALONG_Z = 0.996

# Less than this share of the weight is rounding, not a tilt: of a fit to exact data 1e-13 remains.
_ROUNDING = 1e-9
# Noise alone turns the weight of a bare sensor upwards every other time; this many sigma is no noise.
_NOISE = 2.0
# The covariance of a compensated wrench is of second degree in the rotation. The mean over the 24 rotations
# of a cube is then the mean over all rotations, exactly.
_ORIENTATIONS = Rotation.create_group("O").as_matrix()
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
    source = f"{broadcaster.rsplit('/', 1)[-1]}/{sensor_name or 'SENSOR_NAME'}"
    along_z, vertical = down_along_z(down_W), None
    if along_z is not None:
        weight = max(along_z * float(model.gravity_W[2]), 0.0)
        vertical = residual_of(model, weight, (0.0, 0.0, along_z))
    return _written(
        "ros2.yaml.jinja",
        model,
        consumer="ros2_control",
        frame=sensor_frame,
        names={
            "sensor_frame": sensor_frame,
            "world_frame": world_frame,
            "sensor_name": sensor_name or _NOT_GIVEN,
            "broadcaster": broadcaster,
            "admittance": admittance,
        },
        checked=", ".join(CHECKED),
        vertical=vertical,
        warning="WARNING: ",
        source=source,
        sensor_name=sensor_name,
        hangs=along_z == 1,
        down_W=np.asarray(down_W, dtype=np.float64),
        weight=None if along_z is None or vertical is None else -along_z * vertical.weight,
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
    return _written(
        "ft_calib.yaml.jinja",
        model,
        consumer="KTH gravity_compensation (force_torque_tools)",
        frame=com_frame,
        names={"com_frame": com_frame, "child_frame": child_frame},
        where=where,
        down=down,
        vertical=vertical,
        warning=message("WARNING, should the topic carry the vertical of that frame instead: "),
        gravity=STANDARD_GRAVITY,
    )


def ft_tools_yaml(model: GravityModel) -> str:
    """Return the calibration file of ft_tools_ros2, whose keys force_torque_tools ignores, and the other way round.

    It computes what `ft_calib_yaml` says, with ``a`` from its parameter ``gravity_in_reference_frame``.
    """
    weight = length(model.gravity_W)
    return _written(
        "ft_tools.yaml.jinja",
        model,
        down=_FT_TOOLS_GRAVITY * model.gravity_W / (weight or 1.0),
        mass=weight / _FT_TOOLS_GRAVITY,
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


# ---- the text ------------------------------------------------------------------------------------


def _written(
    template: str,
    model: GravityModel,
    *,
    vertical: "VerticalResidual | None" = None,
    warning: str = "",
    **content: Any,
) -> str:
    """Return a template of this folder, filled in; comments warn, after some words, of what `vertical` warns of."""
    from jinja2 import Environment, PackageLoader, StrictUndefined  # takes a while, and few commands export

    environment = Environment(
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701 - YAML: `_text` quotes
        loader=PackageLoader("contactbench.pipeline.config", ""),
    )
    environment.filters |= {
        "number": yaml_number,
        "list_of": _list,
        "text": _text,
        "key": _key,
        "sigma": _sigma,
    }
    warnings = [] if vertical is None else vertical.warnings
    sigmas = np.sqrt(np.maximum(np.diag(model.covariance), 0.0)).reshape(4, 3).tolist()
    lines = [textwrap.wrap(warning + each, 98, break_long_words=False) for each in warnings]
    return environment.get_template(template).render(
        content,
        version=__version__,
        model=model,
        sigmas=dict(zip(("gravity", "force_bias", "centre", "torque_bias"), sigmas, strict=True)),
        warnings=list(chain(*lines)),
    )


def _sigma(values: Iterable[float], indent: int = 0) -> str:
    """Return a comment and the start of the next line, or nothing where nothing is known."""
    known = list(values)
    said = ", ".join(f"{value:.2g}" for value in known)
    return f"# 1 sigma: {said}\n{' ' * indent}" if any(known) else ""


@dataclass(frozen=True)
class VerticalResidual:
    """The error of a compensated wrench that comes from taking gravity as vertical."""

    tilt: float  # Angle between the model's gravity and the consumer's vertical, degrees
    weight: float  # What the consumer takes off along its vertical, N: that part of gravity
    # Largest error over all orientations of the sensor, N and N·m about the sensor origin
    force: float
    torque: float
    # 1 sigma of a compensated wrench that the calibration itself leaves, root mean square over all
    # orientations, N and N·m. Zero when the model carries no covariance.
    force_sigma: float
    torque_sigma: float
    warnings: tuple[str, ...]  # For the reader, when the error exceeds that sigma; empty otherwise


def points_away(model: GravityModel, down_W: ArrayLike, cosine: float = 0.0) -> bool:
    """Tell whether gravity is further from ``down_W`` than an angle, by more than its noise.

    Parameters
    ----------
    model : GravityModel
    down_W : array_like (3,)
        Unit vector in W.
    cosine : float
        Of the angle; 0: gravity points up.
    """
    down = np.asarray(down_W, dtype=np.float64)
    sigma = float(np.sqrt(max(float(down @ model.covariance[:3, :3] @ down), 0.0)))
    return float(model.gravity_W @ down) + _NOISE * sigma < cosine * length(model.gravity_W)


def down_along_z(down_W: ArrayLike) -> float | None:
    """Return -1 where down is -z of W (the robot stands), 1 where it is +z (it hangs), else None.

    Parameters
    ----------
    down_W : array_like (3,)
        Unit vector in W.
    """
    z = float(np.asarray(down_W, dtype=np.float64)[2])
    return float(np.sign(z)) if abs(z) >= _ALONG_Z else None


def vertical_residual(model: GravityModel, down_W: ArrayLike = DOWN_W) -> VerticalResidual:
    """Return what a consumer that takes gravity along one direction leaves in the wrench.

    With the part ``e`` of gravity across that direction, a still sensor keeps ``R_SW e`` in the force and
    ``L_S x R_SW e`` in the torque: at most ``|e|`` and ``|L| |e|``, whatever the orientation.

    Parameters
    ----------
    model : GravityModel
    down_W : array_like (3,)
        Unit vector in W: the consumer's vertical.

    Raises
    ------
    InputError
        Gravity points up.
    """
    along = float(model.gravity_W @ np.asarray(down_W, dtype=np.float64))
    if points_away(model, down_W):
        raise InputError(
            f"gravity_W: gravity points up (by {arg(-along):.3g} N) against the declared direction of"
            " down. The sensor reports the opposite sign, or the orientations are inverted:"
            " correct that. If the robot is not mounted upright, give --down and recalibrate."
        )
    return residual_of(model, max(along, 0.0), down_W)


def residual_of(model: GravityModel, weight: float, down_W: ArrayLike = DOWN_W) -> VerticalResidual:
    """Return the same for a consumer that was given another weight.

    Parameters
    ----------
    model : GravityModel
    weight : float
        What the consumer subtracts along ``down_W``, N.
    down_W : array_like (3,)
        Unit vector in W.
    """
    g, down = model.gravity_W, np.asarray(down_W, dtype=np.float64)
    tilt = float(np.degrees(np.arctan2(length(np.cross(g, down)), float(g @ down)))) if g.any() else 0.0
    force = length(g - weight * down)
    arm = length(model.centre_of_mass_S)
    torque = arm * force
    C = model.wrench_covariance(_ORIENTATIONS)
    force_sigma = _rms(np.trace(C[:, :3, :3], axis1=1, axis2=2))
    torque_sigma = _rms(np.trace(C[:, 3:, 3:], axis1=1, axis2=2))
    least = _ROUNDING * length(g)
    warnings = []
    if force > max(force_sigma, least) or torque > max(torque_sigma, arm * least):
        warnings.append(
            message(
                f"Gravity in the calibration is tilted by {arg(tilt):.3g} deg from the vertical of its world"
                f" frame. Taken as vertical, it leaves up to {arg(force):.2g} N and {arg(torque):.2g} N*m in"
                f" a compensated wrench, where the calibration itself leaves {arg(force_sigma):.2g} N and"
                f" {arg(torque_sigma):.2g} N*m (1 sigma). Level the base, or put its tilt into the robot"
                " description, and calibrate again."
            )
        )
    return VerticalResidual(tilt, weight, force, torque, force_sigma, torque_sigma, tuple(warnings))


def _rms(variances: NDArray[np.float64]) -> float:
    return float(np.sqrt(max(float(variances.mean()), 0.0)))
