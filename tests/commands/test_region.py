"""contactbench probe regions ..."""

import json
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import terminal
import trimesh
from terminal import said

from contactbench.pipeline.mesh import Probe, load_probe, save_probe
from contactbench.pipeline.mesh.regions import exchange

invoke = partial(terminal.invoke, "probe", "regions")


def done(*arguments: object) -> dict[str, Any]:
    result = invoke(*arguments, "--json")
    assert result.exit_code == 0, result.stderr
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def unchanged(mesh: Path, why: str, *arguments: object) -> None:
    """The command says why nothing changed, with exit code 1, and leaves the files alone."""
    before = mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()
    result = invoke(*arguments, "--json")
    assert result.exit_code == 1, result.stderr
    assert json.loads(result.stdout)["changed"] == 0
    assert f"Nothing changed: {why}" in said(result)
    assert (mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()) == before


def labels(mesh: Path) -> np.ndarray:
    return load_probe(mesh, units="m").region


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    """A cube of 40 mm with 768 facets, corners every 5 mm, and the regions Top and Side."""
    box = trimesh.creation.box(extents=(0.04, 0.04, 0.04)).subdivide().subdivide().subdivide()
    save_probe(Probe.from_arrays(box.vertices, box.faces), tmp_path / "probe.ply")
    done("add", tmp_path / "probe.ply", "Top")
    done("add", tmp_path / "probe.ply", "Side", "--colour", "#123456")
    return tmp_path / "probe.ply"


def test_the_list(mesh: Path) -> None:
    found = done("list", mesh)
    assert found["facets"] == 768
    empty = {"untouchable": False, "facets": 0, "area_mm2": 0.0}
    assert found["regions"] == [
        {"priority": 1, "name": "Top", "colour": "#e69f00", **empty},
        {"priority": 2, "name": "Side", "colour": "#123456", **empty},
    ]
    shown = invoke("list", mesh)
    assert "Top" in shown.stdout
    assert "#123456" in shown.stdout


def test_names_colours_and_order(mesh: Path) -> None:
    done("plane", mesh, "Top", "--point", "0,0,20", "--normal", "0,0,1")
    done("rename", mesh, "Top", "Lens")
    done("colour", mesh, "2", "#ffffff")
    found = done("reorder", mesh, "Side", "Lens")
    assert [(row["name"], row["colour"], row["facets"]) for row in found["regions"]] == [
        ("Side", "#ffffff", 0),
        ("Lens", "#e69f00", 128),
    ]
    assert np.count_nonzero(labels(mesh) == 2) == 128
    found = done("remove", mesh, "1")
    assert [row["name"] for row in found["regions"]] == ["Lens"]
    assert np.count_nonzero(labels(mesh) == 1) == 128
    assert done("clear", mesh, "Lens")["changed"] == 128
    assert not labels(mesh).any()


def test_a_region_that_nothing_can_touch(mesh: Path) -> None:
    done("plane", mesh, "Side", "--point", "0,0,20", "--normal", "0,0,1")
    found = done("mark", mesh, "Side", "--untouchable")
    assert [row["untouchable"] for row in found["regions"]] == [False, True]
    assert load_probe(mesh, units="m").untouchable == (2,)
    assert "untouchable" in invoke("list", mesh).stdout
    done("reorder", mesh, "Side", "Top")
    assert load_probe(mesh, units="m").untouchable == (1,)
    other = mesh.with_name("other.ply")
    save_probe(load_probe(mesh, units="m").with_region(np.zeros(768, dtype=int)), other)
    done("transfer", mesh, other)
    assert load_probe(other, units="m").untouchable == (1,)
    found = done("mark", mesh, "1", "--touchable")
    assert not any(row["untouchable"] for row in found["regions"])
    assert load_probe(mesh, units="m").untouchable == ()


def test_every_command_is_in_the_history(mesh: Path) -> None:
    done("box", mesh, "Top", "--low=-100,-100,20", "--high=100,100,100")
    history = json.loads(mesh.with_suffix(".json").read_text(encoding="utf-8"))["history"]
    assert [step["parameters"]["command"] for step in history] == ["add", "add", "box"]
    assert history[1]["parameters"] == {"command": "add", "name": "Side", "colour": "#123456"}
    assert history[2]["parameters"]["low"] == "-100,-100,20"
    assert history[2]["result"] == {"changed": 128, "areas_mm2": [1600.0, 0.0]}
    assert history[2]["input"] == history[2]["output"]  # the surface itself stays


