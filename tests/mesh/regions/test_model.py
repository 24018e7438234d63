"""Edits, undo and redo, against plain sets of facets."""

import copy
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
from contactbench.pipeline.mesh.regions.model import RegionModel
from contactbench.pipeline.mesh.regions.region import Region, RegionError, RegionSet
from contactbench.pipeline.mesh.regions.selections import Selection

FACETS = 60
GRAPH = FacetGraph(
    Probe.from_arrays(
        *trimesh.creation.cylinder(radius=0.02, height=0.05, sections=15).triangles.reshape(1, -1, 3),
        np.arange(3 * FACETS).reshape(-1, 3),
    )
)


def model_of(*labels: int) -> RegionModel:
    names = [Region(name, "#000000") for name in "abc"[: max(labels, default=0)]]
    return RegionModel(RegionSet(tuple(names), np.array(labels, dtype=np.int32)))


class AgainstPlainSets(RuleBasedStateMachine):
    """The model does what a list of (name, colour, set of facets) does; history is a list of copies of it."""

    @initialize(limit=st.sampled_from([None, 3]))
    def start(self, limit: int | None) -> None:
        self.limit = limit
        self.model = RegionModel(RegionSet.empty(FACETS), undo_limit=limit)
        self.regions: list[tuple[str, str, set[int]]] = []
        self.past: list[Any] = []
        self.future: list[Any] = []
        self.before: Any = None

    def remember(self) -> None:
        self.before = copy.deepcopy(self.regions)

    def commit(self) -> None:
        if self.before != self.regions:
            self.past.append(self.before)
            if self.limit is not None:
                self.past = self.past[-self.limit :]
            self.future.clear()

    def pick(self, data: Any) -> int | None:
        return data.draw(st.integers(0, len(self.regions) - 1)) if self.regions else None

    @rule(number=st.integers(0, 9))
    def add(self, number: int) -> None:
        name = f"r{number}"
        if any(name == known for known, _, _ in self.regions):
            with pytest.raises(RegionError, match="two regions"):
                self.model.add(name)
            return
        self.remember()
        rank = self.model.add(name, "#abcdef")
        self.regions.append((name, "#abcdef", set()))
        assert rank == len(self.regions)
        self.commit()

    @rule(data=st.data())
    def remove(self, data: Any) -> None:
        at = self.pick(data)
        if at is not None:
            self.remember()
            self.model.remove(at + 1)
            del self.regions[at]
            self.commit()

    @rule(data=st.data(), colour=st.sampled_from(["#000000", "#ffffff"]))
    def recolour(self, data: Any, colour: str) -> None:
        at = self.pick(data)
        if at is not None:
            self.remember()
            self.model.recolour(at + 1, colour)
            self.regions[at] = (self.regions[at][0], colour, self.regions[at][2])
            self.commit()

    @rule(data=st.data())
    def rename(self, data: Any) -> None:
        at = self.pick(data)
        if at is not None:
            self.remember()
            name = f"{self.regions[at][0]}'"
            if name in [known for known, _, _ in self.regions] or len(name) > 60:
                return
            self.model.rename(at + 1, name)
            self.regions[at] = (name, *self.regions[at][1:])
            self.commit()

    @rule(data=st.data())
    def reorder(self, data: Any) -> None:
        order = data.draw(st.permutations(range(len(self.regions))))
        self.remember()
        self.model.reorder([at + 1 for at in order])
        self.regions = [self.regions[at] for at in order]
        self.commit()

    @rule(data=st.data(), faces=st.sets(st.integers(0, FACETS - 1)), protect=st.booleans())
    def paint(self, data: Any, faces: set[int], protect: bool) -> None:
        at = self.pick(data)
        if at is None:
            return
        self.remember()
        changed = self.model.assign(sorted(faces), at + 1, protect=protect)
        others = set().union(*(own for i, (_, _, own) in enumerate(self.regions) if i != at))
        gained = faces - others if protect else faces
        assert changed.tolist() == sorted(gained - self.regions[at][2])
        for i, (_, _, own) in enumerate(self.regions):
            own.difference_update(gained if i != at else set())
        self.regions[at][2].update(gained)
        self.commit()

    @rule(faces=st.sets(st.integers(0, FACETS - 1)))
    def erase(self, faces: set[int]) -> None:
        self.remember()
        self.model.assign(np.array(sorted(faces), dtype=np.int64), 0)
        for _, _, own in self.regions:
            own.difference_update(faces)
        self.commit()

    @rule(data=st.data(), faces=st.sets(st.integers(0, FACETS - 1)))
    def reshape(self, data: Any, faces: set[int]) -> None:
        at = self.pick(data)
        if at is None:
            return
        self.remember()
        mask = np.zeros(FACETS, dtype=bool)
        mask[sorted(faces)] = True
        Selection.whole(GRAPH, mask).give(self.model, at + 1, "reshape", protect=True, text="reshape")
        others = set().union(*(own for i, (_, _, own) in enumerate(self.regions) if i != at))
        self.regions[at][2].clear()
        self.regions[at][2].update(faces - others)
        self.commit()

    @rule(labels=st.lists(st.integers(0, 2), min_size=FACETS, max_size=FACETS))
    def import_all(self, labels: list[int]) -> None:
        self.remember()
        names = (Region("one", "#111111"), Region("two", "#222222"))
        self.model.replace_all(RegionSet(names, np.array(labels, dtype=np.int32)))
        self.regions = [
            (region.name, region.colour, {f for f, label in enumerate(labels) if label == rank})
            for rank, region in enumerate(names, 1)
        ]
        self.commit()

    @rule()
    def undo(self) -> None:
        assert self.model.undo() == bool(self.past)
        if self.past:
            self.future.append(copy.deepcopy(self.regions))
            self.regions = self.past.pop()

    @rule()
    def redo(self) -> None:
        assert self.model.redo() == bool(self.future)
        if self.future:
            self.past.append(copy.deepcopy(self.regions))
            self.regions = self.future.pop()

    @invariant()
    def same(self) -> None:
        if not hasattr(self, "model"):
            return
        assert [(r.name, r.colour) for r in self.model.regions] == [(n, c) for n, c, _ in self.regions]
        expected = np.zeros(FACETS, dtype=np.int32)
        for rank, (_, _, own) in enumerate(self.regions, 1):
            expected[sorted(own)] = rank
        assert self.model.labels.tobytes() == expected.tobytes()
        assert (self.model.undo_text is None) == (not self.past)


