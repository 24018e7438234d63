"""Each choice alone: its error is there without it, and gone with it."""

import numpy as np
import pytest
from benchmarks.ablation import locating, reading, study
from benchmarks.ablation.reading import SceneRecord, drawn
from benchmarks.ablation.smooth import SmoothNormals, vertex_normals
from benchmarks.ablation.study import FILTERED, compared, effect, run
from benchmarks.plane import FlatFace, _block

from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.simulation.marker_touches import model_of


@pytest.fixture(scope="module")
def record() -> SceneRecord:
    return drawn("linear", 300, np.random.default_rng(1))


def test_figures_are_of_rows_that_are_sure_and_not_grossly_off() -> None:
    truth = np.zeros((4, 3))
    without = 1e-3 * np.array([[2.0, 0, 0], [20.0, 0, 0], [4.0, 0, 0], [np.nan] * 3])
    made = 1e-3 * np.array([[1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0]])
    found = compared(truth, without, made, np.ones(4, dtype=bool), np.array([True, True, False, True]))
    assert (found["without"], found["with"], found["taken"]) == pytest.approx((2, 1, 1))
    assert (found["located_without"], found["located_with"]) == (0.5, 0.75)


def test_without_axial_torque_no_local_torque_is_left(record: SceneRecord) -> None:
    plain = locating.without_axial(record.contacts)
    assert np.allclose(np.einsum("nd,nd->n", plain[:, :3], plain[:, 3:]), 0.0, atol=1e-12)
    made = locating.locators("linear", 500, 0.0).ours.locate_batch(plain)
    explained = made.misfits < 1e-9  # at the others' edges and corners the axis passes the coarse mesh by
    assert explained.mean() > 0.95
    assert np.abs(made.torques[explained]).max() < 1e-9


def test_local_torque_takes_more_away_the_more_it_twists(record: SceneRecord) -> None:
    little = effect(locating.LOCAL_TORQUE, record, 2_000, 0.0, 0)
    twisted = drawn("linear", 300, np.random.default_rng(1), torsion=0.003)
    much = effect(locating.LOCAL_TORQUE, twisted, 2_000, 0.0, 0)
    assert 0 < little["taken"] < 0.2 < much["taken"]


@pytest.mark.parametrize("choice", reading.CHOICES)
def test_what_a_sensor_does_wrong_is_taken_off_again(
    record: SceneRecord, choice: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = effect(choice, record, 2_000, FILTERED, 0)
    clean = effect(locating.LOCAL_TORQUE, record, 2_000, FILTERED, 0)["with"]
    assert found["without"] > 1.3 * clean
    assert found["with"] < 1.15 * clean
    monkeypatch.setitem(reading.AMOUNTS, choice, 0.0)
    assert abs(effect(choice, record, 2_000, FILTERED, 0)["taken"]) < 0.1 * clean


def test_ten_times_the_facets_are_nearer(record: SceneRecord) -> None:
    found = effect(locating.FINER, record, 500, 0.0, 0)
    assert found["with"] < 0.3 * found["without"]


def test_the_same_seed_gives_the_same(record: SceneRecord) -> None:
    one, other = (effect(locating.GATE, record, 500, 1.0, 5) for _ in range(2))
    assert one == other
    assert one != effect(locating.GATE, record, 500, 1.0, 6)


def test_every_choice_has_its_figures() -> None:
    pytest.importorskip("mujoco")
    report = run(["linear"], seeds=1, facets=500, touches=60, tips=4, rounds=1)
    choices = report.sheets[0].to_json()
    assert {row["choice"] for row in choices} == set(study.CHOICES)
    assert {row["scene"] for row in choices if row["choice"] == study.INERTIA} == {"platform", "arm"}
    said = {(row["choice"], row["scene"]): row["worth modelling"] for row in choices}
    assert said[reading.MOUNT, "platform"] == "yes"
    assert said[locating.SMOOTH, "platform"] == "no"
    assert {row["choice"] for row in report.sheets[1].to_json()} == set(locating.CHOICES)


# ---- smooth normals: what they solve, and what they leave as it is -------------------------------


QUIET = WrenchNoise(1e-6, 1e-8)


@pytest.fixture(scope="module")
def coarse():
    """A coarse mesh of a curved probe, touches of the exact surface, and what flat facets make of them."""
    probe = model_of("convex", 500)
    touches = drawn("convex", 600, np.random.default_rng(3), torsion=0.001)
    return probe, touches, ContactSolver(probe, QUIET).locate_batch(touches.contacts)


def test_normals_at_vertices_are_of_length_1_and_point_outward():
    probe = model_of("linear", 500)
    normals = vertex_normals(probe)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    at_facets = normals[probe.faces].sum(axis=1)
    assert (np.einsum("md,md->m", at_facets, probe.normals) > 0).all()


def test_what_is_refined_solves_the_equation_with_the_interpolated_normal(coarse):
    probe, touches, found = coarse
    points = SmoothNormals(probe).refine(touches.contacts, found)
    normals = vertex_normals(probe)
    solved = 0
    for w, p, flat, facet in zip(touches.contacts, points, found.points, found.faces, strict=True):
        if facet < 0 or np.array_equal(p, flat):
            continue
        a, b, c = probe.vertices[probe.faces[facet]]
        weights = np.linalg.lstsq(
            np.vstack([np.column_stack([a, b, c]), np.ones(3)]), np.append(p, 1.0), rcond=None
        )[0]
        if weights.min() < 0:
            continue  # it has walked to a neighbour
        n = weights @ normals[probe.faces[facet]]
        left = w[3:] - np.cross(p, w[:3])
        assert np.linalg.norm(np.cross(left, n)) < 1e-4 * np.linalg.norm(w[3:])
        solved += 1
    assert solved > 300


def test_bulged_facets_halve_the_error_of_a_coarse_mesh_and_normals_alone_do_not(coarse):
    probe, touches, found = coarse
    smooth = SmoothNormals(probe)
    flat, normals, bulged = (
        np.linalg.norm(points - touches.points, axis=1)[found.accepted].mean()
        for points in (
            found.points,
            smooth.refine(touches.contacts, found),
            smooth.refine(touches.contacts, found, bulge=True),
        )
    )
    assert found.accepted.mean() > 0.99
    assert bulged < 0.6 * flat
    assert normals == pytest.approx(flat, rel=0.1)


def test_on_a_plane_nothing_changes_far_from_its_rim_and_what_is_not_found_stays_so():
    probe = _block()
    points, _ = FlatFace().sample(50, np.random.default_rng(0))
    forces = np.broadcast_to([0.0, 0.0, -9.0], points.shape)
    wrenches = np.hstack([forces, np.cross(points, forces)])
    wrenches[7] = 0.0
    found = ContactSolver(probe, QUIET).locate_batch(wrenches)
    refined = SmoothNormals(probe).refine(wrenches, found)
    assert np.isnan(refined[7]).all()
    kept = np.delete(np.arange(50), 7)
    # Without torque about the force the normals do not count.
    assert np.allclose(refined[kept], points[kept], atol=1e-9)
