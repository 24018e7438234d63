"""The ``probe`` commands, as a technician types them."""

import json
from functools import partial

import numpy as np
import pytest
import terminal
import trimesh
from contact_cases import bundled
from mesh.shell.housings import housing, write_stl
from terminal import said

from contactbench.pipeline.mesh import Probe, load_probe, save_probe
from contactbench.pipeline.mesh.shell import Shell
from contactbench.pipeline.preparation.ladder.compare import ExpectedTouches, draw_parts

invoke = partial(terminal.invoke, "probe")


@pytest.fixture
def hollow(tmp_path):
    return write_stl(tmp_path / "housing.stl", housing())


@pytest.fixture
def ready(tmp_path):
    save_probe(bundled("t-shape", 2000, regions=True), tmp_path / "ready.ply")
    return tmp_path / "ready.ply"


def test_inspect_tells_what_is_wrong(hollow, ready):
    result = invoke("inspect", hollow, "--json")
    assert result.exit_code == 1
    assert not json.loads(result.stdout)["sound"]
    assert "fault:" in said(result)
    result = invoke("inspect", ready)
    assert result.exit_code == 0
    assert "No problems found" in said(result)


@pytest.mark.parametrize("command", ["inspect", "shell", "prepare"])
def test_a_doubtful_unit_is_told_once_and_nothing_is_praised(tmp_path, command):
    box = trimesh.creation.box(extents=(1.0, 0.8, 3.15))
    (tmp_path / "box.stl").write_bytes(box.export(file_type="stl"))
    out = () if command == "inspect" else ("--out", tmp_path / "out.ply")
    words = said(invoke(command, tmp_path / "box.stl", *out))
    assert words.count("80.01 mm if they are inches, 31.5 mm if they are centimetres") == 1
    assert "No problems found" not in words


@pytest.mark.parametrize("command", ["shell", "prepare"])
def test_nothing_is_made_of_numbers_whose_unit_nobody_can_tell(tmp_path, command):
    # 150 mm in inches, with a length in the header that is not their unit.
    box = trimesh.creation.box(extents=(5.906, 2.0, 1.0)).export(file_type="stl")
    (tmp_path / "box.stl").write_bytes(b"Exported, deviation 0.1 mm".ljust(80) + box[80:])
    result = invoke(command, tmp_path / "box.stl", "--out", tmp_path / "out.ply")
    assert result.exit_code == 2
    assert "59.06 mm if they are centimetres, 150 mm if they are inches" in said(result)
    assert "give --units cm, in or mm" in said(result)
    assert [file.name for file in tmp_path.iterdir()] == ["box.stl"]
    assert "unit cannot be determined" not in said(
        invoke(command, tmp_path / "box.stl", "--units", "in", "--out", tmp_path / "out.ply")
    )


def test_a_shell_that_is_not_sound_ends_with_1(hollow, tmp_path, monkeypatch):
    monkeypatch.setattr(Shell, "faults", ("It crosses itself.",))
    result = invoke("shell", hollow, "--alpha", "2", "--gap", "4", "--out", tmp_path / "shell.ply")
    assert result.exit_code == 1
    assert said(result).count("It crosses itself.") == 1


def test_shell_closes_and_says_how(hollow, tmp_path):
    pytest.importorskip("pymeshlab", reason="the outer shell is wrapped by pymeshlab (extra 'meshlab')")
    out = tmp_path / "shell.ply"
    result = invoke("shell", hollow, "--close", "hull", "--alpha", "2", "--gap", "4", "--out", out, "--json")
    assert result.exit_code == 0, result.stderr
    assert [opening["closing"] for opening in json.loads(result.stdout)["openings"]] == ["hull"]
    assert "closed by the hull of its rim" in said(result)
    probe = load_probe(out, "m")
    assert probe.health.sentences == ()
    assert probe.invented.any()
    assert json.loads((tmp_path / "shell.json").read_text(encoding="utf-8"))["history"][1]["step"] == "shell"


