"""Where is the probe touched? The solver, its answers, and the methods it is compared with."""

from pipeline.contact.gates import Gates
from pipeline.contact.noise import WrenchNoise
from pipeline.contact.solver import ContactSolver
from pipeline.contact.touch_model import TouchModel
from pipeline.kernel import Batch, Candidate, Contact, Reason

__all__ = ["Batch", "Candidate", "Contact", "ContactSolver", "Gates", "Reason", "TouchModel", "WrenchNoise"]
