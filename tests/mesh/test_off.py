"""OFF files."""

from __future__ import annotations

import pytest

from contactbench.pipeline.mesh import MeshError, MeshWarning, load_probe

VERTICES = "0 0 0\n50 0 0\n0 50 0\n0 0 50\n"
FACETS = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
OFF = f"OFF\n4 4 6\n{VERTICES}{FACETS}"


def corners(path) -> list:
    probe = load_probe(path, "mm")
    assert probe.health.sentences == ()
    return (probe.vertices[probe.faces] * 1000).round(9).tolist()


@pytest.mark.parametrize(
    "text",
    [
        OFF.replace("OFF\n", "OFF"),
        OFF.replace("OFF", "NCOFF").replace("50 0 0\n", "50 0 0 9 9 9 9 1 0 0\n"),
        OFF.replace("OFF\n", "off\n"),
        OFF.replace("OFF\n", "\ufeffOFF\n"),
        OFF.replace("4 4 6", "4 4"),
        OFF.replace("\n", "\r"),
        "# made by hand\n\n" + OFF.replace("\n50 0 0", " # corner\n\n  50 0 0"),
        OFF.replace("OFF", "STCNOFF").replace("50 0 0\n", "50 0 0 1 0 0 9 9 9 0 0\n"),
        OFF.replace("3 0 2 1\n", "3 0 2 1 0.5 0.5 0.5\n"),
        OFF.replace("50 0 0\n0", "50\n0\n0 0"),
        OFF.replace("\n", " "),
        OFF.replace(" ", "\n"),
    ],
)
def test_forms_of_the_same(write, text):
    assert corners(write("a.off", text)) == corners(write("b.off", OFF))


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [
        ("3 1 2 3\n", "3 1 2 3\n2 0 1\n", "fewer than three corners were left out .polygons: 1"),
        (
            "3 1 2 3\n",
            "3 1 2 3\nmade by hand\n",
            "the last facet of the OFF file, from line 11, was left out",
        ),
        ("50 0 0", "50,0 0 0", "decimal commas"),
    ],
)
def test_what_is_repaired_is_told(write, old, new, note):
    text = OFF.replace(old, new, 1)
    if "corners" in note:
        text = text.replace("4 4 6", "4 5 6")
    with pytest.warns(MeshWarning, match=note):
        assert len(load_probe(write("a.off", text), "mm").faces) == 4


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("OFF\n", "OFF BINARY\n", "this is a binary OFF file, but only text is supported"),
        ("OFF\n", "4OFF\n", "the first line is not 'OFF'"),
        ("OFF\n", "\n", "the first line is not 'OFF'"),
        ("4 4 6", "4", "does not state its numbers"),
        ("4 4 6", "4 -4 6", "does not state its numbers"),
        ("4 4 6", "4 999999999999 6", "more than 4000000 facets"),
        ("4 4 6", "999999999999 4 6", "announces 999999999999 vertices.*cut short"),
        ("4 4 6", "4 0 6", "line 7 .* is one facet more"),
        ("4 4 6", "4 5 6", "announces 4 vertices and 5 facets.*cut short"),
        ("4 4 6", "4 3 6", "line 10 .* is one facet more"),
        ("4 4 6", "3 4 6", "line 10 .* is one facet more"),
        ("50 0 0", "50 0", "line 4 .* is not a vertex of three numbers"),
        ("50 0 0", "50,0,0 0 0", "line 4 .* has the number '50,0,0', whose comma"),
        ("50 0 0", "nan 0 0", r"vertex 2 is .* not finite"),
        ("3 0 1 3", "3 0 1 4", "line 8 .* refers to a vertex that does not exist .the file has 4"),
        ("3 0 1 3", "3 0 1 -1", "line 8 .* is not a facet that lists its vertices"),
        ("3 0 1 3", "4 0 1 3", "line 8 .* is not a facet that lists its vertices"),
        ("3 0 1 3", "999999999999999999 0 1 3", "line 8 .* is not a facet that lists its vertices"),
        (FACETS, "", "ends before them: it is cut short"),
    ],
)
def test_damaged(write, old, new, message):
    assert old in OFF
    path = write("a.off", OFF.replace(old, new, 1))
    with pytest.raises(MeshError, match=message) as caught:
        load_probe(path)
    assert str(path) in str(caught.value)
