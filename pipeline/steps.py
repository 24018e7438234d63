"""The steps of the work, in their order, and how each of them stands."""

from dataclasses import dataclass
from enum import StrEnum

from contactbench.pipeline.errors import message


class Step(StrEnum):
    """What is done, in this order."""

    DEVICES = "devices"
    GRAVITY = "gravity"
    PROBE = "probe"
    REGIONS = "regions"
    VERIFY = "verify"
    EXPORT = "export"


class StepState(StrEnum):
    """How a step stands; the same words, icons and colours everywhere."""

    LOCKED = message("locked")
    READY = message("ready")
    RUNNING = message("running")
    DONE = message("done")
    FAILED = message("failed")
    STALE = message("stale")


@dataclass(frozen=True)
class StepStatus:
    """How a step stands, and why."""

    state: StepState
    sentence: str  # For people: what is missing, what came of it, or why it no longer holds
    broken: bool = False  # Whether something is wrong that no result is to blame for; see `SessionTrouble`
