"""What each effect of a real bench costs: alone, and what a mix of them gains without it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import Reality
from contactbench.pipeline.simulation.loads import LoadedSensor, draw_load
from contactbench.pipeline.simulation.marker_touches import check_bundled, model_of
from contactbench.pipeline.simulation.reality.bench import VERIFIED_S, MarkedPresses, RealBench, planned_poses
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.pages import chapter, table
from contactbench.pipeline.study.report import Sheet, StudyReport, short

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from contactbench.pipeline.mesh.arrays import Floats, Mask
    from contactbench.pipeline.study.pages import Results
    from contactbench.pipeline.study.report import Cell


FACETS = 2_000
# Quicker than a device, and as good as its filter: the mean of these readings leaves a fifth of the noise.
_RATE_HZ, _READINGS = 50.0, 25
_MASS_KG = (0.3, 0.8)
_FAR_MM = 5.0
# What nobody sees on a touch that is held still.
_LATE = ("latency", "jitter", "pose_latency")
# What has no effect of its own without another.
_WITH = {"drag": ("cable",), "lean": ("patch",), "twist": ("patch",)}


@dataclass(frozen=True, eq=False)
class MarkerPresses:
    """Every marker of one probe, pressed on one bench; mm."""

    from_truth: Floats  # (n,) from the true points; NaN without an answer
    from_marker: Floats  # (n,) from the markers as they are told
    sure: Mask  # (n,)

    @property
    def rms(self) -> float:
        """Of the errors from the true points."""
        return float(np.sqrt(np.nanmean(self.from_truth**2)))

    @classmethod
    def joined(cls, parts: Sequence[MarkerPresses]) -> MarkerPresses:
        """Put the presses of several benches together."""
        names = ("from_truth", "from_marker", "sure")
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def run(
    mixes: Sequence[Reality],
    probes: Sequence[str] | None = None,
    *,
    seeds: int = 5,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """
    Press every marker on benches with none, one, all and all but one of the effects of each mix.

    Parameters
    ----------
    probes : sequence of str, optional
        Of assets.PROBE_NAMES; all of them when left out.
    seeds, seed : int
        Benches, and the first's.

    Raises
    ------
    InputError
        An argument is out of its range.
    """
    names = check_bundled(probes or assets.PROBE_NAMES)
    if seeds < 1 or seed < 0:
        raise InputError(f"--seeds {seeds}, --seed {seed}: give at least one seed, from 0 on.")
    benches = [(name, number) for name in names for number in range(seed, seed + seeds)]

    @cache
    def pressed(reality: Reality, follow: bool = False) -> list[MarkerPresses]:
        progress(f"{reality}, with a zero that follows" if follow else f"{reality}")
        return [press_all(name, reality, number, follow=follow) for name, number in benches]

    ideal = pressed(Reality())

    def row(label: str, reality: Reality, mix: Reality, without: Reality | None = None) -> tuple[Cell, ...]:
        mixed = (pressed(mix), pressed(without)) if without else None
        return _row(label, pressed(reality), ideal, mixed)

    sheets = []
    for mix in mixes:
        rows, squares = [row("none", Reality(), mix)], 0.0
        for effect in mix.on:
            if effect in _LATE:
                continue
            alone = mix.only(effect, *_WITH.get(effect, ()))
            if effect not in _WITH:  # what needs another holds that one's squares, too
                squares += (
                    MarkerPresses.joined(pressed(alone)).rms ** 2 - MarkerPresses.joined(ideal).rms ** 2
                )
            label = " with ".join((f"{effect} {getattr(mix, effect):g}", *_WITH.get(effect, ())))
            rows.append(row(label, alone, mix, mix.without(effect)))
        rows.append(row("together", mix, mix))
        followed, whole = pressed(mix, True), pressed(mix)
        rows.append(_row("with a zero that follows", followed, ideal, (whole, followed)))
        name = f"costs-{str(mix).replace(',', '_').replace('=', '-')}"
        sum_mm = np.sqrt(max(squares, 0.0))
        title = f"What the effects of {mix} cost; the squares of those alone add up to {sum_mm:.2f} mm"
        sheets.append(Sheet(name, title, _COLUMNS, tuple(rows)))
    about = {"probes": ", ".join(names), "seeds": seeds, "first seed": seed}
    return StudyReport("What a real bench costs", about, (), _NOTES, tuple(sheets))


_COLUMNS = (
    "effect", "rms mm", "adds mm", "over benches mm", "p95 mm", "from the marker mm", "sure %", "sure, > 5 mm off %",
    "saved without it mm",
)  # fmt: skip
_NOTES = (
    "Adds: root of the difference of mean squares to a bench without any effect.",
    "Saved: what the rms of the mix falls by without the effect, or with a zero that follows.",
    "Late samples and poses cost nothing on a touch that is held still: they are left out.",
)


def press_all(name: str, reality: Reality, seed: int, *, follow: bool = False) -> MarkerPresses:
    """Calibrate on one bench, and press every marker straight and at 30 degrees an hour later."""
    rng = np.random.default_rng([seed, 23])
    loaded = LoadedSensor(draw_load(rng, _MASS_KG))
    bench = RealBench(name, reality, seed, loaded, rate=_RATE_HZ)
    model = calibrate(bench.weigh(planned_poses()).poses()).model
    bench.warm()
    bench.time = VERIFIED_S
    pressed = MarkedPresses.drawn(name, rng)
    tape = bench.press(pressed.on(bench), pressed.R_WS)
    sigma = loaded.settings.noise / np.sqrt(_READINGS)
    uncertain = model.wrench_covariance(tape.means()[1]).mean(axis=0)
    solver = ContactSolver(model_of(name, FACETS), WrenchNoise(sigma[:3], sigma[3:], extra=uncertain))
    found = solver.locate_batch(np.ascontiguousarray(tape.compensated(model, follow=follow)))
    true = np.array([touch.point for touch in tape.touches])
    told = markers(name)[np.asarray(pressed.markers) - 1]
    from_truth, from_marker = (1e3 * np.linalg.norm(found.points - each, axis=1) for each in (true, told))
    return MarkerPresses(from_truth, from_marker, np.array(found.accepted))


def _row(
    label: str,
    found: list[MarkerPresses],
    ideal: list[MarkerPresses],
    mixed: tuple[list[MarkerPresses], list[MarkerPresses]] | None,
) -> tuple[Cell, ...]:
    whole = MarkerPresses.joined(found)
    with_it, without = (MarkerPresses.joined(each).rms for each in mixed) if mixed else (0.0, 0.0)
    by_bench = [_added(one, none) for one, none in zip(found, ideal, strict=True)]
    sure = whole.from_truth[whole.sure]
    return (
        label,
        whole.rms,
        _added(whole, MarkerPresses.joined(ideal)),
        f"{min(by_bench):.2f} to {max(by_bench):.2f}",
        float(np.nanpercentile(whole.from_truth, 95)),
        float(np.sqrt(np.nanmean(whole.from_marker**2))),
        100 * float(whole.sure.mean()),
        100 * float((sure > _FAR_MM).sum() / len(whole.sure)),
        with_it - without if mixed else None,
    )


def _added(found: MarkerPresses, ideal: MarkerPresses) -> float:
    more = found.rms**2 - ideal.rms**2
    return float(np.sign(more) * np.sqrt(abs(more)))


# ---- the chapter of what a scene costs or leaves out, from the rows of its tables ----------------


KIND = "scene"
_ABOUT = ("study", "notes", "table")  # columns that are none of a table's own


def rows_of(report: StudyReport) -> list[dict[str, Any]]:
    """Return the rows of all tables of a report, each with the table and the study that it is of."""
    notes = " ".join(report.notes)
    return [
        {"study": report.title, "notes": notes, "table": sheet.title, **row}
        for sheet in report.sheets
        for row in sheet.to_json()
    ]


def make(results: Results, folder: Path) -> str:
    """
    Return the chapter, Markdown: a table for each mix, or for each thing that a moving scene leaves out.

    Parameters
    ----------
    results : Results
        Of kind ``scene``.
    folder : Path
        There are no pictures to write there.
    """
    first = results.rows[0]
    tables = []
    for title in dict.fromkeys(row["table"] for row in results.rows):
        mine = [row for row in results.rows if row["table"] == title]
        # Of the columns of all tables only those that this one has.
        own = [name for name in first if name not in _ABOUT and any(row[name] is not None for row in mine)]
        tables.append((title, table(own, [[short(row[name]) for name in own] for row in mine])))
    return chapter(first["study"], first["notes"], tables, {}, {}, folder)
