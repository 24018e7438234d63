"""What a file's numbers are: the guess, what it says, and `units="auto"`."""

import warnings

import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.mesh import MeshError, MeshWarning, load_probe
from contactbench.pipeline.mesh.formats import notes_in
from contactbench.pipeline.mesh.load import METRES, guess_units, in_metres


@pytest.mark.parametrize(
    ("span", "units", "certain"),
    [
        (132.0, "mm", True),
        (300.0, "mm", True),
        (0.132, "m", True),
        (0.05, "m", True),
        (13.2, "cm", False),
        (5.2, "cm", False),
        (1.5, "in", False),
        (45.0, "mm", False),
        (1000.0, "mm", False),
        (0.01, "m", False),
        (0.47, "m", False),
        (0.19, "m", True),
        (3.15, "in", False),
    ],
)
def test_size_alone(span, units, certain):
    guess = guess_units(span)
    assert (guess.units, guess.certain) == (units, certain)
    assert guess.units not in guess.alternatives


def test_reason_compares():
    assert guess_units(132.0).reason == (
        "The numbers span 132: 132 mm is a probe; it is 1320 mm long if they are centimetres."
    )


def test_inch_or_centimetre_is_asked():
    guess = guess_units(5.2)
    assert set(guess.alternatives) >= {"in"}
    assert "52 mm if they are centimetres, 132.1 mm if they are inches" in guess.reason
    assert "Measure the probe and give --units cm, in or mm" in guess.reason
    assert not guess.certain


def test_a_small_part_in_inches_is_asked_about():
    guess = guess_units(0.47)
    assert guess.alternatives == ("in",)
    assert "470 mm if they are metres, 11.94 mm if they are inches" in guess.reason


@pytest.mark.parametrize(
    ("notes", "units"),
    [
        (b"units mm", "mm"),
        (b"UNIT=MM", "mm"),
        (b"STL unit: inch", "in"),
        (b"exported in inches", "in"),
        (b"file_units: cm", "cm"),
        (b"Units are in", "in"),
        (b"lengths in centimeters", "cm"),
    ],
)
def test_notes_decide_where_they_declare_what_can_be_true(notes, units):
    guess = guess_units(5.2 if units != "mm" else 52.0, notes=notes)
    assert (guess.units, guess.certain) == (units, True)
    assert guess.reason.startswith("The file declares")


@pytest.mark.parametrize(
    "notes",
    [
        b"chord tolerance 0.01 mm",
        b"probe for 12 mm bolts",
        b"Exported, deviation 0.1 mm",
        b"unit scale: 1 m",
        b"unit = 0.01 mm",
        b"units in the header",
        b"unit: m4 screws",
    ],
)
def test_a_unit_that_is_only_mentioned_decides_nothing(notes):
    # A probe of 150 mm in inches.
    guess = guess_units(5.906, notes=notes)
    assert guess == guess_units(5.906)
    assert not guess.certain
    assert "--units cm, in or mm" in guess.reason


def test_a_declared_unit_that_makes_no_usual_probe_is_a_doubt():
    guess = guess_units(5.906, notes=b"units: mm")
    assert (guess.units, guess.certain) == ("cm", False)
    assert guess.reason.endswith("The file declares millimetres, but 5.906 mm is small for a probe.")
    assert guess_units(700.0, notes=b"units: mm").certain


def test_several_declared_units_decide_nothing():
    guess = guess_units(132.0, notes=b"units: mm\nunits: inches")
    assert (guess.units, guess.certain) == ("mm", False)
    assert guess.reason.endswith("The file declares several units: millimetres, inches.")


def test_notes_that_cannot_be_true_make_it_uncertain():
    guess = guess_units(132.0, notes=b"units: m")
    assert (guess.units, guess.certain) == ("mm", False)
    assert guess.reason.endswith("The file declares metres, but 132 m is impossible.")


def test_a_stated_unit_that_cannot_be_is_a_question():
    assert guess_units(20.0, stated="mm").certain
    guess = guess_units(802.0, stated="m")
    assert (guess.units, guess.certain) == ("mm", False)
    assert guess.reason.endswith("The file declares metres, but 802 m is impossible.")


def test_a_format_that_is_defined_in_metres():
    assert guess_units(0.7, defined="m").certain
    guess = guess_units(60.0, defined="m")
    assert (guess.units, guess.certain) == ("mm", False)
    assert guess.reason.endswith("The format is defined in metres, but 60 m is impossible.")


