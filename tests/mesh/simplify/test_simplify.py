"""Fewer facets: the count is reached, the shape is kept, and what an engine spoils is not used."""

from __future__ import annotations

import re

import numpy as np
import pytest
import trimesh
from contact_cases import bundled

from pipeline.mesh import MeshError, Probe, engines
from pipeline.mesh.deviation import measure_deviation
from pipeline.mesh.simplify import Count, MaxDeviation, MaxError, simplify
from pipeline.mesh.simplify import recipe as recipe_module


def _moved(probe: Probe, factor: float) -> Probe:
    return Probe.from_arrays(probe.vertices * factor, probe.faces, probe.region, check_size=False)


def _bumpy(level: int = 5) -> Probe:
    mesh = trimesh.creation.icosphere(level)
    d = np.asarray(mesh.vertices)
    radius = 0.04 * (1 + 0.05 * np.sin(10 * d[:, 0]) * np.sin(8 * d[:, 1]) * np.sin(9 * d[:, 2]))
    return Probe.from_arrays(d * radius[:, None], mesh.faces, name="bumpy")


def _with_cap(probe: Probe, share: float = 0.1) -> Probe:
    centre = probe.vertices[probe.faces].mean(axis=1)
    order = np.argsort(np.linalg.norm(centre - probe.vertices[np.argmax(probe.vertices[:, 2])], axis=1))
    region = np.zeros(len(probe.faces), dtype=np.int32)
    region[order[: np.searchsorted(np.cumsum(probe.areas[order]), share * probe.areas.sum())]] = 1
    return probe.with_region(region)


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_a_count_is_reached_and_the_shape_is_kept(name: str) -> None:
    probe = bundled(name, 8_000)
    made = simplify(probe, Count(500))
    assert made.count == len(made.probe.faces) == 500
    assert made.engine == "fast-simplification"
    assert made.probe.health.watertight
    assert made.probe.health.outward is True
    assert made.probe.name == probe.name
    assert made.deviation.hausdorff < 0.01 * probe.size
    assert made.deviation.rms < 0.002 * probe.size
    # The coarse measurement that comes with a count agrees with the thorough one.
    thorough = measure_deviation(probe, made.probe)
    assert made.deviation.hausdorff == pytest.approx(thorough.hausdorff, rel=0.1)
    assert made.deviation.rms == pytest.approx(thorough.rms, rel=0.1)


@pytest.mark.parametrize("factor", [0.001, 1000.0, 1 / 0.0254])
def test_the_unit_makes_no_difference(factor: float) -> None:
    probe = bundled("t-shape", 5_000)
    made, other = simplify(probe, Count(300)), simplify(_moved(probe, factor), Count(300))
    np.testing.assert_array_equal(made.probe.faces, other.probe.faces)
    apart = np.abs(other.probe.vertices / factor - made.probe.vertices).max()
    assert apart < 1e-6 * probe.size
    assert other.deviation.hausdorff == pytest.approx(factor * made.deviation.hausdorff, rel=1e-6)


def test_rounding_and_place_make_no_difference() -> None:
    probe = bundled("convex", 5_000)
    in_mm = Probe.from_arrays((probe.vertices * 1000) * 0.001, probe.faces)
    assert not np.array_equal(in_mm.vertices, probe.vertices)
    made, other = simplify(probe, Count(300)), simplify(in_mm, Count(300))
    np.testing.assert_array_equal(made.probe.faces, other.probe.faces)
    assert np.abs(other.probe.vertices - made.probe.vertices).max() < 1e-12


def test_a_probe_that_is_coarse_enough_is_left_as_it_is() -> None:
    probe = _with_cap(_bumpy(2))
    made = simplify(probe, Count(320))
    assert made.probe is probe
    assert made.engine == "none"
    assert "left as it is" in made.steps[0]
    assert made.deviation.hausdorff < 1e-15


def test_a_great_reduction_goes_in_two_steps_and_keeps_the_shape() -> None:
    probe = _bumpy(6)
    made = simplify(probe, Count(200))
    assert made.count == 200
    assert made.probe.health.watertight
    assert made.deviation.rms < 0.01 * probe.size


