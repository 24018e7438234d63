"""What is measured of a contender, as plain rows."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Row = dict[str, Any]
OURS = "contactbench"
SURE = f"{OURS}, sure answers"  # its own subset, no contender
TOLD = f"{OURS}, noise told"
REMEDY = "pip install contactbench[rivals]"
_MM = 1e3


@dataclass(frozen=True)
class Contender:
    """Somebody's code."""

    name: str
    package: str = ""  # on PyPI; empty for code of this project

    @property
    def version(self) -> str:
        """Its version; empty where it is not installed."""
        try:
            return version(self.package or OURS)
        except PackageNotFoundError:
            return ""


def missing(family: str, contender: Contender, error: BaseException) -> Row:
    """Return the row of something that cannot be measured here."""
    why = str(error).splitlines()[0] if str(error) else type(error).__name__
    said = f"not installed: {REMEDY}" if not contender.version else f"cannot be used here ({why})"
    return {
        "kind": "missing",
        "family": family,
        "contender": contender.name,
        "package": contender.package,
        "note": said,
    }


def known(family: str, contender: Contender) -> Row:
    """Return the row that says which version was measured."""
    return {
        "kind": "version",
        "family": family,
        "contender": contender.name,
        "package": contender.package or "of this project",
        "version": contender.version,
    }


def timed(family: str, contender: str, subject: str, mode: str, us: Sequence[float], **more: Any) -> Row:
    """Return the row of some timed rounds: the median of each round, µs."""
    low, middle, high = np.percentile(np.asarray(us, dtype=np.float64), [5, 50, 95]).tolist()
    return {
        "kind": "time",
        "family": family,
        "contender": contender,
        "subject": subject,
        "mode": mode,
        "median_us": middle,
        "low_us": low,
        "high_us": high,
        "rounds": len(us),
        **more,
    }


def erred(
    family: str,
    contender: str,
    subject: str,
    condition: str,
    error: NDArray[np.float64],
    ours: NDArray[np.float64],
    **more: Any,
) -> Row:
    """
    Return the row of a contender's errors beside ours on the same inputs.

    Parameters
    ----------
    error, ours : (n,)
        m; NaN where nothing was answered.
    """
    both = np.isfinite(error) & np.isfinite(ours)
    there = np.isfinite(error)
    apart = _MM * (error[both] - ours[both])
    count = int(both.sum())
    mm = _MM * error[there]
    return {
        "kind": "error",
        "family": family,
        "contender": contender,
        "subject": subject,
        "condition": condition,
        "inputs": len(error),
        "answered": float(there.mean()),
        "mean_mm": _or_nan(mm, np.mean),
        "median_mm": _or_nan(mm, np.median),
        "p95_mm": _or_nan(mm, lambda x: np.percentile(x, 95)),
        "max_mm": _or_nan(mm, np.max),
        "worse_mm": _or_nan(apart, np.mean),
        "worse_se_mm": float(apart.std(ddof=1) / np.sqrt(count)) if count > 1 else float("nan"),
        "common_mm": _or_nan(_MM * error[both], np.mean),
        "ours_common_mm": _or_nan(_MM * ours[both], np.mean),
        **more,
    }


def _or_nan(values: NDArray[np.float64], what: Any) -> float:
    return float(what(values)) if len(values) else float("nan")
