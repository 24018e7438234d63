"""All of the ablation: every choice in every scene, curves of where it begins to matter, and what it costs."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.ablation import location_choices, scenery, sensor_choices
from contactbench.pipeline.study.ablation.effects import (
    CHOICES,
    FILTERED,
    NOISES,
    QUIET,
    RAW,
    effect,
    meaningful,
)
from contactbench.pipeline.study.ablation.location_choices import locators, sigmas_of
from contactbench.pipeline.study.ablation.records import SCENES, SceneRecord, drawn, record

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

Row = dict[str, Any]
KIND = "ablation"
_MOST_SEEDS = 100
_NOISE_STEPS = (0.0, 0.001, 0.003, 0.01, 0.03, 0.1, FILTERED, 0.3, 1.0)
_TORSIONS_MM = (0.0, 0.1, 0.3, 1.0, 2.0, 3.0, 5.0, 10.0)
_ANGLES_DEG = (15.0, 30.0, 45.0, 60.0, 70.0, 80.0)
_AMOUNTS = {
    sensor_choices.DRIFT: (0.1, 0.3, 1.0, 2.0, 4.0, 8.0),
    sensor_choices.MOUNT: (0.1, 0.3, 1.0, 2.0, 5.0, 10.0),
    sensor_choices.CROSSTALK: (0.01, 0.03, 0.1, 0.3, 1.0, 3.0),
}


@dataclass(frozen=True)
class AblationSizes:
    """How much is done."""

    probes: tuple[str, ...] = assets.PROBE_NAMES
    scenes: tuple[str, ...] = SCENES
    facets: int = 2_000  # of the mesh in the scenes
    coarse: tuple[int, ...] = (300, 500, 1_000, 2_000)  # of the meshes on which smooth normals are tried
    twisted: tuple[int, ...] = (500, 2_000)  # of those, the ones on which the local torque is varied
    size: int = 15  # markers, and fifths of a second, of a scene
    touches: int = 4_000  # drawn for each point of a curve
    seeds: int = 5
    rounds: int = 20  # of timed blocks
    motions: tuple[str, ...] = ("vertical", "in plane", "out of plane")  # of the platform

    def __post_init__(self) -> None:
        for probe in self.probes:
            if probe not in assets.PROBE_NAMES:
                raise InputError(f"--probe {probe}: choose of {', '.join(assets.PROBE_NAMES)}.")
        for scene in self.scenes:
            if scene not in SCENES:
                raise InputError(f"--scene {scene}: choose of {', '.join(SCENES)}.")
        if not 1 <= self.seeds <= _MOST_SEEDS:
            raise InputError(f"--seeds {self.seeds}: give 1 to {_MOST_SEEDS}.")


QUICK = AblationSizes(
    probes=("linear",),
    scenes=("touch", "platform"),
    coarse=(500,),
    twisted=(500,),
    size=3,
    touches=400,
    seeds=2,
    rounds=2,
    motions=("in plane",),
)


def run(
    sizes: AblationSizes, *, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> list[Row]:
    """
    Measure everything.

    Parameters
    ----------
    seed : int
        Of touches and noise; that of each repetition is this one plus its number.
    progress : callable
        Told what is being done.

    Returns
    -------
    list of dict
        Plain rows of four kinds: ``effect``, ``curve``, ``scenery`` and ``cost``.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """
    rows: list[Row] = []
    progress("costs")
    rows += costs(sizes, seed)
    for probe in sizes.probes:
        progress(f"{probe}: touches drawn on the exact surface")
        rows += _curves(probe, sizes, seed)
        rows += effects(drawn(probe, sizes.touches, np.random.default_rng([seed, 14])), sizes, seed)
        for scene in sizes.scenes:
            progress(f"{probe}: scene {scene}")
            rows += effects(record(scene, probe, sizes.size), sizes, seed)
            rows += [{"kind": "scenery", **asdict(each)} for each in _scenery(scene, probe, sizes)]
    return rows


def effects(made: SceneRecord, sizes: AblationSizes, seed: int) -> Iterator[Row]:
    """Give every choice that can matter on a record, at every noise and for every seed."""
    for choice in CHOICES:
        if not meaningful(choice, made.scene):
            continue
        for name, noise in NOISES.items():
            for number in _seeds(noise, choice, sizes.seeds):
                about = {"choice": choice, "scene": made.scene, "probe": made.probe, "noise": name}
                figures = effect(choice, made, sizes.facets, noise, seed + number)
                yield {"kind": "effect", **about, "facets": sizes.facets, "seed": seed + number} | figures


def costs(sizes: AblationSizes, seed: int) -> list[Row]:
    """Time every choice beside doing without it."""
    rng = np.random.default_rng([seed, 12])
    rows = []
    for probe in sizes.probes:
        wrenches = drawn(probe, 2_000, rng).contacts
        wrenches = wrenches + sigmas_of(FILTERED) * rng.standard_normal(wrenches.shape)
        timed = locators(probe, sizes.facets, FILTERED).costs(wrenches, sizes.rounds)
        rows += [_cost(choice, probe, "a solve", *pair) for choice, pair in timed.items()]
    per = {
        sensor_choices.DRIFT: "a moment without contact",
        sensor_choices.MOUNT: "a calibration",
        sensor_choices.CROSSTALK: "a reading",
        sensor_choices.INERTIA: "a control period",
    }
    timed = sensor_choices.costs(rng, max(sizes.rounds // 2, 2))
    return rows + [_cost(choice, "", per[choice], *pair) for choice, pair in timed.items()]


def _cost(choice: str, probe: str, per: str, without: float, made: float) -> Row:
    return {
        "kind": "cost",
        "choice": choice,
        "probe": probe,
        "per": per,
        "without_us": without,
        "made_us": made,
    }


def _scenery(scene: str, probe: str, sizes: AblationSizes) -> Iterator[scenery.SceneryDifference]:
    if scene == "press":
        yield scenery.phantom_pressed(probe, sizes.size)
    for motion in sizes.motions:
        if scene == "platform":
            yield scenery.phantom_ridden(probe, motion)
        if scene == "arm":
            yield scenery.arm_ridden(probe, motion)


def _curves(probe: str, sizes: AblationSizes, seed: int) -> Iterator[Row]:
    for number in range(sizes.seeds):
        usual = drawn(probe, sizes.touches, np.random.default_rng([seed + number, 13]))
        for noise in _NOISE_STEPS:
            for facets, choice in product(sizes.coarse, location_choices.SMOOTHED):
                yield _point(choice, usual, facets, noise, seed + number, "noise", noise)
            yield _point(
                location_choices.LOCAL_TORQUE, usual, sizes.facets, noise, seed + number, "noise", noise
            )
        yield from _twisted(probe, sizes, seed + number)
        for choice, amounts in _AMOUNTS.items():
            for amount in amounts:
                unit = sensor_choices.UNITS[choice]
                yield _point(choice, usual, sizes.facets, FILTERED, seed + number, unit, amount, amount)


def _twisted(probe: str, sizes: AblationSizes, seed: int) -> Iterator[Row]:
    """Vary the local torque, and the angle of the force."""
    for torsion in _TORSIONS_MM:
        made = drawn(probe, sizes.touches, np.random.default_rng([seed, 13]), torsion=1e-3 * torsion)
        for noise in (QUIET, FILTERED, RAW):
            for choice, facets in (
                (location_choices.LOCAL_TORQUE, sizes.facets),
                *product(location_choices.SMOOTHED, sizes.twisted),
            ):
                yield _point(choice, made, facets, noise, seed, "torsion, mm", torsion)
    for angle in _ANGLES_DEG:
        made = drawn(probe, sizes.touches, np.random.default_rng([seed, 13]), angle=angle)
        for noise in (QUIET, FILTERED, RAW):
            yield _point(
                location_choices.GATE, made, sizes.facets, noise, seed, "force angle up to, deg", angle
            )


def _point(
    choice: str,
    made: SceneRecord,
    facets: int,
    noise: float,
    seed: int,
    name: str,
    x: float,
    amount: float | None = None,
) -> Row:
    about = {"choice": choice, "scene": made.scene, "probe": made.probe, "facets": facets, "seed": seed}
    figures = effect(choice, made, facets, noise, seed, amount)
    return {"kind": "curve", **about, "noise_times": noise, "x_name": name, "x": x} | figures


def _seeds(noise: float, choice: str, count: int) -> Sequence[int]:
    """Return the repetitions that differ: without noise only the sensors of the choices of reading do."""
    return range(count if noise > 0 or choice in sensor_choices.CHOICES else 1)
