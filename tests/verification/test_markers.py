import numpy as np
import pytest
from benchmarks.verification import mesh

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.kernel import Reason, SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.verification.markers import (
    Marker,
    MarkerError,
    MarkerSet,
    load_markers,
    make_markers,
    read_markers,
    snap,
    with_normals,
)
from contactbench.pipeline.verification.spread import grid_markers, spread_markers

HEADER = "name,x_mm,y_mm,z_mm\n"


def test_a_table_keeps_markers(tmp_path):
    made = make_markers([[0.001, -0.002, 0.1234567], [0, 0, 0.1]], ["tip, left", "M2"])
    made.save(tmp_path / "m.csv")
    read = load_markers(tmp_path / "m.csv")
    assert read.names == made.names
    np.testing.assert_allclose(read.points, made.points, atol=1e-9)
    assert read.to_bytes() == made.to_bytes()


def test_columns_may_come_in_any_order_and_others_are_ignored():
    read = read_markers(b"\xef\xbb\xbfz_mm,note,name,y_mm,x_mm\r\n30,hi,A,20,10\r\n\r\n")
    np.testing.assert_allclose(read.points, [[0.01, 0.02, 0.03]])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1"),
        ("name,x_mm,y_mm\nA,1,2\n", "z_mm"),
        ("name,x_mm,x_mm,y_mm,z_mm\n", "x_mm"),
        (HEADER, "at least one"),
        (HEADER + "A,1,2\n", "line 2"),
        (HEADER + "A,1,2,3\nB,1,two,3\n", "line 3: y_mm is 'two'"),
        (HEADER + "A,1,nan,3\n", "y_mm"),
        (HEADER + "A,1,1e99,3\n", "y_mm"),
        (HEADER + "A,1,,3\n", "y_mm"),
        (HEADER + ",1,2,3\n", "line 2"),
        (HEADER + "A\x07,1,2,3\n", "line 2"),
        (HEADER + "A,1,2,3\nA,4,5,6\n", "twice"),
        (HEADER + '"A,1,2,3\n', "CSV"),
    ],
)
def test_a_table_that_cannot_be_used_is_refused_with_its_row(text, said):
    with pytest.raises(MarkerError, match=said):
        read_markers(text.encode())


def test_bytes_that_are_no_text_and_missing_files_are_refused(tmp_path):
    with pytest.raises(MarkerError, match="UTF-8"):
        read_markers(b"\xff\xfe\x00")
    with pytest.raises(MarkerError, match="check the path"):
        load_markers(tmp_path / "none.csv")
    with pytest.raises(MarkerError, match="cannot be written"):
        make_markers([[0, 0, 0]]).save(tmp_path / "no" / "m.csv")


def test_shapes_names_and_numbers_are_checked():
    with pytest.raises(MarkerError, match="shape"):
        make_markers([1.0, 2.0, 3.0])
    with pytest.raises(MarkerError, match="names"):
        make_markers([[0, 0, 0]], ["a", "b"])
    with pytest.raises(MarkerError, match="finite"):
        Marker("A", [0, np.inf, 0], [0, 0, 1])
    with pytest.raises(MarkerError, match="at least one"):
        MarkerSet(())


def test_snapping_moves_to_the_surface_and_tells_how_far():
    probe = mesh(2_000)
    on = spread_markers(probe, 5)
    off = make_markers(on.points + 0.002 * on.normals, on.names)
    found = snap(off, probe)
    np.testing.assert_allclose(found.distances, 0.002, atol=2e-4)
    again, _, _ = SurfaceIndex(probe.vertices, probe.faces).closest(found.markers.points)
    assert again.max() < 1e-9
    _, heights = with_normals(off, probe)
    np.testing.assert_allclose(heights, found.distances, atol=1e-9)


def test_markers_off_the_probe_are_refused_and_named():
    with pytest.raises(MarkerError, match=r"far \(.* mm\)"):
        snap(make_markers([[1.0, 0, 0]], ["far"]), mesh(2_000))


def test_spread_markers_are_even_repeatable_and_on_their_region():
    probe = mesh(2_000)
    made = spread_markers(probe, 17)
    assert made.to_bytes() == spread_markers(probe, 17).to_bytes()
    apart = np.linalg.norm(made.points[:, None] - made.points, axis=2)[np.triu_indices(17, 1)].min()
    drawn = np.random.default_rng(0).choice(probe.vertices, 17)
    assert apart > 2 * np.linalg.norm(drawn[:, None] - drawn, axis=2)[np.triu_indices(17, 1)].min()
    region = (probe.normals[:, 2] > 0.95).astype(np.int32)
    assert (spread_markers(probe.with_region(region), 5, region=1).normals[:, 2] > 0.9).all()


@pytest.mark.parametrize("name", ["t-shape", "linear"])
def test_spread_markers_are_where_a_press_is_told_and_a_tip_has_room(name):
    vertices, faces = assets.make(name, 2_000)
    probe = Probe.from_arrays(vertices, faces, name=name)
    made = spread_markers(probe, 17)
    forces = -9.0 * made.normals
    found = ContactSolver(probe).locate_batch(np.hstack([forces, np.cross(made.points, forces)]))
    assert {Reason(each) for each in found.reasons} <= {Reason.OK, Reason.VERTEX}
    assert np.linalg.norm(found.points - made.points, axis=1).max() < 0.002
    down = made.normals[:, 2] < 0
    assert (made.points[down, 2] / -made.normals[down, 2] > 0.045).all()


def test_markers_keep_clear_of_where_a_press_is_not_told(monkeypatch):
    monkeypatch.setattr(
        "contactbench.pipeline.verification.spread._told", lambda _, points, __: points[:, 0] > 0
    )
    assert spread_markers(mesh(2_000), 17).points[:, 0].min() > 0.001


def test_no_marker_is_put_where_nothing_can_touch():
    probe = mesh(2_000)
    low = (probe.vertices[probe.faces, 2].mean(axis=1) < 0.5 * probe.bounds[1, 2]).astype(np.int32)
    marked = probe.with_region(low, (1,))
    assert spread_markers(marked, 17).points[:, 2].min() > 0.45 * probe.bounds[1, 2]
    with pytest.raises(MarkerError, match="no touchable region 1"):
        spread_markers(marked, 3, region=1)
    with pytest.raises(MarkerError, match="untouchable"):
        spread_markers(probe.with_region(np.ones_like(low), (1,)), 3)


def test_a_grid_has_its_pitch():
    probe = mesh(2_000)
    region = ((probe.normals[:, 2] > 0.9) & (probe.vertices[probe.faces, 2].mean(axis=1) > 0.1)).astype(
        np.int32
    )
    made = grid_markers(probe.with_region(region), 0.005, region=1)
    xs = np.unique(np.round(made.points[:, 0], 9))
    assert len(xs) > 2
    np.testing.assert_allclose(np.diff(xs), 0.005, atol=1e-8)


@pytest.mark.parametrize("count", [0, 1001])
def test_too_few_or_too_many_are_refused(count):
    with pytest.raises(MarkerError, match="give a number"):
        spread_markers(mesh(2_000), count)


def test_unknown_regions_and_useless_pitches_are_refused():
    probe = mesh(2_000)
    with pytest.raises(MarkerError, match="no touchable region 3"):
        spread_markers(probe, 3, region=3)
    with pytest.raises(MarkerError, match="no touchable region 0"):
        spread_markers(probe, 3, region=0)
    for pitch in (0.0, float("nan"), 0.0006):
        with pytest.raises(MarkerError, match="grid"):
            grid_markers(probe, pitch)
