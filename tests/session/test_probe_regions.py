"""Regions as an input of a probe: painted on its outer surface, and still there whatever changes."""

import json

import numpy as np
import pytest
from workbench.probe_files import egg

from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.mesh.regions.exchange import encode_json
from contactbench.pipeline.mesh.regions.region import Region, RegionSet
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.recompute import ReplayOutcome, compute, newest_inputs, replay
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.regions_session import keep, regions_on, shell_file_of

USUAL = {"units": "mm", "facets": 300, "engine": "fast-simplification"}


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s", by="ada") as session:
        session.add_input(egg(tmp_path), "mesh")
        yield session


def align(session, tmp_path, *numbers):
    file = tmp_path / "alignment.json"
    file.write_text(from_angles(numbers[:3], numbers[3:]).to_json(), encoding="utf-8")
    session.add_input(file, "alignment")


def made(session, **parameters):
    return compute(
        session, "probe", "probe.ply", newest_inputs(session.state, "probe"), {**USUAL, **parameters}
    )


def story(session, record):
    ref = record.action.files["probe.json"]
    return json.loads((session.folder / ref.path).read_bytes())["history"]


def painted(session, share=0.4):
    """Paint the end that is furthest along z of the mesh."""
    shell = shell_file_of(_Desk(session))
    start = shell.probe
    height = start.vertices[start.faces].mean(axis=1)[:, 2]
    labels = (height > np.quantile(height, 1 - share)).astype(np.int32)
    regions = RegionSet((Region("Lens", "#009e73"),), labels)
    keep(session, regions, shell)
    return regions, shell


class _Desk:
    """What is read of a desk, of a session in this thread."""

    def __init__(self, session):
        self.folder, self.state = session.folder, session.state


def lens_area(session, record):
    return next(
        each["after_mm2"]
        for step in reversed(story(session, record))
        if step["step"] == "simplify"
        for each in step["result"]["carried"]
    )


def test_painted_regions_are_carried_to_fewer_facets(session):
    made(session)
    regions, shell = painted(session)
    area = 1e6 * regions.areas(shell.probe.areas)[0]
    record = made(session)
    assert set(record.action.inputs) == {"mesh", "regions"}
    assert lens_area(session, record) == pytest.approx(area, rel=0.05)
    assert lens_area(session, made(session, facets=150, region_ratio=4.0)) == pytest.approx(area, rel=0.08)


def test_another_alignment_leaves_them_where_they_are_on_the_probe(session, tmp_path):
    align(session, tmp_path, 0, 0, 30, 0, 0, 0)
    made(session)
    regions, _ = painted(session)
    align(session, tmp_path, 5, -3, 40, 180, 20, 0)  # upside down, so a place in S would be another end
    desk = _Desk(session)
    moved, carried = regions_on(desk, shell_file_of(desk))
    assert carried == ()
    assert np.array_equal(moved.labels, regions.labels)
    steps = [step["step"] for step in story(session, made(session))]
    assert steps == ["import", "shell", "align", "region", "simplify"]


def test_another_mesh_of_the_same_probe_takes_them_over(session, tmp_path):
    made(session)
    regions, shell = painted(session)
    session.add_input(egg(tmp_path, "finer.stl", facets=4), "mesh")
    record = made(session)
    area = 1e6 * regions.areas(shell.probe.areas)[0]
    assert lens_area(session, record) == pytest.approx(area, rel=0.06)
    region = next(step for step in story(session, record) if step["step"] == "region")
    assert region["result"]["carried"][0]["name"] == "Lens"


def test_a_file_alone_is_for_its_own_surface_only(session, tmp_path):
    made(session)
    regions, shell = painted(session)
    file = tmp_path / "regions.json"
    file.write_bytes(encode_json(regions, shell.probe))
    session.add_input(file, "regions")
    made(session)
    align(session, tmp_path, 0, 0, 30, 0, 0, 0)
    with pytest.raises(SessionError, match="companion of the file"):
        made(session)
    assert len(session.state.results) == 2


def test_regions_of_another_thing_are_refused(session, tmp_path):
    made(session)
    painted(session)
    session.add_input(egg(tmp_path, "far.stl", scale=3.0), "mesh")
    with pytest.raises(SessionError, match="none of the regions"):
        made(session)
    inputs = newest_inputs(session.state, "probe", {"regions": ""})
    assert set(compute(session, "probe", "probe.ply", inputs, USUAL).action.inputs) == {"mesh"}


def test_what_is_remembered_gives_the_same_bytes_as_what_is_computed_anew(session, tmp_path):
    align(session, tmp_path, 0, 0, 30, 0, 90, 0)
    made(session)
    painted(session)
    made(session, facets=200, region_ratio=3.0)
    assert [each.outcome for each in replay(session)] == [ReplayOutcome.SAME] * 2


def test_a_probe_tells_how_far_it_is_and_can_be_stopped(session):
    told = []
    inputs = newest_inputs(session.state, "probe")
    with pytest.raises(Cancelled):
        compute(
            session,
            "probe",
            "p.ply",
            inputs,
            {**USUAL, "alpha": 5.0},
            monitor=Monitor(told.append, lambda: len(told) > 1),
        )
    assert session.state.results == ()
    compute(session, "probe", "p.ply", inputs, USUAL, monitor=Monitor(told.append))
    assert told[-1] == 1.0


def test_earlier_poses_are_taken_only_when_they_are_named(session, tmp_path):
    (tmp_path / "a.mcap").write_bytes(b"x")
    session.add_input(tmp_path / "a.mcap", "recording")
    session.add_result("captures", "poses.csv", {"poses.csv": b"t"}, {}, {})
    assert set(newest_inputs(session.state, "captures")) == {"recording"}
    named = newest_inputs(session.state, "captures", {"earlier": "poses.csv"})
    assert named["earlier"] == session.state.results[0].content
    assert set(newest_inputs(session.state, "captures", {"earlier": ""})) == {"recording"}
    with pytest.raises(SessionError, match="no earlier called"):
        newest_inputs(session.state, "captures", {"earlier": "none.csv"})
    with pytest.raises(SessionError, match="recording, earlier"):
        newest_inputs(session.state, "captures", {"later": "poses.csv"})


def test_desk_and_session_agree_on_the_surface(session):
    made(session)
    folder = session.folder
    session.close()
    desk = Desk(Session.open(folder, by="ada"))
    try:
        shell = shell_file_of(desk)
        regions = RegionSet((Region("Tip", "#d55e00"),), np.ones(len(shell.probe.faces), dtype=np.int32))
        record = desk.do(lambda session: keep(session, regions, shell)).result(30)
        assert set(record.action.companions) == {"painted.ply", "painted.json"}
        assert regions_on(desk, shell)[0].regions == regions.regions
    finally:
        desk.close()
