"""Exports of a calibration, proved with each consumer's own formula, written here from its sources."""

import hashlib
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench import __version__
from contactbench.pipeline.calibration import GravityModel, PoseSample, calibrate
from contactbench.pipeline.calibration.model import DOWN_W
from contactbench.pipeline.config.consumers import (
    CHECKED,
    VerticalResidual,
    down_along_z,
    ft_calib_yaml,
    ft_tools_yaml,
    read_ft_calib,
    ros2_yaml,
    vertical_residual,
    yaml_number,
)
from contactbench.pipeline.errors import InputError

ROS_PAGE = Path(__file__).parents[2] / "docs" / "ros.md"
TILTED_BY = 1.3  # deg
TRUE = GravityModel([0, 0, -9.4], [0.52, -11.3, 4.07], [0.031, -0.022, 0.085], [-0.24, 0.33, 2.5e-5])
TILTED = GravityModel(
    Rotation.from_euler("x", TILTED_BY, degrees=True).as_matrix() @ TRUE.gravity_W,
    TRUE.force_bias,
    TRUE.centre_of_mass_S,
    TRUE.torque_bias,
)
MOUNT = Rotation.from_euler("zyx", [50, -20, 35], degrees=True)  # R_ES: the sensor on its flange
PUSH = np.array([1.5, -2.0, 8.0, 0.3, -0.1, 0.05])
SIGMA = np.repeat([0.03, 0.001], 3)  # N, N·m

CEILING, WALL = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)

Parameters = dict[str, Any]


# ---- a strict reader -----------------------------------------------------------------------------

FLOAT = re.compile(r"[-+]?[0-9]+\.[0-9]*(e[-+][0-9]+)?")  # part of YAML 1.1's, and a double for ROS 2
KEY = re.compile(r'( *)("?)([/A-Za-z_][/\w]*)\2:(?: (.+))?')


def scalar(text: str) -> str | float:
    if text.startswith('"'):
        assert re.fullmatch(r'"[\w./-]+"', text, re.ASCII), text
        return text[1:-1]
    assert FLOAT.fullmatch(text), f"{text} is no float: ROS 2 would refuse it"
    return float(text)


def value(text: str) -> str | float | list[float]:
    if not text.startswith("["):
        return scalar(text)
    assert text.endswith("]")
    assert '"' not in text
    return [float(scalar(item)) for item in text[1:-1].split(", ")]


def read(text: str) -> Parameters:
    """Read the little YAML that the exports use; anything else fails."""
    assert text.isascii()
    root: Parameters = {}
    stack = [root]
    for line in text.splitlines():
        if line.lstrip().startswith("#"):
            continue
        match = KEY.fullmatch(line)
        assert match, line
        indent, _, key, rest = match.groups()
        depth, odd = divmod(len(indent), 2)
        assert not odd
        assert depth < len(stack), line
        del stack[depth + 1 :]
        assert key not in stack[-1], f"{key} twice"
        stack[-1][key] = {} if rest is None else value(rest)
        if rest is None:
            stack.append(stack[-1][key])
    return root


def node(parameters: Parameters, name: str) -> Parameters:
    return parameters[name]["ros__parameters"]


# ---- the consumers -------------------------------------------------------------------------------


def broadcaster(parameters: Parameters, wrench: np.ndarray) -> np.ndarray:
    """force_torque_sensor_broadcaster: adds the offset, then multiplies, axis by axis."""
    out = np.empty(6)
    for i, (kind, axis) in enumerate((kind, axis) for kind in ("force", "torque") for axis in "xyz"):
        reading = wrench[i] + parameters["offset"][kind][axis]
        out[i] = reading * parameters["multiplier"][kind][axis]
    return out


