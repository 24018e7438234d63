"""The methods that every speed-against-error report compares, behind one signature.

Each takes a probe, the noise, the gates and the touch model, and gives a :class:`ContactMethod`. Rivals answer with one
contact or none and no doubt: only contactbench weighs touches against each other, says ``ambiguous``, ``by_region`` and
``implausible``, and uses regions, noise and model for more than the uncertainty of the point.

=============  ========================================================================================
algorithm1     the paper's loop taken literally: one 4x4 solve a plane, priority planes first, first accepted
               wins; compiled
wrench_axis    k = 0: the wrench axis as a ray against the mesh, by Embree (extra ``embree``)
iterative      Levenberg-Marquardt on a paraboloid fitted to the contact face; compiled, or by SciPy
scan           the closed form for any k over every facet, the smallest local torque wins; compiled
contactbench   the likeliest touch, with every other one that explains the wrench about as well
=============  ========================================================================================
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline import kernel
from contactbench.pipeline.contact.noise import WrenchNoise
from contactbench.pipeline.contact.paraboloid import fit_contact_face
from contactbench.pipeline.contact.solver import ContactSolver
from contactbench.pipeline.contact.touch_model import TouchModel
from contactbench.pipeline.contact.wrench_axis import EmbreeAxis
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.kernel import Batch, Contact
from contactbench.pipeline.mesh import Probe

Float = NDArray[np.float64]


@dataclass(frozen=True)
class ContactMethod:
    """One way to locate contacts."""

    name: str  # As in :data:`METHODS`
    locate: Callable[[ArrayLike], Contact]  # (6,) wrench in S, N and N·m -> Contact
    locate_batch: Callable[[ArrayLike], Batch]  # (n, 6) wrenches -> Batch, each row on its own
    # What does the work; compiled ones have ``time_each(wrenches)`` -> nanoseconds of each solve
    engine: Any = field(repr=False, compare=False, default=None)


class MakeMethod(Protocol):
    """Makes a method for a probe."""

    def __call__(
        self,
        probe: Probe,
        noise: WrenchNoise | None = None,
        gates: Gates | None = None,
        model: TouchModel | None = None,
    ) -> ContactMethod:
        """Return it, with the sensor's noise, what is asked of a contact, and what is known of a touch."""


def _method(engine: Callable[[ContactSolver], Any]) -> MakeMethod:
    """Return what makes a method of a probe, its noise, gates and touch model: `engine` does the work."""

    def made(
        probe: Probe,
        noise: WrenchNoise | None = None,
        gates: Gates | None = None,
        model: TouchModel | None = None,
    ) -> ContactMethod:
        built = engine(ContactSolver(probe, noise, gates, model))
        return ContactMethod(engine.__name__, built.locate, built.locate_batch, built)

    made.__doc__ = engine.__doc__
    return made


@_method
def contactbench(solver: ContactSolver) -> Any:
    """Return the solver: the likeliest touch and its rivals, with reason, confidence and uncertainty."""
    return solver


@_method
def scan(solver: ContactSolver) -> Any:
    """Return the closed form over every facet: the limit of an infinite torsion arm and no noise."""
    return kernel.Scan(solver)


@_method
def algorithm1(solver: ContactSolver) -> Any:
    """Return Algorithm 1 of Cao et al. (2023), literally."""
    return kernel.Algorithm1(solver)


@_method
def wrench_axis(solver: ContactSolver) -> Any:
    """Return the wrench-axis method: no local torque, the first facet that the axis enters.

    Raises
    ------
    InputError
        Embree's bindings are not installed.
    """
    return EmbreeAxis(solver)


@_method
def iterative(solver: ContactSolver) -> Any:
    """Return Levenberg-Marquardt on a paraboloid fitted to the contact face.

    Raises
    ------
    InputError
        There is no contact face to fit.
    """
    surface = fit_contact_face(solver.probe)
    return kernel.Iterative(solver, surface.origin_S, surface.axes_S, surface.coefficients, surface.reach)


METHODS: dict[str, MakeMethod] = {
    "contactbench": contactbench,
    "scan": scan,
    "algorithm1": algorithm1,
    "wrench_axis": wrench_axis,
    "iterative": iterative,
}


def make(
    name: str,
    probe: Probe,
    noise: WrenchNoise | None = None,
    gates: Gates | None = None,
    model: TouchModel | None = None,
) -> ContactMethod:
    """Build a method by name.

    Raises
    ------
    InputError
        There is no method of this name.
    """
    if name not in METHODS:
        raise InputError(f"there is no method {arg(name)!r}: choose one of {arg(', '.join(METHODS))}")
    return METHODS[name](probe, noise, gates, model)
