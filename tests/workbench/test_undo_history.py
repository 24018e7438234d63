"""What can be undone outlives its window: by the journal, and by which records each step made."""

import json

import pytest

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.workbench.undo_history import UNDO_FILE, Deed, read_history, write_history


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s") as found:
        yield found


def done(session, text, action):
    deed = Deed(text)
    deed.around(action)(session)
    return deed


def kept(session):
    one = done(session, "one", lambda it: it.set_parameter("study.one", 1))
    session.note("in between")
    nothing = done(session, "nothing", lambda _it: None)
    two = done(session, "two", lambda it: it.add_result("study", "a.json", {"a.json": b"1"}, {}, {}))
    return [one, nothing, two]


def test_steps_are_taken_back_after_the_session_was_opened_again(session):
    write_history(session.folder, kept(session), 3)
    session.close()
    with Session.open(session.folder) as again:
        history = read_history(again)
        assert [each.text for each in history.deeds] == ["one", "two"]
        assert history.done == 2
        one, two = (each.change(again) for each in history.deeds)
        two.undo(again)
        assert again.state.current_results["study", "a.json"].rejected
        one.undo(again)
        assert again.state.setting("study.one") is None
        one.redo(again)
        two.redo(again)
        assert again.state.setting("study.one") == 1
        assert not again.state.current_results["study", "a.json"].rejected
    assert not check(session.folder).problems


def test_what_was_taken_back_is_to_be_done_again(session):
    write_history(session.folder, kept(session), 1)
    assert read_history(session).done == 1
    write_history(session.folder, kept(session), 0)
    assert read_history(session).done == 0


def test_an_action_that_fails_is_no_step(session):
    def fails(it):
        it.set_parameter("study.one", 1)
        raise ArithmeticError

    deed = Deed("fails")
    with pytest.raises(ArithmeticError):
        deed.around(fails)(session)
    assert not deed.happened


@pytest.mark.parametrize(
    "damage", ["missing", "half", "list", "version", "another journal", "beyond the end"]
)
def test_a_history_that_does_not_fit_is_none(session, tmp_path, damage):
    write_history(session.folder, kept(session), 3)
    file = session.folder / UNDO_FILE
    content = json.loads(file.read_bytes())
    if damage == "missing":
        file.unlink()
    elif damage == "half":
        file.write_bytes(file.read_bytes()[:40])
    elif damage == "list":
        file.write_bytes(b"[]")
    elif damage == "version":
        file.write_text(json.dumps({**content, "version": 9}))
    elif damage == "beyond the end":
        content["steps"][1]["last"] = 99
        file.write_text(json.dumps(content))
    else:
        with Session.create(tmp_path / "other") as other:
            for _ in range(9):
                other.note("n")
            (other.folder / UNDO_FILE).write_bytes(file.read_bytes())
            assert read_history(other).deeds == ()
        return
    assert read_history(session).deeds == ()


def test_a_full_disk_loses_no_more_than_the_steps(session, monkeypatch):
    import os

    deeds = kept(session)

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    monkeypatch.setattr(os, "fsync", full)
    write_history(session.folder, deeds, 3)
    monkeypatch.undo()
    assert read_history(session).deeds == ()