def admittance(parameters: Parameters, wrench: np.ndarray, links: dict[str, np.ndarray]) -> list[np.ndarray]:
    """admittance_controller: returns the wrench in its world and base frame; `links` rotates into the base."""
    world = links[parameters["fixed_world_frame"]["frame"]["id"]]  # taken for world from base
    sensor = links[parameters["ft_sensor"]["frame"]["id"]]
    cog = links[parameters["gravity_compensation"]["frame"]["id"]]
    centre = parameters["gravity_compensation"]["CoG"]
    weight = np.array([0.0, 0.0, -centre["force"]])
    force = world @ sensor @ wrench[:3]
    torque = world @ sensor @ wrench[3:]
    force[2] -= weight[2]
    torque -= np.cross(world @ cog @ centre["pos"], weight)
    return [np.concatenate([force, torque]), np.concatenate([world.T @ force, world.T @ torque])]


def gravity_compensation(
    parameters: Parameters, wrench: np.ndarray, imu: np.ndarray, tf: dict[str, np.ndarray], sign: float
) -> np.ndarray:
    """KTH's node: `tf` rotates into the frame of the wrench, `sign` is -1 where it negates the reading."""
    zeroed = wrench - parameters["bias"]
    weight = parameters["gripper_mass"] * (tf["imu"] @ (sign * imu))
    arm = tf[parameters["gripper_com_frame_id"]] @ parameters["gripper_com_pose"][:3]
    return zeroed - np.concatenate([weight, np.cross(arm, weight)])


def ft_estimation(
    parameters: Parameters, wrench: np.ndarray, R_WS: np.ndarray, gravity: np.ndarray
) -> np.ndarray:
    """ft_tools_ros2's FtEstimation::remove_weight: the weight goes before the offsets."""
    weight = parameters["mass"] * (R_WS.T @ gravity)
    torque = np.cross(parameters["sensor_frame_to_com"], weight)
    offset = np.concatenate([parameters["force_offset"], parameters["torque_offset"]])
    return wrench - np.concatenate([weight, torque]) - offset


# ---- a robot -------------------------------------------------------------------------------------


def orientations(count: int, seed: int = 5) -> np.ndarray:
    """R_WS of a sensor whose mount is turned on the flange."""
    flange = Rotation.from_quat(np.random.default_rng(seed).standard_normal((count, 4)))
    return (flange * MOUNT).as_matrix()


def fit(truth: GravityModel, noise: float = 0.0, seed: int = 3) -> GravityModel:
    rng = np.random.default_rng(seed)
    R_WS = orientations(18, seed)
    readings = truth.predict(R_WS) + noise * SIGMA * rng.standard_normal((18, 6))
    poses = [PoseSample(R, wrench[:3], wrench[3:]) for R, wrench in zip(R_WS, readings, strict=True)]
    return calibrate(poses).model


@pytest.fixture(scope="module")
def exact() -> GravityModel:
    return fit(TRUE)


def through_ros2(model: GravityModel, R_WS: np.ndarray, wrench: np.ndarray) -> np.ndarray:
    """Return the compensated wrench in S, for the base of the chain as the world frame."""
    parameters = read(ros2_yaml(model, sensor_frame="ft_sensor", world_frame="base_link"))
    unbiased = broadcaster(node(parameters, "force_torque_sensor_broadcaster"), wrench)
    links = {"base_link": np.eye(3), "ft_sensor": R_WS}
    world, _ = admittance(node(parameters, "admittance_controller"), unbiased, links)
    return np.concatenate([R_WS.T @ world[:3], R_WS.T @ world[3:]])


# ---- round trips ---------------------------------------------------------------------------------

BASES = {
    "upright": Rotation.identity(),
    "turned about the vertical": Rotation.from_euler("z", 77, degrees=True),
    "upside down": Rotation.from_euler("y", 180, degrees=True),
}


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("push", [np.zeros(6), PUSH], ids=["untouched", "touched"])
def test_ros2_leaves_what_the_tissue_does_and_nothing_else(exact, base, push):
    R_WB = BASES[base].as_matrix()
    parameters = read(
        ros2_yaml(exact, sensor_frame="tool/ft", world_frame="world", broadcaster="fts", admittance="adm")
    )
    for R_WS in orientations(50):
        R_BS = R_WB.T @ R_WS
        unbiased = broadcaster(node(parameters, "fts"), TRUE.predict(R_WS) + push)
        links = {"world": R_WB.T, "tool/ft": R_BS}
        world, base_wrench = admittance(node(parameters, "adm"), unbiased, links)
        assert push.any() or np.abs(world).max() < 1e-9
        np.testing.assert_allclose((base_wrench.reshape(2, 3) @ R_BS).ravel(), push, atol=1e-9)


