"""A small bench: pushes on the tip of a sphere-like probe, sample by sample, with a perfect calibration."""

from dataclasses import dataclass

import numpy as np
from benchmarks.verification import mesh

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.verification.markers import TouchLocator, make_markers, with_normals
from contactbench.pipeline.verification.protocol import ProtocolSettings, TouchProtocol

RATE = 200.0
MODEL = GravityModel(np.array([0, 0, -5.0]), np.zeros(3), np.array([0, 0, 0.05]), np.zeros(3))
NOISE = WrenchNoise(0.05, 0.0014)
SETTINGS = ProtocolSettings()


def probe():
    return mesh(2_000)


def markers():
    """Three markers along the face, 10 mm from each other, with normals."""
    points = np.array([[-0.01, 0, 0.2], [0.0, 0, 0.2], [0.01, 0, 0.2]])
    from contactbench.pipeline.kernel import SurfaceIndex

    _, _, feet = SurfaceIndex(probe().vertices, probe().faces).closest(points)
    return with_normals(make_markers(feet, ["left", "middle", "right"]), probe())[0]


@dataclass
class Push:
    """A press of a marker: |F| sample by sample, and what is special about it; twist is torque over force, m."""

    marker: int = 1
    force: float = 9.0
    held: float = 0.6
    rise: float = 0.05
    slide: float = 0.0
    wave: float = 0.0
    shift: float = 0.0
    twist: float = 0.0


def stream(*pushes, seed=0):
    """Return times, wrenches, R_WS of pushes with 0.3 s between them."""
    rng = np.random.default_rng(seed)
    targets, rows = markers(), [np.zeros((60, 6))]
    for push in pushes:
        n, ramp = round(push.held * RATE), round(push.rise * RATE)
        size = np.full(n, push.force) + push.wave * np.sin(np.arange(n) / RATE * 2 * np.pi * 3)
        size[:ramp] = np.linspace(0.5, push.force, ramp)
        normal = targets[push.marker].normal_S
        along = push.shift + push.slide * np.arange(n) / RATE
        points = targets[push.marker].point_S + along[:, None] * np.array([1.0, 0, 0])
        forces = -size[:, None] * normal
        torques = np.cross(points, forces) + push.twist * size[:, None] * normal
        rows += [np.hstack([forces, torques]), np.zeros((60, 6))]
    wrenches = np.vstack(rows)
    wrenches += rng.standard_normal(wrenches.shape) * np.repeat([0.05, 0.0014], 3)
    times = np.arange(len(wrenches)) / RATE
    return times, wrenches, np.tile(np.eye(3), (len(times), 1, 1))


def protocol(settings=SETTINGS):
    return TouchProtocol(TouchLocator(probe(), markers(), MODEL, NOISE, settings.samples), settings)


def touches(*pushes, settings=SETTINGS, saturated=None, seed=0):
    followed = protocol(settings)
    times, wrenches, R_WS = stream(*pushes, seed=seed)
    flags = None if saturated is None else np.isin(np.arange(len(times)), saturated)
    events = [*followed.feed(times, wrenches, R_WS, flags), *followed.finish()]
    return [event.touch for event in events if event.touch is not None]
