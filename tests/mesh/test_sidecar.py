"""A probe on disk: the surface, and beside it names and history."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from contact_cases import bundled

from contactbench.pipeline.mesh import MeshError, load_probe, save_probe
from contactbench.pipeline.mesh.regions import Region, RegionError, RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file, save_probe_file


@pytest.fixture
def content():
    probe = bundled("linear", 500)
    labels = np.zeros(len(probe.faces), dtype=np.int32)
    labels[:40], labels[40:60] = 1, 2
    regions = RegionSet.from_labels(labels, (Region("lens", "#112233"), Region("edge", "#445566")))
    invented = np.arange(len(labels)) % 7 == 0
    start = ProbeFile(probe.with_invented(invented).with_region(labels), regions)
    return start.after("paint", start.probe, {"by": "hand"}, {"changed": 60}, frame="S")


def test_everything_comes_back(content, tmp_path):
    save_probe_file(content, tmp_path / "probe.ply")
    back = load_probe_file(tmp_path / "probe.ply")
    assert np.array_equal(back.probe.vertices, content.probe.vertices)
    assert np.array_equal(back.probe.faces, content.probe.faces)
    assert np.array_equal(back.probe.region, content.regions.labels)
    assert np.array_equal(back.probe.invented, content.probe.invented)
    assert [region.name for region in back.regions.regions] == ["lens", "edge"]
    assert (back.frame, back.history, back.notes) == ("S", content.history, ())


def test_what_nothing_can_touch_comes_back_in_both_files(content, tmp_path):
    lens, edge = content.regions.regions
    painted = replace(content.regions, regions=(lens, replace(edge, untouchable=True)))
    marked = replace(content, regions=painted)
    assert marked.probe.untouchable == (2,)
    assert marked.after("simplify", bundled("linear", 100), {}, {}).probe.untouchable == (2,)
    file = tmp_path / "probe.ply"
    save_probe_file(marked, file)
    back = load_probe_file(file)
    assert [region.untouchable for region in back.regions.regions] == [False, True]
    assert back.probe.untouchable == load_probe(file, "m").untouchable == (2,)
    file.with_suffix(".json").unlink()
    alone = load_probe_file(file)
    assert [region.untouchable for region in alone.regions.regions] == [False, True]
    assert alone.probe.untouchable == (2,)


def test_files_from_before_there_were_marks_are_touchable(content, tmp_path):
    save_probe_file(content, tmp_path / "probe.ply")
    assert b"untouchable" not in (tmp_path / "probe.ply").read_bytes()
    assert b"untouchable" not in (tmp_path / "probe.json").read_bytes()
    assert load_probe_file(tmp_path / "probe.ply").probe.untouchable == ()


def test_the_same_content_gives_the_same_bytes(content, tmp_path):
    for name in ("a", "b"):
        save_probe_file(content, tmp_path / f"{name}.ply")
    save_probe_file(load_probe_file(tmp_path / "a.ply"), tmp_path / "c.ply")
    for suffix in (".ply", ".json"):
        assert len({(tmp_path / f"{name}{suffix}").read_bytes() for name in "abc"}) == 1


def test_a_step_knows_what_went_in_and_what_came_out(content):
    smaller = bundled("linear", 100)
    after = content.after("simplify", smaller, {"facets": 100}, {"facets": len(smaller.faces)})
    before, step = after.history
    assert step["step"] == "simplify"
    assert step["input"]["sha256"] == before["output"]["sha256"] != step["output"]["sha256"]
    assert step["output"]["facets"] == len(smaller.faces)
    assert step["tool"].startswith("contactbench ")
    assert after.frame == "S"
    assert [region.name for region in after.regions.regions] == ["lens", "edge"]


def test_a_file_changed_by_another_program_is_noticed(content, tmp_path):
    file = tmp_path / "probe.ply"
    save_probe_file(content, file)
    save_probe(content.probe.with_region(np.zeros(len(content.probe.faces), dtype=int)), file)
    back = load_probe_file(file)
    assert len(back.notes) == 1
    assert "was changed after contactbench wrote it" in back.notes[0]


def test_colours_are_for_viewers(content, tmp_path):
    import trimesh

    save_probe_file(content, tmp_path / "probe.ply")
    seen = trimesh.load_mesh(tmp_path / "probe.ply", process=False)
    raw = seen.metadata["_ply_raw"]["face"]["data"]
    colours = np.column_stack([np.ravel(raw[name]) for name in ("red", "green", "blue")])
    plain = (content.probe.region == 0) & ~content.probe.invented
    assert (colours[plain] == 200).all()
    assert (colours[(content.probe.region == 0) & content.probe.invented] == (70, 70, 70)).all()
    assert (colours[(content.probe.region == 1) & ~content.probe.invented] == (0x11, 0x22, 0x33)).all()
    assert len(np.unique(colours, axis=0)) == 6


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("[]", "does not hold one object"),
        ("{", "not a JSON file"),
        ('{"schema": "other"}', "does not belong to a probe"),
        ('{"version": 2}', "use a newer contactbench"),
        ('{"version": "1"}', "does not belong to a probe"),
        ('{"regions": {}}', "not a list of names"),
        ('{"regions": [{"name": "a"}]}', "colour"),
        ('{"regions": [1]}', "region 1 of the file is not an object"),
        ('{"history": {}}', "not a list of at most"),
        ('{"history": [{"step": 1}]}', "step 1 of 'history'"),
        ('{"mesh": {"frame": "Q"}}', "frame is P or S"),
        ('{"mesh": 1}', "frame is P or S"),
    ],
)
def test_a_broken_history_is_refused_by_name(content, tmp_path, text, match):
    save_probe_file(content, tmp_path / "probe.ply")
    (tmp_path / "probe.json").write_text(text, encoding="utf-8")
    with pytest.raises(RegionError, match=match) as caught:
        load_probe_file(tmp_path / "probe.ply")
    assert str(tmp_path / "probe.json") in str(caught.value)


def test_what_else_the_json_holds_stays(content, tmp_path):
    (tmp_path / "probe.json").write_text('{"serial": 7}', encoding="utf-8")
    save_probe_file(content, tmp_path / "probe.ply")
    document = json.loads((tmp_path / "probe.json").read_text(encoding="utf-8"))
    assert document["serial"] == 7
    assert document["mesh"]["frame"] == "S"


def test_only_ply_in_a_folder_that_exists(content, tmp_path):
    with pytest.raises(MeshError, match=r"end the name in \.ply"):
        save_probe_file(content, tmp_path / "probe.stl")
    with pytest.raises(MeshError, match="cannot be written"):
        save_probe_file(content, tmp_path / "no" / "probe.ply")
    with pytest.raises(RegionError, match="stored in a probe's PLY"):
        load_probe_file(tmp_path / "probe.stl")


def test_invented_facets_are_read_by_load_probe_too(content, tmp_path):
    save_probe(content.probe, tmp_path / "probe.ply")
    assert np.array_equal(load_probe(tmp_path / "probe.ply", "m").invented, content.probe.invented)
