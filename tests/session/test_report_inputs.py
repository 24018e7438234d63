"""A report in a session is about what was verified, and knows its session."""

import hashlib
from dataclasses import replace

import pytest
from report.report_cases import content, probe_file

from contactbench.pipeline.mesh.sidecar import save_probe_file
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.recompute import compute, newest_inputs


@pytest.fixture
def session(tmp_path):
    """A probe that was verified, and a newer one that was not."""
    for name, facets in {"old.ply": 1_500, "new.ply": 900}.items():
        save_probe_file(probe_file(facets), tmp_path / name)
    sources = {"probe": hashlib.sha256((tmp_path / "old.ply").read_bytes()).hexdigest()}
    verified = replace(content(markers=3).verification, sources=sources).to_bytes()
    with Session.create(tmp_path / "s", by="ada") as session:
        old = session.add_input(tmp_path / "old.ply", "probe", sensor="SN 7").action.file.sha256
        session.add_result("verification", "v.json", {"v.json": verified}, {"probe": old}, {})
        session.add_input(tmp_path / "new.ply", "probe")
        yield session


def test_the_verified_probe_is_taken_not_the_newest(session, monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.report.page._PIXELS", 60)
    inputs = newest_inputs(session.state, "report")
    old, new = (each.content for each in session.state.inputs)
    assert inputs["probe"] == old
    record = compute(session, "report", "r.html", inputs, {})
    state = session.state
    assert record.action.parameters["operator"] == "ada"
    assert record.action.parameters["serials"] == {"sensor": "SN 7"}
    page = (session.folder / state.result_with(record.action.files["r.html"].sha256).file.path).read_text(
        "utf-8"
    )
    assert state.id in page
    assert "<dt>Serial number</dt><dd><bdi>SN 7</bdi>" in page
    assert newest_inputs(state, "report", {"probe": "new.ply"})["probe"] == new
    with pytest.raises(SessionError, match="not the probe that was verified"):
        compute(session, "report", "r.html", {**inputs, "probe": new}, {})


def test_a_report_takes_its_details_from_the_settings_of_the_session(session, monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.report.page._PIXELS", 60)
    for key, value in (
        ("config.operator", "B. Lovelace"),
        ("config.sensor", "M8128"),
        ("report.certificate", "DKD-7"),
        ("report.due", "2031-01-31"),
    ):
        session.set_parameter(key, value)
    inputs = newest_inputs(session.state, "report")
    given = compute(session, "report", "r.html", inputs, {}).action.parameters
    assert (given["operator"], given["sensor"]) == ("B. Lovelace", "M8128")
    page = next(iter((session.folder / "results").rglob("*r.html"))).read_text("utf-8")
    for words in ("B. Lovelace", "M8128", "DKD-7", "2031-01-31"):
        assert f"<bdi>{words}</bdi>" in page
    assert "To fill in what is missing" not in page
    session.set_parameter("report.due", "next spring")
    with pytest.raises(SessionError, match="give a date as 2027-03-31"):
        compute(session, "report", "r.html", inputs, {})