def test_the_file_warns_of_the_wall_because_the_controller_is_wrong_there(exact):
    text = ros2_yaml(exact, sensor_frame="s", world_frame="w")
    controller = node(read(text), "admittance_controller")
    R_WS, R_WB = orientations(1)[0], Rotation.from_euler("x", 90, degrees=True).as_matrix()
    weight = TRUE.predict(R_WS) - TRUE.predict(np.zeros((3, 3)))  # the bias taken off
    world, _ = admittance(controller, weight, {"w": R_WB.T, "s": R_WB.T @ R_WS})
    assert np.linalg.norm(world[:3]) > 9
    world, _ = admittance(controller, weight, {"w": np.eye(3), "s": R_WS})  # the chain begins at w
    assert np.abs(world).max() < 1e-9
    assert "kinematics.base" in text


@pytest.mark.parametrize(("line", "sign"), [(0, 1.0), (1, -1.0)])
@pytest.mark.parametrize("truth", [TRUE, TILTED], ids=["level", "tilted"])
def test_ft_calib_leaves_nothing_with_the_gravity_that_its_file_gives(truth, line, sign):
    text = ft_calib_yaml(fit(truth), com_frame="ft_sensor")
    parameters = read(text)
    imu = np.array(value(re.findall(r"# +(\[.*\]) ", text)[line]))
    assert math.isclose(np.linalg.norm(imu), 9.80665)
    assert imu[2] * sign < 0
    for R_WS in orientations(50):
        tf = {"imu": R_WS.T, "ft_sensor": np.eye(3)}
        assert np.abs(gravity_compensation(parameters, truth.predict(R_WS), imu, tf, sign)).max() < 1e-9


def test_ft_calib_has_the_keys_that_the_node_asks_for(exact):
    parameters = read(ft_calib_yaml(exact, com_frame="ft_sensor", child_frame="load"))
    assert parameters["gripper_com_child_frame_id"] == "load"
    assert parameters["gripper_com_pose"][3:] == [0.0, 0.0, 0.0]
    np.testing.assert_allclose(parameters["bias"], [*TRUE.force_bias, *TRUE.torque_bias], atol=1e-9)
    assert math.isclose(parameters["gripper_mass"], 9.4 / 9.80665)
    keys = "bias gripper_mass gripper_com_frame_id gripper_com_child_frame_id gripper_com_pose"
    assert set(parameters) == set(keys.split())


# ---- ft_tools_ros2, and files of both ------------------------------------------------------------


@pytest.mark.parametrize("down", [(0.0, 0.0, -1.0), CEILING, WALL])
def test_ft_tools_leaves_what_the_tissue_does_with_the_gravity_that_the_file_gives(down):
    tool = mounted(down, TILTED)
    text = ft_tools_yaml(tool)
    gravity = np.array(value(re.findall(r"^# +(\[.*\])$", text, re.MULTILINE)[0]))
    assert math.isclose(np.linalg.norm(gravity), 9.81)
    assert gravity @ down > 9.8
    for R_WS in orientations(50):
        found = ft_estimation(read(text), tool.predict(R_WS) + PUSH, R_WS, gravity)
        np.testing.assert_allclose(found, PUSH, atol=1e-9)


# As yaml-cpp and rosparam write them: lists in lines, lists wrapped, comments, an int.
FT_TOOLS = """\
mass: 0.75
sensor_frame_to_com:
  - 0.031
  - -2.2e-02
  - 0.085
force_offset:
  - 0.52  # N
  - -11.3
  - 4.07
torque_offset:
- -0.24
- 0.33
- 0
"""
KTH = """\
bias: [0.52, -11.3, 4.07, -0.24,
  0.33, 0]
gripper_com_child_frame_id: left_gripper_com
gripper_com_frame_id: 'ft_sensor'
gripper_com_pose: [0.031, -0.022, 0.085, 0.0, 0.0, 0.0]
gripper_mass: 0.75
"""


