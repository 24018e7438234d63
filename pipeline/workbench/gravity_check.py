"""One more still pose that a calibration has not seen: does it hold there."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.reachable import by_hand, describe
from contactbench.pipeline.calibration.stillness import StillnessDetector, StillState
from contactbench.pipeline.calibration.verify import StillVerification, verify_still

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import Calibration, PoseSample
    from contactbench.pipeline.workbench.gravity_settings import GravitySettings
    from contactbench.pipeline.workbench.live import Block

_NEAREST = np.radians(15.0)  # to a pose that the calibration has seen: nearer, it tells little
_NEAR = "This is nearly a pose that the calibration was made from: turn the tool further."


class GravityCheck:
    """
    Waits for a still pose that differs from a calibration's own, and compares.

    One pose says little; each further check counts those before it too.

    Parameters
    ----------
    calibration : Calibration
    settings : GravitySettings
    live_R_ES : (3, 3), optional
        The mount that is in the orientations of the samples to come; left out: that of the settings.
    before : sequence of PoseSample
        Of earlier checks.

    Attributes
    ----------
    found : StillVerification or None
        Once there was such a pose.
    poses : tuple of PoseSample
        All that were compared.
    proposal : (3, 3)
        R_WS in which the calibration is worth checking.
    """

    def __init__(
        self,
        calibration: Calibration,
        settings: GravitySettings,
        *,
        live_R_ES: NDArray[np.float64] | None = None,
        before: Sequence[PoseSample] = (),
    ) -> None:
        self._calibration, self._settings = calibration, settings
        self._R_SE_live = (settings.R_ES if live_R_ES is None else live_R_ES).T
        self._lock = threading.Lock()
        self._detector = StillnessDetector()
        self.poses = tuple(before)
        down = settings.down_W
        self._seen = np.array([down @ pose.R_WS for pose in (*calibration.poses, *before)])  # down, in S
        self._word = ""
        self.found: StillVerification | None = None
        self.proposal = self._farthest()

    @property
    def sentence(self) -> str:
        """What to do, or what is going on."""
        if self._word:
            return self._word
        stands = describe(self.proposal, self._settings.down_W)
        return f"Turn the tool to a pose that it was not in: {stands}. Then keep still."

    def _farthest(self) -> NDArray[np.float64]:
        """Return the orientation whose weight pulls least like that of any pose so far."""
        tilt, down = float(np.radians(self._settings.max_tilt)), self._settings.down_W
        candidates = by_hand(300, max_tilt=tilt, down_W=down).R_WS
        nearness = (np.array(down) @ candidates @ self._seen.T).max(axis=1)
        farthest: NDArray[np.float64] = candidates[int(np.argmin(nearness))]
        return farthest

    def feed(self, block: Block) -> None:
        """Take samples, in the streams' thread."""
        known = np.isfinite(block.wrenches).all(axis=1) & np.isfinite(block.R_WS).all(axis=(1, 2))
        known &= ~block.saturated
        if self.found is not None or not known.any():
            return
        with self._lock:
            R_WS = self._settings.sensor_orientations(block.R_WS[known] @ self._R_SE_live)
            before = len(self._detector.captures)
            now = self._detector.update_block(block.times[known], block.wrenches[known], R_WS)
            if now.state is StillState.MOVING:
                self._word = ""
            elif self._word is not _NEAR:
                self._word = now.sentence
            for capture in self._detector.captures[before:]:
                pose = capture.to_pose(name=f"check {len(self.poses) + 1}")
                if (
                    np.arccos(np.clip((self._seen @ (self._settings.down_W @ pose.R_WS)).max(), -1, 1))
                    < _NEAREST
                ):
                    self._word = _NEAR
                    continue
                self.poses = (*self.poses, pose)
                self.found = verify_still(self._calibration, self.poses)
                return

    @property
    def state(self) -> StillState:
        """What the reading does."""
        with self._lock:
            return self._detector.poll(-np.inf).state