def test_what_else_the_sidecar_holds_stays(mesh: Path) -> None:
    sidecar = mesh.with_suffix(".json")
    document = json.loads(sidecar.read_text(encoding="utf-8"))
    sidecar.write_text(json.dumps({"source": "part.stl", **document}), encoding="utf-8")
    done("rename", mesh, "Top", "Lens")
    kept = json.loads(sidecar.read_text(encoding="utf-8"))
    assert kept["source"] == "part.stl"
    assert kept["regions"][0] == {"name": "Lens", "colour": "#e69f00"}


def test_boxes_planes_and_floods(mesh: Path) -> None:
    found = done("box", mesh, "Top", "--low=-100,-100,20", "--high=100,100,100")
    assert found["changed"] == 128
    assert found["regions"][0]["area_mm2"] == pytest.approx(1600)
    unchanged(mesh, "they already belong to it", "flood", mesh, "Top", "--at", "0,0,30", "--crease", 45)
    assert done("flood", mesh, "Side", "--at", "30,0,0")["changed"] == 128
    # The axes of the box are turned by a quarter: its x is y of S.
    turned = done(
        "box", mesh, "Side", "--low", "0,-999,-999", "--high", "999,999,999", "--frame", "0,0,0,0,0,90"
    )
    assert (labels(mesh) == 2)[load_probe(mesh, units="m").normals[:, 1] > 0.9].all()
    assert turned["changed"] > 128
    protected = done("plane", mesh, "Top", "--point", "0,0,0", "--normal", "0,0,1", "--protect")
    assert protected["regions"][1]["facets"] == turned["regions"][1]["facets"]
    erased = done("plane", mesh, "Top", "--point", "0,0,0", "--normal", "0,0,1", "--erase")
    assert erased["regions"][0]["facets"] == 0
    assert erased["regions"][1]["facets"] == turned["regions"][1]["facets"]


def test_a_box_ends_where_it_was_put(mesh: Path) -> None:
    found = done("box", mesh, "Top", "--low=3,-9,10.5", "--high=20,8.25,22")["regions"][0]
    assert found["area_mm2"] == pytest.approx(17.25 * (17 + 9.5), rel=1e-4)
    left = done("box", mesh, "Top", "--low=4,-99,-99", "--high=5,99,99", "--erase")["regions"][0]
    assert left["area_mm2"] == pytest.approx(17.25 * (16 + 9.5), rel=1e-4)


def test_brush_grow_shrink_and_smooth(mesh: Path) -> None:
    stroke = ("--at=-10,0,20", "--at=10,0,20", "--radius", 6)
    painted = done("brush", mesh, "Top", *stroke)["regions"][0]["area_mm2"]
    assert painted == pytest.approx(20 * 12 + np.pi * 36, rel=0.01)
    for command, distance, radius in (("grow", 3, 9), ("shrink", 2, 7)):
        found = done(command, mesh, "Top", "--distance", distance)
        assert found["regions"][0]["area_mm2"] == pytest.approx(20 * 2 * radius + np.pi * radius**2, rel=0.01)
    assert done("smooth", mesh, "Top", "--rings", 1)["changed"] > 0
    wide = done("brush", mesh, "Top", *stroke[:2], "--radius", 9, "--straight")["regions"][0]["area_mm2"]
    unchanged(mesh, "none of them belongs to it", "brush", mesh, "Side", *stroke, "--erase")
    left = done("brush", mesh, "Top", *stroke, "--straight", "--erase")["regions"][0]["area_mm2"]
    assert wide - left == pytest.approx(painted, rel=0.01)