@pytest.mark.parametrize("down", [(0.0, 0.0, -1.0), CEILING, WALL])
@pytest.mark.parametrize("text", [FT_TOOLS, KTH], ids=["ft_tools_ros2", "force_torque_tools"])
def test_we_compensate_by_the_file_of_another_tool_as_that_tool_does(tmp_path, text, down):
    file = tmp_path / "theirs.yaml"
    file.write_text(text)
    model = read_ft_calib(file, down)
    force, torque, centre = [0.52, -11.3, 4.07], [-0.24, 0.33, 0.0], [0.031, -0.022, 0.085]
    theirs = {"mass": 0.75, "sensor_frame_to_com": centre, "force_offset": force, "torque_offset": torque}
    gripper = {"gripper_mass": 0.75, "gripper_com_pose": centre, "bias": force + torque}
    gripper["gripper_com_frame_id"] = "s"
    for R_WS in orientations(20):
        wrench = TRUE.predict(R_WS) + PUSH
        if text is FT_TOOLS:
            expected = ft_estimation(theirs, wrench, R_WS, 9.81 * np.array(down))
        else:
            tf = {"imu": R_WS.T, "s": np.eye(3)}
            expected = gravity_compensation(gripper, wrench, 9.80665 * np.array(down), tf, 1.0)
        np.testing.assert_allclose(model.compensate(R_WS, wrench), expected, atol=1e-12)


def test_what_we_write_for_them_we_read_as_it_was(tmp_path, exact):
    file = tmp_path / "ft_calib.yaml"
    for text in (ft_calib_yaml(exact, com_frame="s"), ft_tools_yaml(exact)):
        file.write_text(text)
        np.testing.assert_allclose(read_ft_calib(file).vector, exact.vector, atol=1e-9)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (FT_TOOLS.replace("torque_offset", "torque"), "torque_offset is missing"),
        (FT_TOOLS.replace("  - 0.085\n", ""), "sensor_frame_to_com is not 3 numbers"),
        (FT_TOOLS.replace("0.085", "0,085"), "sensor_frame_to_com is not 3 numbers"),
        (FT_TOOLS.replace("0.52", "nan"), "force_offset is not 3 numbers"),
        (FT_TOOLS.replace("0.52", "1e300"), "force_offset is not 3 numbers"),
        (FT_TOOLS.replace("0.75", "heavy"), "mass is not a number"),
        (FT_TOOLS.replace("0.75", "-0.75"), "mass is negative"),
        (FT_TOOLS + "mass: 1.0\n", "'mass' is there twice"),
        (re.sub(r"[1-9]", "0", FT_TOOLS).replace("e-00", ""), "as before a calibration"),
        (KTH.replace("gripper_mass", "weight"), "neither mass nor gripper_mass"),
        (KTH.replace("0.33, 0", "0.33"), "bias is not 6 numbers"),
        ("", "neither mass nor gripper_mass"),
        ("\udcff", "cannot be read"),
        ("- 1\n" * 30_000, "neither mass nor gripper_mass"),
    ],
)
def test_a_file_that_is_no_calibration_is_refused_by_name_field_and_remedy(tmp_path, text, told):
    file = tmp_path / "theirs.yaml"
    file.write_bytes(text.encode(errors="surrogateescape"))
    with pytest.raises(
        InputError, match=rf"theirs\.yaml: .*{told}.*: (choose|calibrate)|upside down"
    ) as raised:
        read_ft_calib(file)
    assert told in str(raised.value)


@pytest.mark.parametrize("truth", [TRUE, TILTED], ids=["level", "tilted"])
def test_a_noisy_fit_agrees_with_our_own_compensation_up_to_the_stated_residual(truth):
    model = fit(truth, noise=1.0)
    vertical = vertical_residual(model)
    R_WS = orientations(50)
    readings = truth.predict(R_WS) + PUSH
    ours = model.compensate(R_WS, readings)
    theirs = np.array([through_ros2(model, R, wrench) for R, wrench in zip(R_WS, readings, strict=True)])
    force, torque = np.linalg.norm((theirs - ours).reshape(-1, 2, 3), axis=2).T
    np.testing.assert_allclose(force, vertical.force, rtol=1e-6)  # the same in every orientation
    assert torque.max() <= vertical.torque * (1 + 1e-6)
    assert torque.max() > 0.9 * vertical.torque  # stated, not merely bounded


