"""A probe's figures keep their bounds, its page comes from its results alone, and a broken bound is exit code 1."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.solver import hard_meshes as hm
from terminal import invoke

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.sidecar import save_probe
from contactbench.pipeline.study import stability as study
from contactbench.pipeline.study.harness import CasesReport
from contactbench.pipeline.study.stability import PARTS, StabilityRow

Report = CasesReport[StabilityRow]
ROW = StabilityRow("edges", "case", "double", "figure", "mm", 3, 1.0, 2.0, x=10.0, axis="ratio", most=2.0)


@pytest.fixture(scope="module")
def report() -> Report:
    return study.run(samples=50, seed=1)


def broken(report: Report) -> Report:
    at = next(i for i, row in enumerate(report.rows) if row.most is not None)
    wrong = replace(report.rows[at], worst=1e9)
    return replace(report, rows=(*report.rows[:at], wrong, *report.rows[at + 1 :]))


def test_every_bound_is_kept(report: Report) -> None:
    assert [row for row in report.rows if not row.met] == []
    assert list(dict.fromkeys(row.part for row in report.rows)) == list(PARTS)
    conditions = {(r.case, r.x): r.worst for r in report.rows if r.figure == study.CONDITION}
    for name in report.about["probes"]:
        assert conditions[name, 75.0] > 2 * conditions[name, 0.0]


def test_an_inexact_solver_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = study.answers_on
    monkeypatch.setattr(study, "answers_on", lambda *given: right(*given) * (1 + 1e-12))
    missed = [row for row in study.run(["linear"], samples=50).rows if not row.met]
    assert {row.figure for row in missed} == {study.RATIO}


@pytest.mark.parametrize(
    ("worst", "most", "met"),
    [(2.0, 2.0, True), (2.1, 2.0, False), (9.0, None, True), (np.nan, 2.0, False), (np.inf, 2.0, False)],
)
def test_a_bound_is_kept_or_not(worst: float, most: float | None, met: bool) -> None:
    assert replace(ROW, worst=worst, most=most).met is met


def test_values_are_summed_up_without_those_that_are_none() -> None:
    row = StabilityRow.of("edges", "case", "double", "figure", "mm", [3.0, np.nan, 1.0, 2.0])
    assert (row.tries, row.median, row.worst) == (3, 2.0, 3.0)
    empty = StabilityRow.of("edges", "case", "double", "figure", "mm", [], most=1.0)
    assert empty.tries == 0
    assert not empty.met


@pytest.mark.parametrize("row", [ROW, replace(ROW, x=None, most=None, worst=np.nan)])
def test_rows_are_plain_data_and_come_back(row: StabilityRow) -> None:
    data = json.loads(json.dumps(row.to_json(), allow_nan=False))
    assert repr(StabilityRow.from_json(data)) == repr(row)


@pytest.mark.parametrize("code", [0, 1])
def test_the_command_keeps_a_page_that_is_made_from_its_results_alone(
    report: Report, code: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    pytest.importorskip("pyarrow")
    from contactbench.pipeline.study.pages import make_page

    monkeypatch.setattr(study, "run", lambda *_, **__: broken(report) if code else report)
    out = tmp_path / "one"
    words = ["study", "stability", "--samples", "50", "--seed", "1", "--out", str(out), "--json"]
    ran = invoke(*words)
    assert ran.exit_code == code
    data = json.loads(ran.stdout)
    assert data["passed"] is (code == 0)
    assert len(data["rows"]) == len(report.rows)
    other = tmp_path / "other"
    other.mkdir()
    shutil.copy(out / "results.parquet", other)
    make_page(other)
    for name in ("page.md", "rounding.png"):
        assert (other / name).read_bytes() == (out / name).read_bytes()
    text = (out / "page.md").read_text(encoding="utf-8")
    assert text.startswith("## Numerical stability")
    assert "Repeat with `contactbench study stability --seed 1 --samples 50`" in text
    assert ("Every bound is kept." in text) is (code == 0)
    assert ("1e+09" in text) is (code == 1)
    assert {line.count("|") - line.count("\\|") for line in text.splitlines() if line.startswith("|")} == {10}
    assert "### Rounding" in text
    assert invoke("study", "stability").exit_code == code


def test_results_with_parts_of_earlier_versions_still_make_a_page(report: Report, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    from contactbench.pipeline.study.pages import publish

    rows = [replace(ROW, part="repeatability"), *report.rows]
    page = publish(tmp_path, "stability", "contactbench study stability", [row.to_json() for row in rows])
    assert "### Repeatability" in page.read_text(encoding="utf-8")


def test_a_probe_of_ones_own_is_measured_on_its_own_mesh(tmp_path: Path) -> None:
    body = hm.ellipsoid(2)
    file = tmp_path / "own, round.ply"
    save_probe(body.probe(), file)
    rows = study.run([str(file)], samples=50).rows
    assert {row.case.partition(", ")[0] for row in rows} == {"own  round"}
    assert all(row.met for row in rows)
    slender = next(row for row in rows if row.figure == study.SLENDER)
    assert slender.tries == 320
    a, b, c = np.moveaxis(body.vertices[body.faces], 1, 0)
    sides = np.linalg.norm([b - a, c - b, a - c], axis=2)
    half = sides.sum(axis=0) / 2
    area = np.sqrt(half * np.prod(half - sides, axis=0))  # Heron
    assert slender.worst == pytest.approx((sides.max(axis=0) ** 2 / (2 * area)).max(), rel=1e-6)


@pytest.mark.parametrize(
    ("names", "samples", "said"),
    [
        (["nowhere.ply"], 50, r"nowhere\.ply"),
        (["linear", "linear"], 50, "another one is named linear"),
        (["linear"], 49, "at least 50"),
    ],
)
def test_what_cannot_be_measured_is_refused(names: list[str], samples: int, said: str) -> None:
    with pytest.raises(InputError, match=said):
        study.run(names, samples=samples)
