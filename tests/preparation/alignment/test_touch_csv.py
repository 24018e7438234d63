"""Touches from CSV: units, optional columns, and errors that name the place."""

import io

import numpy as np
import pytest

from contactbench.pipeline.preparation.alignment.alignment import AlignmentError
from contactbench.pipeline.preparation.alignment.touches.fit import TouchFileError, read_touches

HEADER = "px,py,pz,fx,fy,fz,mx,my,mz"
ROWS = ["10,0,150,0,0,-9,0.1,0,0", "-10,0,150,1,0,-9,0,0.2,0", "0,5,150,0,1,-9,0,0,0"]


def read(*lines):
    return read_touches(io.BytesIO("\n".join(lines).encode()))


def test_millimetres_become_metres_and_wrenches_stay():
    touches = read(HEADER, *ROWS)
    assert np.allclose(touches.points_P[0], [0.01, 0, 0.15])
    assert np.array_equal(touches.wrenches[1], [1, 0, -9, 0, 0.2, 0])
    assert touches.normals_P is None
    assert touches.names == ("line 2", "line 3", "line 4")


def test_normals_and_names_are_read_wherever_they_stand():
    touches = read(f"marker,nz,{HEADER},nx,ny,note", *(f'"A{i}",2,{row},0,0,x' for i, row in enumerate(ROWS)))
    assert np.array_equal(touches.normals_P, np.tile([0, 0, 1.0], (3, 1)))
    assert touches.names == ("A0 (line 2)", "A1 (line 3)", "A2 (line 4)")
    assert np.allclose(touches.points_P[0], [0.01, 0, 0.15])


def test_a_file_is_named_in_its_errors(tmp_path):
    path = tmp_path / "touches.csv"
    with pytest.raises(TouchFileError, match="no such file"):
        read_touches(path)
    path.write_text("\n".join([HEADER, *ROWS[:2]]), encoding="utf-8")
    with pytest.raises(TouchFileError, match=r"touches\.csv: 2 touches cannot show a mount"):
        read_touches(path)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["px,py,pz,fx,fy,fz", "1,2,3,4,5,6"], "columns mx, my, mz missing"),
        ([HEADER + ",nx", *(row + ",0" for row in ROWS)], "give all three, or none"),
        ([HEADER, ROWS[0], ROWS[1], "a,0,150,0,0,-9,0,0,0"], "line 4"),
        ([HEADER, ROWS[0], ROWS[1], "nan,0,150,0,0,-9,0,0,0"], "line 4.*remove the row"),
        ([HEADER, ROWS[0], ROWS[1], "0,0,150,0,0,-0.1,0,0,0"], "line 4: the force is 0.1 N"),
        ([HEADER, ROWS[0], ROWS[1], "0,0,150000,0,0,-9,0,0,0"], "line 4: the marker is over 10 m away"),
        ([HEADER + ",nx,ny,nz", *(row + ",0,0,0" for row in ROWS)], "line 2: the normal has zero length"),
        ([""], "empty"),
    ],
)
def test_a_bad_file_is_refused_with_the_line(lines, words):
    with pytest.raises(TouchFileError, match=words) as caught:
        read(*lines)
    assert isinstance(caught.value, AlignmentError)


def test_a_header_of_one_marker_column_only_needs_its_numbers():
    with pytest.raises(TouchFileError, match=r"missing.*Name the columns"):
        read("marker", "a", "b", "c")
