"""Fewer facets: the count is reached, the shape is kept, and what is not sound is not used."""

import math

import manifold3d
import numpy as np
import pytest
import trimesh
from contact_cases import bundled

from contactbench.pipeline.mesh import MeshError, Probe, engines
from contactbench.pipeline.mesh.deviation import measure_deviation
from contactbench.pipeline.mesh.simplify import Count, MaxDeviation, MaxError, simplify
from contactbench.pipeline.mesh.simplify import job as job_module
from contactbench.pipeline.mesh.soundness import check_soundness


def _moved(probe: Probe, factor: float) -> Probe:
    return Probe.from_arrays(probe.vertices * factor, probe.faces, probe.region, check_size=False)


def _bumpy(level: int = 4) -> Probe:
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
    assert made.engine == "edge collapse"
    assert check_soundness(made.probe.vertices, made.probe.faces, (probe.vertices, probe.faces)).sound
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
    assert "left unchanged" in made.steps[0]
    assert made.deviation.hausdorff < 1e-15


def test_regions_are_carried_over() -> None:
    probe = bundled("t-shape", 5_000, regions=True)
    made = simplify(probe, Count(500))
    before = probe.areas[probe.region > 0].sum()
    assert made.probe.areas[made.probe.region > 0].sum() == pytest.approx(before, rel=0.03)
    assert set(made.regions) == set(np.unique(probe.region).tolist())
    assert max(part.hausdorff for part in made.regions.values()) == pytest.approx(made.deviation.hausdorff)
    assert simplify(bundled("t-shape", 5_000), Count(500)).regions == {}


@pytest.mark.parametrize("shape", ["bumpy", "t-shape"])
def test_a_ratio_gives_the_region_its_facets(shape: str) -> None:
    probe = _with_cap(_bumpy(5) if shape == "bumpy" else bundled("t-shape", 8_000))
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
    probe = _bumpy()
    plain = simplify(probe, Count(300))
    for region in (0, 1):
        made = simplify(probe.with_region(np.full(len(probe.faces), region)), Count(300), region_ratio=5.0)
        assert ("The region ratio is 5, but the mesh has no region" in made.sentences[1]) == (region == 0)
        np.testing.assert_array_equal(made.probe.vertices, plain.probe.vertices)


def test_a_largest_deviation_is_kept_with_few_facets() -> None:
    probe = _bumpy()
    limit = 0.002
    told: list[float] = []
    made = simplify(probe, MaxDeviation(limit), monitor=engines.Monitor(told.append))
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
    assert "left unchanged" in made.steps[-1]


def test_any_error_can_be_the_target() -> None:
    probe = _bumpy()

    def volume_error(made: Probe) -> float:
        volume = trimesh.Trimesh(made.vertices, made.faces, process=False).volume
        return abs(volume / trimesh.Trimesh(probe.vertices, probe.faces, process=False).volume - 1)

    made = simplify(probe, MaxError(volume_error, 0.01))
    assert volume_error(made.probe) <= 0.01
    assert made.count < 1500
    with pytest.raises(MeshError, match=r"full mesh already has an error of 3, above the limit of 1"):
        simplify(_bumpy(2), MaxError(lambda _probe: 3.0, 1.0))


@pytest.mark.parametrize(
    "target", [lambda: Count(3), lambda: MaxDeviation(0.0), lambda: MaxError(lambda _: 0.0, float("nan"))]
)
def test_targets_that_are_none_are_refused(target: object) -> None:
    with pytest.raises(MeshError):
        target()


def test_unmerged_vertices_and_duplicate_facets_are_mended_first() -> None:
    probe = _bumpy()
    loose = Probe.from_arrays(
        np.vstack([probe.vertices[probe.faces].reshape(-1, 3)] * 2),
        np.arange(2 * probe.faces.size).reshape(-1, 3),
    )
    assert not loose.health.watertight
    made = simplify(loose, Count(500))
    assert made.count == 500
    assert made.probe.health.watertight
    assert made.deviation.rms < 2 * simplify(probe, Count(500)).deviation.rms


def _spoil(monkeypatch: pytest.MonkeyPatch, spoil: object, below: int) -> list[int]:
    """Spoil what has fewer facets than `below`; the counts asked for come in the list."""
    true, asked = job_module.collapse_edges, []

    def spoiled(vertices: np.ndarray, faces: np.ndarray, wanted: tuple[int, int], *rest: object) -> object:
        asked.append(sum(wanted))
        made = true(vertices, faces, wanted, *rest)
        if sum(wanted) >= below:
            return made
        vertices, faces = spoil(*made[:2])
        return vertices, faces, np.resize(made[2], len(faces))

    monkeypatch.setattr(job_module, "collapse_edges", spoiled)
    return asked