def test_ft_calib_with_a_vertical_imu_stays_within_the_warning():
    model = fit(TILTED, noise=1.0)
    text = ft_calib_yaml(model, com_frame="s")
    warning = " ".join(re.findall(r"^# (.*)", text, re.MULTILINE))
    force, torque = map(float, re.search(r"leaves up to (\S+) N and (\S+) N\*m", warning).groups())
    R_WS, readings = orientations(50), TILTED.predict(orientations(50))
    ours = model.compensate(R_WS, readings)
    parameters, imu = read(text), np.array([0.0, 0.0, -9.80665])
    theirs = [
        gravity_compensation(parameters, wrench, imu, {"imu": R.T, "s": np.eye(3)}, 1.0)
        for R, wrench in zip(R_WS, readings, strict=True)
    ]
    off = np.linalg.norm((np.array(theirs) - ours).reshape(-1, 2, 3), axis=2).max(axis=0)
    np.testing.assert_allclose(off[0], force, rtol=0.05)  # two digits are printed
    assert 0.85 * torque < off[1] < 1.05 * torque


# ---- robots that do not stand --------------------------------------------------------------------


def mounted(down: Any, model: GravityModel = TRUE) -> GravityModel:
    """Return the same tool on a robot in whose W gravity points along `down`."""
    turn, _ = Rotation.align_vectors([down], [[0, 0, -1]])
    return GravityModel(
        turn.as_matrix() @ model.gravity_W, model.force_bias, model.centre_of_mass_S, model.torque_bias
    )


def test_ros2_on_the_ceiling_leaves_what_the_tissue_does_and_nothing_else():
    tool = mounted(CEILING)
    text = ros2_yaml(tool, sensor_frame="s", world_frame="w", down_W=CEILING)
    controller = node(read(text), "admittance_controller")
    assert controller["gravity_compensation"]["CoG"]["force"] == pytest.approx(-9.4)
    for R_WS in orientations(50):
        unbiased = broadcaster(node(read(text), "force_torque_sensor_broadcaster"), tool.predict(R_WS) + PUSH)
        world, _ = admittance(controller, unbiased, {"w": np.eye(3), "s": R_WS})
        np.testing.assert_allclose((world.reshape(2, 3) @ R_WS).ravel(), PUSH, atol=1e-9)
    assert "WARNING" not in text
    assert "Negative on purpose" in text
    assert "z up. Make it" not in text
    leaning = ros2_yaml(mounted(CEILING, TILTED), sensor_frame="s", world_frame="w", down_W=CEILING)
    assert f"tilted by {TILTED_BY} deg" in " ".join(leaning.replace("\n#", "").split())


def test_ros2_on_a_wall_holds_the_offset_alone_and_says_why():
    text = ros2_yaml(mounted(WALL), sensor_frame="s", world_frame="w", down_W=WALL)
    parameters = read(text)
    assert set(parameters) == {"force_torque_sensor_broadcaster"}
    reading = np.array([*TRUE.force_bias, *TRUE.torque_bias]) + PUSH
    np.testing.assert_allclose(
        broadcaster(node(parameters, "force_torque_sensor_broadcaster"), reading), PUSH, atol=1e-12
    )
    assert "# NO admittance_controller: it takes the weight along z" in text
    assert "#   [0.0, 1.0, 0.0]" in text


@pytest.mark.parametrize("down", [CEILING, WALL, (0.6, 0.0, -0.8), (0.0, -1.0, 0.0)])
def test_ft_calib_leaves_nothing_whatever_way_is_down(down):
    tool = mounted(down, TILTED)
    text = ft_calib_yaml(tool, com_frame="s", down_W=down)
    imu = np.array(value(re.findall(r"# +(\[.*\])  release", text)[0]))
    for R_WS in orientations(50):
        tf = {"imu": R_WS.T, "s": np.eye(3)}
        assert np.abs(gravity_compensation(read(text), tool.predict(R_WS), imu, tf, 1.0)).max() < 1e-9
    assert "z up" not in text
    assert f"down in it is [{', '.join(map(str, down))}]" in text
    # An imu that reads the true vertical leaves what the warning says.
    assert f"tilted by {TILTED_BY} deg" in " ".join(text.replace("\n#", "").split())


