"""Principal axes: known moments, the signs by rule, all four rotations, and shapes that have no axes."""

import numpy as np
import pytest
import trimesh
from contact_cases import ball, bundled

from contactbench import assets
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.preparation.alignment.alignment import AlignmentError
from contactbench.pipeline.preparation.alignment.flange import align_axes, align_flange, find_mounting_face

SIZES = (0.06, 0.03, 0.12)


def box():
    mesh = trimesh.creation.box(extents=SIZES).subdivide()
    return Probe.from_arrays(np.asarray(mesh.vertices) + [0.01, 0.02, 0.1], np.asarray(mesh.faces))


def test_a_box_has_the_moments_of_a_box():
    found = align_axes(box())
    # A box's root second moment along a side is that side over the root of 12.
    assert (
        "of the volume: the longest (rms 34.6 mm) along z, the middle (17.3) along x, the shortest (8.7)"
        in (found.alignment.how[0])
    )
    assert np.allclose(found.alignment.T_SP[:3, :3], np.eye(3), atol=1e-9)
    assert np.allclose(found.alignment.p_SP_S, [-0.01, -0.02, -0.04], atol=1e-9)
    assert not any("not determined" in sentence for sentence in found.alignment.warnings)


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
@pytest.mark.parametrize("seed", range(3))
def test_one_of_the_four_rotations_is_right_however_the_mesh_lies(name, seed, random_rigid, move):
    probe = bundled(name, 1000)
    T = random_rigid(np.random.default_rng(seed), 0.3, 170.0)
    back = np.linalg.inv(T)
    mesh = Probe.from_arrays(move(back, probe.vertices), probe.faces)
    tip = move(back, np.array([[0.0, 0.0, 0.15]]))[0]
    found = align_axes(mesh, tip_P=tip)
    off = np.abs(found.alternatives - T).reshape(4, -1).max(axis=1)
    # The probes are symmetric in x and y, so of the two with the tip up either may be the first.
    assert off[:2].min() < 1e-4
    assert np.array_equal(found.alternatives[0], found.alignment.T_SP)
    for T_SP in found.alternatives:
        assert np.isclose(move(T_SP, mesh.vertices)[:, 2].min(), 0.0, atol=1e-12)
        assert np.isclose(np.linalg.det(T_SP[:3, :3]), 1.0)
    assert len({tuple(np.round(T_SP[:3, :3], 6).ravel()) for T_SP in found.alternatives}) == 4


def test_the_tip_is_the_end_further_from_the_origin_or_the_one_picked():
    probe = bundled("linear", 1000)
    up = align_axes(probe)
    down = Probe.from_arrays(probe.vertices * [1, -1, -1], probe.faces)
    assert np.isclose(up.alignment.R_SP[2, 2], 1.0)
    assert np.isclose(align_axes(down).alignment.R_SP[2, 2], -1.0)
    assert np.isclose(align_axes(probe, tip_P=[0, 0, 0]).alignment.R_SP[2, 2], -1.0)
    middle = Probe.from_arrays(probe.vertices - [0, 0, 0.075], probe.faces)
    assert any("in its middle" in sentence for sentence in align_axes(middle).alignment.warnings)
    assert any("farther from the mesh's origin" in sentence for sentence in up.alignment.warnings)
    # Its lens is symmetric, too.
    (only,) = align_axes(probe, tip_P=[0, 0, 0.15]).alignment.warnings
    assert only.startswith("Turned by 180° about z, the surface lies within 0.0")
    notch = np.where((probe.vertices[:, :1] > 0.005) & (probe.vertices[:, 2:] > 0.1), [[0.002, 0, 0]], 0.0)
    marked = Probe.from_arrays(probe.vertices + notch, probe.faces)
    assert not align_axes(marked, tip_P=[0, 0, 0.15]).alignment.warnings


def test_shapes_without_axes_say_so():
    assert len(align_axes(ball()).alignment.warnings) >= 3
    rod = trimesh.creation.cylinder(radius=0.01, height=0.1, sections=64)
    round_one = align_axes(Probe.from_arrays(np.asarray(rod.vertices) + [0, 0, 0.05], np.asarray(rod.faces)))
    (told,) = (each for each in round_one.alignment.warnings if "not determined" in each)
    assert "turn about z is not determined" in told


def test_an_open_mesh_is_weighed_by_its_area():
    mesh = trimesh.creation.box(extents=SIZES).subdivide().subdivide().subdivide()
    opened = Probe.from_arrays(np.asarray(mesh.vertices), np.asarray(mesh.faces)[:-1])
    found = align_axes(opened).alignment
    a, b, c = SIZES
    walls = [(2 * b * c, (a / 2) ** 2), (2 * a * c, a**2 / 12), (2 * a * b, a**2 / 12)]
    expected = np.sqrt(sum(area * square for area, square in walls) / sum(area for area, _ in walls))
    assert (
        f"Principal axes of the area: the longest (rms 39.3 mm) along z, the middle ({1e3 * expected:.1f})"
        in (found.how[0])
    )
    assert any("no volume" in sentence for sentence in found.warnings)