def test_prepare_goes_from_the_file_to_the_probe(hollow, tmp_path):
    pytest.importorskip("pymeshlab", reason="the outer shell is wrapped by pymeshlab (extra 'meshlab')")
    out = tmp_path / "probe.ply"
    arguments = ("--alpha", "2", "--gap", "4", "--place", "0,0,40,0,0,90", "--facets", "300")
    result = invoke("prepare", hollow, "--close", "auto", *arguments, "--out", out, "--json")
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    assert facts["ready"]
    assert [step["step"] for step in facts["history"]] == ["import", "shell", "align", "simplify"]
    probe = load_probe(out, "m")
    assert len(probe.faces) == 300
    assert probe.bounds[0, 2] == pytest.approx(0.04, abs=1e-3)
    assert np.ptp(probe.bounds, axis=0)[1] == pytest.approx(0.06, abs=1e-3)  # turned by 90 degrees


def test_simplify_by_contact_error_when_nothing_is_asked_for(ready, tmp_path):
    result = invoke("simplify", ready, "--out", tmp_path / "less.ply", "--json")
    assert result.exit_code == 0, result.stderr
    assert (
        2000 <= json.loads(result.stdout)["facets"] <= 2020
    )  # fewer gain nothing; a step that would spoil the surface is not taken
    step = json.loads((tmp_path / "less.json").read_text(encoding="utf-8"))["history"][-1]
    assert step["parameters"]["max_contact_error_mm"] == pytest.approx(0.1)
    assert load_probe(tmp_path / "less.ply", "m").region.max() == 1


def test_ladder_recommends(ready, tmp_path):
    result = invoke(
        "ladder", ready, "--facets", "200,800", "--touches", "400", "--out", tmp_path / "ladder", "--json"
    )
    assert result.exit_code in (0, 1)
    facts = json.loads(result.stdout)
    assert (facts["recommendation"]["facets"] is None) == (result.exit_code == 1)
    assert {file.name for file in (tmp_path / "ladder").iterdir()} == {
        "ladder.json", "ladder.csv", "ladder.svg", "ladder.png",
    }  # fmt: skip


# ---- align -----------------------------------------------------------------------------------------


def test_align_by_numbers_and_by_what_was_saved(ready, tmp_path):
    saved = tmp_path / "mount.json"
    first = invoke(
        "align", ready, "--place", "1,2,3,0,90,0", "--save", saved, "--out", tmp_path / "a.ply", "--json"
    )
    assert first.exit_code == 0, first.stderr
    assert json.loads(first.stdout)["method"] == "typed"
    assert invoke("align", ready, "--alignment", saved, "--out", tmp_path / "b.ply").exit_code == 0
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()
    moved, before = load_probe(tmp_path / "a.ply", "m"), load_probe(ready, "m")
    x, y, z = before.vertices.T
    assert moved.vertices == pytest.approx(np.column_stack((z, y, -x)) + [0.001, 0.002, 0.003])
    assert np.array_equal(moved.region, before.region)


def test_align_by_points(ready, tmp_path):
    points = tmp_path / "points.csv"
    points.write_text(
        "px,py,pz,sx,sy,sz\n0,0,0,0,0,10\n50,0,0,0,50,10\n0,30,0,-30,0,10\n0,0,20,0,0,30\n", encoding="utf-8"
    )
    result = invoke("align", ready, "--points", points, "--out", tmp_path / "a.ply", "--json")
    assert result.exit_code == 0, result.stderr
    T_SP = np.array(json.loads(result.stdout)["T_SP_m"])
    expected = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0.01], [0, 0, 0, 1]]
    assert pytest.approx(np.array(expected), abs=1e-9) == T_SP


def test_align_by_a_frame_of_three_points(ready, tmp_path):
    result = invoke(
        "align", ready, "--frame", "10,0,0,10,50,0,-40,0,0", "--out", tmp_path / "a.ply", "--json"
    )
    assert result.exit_code == 0, result.stderr
    expected = [[-1, 0, 0, 0.01], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1]]
    assert pytest.approx(np.array(expected), abs=1e-9) == np.array(json.loads(result.stdout)["T_SP_m"])


