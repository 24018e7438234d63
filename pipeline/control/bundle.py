"""From a runtime config to what a controller is made of."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.config.runtime.values import gates_of, touch_model_of
from contactbench.pipeline.contact.noise import WrenchNoise
from contactbench.pipeline.control.command import Mount
from contactbench.pipeline.control.sensing import Intake
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from contactbench.pipeline.config.runtime.config import RuntimeConfig
    from contactbench.pipeline.control.settings import ControlSettings


def intake_of(config: RuntimeConfig, settings: ControlSettings, method: str = "contactbench") -> Intake:
    """
    Return what a bundle says of its sensor: gravity and bias, noise of a reading, gates, touch model.

    The bundle's filters are left out: a controller takes the mean of the readings of a period, and what a slow filter
    holds back is lost to its loops.

    Raises
    ------
    InputError
        There is no such method.
    """
    noise = WrenchNoise(config.model.noise.force_N, config.model.noise.torque_Nm)
    model = touch_model_of(config.model.touch)
    gates = gates_of(config.model.gates)
    # Odds stand with the regions: of the first of either kind all others follow.
    odds = {region.untouchable: region.odds for region in reversed(config.model.regions)}
    gates = replace(
        gates,
        region_odds=odds.get(False, gates.region_odds),
        untouchable_odds=1 / odds[True] if True in odds else gates.untouchable_odds,
    )
    return Intake(config.probe, config.gravity, noise, gates, model, method=method, stale=settings.stale)


def mount_of(config: RuntimeConfig, p_ES_E: ArrayLike, quaternion_ES: ArrayLike | None = None) -> Mount:
    """
    Return how the sensor sits on the flange.

    Parameters
    ----------
    p_ES_E : (3,)
        m; a bundle does not know it.
    quaternion_ES : (4,), optional
        w, x, y, z; for a bundle that does not say.

    Raises
    ------
    InputError
        Neither says, or they contradict each other.
    """
    told = config.model.frames.quaternion_ES
    given = None if quaternion_ES is None else np.asarray(quaternion_ES, dtype=np.float64)
    if told is None and given is None:
        raise InputError(
            "bundle: frames.quaternion_ES is null, its orientations were the sensor's own: say how the sensor sits on"
            " the flange."
        )
    if told is not None and given is not None and abs(float(np.dot(told, given))) < 1 - 1e-6:
        raise InputError(
            f"bundle: frames.quaternion_ES is {told}, but {given.tolist()} was given: leave it out, or calibrate anew."
        )
    quaternion = given if told is None else np.array(told)
    R_ES = Rotation.from_quat(np.asarray(quaternion), scalar_first=True).as_matrix()
    return Mount(R_ES, np.asarray(p_ES_E, dtype=np.float64))
