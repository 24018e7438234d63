"""What is judged of the static experiments: in millimetres too, by seed, on every touch, and nothing that flatters."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from benchmarks.reproduce import static, static_sheets
from benchmarks.reproduce.attribution import FINE, Attributed
from benchmarks.reproduce.judging import judged
from benchmarks.reproduce.locating import LITERAL, OURS, ProbeResult, locate_all
from benchmarks.reproduce.statistics import distances_mm

from contactbench.pipeline.contact import Reason
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.marker_touches import ANGLES, IN_PLANE, PERPENDICULAR, press_markers
from contactbench.pipeline.study.paper_setup import draw_bench
from contactbench.pipeline.study.report import Figure, Report

CAUSES = [
    Attributed(cause, (0.2,) * 3, (0.2,) * 3, (0.2,) * 3, (0.0,) * 3) for cause in ("none", FINE, "all")
]


@pytest.fixture(scope="module")
def probe() -> ProbeResult:
    touched = press_markers("linear", markers("linear")[:3], 2, 1)
    return locate_all("linear", 1_000, touched, [draw_bench(0), draw_bench(1)])


def told(probe: ProbeResult) -> Report:
    return judged([probe], CAUSES, None, {})


def figure(report: Report, name: str) -> Figure:
    return next(each for each in report.figures if each.name == name)


def moved(probe: ProbeResult, errors_mm: Any) -> ProbeResult:
    """Put every answer so many mm from the true contact."""
    mine = probe.located[OURS]
    points = probe.touched.points + 1e-3 * np.outer(errors_mm, [1.0, 0.0, 0.0])
    return replace(probe, located={**probe.located, OURS: replace(mine, points=points)})


def test_millimetres_are_judged_beside_what_noise_alone_gives(probe: ProbeResult) -> None:
    # As much over the bound at every angle, but 1.4 times the millimetres in plane.
    error = np.where(probe.touched.angles == list(ANGLES).index(IN_PLANE), 0.28, 0.2)
    report = told(moved(probe, error))
    missed = figure(report, f"{IN_PLANE} over {PERPENDICULAR}, mm")
    assert (missed.measured, missed.most) == (pytest.approx(1.4), 1.2)
    assert not missed.passed
    assert not report.passed
    alone = figure(report, f"{IN_PLANE} over {PERPENDICULAR}, noise and geometry alone")
    assert 1.1 < alone.measured < 1.25
    assert figure(report, f"{IN_PLANE} over {PERPENDICULAR}, error over bound").measured == pytest.approx(
        1.4 / alone.measured
    )
    assert any(IN_PLANE in note and "over the target of 1.2" in note for note in report.notes)
    assert told(moved(probe, np.full(len(error), 0.2))).passed


def test_spread_and_worst_are_those_of_the_seeds(probe: ProbeResult) -> None:
    error = np.where(probe.touched.seeds == 0, 0.1, 0.3)
    mean = figure(told(moved(probe, error)), f"{PERPENDICULAR}, mean")
    assert (mean.measured, mean.worst) == (pytest.approx(0.2), pytest.approx(0.3))
    assert mean.spread == pytest.approx((0.11, 0.29))


def test_touches_in_doubt_count_and_may_not_be_many(probe: ProbeResult) -> None:
    mine = probe.located[OURS]
    reasons = mine.reasons.copy()
    reasons[0] = Reason.AMBIGUOUS
    error = np.full(len(reasons), 0.2)
    error[0] = 20.0
    doubtful = moved(replace(probe, located={**probe.located, OURS: replace(mine, reasons=reasons)}), error)
    report = told(doubtful)
    share = figure(report, "answered without doubt")
    assert share.measured == pytest.approx(100 * 17 / 18)
    assert share.least == 95
    assert not share.passed
    assert figure(report, f"{PERPENDICULAR}, mean").measured == pytest.approx((20 + 5 * 0.2) / 6)


def test_touches_that_only_the_region_decides_are_no_doubt_but_told(probe: ProbeResult) -> None:
    mine = probe.located[OURS]
    reasons = np.full_like(mine.reasons, Reason.OK)
    reasons[:2] = Reason.BY_REGION
    report = told(replace(probe, located={**probe.located, OURS: replace(mine, reasons=reasons)}))
    assert figure(report, "answered without doubt").measured == 100
    by_region = figure(report, "answered without doubt only because of the region")
    assert by_region.measured == pytest.approx(100 * 2 / 18)


def test_where_the_tip_rests_is_told_as_it_is(probe: ProbeResult) -> None:
    off = distances_mm(probe.touched.points, probe.touched.targets)
    for index, angle in enumerate(ANGLES):
        mine = 1e3 * off[probe.touched.angles == index]
        rests = figure(told(probe), f"{angle}, tip rests off its marker")
        assert (rests.measured, rests.worst) == (pytest.approx(mine.mean()), pytest.approx(mine.max()))


def test_methods_are_compared_on_the_same_touches(
    monkeypatch: pytest.MonkeyPatch, probe: ProbeResult
) -> None:
    benches = [draw_bench(0), draw_bench(1)]
    from benchmarks.reproduce import locating

    real = locating.Located.of
    calls = iter(range(1_000))

    def some_left_out(batch: Any) -> Any:
        made = real(batch)
        if next(calls) == 0:  # the first method, the first seed
            made.points[0] = np.nan
        return made

    monkeypatch.setattr(locating.Located, "of", some_left_out)
    errors = locate_all("linear", 1_000, probe.touched, benches).errors
    assert {one.common for (angle, _), one in errors.items() if angle == PERPENDICULAR} == {5}
    literal = errors[PERPENDICULAR, LITERAL]
    assert literal.answered == 1
    rows = (probe.touched.angles == 0) & (np.arange(len(probe.touched)) != 0)
    error = distances_mm(probe.located[LITERAL].points, probe.touched.points)
    assert literal.common_mean == pytest.approx(error[rows].mean())
    assert literal.mean == pytest.approx(error[probe.touched.angles == 0].mean())


def test_the_papers_figures_are_only_beside_its_own_probe(probe: ProbeResult) -> None:
    shaped = replace(probe, name="t-shape")
    assert [row[1] for row in static_sheets.times_sheet([probe]).rows].count("paper") == 0
    assert [row[1] for row in static_sheets.times_sheet([probe, shaped]).rows].count("paper") == 1
    assert "paper" not in [row[0] for row in static_sheets.causes_sheet(CAUSES, None).rows]
    assert not any("the paper has" in note for note in told(probe).notes)
    paper = {row[2]: row[-1] for row in static_sheets.errors_sheet([probe]).rows if row[1] == PERPENDICULAR}
    assert paper[OURS] == "1.28 ± 0.44"
    assert paper[LITERAL] == ""


def test_the_order_of_the_probes_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    for part in ("by_force", "force_errors", "attribute", "explain", "effects"):
        monkeypatch.setattr(static, part, lambda *_: [])
    options: dict[str, Any] = {"seeds": 1, "touches": 1, "most_markers": 3}
    both = static.run(("linear", "t-shape"), **options)
    turned = static.run(("t-shape", "linear"), **options)
    alone = static.run(("linear",), **options)
    assert [one.name for one in both.probes] == [one.name for one in turned.probes] == ["t-shape", "linear"]
    assert both.settings == turned.settings
    for other in (turned.probes[1], alone.probes[0]):
        np.testing.assert_array_equal(both.probes[1].located[OURS].points, other.located[OURS].points)
