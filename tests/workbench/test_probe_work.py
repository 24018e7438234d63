"""The way from a mesh file to a probe, without a window."""

import os
from dataclasses import replace

import numpy as np
import pytest
from workbench.changes import observed
from workbench.probe_files import bad_meshes, egg

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.preparation.alignment.alignment import from_angles, load_alignment
from contactbench.pipeline.session.recompute import ReplayOutcome, compute, newest_inputs, replay
from contactbench.pipeline.workbench.probe import (
    ProbePlan,
    ProbeWork,
    back_to_mesh,
    by_axes,
    by_flange,
    by_points,
    commit,
    numbers_of,
    trade_of,
)
from contactbench.pipeline.workbench.regions_session import recipe_of, shell_file_of, used_probe

PLAN = ProbePlan(alignment=from_angles([0, 0, 30], [0, 0, 0]), facets=300, engine="fast-simplification")


def used(work, mesh, plan=PLAN):
    preview = work.preview(mesh, plan)
    _, change = work.desk.do(observed(lambda session: commit(session, preview))).result(30)
    return preview, change


def test_a_bad_file_is_told_in_a_sentence_and_changes_nothing(work, tmp_path):
    for file, words in bad_meshes(tmp_path).items():
        with pytest.raises(InputError, match=words) as found:
            work.take(file)
        assert str(found.value).endswith((".", "?"))
    with pytest.raises(InputError, match="no such file"):
        work.take(tmp_path / "none.stl")
    with pytest.raises(InputError, match="folder"):
        work.take(tmp_path)
    assert work.desk.state.count == 1


def test_reading_can_be_stopped(work, tmp_path):
    with pytest.raises(Cancelled):
        work.take(egg(tmp_path), monitor=Monitor(cancelled=lambda: True))


def test_what_was_taken_does_not_change_with_the_file(work, tmp_path):
    file = egg(tmp_path)
    mesh = work.take(file)
    file.write_bytes(b"")
    assert work.preview(mesh, PLAN).done.content.frame == "S"


def test_a_preview_is_what_the_session_computes(work, tmp_path):
    preview, _ = used(work, work.take(egg(tmp_path)))
    desk = work.desk
    result = desk.state.current_results["probe", "probe.ply"]
    assert set(result.action.inputs) == {"mesh", "alignment"}
    assert result.action.parameters == {"facets": 300, "engine": "fast-simplification"}
    assert desk.stale["probe", "probe.ply"] == ()
    assert [each.outcome for each in desk.do(replay).result(60)] == [ReplayOutcome.SAME]
    again = desk.do(
        lambda session: compute(
            session, "probe", "probe.ply", newest_inputs(session.state, "probe"), preview.plan.parameters
        )
    ).result(60)
    assert {name: ref.sha256 for name, ref in again.action.files.items()} == result.outcome
    assert len(used_probe(desk).faces) == 300
    assert shell_file_of(desk).probe.size == pytest.approx(0.07, rel=1e-2)
    assert preview.deviation.shape == (len(preview.placed.probe.vertices),)
    assert 0 < preview.deviation.max() < 1e-3


def test_the_same_again_adds_only_a_result(work, tmp_path):
    mesh = work.take(egg(tmp_path))
    used(work, mesh)
    inputs = len(work.desk.state.inputs)
    used(work, mesh, replace(PLAN, facets=200))
    assert len(work.desk.state.inputs) == inputs
    assert len(work.desk.state.results) == 2


def test_undoing_brings_back_the_probe_before(work, tmp_path):
    desk = work.desk
    _, nothing = used(work, work.take(egg(tmp_path)))
    desk.do(lambda session: session.mark("probe", "probe.ply", "accepted", "it fits")).result(30)
    first = desk.state
    other = replace(PLAN, alignment=from_angles([1, 2, 33], [0, 0, 90]))
    _, back = used(work, work.take(egg(tmp_path, "b.stl", facets=2)), other)
    second = desk.state.newest("probe")
    assert second.content != first.newest("probe").content
    desk.do(back.undo).result(30)
    for kind in ("mesh", "alignment", "probe"):
        assert desk.state.newest(kind).content == first.newest(kind).content
    mark = desk.state.newest("probe").mark
    assert (mark.mark, mark.reason) == ("accepted", "it fits")
    assert desk.stale["probe", "probe.ply"] == ()
    desk.do(nothing.undo).result(30)
    assert recipe_of(desk.state).result is None
    assert used_probe(desk) is None
    desk.do(nothing.redo).result(30)
    desk.do(back.redo).result(30)
    assert desk.state.newest("probe").content == second.content
    assert recipe_of(desk.state).result is not None


