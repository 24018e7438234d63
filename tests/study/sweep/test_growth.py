"""Powers, fronts, knees and needed facets, on figures that are known."""

import json
import re
import shutil

import numpy as np
import pytest
from terminal import invoke

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.pages import (
    PAGE,
    RESULTS,
    environment,
    gather,
    make_page,
    read_results,
    write_results,
)
from contactbench.pipeline.study.sweep.growth import (
    beaten,
    enough_facets,
    front,
    knee,
    merged,
    needed_facets,
    on_front,
    over_bound,
    power,
    settling,
    tables,
    targets,
    torque_table,
)
from contactbench.pipeline.study.sweep.plan import preset_plan

_FACETS = (100, 300, 1_000, 3_000, 20_000)


def _row(method="contactbench", facets=20_000, error=0.5, time=1_000.0, **more):
    return {
        "probe": "linear",
        "method": method,
        "facets": facets,
        "facets_found": facets,
        "force": 9.0,
        "angle": 0.0,
        "torsion": 0.0003,
        "noise": "paper",
        "filter": "none",
        "touches": 1_000,
        "failed": "",
        "mean_mm": error,
        "rms_sure_mm": error,
        "rms_near_mm": error,
        "bound_mm": 0.5,
        "sure": 1.0,
        "python_median_ns": time,
    } | more


def test_a_power_is_found_with_its_uncertainty():
    facets = np.array([100, 1_000, 10_000, 100_000])
    exact = power(facets, 3 * facets**-0.9)
    assert (exact.exponent, exact.scale) == (pytest.approx(-0.9), pytest.approx(3))
    assert exact.sigma < 1e-9
    assert power(facets, [3.0, 2.0, 1.9, 1.85]).sigma > 0.02
    assert power([100, 200], [1, 2]) is None
    assert power([100, 100, 100], [1, 2, 3]) is None
    assert power([1, 2, 3], [0, np.nan, 1]) is None


def test_a_floor_is_told_from_a_power():
    facets = np.array([100, 1_000, 10_000, 100_000, 1_000_000.0])
    bent = settling(facets, np.hypot(50 * facets**-0.9, 0.1))
    assert (bent.exponent, bent.floor) == (pytest.approx(-0.9, abs=1e-3), pytest.approx(0.1, rel=1e-3))
    straight = settling(facets, 50 * facets**-0.8 * np.array([1.1, 0.9, 1.05, 1, 0.95]))
    assert straight.floor == 0
    assert straight.exponent == pytest.approx(-0.8, abs=0.03)
    assert abs(settling(facets, [1.0, 1.1, 0.9, 1.05, 1.0]).exponent) < 0.02
    assert settling(facets[:3], 1 / facets[:3]).exponent == pytest.approx(-1)
    assert settling(facets[:2], facets[:2]) is None


def test_the_front_and_its_knee():
    rows = [_row(time=t, error=e) for t, e in ((1, 9), (2, 1), (3, 5), (40, 0.9), (50, 0.9))]
    assert [(r["python_median_ns"], r["mean_mm"]) for r in front(rows)] == [(1, 9), (2, 1), (40, 0.9)]
    assert knee(rows)["python_median_ns"] == 2
    assert knee([]) is None
    assert beaten(rows[2], rows) == [rows[1]]
    assert beaten(rows[1], [_row(time=1.99, error=0.99)]) == []  # within chance


def test_figures_are_merged_over_what_is_not_asked_for():
    rows = [_row(error=1.0), _row(error=7.0, force=2.0), _row(error=9.0, failed="no")]
    [both] = merged(rows, ("method",))
    assert both["cells"] == 2
    assert both["mean_mm"] == 4
    assert both["rms_sure_mm"] == pytest.approx(5)
    assert np.isnan(both["compiled_median_ns"])