def test_align_by_axes_and_by_the_flange_face(ready, tmp_path):
    assert invoke("align", ready, "--axes", "--tip", "0,0,150", "--out", tmp_path / "a.ply").exit_code == 0
    probe = load_probe(ready, "m")
    facet = int(np.argmin(probe.vertices[probe.faces].mean(axis=1)[:, 2]))
    result = invoke("align", ready, "--flange-face", facet, "--offset", "5", "--out", tmp_path / "f.ply")
    assert result.exit_code == 0, result.stderr
    assert load_probe(tmp_path / "f.ply", "m").bounds[0, 2] == pytest.approx(0.005, abs=1e-4)


def touches_file(file, probe, T_SP, count=15):
    """Touches of points of the mesh, felt by a sensor in which it lies at T_SP."""
    moved = probe.vertices @ T_SP[:3, :3].T + T_SP[:3, 3]
    (drawn,) = draw_parts(Probe.from_arrays(moved, probe.faces), ExpectedTouches(count=100, seed=3))
    points = (drawn.truth.points[:count] - T_SP[:3, 3]) @ T_SP[:3, :3] * 1000
    rows = np.column_stack((points, drawn.noisy[:count]))
    lines = [",".join(f"{value!r}" for value in row) for row in rows.tolist()]
    file.write_text("px,py,pz,fx,fy,fz,mx,my,mz\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return file


def test_align_by_touches_when_they_bear_it_out(ready, tmp_path):
    probe = load_probe(ready, "m")
    T_SP = np.eye(4)
    T_SP[:3, 3] = [0.002, -0.001, 0.001]
    file = touches_file(tmp_path / "touches.csv", probe, T_SP)
    result = invoke(
        "align", ready, "--touches", file, "--place", "0,0,0,0,0,0", "--out", tmp_path / "a.ply", "--json"
    )
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    assert facts["advice"] == "adopt"
    assert np.array(facts["T_SP_m"])[:3, 3] == pytest.approx(T_SP[:3, 3], abs=1.5e-3)
    assert max(facts["sigmas_mm"]) < 1


def test_touches_that_bear_out_the_present_mount_change_nothing(ready, tmp_path):
    file = touches_file(tmp_path / "touches.csv", load_probe(ready, "m"), np.eye(4))
    result = invoke("align", ready, "--touches", file, "--place", "0,0,0,0,0,0", "--out", tmp_path / "a.ply")
    assert result.exit_code == 1
    assert "Nothing was written: the present mount is kept" in said(result)
    assert not (tmp_path / "a.ply").exists()


# ---- wrong input -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        (("shell", "FILE", "--out", "OUT.stl"), "end the name in .ply"),
        (("shell", "FILE", "--out", "no/such/OUT.ply"), "there is no folder"),
        (("shell", "FILE", "--alpha", "0.001", "--out", "OUT.ply"), "alpha must be at least"),
        (("simplify", "FILE", "--facets", "2", "--out", "OUT.ply"), "no closed surface has fewer than 4"),
        (("simplify", "FILE", "--max-deviation", "0", "--out", "OUT.ply"), "largest deviation is 0"),
        (("simplify", "FILE", "--region-ratio", "0.5", "--facets", "50", "--out", "OUT.ply"), "region ratio"),
        (("prepare", "missing.stl", "--out", "OUT.ply"), "no such file"),
        (("inspect", "missing.stl"), "no such file"),
        (("align", "FILE", "--alignment", "missing.json", "--out", "OUT.ply"), "no such file"),
    ],
)
def test_wrong_input_ends_with_2_and_leaves_nothing(hollow, tmp_path, monkeypatch, arguments, match):
    monkeypatch.chdir(tmp_path)
    result = invoke(*(hollow.name if part == "FILE" else part for part in arguments))
    assert result.exit_code == 2
    assert match in said(result)
    assert [file.name for file in tmp_path.iterdir()] == [hollow.name]


