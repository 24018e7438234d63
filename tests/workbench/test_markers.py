"""The markers of a session: edits give new ones, files and the session keep them to the byte."""

import numpy as np
import pytest
from workbench.touch_session import surface

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.verification import MarkerError, load_markers
from contactbench.pipeline.workbench.markers import Markers, grid, imported, keep, kept, on_surface, spread

FIRST, SECOND = (0.0, 0.0, 0.15), (0.01, 0.0, 0.15)


def two():
    return Markers().added(FIRST).added(SECOND)


def test_an_edit_gives_new_markers_and_leaves_the_old_ones():
    markers = two()
    assert markers.names == ("M1", "M2")
    assert markers.renamed("M1", "tip").names == ("tip", "M2")
    assert markers.without(["M1"]).names == ("M2",)
    assert markers.without(["M1"]).added(FIRST).names == ("M2", "M3")
    moved = markers.moved("M2", (0.02, 0.0, 0.15))
    assert moved.all[1].point_S.tolist() == [0.02, 0.0, 0.15]
    assert markers.all[1].point_S.tolist() == list(SECOND)
    assert moved != markers
    assert markers == two()


@pytest.mark.parametrize("name", ["M2", "", " x", "a\nb"])
def test_a_name_that_does_not_do_is_refused(name):
    with pytest.raises(MarkerError):
        two().renamed("M1", name)


def test_a_name_that_is_taken_is_refused_when_one_is_added():
    with pytest.raises(MarkerError, match="twice"):
        two().added(FIRST, "M1")


def test_a_session_keeps_them_and_none_of_them(tmp_path):
    with Session.create(tmp_path / "s") as session:
        assert kept(session.folder, session.state) == Markers()
        keep(session, two())
        assert kept(session.folder, session.state) == two()
        keep(session, Markers())
        assert kept(session.folder, session.state) == Markers()
        with pytest.raises(MarkerError, match="no markers"):
            kept(session.folder, session.state).as_set()


def test_a_table_that_was_saved_is_the_same_when_it_is_imported(tmp_path):
    file = tmp_path / "m.csv"
    file.write_bytes(two().to_bytes())
    assert imported(file) == two()
    with pytest.raises(InputError):
        imported(tmp_path / "none.csv")


def test_what_is_spread_is_what_a_file_of_it_holds(tmp_path):
    made = spread(surface(), 5, 1)
    (tmp_path / "m.csv").write_bytes(made.to_bytes())
    points = load_markers(tmp_path / "m.csv").points
    assert np.array_equal(points, [each.point_S for each in made.all])
    assert len(grid(surface(), 0.01, 1)) >= 3
    with pytest.raises(InputError, match="region 7"):
        spread(surface(), 5, 7)


def test_markers_beside_the_surface_are_moved_onto_it():
    off = Markers().added(np.array(spread(surface(), 1, 1).all[0].point_S) + [0, 0, 0.002])
    moved, farthest = on_surface(off, surface())
    assert 0.0005 < farthest <= 0.0021
    assert on_surface(moved, surface())[1] < 1e-6
