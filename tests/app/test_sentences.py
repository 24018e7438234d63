from pathlib import Path

import pytest

from contactbench import pipeline
from contactbench.app.sentences import PARTS, templates


@pytest.fixture
def package(tmp_path):
    def made(source):
        (tmp_path / "module.py").write_text(source, "utf-8")
        return without_parts(templates(tmp_path))

    return made


def without_parts(found):
    return tuple(each for each in found if each not in PARTS)


def test_what_is_filled_in_is_numbered(package):
    assert package('say(f"The pose {name} is {angle:.1f} deg off.")') == ("The pose {0} is {1} deg off.",)
    assert package('WORDS = "Give {count} poses, or {more}."') == ("Give {0} poses, or {1}.",)
    assert package('say("The pose " f"is {angle:.1f} deg off.")') == ("The pose is {0} deg off.",)


def test_what_nobody_reads_is_left_out(package):
    assert package('"""Say what is said."""') == ()
    assert package('raise AssertionError("this cannot be so")') == ()
    assert package('f"{value:some long format}"') == ()
    assert package('KEYS = ("mean_mm", "gravity", "--with-option", "<b>bold words</b>", "a = 3")') == ()


def test_terminals_and_documents_are_not_windows(tmp_path):
    (tmp_path / "commands").mkdir()
    (tmp_path / "commands" / "verify.py").write_text('say("Verify the session first.")', "utf-8")
    (tmp_path / "heatmap").mkdir()
    (tmp_path / "heatmap" / "page.py").write_text('WORDS = "The largest force."', "utf-8")
    (tmp_path / "heatmap" / "film.py").write_text('WORDS = "The film is long."', "utf-8")
    assert without_parts(templates(tmp_path)) == ("The film is long.",)


def test_what_a_page_says_is_among_them():
    found = templates(Path(pipeline.__file__).parent)
    assert len(found) > 1000
    assert any("facets" in each for each in found)
