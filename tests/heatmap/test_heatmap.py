"""Contacts are spread along the surface, and what they add up to stays."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from contactbench.assets import make
from contactbench.pipeline.colour_ramp import ColourScale, colour_ramp
from contactbench.pipeline.heatmap import HeatmapError, heatmap
from contactbench.pipeline.heatmap.heatmap import (
    NO_DATA,
    REACH,
    SMALLEST_BANDWIDTH,
    colours,
    default_bandwidth,
    vertex_areas,
)
from contactbench.pipeline.mesh import Probe


@pytest.fixture(scope="module")
def probe():
    return Probe.from_arrays(*make("t-shape", 3_000), name="t-shape")


@pytest.fixture(scope="module")
def plate():
    """A thin plate, 60 x 60 x 1 mm, with edges of 1 mm on both faces."""
    n = 61
    x, y = np.meshgrid(np.linspace(-0.03, 0.03, n), np.linspace(-0.03, 0.03, n), indexing="ij")
    top = np.column_stack([x.ravel(), y.ravel(), np.zeros(n * n)])
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    up = np.vstack([np.column_stack([a, a + n, a + n + 1]), np.column_stack([a, a + n + 1, a + 1])])
    down = up[:, ::-1] + n * n
    edge = [
        *range(0, n * n, n),
        *range(n * n - n + 1, n * n),
        *range(n * n - n - 1, n - 1, -n),
        *range(n - 1, 0, -1),
    ]
    edge = list(dict.fromkeys(edge))
    b = np.array(edge)
    c = np.roll(b, -1)
    rim = np.vstack([np.column_stack([b, b + n * n, c]), np.column_stack([c, b + n * n, c + n * n])])
    bottom = top - [0, 0, 0.001]
    return Probe.from_arrays(np.vstack([top, bottom]), np.vstack([up, down, rim]).astype(np.int32))


def touched(probe, count, seed=0):
    rng = np.random.default_rng(seed)
    faces = rng.choice(len(probe.faces), count, p=probe.areas / probe.areas.sum())
    shares = rng.dirichlet(np.ones(3), count)
    return np.einsum("ij,ijk->ik", shares, probe.vertices[probe.faces[faces]])


def integral(made):
    return float(np.nansum(made.values * 1e6 * vertex_areas(made.probe)))


@pytest.mark.parametrize("bandwidth", [0.001, 0.003, 0.02])
def test_a_density_adds_up_to_the_number_of_contacts(probe, bandwidth):
    made = heatmap(probe, touched(probe, 500), bandwidth=bandwidth)
    assert integral(made) == pytest.approx(500, rel=1e-9)
    assert made.unit == "1/mm²"
    assert made.total == 500


def test_cells_numbered_by_sorting_are_those_numbered_by_a_table(probe, monkeypatch):
    at = touched(probe, 500)
    few = heatmap(probe, at, bandwidth=0.003)
    monkeypatch.setattr(import_module("contactbench.pipeline.heatmap.heatmap"), "_MOST_PLACES", 0)
    np.testing.assert_array_equal(heatmap(probe, at, bandwidth=0.003).values, few.values)


def test_a_density_adds_up_to_the_seconds_or_the_contacts_per_second(probe):
    points, seconds = touched(probe, 200), np.linspace(0.001, 0.01, 200)
    held = heatmap(probe, points, seconds, bandwidth=0.003, normalisation="seconds")
    assert integral(held) == pytest.approx(seconds.sum(), rel=1e-9)
    assert held.unit == "s/mm²"
    rate = heatmap(probe, points, bandwidth=0.003, normalisation="rate", duration=4.0)
    assert integral(rate) == pytest.approx(50, rel=1e-9)
    assert rate.unit == "1/(mm²·s)"


def test_one_contact_makes_a_gaussian_of_the_stated_bandwidth(plate):
    made = heatmap(plate, [[0.0, 0.0, 0.0]], bandwidth=0.004)
    away = np.linalg.norm(plate.vertices[:, :2], axis=1)
    top = (plate.vertices[:, 2] == 0) & made.known
    # Cut off at three bandwidths.
    expected = np.exp(-0.5 * (away[top] / 0.004) ** 2) / (2 * np.pi * 16) / 0.98889
    assert made.values[top] == pytest.approx(expected, rel=0.02)
    assert away[top].max() <= 0.012 * 1.001
    assert made.facts()["covered_mm2"] == pytest.approx(np.pi * 12**2, rel=0.1)
    assert (away[(plate.vertices[:, 2] == 0) & ~made.known] > 0.012 * 0.999).all()


def test_nothing_goes_through_a_thin_wall(plate):
    made = heatmap(plate, [[0.001, 0.002, 0.0], [0.001, 0.002, -0.001]], bandwidth=0.004)
    top = heatmap(plate, [[0.001, 0.002, 0.0]], bandwidth=0.004)
    below = plate.vertices[:, 2] < -0.0005
    assert not top.known[below].any()
    assert made.values[~below] == pytest.approx(top.values[~below], nan_ok=True)


def test_many_contacts_in_one_cell_keep_the_width(plate):
    points = np.column_stack([np.random.default_rng(3).normal(0, 0.003, (20_000, 2)), np.zeros(20_000)])
    made = heatmap(plate, points, bandwidth=0.004)
    top = (plate.vertices[:, 2] == 0) & made.known
    spread = np.average(plate.vertices[top, :2] ** 2, axis=0, weights=made.values[top])
    # 9 mm² of the contacts, 16 mm² less the tails of the bell, 1 or 2 % of sharing.
    assert spread * 1e6 == pytest.approx(9 + 16 * 0.95, rel=0.03)


def test_mean_and_peak_of_the_force(plate):
    points = [[-0.015, 0, 0], [-0.015, 0, 0], [0.015, 0, 0]]
    forces = [4.0, 8.0, 20.0]
    mean = heatmap(plate, points, None, "force", 0.002, values=forces)
    peak = heatmap(plate, points, None, "peak", 0.002, values=forces)
    left = np.linalg.norm(plate.vertices - [-0.015, 0, 0], axis=1) < 0.0019
    left &= plate.vertices[:, 2] == 0
    assert mean.values[left] == pytest.approx(6.0)
    assert peak.values[left] == pytest.approx(8.0)
    assert (mean.largest, peak.largest) == pytest.approx((20.0, 20.0))
    assert np.nanmin(mean.values) == pytest.approx(6.0)
    assert not mean.known[np.linalg.norm(plate.vertices, axis=1) < 0.005].any()
    assert mean.unit == "N"
    assert mean.total == pytest.approx(32 / 3)


def test_errors_are_shown_in_mm(probe):
    points = touched(probe, 50)
    made = heatmap(probe, points, None, "error", 0.003, values=np.full(50, 0.0012))
    assert made.values[made.known] == pytest.approx(1.2)
    assert made.unit == "mm"


def test_the_same_contacts_give_the_same_bits_whatever_their_order(probe):
    points = touched(probe, 300)
    first, second = heatmap(probe, points, bandwidth=0.003), heatmap(probe, points[::-1], bandwidth=0.003)
    assert first.values == pytest.approx(second.values, rel=1e-9, nan_ok=True)
    again = heatmap(probe, points, bandwidth=0.003)
    assert first.values.tobytes() == again.values.tobytes()


def test_a_mesh_too_coarse_for_the_bandwidth_is_said():
    coarse = Probe.from_arrays(*make("linear", 300))
    assert "longer than the bandwidth" in heatmap(coarse, touched(coarse, 5), bandwidth=0.0015).notes[0]


def test_the_default_bandwidth_follows_the_uncertainty():
    assert default_bandwidth() == 0.0015
    assert default_bandwidth([0.0003, 0.0004, np.nan]) == 0.0015
    assert default_bandwidth([0.002, 0.003, 0.004, np.nan]) == 0.003


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"points": np.empty((0, 3))}, "no contact"),
        ({"points": [[0, 0, np.nan]]}, "finite"),
        ({"points": [0.0, 0, 0]}, "shape"),
        ({"weights": [1.0, 2.0]}, "1 finite"),
        ({"weights": [-1.0]}, "negative"),
        ({"weights": [0.0]}, "above 0"),
        ({"quantity": "force"}, "values"),
        ({"quantity": "heat"}, "there is no heatmap"),
        ({"bandwidth": 2.0}, "bandwidth"),
        ({"bandwidth": float("nan")}, "bandwidth"),
        ({"normalisation": "rate"}, "duration"),
    ],
)
def test_what_cannot_be_drawn_is_refused(probe, change, words):
    arguments = {"points": probe.vertices[:1], "bandwidth": 0.002} | change
    with pytest.raises(HeatmapError, match=words):
        heatmap(probe, **arguments)


@pytest.mark.parametrize("quantity", ["density", "force"])
def test_strays_do_not_swallow_the_colours_and_contacts_are_counted_where_they_lie(plate, quantity):
    rng = np.random.default_rng(5)
    patch = np.column_stack([rng.normal(0.0, 0.003, (20_000, 2)), np.zeros(20_000)])
    strays = np.column_stack([rng.uniform(-0.029, 0.029, (50, 2)), np.zeros(50)])
    forces = np.append(rng.normal(5.0, 0.2, 20_000) + 200.0 * np.abs(patch[:, 0]), np.full(50, 0.1))
    points = np.vstack([patch, strays])
    with_strays, without = (
        heatmap(plate, points[:n], quantity=quantity, values=None if quantity == "density" else forces[:n])
        for n in (len(points), len(patch))
    )
    assert with_strays.scale.top == pytest.approx(without.scale.top, rel=0.03)
    nearest = np.argmin(np.linalg.norm(plate.vertices[:, None, :2] - points[None, ::20, :2], axis=2), axis=0)
    below = (with_strays.values[nearest] <= with_strays.scale.top).mean()  # counted one by one, without bells
    assert below == pytest.approx(0.95, abs=0.04) or with_strays.scale.top == with_strays.largest
    assert (
        np.unique(
            np.digitize(with_strays.scale.places(with_strays.values[nearest]), np.linspace(0, 1, 9))
        ).size
        >= 4
    )


def test_logarithmic_colours_show_one_contact_beside_thousands_and_none_where_there_is_none(plate):
    rng = np.random.default_rng(5)
    points = np.column_stack([rng.normal(0.0, 0.002, (3_000, 2)), np.zeros(3_000)])
    points[0] = 0.022, 0.022, 0.0
    made = replace(heatmap(plate, points), logarithmic=True)
    square = ((plate.vertices[:, None, :2] - points[None, :, :2]) ** 2).sum(axis=2) / SMALLEST_BANDWIDTH**2
    bells = np.where(square < REACH**2, np.exp(-0.5 * square), 0.0).sum(axis=1) / (2 * np.pi * 1.5**2)
    found, alone = colours(made), np.argmin(square[:, 0])
    away = np.sqrt(square.min(axis=1))  # of each vertex from the nearest contact: counted one by one
    assert (found[away > REACH + 0.2] == NO_DATA).all()
    assert (
        np.abs(found[(away < REACH - 0.2) & (plate.vertices[:, 2] == 0)] - NO_DATA).max(axis=1) > 0.05
    ).all()
    scale = made.scale
    assert (scale.top, scale.low) == (replace(made, logarithmic=False).scale.top, np.nanmin(made.values))
    share = np.log(bells[alone] / scale.low) / np.log(scale.top / scale.low)
    table = colour_ramp(1001)
    np.testing.assert_allclose(found[alone], table[round(1000 * (0.12 + 0.88 * share))], atol=0.02)
    assert np.abs(colours(replace(made, logarithmic=False))[alone] - NO_DATA).max() < 0.02  # that is why
    assert scale.ticks() == [10.0**power for power in range(-3, 4) if scale.low <= 10.0**power <= scale.top]
    assert ColourScale(9.0, 0.9, True).ticks() == pytest.approx([1.0, 2.0, 5.0])