@pytest.mark.parametrize("make", [ros2_yaml, ft_calib_yaml])
@pytest.mark.parametrize("down", [(0.0, 0.0, -1.0), CEILING, WALL, (0.6, 0.0, 0.8)])
def test_gravity_against_the_direction_that_was_given_is_refused(make, down):
    names = {"com_frame": "s"} if make is ft_calib_yaml else {"sensor_frame": "s", "world_frame": "w"}
    make(mounted(down), **names, down_W=down)
    with pytest.raises(InputError, match=r"points up .*--down"):
        make(mounted(-np.array(down)), **names, down_W=down)


@pytest.mark.parametrize(
    ("down", "along"),
    [((0, 0, -1), -1), ((0, 0, 1), 1), ((0.08, 0, 0.9968), 1), ((0.1, 0, -0.995), None), (WALL, None)],
)
def test_down_is_along_z_within_some_degrees(down, along):
    assert down_along_z(down) == along


# ---- what is lost --------------------------------------------------------------------------------


def test_a_tilt_is_stated_with_its_size_and_warned_of():
    vertical = vertical_residual(fit(TILTED, noise=1.0))
    arm = np.linalg.norm(TILTED.centre_of_mass_S)
    horizontal = 9.4 * math.sin(math.radians(TILTED_BY))
    found = [vertical.tilt, vertical.force, vertical.torque]
    np.testing.assert_allclose(found, [TILTED_BY, horizontal, horizontal * arm], rtol=0.1)
    assert math.isclose(vertical.weight, 9.4 * math.cos(math.radians(TILTED_BY)), rel_tol=0.01)
    (warning,) = vertical.warnings
    assert f"{vertical.tilt:.3g} deg" in warning
    assert f"{vertical.force:.2g} N and {vertical.torque:.2g} N*m" in warning
    assert "# WARNING" in ros2_yaml(TILTED, sensor_frame="s", world_frame="w")


def test_exact_data_of_a_level_base_raises_no_warning(exact):
    vertical = vertical_residual(exact)
    assert vertical.warnings == ()
    assert vertical.force < 1e-12
    assert "WARNING" not in ros2_yaml(exact, sensor_frame="s", world_frame="w")


def test_noise_of_a_level_base_is_seldom_taken_for_a_tilt():
    alarms = sum(bool(vertical_residual(fit(TRUE, noise=1.0, seed=seed)).warnings) for seed in range(20))
    assert alarms <= 5


def test_sigma_is_what_the_calibration_leaves_on_average():
    model = fit(TILTED, noise=1.0)
    vertical = vertical_residual(model)
    C = model.wrench_covariance(orientations(20_000))
    force, torque = C[:, :3, :3].trace(axis1=1, axis2=2), C[:, 3:, 3:].trace(axis1=1, axis2=2)
    assert math.isclose(vertical.force_sigma, math.sqrt(force.mean()), rel_tol=0.01)
    assert math.isclose(vertical.torque_sigma, math.sqrt(torque.mean()), rel_tol=0.01)


def test_without_a_covariance_every_tilt_counts():
    assert vertical_residual(TRUE).warnings == ()
    assert len(vertical_residual(TILTED).warnings) == 1
    assert vertical_residual(TILTED).force_sigma == 0
    assert "1 sigma:" not in ros2_yaml(TILTED, sensor_frame="s", world_frame="w")


def test_a_bare_sensor_has_no_weight_to_export():
    bare = GravityModel(np.zeros(3), TRUE.force_bias, np.zeros(3), TRUE.torque_bias)
    assert vertical_residual(bare) == VerticalResidual(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, ())
    centre = node(read(ros2_yaml(bare, sensor_frame="s", world_frame="w")), "admittance_controller")
    assert centre["gravity_compensation"]["CoG"] == {"pos": [0.0, 0.0, 0.0], "force": 0.0}
    with pytest.raises(InputError, match="mass of zero"):
        ft_calib_yaml(bare, com_frame="s")


