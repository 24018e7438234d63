import numpy as np
import pytest
from scipy.spatial import ConvexHull

from contactbench import assets
from contactbench.assets import PROBE_NAMES, contact_region, make, surface


def areas(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


@pytest.mark.parametrize(
    ("name", "head", "height"),
    [("linear", (43, 11.5), 150), ("convex", (62, 16.4), 140), ("t-shape", (80, 20), 128)],
)
def test_true_sizes_in_millimetres(name, head, height):
    vertices, _ = make(name, 100_000)
    mm = 1e3 * vertices
    assert np.ptp(mm[:, 2]) == pytest.approx(height, abs=0.01)
    assert mm[:, 2].min() == pytest.approx(0, abs=1e-12)
    # Below the rounding of the face and above anything wider; the convex face itself is 8 mm high.
    nose = mm[mm[:, 2] > height - 5]
    wide = mm[mm[:, 2] > height - 18] if name == "convex" else nose
    assert np.ptp(wide[:, 0]) == pytest.approx(head[0], abs=0.3)
    assert np.ptp(nose[:, 1]) == pytest.approx(head[1], abs=0.4)
    flange = mm[mm[:, 2] < 8]
    assert np.hypot(*flange[:, :2].T).max() == pytest.approx(25, abs=1e-3)


@pytest.mark.parametrize("name", PROBE_NAMES)
def test_frame_is_at_the_middle_of_a_flat_flange_base(name):
    probe = surface(name)
    assert np.array_equal(probe.points(0.0, 0.0), [[0, 0, 0]])
    points, normals, _, _ = probe.sample(
        5000, np.random.default_rng(0), lambda p, _: np.hypot(p[:, 0], p[:, 1]) < 0.02
    )
    base = normals[:, 2] < -0.5
    below = base & (points[:, 2] < 1e-3)
    assert np.abs(points[below, 2]).max() < 1e-12
    # The probe is symmetric, so its tip is on the axis.
    assert probe.points(np.pi / 2, 1.0)[0, :2] == pytest.approx([0, 0], abs=1e-12)


def test_linear_face_is_a_flat_rectangle():
    probe = surface("linear")
    points, _, _, _ = probe.sample(40_000, np.random.default_rng(1), lambda p, _: p[:, 2] > 150e-3 - 5e-6)
    width, depth = np.ptp(points[:, 0]), np.ptp(points[:, 1])
    assert width == pytest.approx(40e-3, abs=1e-3)
    assert depth == pytest.approx(8e-3, abs=1e-3)
    assert ConvexHull(points[:, :2]).volume > 0.94 * width * depth


def test_convex_face_is_a_cylinder_of_sixty_millimetres():
    probe = surface("convex")
    points, normals, phi, t = probe.sample(
        5000,
        np.random.default_rng(2),
        lambda p, n: (n[:, 2] > 0.8) & (np.abs(p[:, 1]) < 5.5e-3) & (p[:, 2] > 0.12),
    )
    inner = np.abs(points[:, 0]) < 22e-3
    axis = np.array([0, 140e-3 - 60e-3])
    assert np.hypot(*(points[inner][:, [0, 2]] - axis).T) == pytest.approx(60e-3, abs=1e-12)
    radial = (points[inner][:, [0, 2]] - axis) / 60e-3
    assert np.abs(normals[inner][:, [0, 2]] - radial).max() < 1e-9
    assert probe.principal_curvatures(phi[inner], t[inner])[:, 1] == pytest.approx(1 / 60e-3, rel=1e-6)
    assert np.ptp(points[:, 0]) > 58e-3


def test_t_shape_has_square_shoulders():
    points, normals, _, _ = surface("t-shape").sample(100_000, np.random.default_rng(3))
    under = (points[:, 2] > 0.09) & (points[:, 2] < 0.108) & (np.abs(points[:, 0]) > 24e-3)
    plane = under & (np.abs(points[:, 0]) < 34e-3) & (np.abs(points[:, 1]) < 4e-3)
    assert np.degrees(np.arccos(-normals[plane, 2])).max() < 5
    assert points[plane, 2] == pytest.approx(104e-3, abs=0.2e-3)


def hull_excess(name, floor=60e-3):
    """Volume of the convex hull of what lies above ``floor``, over the volume of what lies above it."""
    vertices, faces = make(name, 20_000)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    upward = np.cross(b - a, c - a)[:, 2] / 2
    # The field (0, 0, max(z - floor, 0)) has divergence 1 above the floor and 0 below.
    above = (np.maximum(vertices[:, 2] - floor, 0)[faces].mean(axis=1) * upward).sum()
    return ConvexHull(vertices[vertices[:, 2] > floor]).volume / above


def test_only_the_t_shape_is_far_from_convex_above_its_flange():
    assert hull_excess("t-shape") > 1.3
    assert hull_excess("convex") < 1.15
    assert hull_excess("linear") < 1.15


def test_t_shape_neck_is_a_saddle():
    probe = surface("t-shape")
    _, _, phi, t = probe.sample(
        20_000, np.random.default_rng(4), lambda p, _: (p[:, 2] > 0.095) & (p[:, 2] < 0.108)
    )
    low, high = probe.principal_curvatures(phi, t).T
    assert ((low < -20) & (high > 5)).mean() > 0.05


@pytest.mark.parametrize("faces", [500, 2000, 20_000])
@pytest.mark.parametrize(
    ("name", "area"), [("linear", 42 * 10.6), ("convex", 62 * 14.5), ("t-shape", 77 * 18)]
)
def test_contact_region_is_the_acoustic_face(name, area, faces):
    vertices, triangles = make(name, faces)
    region = contact_region(name, vertices, triangles)
    assert region.dtype == np.int32
    assert region.shape == (len(triangles),)
    assert set(np.unique(region)) == {0, 1}
    assert areas(vertices, triangles)[region == 1].sum() * 1e6 == pytest.approx(area, rel=0.15)
    corners = vertices[triangles[region == 1]]
    assert corners[:, :, 2].min() > vertices[:, 2].max() - 15e-3


@pytest.mark.parametrize(
    "call", [surface, make, lambda name: contact_region(name, np.zeros((3, 3)), [[0, 1, 2]])]
)
def test_unknown_names_are_refused_with_the_known_ones(call):
    with pytest.raises(ValueError, match=r"'linar'.*linear, convex, t-shape"):
        call("linar")


def test_surfaces_are_shared_and_names_are_public():
    assert surface("convex") is surface("convex")
    assert assets.PROBE_NAMES == ("linear", "convex", "t-shape")
    assert all(hasattr(assets, name) for name in assets.__all__)