# ---- the mounting face of a turned probe is found again, and what is no datum is said ------------


def lowest(probe):
    """The facet of the flange: the largest that looks down."""
    return int(np.argmin(probe.normals[:, 2] * probe.areas))


def turned(probe, T, move):
    return Probe.from_arrays(move(np.linalg.inv(T), probe.vertices), probe.faces)


@pytest.mark.parametrize("name", ["linear", "t-shape"])
@pytest.mark.parametrize("seed", range(3))
def test_a_bundled_probe_is_put_back_on_its_flange(name, seed, random_rigid, move):
    probe = bundled(name, 1000)
    T = random_rigid(np.random.default_rng(seed), 0.2, 150.0)
    face = find_mounting_face(turned(probe, T, move), lowest(probe))
    back = np.linalg.inv(T)
    side = move(back, np.array([[0.02, 0.0, 0.01]]))[0]
    found = align_flange(face, toward_P=side)
    assert np.abs(found.T_SP - T).max() < 1e-9
    assert not found.warnings
    assert found.residual_m < 1e-9
    assert face.round
    # As well at another offset and clocking.
    beside = face.centre_P + 0.02 * back[:3, :3] @ [0, 1, 0]
    other = align_flange(face, toward_P=beside, clock_deg=90.0, offset=0.003)
    assert np.abs(other.T_SP - (T + [[0] * 4, [0] * 4, [0, 0, 0, 0.003], [0] * 4])).max() < 1e-9


def test_without_clocking_the_mesh_is_turned_as_little_as_possible():
    found = align_flange(find_mounting_face(bundled("linear", 1000), lowest(bundled("linear", 1000))))
    assert np.allclose(found.R_SP, np.eye(3), atol=1e-9)
    assert any("clocking" in sentence for sentence in found.warnings)


def test_the_rounded_edge_does_not_lift_the_plane():
    probe = bundled("linear", 1000)
    face = find_mounting_face(probe, lowest(probe), angle_deg=15.0)
    assert abs(face.centre_P[2]) < 1e-9
    rough = find_mounting_face(probe, lowest(probe), angle_deg=15.0, flatness=0.01)
    assert rough.facets.sum() > face.facets.sum()
    assert rough.planarity_max > 1e-4
    assert any("off a plane" in sentence for sentence in align_flange(rough).warnings)


def test_a_hole_in_the_face_does_not_move_the_axis():
    ring = trimesh.creation.annulus(r_min=0.008, r_max=0.025, height=0.01, sections=64)
    probe = Probe.from_arrays(np.asarray(ring.vertices), np.asarray(ring.faces))
    face = find_mounting_face(probe, lowest(probe))
    assert np.isclose(face.rim.radius, 0.025, rtol=1e-9)
    assert np.allclose(face.centre_P[:2], 0.0, atol=1e-9)


def test_a_square_face_is_centred_by_its_area_and_said_to_be_so():
    box = trimesh.creation.box(extents=(0.06, 0.03, 0.1))
    probe = Probe.from_arrays(np.asarray(box.vertices), np.asarray(box.faces))
    face = find_mounting_face(probe, lowest(probe))
    assert not face.round
    assert np.allclose(face.centre_P, [0, 0, -0.05], atol=1e-12)
    assert np.isclose(face.area_m2, 0.06 * 0.03)
    found = align_flange(face, toward_P=face.centre_P + [1, 0, 0])
    assert np.allclose(found.p_SP_S, [0, 0, 0.05], atol=1e-12)
    assert any("not round" in sentence for sentence in found.warnings)


def test_what_is_no_datum_is_refused():
    probe = bundled("linear", 1000)
    face = find_mounting_face(probe, lowest(probe))
    with pytest.raises(AlignmentError, match="pick a facet of the mesh"):
        find_mounting_face(probe, len(probe.faces))
    with pytest.raises(AlignmentError, match="at most 45"):
        find_mounting_face(probe, 0, angle_deg=90)
    with pytest.raises(AlignmentError, match="along the axis"):
        align_flange(face, toward_P=[0, 0, 0.1])


def test_a_facet_of_a_ball_makes_a_small_face_that_is_doubted():
    found = align_flange(find_mounting_face(ball(), 0, angle_deg=4.0))
    assert any("hardly shows" in sentence for sentence in found.warnings)
