"""What a sweep will take: counted exactly, and reckoned from what a few cells took."""

import json

import pytest
from terminal import invoke

from contactbench.pipeline.study.sweep import cell
from contactbench.pipeline.study.sweep.plan import SweepPlan
from contactbench.pipeline.study.sweep.run import estimate

_PLAN = SweepPlan(
    methods=("contactbench", "algorithm1"),
    probes=("linear",),
    facets=(500, 1_000),
    forces=tuple(range(1, 51)),
    touches=100_000,
)
_FIXED, _MAKING = 0.5, 2.0  # s
_DRAWING = 1e-4  # of each touch, s


@pytest.fixture
def clock(monkeypatch):
    """A processor whose cells take what is known, and the first of each method on each mesh more."""
    now, made, drawn = [0.0], set(), []

    def touches_of(each):
        if (each.touches, each.touch_seed) not in drawn:
            now[0] += _DRAWING * each.touches
        drawn[:] = [(each.touches, each.touch_seed)]

    def run_cell(each):
        touches_of(each)
        kind = each.method, each.facets
        now[0] += _FIXED + each.touches * _touch(each) + (0.0 if kind in made else _MAKING)
        made.add(kind)
        return {"key": each.key, "failed": ""}

    monkeypatch.setattr(cell, "run_cell", run_cell)
    monkeypatch.setattr(cell, "touches_of", touches_of)
    return lambda: now[0]


def _touch(each):
    return 1e-3 if each.method == "algorithm1" else 1e-5


def test_it_is_the_sum_of_all_cells(clock):
    found = estimate(_PLAN, workers=1, clock=clock)
    cells = _PLAN.cells()
    assert (found.cells, found.touches, found.measured) == (len(cells), len(cells) * 100_000, 4)
    located = sum(_FIXED + 100_000 * _touch(each) for each in cells)
    # Both methods take turns on the touches, which are drawn once for them.
    drawn = len(cells) // 2 * 100_000 * _DRAWING
    assert 3600 * found.core_hours == pytest.approx(located + drawn + 2 * _MAKING * found.tasks, rel=1e-6)
    assert found.hours == found.core_hours


def test_more_cores_take_less_but_never_less_than_a_task(clock):
    one = estimate(_PLAN, workers=1, clock=clock)
    four = estimate(_PLAN, workers=4, clock=clock)
    assert four.hours == pytest.approx(one.core_hours / 4, rel=0.1)
    crowd = estimate(_PLAN, workers=100_000, clock=clock)
    assert crowd.tasks == len(_PLAN)
    assert 3600 * crowd.hours == pytest.approx(_FIXED + 100_000 * 1e-3, rel=0.1)


def test_the_command_computes_nothing(tmp_path):
    plan, out = tmp_path / "a.toml", tmp_path / "out"
    plan.write_text('probes = ["linear"]\nfacets = [300]\ntouches = 2000\n', encoding="utf-8")
    words = ["study", "run", str(plan), "--dry-run", "--no-times", "--workers", "2", "--out", str(out)]
    done = invoke(*words, "--json")
    assert done.exit_code == 0, done.stderr
    told = json.loads(done.stdout)
    assert (told["cells"], told["touches"], told["workers"]) == (6, 12_000, 2)
    assert 0 < told["hours"] <= told["core_hours"]
    assert told["results_MB"] > 0
    assert not out.exists()