def test_a_selection_that_changes_nothing_says_why_and_writes_nothing(mesh: Path) -> None:
    above, below = ("--point", "0,0,99", "--normal", "0,0,1"), ("--point", "0,0,19", "--normal", "0,0,1")
    unchanged(mesh, "no facet lies there", "plane", mesh, "Top", *above)
    unchanged(mesh, "no facet lies there", "plane", mesh, "Top", *above, "--erase")
    for command in (("clear",), ("smooth",), ("grow", "--rings", 1), ("mirror", "--normal", "1,0,0")):
        unchanged(mesh, "the region has no facets", command[0], mesh, "Top", *command[1:])
    done("plane", mesh, "Top", *below)
    unchanged(mesh, "they already belong to it", "plane", mesh, "Top", *below)
    protected = "they already belong to it, or to others, where --protect leaves them"
    unchanged(mesh, protected, "plane", mesh, "Side", *below, "--protect")
    unchanged(mesh, "none of them belongs to it", "plane", mesh, "Side", *below, "--erase")
    unchanged(mesh, "the region already has that shape", "smooth", mesh, "Top", "--rings", 1)
    unchanged(mesh, "they already belong to it", "mirror", mesh, "Top", "--normal", "1,0,0")
    # What the list is to be, it is: that is no mistake. Nothing is written either.
    before = mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()
    done("rename", mesh, "Top", "Top")
    done("mark", mesh, "Top", "--touchable")
    assert (mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()) == before


def test_a_brush_far_from_the_surface_is_refused(mesh: Path) -> None:
    before = mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()
    for far, radius, at_most in (("0,0,22.6", 2.5, "2.5"), ("0,0,20.81", 0.1, "0.8"), ("0,0,500", 6, "6")):
        # One of several points is enough.
        result = invoke("brush", mesh, "Top", "--at", "0,0,20", "--at", far, "--radius", radius)
        assert result.exit_code == 2
        assert f"the point {far.replace(',', ', ')} mm is " in said(result)
        assert f"mm from the surface, more than {at_most} mm: give a point on the surface" in said(result)
    assert (mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()) == before
    assert done("brush", mesh, "Top", "--at", "0,0,22.4", "--radius", 2.5)["changed"] > 0
    assert done("brush", mesh, "Side", "--at", "0,10,20.79", "--radius", 0.1)["changed"] > 0


def state(mesh: Path) -> tuple[bytes, bytes]:
    return mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()


