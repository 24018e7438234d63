"""Markers pressed in the physics scene: what the sensor would feel, and where the contact truly is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.simulation.marker_touches import truth_of
from contactbench.pipeline.simulation.scenes.indenter import TipPress, TouchScene, along, draw_press
from contactbench.pipeline.simulation.scenes.physics import SceneMoment

PERPENDICULAR, IN_PLANE, ACROSS = "perpendicular", "30° in plane", "30° across"
ANGLES = {PERPENDICULAR: (0.0, 0.0), IN_PLANE: (30.0, 0.0), ACROSS: (30.0, 90.0)}


@dataclass(frozen=True, eq=False)
class Touched:
    """Touches at rest, one row each; S, SI units."""

    # seeds, markers, angles, repeats: (n,) markers from 1; angles are rows of `ANGLES`
    seeds: NDArray[np.int_]
    markers: NDArray[np.int_]
    angles: NDArray[np.int_]
    repeats: NDArray[np.int_]
    # targets, points, normals: (n, 3) the marker, the true contact, and the outward normal there
    targets: Floats
    points: Floats
    normals: Floats
    contacts: Floats  # (n, 6) wrench on the probe about the sensor's origin
    R_WS: Floats  # (n, 3, 3) how the sensor is held: the force is vertical

    def __len__(self) -> int:
        return len(self.seeds)

    def where(self, chosen: Mask | NDArray[np.intp]) -> Touched:
        """Return some rows, by a mask or by number."""
        return Touched(*(getattr(self, field.name)[chosen] for field in fields(self)))


class MarkerStation:
    """
    The tip above one marker, ready to press it again and again.

    Parameters
    ----------
    name : str
        Probe.
    marker_S : (3,)
    """

    def __init__(self, name: str, marker_S: Floats) -> None:
        truth = truth_of(name)
        self.scene = TouchScene(truth, marker_S)
        self._where = self.scene.marker_S
        self._normal = truth.nearest(self._where)[1]

    def touch(self, press: TipPress) -> SceneMoment:
        """
        Lift, press, and wait until it rests.

        Raises
        ------
        InputError
            The tip slips.
        """
        self.scene.indenter.place(self._where, self._normal, along(self._normal))
        self.scene.press(press)
        moment = self.scene.settle()
        if moment is None:
            raise InputError(
                f"the tip slips at {np.round(1e3 * self._where, 1)} mm: choose a marker with more face around it."
            )
        return moment


def held(contact: Floats) -> Floats:
    """Return R_WS (3, 3) in which the force of a contact (6,) is straight up, as from a device on a table."""
    up_S = contact[:3] / np.linalg.norm(contact[:3])
    return np.asarray(Rotation.align_vectors([[0.0, 0.0, 1.0]], [up_S])[0].as_matrix())


def press_markers(
    name: str,
    markers_S: Floats,
    seeds: Sequence[int],
    repeats: int,
    progress: Callable[[], None] = lambda: None,
) -> Touched:
    """
    TipPress every marker at every angle, with forces and torsions drawn for each seed and repeat.

    Parameters
    ----------
    name : str
        Probe.
    markers_S : (n, 3)
    progress : callable
        Called after each marker.

    Returns
    -------
    Touched
        Ordered by seed, marker, angle and repeat.
    """
    rows = []
    for number, marker_S in enumerate(markers_S):
        station = MarkerStation(name, marker_S)
        for seed in seeds:
            rng = np.random.default_rng([seed, 3, assets.PROBE_NAMES.index(name), number])
            for angle, (tilt, azimuth) in enumerate(ANGLES.values()):
                for repeat in range(repeats):
                    moment = station.touch(draw_press(rng, tilt, azimuth))
                    rows.append(row((seed, number + 1, angle, repeat), station.scene.marker_S, moment))
        progress()
    pressed = stack(rows)
    return pressed.where(np.argsort(pressed.seeds, kind="stable"))


def row(index: tuple[int, int, int, int], target: Floats, moment: SceneMoment) -> tuple[object, ...]:
    """Return one touch as a row for `stack`."""
    return (*index, target, moment.point_S, moment.normal_S, moment.contact, held(moment.contact))


def stack(rows: Sequence[tuple[object, ...]]) -> Touched:
    """Put rows together."""
    return Touched(*(np.array(column) for column in zip(*rows, strict=True)))
