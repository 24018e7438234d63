"""What each way into a damaged session costs; and going on from where it is still whole."""

import pytest

from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.check import check, repair, salvage
from contactbench.pipeline.session.remains import ways_in


@pytest.fixture
def folder(tmp_path):
    """Make a session of which the record between `early` and `late` is damaged."""
    place = tmp_path / "s"
    with Session.create(place) as session:
        session.add_input(b"1", "recording", name="early.mcap")
        early = session.state.current_inputs["recording", "early.mcap"].content
        session.add_result("study", "early.json", {"early.json": b"{}"}, {"recording": early}, {})
        begin = (place / "journal").stat().st_size
        session.note("lost")
        end = (place / "journal").stat().st_size
        session.add_input(b"2", "recording", name="late.mcap")
        late = session.state.current_inputs["recording", "late.mcap"].content
        session.add_result("study", "late.json", {"late.json": b"{}"}, {"recording": late}, {})
        session.set_parameter("config.rate", 1.0)
    data = bytearray((place / "journal").read_bytes())
    data[begin + 60 : end - 20] = b"#" * (end - 20 - begin - 60)
    (place / "journal").write_bytes(data)
    return place


def test_what_each_way_costs(folder):
    found = ways_in(folder)
    assert (found.before, found.after, found.gaps) == (3, 3, 1)
    assert found.behind == ("study late.json", "recording late.mcap", "config.rate")
    assert found.doubtful == ("study early.json",)
    assert "record 4" in found.damage
    assert found.files == ()


def test_it_says_what_a_salvage_then_finds(folder):
    found = ways_in(folder)
    done = salvage(folder)
    assert done.records == found.before + found.after
    assert set(done.stale) == set(found.doubtful)


def test_files_that_are_damaged_count(folder):
    (file,) = (folder / "results").glob("*-late.json")
    file.unlink()
    found = ways_in(folder)
    assert any("missing" in each for each in found.files)
    assert "study late.json" in found.doubtful


def test_going_on_up_to_the_damage_keeps_the_journal_as_it_was(folder):
    journal = (folder / "journal").read_bytes()
    with pytest.raises(SessionError, match="salvage"):
        repair(folder)
    assert (folder / "journal").read_bytes() == journal
    done = repair(folder, up_to_damage=True)
    assert (folder / done.kept_as).read_bytes() == journal
    assert done.removed > 0
    with Session.open(folder) as session:
        assert len(session.records) == 3
        assert [each.name for each in session.state.inputs] == ["early.mcap"]
        session.note("goes on")
    assert not check(folder).problems


def test_a_whole_session_is_left_as_it_is(tmp_path):
    Session.create(tmp_path / "s").close()
    journal = (tmp_path / "s" / "journal").read_bytes()
    assert not repair(tmp_path / "s", up_to_damage=True).kept_as
    assert (tmp_path / "s" / "journal").read_bytes() == journal


def test_there_is_no_way_into_nothing(tmp_path):
    Session.create(tmp_path / "s").close()
    (tmp_path / "s" / "journal").write_bytes(b"x" * 400)
    with pytest.raises(SessionError):
        ways_in(tmp_path / "s")
    with pytest.raises(SessionError):
        repair(tmp_path / "s", up_to_damage=True)


def test_damage_in_the_first_record_leaves_nothing_to_go_on_from(folder):
    data = bytearray((folder / "journal").read_bytes())
    data[70:90] = b"#" * 20
    (folder / "journal").write_bytes(data)
    found = ways_in(folder)
    assert found.before == 0
    assert found.after > 0
    with pytest.raises(SessionError):
        repair(folder, up_to_damage=True)
