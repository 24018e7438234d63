"""Drawn sessions hold what is said of them, and the study of them could fail."""

import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks import calibration_doubt as study
from benchmarks import wrong_models as wrong
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel

QUIET = {"force_noise": (1e-9, 1e-9), "torque_noise": (1e-9, 1e-9)}


def drawn(seed=0, **how):
    return wrong.draw(np.random.default_rng(seed), **(QUIET | how))


def model(session):
    return GravityModel.from_vector(session.truth, np.zeros((12, 12)))


# ---- sessions ----------------------------------------------------------------------------------


@pytest.mark.parametrize("plan", wrong.PLANS)
def test_a_clean_session_reads_bias_and_weight(plan):
    session = drawn(plan=plan)
    assert 8 <= len(session) <= 20
    assert np.allclose(session.wrenches, model(session).predict(session.R_WS), atol=1e-7)
    assert session.contact_error(session.truth) < 1e-12
    assert (np.diff(session.times) >= 10).all()


def test_the_bound_is_the_information_of_the_readings():
    session = drawn(force_noise=(0.03, 0.03), torque_noise=(0.001, 0.001), orientation_deg=0.2)
    information = np.zeros((12, 12))
    for R, w in zip(session.true_R_WS, session.weight_S, strict=True):
        steps = 1e-6 * np.eye(12)
        J = np.array(
            [(wrong._read(R, session.truth + h) - wrong._read(R, session.truth - h)) / 2e-6 for h in steps]
        ).T
        turned = np.array(
            [
                np.concatenate([np.cross(w, axis), np.cross(session.truth[6:9], np.cross(w, axis))])
                for axis in np.eye(3)
            ]
        ).T
        V = np.diag(session.sigmas**2) + np.radians(0.2) ** 2 * turned @ turned.T
        information += J.T @ np.linalg.inv(V) @ J
    assert np.allclose(session.bound(), np.linalg.inv(information), rtol=1e-5)


def test_drift_is_over_at_the_end():
    clean = drawn(3)
    for warm_up in (None, 0.3):
        session = wrong.drift(clean, np.random.default_rng(1), force=0.3, torque=0.01, warm_up=warm_up)
        added = session.wrenches - clean.wrenches
        assert np.allclose(added[-1], 0)
        assert np.linalg.norm(added[0, :3]) == pytest.approx(0.3)
        assert np.linalg.norm(added[0, 3:]) == pytest.approx(0.01)
        left = np.linalg.norm(added[:, :3], axis=1) / 0.3
        run = session.times / session.times[-1]
        assert np.allclose(left, 1 - run) if warm_up is None else (left[1:-1] < 1 - run[1:-1]).all()


def test_a_rezero_is_before_the_pose_that_is_named():
    clean = drawn(4)
    session = wrong.rezero(clean, np.random.default_rng(1), force=0.3, before=5)
    added = np.linalg.norm((session.wrenches - clean.wrenches)[:, :3], axis=1)
    assert np.allclose(added[:5], 0.3)
    assert np.allclose(added[5:], 0)
    assert session.rezeroed == (5,)
    assert wrong.rezero(session, np.random.default_rng(1)).rezeroed[0] == 5


def test_a_turned_mount_is_right_for_who_knows_it():
    session = wrong.turned_mount(drawn(6), np.random.default_rng(1), deg=5.0)
    assert np.allclose(session.R_WS @ session.R_FS, session.true_R_WS)
    assert np.degrees(Rotation.from_matrix(session.R_FS).magnitude()) == pytest.approx(5.0)
    assert session.contact_error(session.truth) > 1e-4
    assert replace(session, R_FS=np.eye(3)).contact_error(session.truth) < 1e-12


@pytest.mark.parametrize("fault", [wrong.spring, wrong.side_pull, wrong.hysteresis])
def test_a_cable_pulls_with_the_force_that_is_said(fault):
    clean = drawn(7)
    added = (fault(clean, np.random.default_rng(1), force=0.5).wrenches - clean.wrenches)[:, :3]
    size = np.linalg.norm(added, axis=1)
    assert size.mean() == pytest.approx(0.5, rel=0.5)
    assert size.max() < 1.5
    session = fault(clean, np.random.default_rng(1), force=0.5)
    # A cable is still there when the probe is used: knowing the tool alone is not enough.
    assert (session.contact_error(session.truth) > 0.001) == (fault is not wrong.hysteresis)
    in_world = np.einsum("nij,nj->ni", clean.true_R_WS, added)
    assert np.allclose(in_world, in_world[0]) == (fault is wrong.side_pull)


