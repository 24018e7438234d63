"""What the scenes with a moving phantom leave out or choose, and how much that changes what a controller meets."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.simulation.marker_touches import check_bundled, truth_of
from contactbench.pipeline.simulation.scenes import (
    ArmScene,
    Payload,
    PlatformMotion,
    PlatformScene,
    ServoSettings,
    Tissue,
    depth_for,
)
from contactbench.pipeline.simulation.scenes.tissue import PLACES
from contactbench.pipeline.study.report import Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.mesh.arrays import Floats
    from contactbench.pipeline.simulation.scenes import MovedScene, SceneMoment, TrueSurface
    from contactbench.pipeline.study.report import Cell

FORCE_N = 7.0
MOTIONS = {
    "vertical": ("z", 0.01),
    "in plane": ("ry", np.radians(10)),
    "out of plane": ("rx", np.radians(10)),
}
AS_IT_IS = "platform, as it is"
ARM = "arm, as it is"
_REST_S, _PERIOD_S, _SAMPLE_S = 0.5, 0.02, 0.005
# The set-points go nine tenths of the way: 1 mm or 1 degree is left, as by a controller that is quite good.
_SHARE = 0.9
_GRAVITY = np.array([0.0, 0.0, -9.80665])


@dataclass(frozen=True, eq=False)
class Ride:
    """A probe that follows set-points beside a moving phantom; rows every 5 ms, after a quarter of a period."""

    force: Floats  # (n,) along the probe's axis, N
    angles: Floats  # (n, 2) in plane and out of plane, degrees
    places: Floats  # (n, 2) of the contact in S, mm
    # (n, 2) of the contact's force against the probe's axis, degrees: what friction adds
    leans: Floats
    # (n, 2) what the sensor reads beside contact and weight: |force|, N, and how far that moves a contact
    # of this force, mm
    inertia: Floats
    lag_ms: float  # by how much later than its set-points the carrier is there


@dataclass(frozen=True)
class SceneChange:
    """What a changed scene is compared with, how to make it, and how many places feel its tissue."""

    against: str
    make: Callable[..., MovedScene]
    places: int = PLACES


def changes(truth: TrueSurface) -> dict[str, SceneChange]:
    """Return each scene by what is changed in it."""

    def platform(friction: float = Tissue.friction, places: int = PLACES, **given: Any) -> SceneChange:
        tissue = Tissue(friction=friction)
        return SceneChange(
            AS_IT_IS,
            lambda **more: PlatformScene(truth, tissue=tissue, places=places, **more, **given),
            places,
        )

    def arm(against: str = ARM, **given: Any) -> SceneChange:
        return SceneChange(against, lambda **more: ArmScene(truth, **more, **given))

    return {
        AS_IT_IS: platform(),
        "half the time step": platform(step=0.0005),
        "2.5 times the time step": platform(step=0.0025),
        "50 places instead of 100": platform(places=50),
        "200 places": platform(places=200),
        "400 places": platform(places=400),
        "friction 0 instead of 0.3": platform(0.0),
        "friction 0.6": platform(0.6),
        ARM: arm(AS_IT_IS),
        "arm, half the time step": arm(step=0.0005),
        "arm, 2.5 times the time step": arm(step=0.0025),
        "arm, following with 30 rad/s instead of 60": arm(servo=ServoSettings(bandwidth=30.0)),
        "arm, holding with 60 rad/s instead of 120": arm(servo=ServoSettings(stiffness=60.0)),
        "arm, payload of 1 kg instead of 0.45": arm(payload=Payload(1.0)),
    }


def run(
    probes: Sequence[str] = ("convex",),
    period: float = 2.0,
    *,
    motions: Sequence[str] = tuple(MOTIONS),
    only: Sequence[str] | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """
    Ride every changed scene, and compare.

    Parameters
    ----------
    probes : sequence of str
        Bundled ones.
    period : float
        s, of the phantom's motion: 10 mm or 10 degrees to either side.
    motions : sequence of str
        Of `MOTIONS`.
    only : sequence of str, optional
        Of `changes`; what they are compared with comes along.
    progress : callable
        Told what is being done.

    Raises
    ------
    InputError
        There is no such probe, or MuJoCo is missing.
    """
    effects: list[tuple[Cell, ...]] = []
    inertia: list[tuple[Cell, ...]] = []
    factors: dict[tuple[str, str], float] = {}
    for probe in check_bundled(probes):
        truth = truth_of(probe)
        known = changes(truth)
        chosen = list(known) if only is None else _with_bases(only, known)
        for motion in motions:
            rides: dict[str, Ride] = {}
            for change in chosen:
                progress(f"{motion}: {change}")
                each = known[change]
                depth = depth_for(truth, FORCE_N, places=each.places)  # the same force, not the same depth
                rides[change], factor = ride(each.make, *MOTIONS[motion], period, depth)
                factors[probe, change] = min(factor, factors.get((probe, change), np.inf))
                if change != each.against:
                    differences = _differences(rides[change], rides[each.against])
                    effects.append((probe, motion, change, *differences, rides[change].lag_ms))
                if change in (AS_IT_IS, ARM):
                    inertia.append((probe, motion, change, *rides[change].inertia.max(axis=0).tolist()))
    sheets = (
        Sheet("effects", "What a change of the scene changes", _EFFECTS, tuple(effects)),
        Sheet("inertia", "What the sensor reads beside contact and weight", _INERTIA, tuple(inertia)),
        Sheet(
            "speed",
            "How fast, with a sample every 5 ms",
            _TIMES,
            tuple((*of, factor) for of, factor in factors.items()),
        ),
    )
    about = {"probes": ", ".join(dict.fromkeys(probes)), "period": f"{period:g} s"}
    return StudyReport("What the scenes with a moving phantom leave out", about, (), (_HOW,), sheets)


def ride(
    make: Callable[..., MovedScene],
    axis: str,
    size: float,
    period: float,
    depth: float,
    *,
    seen: Callable[[SceneMoment], None] = lambda _: None,
) -> tuple[Ride, float]:
    """
    Move a probe beside a phantom for a period and a quarter; return what was met, and simulated over real time.

    `seen` is told every moment of it.
    """
    motion = PlatformMotion.along(axis, size, period, _REST_S)
    followed = PlatformMotion.along(axis, _SHARE * size, period, _REST_S)
    scene = make(motion=motion, gap=-depth)
    count = round((_REST_S + 1.25 * period) / _PERIOD_S)
    settled = round((_REST_S + 0.25 * period) / _PERIOD_S)
    rows, behind, q = [], [], scene.start
    spent = 0.0
    for k in range(count):
        where = scene.held_at(-depth, followed.at((k + 1) * _PERIOD_S))
        before, q = q, scene.joints_for(*where, q)
        begun = time.perf_counter()
        scene.command(q)
        for _ in range(round(_PERIOD_S / _SAMPLE_S)):
            scene.advance(_SAMPLE_S)
            moment = scene.moment()
            if k >= settled:
                rows.append(_row(scene, moment))
                seen(moment)
        spent += time.perf_counter() - begun
        if k >= settled:
            behind.append((q - scene.true_joints, (q - before) / _PERIOD_S))
    table = np.array(rows)
    off, speed = np.array(behind).transpose(1, 0, 2)
    lag = 1e3 * float((off * speed).sum() / (speed * speed).sum())
    return Ride(
        table[:, 0], table[:, 1:3], table[:, 3:5], table[:, 5:7], table[:, 7:9], lag
    ), scene.time / spent


def _row(scene: MovedScene, moment: SceneMoment) -> list[float]:
    angles = np.degrees(scene.angles())
    # Of the payload, as MuJoCo has it: what is read beside contact and weight is inertia.
    body = scene.model.body("probe").id
    weight = moment.R_WS.T @ (scene.model.body_mass[body] * _GRAVITY)
    left = moment.reading - moment.contact
    force = left[:3] - weight
    torque = left[3:] - np.cross(scene.model.body_ipos[body], weight) - np.cross([0, 0, scene.top], force)
    moved = 1e3 * float(np.linalg.norm(torque[:2])) / FORCE_N
    return [
        -moment.contact[2],
        *angles,
        *(1e3 * moment.centroid_S[:2]),
        *np.degrees(np.arctan2(moment.contact[:2], -moment.contact[2])),
        float(np.linalg.norm(force)),
        moved,
    ]


def _with_bases(only: Sequence[str], known: dict[str, SceneChange]) -> list[str]:
    wanted = set(only)
    for change in only:
        base = known[change].against
        wanted |= {base, known[base].against}
    return [change for change in known if change in wanted]


def _differences(a: Ride, b: Ride) -> list[float]:
    """Return the root mean square and the largest of each difference, in the order of `_EFFECTS`."""
    differences = [np.abs(a.force - b.force)]
    for one, other in ((a.angles, b.angles), (a.places, b.places), (a.leans, b.leans)):
        differences.append(np.linalg.norm(one - other, axis=1))
    return [
        float(figure) for each in differences for figure in (np.sqrt(np.nanmean(each**2)), np.nanmax(each))
    ]


_EFFECTS = (
    "probe", "motion", "change", "N rms", "N most", "deg rms", "deg most", "mm rms", "mm most", "lean rms", "lean most",
    "lag ms",
)  # fmt: skip
_INERTIA = ("probe", "motion", "scene", "N most", "mm most")
_TIMES = ("probe", "scene", "times real time")
_HOW = (
    f"Set-points from the truth follow {_SHARE:.0%} of the phantom's motion, {FORCE_N:g} N. Differences are against the"
    " platform as it is; those of the arm's own settings against the arm as it is."
)
