"""Is what is accepted near? Days on ideal, typical and harsh benches, with and without the gate of nearness.

The bundle of each day locates its held-out touches.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.demo.day import run_days
from contactbench.pipeline.demo.verification import BUNDLE, answers_of
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.reality import MIXES
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FAR_M = 0.005
BENCHES = ("ideal", "typical", "harsh")
ASKED_M = ExportKnobs().sigma_max
# Of what is accepted, per cent more than FAR_M off; of what is accepted without the gate, per cent kept.
_MOST_FAR = {"harsh": 0.5, "typical": 0.1}
_LEAST_KEPT = {"typical": 90.0, "ideal": 96.0}


@dataclass(frozen=True, eq=False)
class Located:
    """Touches of one bench and probe, located without the gate and with it."""

    bench: str
    probe: str
    off: tuple[Array, Array]  # (n,) each: m, NaN: not accepted

    @property
    def shares(self) -> tuple[float, ...]:
        """Touches, accepted of them without the gate, far of those, the same with it, and kept, %."""
        (all_, far), (near, still) = ((np.isfinite(each).sum(), (each > FAR_M).sum()) for each in self.off)
        count = len(self.off[0])
        parts = ((all_, count), (far, all_), (still, near), (near, all_))
        return (count, *(100 * float(some) / max(int(whole), 1) for some, whole in parts))


def run(
    seeds: int = 5,
    seed: int = 0,
    probes: Sequence[str] = assets.PROBE_NAMES,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure it."""
    found: list[Located] = []
    with TemporaryDirectory() as folder:
        benches = [MIXES[name] for name in BENCHES]
        run_days(Path(folder), benches, probes, seeds, seed, progress)
        for bench in BENCHES:
            days = sorted(each.parent for each in (Path(folder) / bench).glob(f"*/*/{BUNDLE}"))
            found += [of_day(bench, day) for day in days]
    columns = ("bench", "probe", "touches", "sure %", "sure: > 5 mm off %", "near: > 5 mm off %", "kept %")
    sheet = Sheet("nearness", "What is accepted", columns, tuple(_rows(found)))
    about = {"seeds": seeds, "first seed": seed, "asked, mm": 1e3 * ASKED_M}
    return StudyReport("Is what is accepted near?", about, tuple(_figures(found)), (), (sheet,))


def of_day(bench: str, day: Path) -> Located:
    """Locate the held-out touches of a day by its bundle, without and with the gate."""
    config = RuntimeConfig.load(day / BUNDLE)
    with (day / "run.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    offs = []
    for asked in (0.0, ASKED_M):
        gates = config.model.gates.model_copy(update={"sigma_max_m": asked})
        model = config.model.model_copy(update={"gates": gates})
        answers = {
            each.time: each.contact for each in answers_of(replace(config, model=model), day / "run.mcap")
        }
        off = np.full(len(rows), np.nan)
        for i, row in enumerate(rows):
            contact = answers[float(row["t"])]
            if contact is not None and contact.accepted:
                off[i] = np.linalg.norm(contact.point - [float(row[f"true_{axis}"]) for axis in "xyz"])
        offs.append(off)
    return Located(bench, day.parent.name, (offs[0], offs[1]))


def together(found: Sequence[Located], bench: str, probes: Sequence[str]) -> Located:
    """Put the touches of a bench and of probes together."""
    mine = [each for each in found if each.bench == bench and each.probe in probes]
    before, after = (np.concatenate([each.off[i] for each in mine]) for i in (0, 1))
    return Located(bench, ", ".join(dict.fromkeys(each.probe for each in mine)), (before, after))


def _rows(found: Sequence[Located]) -> Iterator[tuple[str | float, ...]]:
    for bench, probe in dict.fromkeys((each.bench, each.probe) for each in found):
        yield (bench, probe, *together(found, bench, (probe,)).shares)


def _figures(found: Sequence[Located]) -> Iterator[Figure]:
    for bench in BENCHES:
        before, after = together(found, bench, assets.PROBE_NAMES).off
        for name, off, most in (("sure", before, None), ("near", after, _MOST_FAR.get(bench))):
            far, all_ = int((off > FAR_M).sum()), int(np.isfinite(off).sum())
            yield Figure.share(bench, f"{name} and more than 5 mm off", far, all_, most=most)
        kept = int(np.isfinite(after).sum()), int(np.isfinite(before).sum())
        yield Figure.share(bench, "kept", *kept, least=_LEAST_KEPT.get(bench))
