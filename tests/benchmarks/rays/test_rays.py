"""A touch beside a ray query: every figure is there, and all who are asked answer the same question."""

from __future__ import annotations

import shutil
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np
import pytest
from benchmarks.plane import _block
from benchmarks.rays import contenders as who
from benchmarks.rays import page
from benchmarks.rays.contest import run
from benchmarks.rays.memory import bytes_per_facet

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.contact.methods import EmbreeAxis
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import draw_touches

if TYPE_CHECKING:
    import ctypes
    from pathlib import Path

needs_compiler = pytest.mark.skipif(shutil.which("g++") is None, reason="no g++")
needs_embree = pytest.mark.skipif(find_spec("embreex") is None, reason="no embreex")


@pytest.fixture(scope="module")
def asked() -> who.Questions:
    rng = np.random.default_rng(3)
    wrenches = draw_touches(assets.surface("convex"), 300, rng, above=0.02).wrenches
    return who.Questions.of(ContactSolver(Probe.from_arrays(*assets.make("convex", 500))), wrenches, wrenches)


@pytest.fixture(scope="module")
def headers(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return who.compile_touches(tmp_path_factory.mktemp("headers"))


@pytest.fixture
def compiled(headers: ctypes.CDLL, monkeypatch: pytest.MonkeyPatch) -> None:
    """Compile the headers once for all."""
    monkeypatch.setattr(who, "compile_touches", lambda _folder: headers)


@needs_compiler
@pytest.mark.usefixtures("compiled")
def test_the_headers_answer_as_the_solver_does(asked: who.Questions, tmp_path: Path) -> None:
    there = who.Field(tmp_path, None)
    answers = {each.key: each.ready(slice(None))() for each in there.contenders(asked)}
    ours = answers[who.OURS, "", who.BATCH]
    assert np.isfinite(ours.points).mean() > 0.9
    for calls in (who.BATCH, who.PAIR):
        assert np.array_equal(answers[who.HEADERS, "", calls], ours.points, equal_nan=True)
    assert [each.face for each in answers[who.OURS, "", who.SINGLE]] == list(ours.faces)
    assert "--bvh" in there.absent[who.BVH]


def test_who_is_not_there_is_left_out_by_name(
    asked: who.Questions, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def gone(name: str) -> None:
        raise ImportError(f"no {name}")

    monkeypatch.setattr(who, "import_module", gone)
    monkeypatch.setattr(who, "compile_touches", lambda _folder: gone("g++"))
    there = who.Field(tmp_path, tmp_path / "elsewhere")
    names = {each.name for each in there.contenders(asked)}
    assert who.OURS in names
    assert not {who.HEADERS, who.FCPW, who.TRIMESH, who.BVH} & names
    assert there.absent[who.FCPW] == "no fcpw"
    assert there.absent[who.HEADERS] == "no g++"
    assert "bvh.h" in there.absent[who.BVH]


@needs_compiler
@needs_embree
@pytest.mark.usefixtures("compiled")
def test_rays_meet_the_mesh_where_the_axis_does(asked: who.Questions, tmp_path: Path) -> None:
    facets = EmbreeAxis(asked.solver).trace(*asked.rays)
    answers = {each.key: each.ready(slice(None))() for each in who.Field(tmp_path, None).contenders(asked)}
    assert (facets >= 0).mean() > 0.98
    assert np.array_equal(answers[who.TRIMESH, who.FIRST, who.BATCH], facets)
    rays, _ = answers[who.EMBREEX, who.ALL, who.BATCH]
    hits = np.bincount(rays, minlength=len(facets))
    # Into a closed mesh and out of it again, but for the few that graze it.
    assert (hits[facets >= 0] % 2 == 0).mean() > 0.98


@needs_embree
def test_every_hit_of_a_ray_through_a_box_is_found() -> None:
    axis = EmbreeAxis(ContactSolver(_block()))
    # About the box's middle: 0.1 m high.
    origins = np.array([[0.001, 0.002, 1.0], [1.0, 0.0, 1.0]], np.float32)
    rays, distances = who.every_hit(axis, origins, np.array([[0, 0, -1.0]] * 2, np.float32))
    assert rays.tolist() == [0, 0]
    assert distances == pytest.approx([0.95, 1.05], abs=1e-4)


@needs_compiler
@pytest.mark.usefixtures("compiled")
def test_a_run_reports_every_figure(tmp_path: Path) -> None:
    report = run([300, 2_000], touches=8_192, rounds=2)
    text = report.markdown()
    assert text.startswith("# A touch beside a ray query\n")
    assert {"errors", "answers", "solves", "times"} <= {sheet.name for sheet in report.sheets}
    assert f"Left out: {who.BVH}" in text
    names = {figure.name for figure in report.figures}
    assert f"two threads, times one: {who.OURS}" in names
    errors = next(sheet for sheet in report.sheets if sheet.name == "errors").to_json()
    by = {(row["facets"], row["answers"]): row for row in errors}
    assert by["2,000", page.OURS_SURE]["within 1 mm, %"] > by["300", page.OURS_SURE]["within 1 mm, %"] > 30
    report.write(tmp_path / "new" / "rays.md")
    assert (tmp_path / "new" / page.PICTURE).read_bytes().startswith(b"\x89PNG")
    assert page.PICTURE in (tmp_path / "new" / "rays.md").read_text(encoding="utf-8")
    assert len(list((tmp_path / "new").iterdir())) == 2


def test_a_model_takes_more_than_its_corners_alone() -> None:
    assert 36 < bytes_per_facet("convex", 50_000) < 1_000
