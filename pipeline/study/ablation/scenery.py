"""Choices of what a scene simulates: a phantom that yields, and an arm with dynamics of its own."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.simulation.marker_touches import truth_of
from contactbench.pipeline.study import scene_limits
from contactbench.pipeline.study.ablation.records import LEAST_N, SAMPLE_S, pressed, ridden

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes import SceneMoment, TrueSurface

    Array = NDArray[np.float64]

_T = TypeVar("_T")
PHANTOM, ARM_DYNAMICS = CHOICES = ("deformable phantom", "arm dynamics")
_RIDE_SAMPLE_S = 0.005
_FINE_S = 0.0005
_TOUCHING_M = 2e-5  # what lies so near to the foremost place touches a rigid plane, too


@dataclass(frozen=True)
class SceneryDifference:
    """What leaving a choice out changes in the truth of a scene."""

    choice: str
    scene: str
    probe: str
    motion: str
    samples: int
    # mean_mm, rms_mm, p95_mm: how far the contact moves on the probe
    mean_mm: float
    rms_mm: float
    p95_mm: float
    # the same, root mean square, for half the time step: less than this the scene does not know
    floor_mm: float
    # root mean square difference of the force; None where a rigid body's is whatever one pushes with
    force_n: float | None
    # without_us, made_us: of computing a millisecond of the scene
    without_us: float
    made_us: float


def phantom_pressed(probe: str, size: int) -> SceneryDifference:
    """Press by hand on tissue, and compare with where a rigid plane that is turned the same would touch."""
    truth = truth_of(probe)
    (scene, soft), seconds = _timed(lambda: pressed(truth, size))
    _, fine = pressed(truth, size, step=_FINE_S)
    turns = Rotation.from_euler("XYZ", [scene.motion.at(moment.time)[3:] for moment in soft])
    return _on_rigid(
        truth, "press", "by hand", (soft, fine), turns.apply([0.0, 0.0, 1.0]), seconds / len(soft) / SAMPLE_S
    )


def phantom_ridden(probe: str, motion: str) -> SceneryDifference:
    """Follow a platform with tissue on it, and compare with where a rigid plane that is turned the same would touch."""
    truth = truth_of(probe)
    known = scene_limits.changes(truth)
    (met, soft), seconds = _timed(lambda: ridden(truth, known[scene_limits.AS_IT_IS].make, motion))
    fine = ridden(truth, known["half the time step"].make, motion)[1]
    slopes = np.tan(np.radians(met.angles))
    into = np.column_stack([slopes[:, 0], -slopes[:, 1], np.ones(len(slopes))])
    return _on_rigid(truth, "platform", motion, (soft, fine), into, seconds / len(soft) / _RIDE_SAMPLE_S)


def arm_ridden(probe: str, motion: str) -> SceneryDifference:
    """Follow a platform with an arm, and with a mount that goes where it is told."""
    truth = truth_of(probe)
    known = scene_limits.changes(truth)
    (_, arm), arm_s = _timed(lambda: ridden(truth, known[scene_limits.ARM].make, motion))
    (_, mount), mount_s = _timed(lambda: ridden(truth, known[scene_limits.AS_IT_IS].make, motion))
    fine = ridden(truth, known["arm, half the time step"].make, motion)[1]
    both = _touching(arm) & _touching(mount)
    forces = np.array([a.force - b.force for a, b in zip(arm, mount, strict=True)])[both]
    moved = _between(_points(arm), _points(mount))[both]
    per_ms = 1e3 / (len(arm) * _RIDE_SAMPLE_S)
    return _summed(
        (ARM_DYNAMICS, "arm", probe, motion),
        moved,
        _floor(arm, fine),
        float(np.sqrt(np.mean(forces**2))),
        (mount_s * per_ms, arm_s * per_ms),
    )


def foremost(probe_vertices: Array, into: Array) -> Array:
    """
    Return where a rigid plane touches a probe, (n, 3), m: the mean of what lies foremost.

    Parameters
    ----------
    probe_vertices : (m, 3)
    into : (n, 3)
        Directions from the probe into the plane.
    """
    found = np.empty((len(into), 3))
    for row, direction in enumerate(into):
        height = probe_vertices @ (direction / np.linalg.norm(direction))
        found[row] = probe_vertices[height > height.max() - _TOUCHING_M].mean(axis=0)
    return found


def _on_rigid(
    truth: TrueSurface,
    scene: str,
    motion: str,
    runs: tuple[Sequence[SceneMoment], Sequence[SceneMoment]],
    into: Array,
    soft_s: float,
) -> SceneryDifference:
    soft, fine = runs
    rigid, rigid_s = _timed(lambda: foremost(truth.probe.vertices, into))
    moved = _between(_points(soft), rigid)[_touching(soft)]
    return _summed(
        (PHANTOM, scene, truth.probe.name, motion),
        moved,
        _floor(soft, fine),
        None,
        (1e6 * rigid_s / len(into), 1e3 * soft_s),
    )


def _summed(
    names: tuple[str, str, str, str],
    moved: Array,
    floor: Array,
    force: float | None,
    times_us: tuple[float, float],
) -> SceneryDifference:
    rms, least = (float(np.sqrt(np.mean(mm**2))) for mm in (moved, floor))
    mean, p95 = float(moved.mean()), float(np.percentile(moved, 95))
    return SceneryDifference(*names, len(moved), mean, rms, p95, least, force, *times_us)


def _floor(one: Sequence[SceneMoment], other: Sequence[SceneMoment]) -> Array:
    return _between(_points(one), _points(other))[_touching(one) & _touching(other)]


def _points(moments: Sequence[SceneMoment]) -> Array:
    return np.array([moment.point_S for moment in moments])


def _touching(moments: Sequence[SceneMoment]) -> NDArray[np.bool_]:
    return np.array([moment.force > LEAST_N for moment in moments])


def _between(one: Array, other: Array) -> Array:
    return np.asarray(1e3 * np.linalg.norm(one - other, axis=1))


def _timed(run: Callable[[], _T]) -> tuple[_T, float]:
    began = time.perf_counter()
    made = run()
    return made, time.perf_counter() - began
