"""A heatmap that moves through time."""

from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.heatmap import HeatmapError
from contactbench.pipeline.heatmap.contacts import Contacts
from contactbench.pipeline.heatmap.selection import Playback, Selection, selected_heatmap
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.mesh import Probe

N = 400
BANDWIDTH = 0.003


@pytest.fixture(scope="module")
def bench():
    """A probe that is stroked from one end to the other, ever harder."""
    from contactbench.assets import make

    probe = Probe.from_arrays(*make("linear", 1_000), name="linear")
    centroids = probe.vertices[probe.faces].mean(axis=1)
    top = np.flatnonzero((probe.normals[:, 2] > 0.3) & (centroids[:, 2] > 0.1))
    order = top[np.argsort(centroids[top, 0])]
    at = centroids[order[np.arange(N) * len(order) // N]]
    found = Contacts(at, np.full(N, 0.01), np.full(N, 1e-3), np.linspace(1, 9, N), 0.01 * N, {})
    return drawing_of(probe), replace(found, times=0.01 * np.arange(N))


@pytest.fixture(scope="module")
def playback(bench):
    return Playback(*bench, BANDWIDTH)


KINDS = [
    *(("density", normalisation) for normalisation in ("contacts", "seconds", "rate")),
    *(("force", "rate"), ("uncertainty", "seconds"), ("peak", "contacts")),
]


@pytest.mark.parametrize(("quantity", "normalisation"), KINDS)
def test_all_of_it_is_the_heatmap(bench, playback, quantity, normalisation):
    selection = Selection(quantity, normalisation, BANDWIDTH)
    made, frame = selected_heatmap(*bench, selection), playback.frame(selection)
    np.testing.assert_allclose(frame.values, made.values, rtol=1e-12)
    assert (frame.unit, frame.contacts) == (made.unit, made.contacts)
    assert playback.scale(selection).top == pytest.approx(made.scale.top)


@pytest.mark.parametrize(("quantity", "normalisation"), KINDS[:-1])
def test_weighed_by_confidence_it_is_the_heatmap_too(bench, quantity, normalisation):
    found = replace(bench[1], sigmas=np.linspace(1e-3, 3e-3, N), confidences=np.linspace(0.1, 1.0, N))
    playback = Playback(bench[0], found, BANDWIDTH)
    selection = Selection(quantity, normalisation, BANDWIDTH, by_confidence=True)
    made, frame = selected_heatmap(bench[0], found, selection), playback.frame(selection)
    np.testing.assert_allclose(frame.values, made.values, rtol=1e-12)
    assert playback.heatmap(selection).by_confidence
    plain = playback.frame(replace(selection, by_confidence=False))
    assert not np.allclose(frame.values, plain.values, equal_nan=True)


@pytest.mark.parametrize("quantity", ["density", "force", "peak"])
def test_an_unknown_confidence_weighs_nothing(playback, quantity):
    with pytest.raises(HeatmapError, match="weigh"):
        playback.frame(Selection(quantity, bandwidth=BANDWIDTH, by_confidence=True))


def test_a_window_adds_up_and_is_where_the_contacts_are(bench, playback):
    probe, found = bench
    selection = Selection(bandwidth=BANDWIDTH, start=1.0, end=1.5, least_force=3.2)
    inside = (found.moments >= 1.0) & (found.moments <= 1.5) & (found.forces >= 3.2)
    frame = playback.frame(selection)
    assert frame.contacts == inside.sum() > 0
    from contactbench.pipeline.heatmap.heatmap import vertex_areas

    assert 1e6 * vertex_areas(probe) @ np.nan_to_num(frame.values) == pytest.approx(inside.sum())
    seen = probe.vertices[np.isfinite(frame.values), 0]
    assert seen.min() > found.points[inside, 0].min() - 4 * BANDWIDTH
    assert seen.max() < found.points[inside, 0].max() + 4 * BANDWIDTH


def test_a_window_hardly_differs_from_the_heatmap_of_it_alone(bench, playback):
    selection = Selection("force", bandwidth=BANDWIDTH, start=1.0, end=2.0)
    made, frame = selected_heatmap(*bench, selection), playback.frame(selection)
    both = np.isfinite(made.values) & np.isfinite(frame.values)
    assert both.sum() > 0.8 * made.known.sum()
    assert np.abs(made.values - frame.values)[both].max() < 0.25


def test_the_peak_of_a_window_is_the_largest_force_in_it(bench, playback):
    frame = playback.frame(Selection("peak", bandwidth=BANDWIDTH, end=1.0))
    assert np.nanmax(frame.values) == bench[1].forces[100]


def test_nothing_selected_is_all_unknown(playback):
    frame = playback.frame(Selection(start=100.0))
    assert frame.contacts == 0
    assert np.isnan(frame.values).all()
    assert playback.scale(Selection(start=100.0)).top == 0.0


def test_a_moving_window_has_a_scale_of_its_own(playback):
    whole, moving = playback.scale(Selection()).top, playback.scale(Selection(), 0.2).top
    assert 0 < moving <= whole
    parts = [
        playback.frame(Selection(start=t, end=t + 0.2)) for t in np.linspace(0, playback.duration - 0.2, 5)
    ]
    assert max(np.nanpercentile(p.values, 50) for p in parts if p.contacts) < moving * 1.5


def test_the_value_at_a_point_and_how_sure_it_is(bench, playback):
    probe, found = bench
    face = int(
        np.argmin(np.linalg.norm(probe.vertices[probe.faces].mean(axis=1) - found.points[200], axis=1))
    )
    point = probe.vertices[probe.faces[face]].mean(axis=0)
    mean = Selection("force", bandwidth=BANDWIDTH)
    said = playback.at(mean, playback.frame(mean), face, point)
    corner = playback.frame(mean).values[probe.faces[face]]
    assert corner.min() <= said.value <= corner.max()
    assert said.unit == "N"
    assert 0.05 < said.plus_minus < 2.0
    density = Selection(bandwidth=BANDWIDTH)
    said = playback.at(density, playback.frame(density), face, point)
    assert said.plus_minus == pytest.approx(
        said.value, rel=0.3
    )  # one touch without a pause: it may be there or not
    far = int(np.argmin(probe.vertices[probe.faces].mean(axis=1)[:, 2]))
    assert np.isnan(
        playback.at(density, playback.frame(density), far, probe.vertices[probe.faces[far, 0]]).value
    )


def test_more_touches_make_a_density_surer(bench):
    probe, found = bench
    again = replace(
        found,
        points=np.repeat(found.points[:1], 9, axis=0),
        seconds=np.full(9, 0.1),
        sigmas=np.full(9, 1e-3),
        forces=np.full(9, 5.0),
        times=np.arange(9.0),
    )
    playback = Playback(probe, again, BANDWIDTH)
    index = int(np.nanargmax(playback.frame(Selection()).values))
    face = int(np.flatnonzero((probe.faces == index).any(axis=1))[0])
    said = playback.at(Selection(), playback.frame(Selection()), face, probe.vertices[index])
    assert said.plus_minus == pytest.approx(said.value / 3, rel=1e-6)


def test_a_peak_is_as_sure_as_the_sensor(bench):
    probe, found = bench
    playback = Playback(probe, replace(found, noise=WrenchNoise(0.2, 0.01)), BANDWIDTH)
    selection = Selection("peak")
    index = int(np.nanargmax(playback.frame(selection).values))
    face = int(np.flatnonzero((probe.faces == index).any(axis=1))[0])
    said = playback.at(selection, playback.frame(selection), face, probe.vertices[index])
    assert (said.value, said.plus_minus) == (pytest.approx(9.0), pytest.approx(0.2))


def test_a_bandwidth_that_does_not_suit_is_refused(bench):
    with pytest.raises(HeatmapError, match="does not suit"):
        Playback(*bench, 5.0)
