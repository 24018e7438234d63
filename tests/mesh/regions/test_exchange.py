"""Regions in files: what comes back, and what is refused."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.exchange import (
    decode_csv,
    decode_json,
    encode_csv,
    encode_json,
    load_regions,
    mesh_hash,
    save_regions,
)
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
from contactbench.pipeline.mesh.regions.model import RegionModel
from contactbench.pipeline.mesh.regions.region import Region, RegionError, RegionSet
from contactbench.pipeline.mesh.regions.selections import Brush

NAMES = st.text(
    st.characters(categories=("L", "N", "P", "S"), include_characters=" "), min_size=1, max_size=20
).filter(lambda text: len(text.strip()) > 0)


def same(one: RegionSet, other: RegionSet) -> bool:
    return one.regions == other.regions and one.labels.tobytes() == other.labels.tobytes()


def some(probe: Probe, rng: np.random.Generator) -> RegionSet:
    names = (Region("Linse ‹1›", "#e69f00"), Region('"quoted", name', "#000000"), Region("empty", "#56b4e9"))
    return RegionSet(names, rng.integers(0, 3, len(probe.faces)).astype(np.int32))


@settings(max_examples=40, deadline=None)
@given(st.data())
def test_json_gives_back_what_went_in(cube: FacetGraph, data: Any) -> None:
    names = data.draw(st.lists(NAMES, max_size=5, unique_by=lambda text: Region(text, "#000000").name))
    colours = st.from_regex(r"#[0-9a-f]{6}", fullmatch=True)
    listed = tuple(Region(name, data.draw(colours), data.draw(st.booleans())) for name in names)
    seed = data.draw(st.integers(0, 2**32 - 1))
    labels = np.random.default_rng(seed).integers(0, len(names) + 1, cube.facet_count).astype(np.int32)
    regions = RegionSet(listed, labels)
    assert same(decode_json(encode_json(regions, cube.probe), cube.probe), regions)


def test_a_mark_is_written_only_where_there_is_one(cube: FacetGraph) -> None:
    regions = RegionSet(
        (Region("Lens", "#e69f00"), Region("Clamp", "#000000", True)), RegionSet.empty(768).labels
    )
    document = json.loads(encode_json(regions, cube.probe))
    lens, clamp = document["regions"]
    assert "untouchable" not in lens  # as files were before there were marks
    assert clamp["untouchable"] is True
    clamp["untouchable"] = "yes"
    with pytest.raises(RegionError, match="'untouchable' is str in the JSON file, where bool belongs"):
        decode_json(json.dumps(document).encode(), cube.probe)


def test_csv_gives_back_the_labels(cube: FacetGraph, tmp_path: Path, rng: np.random.Generator) -> None:
    regions = some(cube.probe, rng)
    file = tmp_path / "r.csv"
    file.write_bytes(encode_csv(regions))
    assert decode_csv(file, cube.facet_count).tobytes() == regions.labels.tobytes()
    file.write_text("region,face\n2,5\n", encoding="utf-8")
    assert np.flatnonzero(decode_csv(file, cube.facet_count)).tolist() == [5]


def test_files(cube: FacetGraph, tmp_path: Path, rng: np.random.Generator) -> None:
    regions = some(cube.probe, rng)
    for name in ("r.json", "R.CSV"):
        save_regions(regions, cube.probe, tmp_path / name)
        assert load_regions(tmp_path / name, cube.probe).labels.tobytes() == regions.labels.tobytes()
    assert same(load_regions(tmp_path / "r.json", cube.probe), regions)
    with pytest.raises(RegionError, match=r"\.json or \.csv"):
        save_regions(regions, cube.probe, tmp_path / "r.yaml")
    with pytest.raises(RegionError, match=r"\.json or \.csv"):
        load_regions(tmp_path / "r.yaml", cube.probe)
    with pytest.raises(RegionError, match="cannot be written"):
        save_regions(regions, cube.probe, tmp_path / "no" / "r.json")
    with pytest.raises(RegionError, match="cannot be read"):
        load_regions(tmp_path / "no.json", cube.probe)


def test_another_mesh_is_refused_with_the_way_out(cube: FacetGraph, ball: FacetGraph) -> None:
    data = encode_json(RegionSet.empty(cube.facet_count), cube.probe)
    with pytest.raises(RegionError, match=r"768 facets, this one has 5120.*[Tt]ransfer"):
        decode_json(data, ball.probe)
    moved = Probe.from_arrays(cube.probe.vertices + [0, 0, 1e-15], cube.probe.faces)
    with pytest.raises(RegionError, match=r"another mesh.*[Tt]ransfer"):
        decode_json(data, moved)
    assert mesh_hash(cube.probe) != mesh_hash(moved)
    assert mesh_hash(cube.probe) == mesh_hash(cube.probe.with_region(np.ones(cube.facet_count, dtype=int)))


def document(probe: Probe) -> dict[str, Any]:
    regions = RegionSet.from_labels(np.minimum(np.arange(len(probe.faces)), 2))
    parsed: dict[str, Any] = json.loads(encode_json(regions, probe))
    return parsed


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(format="other"), "contains no regions"),
        (lambda d: d.pop("format"), "'format' is missing"),
        (lambda d: d.update(version=2), "format 2"),
        (lambda d: d.update(version=True), "'version' is bool"),
        (lambda d: d["mesh"].update(facets="many"), "'facets' is str"),
        (lambda d: d["mesh"].update(sha256=5), "'sha256' is int"),
        (lambda d: d.update(mesh=[]), "'mesh' is list"),
        (lambda d: d.update(regions={}), "'regions' is dict"),
        (lambda d: d.update(regions=[5]), "region 1 of the file is not an object"),
        (lambda d: d.update(regions=d["regions"][:1] * 300), "300 regions"),
        (lambda d: d["regions"][0].update(name="\u0007"), "cannot be displayed"),
        (lambda d: d["regions"][0].update(name="n" * 65), "64"),
        (lambda d: d["regions"][0].update(name=d["regions"][1]["name"]), "two regions"),
        (lambda d: d["regions"][0].update(colour="blue"), "#rrggbb"),
        (lambda d: d["regions"][0].pop("colour"), "'colour' is missing"),
        (lambda d: d["regions"][0].update(facets=[[1, 2, 3]]), "not a run"),
        (lambda d: d["regions"][0].update(facets=[[0.0, 1]]), "not a run"),
        (lambda d: d["regions"][0].update(facets=[[True, 1]]), "not a run"),
        (lambda d: d["regions"][0].update(facets=[7]), "not a run"),
        (lambda d: d["regions"][0].update(facets=[[-1, 2]]), "facets run from 0 to 767"),
        (lambda d: d["regions"][0].update(facets=[[767, 2]]), "facets run from 0 to 767"),
        (lambda d: d["regions"][0].update(facets=[[0, 0]]), "facets run from 0 to 767"),
        (lambda d: d["regions"][0].update(facets=[[10**300, 1]]), "facets run from 0 to 767"),
        (lambda d: d["regions"][0].update(facets=[[0, 10**300]]), "facets run from 0 to 767"),
        (lambda d: d["regions"][0].update(facets=[[0, 2], [1, 1]]), "facet 1 is listed twice"),
        (lambda d: d["regions"][1].update(facets=[[1, 1]]), "facet 1 is listed twice"),
    ],
)
def test_hostile_json(cube: FacetGraph, change: Any, message: str) -> None:
    parsed = document(cube.probe)
    decode_json(json.dumps(parsed).encode(), cube.probe)
    change(parsed)
    with pytest.raises(RegionError, match=message):
        decode_json(json.dumps(parsed).encode(), cube.probe)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe",
        b"[]",
        b"null",
        b'{"a": 1',
        b'{"a": 1, "a": 2}',
        b'{"version": NaN}',
        b"[" * 100_000,
        b'{"a": ' * 100_000,
        b'{"version": 1' + b"0" * 10_000 + b"}",
        b"solid ascii",
    ],
)
def test_garbage_json(cube: FacetGraph, data: bytes) -> None:
    with pytest.raises(RegionError):
        decode_json(data, cube.probe)


@settings(max_examples=50, deadline=None)
@given(st.binary(max_size=60), st.integers(0, 400), st.integers(0, 40))
def test_damaged_json_is_refused_or_means_something(cube: FacetGraph, junk: bytes, at: int, cut: int) -> None:
    data = json.dumps(document(cube.probe)).encode()
    damaged = data[:at] + junk + data[at + cut :]
    try:
        found = decode_json(damaged, cube.probe)
    except RegionError:
        return
    assert len(found.labels) == cube.facet_count


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("face\n1\n", "column region missing"),
        ("face,region\n1,0.5\n", "line 2: region is 0.5"),
        ("face,region\n768,1\n", "line 2: face is 768"),
        ("face,region\n-1,1\n", "line 2: face is -1"),
        ("face,region\n1,256\n", "line 2: region is 256"),
        ("face,region\n1,1\n2,1\n1,2\n", "line 4: facet 1 occurs twice"),
        ("face,region\n1,x\n", "not a number"),
        ("face,region\n1,nan\n", "nan"),
        ("face,region\n1e400,1\n", "inf"),
        ("face,region\n" + "1,1\n" * 769, "more than 768 rows"),
    ],
)
def test_hostile_csv(cube: FacetGraph, tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "r.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(RegionError, match=message):
        load_regions(file, cube.probe)


def test_cut_facets_come_back_and_damaged_ones_are_refused(cube: FacetGraph) -> None:
    model = RegionModel(RegionSet((Region("Lens", "#e69f00"),), np.zeros(cube.facet_count, dtype=np.int32)))
    cuts = []
    model.subscribe(lambda change: cuts.append(change.cut))
    with model.stroke(cube, Brush(0.0025), 1) as stroke:
        stroke.extend(*(each[0] for each in cube.pick([[0.003, 0.001, 0.02]])))
    regions = replace(model.snapshot(), cut=cuts[-1])
    found = decode_json(encode_json(regions, cube.probe), cube.probe).mesh(cube.probe)
    assert found.areas[found.region == 1].sum() == pytest.approx(np.pi * 0.0025**2, rel=0.015)
    assert found.faces.tolist() == regions.mesh(cube.probe).faces.tolist()
    for name, wrong in (
        *(("vertices", -1), ("facets", 10**9), ("faces", [[0, 1, 2**40]]), ("points", [[0, 0, np.inf]])),
        *(("slots", [10**6]), ("slots", "x"), ("invented", []), ("faces", [[0, 0, 0]]), ("facets", None)),
    ):
        document = json.loads(encode_json(regions, cube.probe))
        document["cut"][name] = wrong
        with pytest.raises(RegionError):
            decode_json(json.dumps(document).replace("Infinity", "1e999").encode(), cube.probe)
