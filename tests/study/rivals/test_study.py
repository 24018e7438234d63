"""The rivals' page and command, on one short run."""

import json

import pytest
from typer.testing import CliRunner

from contactbench.pipeline.cli import app
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.pages import make_page
from contactbench.pipeline.study.results import write_results
from contactbench.pipeline.study.rivals import place
from contactbench.pipeline.study.rivals.rows import FAMILY, OURS
from contactbench.pipeline.study.rivals.run import KIND, RivalsSizes, run

pytest.importorskip("pyarrow")


@pytest.fixture(scope="module")
def rows():
    patch = pytest.MonkeyPatch()
    patch.setattr(place, "_FEW", 20)
    short = RivalsSizes(probes=("linear",), facets=(500,), touches=200, rounds=1)
    found = run(short)
    patch.undo()
    return found


def test_what_is_said_once_is_said_once(rows):
    said = [
        (row["kind"], row["family"], row["contender"])
        for row in rows
        if row["kind"] in ("version", "missing")
    ]
    assert len(set(said)) == len(said)


def test_ours_is_on_the_front_of_a_short_run(rows):
    errors = {
        row["contender"]: row["mean_mm"]
        for row in rows
        if (row["kind"], row.get("condition")) == ("error", "none") and row["family"] == FAMILY
    }
    # Without noise nobody is nearer; the literal loop and the scan are the same on a face that is convex.
    assert errors[OURS] <= 1.001 * min(mean for name, mean in errors.items() if not name.startswith(OURS))


def test_the_page_is_made_from_the_file_alone(rows, tmp_path):
    write_results(tmp_path, KIND, "contactbench study rivals", rows, {"processor": "any"})
    text = make_page(tmp_path)
    assert text.startswith("## Rivals, measured")
    assert "### Is anybody both faster and more accurate?" in text
    assert "| **contactbench** |" in text
    assert "Levenberg-Marquardt, SciPy" in text
    assert (tmp_path / "location.png").read_bytes().startswith(b"\x89PNG")
    assert make_page(tmp_path) == text


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"probes": ("banana",)}, "banana"),
        ({"facets": (10,)}, "--facets 10"),
        ({"rounds": 0}, "--rounds 0"),
    ],
)
def test_wrong_sizes_are_named(change, said):
    with pytest.raises(InputError, match=said):
        RivalsSizes(**change)


def winner(row):
    """Make a rival of a row of ours: twice as fast, half the error."""
    if row["kind"] == "time":
        return row | {"contender": "magic", "median_us": 0.5 * row["median_us"]}
    half = {"worse_mm": -0.5 * row["mean_mm"], "worse_se_mm": 1e-3 * row["mean_mm"]}
    return row | half | {"contender": "magic", "common_mm": 0.5 * row["mean_mm"]}


def test_the_command_ends_with_1_when_a_rival_wins(rows, tmp_path, monkeypatch):
    mine = [row for row in rows if row["kind"] in ("time", "error") and row["contender"] == OURS]
    won = rows + [winner(row) for row in mine if row["family"] == FAMILY]
    for found, code in ((rows, 0), (won, 1)):
        kept = [row for row in found if not _faster(row)]
        monkeypatch.setattr("contactbench.pipeline.study.rivals.run.run", lambda *_, kept=kept, **__: kept)
        done = CliRunner().invoke(app, ["study", "rivals", "--quick", "--out", str(tmp_path), "--json"])
        assert done.exit_code == code, done.output
        said = json.loads(done.stdout)["faster_and_more_accurate"]
        assert bool([words for words in said if words.startswith("magic")]) is bool(code)
    wrong = CliRunner().invoke(app, ["study", "rivals", "--probe", "banana", "--out", str(tmp_path)])
    assert wrong.exit_code == 2


def _faster(row):
    """Leave the real rivals' times out: how fast they are on a busy machine is not what is tested."""
    return row["kind"] == "time" and row["family"] == FAMILY and row["contender"] not in (OURS, "magic")
