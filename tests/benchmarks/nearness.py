"""Is what is accepted near? Days on ideal, typical and harsh benches, with and without the gate of nearness.

On bundled probes the bundle of each day locates its held-out touches. On real housings, of which no bench is drawn,
touches have errors as those bundles state them.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.shapes import REAL

from contactbench import assets
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.contact import ContactSolver, Gates, TouchModel, WrenchNoise
from contactbench.pipeline.demo.day import run_days
from contactbench.pipeline.demo.verification import BUNDLE, answers_of
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.preparation.prepare import prepared
from contactbench.pipeline.reality import MIXES
from contactbench.pipeline.settings import ProbeSettings
from contactbench.pipeline.simulation import add_noise, draw_touches
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport
from contactbench.pipeline.study.sweep.plan import MeshSurface

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe

    Array = NDArray[np.float64]

FAR_M = 0.005
BENCHES = ("ideal", "typical", "harsh")
ASKED_M = ExportKnobs().sigma_max
_FORCES, _TOUCHES = (3.0, 15.0), 1_000  # as a day has them; on a real housing
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
    """Measure it; real housings are left out where they are not there, and the report says so."""
    found: list[Located] = []
    real, notes = housings(progress)
    with TemporaryDirectory() as folder:
        benches = [MIXES[name] for name in BENCHES]
        run_days(Path(folder), benches, probes, seeds, seed, progress)
        for bench in BENCHES:
            days = sorted(each.parent for each in (Path(folder) / bench).glob(f"*/*/{BUNDLE}"))
            found += [of_day(bench, day) for day in days]
            configs = [RuntimeConfig.load(day / BUNDLE) for day in days]
            for probe in real:
                found += [of_housing(bench, probe, each, seed + i) for i, each in enumerate(configs)]
    columns = (
        "bench",
        "probe",
        "touches",
        "sure %",
        "of these > 5 mm off %",
        "near and > 5 mm off %",
        "kept %",
    )
    sheet = Sheet("nearness", "What is accepted", columns, tuple(_rows(found)))
    about = {"seeds": seeds, "first seed": seed, "asked, mm": 1e3 * ASKED_M}
    return StudyReport("Is what is accepted near?", about, tuple(_figures(found)), notes, (sheet,))


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


def housings(progress: Callable[[str], None]) -> tuple[list[Probe], tuple[str, ...]]:
    """Prepare the real housings, and say which are left out, and why."""
    # Their files have the origin at the lens and the handle along -y.
    given = ProbeSettings(mount=(0.0, 0.0, 160.0, 90.0, 0.0, 0.0), facets=4_000, units="mm")
    made, notes = [], [] if REAL.is_dir() else [f"No real housings: {REAL} is not there."]
    for file in sorted(REAL.glob("*.stl")):
        progress(f"{file.stem}: preparing the mesh")
        try:
            made.append(prepared({"mesh": file}, given).content.probe)
        except InputError as error:
            notes.append(f"{file.stem} left out: {error}")
    return made, tuple(notes)


def of_housing(bench: str, probe: Probe, config: RuntimeConfig, seed: int) -> Located:
    """Locate touches of a mesh, whose wrenches are off by what a day's bundle says."""
    rng = np.random.default_rng(seed)
    low, high = probe.bounds
    drawn = draw_touches(
        MeshSurface(probe), _TOUCHES, rng, force=_FORCES, above=float(high[2] - 0.3 * (high[2] - low[2]))
    )
    part = config.model.touch.model_error
    noise = WrenchNoise(0.0, 0.0, extra=config.model.noise.wrench_covariance)
    model = TouchModel(model_error=WrenchNoise(part.force_N, part.torque_Nm))
    wrenches = add_noise(add_noise(drawn.wrenches, noise, rng), model.model_error, rng)
    offs = []
    for asked in (0.0, ASKED_M):
        batch = ContactSolver(probe, noise, Gates(sigma_max=asked), model).locate_batch(wrenches)
        off = np.linalg.norm(batch.points - drawn.points, axis=1)
        offs.append(np.where(batch.accepted, off, np.nan))
    return Located(bench, probe.name, (offs[0], offs[1]))


def together(found: Sequence[Located], bench: str, probes: Sequence[str]) -> Located:
    """Put the touches of a bench and of probes together."""
    mine = [each for each in found if each.bench == bench and each.probe in probes]
    before, after = (np.concatenate([each.off[i] for each in mine]) for i in (0, 1))
    return Located(bench, ", ".join(dict.fromkeys(each.probe for each in mine)), (before, after))


def _rows(found: Sequence[Located]) -> Iterator[tuple[str | float, ...]]:
    for bench, probe in dict.fromkeys((each.bench, each.probe) for each in found):
        yield (bench, probe, *together(found, bench, (probe,)).shares)


def _figures(found: Sequence[Located]) -> Iterator[Figure]:
    """Judge the days; what is drawn by the model that locates it is shown, not judged."""
    for bench in BENCHES:
        before, after = together(found, bench, assets.PROBE_NAMES).off
        for name, off, most in (("sure", before, None), ("near", after, _MOST_FAR.get(bench))):
            far, all_ = int((off > FAR_M).sum()), int(np.isfinite(off).sum())
            yield Figure.share(bench, f"{name} and more than 5 mm off", far, all_, most=most)
        kept = int(np.isfinite(after).sum()), int(np.isfinite(before).sum())
        yield Figure.share(bench, "kept", *kept, least=_LEAST_KEPT.get(bench))
