"""Pages and commands of sweeps: everything shown comes from the Parquet file alone."""

import json
import re
import shutil

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
from contactbench.pipeline.study.sweep.growth import tables
from contactbench.pipeline.study.sweep.plan import preset_plan


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
    assert said in " ".join(result.stderr.split())
