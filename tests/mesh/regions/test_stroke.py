"""Brush strokes: what they cover, and that they are one step."""

import math

import numpy as np
import pytest
import trimesh
from mesh.regions.conftest import as_probe, centroids

from contactbench.pipeline.mesh.probe import connected
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
from contactbench.pipeline.mesh.regions.model import RegionChange, RegionModel
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet
from contactbench.pipeline.mesh.regions.selections import Brush
from contactbench.pipeline.mesh.soundness import check_soundness


class Canvas:
    """A mesh with two regions, and its facets as strokes cut them."""

    def __init__(self, graph: FacetGraph, regions: int = 2) -> None:
        self.graph, self.model = graph, RegionModel(RegionSet.empty(graph.facet_count))
        self.model.subscribe(self.follow)
        for _ in range(regions):
            self.model.add()

    def follow(self, change: RegionChange) -> None:
        if change.cut is not None:
            self.graph = FacetGraph(change.cut.put_on(self.graph.probe))

    def draw(self, brush: Brush, rank: int, points: np.ndarray) -> np.ndarray:
        faces, nearest = self.graph.pick(points)
        with self.model.stroke(self.graph, brush, rank) as stroke:
            for face, point in zip(faces.tolist(), nearest, strict=True):
                stroke.extend(face, point)
        return self.model.labels == rank

    def area(self, mask: np.ndarray) -> float:
        return float(self.graph.probe.areas[mask].sum())

    def bytes(self) -> tuple[bytes, ...]:
        probe = self.graph.probe
        return probe.vertices.tobytes(), probe.faces.tobytes(), self.model.labels.tobytes()


def test_a_dab_on_a_sphere_is_a_cap(ball: FacetGraph) -> None:
    canvas = Canvas(ball)
    covered = canvas.draw(Brush(0.02), 1, np.array([[0.0, 0.0, 0.05]]))
    assert canvas.area(covered) == pytest.approx(2 * np.pi * 0.05**2 * (1 - np.cos(0.4)), rel=0.01)
    corners = canvas.graph.probe.vertices[canvas.graph.probe.faces]
    polar = np.arccos(corners[:, :, 2] / np.linalg.norm(corners, axis=2)) * 0.05
    assert polar[covered].max() < 0.0203
    assert polar[~covered].min() > 0.0197


@pytest.mark.parametrize("halved", [0, 3, 5])
@pytest.mark.parametrize("geodesic", [True, False])
def test_what_is_painted_ends_where_the_brush_did_whatever_the_facets(halved: int, geodesic: bool) -> None:
    """On a wall of 1 mm: a dab of 5 mm, a stripe, and a dab over the rim; the far side stays clean."""
    mesh = trimesh.creation.box(extents=(0.06, 0.04, 0.001))
    for _ in range(halved):
        mesh = mesh.subdivide()
    canvas, brush = Canvas(FacetGraph(as_probe(mesh)), 3), Brush(0.0025, geodesic=geodesic)
    dab = canvas.draw(brush, 1, np.array([[-0.02, 0.01, 0.0005]]))
    assert canvas.area(dab) == pytest.approx(np.pi * 0.0025**2, rel=0.01)
    stripe = canvas.draw(brush, 2, np.array([[-0.02, -0.01, 0.0005], [0.02, -0.005, 0.0005]]))
    length = math.hypot(0.04, 0.005)
    assert canvas.area(stripe) == pytest.approx(0.005 * length + np.pi * 0.0025**2, rel=0.01)
    assert (centroids(canvas.graph.probe)[canvas.model.labels > 0, 2] > 0.0004).all()
    canvas.draw(brush, 3, np.array([[0.03, 0.01, 0.0005]]))
    if geodesic:  # unfolded, half a disc on the top and half over the rim, of which 1 mm is the side
        assert canvas.area(canvas.model.labels == 3) == pytest.approx(np.pi * 0.0025**2, rel=0.01)
    probe = canvas.graph.probe
    assert check_soundness(probe.vertices, probe.faces).sound
    assert probe.areas.sum() == pytest.approx(mesh.area, rel=1e-12)


