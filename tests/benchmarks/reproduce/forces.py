"""How the force of a touch matters: to the contact's place, and whether the filtered force itself is right."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.reproduce.locating import OURS, solver_for
from benchmarks.reproduce.statistics import Errors, Located, bounds_m, errors_of

from contactbench.pipeline.simulation.scenes import Press
from contactbench.pipeline.study.marker_touches import ANGLES, Station, row, stack
from contactbench.pipeline.study.paper_setup import read_touches

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.study.marker_touches import Touched
    from contactbench.pipeline.study.paper_setup import Bench

FORCES_N = (1.0, 2.0, 5.0, 10.0, 15.0, 20.0)
RISING_N = (5.0, 10.0, 15.0, 20.0)
MARKER = 3
_READINGS = 20  # of each touch and seed, with fresh noise


@dataclass(frozen=True, eq=False)
class ForceErrors:
    """One force at one angle."""

    force: float  # N
    angle: str
    errors: Errors
    answers_mm: NDArray[np.float64]  # (n, 2). Each answer less the true contact, along the x and y axes of S.


def by_force(
    name: str, facets: int, marker_S: NDArray[np.float64], benches: Sequence[Bench], key: int
) -> list[ForceErrors]:
    """Press one marker at every angle with `FORCES_N`, and locate many readings of each touch."""
    station = Station(name, marker_S)
    found: list[ForceErrors] = []
    for index, (angle, (tilt, azimuth)) in enumerate(ANGLES.items()):
        for force in FORCES_N:
            moment = station.touch(Press(force, tilt, azimuth))
            rows = [
                row((bench.seed, MARKER, index, repeat), station.scene.marker_S, moment)
                for bench in benches
                for repeat in range(_READINGS)
            ]
            found.append(_located(name, facets, stack(rows), benches, key + len(found), force, angle))
    return found


def force_errors(
    name: str, markers_S: NDArray[np.float64], benches: Sequence[Bench], key: int
) -> NDArray[np.float64]:
    """Press every marker with `RISING_N`, and compare the filtered force with the true one."""
    rows = []
    for number, marker_S in enumerate(markers_S):
        station = Station(name, marker_S)
        for index, (tilt, azimuth) in enumerate(ANGLES.values()):
            for repeat, force in enumerate(RISING_N):
                moment = station.touch(Press(force, tilt, azimuth))
                rows.append(row((0, number + 1, index, repeat), station.scene.marker_S, moment))
    touched = stack(rows)
    true = np.linalg.norm(touched.contacts[:, :3], axis=1)
    off = []
    for bench in benches:
        read = read_touches(bench, touched.contacts, touched.R_WS, key)
        off.append(np.abs(np.linalg.norm(read[:, :3], axis=1) - true))
    mean = np.mean(off, axis=0).reshape(len(markers_S), len(ANGLES), len(RISING_N))
    return np.asarray(mean.mean(axis=2))


def _located(
    name: str,
    facets: int,
    touched: Touched,
    benches: Sequence[Bench],
    key: int,
    force: float,
    angle: str,
) -> ForceErrors:
    parts, bounds = [], []
    for bench in benches:
        mine = touched.where(touched.seeds == bench.seed)
        wrenches = read_touches(bench, mine.contacts, mine.R_WS, key)
        method = solver_for(OURS, name, facets, bench, mine.R_WS)
        parts.append(Located.of(method.locate_batch(wrenches)))
        bounds.append(bounds_m(mine, bench))
    located = Located.joined(parts)
    return ForceErrors(
        force,
        angle,
        errors_of(located, touched, np.concatenate(bounds)),
        1e3 * (located.points - touched.points)[located.answered, :2],
    )
