"""Regions at work: colours that follow, tools, steps, and what the session keeps of them."""

import json
import math
import threading

import numpy as np
import pytest
from terminal import invoke
from workbench.region_sessions import CENTRE, RADIUS, ball_shell, desk, folder  # noqa: F401

from contactbench.pipeline.commands.regions import ProbeRegions as CommandSession
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.colours import PLAIN
from contactbench.pipeline.mesh.engines import Cancelled, Monitor
from contactbench.pipeline.mesh.regions.model import RegionModel
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet
from contactbench.pipeline.mesh.regions.selections import Brush
from contactbench.pipeline.mesh.sidecar import load_probe_file, save_probe_file
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.why import RegionsState, regions_state
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.regions import (
    Box,
    Clear,
    Flood,
    Grow,
    Mirror,
    RegionsWork,
    Shrink,
    Smooth,
)
from contactbench.pipeline.workbench.regions_session import (
    REGION_STEPS_FILE,
    apply,
    keep,
    open_work,
    read_region_steps,
    surface_key,
    write_region_steps,
)

TOP = CENTRE + [0, 0, RADIUS]


def rgb(colour: str) -> list[int]:
    return list(bytes.fromhex(colour[1:]))


def paint(work: RegionsWork, at: np.ndarray, rank: int = 1, radius: float = 0.015, **how: bool) -> str | None:
    work.begin(Brush(radius, **how), rank)
    faces, points = work.graph.pick([at])
    work.extend(int(faces[0]), points[0])
    return work.finish()


@pytest.fixture
def work() -> RegionsWork:
    made = RegionsWork(ball_shell())
    made.step(lambda model: model.add("Lens"))
    return made


def consistent(work: RegionsWork) -> None:
    """The colours are those of the labels, however they came to be."""
    table = np.array([rgb(PLAIN), *(rgb(region.colour) for region in work.model.regions)], dtype=np.uint8)
    assert np.array_equal(work.colours, table[work.model.labels])


# ---- painting ----------------------------------------------------------------------------------


def test_colours_follow_every_edit(work):
    paint(work, TOP)
    same = work.colours.base
    assert work.model.labels.any()
    consistent(work)
    for action in (
        lambda model: model.add("Side"),
        lambda model: model.recolour(1, "#123456"),
        lambda model: model.move(1, 2),
        lambda model: model.rename(2, "Window"),
        lambda model: model.remove(1),
    ):
        assert work.step(action)
        consistent(work)
    assert work.colours.base is same, "a view may keep the array until the mesh is cut"
    for _ in range(7):
        assert work.undo()
        consistent(work)
    assert not work.undo()
    while work.redo():
        consistent(work)


def test_a_piece_of_a_stroke_tells_the_facets_that_changed(work):
    told = []
    end = work.subscribe(lambda change, drawing: told.append((change, drawing)))
    work.begin(Brush(0.01), 1)
    faces, points = work.graph.pick([TOP, TOP + [0.02, 0, -0.004]])
    for face, point in zip(faces, points, strict=True):
        changed = work.extend(int(face), point)
        assert np.array_equal(told[-1][0].faces, changed)
        assert told[-1][1], "still drawing"
    assert work.finish() == "paint Lens"
    assert not told[-1][1]
    assert not len(told[-1][0].faces)
    end()
    work.undo()
    assert [change.cut is not None for change, _ in told] == [False, False, True, False]


def test_an_aborted_stroke_leaves_nothing_to_undo(work):
    before = work.model.undo_text
    work.begin(Brush(0.02), 1)
    faces, points = work.graph.pick([TOP])
    work.extend(int(faces[0]), points[0])
    assert work.model.labels.any()
    work.abort()
    assert not work.model.labels.any()
    consistent(work)
    assert work.model.undo_text == before
    assert work.finish() is None


def test_undoing_while_a_stroke_is_drawn_takes_the_stroke_back_first(work):
    work.begin(Brush(0.02), 1)
    faces, points = work.graph.pick([TOP])
    work.extend(int(faces[0]), points[0])
    assert work.undo()
    assert work.model.regions == ()
    assert not work.drawing


def test_a_stroke_without_a_region_is_refused(work):
    with pytest.raises(RegionError):
        work.begin(Brush(0.01), 5)
    assert not work.drawing
    assert len(work.extend(0, TOP)) == 0


def test_a_step_that_changes_nothing_is_none(work):
    assert work.step(lambda model: model.rename(1, "Lens")) is None
    assert work.give(work.finder(Clear(), 1)()) is None
    with pytest.raises(RegionError, match="rename"):
        work.step(lambda model: model.add("Lens"))


def test_rows_hold_areas_and_facets(work):
    paint(work, TOP, radius=0.01)
    work.step(lambda model: model.add("Side"))
    lens, side = work.rows()
    assert (lens.name, side.name, side.facets, side.area) == ("Lens", "Side", 0, 0.0)
    assert lens.facets == int((work.model.labels == 1).sum())
    assert lens.area == pytest.approx(math.pi * 0.01**2, rel=0.35)


