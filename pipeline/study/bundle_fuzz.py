"""Mutated bundles of a runtime config: every one is refused with a typed error, or loads as what it was."""

from __future__ import annotations

import io
import json
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pipeline.config.runtime import ConfigError, RuntimeConfig
from pipeline.config.runtime.pack import read_zip
from pipeline.durable import make_folder
from pipeline.errors import InputError
from pipeline.study.bundle_example import example_config
from pipeline.study.bundle_mutations import Mutant, mutant
from pipeline.study.preparation.report import Figure, Report

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from typing import Any

_FACETS, _OTHER_FACETS = 300, 400
_NO_NAMES = frozenset("/\\:\0")


@dataclass(frozen=True)
class BundleFuzzReport:
    """
    What became of the mutated bundles.

    Attributes
    ----------
    count : int
    refused : int
        With a typed error.
    same : int
        Loaded as exactly what they were before, to the byte.
    other : int
        Loaded as another config, where a changed number may be as good as the one before.
    kinds : mapping of str to int
        How many of each kind.
    failures : tuple of str
        Kind and what happened: accepted but wrong, or an error of another type.
    """

    count: int
    refused: int
    same: int
    other: int
    kinds: dict[str, int]
    failures: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Nothing went wrong."""
        return not self.failures

    def to_json(self) -> dict[str, Any]:
        """Return plain data."""
        return {**vars(self), "failures": list(self.failures), "passed": self.passed}

    def report(self) -> Report:
        """Return the counts as figures with their targets."""
        figures = [
            Figure("bundles", "tried", self.count),
            Figure("bundles", "refused with an error of this project's own", self.refused),
            Figure("bundles", "loaded as what they were", self.same),
            Figure("bundles", "loaded as another valid config", self.other),
            Figure("bundles", "accepted though wrong, or another error", len(self.failures), most=0),
        ]
        notes = [
            "Another valid config: a number was changed and every hash made anew, by somebody who may do that.",
            *self.failures[:20],
        ]
        return Report("Mutated bundles", {"kinds": len(self.kinds)}, tuple(figures), tuple(notes))


def mutants(count: int, seed: int = 0) -> Iterator[Mutant]:
    """Give mutated bundles; the same arguments give the same ones."""
    if count < 1:
        raise InputError(f"count is {count}: give at least 1.")
    files = example_config(_FACETS, clamped=True).encoded()
    other = example_config(_OTHER_FACETS, seed=2, clamped=True).encoded()
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield mutant(files, other, rng)


def run(count: int = 5_000, seed: int = 0) -> BundleFuzzReport:
    """
    Load mutated bundles.

    Parameters
    ----------
    count : int
    seed : int

    Raises
    ------
    InputError
        `count` is below 1.
    """
    sound = example_config(_FACETS, clamped=True).encoded()
    outcomes: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    failures = []
    for number, each in enumerate(mutants(count, seed)):
        outcome = _outcome(each, sound)
        kinds[each.kind] += 1
        outcomes[outcome] += 1
        accepted = outcome == "other" and not (each.expected == "any" and each.sealed)
        if (
            accepted
            or outcome not in ("refused", "same", "other")
            or (outcome == "same" and each.expected == "refused")
        ):
            failures.append(f"{number}: {each.kind}: {outcome}")
    return BundleFuzzReport(
        count,
        outcomes["refused"],
        outcomes["same"],
        outcomes["other"],
        dict(sorted(kinds.items())),
        tuple(failures),
    )


def write_mutants(folder: Path, count: int, seed: int = 0) -> int:
    """
    Write mutated bundles as folders, for loaders in other languages.

    Next to each ``00017/`` lies ``00017.json``: ``kind``, ``expected`` ("refused", or "any" where a changed number may
    be as good as the one before), and ``python``, what the loader here did: "refused" or "loaded". Those that exist as
    a zip file only are left out.

    Parameters
    ----------
    folder : path
        Made if it is not there.
    count, seed : int

    Returns
    -------
    int
        How many were written.
    """
    make_folder(folder)
    written = 0
    for number, each in enumerate(mutants(count, seed)):
        if each.files is None or any(_NO_NAMES & set(name) for name in each.files):
            continue
        place = folder / f"{number:05d}"
        make_folder(place)
        for name, data in each.files.items():
            (place / name).write_bytes(data)
        about = {
            "kind": each.kind,
            "expected": each.expected,
            "python": "refused" if _outcome(each, {}) == "refused" else "loaded",
        }
        (folder / f"{number:05d}.json").write_text(json.dumps(about) + "\n", encoding="utf-8")
        written += 1
    return written


def _allowed(each: Mutant) -> tuple[str, ...]:
    if each.expected == "refused":
        return ("refused",)
    return ("refused", "same", "other") if each.sealed else ("refused", "same")


def _outcome(each: Mutant, sound: dict[str, bytes]) -> str:
    try:
        packed = io.BytesIO(each.packed or b"")
        loaded = RuntimeConfig.from_files(each.files or read_zip(packed, "fuzz.zip"), "fuzz")
    except ConfigError:
        return "refused"
    except Exception as error:  # noqa: BLE001  (that there is no other is what is measured)
        return f"{type(error).__name__}: {error!s:.200}"
    return "same" if loaded.encoded() == sound else "other"
