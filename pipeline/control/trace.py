"""What happened in a closed loop: one row for each period, with the truth beside what was sensed."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.states import ControlState

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.states import StateChange

STATES = tuple(ControlState)


@dataclass(frozen=True, eq=False)
class Trace:
    """A closed loop, a row per period."""

    time: NDArray[np.float64]  # (n,) s, of the scene, at the end of the period
    force: NDArray[np.float64]  # (n,) how hard the tissue is truly pressed along the probe's axis, N
    peak: NDArray[np.float64]  # (n,) largest |F| of the true contact in the period, N
    # (n,) what the controller took the force for, N; NaN without a fresh sample
    sensed: NDArray[np.float64]
    # (n, 2) sensed place of the contact less the wanted one, S, m; NaN where it was not known
    offset: NDArray[np.float64]
    # (n, 2) where it truly was at the end of the period, the same way; NaN in the air
    place: NDArray[np.float64]
    # (n,) torque of the true contact about the normal at its point, N·m; NaN in the air
    torsion: NDArray[np.float64]
    # (n,) how far that moves the wrench's axis away from the point, m: what a method that neglects it is
    # off by
    shift: NDArray[np.float64]
    # (n, 2) between the probe's axis and the phantom's normal, in plane and out of plane, rad
    angles: NDArray[np.float64]
    # phantom, probe: (n, 3) height of the phantom's middle and of the probe's tip, m, and their tilts in
    # plane and out of plane, rad, in the frame P where the phantom rests
    phantom: NDArray[np.float64]
    probe: NDArray[np.float64]
    joints: NDArray[np.float64]  # (n, k) Set-points, rad or m
    state: NDArray[np.int_]  # (n,) index in `STATES`
    share: NDArray[np.float64]  # (n,) what the arm's limits left of the wanted motion
    step_s: NDArray[np.float64]  # (n,) how long the controller took, s
    # (n,) how long the processor worked for it, s: without what else ran on the machine. These two are all
    # that is not the same each time.
    step_cpu_s: NDArray[np.float64]
    changes: tuple[StateChange, ...] = ()

    def __len__(self) -> int:
        return len(self.time)

    def between(self, start: float, end: float = np.inf) -> Trace:
        """Return the rows from a time on, up to another, s; all changes stay."""
        rows = (self.time >= start) & (self.time < end)
        cut = {each.name: getattr(self, each.name)[rows] for each in fields(self) if each.name != "changes"}
        return replace(self, **cut)

    def was(self, state: ControlState) -> NDArray[np.bool_]:
        """Return when it was in a state, (n,)."""
        return np.asarray(self.state == STATES.index(state))

    @property
    def tilt(self) -> NDArray[np.float64]:
        """Whole angle between the probe's axis and the phantom's normal, (n,), rad."""
        return np.asarray(np.arctan(np.linalg.norm(np.tan(self.angles), axis=1)))

    @property
    def ended(self) -> ControlState:
        """The state at the end."""
        return STATES[int(self.state[-1])]

    def csv(self) -> str:
        """Write it as CSV, in the units of the names, without what steps took."""
        joints = [f"joint_{k + 1}" for k in range(self.joints.shape[1])]
        heads = [*_HEADS, *joints, "state"]
        columns = [
            self.time,
            self.force,
            self.peak,
            self.sensed,
            *(1e3 * self.offset).T,
            *(1e3 * self.place).T,
            1e3 * self.torsion,
            1e3 * self.shift,
        ]
        columns += [*np.degrees(self.angles).T]
        for body in (self.phantom, self.probe):
            columns += [1e3 * body[:, 0], *np.degrees(body[:, 1:]).T]
        columns += [self.share, *self.joints.T]
        rows = (
            ",".join([*("" if np.isnan(value) else f"{value:.6g}" for value in row), STATES[state]])
            for row, state in zip(np.column_stack(columns).tolist(), self.state.tolist(), strict=True)
        )
        return "\n".join([",".join(heads), *rows]) + "\n"


_HEADS = (
    "time_s",
    "force_N",
    "peak_N",
    "sensed_force_N",
    "offset_x_mm",
    "offset_y_mm",
    "true_offset_x_mm",
    "true_offset_y_mm",
    "torsion_Nmm",
    "axis_shift_mm",
    "in_plane_deg",
    "out_of_plane_deg",
    "phantom_height_mm",
    "phantom_in_plane_deg",
    "phantom_out_of_plane_deg",
    "probe_height_mm",
    "probe_in_plane_deg",
    "probe_out_of_plane_deg",
    "share_of_motion",
)