@pytest.mark.parametrize(
    "arguments",
    [
        ("simplify", "FILE", "--facets", "50", "--max-deviation", "1", "--out", "OUT.ply"),
        ("align", "FILE", "--out", "OUT.ply"),
        ("align", "FILE", "--axes", "--place", "0,0,0,0,0,0", "--out", "OUT.ply"),
        ("align", "FILE", "--place", "0,0,0", "--out", "OUT.ply"),
        ("align", "FILE", "--units", "feet", "--axes", "--out", "OUT.ply"),
        ("prepare", "FILE", "--place", "0,0,0,0,0,0", "--alignment", "a.json", "--out", "OUT.ply"),
        ("prepare", "FILE", "--facets", "9", "--max-contact-error", "1", "--out", "OUT.ply"),
        ("ladder", "FILE", "--facets", "many"),
        ("ladder", "FILE", "--forces", "8"),
        ("shell", "FILE", "--close", "glue", "--out", "OUT.ply"),
    ],
)
def test_wrong_usage_ends_with_2(hollow, tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    result = invoke(*(hollow.name if part == "FILE" else part for part in arguments))
    assert result.exit_code == 2, result.stderr
    assert [file.name for file in tmp_path.iterdir()] == [hollow.name]


def test_it_does_not_write_over_its_input(ready):
    before = ready.read_bytes()
    assert invoke("simplify", ready, "--facets", "100", "--out", ready).exit_code == 2
    assert ready.read_bytes() == before


def test_nothing_is_moved_twice(ready, tmp_path):
    once = tmp_path / "once.ply"
    assert invoke("align", ready, "--place", "0,0,45,0,0,0", "--out", once).exit_code == 0
    result = invoke("align", once, "--place", "0,0,45,0,0,0", "--out", tmp_path / "twice.ply")
    assert result.exit_code == 2
    assert "already in the sensor frame" in said(result)
    result = invoke(
        "prepare", once, "--place", "0,0,45,0,0,0", "--facets", "500", "--out", tmp_path / "b.ply"
    )
    assert result.exit_code == 2
    result = invoke("align", once, "--again", "--place", "0,0,1,0,0,0", "--out", tmp_path / "twice.ply")
    assert result.exit_code == 0
    moved = load_probe(tmp_path / "twice.ply", "m").bounds[:, 2] - load_probe(ready, "m").bounds[:, 2]
    assert moved == pytest.approx([0.046, 0.046])


@pytest.mark.parametrize("save", ["ready.ply", "a.ply", "a.json"])
def test_save_writes_over_nothing(ready, tmp_path, save):
    before = ready.read_bytes()
    result = invoke(
        "align", ready, "--place", "0,0,0,0,0,0", "--save", tmp_path / save, "--out", tmp_path / "a.ply"
    )
    assert result.exit_code == 2
    assert ready.read_bytes() == before
    assert not (tmp_path / "a.ply").exists()


@pytest.mark.parametrize("option", ["--offset", "--clock", "--placement", "--noise-force"])
def test_options_of_another_way_are_refused(ready, tmp_path, option):
    result = invoke("align", ready, "--place", "0,0,0,0,0,0", option, "1", "--out", tmp_path / "a.ply")
    assert result.exit_code == 2
    assert option in said(result)


@pytest.mark.parametrize(
    "arguments",
    [
        ("--facets", "0"),
        ("--max-deviation", "nan"),
        ("--max-contact-error", "-1"),
        ("--forces", "10,8"),
        ("--region-ratio", "0"),
    ],
)
def test_prepare_refuses_nonsense_before_the_work(hollow, tmp_path, monkeypatch, arguments):
    def never(*_, **__):
        raise AssertionError("the work was begun")

    monkeypatch.setattr("contactbench.pipeline.preparation.prepare.import_mesh", never)
    result = invoke("prepare", hollow, *arguments, "--out", tmp_path / "probe.ply")
    assert result.exit_code == 2, result.stderr


def test_json_sent_to_where_the_history_goes(ready, tmp_path):
    (tmp_path / "probe.json").write_text("", encoding="utf-8")  # what a shell makes of > probe.json
    result = invoke("simplify", ready, "--facets", "100", "--out", tmp_path / "probe.ply", "--json")
    assert result.exit_code == 2
    assert "send it elsewhere" in said(result)


def test_a_json_file_of_somebody_else_is_not_written_over(ready, tmp_path):
    (tmp_path / "probe.json").write_text("[1, 2]", encoding="utf-8")
    result = invoke("simplify", ready, "--facets", "100", "--out", tmp_path / "probe.ply")
    assert result.exit_code == 2
    assert (tmp_path / "probe.json").read_text(encoding="utf-8") == "[1, 2]"
    assert not (tmp_path / "probe.ply").exists()
