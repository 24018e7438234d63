"""The short study passes, its page comes from its results alone, and a broken bound is exit code 1."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from contactbench.pipeline.cli import app
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.save import save_probe
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.stability import amplification, probes, repeat, study, thin, verdicts
from contactbench.pipeline.study.stability.rows import PARTS
from contactbench.pipeline.study.stability.study import StabilityReport


@pytest.fixture(scope="module")
def report() -> StabilityReport:
    return study.run(samples=50, seed=1, quick=True)


def broken(report: StabilityReport) -> StabilityReport:
    at = next(i for i, row in enumerate(report.rows) if row.most is not None)
    wrong = replace(report.rows[at], worst=1e9)
    return replace(report, rows=(*report.rows[:at], wrong, *report.rows[at + 1 :]))


def test_every_bound_is_kept(report: StabilityReport) -> None:
    assert [row for row in report.rows if not row.met] == []
    assert report.passed
    measured = {row.part for row in report.rows}
    assert measured == set(PARTS) - (set() if shutil.which("g++") else {"precision"})


def test_every_part_has_a_verdict_with_its_figures(report: StabilityReport) -> None:
    said = {v.part: v for v in verdicts.verdicts(report.rows)}
    assert list(said) == list(PARTS)
    for verdict in said.values():
        assert verdict.passed is None or not re.search(r"\b(nan|inf)\b| - ", verdict.words), verdict.words
    assert "0 of 300 answers differ" in said["repeatability"].words
    wrong = verdicts.verdicts(broken(report).rows)
    assert [v.passed for v in wrong].count(False) == 1
    assert any("BROKEN: " in v.words and "1e+09" in v.words for v in wrong)


def test_what_runs_elsewhere_gives_the_same_bits(report: StabilityReport) -> None:
    rows = [row for row in report.rows if row.part == repeat.PART]
    assert {"2 threads", "2 new processes", "wrenches in reverse order"} <= {row.by for row in rows}
    assert all(row.worst == 0 and row.tries == 300 for row in rows)


def test_the_page_is_made_from_the_results_alone(report: StabilityReport, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    from contactbench.pipeline.study.pages import make_page

    page = study.keep(report, tmp_path / "one")
    pictures = sorted(page.parent.glob("*.png"))
    assert pictures
    other = tmp_path / "other"
    other.mkdir()
    shutil.copy(page.parent / "results.parquet", other)
    make_page(other)
    for file in (page, *pictures):
        assert (other / file.name).read_bytes() == file.read_bytes()
    text = page.read_text(encoding="utf-8")
    assert text.startswith("## Numerical stability")
    assert all(f"]({picture.name})" in text for picture in pictures)
    assert "Repeat with `contactbench study stability --samples 50 --seed 1 --quick`" in text
    assert {line.count("|") - line.count("\\|") for line in text.splitlines() if line.startswith("|")} == {10}


def test_the_report_is_plain_data(report: StabilityReport) -> None:
    data = json.loads(json.dumps(report.to_json(), allow_nan=False))
    assert data["passed"] is True
    assert len(data["rows"]) == len(report.rows)
    assert "### Rounding" in report.markdown()


def test_the_command_tells_a_broken_bound(report: StabilityReport, monkeypatch: pytest.MonkeyPatch) -> None:
    for given, code in ((report, 0), (broken(report), 1)):
        monkeypatch.setattr(study, "run", lambda *_, given=given, **__: given)
        ran = CliRunner().invoke(app, ["study", "stability", "--json"])
        assert ran.exit_code == code
        assert json.loads(ran.stdout)["passed"] is (code == 0)
    ran = CliRunner().invoke(app, ["study", "stability"])
    assert ran.exit_code == 1
    assert "BROKEN" in ran.stdout


def test_a_probe_of_ones_own_is_measured(tmp_path: Path) -> None:
    body = hm.ellipsoid(2)
    file = tmp_path / "own, round.ply"
    save_probe(body.probe(), file)
    assert probes.sizes_of(str(file), (100, 1000)) == [100, 320]
    assert probes.sizes_of("linear", (100, 1000)) == [100, 1000]
    rows = thin.run(50, 0, None, [str(file)]) + amplification.run(50, 0, [str(file)])
    assert {row.case for row in rows if row.figure in (thin.SLENDER, amplification.CONDITION)} == {
        "own  round"
    }
    slender = next(row for row in rows if row.figure == thin.SLENDER)
    a, b, c = np.moveaxis(body.vertices[body.faces], 1, 0)
    sides = np.linalg.norm([b - a, c - b, a - c], axis=2)
    half = sides.sum(axis=0) / 2
    area = np.sqrt(half * np.prod(half - sides, axis=0))  # Heron
    assert slender.worst == pytest.approx((sides.max(axis=0) ** 2 / (2 * area)).max(), rel=1e-6)
    with pytest.raises(InputError, match=r"nowhere\.ply"):
        study.run([str(tmp_path / "nowhere.ply")], samples=50, quick=True)
    with pytest.raises(InputError, match="another one is named linear"):
        study.run(["linear", "linear"], samples=50)


def test_too_few_samples_are_refused() -> None:
    with pytest.raises(InputError, match="at least 50"):
        study.run(samples=49)


def test_without_a_compiler_the_rest_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    given = []
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(study, "_parts", lambda *a, **_: given.append(a) or iter(()))
    assert study.run(samples=50).rows == ()
    assert given == [(("linear", "convex", "t-shape"), 50, 0, None)]