def test_enough_facets_lie_where_the_power_says():
    facets = np.array(_FACETS, dtype=float)
    mesh = 200.0 / facets  # mm
    # Squares add: 1.01 times 1 mm of noise leaves 0.1418 mm to the mesh.
    assert enough_facets(facets, mesh, 1.0) == pytest.approx(200 / np.sqrt(1.01**2 - 1), rel=1e-6)
    assert enough_facets(facets, mesh, 1e-3) is None
    assert enough_facets(facets, mesh, 1e4) == 100
    rows = [_row(facets=f, error=200.0 / f, noise="none", bound_mm=0.0) for f in _FACETS]
    rows += [_row(bound_mm=1.0, force=force) for force in (2.0, 9.0)]
    assert needed_facets(rows) == [
        ("linear", force, pytest.approx(1_410.7, abs=1), 100) for force in (2.0, 9.0)
    ]


def test_targets_are_judged_both_ways():
    [good] = over_bound([_row(error=0.51), _row(error=0.52, angle=60.0)])
    [bad] = over_bound([_row(error=0.51), _row(error=0.60, angle=60.0)])
    assert good.met
    assert not bad.met
    assert "worst 1.200" in bad.measured
    assert "60°" in bad.measured
    # Too steep, too light, too coarse: not what the target is about.
    assert over_bound([_row(error=9, angle=70.0), _row(error=9, force=1.0), _row(error=9, facets=500)]) == []
    [front_of] = on_front([_row(), _row("wrench_axis", error=0.4)])
    assert front_of.met
    [beaten_at] = on_front([_row(), _row("wrench_axis", error=0.4, time=900.0)])
    assert not beaten_at.met
    assert "20,000: wrench_axis" in beaten_at.measured


def test_steep_touches_are_judged_apart():
    rows = [_row(), _row("wrench_axis", error=0.6, time=900.0)]
    rows += [_row(angle=60.0, error=0.52), _row("wrench_axis", angle=60.0, error=0.4, time=900.0)]
    found = {target.what: target.met for target in targets(rows)}
    assert found["linear: no rival is both faster and more accurate at the same resolution"]
    assert not found["linear: no rival is both faster and more accurate at the same resolution, beyond 45°"]
    # Torsion beyond what friction makes is no part of the target.
    assert over_bound([_row(error=9, torsion=0.003)]) == []


def test_what_the_local_torque_brings_is_shown_by_force_and_torsion():
    rows = [
        _row(method, force=force, torsion=torsion, rms_near_mm=error)
        for method, error in (("contactbench", 0.5), ("wrench_axis", 1.5))
        for force in (2.0, 9.0)
        for torsion in (0.0003, 0.003)
    ]
    shown = torque_table(rows)
    assert "contactbench, torsion 0.3 mm | wrench_axis, torsion 0.3 mm | contactbench, torsion 3 mm" in shown
    assert "| 2 N | 1.00 | 3.00 | 1.00 | 3.00 |" in shown
    assert torque_table(rows[:1]) == torque_table([]) == ""


# ---- pages and commands of sweeps: everything shown comes from the Parquet file alone ------------


@pytest.fixture
def alone(small, tmp_path):
    """Only the Parquet file, somewhere else."""
    folder = tmp_path / "moved"
    folder.mkdir()
    shutil.copy(small / RESULTS, folder)
    return folder


def _invoke(*words):
    return invoke("study", *words)


def test_a_page_is_made_of_the_results_alone_and_is_the_same_each_time(alone):
    text = make_page(alone)
    assert (alone / PAGE).read_text(encoding="utf-8") == text
    pictures = set(re.findall(r"\]\(([\w.-]+\.png)\)", text))
    assert {"speed-error.png", "growth.png", "force.png", "angle.png"} <= pictures
    kept = {name: (alone / name).read_bytes() for name in pictures}
    assert all(data.startswith(b"\x89PNG") for data in kept.values())
    assert make_page(alone) == text
    assert {name: (alone / name).read_bytes() for name in pictures} == kept
    assert "Repeat with `contactbench study run small.toml`" in text
    assert str(alone.parent) not in text


