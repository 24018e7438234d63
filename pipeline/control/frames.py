"""What somebody who watches a closed loop sees of it, as lines of JSON: a beginning, a frame a period, an end."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.loop import Loop
    from contactbench.pipeline.control.states import ControlCommand

    Three = tuple[float, float, float]

BEGIN, FRAME, END = "begin", "frame", "end"


@dataclass(frozen=True)
class Beginning:
    """What does not change."""

    robot: str
    variant: str
    wanted_N: float
    limit_N: float
    period_s: float  # between frames
    rest_B_m: Three  # (3,) where the sensor is in B while the probe stands upright on the phantom at rest


@dataclass(frozen=True)
class LoopFrame:
    """A period, in the base's frame B, z up."""

    time_s: float
    state: str  # a value of `ControlState`
    reason: str | None  # why the state has changed in this period; None: it has not
    force_N: float  # the true force along the probe's axis
    # (in plane, out of plane) how far the phantom's normal is from the probe's axis, see
    # `MovedScene.angles`
    angles_rad: tuple[float, float]
    R_BS: tuple[float, ...]  # (9,) row by row
    sensor_B_m: Three  # (3,) where S is
    # phantom_B_m, normal_B: (3,) the middle of the phantom's top, and what points out of it
    phantom_B_m: Three
    normal_B: Three
    # point_S_m, force_S_N: (3,) or None The contact as it was located, and the force on the probe; None:
    # not known
    point_S_m: Three | None
    force_S_N: Three | None


def beginning_of(loop: Loop, robot: str) -> Beginning:
    """Return what does not change; `robot` is its address."""
    settings = loop.controller.settings
    _, rest = loop.scene.held_at(0.0)
    force, variant = settings.desired_force, settings.variant.value
    return Beginning(robot, variant, force, settings.max_force, settings.period, _three(rest))


def frame_of(command: ControlCommand, loop: Loop) -> LoopFrame:
    """Return the period that a loop has just gone on by."""
    from contactbench.pipeline.control.loop import arm_of  # not above: who reads frames needs no physics

    scene, sensed = loop.scene, command.sensed
    R_BE, p_BE_B = arm_of(scene).flange_pose(scene.true_joints)
    phantom, normal = scene.surface()
    point = sensed.point
    within, out = scene.angles()
    return LoopFrame(
        time_s=scene.time,
        state=command.state.value,
        reason=None if command.change is None else command.change.reason,
        force_N=-float(scene.moment().contact[2]),
        angles_rad=(float(within), float(out)),
        R_BS=tuple((R_BE @ scene.R_ES).ravel().tolist()),
        sensor_B_m=_three(p_BE_B + R_BE @ scene.p_ES_E),
        phantom_B_m=_three(phantom),
        normal_B=_three(normal),
        point_S_m=None if point is None else _three(point),
        force_S_N=_three(sensed.wrench[:3]) if sensed.fresh else None,
    )


def line_of(kind: str, content: Beginning | LoopFrame | dict[str, Any]) -> str:
    """Return a line of JSON, its end included."""
    plain = content if isinstance(content, dict) else asdict(content)
    return json.dumps({"kind": kind, **plain}, separators=(",", ":"), allow_nan=False) + "\n"


def read_line(line: str | bytes) -> Beginning | LoopFrame | dict[str, Any]:
    """
    Read a line; an end is plain data.

    Raises
    ------
    InputError
        It is none that `line_of` makes.
    """
    try:
        content = json.loads(line)
        kind = content.pop("kind")
        if kind == END:
            return dict(content)
        if kind == BEGIN:
            return Beginning(**_checked(Beginning, content))
        if kind == FRAME:
            return LoopFrame(**_checked(LoopFrame, content))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise InputError(f"line of a closed loop: it cannot be read ({arg(repr(error)[:100])}).") from error
    raise InputError(
        f"line of a closed loop: its kind is {arg(ascii(kind)[:60])}, not {arg(BEGIN)}, {arg(FRAME)} or {arg(END)}."
    )


def _checked(kind: type, content: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a kind, arrays as tuples, numbers finite."""
    if unknown := set(content) - {each.name for each in fields(kind)}:
        raise ValueError(message(f"{arg(sorted(unknown)[0])} is unknown"))
    found = {}
    for each in fields(kind):
        value = content[each.name]
        found[each.name] = tuple(float(one) for one in value) if isinstance(value, list) else value
        numbers = found[each.name] if isinstance(value, list) else (value,)
        if not all(math.isfinite(one) for one in numbers if isinstance(one, float)):
            raise ValueError(each.name)
    return found


def _three(values: NDArray[np.float64]) -> Three:
    x, y, z = (float(each) for each in np.asarray(values))
    return x, y, z