def test_undo_and_redo_give_the_bytes_back(mesh: Path, tmp_path: Path) -> None:
    side = ("--point", "15,0,0", "--normal", "1,0,0")
    other = tmp_path / "other.ply"
    save_probe(load_probe(mesh, units="m").with_region(np.arange(768) % 3), other)
    done("export", other, "--out", tmp_path / "r.json")
    commands = (
        ("plane", mesh, "Side", *side),
        ("mark", mesh, "Side", "--untouchable"),
        ("plane", mesh, "Top", "--point", "0,0,15", "--normal", "0,0,1"),
        ("mirror", mesh, "Side", "--normal", "1,0,0"),
        ("grow", mesh, "Top", "--rings", 1),
        ("reorder", mesh, "Side", "Top"),
        ("remove", mesh, "Side"),
        ("import", mesh, tmp_path / "r.json"),
        ("transfer", other, mesh),
        ("brush", mesh, "1", "--at", "19,0,20", "--radius", 6),
        ("box", mesh, "1", "--low=-9,-9,-99", "--high=7,7,99"),
        ("rename", mesh, "1", "Lens"),
        ("clear", mesh, "Lens"),
    )
    texts = [
        *(
            "half into Side",
            "mark Side untouchable",
            "half into Top",
            "mirror Side",
            "grow Top",
            "reorder regions",
        ),
        *(
            "remove Side",
            "import regions",
            "transfer from other.ply",
            "paint Region 1",
            "box into Region 1",
            "rename Region 1",
            "clear Lens",
        ),
    ]
    save_probe(load_probe(mesh, units="m").with_region(np.arange(768) // 300), other)
    states = [state(mesh)]
    for command in commands:
        done(*command)
        states.append(state(mesh))
    assert len(set(states)) == len(states)
    for _ in range(2):
        for before, text in zip(reversed(states[:-1]), reversed(texts), strict=True):
            assert done("undo", mesh)["undone"] == text
            assert state(mesh) == before
        for after, text in zip(states[1:], texts, strict=True):
            result = invoke("redo", mesh)
            assert result.exit_code == 0
            assert f"redone: {text}. " in said(result)
            assert state(mesh) == after


def test_undo_goes_back_to_the_first_command_and_a_new_one_ends_redo(mesh: Path) -> None:
    assert done("undo", mesh)["regions"][0]["name"] == "Top"
    assert done("undo", mesh)["regions"] == []
    for _ in range(2):
        result = invoke("undo", mesh)
        assert result.exit_code == 1
        assert "There is nothing to undo." in said(result)
    assert done("redo", mesh)["redone"] == "add Top"
    done("rename", mesh, "Top", "Top")  # changes nothing: what was undone can still be redone
    done("add", mesh, "Handle")
    result = invoke("redo", mesh)
    assert result.exit_code == 1
    assert "There is nothing to redo." in said(result)
    assert [row["name"] for row in done("list", mesh)["regions"]] == ["Top", "Handle"]


def test_steps_end_where_something_else_changes_the_probe(mesh: Path) -> None:
    sidecar = mesh.with_suffix(".json")
    document = json.loads(sidecar.read_text(encoding="utf-8"))
    sidecar.write_text(json.dumps({"source": "part.stl", **document}), encoding="utf-8")
    before = state(mesh)
    result = invoke("undo", mesh)
    assert result.exit_code == 1
    assert "There is nothing to undo: something else has changed the probe since then." in said(result)
    assert state(mesh) == before
    done("add", mesh, "Handle")
    assert done("undo", mesh)["undone"] == "add Handle"
    assert invoke("undo", mesh).exit_code == 1  # not beyond the change
    # A folder that is copied keeps its steps.
    moved = Path(shutil.copytree(mesh.parent, mesh.parent / "copy")) / mesh.name
    assert done("redo", moved)["redone"] == "add Handle"


def test_steps_are_few_enough_to_be_kept(mesh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exchange, "MOST_STEPS", 3)
    for colour in range(5):
        done("colour", mesh, "Top", f"#00000{colour}")
    assert [done("undo", mesh)["undone"] for _ in range(3)] == ["colour Top"] * 3
    assert invoke("undo", mesh).exit_code == 1
    assert done("list", mesh)["regions"][0]["colour"] == "#000001"
    monkeypatch.setattr(exchange, "SIZE_LIMIT", 6_000)  # of the steps some 1,500 each
    for colour in range(5, 9):
        done("colour", mesh, "Top", f"#00000{colour}")
    assert mesh.with_suffix(".undo").stat().st_size < 6_000
    assert done("undo", mesh)["regions"][0]["colour"] == "#000007"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda _: b"", "not a JSON file"),
        (lambda _: b"[]", "does not hold one object"),
        (lambda data: data.replace(b"region steps", b"region stairs"), "does not contain region steps"),
        (
            lambda data: data.replace(b'"version": 1, "files"', b'"version": 2, "files"'),
            "does not contain region steps",
        ),
        (lambda data: data.replace(b'"text"', b'"txt"', 1), "step 1 of 'done'"),
        (lambda data: data.replace(b'"step": "region"', b'"step": 3', 1), "step 1 of 'done' has no name"),
        (lambda data: data.replace(b'"undone": []', b'"undone": {}'), "does not contain region steps"),
    ],
)
def test_a_file_of_steps_that_is_none_is_refused(mesh: Path, change: Any, message: str) -> None:
    file = mesh.with_suffix(".undo")
    file.write_bytes(change(file.read_bytes()))
    before = state(mesh), file.read_bytes()
    for command in (("undo", mesh), ("redo", mesh), ("add", mesh, "New")):
        result = invoke(*command)
        assert result.exit_code == 2
        assert message in said(result)
        assert "Delete the file" in said(result)
        assert (state(mesh), file.read_bytes()) == before
    assert invoke("list", mesh).exit_code == 0


def test_steps_with_regions_that_cannot_be_are_refused(mesh: Path) -> None:
    done("plane", mesh, "Top", "--point", "0,0,15", "--normal", "0,0,1")
    done("clear", mesh, "Top")
    file = mesh.with_suffix(".undo")
    document = json.loads(file.read_text(encoding="utf-8"))
    document["done"][-1]["other"]["regions"][0]["facets"] = [[0, 769]]
    file.write_text(json.dumps(document), encoding="utf-8")
    before = state(mesh)
    result = invoke("undo", mesh)
    assert result.exit_code == 2
    assert "facets run from 0 to 767" in said(result)
    assert state(mesh) == before


