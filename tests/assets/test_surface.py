import numpy as np
import pytest

from contactbench.assets import PROBE_NAMES, surface


@pytest.fixture(params=PROBE_NAMES)
def probe(request):
    return surface(request.param)


def grid(seed, n=4_000):
    rng = np.random.default_rng(seed)
    return rng.uniform(0, 2 * np.pi, n), rng.uniform(0.002, 0.998, n)


def unit_cross(a, b):
    cross = np.cross(a, b)
    return cross / np.linalg.norm(cross, axis=1, keepdims=True)


def test_normals_agree_with_central_differences_of_points(probe):
    phi, t = grid(1)
    h = 1e-6
    along_phi = probe.points(phi + h, t) - probe.points(phi - h, t)
    along_t = probe.points(phi, t + h) - probe.points(phi, t - h)
    # Where the chart is nearly singular the difference quotient, not the normal, is imprecise.
    sound = np.linalg.norm(np.cross(along_phi, along_t), axis=1) > (2 * h) ** 2 * 1e-6
    assert sound.mean() > 0.97
    error = np.linalg.norm(unit_cross(along_phi, along_t) - probe.normals(phi, t), axis=1)
    assert error[sound].max() < 1e-5


def test_second_derivatives_agree_with_differences_of_the_first(probe):
    phi, t = grid(2, 1000)
    h = 1e-6
    jet, scale = probe.jet(phi, t), 1.0
    right, left = probe.jet(phi + h, t), probe.jet(phi - h, t)
    after, before = probe.jet(phi, t + h), probe.jet(phi, t - h)
    for exact, difference in (
        (jet.phi_phi, right.phi - left.phi),
        (jet.phi_t, right.t - left.t),
        (jet.phi_t, after.phi - before.phi),
        (jet.tt, after.t - before.t),
    ):
        scale = np.abs(exact).max()
        # The profile's third derivative jumps at its knots, so the largest errors are first order in h.
        assert np.abs(exact - difference / (2 * h)).max() < 1e-4 * scale


def test_normals_are_unit_and_continuous_across_both_ends(probe):
    phi = np.linspace(0, 2 * np.pi, 721)
    for end, near in ((0.0, 1e-7), (1.0, 1 - 1e-7)):
        at, beside = probe.normals(phi, end), probe.normals(phi, near)
        assert np.allclose(np.linalg.norm(at, axis=1), 1)
        assert np.abs(at - beside).max() < 1e-5
    assert np.array_equal(probe.normals(0.3, 0.0), [[0, 0, -1]])


def test_normals_turn_gradually_everywhere(probe):
    """C1: over a hundredth of a millimetre no normal turns more than a 0.8 mm rounding would turn it."""
    points, normals, phi, t = probe.sample(4_000, np.random.default_rng(3))
    jet = probe.jet(phi, t)
    step_t = 1e-5 / np.linalg.norm(jet.t, axis=1)
    # Near the segment's ends one step in phi may be a long way round; half a degree is plenty there.
    step_phi = np.minimum(1e-5 / np.maximum(np.linalg.norm(jet.phi, axis=1), 1e-9), 0.01)
    for other in (probe.normals(phi, np.clip(t + step_t, 0, 1)), probe.normals(phi + step_phi, t)):
        assert np.linalg.norm(other - normals, axis=1).max() < 1e-5 / 0.8e-3
    assert points.shape == (4_000, 3)


def test_flange_rim_curvatures_are_those_of_a_cylinder():
    probe = surface("linear")
    _, _, phi, t = probe.sample(
        100, np.random.default_rng(4), where=lambda p, n: (np.abs(p[:, 2] - 4e-3) < 1e-4) & (n[:, 2] < 0.1)
    )
    assert np.allclose(probe.principal_curvatures(phi, t), [0.0, 1 / 25e-3], atol=1e-6)


def test_no_rounding_is_tighter_than_a_millimetre(probe):
    phi, t = np.meshgrid(np.linspace(0, np.pi / 2, 91), np.linspace(0, 1, 1001))
    assert np.abs(probe.principal_curvatures(phi.ravel(), t.ravel())).max() < 1 / 1e-3


def test_samples_are_on_the_surface_and_uniform_by_area(probe):
    points, normals, phi, t = probe.sample(20_000, np.random.default_rng(5))
    assert np.array_equal(points, probe.points(phi, t))
    assert np.array_equal(normals, probe.normals(phi, t))
    assert np.abs(probe.project(points[:1000])[2]).max() < 1e-12
    # The closed base is a disc: 22 mm of its radius are flat, and the share inside it is known.
    base = (normals[:, 2] < -0.99) & (points[:, 2] < 1e-4)
    radius = np.hypot(*points[base, :2].T)
    inside, half = (radius < 20e-3).sum(), (radius < 10e-3).sum()
    assert half / inside == pytest.approx(0.25, abs=4 * np.sqrt(0.25 * 0.75 / inside))


def test_sampling_is_repeatable_and_can_be_restricted(probe):
    def facing_up(_, normals):
        return normals[:, 2] > 0.9

    first = probe.sample(300, np.random.default_rng(6), where=facing_up)
    again = probe.sample(300, np.random.default_rng(6), where=facing_up)
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert [part.shape for part in first] == [(300, 3), (300, 3), (300,), (300,)]
    assert first[1][:, 2].min() > 0.9
    assert len(probe.sample(0, np.random.default_rng(6))[0]) == 0
    with pytest.raises(ValueError, match="rejected every point"):
        probe.sample(1, np.random.default_rng(6), where=lambda points, _: points[:, 2] > 1)


@pytest.mark.parametrize("offset", [-4e-4, -1e-5, 1e-5, 1e-3])
def test_projection_of_offset_points_returns_the_foot(probe, offset):
    points, normals, _, _ = probe.sample(1000, np.random.default_rng(7))
    foot, normal, distance = probe.project(points + offset * normals)
    assert np.abs(foot - points).max() < 1e-9
    assert np.abs(normal - normals).max() < 1e-6
    assert np.abs(distance - offset).max() < 1e-12


def test_projection_far_away_is_orthogonal_and_no_worse_than_the_samples(probe):
    samples, normals, _, _ = probe.sample(4_000, np.random.default_rng(8))
    query = samples[:500] + 30e-3 * normals[:500]
    foot, normal, distance = probe.project(query)
    gap = query - foot
    nearest = np.min([np.linalg.norm(query - s, axis=1) for s in samples[::10]], axis=0)
    assert (np.abs(distance) <= nearest + 1e-12).all()
    slant = np.linalg.norm(np.cross(gap, normal), axis=1)
    # A few of these points are at a centre of curvature, where the foot itself is not determined.
    assert np.quantile(slant, 0.99) < 1e-9
    assert slant.max() < 1e-4


def test_projection_at_the_singular_points_of_the_chart(probe):
    tip = float(probe.profile(1.0)[0])
    x = np.array([0.0, tip, -tip, tip, tip + 1e-6])
    y = np.array([0.0, 0.0, 0.0, 1e-6, -1e-7])
    face = probe.points(0.0, 1.0)[0, 2]
    lift = np.zeros(5) if probe.warp is None else probe.warp.shift(x, np.full(5, probe.profile(1.0)[2])).value
    on_face = np.stack([x, y, probe.profile(1.0)[2] + lift], axis=1)
    assert face == pytest.approx(on_face[1, 2])
    assert np.abs(probe.project(on_face)[2]).max() < 1e-9
    base = np.array([[0, 0, 0], [1e-9, 0, 0], [0, -1e-4, 0]])
    assert np.abs(probe.project(base)[2]).max() < 1e-9
