"""Mutated bundles of a runtime config: every one is refused with a typed error, or loads as what it was."""

import io
import subprocess
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
from benchmarks.bundle_example import example_config
from benchmarks.bundle_mutations import Mutant, mutant

from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig
from contactbench.pipeline.config.runtime.pack import read_zip
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

_FACETS, _OTHER_FACETS = 300, 400
_BATCH = 200
_LONGEST_S, _MOST_MIB = 2.0, 500.0
_NO_NAMES = frozenset("/\\:\0")


def mutants(count: int, seed: int = 0) -> Iterator[Mutant]:
    """Give mutated bundles; the same arguments give the same ones."""
    if count < 1:
        raise InputError(f"count is {count}: give at least 1.")
    sound, plain = _bases()
    other = example_config(_OTHER_FACETS, seed=2, clamped=True).encoded()
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield mutant(sound, plain, other, rng)


def run(count: int = 5_000, seed: int = 0, cpp: Path | None = None) -> StudyReport:
    """Load mutated bundles."""
    sound = _bases()
    outcomes: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    failures: list[str] = []
    slowest, compared, before = 0.0, 0, _most_memory()
    numbered = enumerate(mutants(count, seed))
    while batch := dict(islice(numbered, _BATCH)):
        told = {}
        for number, each in batch.items():
            begin = perf_counter()
            outcome = _outcome(each, sound)
            slowest = max(slowest, perf_counter() - begin)
            kinds[each.kind] += 1
            outcomes[outcome] += 1
            if outcome not in _allowed(each):
                failures.append(f"{number}: {each.kind}: {outcome}")
            if _is_folder(each):
                told[number] = "refused" if outcome == "refused" else "loaded"
        if cpp is not None:
            answers, took = _answers({number: batch[number] for number in told}, cpp)
            failures += [
                f"{number}: {batch[number].kind}: {verdict} here, in C++: {answers.get(number, 'no answer')}"
                for number, verdict in told.items()
                if answers.get(number, "no answer").split(" ", 1)[0] != verdict
            ]
            slowest, compared = max(slowest, took), compared + len(told)
    grown = _most_memory() - before
    used = 0.0 if cpp is None else _most_memory(children=True)
    figures = (
        Figure("bundles", "tried", count),
        Figure("bundles", "refused with an error of this project's own", outcomes["refused"]),
        Figure("bundles", "loaded as what they were", outcomes["same"]),
        Figure("bundles", "loaded as another valid config", outcomes["other"]),
        Figure("bundles", "also given to the loader in C++", compared),
        Figure("bundles", "accepted though wrong, or loaders that disagree", len(failures), most=0),
        Figure("bundles", "longest time to load", slowest, "s", most=_LONGEST_S),
        Figure("bundles", "most memory to load", max(grown, used), "MiB", most=_MOST_MIB),
    )
    other = (
        "Another valid config: a number was changed and every hash made anew, by somebody who may do that."
    )
    settings = {"kinds": len(kinds), "seed": seed}
    return StudyReport("Mutated bundles", settings, figures, (other, *failures[:20]))


def _bases() -> tuple[dict[str, bytes], dict[str, bytes]]:
    return (
        example_config(_FACETS, clamped=True).encoded(),
        example_config(_FACETS, verified=False).encoded(),
    )


def _is_folder(each: Mutant) -> bool:
    return each.files is not None and not any(_NO_NAMES & set(name) for name in each.files)


def _answers(batch: dict[int, Mutant], cpp: Path) -> tuple[dict[int, str], float]:
    """Return what the loader in C++ says of each, and the longest time that it took, s."""
    with TemporaryDirectory() as place:
        for number, each in batch.items():
            folder = Path(place, f"{number:05d}")
            folder.mkdir()
            for name, data in (each.files or {}).items():
                (folder / name).write_bytes(data)
        try:
            done = subprocess.run(
                [cpp, place],
                capture_output=True,
                text=True,
                errors="replace",
                check=False,
                timeout=_LONGEST_S * _BATCH,
            )
            lines = [line.split(" ", 1) for line in done.stdout.splitlines()]
            return {int(name): answer for name, answer in lines}, float(done.stderr.split()[-2])
        except (OSError, subprocess.TimeoutExpired, ValueError, IndexError) as error:
            raise InputError(
                f"{cpp}: the program does not run ({error}): build contactbench-load_all."
            ) from error


def _most_memory(*, children: bool = False) -> float:
    """Return the most memory that this process ever used, or any child that ended, MiB; 0 where nobody tells."""
    try:
        import resource  # not on Windows
    except ImportError:
        return 0.0
    # Of a child never less than this process had when it started it: an upper bound.
    used = resource.getrusage(resource.RUSAGE_CHILDREN if children else resource.RUSAGE_SELF)
    return used.ru_maxrss / 1024


def _allowed(each: Mutant) -> tuple[str, ...]:
    if each.expected == "refused":
        return ("refused",)
    return ("refused", "same", "other") if each.sealed else ("refused", "same")


def _outcome(each: Mutant, sound: tuple[dict[str, bytes], dict[str, bytes]]) -> str:
    try:
        packed = io.BytesIO(each.packed or b"")
        loaded = RuntimeConfig.from_files(each.files or read_zip(packed, "fuzz.zip"), "fuzz")
    except ConfigError:
        return "refused"
    except Exception as error:  # noqa: BLE001  (that there is no other is what is measured)
        return f"{type(error).__name__}: {error!s:.200}"
    return "same" if loaded.encoded() in sound else "other"
