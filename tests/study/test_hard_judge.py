"""The judge's d2 is the formula's, tried all over each facet, and an answer that is changed is refused."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contactbench.pipeline.contact import Contact, ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.hard_judge import CaseJudge

LIMIT = replace(TouchModel(), torsion_arm=0.01, mesh_curved=False)


@pytest.fixture(scope="module")
def drawn() -> hm.Drawn:
    body, rng = hm.bundled("t-shape", 500), np.random.default_rng(3)
    return hm.press(*hm.places(body, 60, rng, "edge"), rng, pitch=0.002)


def judge_of(model: TouchModel) -> tuple[ContactSolver, CaseJudge]:
    solver = ContactSolver(hm.bundled("t-shape", 500).probe(), WrenchNoise(), model=model)
    return solver, CaseJudge(solver)


def changed(contact: Contact, **fields: Any) -> Any:
    names = ("reason", "point", "face", "misfit", "confidence", "candidates")
    return SimpleNamespace(**{name: getattr(contact, name) for name in names} | fields)


@pytest.mark.parametrize("model", [TouchModel(torsion_arm=0.0, mesh_curved=False), LIMIT])
def test_d2_is_the_least_of_the_formula(model: TouchModel, drawn: hm.Drawn) -> None:
    solver, judge = judge_of(model)
    steps = [(i / 120, j / 120) for i in range(121) for j in range(121 - i)]
    shares = np.array([(1 - u - v, u, v) for u, v in steps])
    near = 0
    for wrench in drawn.wrenches[:10]:
        F, M = wrench[:3], wrench[3:]
        f, foot = F / np.linalg.norm(F), np.cross(F, M) / (F @ F)
        fits = judge.fits(wrench, 75.0)
        for face in np.argsort(fits.d2)[:4]:
            normal, corners = judge.normals[face], judge.corners[face]
            # S on the axis, as deep as where that meets the facet's plane, but no deeper than the facet is.
            depths = (corners - foot) @ f
            met = (corners[0] - foot) @ normal / (f @ normal)
            p = foot + np.clip(met, depths.min(), depths.max()) * f
            A = np.hstack([-np.cross(p, np.eye(3)).T, np.eye(3)])
            S = A @ solver.covariance @ A.T + (model.torsion_arm**2 * F @ F) * np.outer(normal, normal)
            r = M - np.cross(shares @ corners, F)
            least = np.einsum("ni,ij,nj->n", r, np.linalg.inv(S), r).min()
            assert fits.d2[face] <= least * (1 + 1e-6) + 1e-6  # the judge's own least deviation
            if least < 20:
                near += 1
                assert fits.d2[face] == pytest.approx(least, rel=0.01, abs=0.02)  # the grid has gaps
    assert near > 5


def test_right_answers_pass_and_changed_ones_are_refused(drawn: hm.Drawn) -> None:
    for model in (TouchModel(), LIMIT):
        solver, judge = judge_of(model)
        found = [(w, solver.locate(w)) for w in drawn.wrenches]
        assert [judge.faults(*answer) for answer in found] == [[]] * len(found)
        doubtful = [(w, c) for w, c in found if c.reason == Reason.AMBIGUOUS]
        sure = [(w, c) for w, c in found if c.reason == Reason.OK]
        assert doubtful
        assert sure
        for wrench, contact in doubtful:
            assert judge.faults(wrench, changed(contact, reason=Reason.OK))
            assert judge.faults(wrench, changed(contact, candidates=()))
        for wrench, contact in sure:
            assert contact.point is not None
            assert judge.faults(wrench, changed(contact, reason=Reason.AMBIGUOUS))
            assert judge.faults(wrench, changed(contact, misfit=contact.misfit + 1e-4))
            assert judge.faults(wrench, changed(contact, point=contact.point + 1e-6))
            assert judge.faults(wrench, changed(contact, confidence=contact.confidence - 1e-4))
            none = changed(contact, point=None, face=None, reason=Reason.IMPLAUSIBLE)
            assert judge.faults(wrench, none)


def test_another_model_is_noticed(drawn: hm.Drawn) -> None:
    solver, _ = judge_of(TouchModel())
    # On a flat wall a mesh that stands for a curved body is none.
    for other, share in (
        (LIMIT, 0.9),
        (TouchModel(torsion_arm=0.0011), 0.9),
        (TouchModel(mesh_curved=False), 0.2),
    ):
        _, judge = judge_of(other)
        wrong = sum(bool(judge.faults(w, solver.locate(w))) for w in drawn.wrenches)
        assert wrong > share * len(drawn)


def test_a_refusal_has_its_reason(drawn: hm.Drawn) -> None:
    solver, judge = judge_of(TouchModel())
    far = drawn.wrenches + np.array([0.0, 0.0, 0.0, 5.0, 5.0, 5.0])
    for wrench in far:
        contact = solver.locate(wrench)
        assert contact.point is None
        assert judge.faults(wrench, contact) == []
        assert judge.faults(wrench, changed(contact, misfit=contact.misfit * 1.001))
        other = Reason.TANGENTIAL if contact.reason == Reason.IMPLAUSIBLE else Reason.IMPLAUSIBLE
        assert judge.faults(wrench, changed(contact, reason=other))