@pytest.mark.parametrize("notes", [b"made in 2020", b"comma, hammer, m 5", b"mm or inches", b"\xff\x00"])
def test_notes_that_say_nothing(notes):
    assert guess_units(132.0, notes=notes) == guess_units(132.0)


def test_a_probe_lies_near_its_origin():
    # 45 cm would lie 40 m away.
    assert not guess_units(45.0).certain
    assert guess_units(45.0, farthest=4000.0).certain


@pytest.mark.parametrize("span", [0.0, 1e-5, 3e3, 1e9])
def test_no_unit_makes_it_a_probe(span):
    with pytest.raises(MeshError, match="cannot be a probe in millimetres, metres, centimetres or inches"):
        guess_units(span)


@given(st.floats(0, 1e4), st.sampled_from([b"", b"units mm", b"inches", b"units: m"]), st.floats(0, 1e6))
def test_a_guess_is_always_a_possible_size(span, notes, farthest):
    try:
        guess = guess_units(span, notes=notes, farthest=farthest)
    except MeshError:
        assert not any(0.005 <= in_metres(span, unit) <= 2.0 for unit in METRES)
        return
    assert all(0.005 <= in_metres(span, unit) <= 2.0 for unit in (guess.units, *guess.alternatives))
    assert guess.reason.endswith((".", "?"))


def test_notes_of_each_format():
    assert notes_in(b"solid part mm\nfacet inch", ".stl") == b"solid part mm"
    assert notes_in(b"unit: mm".ljust(80) + b"\0\0\0\0inch", ".stl").strip() == b"unit: mm"
    assert (
        notes_in(b"ply\ncomment unit mm\nelement inch 3\nend_header\ncomment cm", ".ply").strip()
        == b"unit mm"
    )
    assert notes_in(b"# units: mm\nv 1 2 3 # cm\ng inch", ".obj").split(b"\n") == [b" units: mm", b" cm"]
    assert notes_in(b"anything", ".3mf") == b""
    assert notes_in(b"anything", ".glb") == b""


@given(st.floats(0.03, 0.6), st.sampled_from(sorted(METRES)))
def test_a_probe_of_usual_size_is_never_silently_read_in_another_unit(size_m, units):
    numerator, denominator = METRES[units]
    guess = guess_units(size_m * denominator / numerator)
    assert guess.units == units or not guess.certain
    assert guess.certain or units in (guess.units, *guess.alternatives)


# ---------------------------------------------------------------- units="auto"


@pytest.fixture
def scaled(ball, encode, write):
    def make(factor: float, name: str = "binary.stl"):
        mesh = trimesh.Trimesh((ball.vertices - [0, 0, 120]) * factor, ball.faces, process=False)
        return write(name, encode(mesh, name))

    return make


@pytest.mark.parametrize("factor", [1.0, 1e-3])
def test_auto_is_silent_where_certain(scaled, factor, format_name):
    assert load_probe(scaled(2 * factor, format_name), "auto").size == pytest.approx(0.16, rel=1e-3)


def test_auto_asks_where_it_is_not(scaled):
    with pytest.warns(
        MeshWarning,
        match="span 8: the longest side is 80 mm if they are centimetres.*inches.*Centimetres are assumed",
    ):
        probe = load_probe(scaled(0.1), "auto")
    assert probe.size == pytest.approx(0.08, rel=1e-3)


def test_auto_reads_comments(scaled, write):
    text = scaled(1 / 25.4, "mesh.obj").read_text(encoding="utf-8")
    probe = load_probe(write("inch.obj", "# File units = inches\n" + text), "auto")
    assert probe.size == pytest.approx(0.08, rel=1e-3)


def test_auto_names_the_file_where_no_unit_fits(scaled):
    path = scaled(1e4)
    with pytest.raises(MeshError, match="cannot be a probe in") as caught:
        load_probe(path, "auto")
    assert str(path) in str(caught.value)


def test_other_values_do_not_guess(scaled):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert load_probe(scaled(0.1), "cm").size == pytest.approx(0.08, rel=1e-3)
    with pytest.raises(MeshError, match=r"are the numbers metres\? Give --units m instead of mm"):
        load_probe(scaled(1e-3), "mm")


def test_the_default_asks_about_inches(scaled):
    with pytest.warns(MeshWarning, match="80 mm if they are inches"):
        load_probe(scaled(1 / 25.4))
    with pytest.warns(MeshWarning, match="if they are inches.*Measure the probe and give --units"):
        load_probe(scaled(1.2 / 25.4))
