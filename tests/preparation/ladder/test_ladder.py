"""The whole ladder: its rungs, its order, its files, and how it is stopped."""

import csv
import io
import json
import re
from pathlib import Path
from typing import Any

import pytest
from contact_cases import bundled
from rich.console import Console

from contactbench.pipeline.mesh import MeshError, load_probe, save_probe
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.preparation.ladder import measure as measure_module
from contactbench.pipeline.preparation.ladder.compare import ExpectedTouches, LadderError
from contactbench.pipeline.preparation.ladder.ladder import Goal, Ladder
from contactbench.pipeline.preparation.ladder.measure import measure_ladder
from contactbench.pipeline.preparation.ladder.picture import draw_ladder, save_ladder

QUICK = ExpectedTouches(count=200)


def test_rungs_climb_to_the_full_mesh(ladder: Ladder) -> None:
    assert [rung.facets for rung in ladder.rungs[:-1]] == [300, 1_000, 2_000]
    full = ladder.full
    assert full.facets == len(bundled("linear", 5_000).faces)
    assert (full.hausdorff, full.rms, full.engine) == (0.0, 0.0, "none")
    assert full.judged.noisy.largest == full.judged.noise_free.largest == 0
    assert all([errors.part for errors in rung.errors] == ["region", "rest"] for rung in ladder.rungs)


def test_finer_rungs_are_nearer_to_the_full_mesh(ladder: Ladder) -> None:
    for part in (0, 1):
        p95 = [rung.errors[part].noise_free.p95 for rung in ladder.rungs]
        # Of 5,000 facets, 1,000 and 2,000 differ by less than 200 touches tell.
        assert p95[0] > 2 * p95[2] > p95[3] == 0
        assert p95[0] > p95[1] > 0.9 * p95[2]
    assert ladder.rungs[0].hausdorff > ladder.rungs[2].hausdorff > 0
    # The bound is the full mesh's, the same for all.
    assert len({rung.judged.bound for rung in ladder.rungs}) == 1
    assert 0.5e-3 < ladder.full.judged.bound < 2e-3


def test_a_rung_states_the_size_of_its_file(ladder: Ladder, tmp_path: Path) -> None:
    rung = ladder.rungs[0]
    save_probe(rung.probe, tmp_path / "rung.ply")
    assert rung.file_bytes == (tmp_path / "rung.ply").stat().st_size
    assert load_probe(tmp_path / "rung.ply", units="m").region.any()


def test_all_rungs_are_timed(ladder: Ladder) -> None:
    for rung in ladder.rungs:
        assert rung.speed is not None
        for timing in (rung.speed.algorithm1, rung.speed.contactbench):
            assert 0 < timing.median <= timing.p99
        assert rung.speed.ratio == rung.speed.algorithm1.median / rung.speed.contactbench.median


def test_progress_never_falls_and_ends_at_one(climbed: Any) -> None:
    assert climbed.progress == sorted(climbed.progress)
    assert climbed.progress[-1] == 1
    assert len(set(climbed.progress)) > 20


def test_everything_but_the_clock_is_the_same_again(ladder: Ladder) -> None:
    again = measure_ladder(
        bundled("linear", 5_000, regions=True), ExpectedTouches(count=500), (300, 1_000, 2_000)
    )
    first, second = ladder.to_json(), again.to_json()
    for data in (first, second):
        for rung in data["rungs"]:
            del rung["speed"]
        data["recommendation"]["reason"] = data["recommendation"]["reason"].split(" Contactbench takes")[0]
    assert first == second


def test_a_probe_without_regions_is_judged_as_a_whole() -> None:
    ladder = measure_ladder(bundled("convex", 2_000), QUICK, (500,), goal=Goal(limit_m=1e-6))
    assert [[errors.part for errors in rung.errors] for rung in ladder.rungs] == [["all"], ["all"]]
    assert ladder.recommendation.facets is None
    assert ladder.recommended is ladder.full
    assert "on its surface" in ladder.sentences()[0]