def test_regions_are_carried_over() -> None:
    probe = bundled("t-shape", 5_000, regions=True)
    made = simplify(probe, Count(500))
    before = probe.areas[probe.region > 0].sum()
    assert made.probe.areas[made.probe.region > 0].sum() == pytest.approx(before, rel=0.1)
    assert set(made.regions) == set(np.unique(probe.region).tolist())
    assert max(part.hausdorff for part in made.regions.values()) == pytest.approx(made.deviation.hausdorff)
    assert simplify(bundled("t-shape", 5_000), Count(500)).regions == {}


@pytest.mark.parametrize("shape", ["bumpy", "t-shape"])
def test_a_ratio_gives_the_region_its_facets(shape: str) -> None:
    probe = _with_cap(_bumpy() if shape == "bumpy" else bundled("t-shape", 8_000))
    even, made = simplify(probe, Count(1000)), simplify(probe, Count(1000), region_ratio=8.0)
    assert 990 <= made.count <= 1000
    assert made.probe.health.watertight
    inside = made.probe.region > 0
    densities = [np.count_nonzero(chosen) / made.probe.areas[chosen].sum() for chosen in (inside, ~inside)]
    assert densities[0] / densities[1] == pytest.approx(8, rel=0.15)
    assert made.regions[1].rms < 0.5 * even.regions[1].rms
    # What the rest pays for it.
    assert made.regions[0].rms < 5 * even.regions[0].rms


@pytest.mark.parametrize("ratio", [0.5, float("nan"), 1000.0])
def test_a_ratio_that_is_none_is_refused(ratio: float) -> None:
    with pytest.raises(MeshError, match="region ratio"):
        simplify(_bumpy(2), Count(100), region_ratio=ratio)


def test_a_ratio_without_regions_or_with_nothing_else_is_as_none() -> None:
    probe = _bumpy(4)
    plain = simplify(probe, Count(300))
    for region in (0, 1):
        made = simplify(probe.with_region(np.full(len(probe.faces), region)), Count(300), region_ratio=5.0)
        np.testing.assert_array_equal(made.probe.vertices, plain.probe.vertices)


def test_a_largest_deviation_is_kept_with_few_facets() -> None:
    probe = _bumpy()
    limit = 0.001
    told: list[float] = []
    made = simplify(probe, MaxDeviation(limit), progress=told.append)
    assert made.deviation.hausdorff <= limit
    assert measure_deviation(probe, made.probe).hausdorff <= limit
    assert made.count < len(probe.faces) / 10
    # Well below the count found, the limit is broken.
    assert simplify(probe, Count(int(made.count * 0.7))).deviation.hausdorff > limit
    assert len(made.steps) <= 12
    assert told == sorted(told)
    assert told[-1] == 1


def test_a_limit_that_no_fewer_facets_keep_leaves_the_probe() -> None:
    probe = _bumpy(2)
    made = simplify(probe, MaxDeviation(1e-9))
    assert made.probe is probe
    assert "left as it is" in made.steps[-1]


def test_any_error_can_be_the_target() -> None:
    probe = _bumpy(4)

    def volume_error(made: Probe) -> float:
        volume = trimesh.Trimesh(made.vertices, made.faces, process=False).volume
        return abs(volume / trimesh.Trimesh(probe.vertices, probe.faces, process=False).volume - 1)

    made = simplify(probe, MaxError(volume_error, 0.01))
    assert volume_error(made.probe) <= 0.01
    assert made.count < 1500
    with pytest.raises(MeshError, match=r"full mesh is 3 already, above the limit of 1"):
        simplify(_bumpy(2), MaxError(lambda _probe: 3.0, 1.0))


@pytest.mark.parametrize(
    "target", [lambda: Count(3), lambda: MaxDeviation(0.0), lambda: MaxError(lambda _: 0.0, float("nan"))]
)
def test_targets_that_are_none_are_refused(target: object) -> None:
    with pytest.raises(MeshError):
        target()