def test_a_failure_leaves_the_session_as_it_is(work, tmp_path):
    mesh = work.take(egg(tmp_path))
    used(work, mesh)
    count = work.desk.state.count
    with pytest.raises(InputError, match="close"):
        work.preview(mesh, replace(PLAN, close=("magic",)))
    with pytest.raises(InputError, match="fewer than 4"):
        work.preview(mesh, replace(PLAN, facets=2))
    assert work.desk.state.count == count


def test_reopening_finds_the_mesh_and_the_plan(work, tmp_path):
    assert work.restore() is None
    used(work, work.take(egg(tmp_path)))
    mesh, plan = work.restore()
    assert mesh.file.name == "egg.stl"
    assert plan.parameters == PLAN.parameters
    assert np.allclose(plan.alignment.T_SP, PLAN.alignment.T_SP)
    again, once_more = (work.preview(mesh, plan).done.content.probe for _ in range(2))
    assert again.vertices.tobytes() == once_more.vertices.tobytes()


def test_the_copies_go_when_the_work_ends(desk, tmp_path):
    work = ProbeWork(desk)
    folder = work.take(egg(tmp_path)).file.path.parent
    assert folder.is_dir()
    work.close()
    assert not os.path.lexists(folder)


def test_a_ladder_becomes_a_chart(work, tmp_path):
    told = []
    trade = trade_of(work.ladder(work.take(egg(tmp_path)), PLAN, Monitor(told.append)))
    facets = [point.facets for point in trade.points]
    assert facets == sorted(facets)
    assert facets[-1] == 1280
    assert trade.points[0].error_mm > trade.points[-1].error_mm == 0
    assert trade.advised in facets
    assert all(point.solve_us > 0 for point in trade.points)
    assert told[-1] == 1.0


# ---- where the mesh lies -----------------------------------------------------------------------


def test_picked_places_give_the_mount_back(work, tmp_path):
    mount = from_angles([3, -4, 50], [10, 20, 100])
    picked_S = mount.place(work.take(egg(tmp_path)).original.probe).vertices[[0, 100, 300, 500]]
    picked_P = back_to_mesh(picked_S, mount)
    found = by_points(list(zip(picked_P, picked_S, strict=True)))
    assert np.allclose(found.T_SP, mount.T_SP, atol=1e-9)
    assert numbers_of(found) == pytest.approx((3, -4, 50, 10, 20, 100))
    assert np.array_equal(back_to_mesh(picked_S, None), picked_S)
    with pytest.raises(InputError, match="2 points are picked"):
        by_points([(picked_P[0], picked_S[0])] * 2)


def test_the_shape_puts_the_lowest_point_at_its_height(work, tmp_path):
    probe = work.take(egg(tmp_path)).original.probe
    assert by_axes(probe, 12.0).place(probe).bounds[0, 2] == pytest.approx(0.012)


def test_a_face_is_put_on_the_sensor(work, tmp_path):
    import trimesh

    file = tmp_path / "rod.stl"
    file.write_bytes(trimesh.creation.cylinder(15.0, 80.0).export(file_type="stl"))
    probe = work.take(file).original.probe
    facet = int(np.argmin(probe.normals[:, 2]))
    found = by_flange(probe, facet, None, 0.0, 5.0)
    assert found.place(probe).bounds[:, 2] == pytest.approx([0.005, 0.085])


def test_an_alignment_is_read_from_its_file(tmp_path):
    file = tmp_path / "a.json"
    file.write_text(PLAN.alignment.to_json(), encoding="utf-8")
    assert np.array_equal(load_alignment(file).T_SP, PLAN.alignment.T_SP)
    with pytest.raises(InputError, match="no such file"):
        load_alignment(tmp_path / "none.json")