def test_gravity_that_points_up_within_the_noise_is_no_weight():
    up = GravityModel([0.001, 0.0, 0.015], *np.zeros((3, 3)), 1e-4 * np.eye(12))
    assert (vertical_residual(up).weight, vertical_residual(up).warnings) == (0, ())


def test_gravity_that_points_up_is_refused():
    up = GravityModel(-TRUE.gravity_W, TRUE.force_bias, TRUE.centre_of_mass_S, TRUE.torque_bias)
    with pytest.raises(InputError, match="points up"):
        ros2_yaml(up, sensor_frame="s", world_frame="w")
    with pytest.raises(InputError, match="points up"):
        ft_calib_yaml(up, com_frame="s")


# ---- the text ------------------------------------------------------------------------------------


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_a_yaml_float_and_reads_back(number):
    text = yaml_number(number)
    assert FLOAT.fullmatch(text)
    assert float(text) == number


@pytest.mark.parametrize(
    ("number", "text"),
    [(1e-5, "1.0e-05"), (0, "0.0"), (-0.0, "0.0"), (-2, "-2.0"), (1e22, "1.0e+22"), (1.25e-7, "1.25e-07")],
)
def test_numbers_carry_a_point(number, text):
    assert yaml_number(number) == text


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_none_are_refused(number):
    with pytest.raises(InputError, match="not finite"):
        yaml_number(number)


def test_a_yaml_library_reads_the_same():
    yaml = pytest.importorskip("yaml")
    tiny = GravityModel([0, 0, -1e-5], [1e-7, 2, -0.0], [1e-9, 0, 1], [3, 1e-12, 0], 1e-9 * np.eye(12))
    for text in (
        ros2_yaml(tiny, sensor_frame="off", world_frame="1e5", broadcaster="on", admittance="/ns/adm"),
        ros2_yaml(fit(TILTED, noise=1.0), sensor_frame="a-b.c/d", world_frame="no", sensor_name="null"),
        ft_calib_yaml(tiny, com_frame="123", child_frame="true"),
    ):
        assert yaml.safe_load(text) == read(text)


def test_the_admittance_controller_is_led_to_readings_without_bias(exact):
    text = ros2_yaml(
        exact,
        sensor_frame="s",
        world_frame="w",
        sensor_name="wrist",
        broadcaster="/arm/fts",
        admittance="adm",
    )
    parameters = read(text)
    assert node(parameters, "/arm/fts")["sensor_name"] == "wrist"
    assert node(parameters, "adm")["ft_sensor"]["name"] == "fts/wrist"
    unnamed = ros2_yaml(exact, sensor_frame="s", world_frame="w")
    assert "name" not in node(read(unnamed), "admittance_controller")["ft_sensor"]
    assert "removes no bias" in unnamed


def test_a_sensor_name_that_nobody_gave_is_a_placeholder_to_uncomment(exact):
    unnamed = ros2_yaml(exact, sensor_frame="s", world_frame="w", broadcaster="fts")
    assert "sensor_name" not in node(read(unnamed), "fts")
    assert "FILL IN" in unnamed
    filled = re.sub(r"# (sensor_name|name): (.*)SENSOR_NAME", r"\1: \2wrist", unnamed)
    parameters = read(filled)
    assert node(parameters, "fts")["sensor_name"] == "wrist"
    assert node(parameters, "admittance_controller")["ft_sensor"]["name"] == "fts/wrist"
    given = ros2_yaml(exact, sensor_frame="s", world_frame="w", sensor_name="wrist")
    assert "FILL IN" not in given
    assert "SENSOR_NAME" not in given


