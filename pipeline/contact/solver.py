"""The solver: from a wrench to a contact point and its confidence."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline import kernel
from contactbench.pipeline.contact.facet_marks import MARKS, facet_marks
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.mesh import Probe


class ContactSolver(kernel.Solver):
    """Locate contacts on one probe.

    A touch at p with outward normal n and local torque k obeys ``M - p x F = k n`` (Cao et al. 2023, Eq. 4). Its
    misfit d2, in standard deviations squared, is the residual relative to the uncertainty of noise, calibration,
    model and mesh. The contact is the place with the least d2 minus prior odds, among those with ``F . n < 0`` inside
    the friction cone. Without a limit on k this is the closed form of the paper, with k = 0 the wrench axis.

    Parameters
    ----------
    probe : Probe
        The surface in the sensor frame S, metres.
    noise : WrenchNoise, optional
        Uncertainty of the wrenches, without the model error.
    gates : Gates, optional
        Limits and odds behind the reason codes.
    model : TouchModel, optional
        Torsion, mesh deviation and model error.

    Attributes
    ----------
    covariance : (6, 6) float64
        Total covariance of a wrench, noise and model error; N², N²·m, N²·m².

    Notes
    -----
    ``locate(wrench)`` and ``locate(wrench, previous)`` are pure: the same arguments give the same bits.
    ``locate_batch(wrenches, threads=1)`` takes (n, 6) and releases the interpreter's lock; ``threads=0`` uses every
    core, for the same bits.
    ``track(wrench)`` follows one stream and equals ``locate`` with the last accepted contact, except where a second
    touch joins it; ``reset()`` starts another stream; calls from several threads wait for each other.
    Wrenches are (6,) ``Fx Fy Fz Mx My Mz`` in S, N and N·m about the sensor origin, float64; they are
    the force and torque of the tissue on the probe. A wrench that is not finite gives ``Reason.NOT_FINITE``; one of
    another shape or type raises TypeError.
    """

    def __init__(
        self,
        probe: Probe,
        noise: WrenchNoise | None = None,
        gates: Gates | None = None,
        model: TouchModel | None = None,
    ) -> None:
        self.probe = probe
        self.noise = noise or WrenchNoise()
        self.gates = gates or Gates()
        self.model = model or TouchModel()
        self.covariance: NDArray[np.float64] = self.noise.covariance + self.model.model_error.covariance
        super().__init__(
            probe.vertices,
            probe.faces,
            probe.region,
            self.covariance,
            bonus=self.gates.bonus(probe.region, probe.untouchable),
            torsion_arm=self.model.torsion_arm,
            torsion_learned=self.model.torsion_learned,
            mesh_deviation=self.model.mesh_deviation,
            mesh_curved=self.model.mesh_curved,
            gates=self.gates.kernel_values(),
        )

    def on(self, contact: kernel.Contact) -> str | None:
        """Return a contact's mark, one of `contactbench.pipeline.contact.facet_marks.MARKS`; None: no facet."""
        return None if contact.face is None else MARKS[self._marks[contact.face]]

    @cached_property
    def _marks(self) -> NDArray[np.uint8]:
        return facet_marks(self.probe)