def test_what_nothing_can_touch_is_told_facet_by_facet(work):
    paint(work, TOP, radius=0.01)
    assert len(work.untouchable()) == 0
    assert work.step(lambda model: model.set_untouchable(1, True)) == "mark Lens untouchable"
    assert work.rows()[0].untouchable
    assert np.array_equal(work.untouchable(), np.flatnonzero(work.model.labels == 1))
    consistent(work)
    work.undo()
    assert not work.rows()[0].untouchable
    assert len(work.untouchable()) == 0


# ---- tools -------------------------------------------------------------------------------------


def test_protecting_leaves_other_regions(work):
    work.step(lambda model: model.add("Side"))
    paint(work, TOP, rank=2)
    side = work.model.labels == 2
    everything = Box((-1, -1, -1), (1, 1, 1))
    work.give(work.finder(everything, 1)(), protect=True)
    assert np.array_equal(work.model.labels == 2, side)
    assert np.array_equal(work.model.labels == 1, ~side)


@pytest.mark.parametrize("tool", [Grow(0.001), Shrink(0.001), Smooth(1), Mirror((0, 0, 0), (1, 0, 0))])
def test_an_empty_region_has_no_shape(work, tool):
    with pytest.raises(RegionError, match="paint something first"):
        work.finder(tool, 1)()


def test_what_was_found_before_another_change_is_not_used(work):
    found = work.finder(Flood(0, math.pi), 1)()
    paint(work, TOP)
    with pytest.raises(RegionError, match="repeat it"):
        work.give(found)
    with pytest.raises(RegionError, match="No region is chosen"):
        work.finder(Clear(), 0)


def test_tools_look_in_another_thread_while_painting_goes_on(work):
    finder, results = work.finder(Flood(0, math.pi), 1), []
    thread = threading.Thread(target=lambda: results.append(finder()))
    thread.start()
    paint(work, TOP)
    thread.join(20)
    assert results[0].selection.mask.all()


# ---- the session -------------------------------------------------------------------------------


def kept(desk, work):  # noqa: F811
    regions, shell = work.kept(), work.shell
    return desk.do(lambda session: keep(session, regions, shell)).result()


def test_what_was_painted_is_found_again_and_reaches_the_probe(desk):  # noqa: F811
    assert regions_state(desk.state) is RegionsState.NONE
    work = open_work(desk)
    assert kept(desk, work) is None, "there are none, and never were any"
    work.step(lambda model: model.add("Lens"))
    paint(work, TOP)
    assert kept(desk, work) is not None
    assert kept(desk, work) is None, "the very same are not kept twice"
    assert regions_state(desk.state) is RegionsState.WAITING

    again = open_work(desk)
    assert again.notes == ()
    assert np.array_equal(again.probe.vertices, work.probe.vertices)
    assert again.model.regions == work.model.regions
    assert np.array_equal(again.model.labels, work.model.labels)

    key, shares = surface_key(desk.state), []
    record = desk.do(apply(desk, Monitor(shares.append))).result()
    assert regions_state(desk.state) is RegionsState.APPLIED
    assert shares[-1] == 1.0
    assert surface_key(desk.state) == key, "the surface is the same: what can be undone stays"
    probe = load_probe_file(desk.folder / record.action.files["probe.ply"].path).probe
    area = float(work.probe.areas[work.model.labels == 1].sum())
    assert float(probe.areas[probe.region == 1].sum()) == pytest.approx(area, rel=0.03)
    assert len(probe.faces) < 400


def test_removing_all_regions_reaches_the_probe_too(desk):  # noqa: F811
    work = open_work(desk)
    work.step(lambda model: model.add("Lens"))
    paint(work, TOP)
    kept(desk, work)
    desk.do(apply(desk)).result()
    work.step(lambda model: model.remove(1))
    kept(desk, work)
    assert regions_state(desk.state) is RegionsState.WAITING
    record = desk.do(apply(desk)).result()
    assert not load_probe_file(desk.folder / record.action.files["probe.ply"].path).probe.region.any()


def test_the_command_gives_the_same_bytes(desk, folder):  # noqa: F811
    work = open_work(desk)
    work.step(lambda model: model.add("Lens"))
    paint(work, TOP)
    kept(desk, work)
    made = desk.do(apply(desk)).result()
    desk.close()
    given = ["--set", "units=mm", "--set", "facets=300", "--set", "mount=[0,0,80,0,0,0]"]
    ran = invoke("session", "compute", folder, "probe", "probe.ply", *given)
    assert ran.exit_code == 0, ran.output
    with Session.open(folder, write=False) as session:
        again = session.state.current_results["probe", "probe.ply"].action
    assert again.files == made.action.files