@pytest.mark.parametrize("engine", ["meshlab", "best"])
def test_the_other_engines_work_too(engine: str) -> None:
    probe = _bumpy(4)
    made = simplify(probe, Count(500), engine=engine)
    assert made.count == 500
    assert made.probe.health.watertight
    if engine == "meshlab":
        assert made.engine.startswith("meshlab")
    else:
        assert made.deviation.hausdorff <= simplify(probe, Count(500)).deviation.hausdorff
        assert len(made.steps) == 5


def test_unmerged_vertices_and_duplicate_facets_are_mended_first() -> None:
    probe = _bumpy(4)
    loose = Probe.from_arrays(
        np.vstack([probe.vertices[probe.faces].reshape(-1, 3)] * 2),
        np.arange(2 * probe.faces.size).reshape(-1, 3),
    )
    assert not loose.health.watertight
    made = simplify(loose, Count(500))
    assert made.count == 500
    assert made.probe.health.watertight
    assert made.deviation.rms < 2 * simplify(probe, Count(500)).deviation.rms


def _spoil(monkeypatch: pytest.MonkeyPatch, spoil: object) -> None:
    true = engines.fast_quadric

    def spoiled(vertices: np.ndarray, faces: np.ndarray, count: int, **options: object) -> object:
        return spoil(*true(vertices, faces, count, **options))

    monkeypatch.setattr(recipe_module.engines, "fast_quadric", spoiled)


def _turned(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return vertices, np.vstack([faces[:30, ::-1], faces[30:]])


@pytest.mark.parametrize(
    ("spoil", "why"),
    [
        (lambda v, f: (v, f[1:]), "opened the surface"),
        (_turned, "turned facets over"),
        (lambda v, f: (v, f[:, ::-1].copy()), "inside out"),
        (lambda v, f: (v, np.vstack([f, f[:1]])), r"stopped at 501.*more than two.*twice"),
        (lambda v, f: (v, np.vstack([f, f[:1, [0, 0, 1]]])), "a mesh that is none"),
        (lambda v, f: (v * [1.0, 1.0, 0.5], f), "ruined the shape"),
        (lambda v, f: (v, f[:200]), "left 200 facets instead of 500"),
    ],
)
def test_what_an_engine_spoils_is_not_used(monkeypatch: pytest.MonkeyPatch, spoil: object, why: str) -> None:
    _spoil(monkeypatch, spoil)
    made = simplify(_bumpy(4), Count(500))
    assert made.engine == "meshlab, careful"
    assert made.probe.health.watertight
    assert made.count == 500
    assert re.search(why, made.steps[0])


def test_an_engine_that_fails_is_told_and_another_used(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: object, **__: object) -> None:
        raise engines.EngineError("meshlab cannot be loaded: install it.")

    monkeypatch.setattr(recipe_module.engines, "quadric", missing)
    made = simplify(_bumpy(4), Count(500), engine="meshlab")
    assert made.engine == "fast-simplification"
    assert "cannot be loaded" in made.steps[0]
    monkeypatch.setattr(recipe_module.engines, "fast_quadric", missing)
    with pytest.raises(MeshError, match=r"cannot be simplified to 500 facets: .*install it.*Ask for more"):
        simplify(_bumpy(4), Count(500))


def test_cancel_reaches_the_engine() -> None:
    with pytest.raises(engines.Cancelled):
        simplify(_bumpy(4), Count(500), cancelled=lambda: True)
    assert simplify(_bumpy(4), Count(500)).count == 500


def test_an_open_surface_stays_open_and_no_more() -> None:
    closed = _bumpy(4)
    keep = closed.vertices[closed.faces].mean(axis=1)[:, 2] < 0.03
    bowl = Probe.from_arrays(closed.vertices, closed.faces[keep])
    made = simplify(bowl, Count(500))
    assert made.count <= 500
    assert 0 < made.probe.health.boundary_edges < bowl.health.boundary_edges
    assert made.probe.health.components == 1
