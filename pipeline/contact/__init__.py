"""Where is the probe touched? The solver, its answers, and the methods it is compared with."""

from contactbench.pipeline.contact.solver import ContactSolver
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.kernel import Batch, Candidate, Contact, Reason

__all__ = ["Batch", "Candidate", "Contact", "ContactSolver", "Gates", "Reason", "TouchModel", "WrenchNoise"]