def test_mirror(mesh: Path) -> None:
    done("box", mesh, "Top", "--low", "5,-10,19", "--high", "15,10,21")
    found = done("mirror", mesh, "Top", "--normal", "1,0,0")
    assert found["unmatched"] == 0
    assert found["regions"][0]["facets"] == 2 * found["changed"] > 0
    result = invoke("mirror", mesh, "Top", "--normal", "1,0,0", "--point", "19,0,0", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["unmatched"] > 0
    assert "no counterpart" in said(result)


def test_export_and_import(mesh: Path, tmp_path: Path) -> None:
    done("flood", mesh, "Side", "--at", "30,0,0")
    before = labels(mesh)
    for name in ("r.json", "r.csv"):
        assert done("export", mesh, "--out", tmp_path / name)["out"] == str(tmp_path / name)
    for name in ("r.json", "r.csv"):
        done("clear", mesh, "Side")
        assert done("import", mesh, tmp_path / name)["changed"] == 128
        assert labels(mesh).tolist() == before.tolist()
        assert [row["name"] for row in done("list", mesh)["regions"]] == ["Top", "Side"]
    refused = invoke("export", mesh, "--out", mesh.with_suffix(".json"))
    assert refused.exit_code == 2
    assert "choose another --out" in said(refused)


def test_transfer(mesh: Path, tmp_path: Path) -> None:
    done("flood", mesh, "Top", "--at", "0,0,30")
    coarse = trimesh.creation.box(extents=(0.04, 0.04, 0.04)).subdivide()
    new = tmp_path / "coarse.ply"
    save_probe(Probe.from_arrays(coarse.vertices, coarse.faces), new)
    assert invoke("export", mesh, "--out", tmp_path / "r.json").exit_code == 0
    refused = invoke("import", new, tmp_path / "r.json")
    assert refused.exit_code == 2
    assert "contactbench probe regions transfer" in said(refused)
    found = done("transfer", mesh, new)
    assert found["unmatched"] == 0
    assert found["regions"][0]["after_mm2"] == pytest.approx(1600)
    assert [row["name"] for row in done("list", new)["regions"]] == ["Top", "Side"]
    assert np.count_nonzero(labels(new) == 1) == 8


def test_a_region_that_vanishes_is_exit_code_1(mesh: Path, tmp_path: Path) -> None:
    done("brush", mesh, "Side", "--at", "1,0,20", "--radius", 0.1)
    coarse = trimesh.creation.box(extents=(0.04, 0.04, 0.03))
    save_probe(Probe.from_arrays(coarse.vertices, coarse.faces), tmp_path / "coarse.ply")
    result = invoke("transfer", mesh, tmp_path / "coarse.ply", "--json")
    assert result.exit_code == 1
    assert "vanished" in said(result)
    assert any(part["vanished"] for part in json.loads(result.stdout)["regions"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("remove", "{}", "Nose"), "there is no region 'Nose': choose one of: Top, Side"),
        (("remove", "{}", "3"), "there is no region '3'"),
        (("remove", "{}", "0"), "there is no region '0'"),
        (("add", "{}", "Top"), "two regions are called 'Top'"),
        (("add", "{}", "New", "--colour", "red"), "#rrggbb"),
        (("mark", "{}", "Top"), "Missing option '--untouchable"),
        (("reorder", "{}", "Top"), "is not an order of 2 regions"),
        (("box", "{}", "Top", "--low", "0,0,0", "--high", "0,1,1"), "below the high one"),
        (("box", "{}", "Top", "--low", "0,0", "--high", "0,1,1"), "--low needs 3"),
        (("plane", "{}", "Top", "--point", "0,0,0", "--normal", "0,0,0"), "no direction"),
        (("flood", "{}", "Top", "--at", "0,0,0", "--crease", "200"), "not an angle"),
        (("brush", "{}", "Top", "--at", "0,0,0", "--radius", "0"), "radius"),
        (("grow", "{}", "Top"), "give the distance"),
        (("grow", "{}", "Top", "--rings", "-1"), "not a valid distance"),
        (("smooth", "{}", "Top", "--rings", "0"), "give the distance"),
        (("import", "{}", "nothing.json"), "cannot be read"),
        (("export", "{}", "--out", "r.txt"), ".json or .csv"),
        (("transfer", "{}", "{}"), "is also an input"),
        (("list", "probe.stl"), "save it as .ply"),
        (("list", "nowhere.ply"), "no such file"),
    ],
)
def test_wrong_arguments_change_nothing(mesh: Path, arguments: tuple[str, ...], message: str) -> None:
    before = mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()
    result = invoke(*(text.format(mesh) for text in arguments), "--json")
    assert result.exit_code == 2
    # Typer frames and wraps what it says itself.
    assert message in " ".join(said(result).replace("│", " ").split())
    assert (mesh.read_bytes(), mesh.with_suffix(".json").read_bytes()) == before
