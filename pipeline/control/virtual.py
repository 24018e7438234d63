"""A virtual robot for a bundle: the probe and the sensor that it tells of, over a phantom that moves."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.control.controller import Controller
from contactbench.pipeline.control.loop import Rig, arm_of
from contactbench.pipeline.control.settings import ControlSettings, Foundation, Variant
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.physics import Payload, TrueSurface
from contactbench.pipeline.simulation.scenes.platform import MovedScene, PlatformMotion, PlatformScene, Tissue
from contactbench.pipeline.simulation.scenes.setpoints import ServoSettings
from contactbench.pipeline.simulation.sensor_model import SensorModel, SensorSettings

ROBOTS = ("virtual://arm", "virtual://platform")
_FASTEST_HZ = 1000.0


def virtual_robot(
    config: RuntimeConfig,
    address: str = ROBOTS[0],
    *,
    variant: Variant | None = None,
    method: str = "contactbench",
    motion: PlatformMotion | None = None,
    stiffness: float | None = None,
    friction: float = 0.1,
    quaternion_ES: ArrayLike | None = None,
    seed: int = 0,
) -> Rig:
    """
    Make a robot that a bundle fits.

    Weight, bias and centre of mass are drawn from what the calibration says of its own uncertainty: the controller
    believes the bundle, which is not quite the truth. The probe's true surface is the bundle's mesh.

    Parameters
    ----------
    address : str
        One of `ROBOTS`.
    variant : Variant, optional
        Another one than the bundle's.
    stiffness : float, optional
        Of the phantom at the wanted force, N/m; left out, that of soft tissue.
    quaternion_ES : (4,), optional
        How the sensor is turned on the flange, w, x, y, z, for a bundle that does not say.

    Raises
    ------
    InputError
        The address is not of a virtual robot, or the bundle lacks something.
    """
    check_address(address)
    rng = np.random.default_rng([seed, 4])
    told = config.model.frames.quaternion_ES if quaternion_ES is None else quaternion_ES
    R_ES = np.eye(3) if told is None else Rotation.from_quat(np.asarray(told), scalar_first=True).as_matrix()
    mean = config.model.gravity
    parts = mean.gravity_W_N, mean.force_bias_N, mean.centre_of_mass_S_m, mean.torque_bias_Nm
    drawn = rng.multivariate_normal(np.concatenate(parts), np.array(mean.covariance), method="eigh")
    weight_W, force_bias, centre, torque_bias = drawn.reshape(4, 3)
    tissue = _tissue(config, stiffness, friction)
    payload = Payload(float(np.linalg.norm(weight_W)) / STANDARD_GRAVITY, centre)
    scene = _scene(config, address, R_ES, payload, tissue, motion)
    scene.model.opt.gravity[:] = STANDARD_GRAVITY * weight_W / np.linalg.norm(weight_W)
    controller = Controller.from_config(
        config,
        arm_of(scene),
        scene.start,
        p_ES_E=scene.p_ES_E,
        quaternion_ES=quaternion_ES,
        method=method,
        variant=variant,
    )
    return Rig(scene, controller, SensorModel(_sensor(config, force_bias, torque_bias), rng))


def check_address(address: str) -> None:
    """
    Refuse every robot that is not virtual.

    Raises
    ------
    InputError
        It is another one.
    """
    if address not in ROBOTS:
        raise InputError(
            f"robot {arg(address)!r}: motion is only sent to a virtual robot, never to a real one: give"
            f" {arg(' or '.join(ROBOTS))}. A real arm needs its maker's controller, which loads the"
            " same bundle."
        )


def _scene(
    config: RuntimeConfig,
    address: str,
    R_ES: NDArray[np.float64],
    payload: Payload,
    tissue: Tissue,
    motion: PlatformMotion | None,
) -> MovedScene:
    truth, part = TrueSurface(config.probe), config.model.controller
    period = ControlSettings.period if part is None else part.period_s
    if address == ROBOTS[0]:
        servo = ServoSettings(period=period)
        return ArmScene(truth, payload=payload, tissue=tissue, motion=motion, servo=servo, R_ES=R_ES)
    if not np.allclose(R_ES, np.eye(3), atol=1e-6):
        raise InputError(
            f"robot {arg(address)}: its mount holds the sensor unturned, but the bundle says that it is turned: give"
            f" {arg(ROBOTS[0])}."
        )
    return PlatformScene(truth, payload=payload, tissue=tissue, motion=motion, period=period)


def _tissue(config: RuntimeConfig, stiffness: float | None, friction: float) -> Tissue:
    part = config.model.controller
    force = ControlSettings.desired_force if part is None else part.desired_force_N
    modulus = Tissue().modulus
    if stiffness is not None:
        if not 0 < stiffness < 1e6:
            raise InputError(
                f"stiffness {arg(stiffness):g} N/m: give a number above 0; soft tissue has 300 to 20,000."
            )
        modulus = Foundation(config.probe).modulus_of(force, stiffness)
    return Tissue(modulus, modulus / 60, friction)


def _sensor(
    config: RuntimeConfig, force_bias: NDArray[np.float64], torque_bias: NDArray[np.float64]
) -> SensorSettings:
    noise = config.model.noise
    return SensorSettings(
        noise=np.array([*noise.force_N, *noise.torque_Nm]),
        bias=np.concatenate([force_bias, torque_bias]),
        limit=np.array(Gates.of_stored(config.model.gates).saturation),
        rate=min(config.model.sensor.rate_Hz, _FASTEST_HZ),
    )