TestAgainstPlainSets = AgainstPlainSets.TestCase
TestAgainstPlainSets.settings = settings(max_examples=60, stateful_step_count=40, deadline=None)


def test_views_are_told_what_changed() -> None:
    model = model_of(0, 0, 1, 2)
    told: list[Any] = []
    stop = model.subscribe(told.append)
    model.assign([0, 2], 1)
    model.rename(1, "z")
    model.reorder([2, 1])
    assert [None if t.faces is None else t.faces.tolist() for t in told] == [[0], [], None]
    assert [t.listed for t in told] == [False, True, True]
    model.undo()
    assert told[-1].faces is None
    stop()
    model.undo()
    assert len(told) == 4


def test_nothing_changed_is_no_step() -> None:
    model = model_of(1, 1, 0)
    told: list[Any] = []
    model.subscribe(told.append)
    model.assign([0, 1], 1)
    model.assign([], 1)
    model.recolour(1, "#000000")
    model.reorder([1])
    model.replace_all(model.snapshot())
    assert model.undo_text is None
    assert told == []


def test_move_shifts_those_between() -> None:
    model = model_of(1, 2, 3)
    model.move(3, 1)
    assert [region.name for region in model.regions] == ["c", "a", "b"]
    assert model.labels.tolist() == [2, 3, 1]
    model.move(1, 99)
    assert [region.name for region in model.regions] == ["a", "b", "c"]


def test_labels_cannot_be_written() -> None:
    model = model_of(1, 0)
    with pytest.raises(ValueError, match="read-only"):
        model.labels[0] = 0
    snapshot = model.snapshot()
    model.assign([0], 0)
    assert snapshot.labels.tolist() == [1, 0]


def test_a_new_step_forgets_what_was_undone() -> None:
    model = model_of(1, 0)
    model.assign([0], 0)
    model.undo()
    model.assign([1], 1)
    assert not model.redo()


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda m: m.assign([0], 3), "no region of rank 3"),
        (lambda m: m.assign([5], 1), "facet 5 does not exist"),
        (lambda m: m.assign([-1], 1), "facet -1 does not exist"),
        (lambda m: m.assign([0.5], 1), "give their numbers"),
        (lambda m: m.assign(np.ones(3, dtype=bool), 1), "one bool per facet"),
        (lambda m: m.remove(0), "no region of rank 0"),
        (lambda m: m.rename(1, "b"), "two regions are called 'b'"),
        (lambda m: m.recolour(1, "red"), "#rrggbb"),
        (lambda m: m.reorder([1]), "is not an order of 2 regions"),
        (lambda m: m.reorder([1, 1]), "is not an order of 2 regions"),
        (lambda m: m.replace_all(RegionSet.empty(4)), "for a mesh of 4 facets, this one has 5"),
    ],
)
def test_impossible_edits_change_nothing(edit: Any, message: str) -> None:
    model = model_of(0, 1, 2, 0, 0)
    before = model.snapshot()
    with pytest.raises(RegionError, match=message):
        edit(model)
    assert model.regions == before.regions
    assert model.labels.tobytes() == before.labels.tobytes()
    assert model.undo_text is None


def test_there_are_at_most_255_regions() -> None:
    model = RegionModel(RegionSet.empty(1))
    for _ in range(255):
        model.add()
    with pytest.raises(RegionError, match="more than 255"):
        model.add()


def test_a_mark_is_one_step_and_moves_with_its_region() -> None:
    model = model_of(0, 1, 2)
    told: list[Any] = []
    model.subscribe(told.append)
    model.set_untouchable(2, True)
    model.set_untouchable(2, True)  # changes nothing
    assert [(t.faces.tolist(), t.listed) for t in told] == [([], True)]
    assert model.undo_text == "mark b untouchable"
    assert model.snapshot().untouchable == (2,)
    model.reorder([2, 1])
    assert model.snapshot().untouchable == (1,)
    model.undo()
    model.undo()
    assert model.snapshot().untouchable == ()
    assert model.undo_text is None
    model.redo()
    assert model.snapshot().untouchable == (2,)
    with pytest.raises(RegionError, match="rank 3"):
        model.set_untouchable(3, True)
