"""What is in preparation is in the session at every stage, and nothing that is in use hears of it."""

from dataclasses import replace

import pytest
from workbench.changes import observed
from workbench.probe_files import egg

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.session.check import check
from contactbench.pipeline.session.why import statuses
from contactbench.pipeline.steps import Step, StepState
from contactbench.pipeline.workbench.probe import DRAFT, ProbePlan, draft_of, keep_draft, use_draft

PLAN = ProbePlan(
    units="mm",
    close=("fair",),
    alpha=0.4,
    alignment=from_angles([0.1, 0.2, 30.3], [1, 2, 3]),
    facets=300,
    engine="fast-simplification",
)


def keep(desk, mesh, plan):
    return desk.do(lambda session: keep_draft(session, mesh, plan)).result(30)


def probe_status(desk):
    return statuses(desk.state, desk.stale, (), True, {})[Step.PROBE]


def test_a_draft_comes_back_as_it_was_kept(desk, work, tmp_path):
    mesh = work.take(egg(tmp_path))
    assert draft_of(desk.state) is None
    keep(desk, mesh, PLAN)
    found = draft_of(desk.state)
    assert found.name == "egg.stl"
    assert found.plan.parameters == PLAN.parameters
    assert found.plan.alignment.to_json() == PLAN.alignment.to_json()
    again = work.kept(found.mesh, found.plan)
    assert again.sha256 == mesh.sha256
    assert work.kept(found.mesh, found.plan) is again  # not looked at twice
    count = desk.state.count
    assert keep(desk, mesh, PLAN) is None
    assert desk.state.count == count
    keep(desk, mesh, replace(PLAN, facets=200, painted=False))
    assert desk.state.count == count + 1  # the mesh is there already
    assert not draft_of(desk.state).plan.painted
    assert not check(desk.folder).problems


def test_used_it_is_a_draft_no_more_and_undone_it_is_one_again(desk, work, tmp_path):
    mesh = work.take(egg(tmp_path))
    keep(desk, mesh, PLAN)
    assert probe_status(desk).state is StepState.READY
    assert "In preparation" in probe_status(desk).sentence
    preview = work.preview(mesh, PLAN)
    _, change = desk.do(observed(lambda session: use_draft(session, preview))).result(30)
    assert draft_of(desk.state) is None
    assert probe_status(desk).state is StepState.DONE
    keep(desk, mesh, replace(PLAN, facets=100))
    assert probe_status(desk).state is StepState.DONE
    assert "Another one" in probe_status(desk).sentence
    assert desk.stale["probe", "probe.ply"] == ()
    desk.do(change.undo).result(30)
    assert draft_of(desk.state).plan.facets == 300


@pytest.mark.parametrize(
    "value",
    [
        "nonsense",
        {},
        {"mesh": "0" * 64},
        {"mesh": "0" * 64, "plan": {"facets": "many"}},
        {"mesh": "0" * 64, "plan": {"colour": "red"}},
        {"mesh": "0" * 64, "plan": {}, "alignment": "{"},
    ],
)
def test_a_draft_that_makes_no_sense_is_refused_in_words(desk, value):
    desk.do(lambda session: session.set_parameter(DRAFT, value)).result(10)
    with pytest.raises(InputError):
        draft_of(desk.state)


def test_a_draft_whose_mesh_is_gone_says_so(desk, work, tmp_path):
    keep(desk, work.take(egg(tmp_path)), PLAN)
    (file,) = (desk.folder / "raw").iterdir()
    file.unlink()
    with pytest.raises(InputError, match="cannot be read"):
        work.kept(draft_of(desk.state).mesh, ProbePlan())
