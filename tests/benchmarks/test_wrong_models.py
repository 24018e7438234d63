"""Drawn sessions hold what is said of them, and the study of them could fail."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from benchmarks import calibration_doubt as study
from benchmarks import wrong_models as wrong

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
