"""Verification: does a calibration hold in poses that it has not seen."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag
from scipy.special import chdtrc, fdtrc

from contactbench.pipeline.calibration.calibrate import Calibration, matched_f
from contactbench.pipeline.calibration.model import prediction_jacobian
from contactbench.pipeline.calibration.poses import PoseSample, named, stack
from contactbench.pipeline.calibration.suggest import ContactTask, contact_sensitivity
from contactbench.pipeline.calibration.verdict import Level, Limits, Verdict
from contactbench.pipeline.errors import InputError, arg, message

Floats = NDArray[np.float64]

# Residuals that chance makes once in so many verifications are not what the calibration claims.
_DOUBT = 1e-3
# A verification of so few poses says little of other orientations.
_FEW = 3


@dataclass(frozen=True, eq=False)
class StillVerification:
    """How a calibration does in still, contact-free poses that it was not made from."""

    names: tuple[str, ...]  # Of the poses
    # (n, 6) read minus predicted, S, N and N·m: what a compensated reading shows although nothing touches
    residuals: Floats
    # Of the residuals' lengths, N and N·m
    force_rms: float
    torque_rms: float
    # (n,) length of each residual in standard deviations of what calibration and noise predict there; on
    # average its square is 6
    deviates: Floats
    # Of all residuals together; the calibration's error, which they share, is in their covariance
    chi_square: float
    freedom: int  # Its degrees of freedom, 6 n
    # Probability of residuals as large if the calibration's covariance and the noise are right
    p_value: float
    # (n, m) by how much each residual moves a contact, for each of the task's forces, m
    contact_errors: Floats
    # The rms that calibration and noise predict for the worst of the forces, m
    predicted_contact_error: float
    limits: Limits

    @property
    def verdict(self) -> Verdict:
        """By the same limits as for the calibration, and no residuals that its covariance denies."""
        limits, n = self.limits, len(self.names)
        worst = self.names[int(self.contact_errors.max(axis=1).argmax())]
        error = message(
            f"In {arg(n)} new {arg(message('poses') if n > 1 else message('pose'))} the residuals move a contact by"
            f" {arg(1e3 * self.contact_rms):.2g} mm rms, at most {arg(1e3 * self.contact_worst):.2g} mm"
            f" ({arg(worst)})"
        )
        if self.contact_rms > limits.usable_error:
            refusal = message(
                f"{arg(error)}; more than {arg(1e3 * limits.usable_error):g} mm rms is refused. Look for a"
                " touching cable, a changed tool or a re-zeroed sensor, and calibrate again."
            )
            return Verdict(Level.REFUSE, (refusal,))
        words = []
        if self.contact_rms > limits.good_error:
            words.append(message(f"{arg(error)}; {arg(1e3 * limits.good_error):g} mm rms would be good."))
        if self.p_value < _DOUBT:
            times = np.sqrt(self.chi_square / self.freedom)
            outlier, sigmas = self.names[self.worst], self.deviates[self.worst]
            strange = message(
                f"The residuals are {arg(times):.1f} times what the calibration's uncertainty and noise"
                f" explain (p = {arg(self.p_value):.1g}), largest in {arg(outlier)} ({arg(sigmas):.1f} sigma):"
                " drift since the calibration, wrong orientations, or a touch."
            )
            words.append(strange)
        if n == 1:
            words.append(
                message(f"{arg(n)} pose says little about other orientations. Take {arg(_FEW)} or more.")
            )
        elif n < _FEW:
            words.append(
                message(f"{arg(n)} poses say little about other orientations. Take {arg(_FEW)} or more.")
            )
        if words:
            return Verdict(Level.USABLE, tuple(words))
        good = message(
            f"{arg(error)}; the limit for good is {arg(1e3 * limits.good_error):g} mm rms. No action needed."
        )
        return Verdict(Level.GOOD, (good,))

    @property
    def passed(self) -> bool:
        """Whether the calibration may be used."""
        return self.verdict.level is not Level.REFUSE

    @property
    def contact_rms(self) -> float:
        """Rms over the poses of the contact's error, for the worst of the task's forces, m."""
        return float(np.sqrt((self.contact_errors**2).mean(axis=0)).max())

    @property
    def contact_worst(self) -> float:
        """Largest error of a contact over poses and forces, m."""
        return float(self.contact_errors.max())

    @property
    def worst(self) -> int:
        """Index of the pose with the largest deviate."""
        return int(np.argmax(self.deviates))

    def to_json(self) -> dict[str, Any]:
        """Return all figures as plain data for ``--json``; units are in the names."""
        poses = [
            {
                "name": name,
                "residual_force_N": residual[:3].tolist(),
                "residual_torque_Nm": residual[3:].tolist(),
                "sigmas": float(deviate),
                "contact_error_mm": 1e3 * float(errors.max()),
            }
            for name, residual, deviate, errors in zip(
                self.names, self.residuals, self.deviates, self.contact_errors, strict=True
            )
        ]
        return {
            "passed": self.passed,
            "level": str(self.verdict.level),
            "reasons": list(self.verdict.reasons),
            "force_rms_N": self.force_rms,
            "torque_rms_Nm": self.torque_rms,
            "chi_square": self.chi_square,
            "freedom": self.freedom,
            "p_value": self.p_value,
            "contact_rms_mm": 1e3 * self.contact_rms,
            "contact_worst_mm": 1e3 * self.contact_worst,
            "contact_predicted_mm": 1e3 * self.predicted_contact_error,
            "contact_good_mm": 1e3 * self.limits.good_error,
            "contact_usable_mm": 1e3 * self.limits.usable_error,
            "poses": poses,
        }


def verify_still(
    calibration: Calibration,
    samples: Sequence[PoseSample],
    *,
    task: ContactTask | None = None,
    limits: Limits | None = None,
) -> StillVerification:
    """Compare a calibration with still, contact-free poses that it was not made from.

    Parameters
    ----------
    calibration : Calibration
    samples : sequence of PoseSample
        Other poses than the calibration's own, which it fits better than it should.
    task : ContactTask, optional
        The touches behind the figures in millimetres; left out: the calibration's.
    limits : Limits, optional
        The rule: those of the calibration's verdict, applied to the rms over the poses.

    Raises
    ------
    InputError
        There is no pose, or one of them is the calibration's own.
    """
    if not samples:
        raise InputError("verify_still: no poses; take three or more, in other orientations than before")
    own = {id(pose) for pose in calibration.poses}
    for index, pose in enumerate(samples):
        if id(pose) in own:
            raise InputError(
                f"verify_still: {arg(named(samples, index))} was used for the calibration; give poses"
                " that were not used"
            )
    task, limits = task or calibration.task, limits or Limits()
    arrays = stack(samples)
    residuals = arrays.wrenches - calibration.model.predict(arrays.R_SW.transpose(0, 2, 1))
    covariance = _covariance(calibration, arrays.R_SW, _noise(calibration, arrays.R_SW, samples))
    square, freedom = _square(residuals.ravel(), covariance), residuals.size
    blocks = np.array([covariance[i : i + 6, i : i + 6] for i in range(0, freedom, 6)])  # of each pose alone
    each = np.array([_square(*own) for own in zip(residuals, blocks, strict=True)])
    sensitivity = contact_sensitivity(task.point, task.normal, task.forces)
    errors = np.linalg.norm(np.einsum("mij,nj->nmi", sensitivity, residuals), axis=2)
    return StillVerification(
        names=tuple(named(samples, index) for index in range(len(samples))),
        residuals=residuals,
        force_rms=float(np.sqrt((residuals[:, :3] ** 2).sum(axis=1).mean())),
        torque_rms=float(np.sqrt((residuals[:, 3:] ** 2).sum(axis=1).mean())),
        deviates=np.sqrt(each),
        chi_square=square,
        freedom=freedom,
        p_value=_probability(square, freedom, min(calibration.noise.freedom)),
        contact_errors=errors,
        predicted_contact_error=_predicted(blocks, sensitivity),
        limits=limits,
    )


def _noise(calibration: Calibration, R_SW: Floats, samples: Sequence[PoseSample]) -> Floats:
    """Return the covariance (n, 6, 6) of each pose: the calibration's noise, or more if its samples say so."""
    V = calibration.noise.covariances(R_SW, calibration.model.vector)
    for each, pose in zip(V, samples, strict=True):
        if pose.force_sd is not None and pose.torque_sd is not None:
            own = np.concatenate([pose.force_sd, pose.torque_sd]) ** 2 / pose.count
            each[range(6), range(6)] += np.maximum(own - calibration.noise.sigmas**2, 0)
    return V


