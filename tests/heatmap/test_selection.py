"""Windows of time and ranges of force."""

from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.heatmap import HeatmapError, heatmap
from contactbench.pipeline.heatmap.contacts import Contacts
from contactbench.pipeline.heatmap.selection import (
    OUTSIDE_FORCE,
    OUTSIDE_TIME,
    Selection,
    in_order,
    selected_heatmap,
    shown,
    windowed,
)
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.mesh import Probe


@pytest.fixture(scope="module")
def probe():
    from contactbench.assets import make

    return Probe.from_arrays(*make("linear", 1_500), name="linear")


def contacts(probe, count=10):
    faces = np.flatnonzero(probe.normals[:, 2] > 0.9)[:count]
    return Contacts(
        probe.vertices[probe.faces[faces]].mean(axis=1),
        np.full(count, 0.1),
        np.full(count, 1e-3),
        np.arange(count, dtype=float),
        2.0,
        {"low_force": 3},
    )


def test_contacts_are_put_in_order_of_time(probe):
    plain = contacts(probe, 4)
    found = in_order(replace(plain, times=np.array([0.3, 0.1, 0.2, 0.0])))
    assert found.moments.tolist() == [0.0, 0.1, 0.2, 0.3]
    assert found.forces.tolist() == [3.0, 1.0, 2.0, 0.0]
    assert np.array_equal(found.points, plain.points[[3, 1, 2, 0]])
    with pytest.raises(HeatmapError, match="have no times"):
        in_order(plain)


def test_a_window_keeps_both_ends_and_says_what_is_outside(probe):
    found = replace(contacts(probe), times=np.arange(10) * 0.1)
    part = windowed(found, Selection(start=0.2, end=0.5, least_force=3.0, most_force=4.0))
    assert part.forces.tolist() == [3.0, 4.0]
    assert part.moments == pytest.approx([0.3, 0.4])
    assert part.left_out == {"low_force": 3, OUTSIDE_TIME: 6, OUTSIDE_FORCE: 2}
    assert part.duration == pytest.approx(0.3)


def test_nothing_chosen_leaves_the_contacts_as_they_are(probe):
    found = replace(contacts(probe), times=np.arange(10) * 0.1)
    assert windowed(found, Selection("force", bandwidth=0.002)) is found


def test_a_window_that_outlasts_the_recording_has_its_length(probe):
    found = replace(contacts(probe), times=np.arange(10) * 0.1)
    assert windowed(found, Selection(start=-1.0, end=50.0)).duration == pytest.approx(2.0)
    made = selected_heatmap(probe, found, Selection(normalisation="rate", start=1e-9, end=50.0))
    assert made.total == pytest.approx(9 / 2.0)


@pytest.mark.parametrize(
    ("selection", "words"),
    [
        (Selection(start=1.5), "no contact from 1.5 s on: widen"),
        (Selection(end=0.0, least_force=5), "no contact from 0 to 0 s with 5 N or more"),
        (Selection(least_force=90, most_force=95), "with 90 to 95 N"),
        (Selection(start=2, end=1), "swap them"),
        (Selection(least_force=2, most_force=1), "swap them"),
        (Selection("error"), "needs the touched points"),
    ],
)
def test_what_cannot_be_shown_is_said(probe, selection, words):
    found = replace(contacts(probe), times=np.arange(10) * 0.1)
    with pytest.raises(HeatmapError, match=words):
        selected_heatmap(probe, found, selection)


def test_unknown_forces_and_uncertainties_are_said(probe):
    found = replace(
        replace(contacts(probe), times=np.arange(10) * 0.1), forces=None, sigmas=np.full(10, np.nan)
    )
    for selection in (Selection("force"), Selection("peak"), Selection(least_force=1)):
        with pytest.raises(HeatmapError, match="forces"):
            selected_heatmap(probe, found, selection)
    with pytest.raises(HeatmapError, match="known uncertainty"):
        selected_heatmap(probe, found, Selection("uncertainty"))


def test_errors_count_where_they_are_known(probe):
    errors = np.where(np.arange(10) < 4, 1e-3, np.nan)
    found = replace(replace(contacts(probe), times=np.arange(10) * 0.1), known_errors=errors)
    values, use = shown(found, Selection("error"))
    assert use.sum() == 4
    assert selected_heatmap(probe, found, Selection("error")).total == pytest.approx(1.0)
    assert np.nanmax(values) == pytest.approx(1e-3)


def test_a_part_is_drawn_like_these_contacts_alone(probe):
    found = replace(contacts(probe), times=np.arange(10) * 0.1)
    part = selected_heatmap(probe, found, Selection("force", bandwidth=0.003, start=0.25, end=0.65))
    alone = heatmap(
        drawing_of(probe),
        found.points[3:7],
        quantity="force",
        bandwidth=0.003,
        values=found.forces[3:7],
        counted="samples",
    )
    assert np.array_equal(part.values, alone.values, equal_nan=True)
    assert part.total == pytest.approx(4.5)


def test_a_sure_contact_counts_more(probe):
    sure = np.array([1.0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0])
    found = replace(contacts(probe), confidences=sure)
    plain = selected_heatmap(probe, found, Selection())
    made = selected_heatmap(probe, found, Selection(by_confidence=True))
    assert (plain.total, made.total) == pytest.approx((10, 1.5))
    assert (made.contacts, made.by_confidence, plain.by_confidence) == (10, True, False)
    assert "weighed by confidence" in made.title
    per = selected_heatmap(probe, found, Selection(normalisation="seconds", by_confidence=True))
    assert per.total == pytest.approx(0.15)
    force = selected_heatmap(probe, found, Selection("force", by_confidence=True))
    assert force.total == pytest.approx(0.5 / 1.5)
    assert windowed(found, Selection(least_force=1)).confidences.tolist() == sure[1:].tolist()


@pytest.mark.parametrize(
    ("sure", "quantity", "words"),
    [
        (None, "density", "have no confidence: locate them again"),
        (np.ones(10), "peak", "choose another quantity"),
        (np.zeros(10), "density", "none of these contacts has any confidence"),
    ],
)
def test_what_cannot_be_weighed_is_said(probe, sure, quantity, words):
    found = replace(contacts(probe), confidences=sure)
    with pytest.raises(HeatmapError, match=words):
        selected_heatmap(probe, found, Selection(quantity, by_confidence=True))