def test_a_rung_that_no_engine_reaches_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    simplify = measure_module.simplify

    def without_500(probe, target, **options):
        if target.facets == 500:
            raise MeshError("the surface cannot be simplified to 500 facets.")
        return simplify(probe, target, **options)

    monkeypatch.setattr(measure_module, "simplify", without_500)
    ladder = measure_ladder(bundled("convex", 2_000), QUICK, (500, 1_000))
    assert [rung.asked for rung in ladder.rungs[:-1]] == [1_000]
    assert ladder.notes == (
        "The rung of 500 facets is missing: the surface cannot be simplified to 500 facets.",
    )
    assert ladder.sentences()[-1] == ladder.notes[0]


@pytest.mark.parametrize("until", [0.0, 0.25, 0.7])
def test_a_ladder_can_be_cancelled_at_any_time(until: float) -> None:
    told = [0.0]
    with pytest.raises(Cancelled):
        measure_ladder(
            bundled("convex", 2_000),
            QUICK,
            (500, 1_000),
            monitor=Monitor(told.append, lambda: told[-1] >= until),
        )
    assert until <= told[-1] < 1


def test_wrong_counts_are_refused() -> None:
    with pytest.raises(LadderError, match="at least one"):
        measure_ladder(bundled("convex", 2_000), QUICK, ())
    with pytest.raises(MeshError, match="fewer than 4"):
        measure_ladder(bundled("convex", 2_000), QUICK, (500, 3))


def test_the_data_is_plain_and_the_table_has_a_row_per_part(ladder: Ladder) -> None:
    data = json.loads(json.dumps(ladder.to_json(), allow_nan=False))
    assert data["schema"] == "contactbench.ladder"
    assert data["expected"]["noise"] == pytest.approx([0.05] * 3 + [0.002] * 3)
    rung = data["rungs"][0]
    judged = ladder.rungs[0].judged
    assert rung["errors"][0]["noisy"]["p95"] == judged.noisy.p95
    assert rung["errors"][0]["p95_over_bound"] == judged.noisy.p95 / judged.bound
    assert data["rungs"][-1]["speed"]["contactbench_over_full"] == 1
    columns, rows = ladder.csv_rows()
    assert len(rows) == 2 * len(ladder.rungs)
    first = dict(zip(columns, rows[0], strict=True))
    assert first["p95_mm"] == 1e3 * judged.noisy.p95
    assert first["max_mm"] == 1e3 * judged.noisy.largest
    assert (first["facets"], first["part"], first["lost"]) == (300, "region", judged.noisy.lost)
    assert first["contactbench_median_ns"] == ladder.rungs[0].speed.contactbench.median


def test_the_tables_mark_what_is_recommended(ladder: Ladder) -> None:
    console = Console(file=io.StringIO(), width=140)
    for table in ladder.tables():
        console.print(table)
    text = console.file.getvalue()
    assert text.count(f"{ladder.recommendation.facets:,}*") == 2
    assert f"{1e3 * ladder.rungs[0].judged.noisy.p95:.3f}" in text
    assert "-0.0 %" not in text


def test_the_files_are_written_and_the_pictures_are_the_same_again(ladder: Ladder, tmp_path: Path) -> None:
    files = save_ladder(ladder, tmp_path)
    assert [file.name for file in files] == ["ladder.json", "ladder.csv", "ladder.svg", "ladder.png"]
    assert json.loads(files[0].read_text(encoding="utf-8")) == json.loads(json.dumps(ladder.to_json()))
    rows = list(csv.DictReader(files[1].read_text(encoding="utf-8").splitlines()))
    assert [row["part"] for row in rows[:2]] == ["region", "rest"]
    svg = files[2].read_text(encoding="utf-8")
    assert svg.encode() == draw_ladder(ladder, "svg")
    assert files[3].read_bytes() == draw_ladder(ladder, "png")
    assert files[3].read_bytes().startswith(b"\x89PNG")
    words = re.sub(r"<[^>]*>", " ", svg)
    for said in ("linear: what fewer facets cost in the priority regions", "recommended", "noise 1", "1,000"):
        assert said in words


def test_a_folder_that_is_not_there_is_named(ladder: Ladder, tmp_path: Path) -> None:
    with pytest.raises(LadderError, match=r"ladder\.json: the file cannot be written"):
        save_ladder(ladder, tmp_path / "nowhere")