def _covariance(calibration: Calibration, R_SW: Floats, V: Floats) -> Floats:
    """Return the joint covariance (6 n, 6 n) of the residuals: one calibration's error is in all of them."""
    J = prediction_jacobian(R_SW, calibration.model.vector).reshape(-1, 12)
    shared: Floats = J @ calibration.covariance @ J.T
    return shared + block_diag(*V)


def _square(residual: Floats, covariance: Floats) -> float:
    """Return ``r' inv(C) r``, in units in which newtons and newton metres are alike in size."""
    scale = np.sqrt(np.diag(covariance))
    unit = residual / scale
    return float(unit @ np.linalg.solve(covariance / np.outer(scale, scale), unit))


def _probability(square: float, freedom: int, behind: float) -> float:
    """Return the probability of a larger sum of squares, for noise with so many degrees of freedom `behind` it."""
    if not np.isfinite(behind):
        return float(chdtrc(freedom, square))
    scale, matched = matched_f(freedom, np.full(2, behind))
    return float(fdtrc(freedom, matched, square / scale))


def _predicted(blocks: Floats, sensitivity: Floats) -> float:
    traces = np.einsum("mij,njk,mik->nm", sensitivity, blocks, sensitivity)
    return float(np.sqrt(traces.mean(axis=0).max()))