def _turned(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return vertices, np.vstack([faces[:30, ::-1], faces[30:]])


def _spiked(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pull one vertex through the other side: closed, consistent and outward as before, but crossing."""
    moved = vertices.copy()
    moved[0] *= -1.5
    return moved, faces


def _folded(vertices: np.ndarray, faces: np.ndarray, every: int, by: float) -> tuple[np.ndarray, np.ndarray]:
    """Put a corner into facets of a ball, and beyond an edge: a sliver is turned, nothing crosses."""
    a, b, c = faces[::every].T
    middle = (vertices[a] + vertices[b]) / 2
    over = np.arange(len(a)) + len(vertices)
    split = [np.stack(each, axis=1) for each in ((a, b, over), (b, c, over), (c, a, over))]
    moved = middle * (1 + 1e-5) + by * (middle - vertices[c])
    return np.vstack([vertices, moved]), np.vstack([np.delete(faces, np.s_[::every], axis=0), *split])


SPOILT = [
    (lambda v, f: (v, f[1:]), "The surface is open"),
    (_turned, "disagree about which side"),
    (lambda v, f: (v, f[:, ::-1].copy()), "inside out"),
    (lambda v, f: (v, np.vstack([f, f[:1]])), "More than two facets"),
    (lambda v, f: (v, np.vstack([f, f[:1, [0, 0, 1]]])), "have no area"),
    (_spiked, "cut through each other"),
    (lambda v, f: _folded(v, f, 600, 0.1), "turned against the original"),
]


@pytest.mark.parametrize(("spoil", "why"), SPOILT)
def test_what_is_not_sound_is_not_used(monkeypatch: pytest.MonkeyPatch, spoil: object, why: str) -> None:
    asked = _spoil(monkeypatch, spoil, 550)
    made = simplify(_bumpy(), Count(500))
    # What crosses or overlaps is tried again on the exact coordinates.
    assert asked == [500] * why.startswith(("More than two", "cut through")) + [500, 525, 600]
    assert made.count == 600
    assert made.probe.health.watertight
    assert made.sentences[0].startswith("600 facets, more than the requested 500, because")
    other = made.sentences[0].translated(lambda text: text.replace("the requested {0}", "all {0}"))
    assert other.startswith("600 facets, more than all 500, because")
    assert "That took 3 attempts" in made.sentences[1]
    assert why in made.steps[0]


def test_specks_that_fold_excuse_no_larger_fold(monkeypatch: pytest.MonkeyPatch) -> None:
    ball = trimesh.creation.icosphere(4, 0.04)
    probe = Probe.from_arrays(*_folded(np.asarray(ball.vertices), np.asarray(ball.faces), 400, 0.01))
    found = check_soundness(probe.vertices, probe.faces)
    assert found.sound
    assert len(found.folded_facets) == 13
    _spoil(monkeypatch, lambda v, f: _folded(v, f, 600, 0.1), 550)
    assert simplify(probe, Count(500)).count == 600


def test_when_nothing_is_sound_it_fails_after_few_attempts(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = _spoil(monkeypatch, _turned, 10**9)
    with pytest.raises(MeshError, match=r"cannot be simplified to 500 facets.*disagree.*Choose more"):
        simplify(_bumpy(), Count(500))
    assert asked == [500, 525, 600, 750, 1000, 2000, 4000]


def test_a_search_goes_up_by_factors_after_failures(monkeypatch: pytest.MonkeyPatch) -> None:
    probe, told = _bumpy(), []
    asked = _spoil(monkeypatch, _turned, 10**9)
    made = simplify(probe, MaxDeviation(0.001), monitor=engines.Monitor(told.append))
    assert made.probe is probe
    assert len(asked) <= 12
    ratios = np.array(asked[1:]) / asked[:-1]
    assert (ratios[:2] > 1.9).all()
    assert ratios.min() > 1.02
    assert made.sentences[0].startswith("5,120 facets, as many as before, because")
    assert told == sorted(told)
    assert len(told) >= len(asked)


def test_a_search_passes_failures_on_its_way(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = _spoil(monkeypatch, _turned, 900)
    made = simplify(_bumpy(), MaxDeviation(0.002))
    assert 900 <= made.count <= 1_100
    assert len(asked) <= 12
    assert made.deviation.hausdorff <= 0.002


def test_thin_parts_and_grooves_survive_without_a_crossing() -> None:
    blade = trimesh.creation.box([0.02, 0.0003, 0.1])
    for _ in range(5):
        blade = blade.subdivide()
    probe = Probe.from_arrays(blade.vertices, blade.faces)
    made = simplify(probe, Count(300))
    assert made.count == 300
    assert check_soundness(made.probe.vertices, made.probe.faces, (probe.vertices, probe.faces)).sound
    assert made.deviation.hausdorff < 1e-6


def test_cancel_ends_the_work_on_the_way() -> None:
    told: list[float] = []
    with pytest.raises(engines.Cancelled):
        simplify(_bumpy(5), Count(500), monitor=engines.Monitor(told.append, lambda: len(told) >= 2))
    assert len(told) == 2
    assert 0 < told[1] < 0.9


def test_an_open_surface_stays_open_and_no_more() -> None:
    closed = _bumpy()
    keep = closed.vertices[closed.faces].mean(axis=1)[:, 2] < 0.03
    bowl = Probe.from_arrays(closed.vertices, closed.faces[keep])
    made = simplify(bowl, Count(500))
    assert made.count <= 500
    assert 0 < made.probe.health.boundary_edges < bowl.health.boundary_edges
    assert made.probe.health.components == 1


def test_a_search_goes_up_by_factors_where_a_measure_says_nothing() -> None:
    seen = []

    def lost(probe: Probe) -> float:
        seen.append(len(probe.faces))
        return math.inf if len(probe.faces) < 900 else 0.001

    assert 900 <= simplify(_bumpy(), MaxError(lost, 0.01)).count < 1_200
    assert len(seen) <= 12
    assert seen[1] > 1.9 * seen[0]


def _grooved() -> Probe:
    """A block of 60 x 40 x 30 mm with eight grooves, half a millimetre wide and deep."""
    plate = manifold3d.Manifold.cube((60, 40, 30))
    for x in range(6, 54, 6):
        plate -= manifold3d.Manifold.cube((0.5, 42, 1)).translate((x, -1, 29.5))
    mesh = plate.to_mesh()
    return Probe.from_arrays(np.asarray(mesh.vert_properties[:, :3], dtype=np.float64) / 1e3, mesh.tri_verts)


def test_a_shape_that_cannot_be_kept_is_not_given(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(MeshError, match="cannot be simplified to 4 facets"):
        simplify(_grooved(), Count(4))
    monkeypatch.setattr(job_module, "_ANOTHER_SHAPE", 1e-6)
    with pytest.raises(MeshError, match=r"to 500 facets.*mm off: the shape is lost"):
        simplify(_bumpy(), Count(500))


def test_a_probe_of_few_facets_is_left_as_it_is() -> None:
    probe = _grooved()
    made = simplify(probe, MaxError(lambda _: 0.001, 0.01, enough=len(probe.faces)))
    assert made.probe is probe
    assert "few enough" in made.steps[0]
    assert made.short == ""
    assert simplify(probe, MaxError(lambda _: 0.001, 0.01, enough=len(probe.faces) - 12)).count < made.count


def test_facets_that_hardly_help_are_not_kept() -> None:
    """As with the scan of a rough surface: the contacts on any two of its meshes differ."""
    probe = _bumpy()
    made = simplify(probe, MaxError(lambda made: 0.03 - 1e-7 * len(made.faces), 0.01, enough=500))
    assert made.count == 500
    assert "more facets hardly help" in made.sentences[0]
    assert len(made.steps) < 8
    falls = simplify(probe, MaxError(lambda made: 2 / len(made.faces), 0.001, enough=500))
    assert 2_000 <= falls.count < 2_400
    assert falls.short == ""


def test_a_large_mesh_is_collapsed_in_two_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    probe = _bumpy()
    direct = simplify(probe, Count(200))
    monkeypatch.setattr(job_module, "_MANY", 1_000)
    counts = []
    collapse = job_module.collapse_edges
    monkeypatch.setattr(
        job_module,
        "collapse_edges",
        lambda *given: counts.append((len(given[1]), given[2])) or collapse(*given),
    )
    made = simplify(probe, Count(200))
    assert counts == [(len(probe.faces), (1_000, 0)), (1_000, (200, 0))]
    assert made.deviation.rms < 1.1 * direct.deviation.rms


def test_a_small_part_does_not_vanish_though_the_measure_does_not_see_it() -> None:
    probe = _bumpy()
    free = simplify(probe, MaxError(lambda _: 0.001, 0.01))
    kept = simplify(probe, MaxError(lambda _: 0.001, 0.01, farthest=free.deviation.hausdorff / 4))
    assert kept.deviation.hausdorff <= free.deviation.hausdorff / 4
    assert free.count < kept.count < len(probe.faces)