def test_the_head_says_that_it_is_a_fragment_for_which_releases_and_what_to_beware_of(exact):
    head = ros2_yaml(exact, sensor_frame="s", world_frame="w").split("ros__parameters")[0]
    words = " ".join(line.removeprefix("# ") for line in head.splitlines())
    assert "FRAGMENT" in words
    assert f"Checked against the sources of ros2_controllers {', '.join(CHECKED)}" in words
    for release in ("4.42.0", "4.42.1", "5.17.0", "6.9.0"):
        assert release in words.partition("CAUTION")[2]
    assert set(CHECKED) <= set(re.findall(r"\d+\.\d+\.\d+", ROS_PAGE.read_text("utf-8")))


# ---- the text -------------------------------------------------------------------------------------

NAMED = {"sensor_frame": "tool/ft", "world_frame": "w"}


def test_the_text_stays_to_the_byte():
    """What robots were set up with reads the same from one release to the next."""
    load = GravityModel(
        [0.5, 0.25, -4.0], [1.0, -2.0, 0.5], [0.0, 0.125, 0.25], [0.5, 0.0, -0.25], np.eye(12) / 64
    )
    assert digest_of(load, DOWN_W) == "e6947be7e499ecf6"
    for down, weight, digest in (
        (CEILING, [0.5, 0.25, 4.0], "138a8fe472412847"),
        (WALL, [0.5, 4.0, 0.25], "bee4b4e4abf46424"),
    ):
        tool = GravityModel(weight, load.force_bias, load.centre_of_mass_S, load.torque_bias, load.covariance)
        assert digest_of(tool, down) == digest


def digest_of(model: GravityModel, down: Any) -> str:
    texts = (
        ros2_yaml(model, **NAMED, down_W=down),
        ros2_yaml(model, **NAMED, sensor_name="a.b-c", down_W=down),
        ft_calib_yaml(model, com_frame="s", child_frame="load", down_W=down),
    )
    return hashlib.sha256("".join(texts).replace(__version__, "").encode()).hexdigest()[:16]


def test_files_say_units_signs_and_version_but_no_date_and_no_path(exact):
    for text in (
        ros2_yaml(exact, sensor_frame="ft_sensor", world_frame="base_link"),
        ft_calib_yaml(exact, com_frame="ft_sensor"),
    ):
        assert f"contactbench {__version__}" in text
        assert re.search(r"ADDED|SUBTRACTED", text)
        assert "N*m" in text
        assert "1 sigma:" in text
        assert not re.search(r"20\d\d-|(^|\s)/\w", text)  # no date, no path
        assert max(map(len, text.splitlines())) < 140  # three numbers with all their digits, and a few words


@pytest.mark.parametrize(
    "name",
    [
        "",
        " ",
        "a b",
        201 * "a",
        "/ft_sensor",
        "ft/",
        "a//b",
        'a"b',
        "a:b",
        "a#b",
        "a\nb",
        "ft_sensor\n",
        "é",
        "{a}",
    ],
)
@pytest.mark.parametrize("where", ["sensor_frame", "world_frame", "sensor_name"])
def test_frames_that_a_consumer_would_refuse_are_refused_here(exact, where, name):
    names = {"sensor_frame": "s", "world_frame": "w", where: name}
    with pytest.raises(InputError, match=where):
        ros2_yaml(exact, **names)
    if where == "sensor_frame":
        with pytest.raises(InputError, match="com_frame"):
            ft_calib_yaml(exact, com_frame=name)
        with pytest.raises(InputError, match="child_frame"):
            ft_calib_yaml(exact, com_frame="s", child_frame=name)


@pytest.mark.parametrize("name", ["", "1st", "a-b", "a.b", "a b", "a/", "/a/2", "ä"])
def test_node_names_that_ros_would_refuse_are_refused_here(exact, name):
    with pytest.raises(InputError, match="broadcaster"):
        ros2_yaml(exact, sensor_frame="s", world_frame="w", broadcaster=name)
    with pytest.raises(InputError, match="admittance"):
        ros2_yaml(exact, sensor_frame="s", world_frame="w", admittance=name)


def test_two_things_need_two_names(exact):
    with pytest.raises(InputError, match="two nodes"):
        ros2_yaml(exact, sensor_frame="s", world_frame="w", broadcaster="adm", admittance="adm")
    with pytest.raises(InputError, match="two names"):
        ft_calib_yaml(exact, com_frame="s", child_frame="s")