def test_tables_say_what_the_rows_say(rows):
    shown = dict(tables(rows))
    assert list(shown) == [
        "Targets",
        "Speed against error: the knees",
        "Growth with the mesh",
        "Facets at which the mesh adds 1 % to the noise",
        "Steep touches, without noise",
        "Reasons, and answers on another part of the probe",
    ]
    growth = re.search(r"\| linear \| contactbench \| .*? \| (-?[\d.]+) ±", shown["Growth with the mesh"])
    assert -1.3 < float(growth.group(1)) < -0.6
    assert shown["Facets at which the mesh adds 1 % to the noise"].startswith("| probe | 2 N | 9 N | 20 N |")
    # A plan that varies little is told about in fewer tables.
    few = dict(tables([row for row in rows if row["facets"] == 600 and row["angle"] == 0]))
    assert "Growth with the mesh" not in few
    assert "Steep touches, without noise" not in few


def test_pages_of_several_studies_go_into_one_folder(small, tmp_path):
    results = read_results(small)
    rows = [row for row in results.rows if row["angle"] == 0]
    folders = [tmp_path / "moved", tmp_path / "other"]
    for folder in folders:
        folder.mkdir()
        write_results(folder, results.kind, results.command, rows, environment(), results.about)
    pages = gather(folders, tmp_path / "docs")
    assert pages == [tmp_path / "docs" / "moved.md", tmp_path / "docs" / "other.md"]
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert text.startswith("# Sweep: small\n")
        assert f"({page.stem}-growth.png)" in text
        for name in re.findall(r"\]\(([\w.-]+\.png)\)", text):
            assert (tmp_path / "docs" / name).is_file()
    twin = tmp_path / "twin" / "other"
    twin.mkdir(parents=True)
    with pytest.raises(InputError, match="two folders have the same name"):
        gather([folders[1], twin], tmp_path / "docs")


def test_unknown_and_missing_studies_are_named(tmp_path):
    with pytest.raises(InputError, match="no results of a study"):
        make_page(tmp_path)
    write_results(tmp_path, "poetry", "none", [{"a": 1}], environment())
    with pytest.raises(InputError, match="a study of kind 'poetry': known are sweep"):
        make_page(tmp_path)
    (tmp_path / RESULTS).write_bytes(b"PAR1 not")
    with pytest.raises(InputError, match="no results of a study"):
        read_results(tmp_path)


def test_the_commands_run_and_page(tmp_path):
    out = tmp_path / "quick"
    words = ("--preset", "quick", "--probe", "linear", "--touches", "100", "--workers", "1", "--out", out)
    done = _invoke("run", *words, "--json")
    assert done.exit_code == 0, done.stderr
    assert (
        json.loads(done.stdout)["cells"]
        == json.loads(done.stdout)["computed"]
        == len(preset_plan("quick").changed(["linear"]))
    )
    assert read_results(out).command == "contactbench study run --preset quick --probe linear --touches 100"
    assert json.loads(_invoke("run", *words, "--json").stdout)["computed"] == 0
    paged = _invoke("page", out, "--json")
    assert paged.exit_code in (0, 1)
    told = json.loads(paged.stdout)
    assert told["pages"] == [str(out / PAGE)]
    assert bool(told["missed"]) == (paged.exit_code == 1)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("run",), "give either a STUDY.toml or a --preset"),
        (("run", "x.toml", "--preset", "quick"), "give either a STUDY.toml or a --preset"),
        (("run", "nowhere.toml"), "cannot be read"),
        (("run", "--preset", "slow"), "choose one of paper"),
        (("run", "--preset", "quick", "--probe", "banana"), "banana: the probe cannot be read"),
        (("run", "--preset", "quick", "--touches", "1"), "touches: Input should be greater"),
        (("run", "--preset", "quick", "--part", "9/8"), "--part 9/8: give which of how many"),
        (("page", "nowhere"), "no results of a study"),
    ],
)
def test_wrong_input_is_named(tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    result = _invoke(*words)
    assert result.exit_code == 2
    assert said in " ".join(result.output.split())
