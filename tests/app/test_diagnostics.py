import getpass
import json
import platform
import zipfile
from pathlib import Path

import pytest

from contactbench.app.diagnostics import save_diagnostics, scrubbed
from contactbench.app.heartbeat import Stalls
from contactbench.app.settings import Recent, Remembered
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session


@pytest.fixture
def session(tmp_path):
    folder = tmp_path / "Mercy Hospital"
    with Session.create(folder, by="doctor.miller") as made:
        recording = tmp_path / "gravity-1.mcap"
        recording.write_bytes(b"SECRET SAMPLES" * 10)
        made.add_input(recording, "recording", sensor="SN-0815")
        made.note("patient Smith came late")
        made.set_parameter("devices.sensor", "sri+tcp://192.168.17.4:4008")
    return folder


def test_the_zip_helps_and_tells_no_secret(session, tmp_path, monkeypatch):
    monkeypatch.setattr(getpass, "getuser", lambda: "miller")
    monkeypatch.setattr(platform, "node", lambda: "bench-pc-7")
    log = (
        f"{Path.home()}/thing failed on bench-pc-7 for miller, 192.168.17.4, /home/otto/x, {session}/journal"
    )
    settings = Remembered(recent=(Recent(str(session)),))
    file = tmp_path / "d.zip"
    save_diagnostics(file, session, log, settings, Stalls(10, 0.2, 0.1, 0.05))
    with zipfile.ZipFile(file) as archive:
        names = set(archive.namelist())
        texts = {name: archive.read(name).decode() for name in names}
    assert names == {"info.json", "settings.json", "log.txt", "window.json", "session.json"}
    whole = "\n".join(texts.values())
    secrets = "miller bench-pc-7 192.168 otto Smith SECRET Mercy SN-0815"
    for secret in (*secrets.split(), str(Path.home())):
        assert secret not in whole, secret
    assert json.loads(texts["info.json"])["contactbench"]
    told = json.loads(texts["session.json"])
    assert told["kinds"]["InputAdded"] == 1
    assert any(name.startswith("raw/") for name in told["bytes"])
    assert "thing failed" in texts["log.txt"]
    assert json.loads(texts["window.json"])["longest"] == 0.2


def test_a_damaged_session_is_described_as_far_as_it_goes(session, tmp_path):
    (session / "journal").write_bytes(b"nonsense")
    save_diagnostics(tmp_path / "d.zip", session, "", Remembered())
    with zipfile.ZipFile(tmp_path / "d.zip") as archive:
        assert "problem" in json.loads(archive.read("session.json"))


def test_a_place_that_cannot_be_written_is_said(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        save_diagnostics(tmp_path / "none" / "d.zip", None, "", Remembered())


def test_short_names_do_not_blank_out_words(monkeypatch):
    monkeypatch.setattr(getpass, "getuser", lambda: "al")
    monkeypatch.setattr(platform, "node", lambda: "pc")
    assert scrubbed("calibration of the pc") == "calibration of the pc"
