"""The solver: from a wrench to a contact point, complete and honest about how sure it is."""

import numpy as np

from pipeline import kernel
from pipeline.contact.gates import Gates
from pipeline.contact.noise import WrenchNoise
from pipeline.mesh import Probe


class ContactSolver(kernel.Solver):
    """Locate contacts on one probe.

    Solves ``p x F + k n = M`` with p on the surface, n its outward normal and ``F . n < 0`` (Cao et al.
    2023, Eq. 4-6) for every facet and vertex that can answer, prefers among them as :class:`Gates` says,
    and states a reason. The solution of a facet needs no 4x4 system: a wrench meets a triangle exactly
    when its moments about the three edges are negative, and those moments are the barycentric weights of p.

    Parameters
    ----------
    probe : Probe
        The surface in the sensor frame S, metres.
    noise : WrenchNoise, optional
        Uncertainty of the wrenches to come; decides the covariance and what counts as ambiguous.
    gates : Gates, optional
        Limits behind the reason codes.

    Notes
    -----
    ``locate(wrench)`` and ``locate(wrench, previous)`` are pure: the same arguments give the same bits.
    ``locate_batch(wrenches)`` takes (n, 6) and releases the interpreter's lock.
    ``track(wrench)`` follows one stream and equals ``locate`` with the last accepted contact; ``reset()``
    begins another; calls from several threads wait for each other.
    Wrenches are (6,) ``Fx Fy Fz Mx My Mz`` in S, N and N·m about the sensor origin, float64; they describe
    what the tissue does to the probe. A wrench that is not finite is answered with
    ``Reason.NOT_FINITE``; one of another shape or type raises TypeError.
    """

    def __init__(self, probe: Probe, noise: WrenchNoise | None = None, gates: Gates | None = None) -> None:
        self.probe = probe
        self.noise = noise or WrenchNoise()
        self.gates = gates or Gates()
        super().__init__(
            probe.vertices,
            probe.faces,
            probe.region,
            np.array(self.noise.covariance),
            **self.gates.kernel_arguments(),
        )
