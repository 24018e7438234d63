"""The whole ablation in short: rows of every kind, a page from them alone, and the command."""

import json

import pytest
from typer.testing import CliRunner

from contactbench.pipeline.cli import app
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.ablation.effects import CHOICES
from contactbench.pipeline.study.ablation.run import KIND, AblationSizes, run
from contactbench.pipeline.study.ablation.verdicts import CHOICES as ALL
from contactbench.pipeline.study.ablation.verdicts import about_choices
from contactbench.pipeline.study.pages import make_page
from contactbench.pipeline.study.results import write_results

SHORT = AblationSizes(
    probes=("linear",),
    scenes=("touch", "platform"),
    facets=500,
    coarse=(300,),
    twisted=(300,),
    size=4,
    touches=60,
    seeds=1,
    rounds=1,
    motions=("in plane",),
)


@pytest.fixture(scope="module")
def rows():
    pytest.importorskip("mujoco")
    return run(SHORT)


def test_every_choice_has_its_rows(rows):
    assert {row["kind"] for row in rows} == {"effect", "curve", "scenery", "cost"}
    assert {row["choice"] for row in rows if row["kind"] == "effect"} == set(CHOICES)
    found = about_choices(rows)
    assert [each.choice for each in found] == [choice for choice in ALL if choice != "arm dynamics"]


def test_tissue_is_worth_its_time_and_smooth_normals_are_not(rows):
    said = {each.choice: each.verdict for each in about_choices(rows)}
    assert said["deformable phantom"] == "model it"
    assert said["smooth normals"] == "leave it out"


def test_the_page_is_made_from_the_file_alone(rows, tmp_path):
    pytest.importorskip("pyarrow")
    write_results(tmp_path, KIND, "contactbench study ablation", rows, {"processor": "any"})
    text = make_page(tmp_path)
    assert text.startswith("## What a scene needs")
    for title in (
        "Model this, leave this out",
        "What each choice costs",
        "Where each choice begins to matter",
    ):
        assert f"### {title}" in text
    for name in ("smooth.png", "torque.png", "reading.png"):
        assert f"({name})" in text
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    assert make_page(tmp_path) == text


@pytest.mark.parametrize(
    ("change", "said"),
    [({"probes": ("banana",)}, "banana"), ({"scenes": ("moon",)}, "moon"), ({"seeds": 0}, "--seeds 0")],
)
def test_wrong_sizes_are_named(change, said):
    with pytest.raises(InputError, match=said):
        AblationSizes(**change)


def test_the_command_writes_everything(rows, tmp_path, monkeypatch):
    pytest.importorskip("pyarrow")
    monkeypatch.setattr("contactbench.pipeline.study.ablation.run.run", lambda *_, **__: rows)
    call = ["study", "ablation", "--quick", "--seeds", "1", "--out", str(tmp_path / "a"), "--json"]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["rows"] == len(rows)
    assert {each["choice"] for each in found["choices"]} >= set(CHOICES)
    assert (tmp_path / "a" / "page.md").exists()
    wrong = CliRunner().invoke(app, ["study", "ablation", "--probe", "banana", "--out", str(tmp_path)])
    assert wrong.exit_code == 2
