"""How the sensor sits on the flange: what calibration, verification and config each took it to be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.calibration.files.calibration_file import CalibrationRecord

Quaternion = tuple[float, float, float, float]

UNTURNED = (1.0, 0.0, 0.0, 0.0)
_SAME_RAD = 1e-6


@dataclass(frozen=True)
class Mounts:
    """quaternion_ES (w, x, y, z) of a calibration and of a verification; None where it is not known."""

    calibrated: Quaternion | None = None  # None also means that the orientations were the sensor's own
    verified: Quaternion | None = None


def mount_of(record: CalibrationRecord) -> Quaternion | None:
    """Return quaternion_ES of a calibration; None: its orientations were the sensor's own."""
    if record.mount is None:
        return None
    w, x, y, z = record.mount.quaternion_SE.tolist()
    return w, -x, -y, -z


def mount_of_angles(degrees: Sequence[float] | None) -> Quaternion | None:
    """Return quaternion_ES of ``--mount``: turns about the fixed axes x, y, z, degrees; None stays None."""
    if degrees is None:
        return None
    x, y, z, w = Rotation.from_euler("xyz", degrees, degrees=True).as_quat(canonical=True).tolist()
    return w, x, y, z


def mount_reasons(
    mount: Quaternion | None, calibrated: Quaternion | None, verified: Quaternion | None
) -> list[str]:
    """
    Say where a config would turn the flange otherwise than what it rests on did.

    Parameters
    ----------
    mount : (4,) tuple or None
        Of the config.
    calibrated : (4,) tuple or None
        None: the calibration does not tell.
    verified : (4,) tuple or None
        None: the verification does not tell.
    """
    return [
        message(
            f"The {arg(what)} was made with the mounting {arg(_degrees(other))}, but the config has"
            f" {arg(_degrees(mount))}: {arg(remedy)}."
        )
        for what, other, remedy in (
            ("calibration", calibrated, message("calibrate again, or leave out --mount")),
            ("verification", verified, message("verify again with the mounting of the calibration")),
        )
        if other is not None and _apart(mount, other) > _SAME_RAD
    ]


def _apart(one: Quaternion | None, other: Quaternion) -> float:
    """Return the angle between two mountings, rad; None is unturned."""
    return float((_rotation(one or UNTURNED).inv() * _rotation(other)).magnitude())


def _rotation(quaternion: Quaternion) -> Rotation:
    return Rotation.from_quat(quaternion, scalar_first=True)


def _degrees(quaternion: Quaternion | None) -> str:
    if quaternion is None:
        return "none"
    vector = np.degrees(_rotation(quaternion).as_rotvec())
    return message(f"({arg(', '.join(f'{each:.3g}' for each in vector + 0.0))}) degrees as a rotation vector")
