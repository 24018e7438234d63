"""What the checks against a known weight and a known point share: outcome, and the file they write."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration import Calibration
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.files import File

WEIGHT, TOUCH = "known_weight", "known_touch"  # kinds of results in a session
SCHEMAS = {WEIGHT: "contactbench.known_weight", TOUCH: "contactbench.known_touch"}
VERSION = 1
"""Of both files."""

WEIGHT_ROLES = ("calibration", "unloaded", "loaded")
TOUCH_ROLES = ("calibration", "probe", "touch")


class CheckOutcome(StrEnum):
    """What a check says."""

    PASSED = "passed"
    FAILED = "failed"
    UNDECIDED = "undecided"  # its uncertainty is too large to tell


@dataclass(frozen=True, eq=False)
class KnownCheck:
    """What a check shows."""

    outcome: CheckOutcome
    reasons: tuple[str, ...]  # What is wrong or missing, and what else to know; sentences
    sentence: str  # All in a paragraph

    @property
    def passed(self) -> bool:
        """Whether what was measured is what it should be."""
        return self.outcome is CheckOutcome.PASSED

    def said(self) -> dict[str, Any]:
        """Return it as the file of the check has it."""
        return {
            "outcome": self.outcome.value,
            "passed": self.passed,
            "reasons": list(self.reasons),
            "sentence": self.sentence,
        }


def load_calibrated(
    file: File, R_ES: NDArray[np.float64] | None
) -> tuple[Calibration, NDArray[np.float64] | None, tuple[str, ...]]:
    """
    Load a calibration.

    Returns
    -------
    Calibration
    (3, 3) or None
        R_ES: as given, else as the calibration has it.
    tuple of str
        Why nothing that rests on it may pass: it was refused.

    Raises
    ------
    InputError
        It cannot be read.
    """
    from contactbench.pipeline.calibration import Level
    from contactbench.pipeline.calibration.files.calibration_file import load_record

    record = load_record(file)
    verdict = record.calibration.verdict
    refused = verdict.level is Level.REFUSE
    faults = (message(f"The calibration was refused: {arg(verdict.reasons[0])}"),) if refused else ()
    if R_ES is None and record.mount is not None:
        R_ES = record.mount.R_SE.T
    return record.calibration, R_ES, faults


def read_check(kind: str, file: File) -> dict[str, Any]:
    """
    Read what ``contactbench calibrate check --out`` wrote.

    Parameters
    ----------
    kind : str
        WEIGHT or TOUCH.
    file : path

    Raises
    ------
    InputError
        It cannot be read, or is something else.
    """
    remedy = message(
        f"choose a file written by `contactbench calibrate check {arg(kind.removeprefix('known_'))} --out`."
    )
    try:
        content = json.loads(file.read_bytes())
    except (OSError, ValueError, RecursionError) as error:
        raise InputError(
            f"{arg(file)}: the file cannot be read ({arg(str(error)[:100])}): {arg(remedy)}"
        ) from error
    known = isinstance(content, dict) and (content.get("schema"), content.get("version")) == (
        SCHEMAS[kind],
        VERSION,
    )
    words = (content.get("sentence"), content.get("outcome")) if known else ()
    if not words or not isinstance(words[0], str) or words[1] not in set(CheckOutcome):
        raise InputError(f"{arg(file)}: not a {arg(SCHEMAS[kind])} of version {arg(VERSION)}: {arg(remedy)}")
    found: dict[str, Any] = content
    return found


def to_bytes(content: Mapping[str, Any]) -> bytes:
    """Return a result as JSON, UTF-8; the same content gives the same bytes."""
    return (json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()


def or_none(value: float) -> float | None:
    """Return a number that JSON can hold: None for one that is not finite."""
    return float(value) if np.isfinite(value) else None


def swap(a: int, b: int) -> NDArray[np.float64]:
    """Return the matrix (3, 3) that exchanges two components."""
    T = np.eye(3)
    T[[a, b]] = T[[b, a]]
    return T


def likely(causes: list[str]) -> str:
    """Return sentences that name causes, the likeliest first."""
    first, *others = causes
    also = (message(f"Also possible: {arg(each)}.") for each in others)
    return join(" ", [message(f"Likely cause: {arg(first)}."), *also])


def words_of(outcome: CheckOutcome, reasons: list[str], passed: str) -> str:
    """Return the one paragraph that says all."""
    start = {
        CheckOutcome.PASSED: passed,
        CheckOutcome.FAILED: message("The check failed."),
        CheckOutcome.UNDECIDED: message("The check is inconclusive."),
    }[outcome]
    return join(" ", [start, *reasons])