def test_a_fast_stroke_leaves_no_gap_and_stays_on_the_surface(ball: FacetGraph) -> None:
    ends = 0.05 * np.array([[1.0, 0, 0], [0, 1.0, 0]])
    for brush in (Brush(0.005), Brush(0.005, geodesic=False)):
        canvas = Canvas(ball)
        covered = canvas.draw(brush, 1, ends)
        on = centroids(canvas.graph.probe)[covered]
        turn = np.degrees(np.arctan2(on[:, 1], on[:, 0]))
        assert np.abs(on[:, 2]).max() < 0.0055
        assert turn.min() < 0
        assert turn.max() > 90
        assert np.diff(np.sort(turn)).max() < 5  # facets are 4 to 5 degrees wide
        pairs = canvas.graph.pairs[covered[canvas.graph.pairs].all(axis=1)].T
        assert len(np.unique(connected(len(covered), *pairs)[covered])) == 1


def test_many_picks_cover_what_two_cover(ball: FacetGraph) -> None:
    angle = np.radians([0.0, 20, 40, 60])
    points = 0.05 * np.column_stack((np.cos(angle), np.sin(angle), np.zeros(4)))
    few, many = Canvas(ball), Canvas(ball)
    area = few.area(few.draw(Brush(0.01), 1, points[[0, -1]]))
    assert many.area(many.draw(Brush(0.01), 1, points)) == pytest.approx(area, rel=0.01)


def test_picks_that_are_not_joined_leave_a_gap(ball: FacetGraph) -> None:
    faces, points = ball.pick(0.05 * np.array([[1.0, 0, 0], [0, 1.0, 0]]))
    canvas = Canvas(ball)
    with canvas.model.stroke(ball, Brush(0.005), 1) as stroke:
        stroke.extend(int(faces[0]), points[0])
        stroke.extend(int(faces[1]), points[1], joined=False)
    on = centroids(canvas.graph.probe)[canvas.model.labels == 1]
    turn = np.degrees(np.arctan2(on[:, 1], on[:, 0]))
    assert len(on)
    assert not ((turn > 20) & (turn < 70)).any()


def test_protect_and_erase(ball: FacetGraph) -> None:
    canvas = Canvas(ball)
    top = np.array([[0.0, 0.0, 0.05]])
    disc = canvas.area(canvas.draw(Brush(0.01), 1, top))
    ring = canvas.area(canvas.draw(Brush(0.02, protect=True), 2, top))
    assert canvas.area(canvas.model.labels == 1) == pytest.approx(disc)
    canvas.draw(Brush(0.02, erase=True, protect=True), 1, top)
    assert not (canvas.model.labels == 1).any()
    assert canvas.area(canvas.model.labels == 2) == pytest.approx(ring)
    canvas.draw(Brush(0.02), 1, top)
    canvas.draw(Brush(0.01, erase=True), 2, top)
    assert canvas.area(canvas.model.labels == 1) == pytest.approx(ring, rel=0.01)


def test_a_stroke_is_told_as_it_grows_and_is_one_step(ball: FacetGraph) -> None:
    canvas = Canvas(ball)
    told: list[RegionChange] = []
    canvas.model.subscribe(told.append)
    angle = np.radians([0.0, 10, 20])
    covered = canvas.draw(Brush(0.01), 1, 0.05 * np.column_stack((np.cos(angle), np.sin(angle), np.zeros(3))))
    assert [change.cut is None for change in told] == [True, True, True, False]
    assert canvas.model.undo_text == "paint Region 1"
    canvas.model.undo()
    assert canvas.bytes() == Canvas(ball).bytes()
    canvas.model.redo()
    assert (canvas.model.labels == 1).tolist() == covered.tolist()