# ---- the study ---------------------------------------------------------------------------------


def cell(words: str) -> study.Cell:
    [found] = [cell for cell in study.CELLS if cell.name == words]
    return found


def test_every_cell_draws_what_it_says():
    assert len({cell.name for cell in study.CELLS}) == len(study.CELLS)
    for each in study.CELLS:
        session = each.draw(np.random.default_rng(0))
        assert bool(session.rezeroed) == (each.told == ("rezero",))
        assert session.bumped.any() == ("bumped" in each.name)


def trial(**facts) -> study.Trial:
    usual = {"cause": "plain", "odds": 0.99, "adopted": "", "steps": (), "rezeroed": (), "level": "good"}
    usual |= {"covered": True, "scaled": np.ones(12), "wrongly_bumped": False, "missed": False}
    return study.Trial(**(usual | {"error": 1e-4, "claimed": 1e-4, "seconds": 0.1} | facts))


@pytest.mark.parametrize(
    ("measure", "hits", "misses"),
    [
        ("told", [{"cause": "rezero"}], [{"cause": "drift"}, {}]),
        (
            "pose",
            [{"steps": (3,), "rezeroed": (3,)}],
            [{"steps": (4,), "rezeroed": (3,)}, {"rezeroed": (3,)}],
        ),
        ("alarmed", [{"cause": "cable"}, {"adopted": "drift"}], [{}, {"cause": "cable", "odds": 0.6}]),
        (
            "wrong",
            [{"cause": "cable"}],
            [{}, {"cause": "none"}, {"cause": "rezero"}, {"cause": "cable", "odds": 0.6}],
        ),
        (
            "deceived",
            [{"error": 0.0016, "claimed": 0.001}, {"error": 0.0004}],
            [{}, {"error": 0.0016, "level": "usable"}, {"error": 0.0014, "claimed": 0.0005}],
        ),
    ],
)
def test_measures_count_what_they_say(measure, hits, misses):
    _, of = study.MEASURES[measure]
    for facts, share in [*((hit, 100) for hit in hits), *((miss, 0) for miss in misses)]:
        assert of(cell("re-zero 0.3 N, 10 mN·m, noise given"), [trial(**facts)], "").measured == share


def test_drift_is_told_and_clean_sets_are_left_alone():
    told = study.figures_of(*tried("drift 0.3 N, 10 mN·m, 10 poses, noise given", 40))
    assert told[0].measured >= 95
    clean = study.figures_of(*tried("clean, robot's orientations, noise given", 40))
    assert clean[0].measured <= 5.0


def tried(words: str, sets: int) -> tuple[study.Cell, list[study.Trial]]:
    return cell(words), cell(words).tried(1, range(sets))


def test_a_calibration_that_lies_misses(monkeypatch):
    honest = study.calibrate

    def lying(*args, **options):
        calibration = honest(*args, **options)
        theta = calibration.model.vector + 6 * np.sqrt(np.diag(calibration.covariance))
        return replace(calibration, model=GravityModel.from_vector(theta, calibration.covariance))

    words = "clean, exact orientations, noise given"
    questions = [study.MEASURES[measure][0] for measure in ("covered", "bound", "deceived")]
    for calibrate, passed in ((honest, True), (lying, False)):
        monkeypatch.setattr(study, "calibrate", calibrate)
        figures = study.figures_of(*tried(words, 20))
        for question in questions[: 3 if not passed else 1]:
            assert [f.passed for f in figures if f.name == question] == [passed]


def test_sessions_do_not_depend_on_the_number_of_workers():
    reports = [study.run(sets=20, cells="times 2", workers=workers) for workers in (1, 2)]
    assert reports[0] == reports[1]
    assert reports[0].figures


def test_the_command_takes_its_options(benchmark):
    result = benchmark(
        "calibration-doubt", "--sets", 20, "--seed", 3, "--cells", "times 2", "--workers", 1, "--json"
    )
    report = json.loads(result.stdout)
    assert result.exit_code == (0 if report["passed"] else 1)
    assert report["settings"] == {"sets": 20, "seed": 3}
    assert {figure["subject"] for figure in report["figures"]} == {"noise given times 2"}
