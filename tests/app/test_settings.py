import json

import pytest

from contactbench.app.settings import WindowSettings, own_folder


def test_what_is_remembered_comes_back(tmp_path):
    settings = WindowSettings(tmp_path)
    settings.change(theme="dark", language="de")
    for number in range(12):
        settings.opened(tmp_path / f"s{number}", "gravity", "begun")
    settings.opened(tmp_path / "s5", "probe", "done: Gravity")
    again = WindowSettings(tmp_path).now
    assert (again.theme, again.language) == ("dark", "de")
    assert len(again.recent) == 10
    assert (again.recent[0].folder, again.recent[0].page) == (str(tmp_path / "s5"), "probe")
    assert len({each.folder for each in again.recent}) == 10
    assert WindowSettings(tmp_path).recent_of(tmp_path / "s0").page == ""


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", '{"version": 99, "theme": "dark"}', '{"version": 1, "theme": 3, "recent": [1, {}]}'],
)
def test_a_file_that_makes_no_sense_counts_as_empty(tmp_path, content):
    (tmp_path / "window.json").write_text(content, encoding="utf-8")
    now = WindowSettings(tmp_path).now
    assert (now.theme, now.recent) == ("system", ())


def test_a_disk_that_cannot_be_written_is_survived(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    settings = WindowSettings(tmp_path / "file")
    settings.change(theme="dark")
    assert settings.now.theme == "dark"


def test_the_file_has_a_version(tmp_path):
    WindowSettings(tmp_path).change(theme="light")
    assert json.loads((tmp_path / "window.json").read_text(encoding="utf-8"))["version"] == 1


def test_one_variable_moves_everything(tmp_path, monkeypatch):
    monkeypatch.setenv("CONTACTBENCH_HOME", str(tmp_path))
    assert {own_folder(kind).parent for kind in ("config", "log", "sessions")} == {tmp_path}
    monkeypatch.delenv("CONTACTBENCH_HOME")
    assert own_folder("config").parts[-1] == "contactbench"