def test_an_aborted_stroke_was_never_there(ball: FacetGraph) -> None:
    canvas = Canvas(ball)
    canvas.draw(Brush(0.02), 2, np.array([[0.0, 0.01, 0.05]]))
    before, text, model = canvas.bytes(), canvas.model.undo_text, canvas.model
    stroke = model.stroke(canvas.graph, Brush(0.03), 1)
    stroke.extend(0, centroids(canvas.graph.probe)[0])
    far, point = canvas.graph.pick([[0.0, 0.0, 0.05]])
    stroke.extend(int(far[0]), point[0])
    assert canvas.bytes() != before
    stroke.abort()
    assert canvas.bytes() == before
    assert model.undo_text == text
    broken = pytest.raises(RegionError, match="facet -5")
    with broken, model.stroke(canvas.graph, Brush(0.03), 1) as other:
        for face in (0, -5):
            other.extend(face, centroids(canvas.graph.probe)[0])
    assert canvas.bytes() == before


def test_nothing_else_during_a_stroke(ball: FacetGraph) -> None:
    model = Canvas(ball).model
    stroke = model.stroke(ball, Brush(0.01), 1)
    stroke.extend(0, centroids(ball.probe)[0])
    for edit in (model.undo, model.redo, model.add, lambda: model.assign([1], 1), lambda: model.remove(1)):
        with pytest.raises(RegionError, match="a stroke is in progress"):
            edit()
    with pytest.raises(RegionError, match="a stroke is in progress"):
        model.stroke(ball, Brush(0.01), 1)
    stroke.finish()
    for late in (stroke.finish, stroke.abort, lambda: stroke.extend(0, centroids(ball.probe)[0])):
        with pytest.raises(RegionError, match="has ended"):
            late()
    model.add()


def test_a_stroke_of_nothing_is_no_step(ball: FacetGraph) -> None:
    model = Canvas(ball).model
    text = model.undo_text
    model.stroke(ball, Brush(0.01), 1).finish()
    with model.stroke(ball, Brush(0.01, erase=True), 1) as stroke:
        stroke.extend(0, centroids(ball.probe)[0])
    assert model.undo_text == text
    model.add()


def test_strokes_undone_and_redone_give_identical_bytes(cube: FacetGraph, rng: np.random.Generator) -> None:
    canvas = Canvas(cube, 3)
    states = [canvas.bytes()]
    for number in range(16):
        size, straight, protect = rng.uniform(0.001, 0.015), rng.integers(2), rng.integers(2)
        brush = Brush(size, not straight, erase=number % 4 == 3, protect=bool(protect))
        canvas.draw(brush, int(rng.integers(1, 4)), rng.uniform(-0.02, 0.02, (3, 3)))
        if canvas.bytes() != states[-1]:
            states.append(canvas.bytes())
    assert len(states) > 11
    probe = canvas.graph.probe
    assert check_soundness(probe.vertices, probe.faces).sound
    for state in reversed(states[:-1]):
        assert canvas.model.undo()
        assert canvas.bytes() == state
    for state in states[1:]:
        assert canvas.model.redo()
        assert canvas.bytes() == state
    assert not canvas.model.redo()


@pytest.mark.parametrize("radius", [0.0, -1.0, math.nan, math.inf])
def test_a_brush_has_a_radius(radius: float) -> None:
    with pytest.raises(RegionError, match="radius"):
        Brush(radius)


def test_wrong_picks_are_refused(ball: FacetGraph, cube: FacetGraph) -> None:
    model = Canvas(ball).model
    with pytest.raises(RegionError, match="facets, but the regions"):
        model.stroke(cube, Brush(0.01), 1)
    with pytest.raises(RegionError, match="no region of rank 9"):
        model.stroke(ball, Brush(0.01), 9)
    with model.stroke(ball, Brush(0.01), 1) as stroke:
        for face in (-1, ball.facet_count):
            with pytest.raises(RegionError, match="does not exist"):
                stroke.extend(face, [0, 0, 0])
        for point in ([0, 0], [0, 0, math.nan]):
            with pytest.raises(RegionError, match="not a point"):
                stroke.extend(0, point)
