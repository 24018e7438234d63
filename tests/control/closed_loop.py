"""A controller and a platform scene in a loop, as short as tests need it."""

from dataclasses import dataclass, replace

import numpy as np

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import Gates, WrenchNoise
from contactbench.pipeline.control.controller import Controller
from contactbench.pipeline.control.intake import SampleIntake
from contactbench.pipeline.control.inverse import CartesianMount
from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Foundation
from contactbench.pipeline.control.states import SensorMount
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.simulation.marker_touches import model_of, truth_of
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.scenes.platform import PlatformScene, Tissue

PAYLOAD = Payload()
QUICK = {"step": 0.0025, "places": 40}


def gravity(bias=(0.0,) * 6):
    force, torque = np.array(bias[:3]), np.array(bias[3:])
    return GravityModel([0, 0, -PAYLOAD.mass * 9.80665], force, PAYLOAD.centre_of_mass_S, torque)


def settings_for(name="t-shape", **changes):
    return replace(ControlSettings.for_probe(Foundation(model_of(name, 1000))), **changes)


@dataclass
class Ramp:
    """Tissue that moves to another place within 0.2 s, and stays: a motion of a scene."""

    amplitude: np.ndarray
    start: float

    def at(self, time):
        return self.amplitude * np.clip((time - self.start) / 0.2, 0.0, 1.0)

    def speed(self, time):
        return self.amplitude * (5.0 if 0 <= time - self.start < 0.2 else 0.0)


@dataclass
class Loop:
    """A scene and its controller; `step` goes on by one period."""

    scene: PlatformScene
    controller: Controller
    noise: tuple[float, float] = (0.05, 0.0014)
    seed: int = 0

    def __post_init__(self):
        self.rng = np.random.default_rng(self.seed)
        self.commands, self.forces, self.angles, self.times = [], [], [], []
        self.bias = np.zeros(6)

    def step(self, samples=None, joints=None):
        taken = []
        for _ in range(4):
            self.scene.advance(0.005)
            reading = self.scene.moment().reading + self.bias
            reading = reading + np.repeat(self.noise, 3) * self.rng.normal(size=6)
            taken.append(WrenchSample(self.scene.time, tuple(reading[:3]), tuple(reading[3:])))
        here = self.scene.joints if joints is None else joints
        command = self.controller.step(self.scene.time, here, taken if samples is None else samples)
        self.scene.command(command.q)
        self.commands.append(command)
        self.forces.append(-self.scene.moment().contact[2])
        self.angles.append(self.scene.angles())
        self.times.append(self.scene.time)
        return command

    def until(self, state, most=4.0):
        while self.scene.time < most:
            if self.step().state is state:
                return self
        raise AssertionError(f"{self.controller.state}, not {state}: {self.controller.safety.changes}")

    def run(self, seconds):
        for _ in range(round(seconds / 0.02)):
            self.step()
        return self


def loop(name="t-shape", settings=None, *, motion=None, modulus=USUAL_MODULUS, friction=0.1, noise=(0.05, 0.0014),
         bias=(0.0,) * 6, damping=1 / 60, seed=0, gap=0.002, course=None):  # fmt: skip
    tissue = Tissue(modulus, modulus * damping, friction, course=course)
    scene = PlatformScene(truth_of(name), payload=PAYLOAD, tissue=tissue, motion=motion, gap=gap, **QUICK)
    probe = model_of(name, 1000)
    intake = SampleIntake(probe, gravity(bias), WrenchNoise(0.05, 0.0014), Gates())
    mount = SensorMount(np.eye(3), np.zeros(3))
    controller = Controller(
        settings or settings_for(name), CartesianMount(), probe, intake, mount, scene.start
    )
    return Loop(scene, controller, noise, seed)