def test_painting_by_commands_gives_the_same_regions(work, tmp_path):
    mesh = tmp_path / "shell.ply"
    save_probe_file(ball_shell(), mesh)
    work = RegionsWork(load_probe_file(mesh), None)  # with the file's own rounding
    for command in (
        ["add", "{}", "Lens"],
        ["brush", "{}", "Lens", "--at=0,0,130", "--radius=15"],
        ["box", "{}", "Lens", "--low=-8,-8,100", "--high=8,8,200", "--erase"],
        ["grow", "{}", "Lens", "--distance=2"],
        ["mirror", "{}", "Lens", "--normal=0,0,1", "--point=0,0,80"],
    ):
        ran = invoke("probe", "regions", *(part.format(mesh) for part in command))
        assert ran.exit_code == 0, ran.output
    texts = [work.step(lambda model: model.add("Lens"))]
    paint(work, TOP)
    texts.append(work.model.undo_text)
    box = Box((-0.008, -0.008, 0.1), (0.008, 0.008, 0.2))
    texts.append(work.give(work.finder(box, 1)(), erase=True))
    texts.append(work.give(work.finder(Grow(0.002), 1)()))
    texts.append(work.give(work.finder(Mirror((0, 0, 0.08), (0, 0, 1)), 1)()))
    assert np.array_equal(work.model.labels, CommandSession(mesh).model.labels)
    for text in reversed(texts):  # undone by command as in the window
        ran = invoke("probe", "regions", "undo", mesh, "--json")
        assert json.loads(ran.stdout)["undone"] == text
        assert work.undo()
        assert np.array_equal(work.model.labels, CommandSession(mesh).model.labels)


def test_regions_of_another_surface_are_left_out_with_a_word(desk, tmp_path):  # noqa: F811
    file = tmp_path / "regions.json"
    file.write_text(
        '{"format": "contactbench regions", "version": 1, "mesh": {"sha256": "0", "facets": 3},'
        ' "regions": []}',
        encoding="utf-8",
    )
    desk.do(lambda session: session.add_input(file, "regions", name="regions.json")).result()
    work = open_work(desk)
    assert work.model.regions == ()
    assert "not shown" in work.notes[0]
    assert desk.state.newest("regions") is not None, "they stay in the session"


def test_without_a_probe_there_is_nothing_to_paint_on(tmp_path):
    desk = Desk(Session.create(tmp_path / "empty"))  # noqa: F811
    try:
        assert surface_key(desk.state) is None
        with pytest.raises(InputError, match="probe"):
            open_work(desk)
        with pytest.raises(InputError, match="There is no probe yet"):
            apply(desk)
    finally:
        desk.close()


def test_cancelled_means_nothing_was_recorded(desk):  # noqa: F811
    work = open_work(desk)
    work.step(lambda model: model.add("Lens"))
    paint(work, TOP)
    kept(desk, work)
    count = desk.state.count
    with pytest.raises(Cancelled):
        apply(desk, Monitor(cancelled=lambda: True))
    assert desk.state.count == count


# ---- steps of painting outlive the window --------------------------------------------------------


SHA = "a" * 64


@pytest.fixture
def painted():
    """Regions of 50 facets after six steps, the last two of which were taken back."""
    model = RegionModel(RegionSet.empty(50))
    for name in ("Lens", "Grip"):
        model.add(name)
    model.assign(np.arange(0, 20), 1)
    model.assign(np.arange(10, 30), 2)
    model.move(2, 1)  # renumbers all
    model.remove(1)
    model.undo()
    model.undo()
    return model


def labels(model):
    return model.labels.tolist(), model.regions


def every(model, step):
    """Go as far as it goes, and return what there is on the way."""
    found = []
    while step(model):
        found.append(labels(model))
    return found


def test_kept_and_read_they_undo_and_redo_the_same(painted, tmp_path):
    write_region_steps(tmp_path, painted.steps, SHA)
    again = RegionModel(painted.snapshot())
    again.put_steps(read_region_steps(tmp_path, SHA))
    assert (again.undo_key, again.redo_key) == (painted.undo_key, painted.redo_key)
    for step in (RegionModel.redo, RegionModel.undo, RegionModel.redo):
        expected = every(painted, step)
        assert expected
        assert every(again, step) == expected


def test_with_other_regions_there_are_none(painted, tmp_path):
    write_region_steps(tmp_path, painted.steps, SHA)
    assert read_region_steps(tmp_path, "b" * 64).done == ()
    assert read_region_steps(tmp_path / "elsewhere", SHA).done == ()


@pytest.mark.parametrize("keep", [0.0, 0.3, 0.9])
def test_a_damaged_file_holds_none(painted, tmp_path, keep):
    write_region_steps(tmp_path, painted.steps, SHA)
    file = tmp_path / REGION_STEPS_FILE
    content = file.read_bytes()
    file.write_bytes(content[: round(keep * len(content))])
    assert read_region_steps(tmp_path, SHA).done == ()


def test_steps_of_another_mesh_are_refused(painted):
    small = RegionModel(RegionSet(painted.regions, painted.labels[:25].copy()))
    with pytest.raises(RegionError, match="does not belong"):
        small.put_steps(painted.steps)
    assert not small.undo()


def test_too_many_lose_the_oldest(painted, tmp_path, monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.workbench.regions_session._MOST", 2)
    write_region_steps(tmp_path, painted.steps, SHA)
    assert [each.key for each in read_region_steps(tmp_path, SHA).done] == [
        each.key for each in painted.steps.done[-2:]
    ]
