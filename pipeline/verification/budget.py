"""What the errors of verified touches should come to, source by source: the budget that they are compared with."""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.budget import BudgetRow, BudgetSource, input_row, parameter_rows
from contactbench.pipeline.calibration.model import prediction_jacobian
from contactbench.pipeline.preparation.alignment.alignment import across
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM
from contactbench.pipeline.verification.causes import TouchEvidence, sensitivities
from contactbench.pipeline.verification.figures import ModelError
from contactbench.pipeline.verification.model_error import PLACEMENT_M

Array = NDArray[np.float64]


def verification_budget(
    evidence: TouchEvidence, covariance: Array, error: ModelError | None, mesh_deviation: float | None
) -> tuple[BudgetRow, ...]:
    """
    Return the budget of the distance between located point and marker: root mean square over the touches.

    Noise, bias, mass, centre of mass and their correlation together are the `predicted_mm` of the touches; the model's
    error is the one that a bundle of this verification allows for.

    Parameters
    ----------
    evidence : TouchEvidence
        Accepted touches, at least one.
    covariance : (12, 12)
        Of the calibration's parameters.
    error : ModelError or None
        None: it was not measured, and the default is assumed.
    mesh_deviation : float or None
        Root mean square between the mesh and the surface that it was made of, m; None: nobody knows.
    """
    points = evidence.points + evidence.errors
    normals = evidence.normals if evidence.facets is None else evidence.facets
    J = sensitivities(points, normals, evidence.wrenches[:, :3])
    by_parameter = J @ prediction_jacobian(evidence.R_WS.transpose(0, 2, 1), evidence.theta)
    if error is None:
        force, torque, kind = DEFAULT_FORCE_N, DEFAULT_TORQUE_NM, "B"
    else:
        force, torque, kind = error.force_N, error.torque_Nm, "A"
    sides = across(evidence.normals).transpose(0, 2, 1)
    mesh = BudgetRow(BudgetSource.MESH, "", 0.0)
    if mesh_deviation is not None:
        along, variance = evidence.along[:, :, None], np.array([[mesh_deviation**2]])
        mesh = input_row(BudgetSource.MESH, "B", along, variance, "mm", 1e3)
    noise, seen = evidence.noise, "A" if evidence.measured else "B"
    return (
        input_row(BudgetSource.NOISE_FORCE, seen, J[:, :, _FORCE], noise[_FORCE, _FORCE], "N", 1.0),
        input_row(BudgetSource.NOISE_TORQUE, seen, J[:, :, _TORQUE], noise[_TORQUE, _TORQUE], "mN·m", 1e3),
        *parameter_rows(by_parameter, covariance),
        BudgetRow(BudgetSource.MOUNT, "", 0.0),
        mesh,
        input_row(BudgetSource.MARKERS, "B", sides, PLACEMENT_M**2 * np.eye(2), "mm", 1e3),
        input_row(BudgetSource.MODEL_FORCE, kind, J[:, :, _FORCE], force**2 * np.eye(3), "N", 1.0),
        input_row(BudgetSource.MODEL_TORQUE, kind, J[:, :, _TORQUE], torque**2 * np.eye(3), "mN·m", 1e3),
    )


_FORCE, _TORQUE = slice(0, 3), slice(3, 6)
