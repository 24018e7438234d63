"""Many sessions in one table: what is read, what is left out, and what is said of it."""

import json
import os
import shutil
import sys
import zipfile
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.fleet import BEGIN, row
from terminal import invoke
from typer.testing import CliRunner
from weighing_files import weighed, write_euler

from contactbench.pipeline.calibration.files.calibration_file import decode_record, load_record
from contactbench.pipeline.commands.session import session_app
from contactbench.pipeline.fleet.judge import FEWEST, DueRules, judge
from contactbench.pipeline.fleet.page import fleet_html
from contactbench.pipeline.fleet.row import FleetRow, Skipped, schema, table_of
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.archive import export_archive

pytest.importorskip("pyarrow", reason="the table is Parquet (extra fleet)")


def fleet(*arguments: object, code: int = 0) -> dict[str, Any]:
    result = invoke("fleet", *arguments, "--json")
    assert result.exit_code == code, result.output
    answer: dict[str, Any] = json.loads(result.stdout)
    return answer


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two sessions with calibrations that a command computed, and one without."""
    folder = tmp_path_factory.mktemp("made")
    for name, seed in (("a", 4), ("b", 5)):
        poses = write_euler(folder / f"{name}.csv", weighed(seed=seed))
        words = [
            ["new", folder / "all" / name],
            ["add", folder / "all" / name, poses, "--kind", "poses", "--serial", "SN 7"],
            ["compute", folder / "all" / name, "calibration", "c.json", "--set", "euler=xyz"],
            ["set", folder / "all" / name, "report.due=2199-03-31", "report.sensor=M8128"],
        ]
        for each in words:
            result = CliRunner().invoke(session_app, list(map(str, each)))
            assert result.exit_code == 0, result.output
        with Session.open(folder / "all" / name) as session:
            session.add_input(b"solid", "mesh", name="linear.stl")
    Session.create(folder / "all" / "sub" / "empty").close()
    return folder / "all"


@pytest.fixture
def calibrated(made: Path) -> datetime:
    """When the sessions were calibrated: a session takes the time of day."""
    created = load_record(next((made / "a" / "results").glob("*c.json"))).created
    assert created is not None
    return created


@pytest.fixture(autouse=True)
def today(calibrated: datetime, monkeypatch: pytest.MonkeyPatch) -> None:
    later = calibrated + timedelta(days=151)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", str(int(later.timestamp())))


@pytest.fixture
def sessions(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "all")
    return tmp_path / "all"


def table_in(file: Path) -> list[dict[str, Any]]:
    import pyarrow.parquet as pq

    rows: list[dict[str, Any]] = pq.read_table(file).to_pylist()
    return rows


# ---- reading -------------------------------------------------------------------------------------


def test_a_row_says_what_the_calibration_says(sessions: Path, tmp_path: Path) -> None:
    for mesh in sessions.glob("*/meshes/*"):
        mesh.unlink()  # nobody looks at it
    fleet(sessions, "--out", tmp_path / "f.parquet", code=1)  # one was never calibrated
    rows = {Path(row["place"]).name: row for row in table_in(tmp_path / "f.parquet")}
    record = load_record(next((sessions / "a" / "results").glob("*c.json")))
    model, sigma = record.calibration.model, np.sqrt(np.diag(record.calibration.covariance))
    row = rows["a"]
    assert (row["sensor"], row["tool"], row["model"], row["due"]) == (
        "SN 7",
        "linear",
        "M8128",
        date(2199, 3, 31),
    )
    assert row["calibrated"] == record.created
    assert row["verdict"] == record.calibration.verdict.level.value
    assert row["poses"] == len(record.calibration.poses)
    assert row["mass_kg"] == model.mass
    assert row["mass_sigma_kg"] == model.mass_sigma
    read = [row[f"{name}_{axis}_{unit}"] for name, unit in BIASES for axis in "xyz"]
    assert read == model.vector[3:12].tolist()
    read = [row[f"{name}_sigma_{axis}_{unit}"] for name, unit in BIASES for axis in "xyz"]
    assert read == sigma[3:12].tolist()
    assert rows["empty"]["calibrated"] is None
    assert rows["empty"]["mass_kg"] is None


BIASES = (("force_bias", "N"), ("centre", "m"), ("torque_bias", "Nm"))  # in the order of the model's vector


def test_an_archive_is_read_as_its_folder(sessions: Path, tmp_path: Path) -> None:
    (tmp_path / "x").mkdir()
    export_archive(sessions / "a", tmp_path / "x" / "a.contactbench")
    fleet(sessions / "a", "--out", tmp_path / "1.parquet")
    fleet(tmp_path / "x", "--out", tmp_path / "2.parquet")
    (one,), (two,) = table_in(tmp_path / "1.parquet"), table_in(tmp_path / "2.parquet")
    assert two.pop("place") == str(tmp_path / "x" / "a.contactbench")
    one.pop("place")
    for each in (one, two):
        assert each.pop("files") != "{}"
    assert one == two


def test_of_two_states_of_a_session_the_later_counts(sessions: Path, tmp_path: Path) -> None:
    export_archive(sessions / "a", tmp_path / "old.zip")
    with Session.open(sessions / "a") as session:
        session.note("goes on")
    found = fleet(tmp_path / "old.zip", sessions / "a")
    assert found["sessions"] == 1
    assert [each["place"] for each in found["skipped"]] == [str(tmp_path / "old.zip")]
    assert "a copy of the session in" in found["skipped"][0]["reason"]
    (tmp_path / "old.zip").rename(sessions / "old.zip")
    assert fleet(sessions, code=1)["sessions"] == 3


def test_a_second_run_reads_only_what_is_new(sessions: Path, tmp_path: Path) -> None:
    out = tmp_path / "f.parquet"
    first = fleet(sessions, "--out", out, code=1)
    assert (first["sessions"], first["read"]) == (3, 3)
    before = table_in(out)
    again = fleet(sessions, "--out", out, code=1)
    assert again["read"] == 0
    assert table_in(out) == before
    assert again["due"] == first["due"]
    with Session.open(sessions / "b") as session:
        session.set_parameter("devices.serial", "SN 8")
    shutil.move(sessions / "a", sessions / "z")
    assert fleet(sessions, "--out", out, code=1)["read"] == 1
    rows = {Path(row["place"]).name: row["sensor"] for row in table_in(out)}
    assert rows == {"z": "SN 7", "b": "SN 8", "empty": ""}
    shutil.rmtree(sessions / "b")
    assert fleet(sessions, "--out", out, code=1)["sessions"] == 2


def _cut_journal(folder: Path) -> None:
    data = (folder / "journal").read_bytes()
    (folder / "journal").write_bytes(data[:200] + b"\0\0\0\0" + data[204:])


def _edit_calibration(folder: Path) -> None:
    file = next((folder / "results").glob("*c.json"))
    file.write_bytes(file.read_bytes().replace(b'"mass_kg"', b'"mAss_kg"'))


def _edit_as_long(folder: Path) -> None:
    file = next((folder / "results").glob("*c.json"))
    file.write_bytes(file.read_bytes().replace(b'"contactbench ', b'"contactbenck '))


def _remove_calibration(folder: Path) -> None:
    next((folder / "results").glob("*c.json")).unlink()


def _link_calibration(folder: Path) -> None:
    file = next((folder / "results").glob("*c.json"))
    shutil.move(file, folder.parent.parent / "elsewhere.json")
    file.symlink_to(folder.parent.parent / "elsewhere.json")


@pytest.mark.parametrize(
    "damage", [_cut_journal, _edit_calibration, _edit_as_long, _remove_calibration, _link_calibration]
)
def test_a_damaged_session_is_named_and_the_others_are_read(sessions: Path, damage: Any) -> None:
    damage(sessions / "a")
    found = fleet(sessions, code=1)
    assert found["sessions"] == 2
    (skipped,) = found["skipped"]
    assert skipped["place"] == str(sessions / "a")
    assert str(sessions / "a") in skipped["reason"]
    assert skipped["damaged"]


def test_damage_alone_is_exit_code_1_and_no_session_or_a_copy_is_not(sessions: Path) -> None:
    shutil.copytree(sessions / "b", sessions / "c")
    (sessions / "holiday").mkdir()
    where = [sessions / name for name in "abc"]
    assert not any(each["damaged"] for each in fleet(*where, sessions / "holiday")["skipped"])
    (sessions / "a" / "journal").unlink()  # its folders tell that it was one
    assert [each["damaged"] for each in fleet(*where, code=1)["skipped"]] == [True, False]


@pytest.mark.parametrize("damage", [_edit_as_long, _remove_calibration])
def test_damage_behind_an_unchanged_journal_is_noticed_by_a_second_run(
    sessions: Path, tmp_path: Path, damage: Any
) -> None:
    words = (sessions / "a", sessions / "b", "--out", tmp_path / "f.parquet")
    fleet(*words)
    assert fleet(*words)["read"] == 0
    damage(sessions / "a")
    for file in (sessions / "a" / "results").glob("*c.json"):
        os.utime(file, (1, 1))  # whatever the resolution of the file system's clock
    assert [each["damaged"] for each in fleet(*words, code=1)["skipped"]] == [True]


def test_a_damaged_lzma_archive_is_named(sessions: Path, tmp_path: Path) -> None:
    file = tmp_path / "x.zip"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_LZMA) as packed:
        packed.writestr("journal", b"abc" * 1000)
        info = packed.infolist()[0]
    data = bytearray(file.read_bytes())
    begin = 30 + len(info.filename) + 9  # behind the local header and the properties of LZMA
    data[begin : begin + 20] = b"\xff" * 20
    file.write_bytes(data)
    (skipped,) = fleet(sessions / "a", file, code=1)["skipped"]
    assert "not an intact archive" in skipped["reason"]


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_a_name_that_is_no_utf_8_is_kept_readable(sessions: Path, tmp_path: Path) -> None:
    odd = sessions / os.fsdecode(b"a\xff")
    (sessions / "a").rename(odd)
    shutil.copytree(odd, sessions / "copy")
    (sessions / os.fsdecode(b"no\xfe")).mkdir()
    words = (sessions, "--out", tmp_path / "f.parquet", "--report", tmp_path / "f.html")
    fleet(*words, code=1)
    assert fleet(*words, code=1)["read"] == 0
    assert any(row["place"].endswith("a\\udcff") for row in table_in(tmp_path / "f.parquet"))
    assert "no\\udcfe" in (tmp_path / "f.html").read_text("utf-8")


def test_a_path_that_is_given_twice_is_read_once(sessions: Path) -> None:
    found = fleet(sessions / "a", sessions / "a", sessions / "sub" / ".." / "a")
    assert (found["sessions"], found["read"], found["skipped"]) == (1, 1, [])


@pytest.mark.parametrize(
    "at",
    [
        "9999-12-31T23:59:59-05:00",
        "0001-01-01T00:00:00+05:00",
        "2200-01-01T00:00:00Z",
        "1969-01-01T00:00:00Z",
    ],
)
def test_a_year_that_cannot_be_is_unreadable(
    sessions: Path, monkeypatch: pytest.MonkeyPatch, at: str
) -> None:
    def aged(data: bytes, name: str) -> Any:
        return replace(decode_record(data, name), created=datetime.fromisoformat(at))

    monkeypatch.setattr("contactbench.pipeline.fleet.row.decode_record", aged)
    found = fleet(sessions, code=1)
    assert (found["sessions"], [each["damaged"] for each in found["skipped"]]) == (1, [True, True])
    assert f"created in {int(at[:4])}, which cannot be" in found["skipped"][0]["reason"]


def test_an_unreadable_date_of_the_certificate_is_due(sessions: Path) -> None:
    words = ["set", str(sessions / "a"), "report.certificate=0815"]
    assert CliRunner().invoke(session_app, words).exit_code == 0
    words = ["set", str(sessions / "a"), "report.certificate=4711", "report.due=31.03.2020"]
    result = CliRunner().invoke(session_app, words)
    assert result.exit_code != 0
    assert "report.due" in str(result.exception)
    with Session.open(sessions / "a") as session:
        assert session.state.setting("report.due") == "2199-03-31"
        assert session.state.setting("report.certificate") == "0815"  # nothing of a command that is refused
        session.set_parameter("report.due", "31.03.2020")  # as earlier versions let it
    words = ["set", str(sessions / "b"), "report.certificate=4711", "report.due=null"]
    assert CliRunner().invoke(session_app, words).exit_code == 0
    with Session.open(sessions / "b", write=False) as session:
        assert session.state.setting("report.certificate") == "4711"
        assert session.state.setting("report.due") is None
    assert "'31.03.2020'" in fleet(sessions / "a", code=1)["due"][0]["sentence"]


def test_what_is_no_session_is_named(sessions: Path) -> None:
    (sessions / "holiday").mkdir()
    (sessions / "holiday" / "beach.jpg").write_bytes(b"x")
    (sessions / "text.zip").write_bytes(b"no zip")
    with zipfile.ZipFile(sessions / "other.zip", "w") as packed:
        packed.writestr("a.txt", "x")
    with zipfile.ZipFile(sessions / "evil.zip", "w") as packed:
        packed.writestr("journal", b"\xff" * 100)
    (sessions / "notes.txt").write_text("left alone", encoding="utf-8")
    (sessions / "loop").symlink_to(sessions)
    found = fleet(sessions, code=1)
    assert found["sessions"] == 3
    assert sorted(Path(each["place"]).name for each in found["skipped"]) == [
        "evil.zip",
        "holiday",
        "other.zip",
        "text.zip",
    ]


def test_a_lying_size_in_an_archive_is_noticed(sessions: Path, tmp_path: Path) -> None:
    export_archive(sessions / "a", tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "a.zip") as packed, zipfile.ZipFile(tmp_path / "b.zip", "w") as other:
        for name in packed.namelist():
            data = packed.read(name)
            other.writestr(name, data + b" " if name.endswith("c.json") else data)
    found = fleet(tmp_path / "b.zip", sessions / "b", code=1)
    assert "does not match the journal" in found["skipped"][0]["reason"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["/nowhere"], "there is no such folder"), (["."], "no session that can be read")],
)
def test_without_any_session_it_is_wrong_usage(
    arguments: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert words in fleet(*arguments, code=2)["error"]


def test_a_file_of_somebody_else_is_not_written_over(sessions: Path, tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    (tmp_path / "text.parquet").write_text("mine", encoding="utf-8")
    pq.write_table(pa.table({"a": [1]}), tmp_path / "other.parquet")
    for name in ("text.parquet", "other.parquet"):
        before = (tmp_path / name).read_bytes()
        assert "is no table of a fleet" in fleet(sessions, "--out", tmp_path / name, code=2)["error"]
        assert (tmp_path / name).read_bytes() == before
    # One of another version is made anew.
    old = table_of([]).replace_schema_metadata({b"contactbench.fleet": b"0"})
    pq.write_table(old, tmp_path / "old.parquet")
    assert fleet(sessions, "--out", tmp_path / "old.parquet", code=1)["read"] == 3


def test_outputs_take_the_place_of_nothing_else(sessions: Path, tmp_path: Path) -> None:
    journal = (sessions / "a" / "journal").read_bytes()
    for words, said in (
        (["--report", sessions / "a" / "journal"], "ends in .html or .pdf"),
        (["--out", tmp_path / "f.html"], "ends in .parquet"),
        (["--report", sessions / "a" / "new.html"], "inside the session"),
        (["--out", sessions / "b" / "results" / "f.parquet"], "inside the session"),
    ):
        assert said in " ".join(fleet(sessions, *words, code=2)["error"].split())
    assert (sessions / "a" / "journal").read_bytes() == journal
    assert not (sessions / "a" / "new.html").exists()
    fleet(sessions, "--out", tmp_path / "f.parquet", code=1)
    (tmp_path / "f.html").symlink_to(tmp_path / "f.parquet")
    words = ["--out", tmp_path / "f.parquet", "--report", tmp_path / "f.html"]
    assert "choose another name" in " ".join(fleet(sessions, *words, code=2)["error"].split())
    assert len(table_in(tmp_path / "f.parquet")) == 3


# ---- judging -------------------------------------------------------------------------------------


def judged(rows: list[FleetRow], today: date = date(2026, 6, 1), **rules: Any) -> Any:
    return judge(table_of(rows), DueRules(today, **rules))


def masses(*values: float, start: int = 0) -> list[FleetRow]:
    return [row(start + n, mass_kg=value) for n, value in enumerate(values)]


STEADY = [0.6 + 0.001 * x for x in (0.1, -0.4, 0.9, -1.1, 0.3, 0.0, -0.6, 0.7, -0.2, 0.5, -0.9, 1.0)]


def test_one_heavy_session_stands_out_and_says_by_how_much() -> None:
    (outlier,) = judged(masses(*STEADY, 0.65)).outliers
    assert (outlier.place, outlier.reason, outlier.sensor) == ("/s/12", "mass", "SN 7")
    assert "The mass is 650 g: 49.9 g (" in outlier.sentence
    assert "from the median of 13 sessions" in outlier.sentence
    assert judged(masses(*STEADY)).outliers == ()
    # Another tool of another mass is another series.
    other = [
        replace(each, tool="convex", mass_kg=2.0, place=f"/o{n}") for n, each in enumerate(masses(*STEADY))
    ]
    assert judged(masses(*STEADY) + other).outliers == ()


def test_a_doubtful_value_that_says_so_does_not_stand_out() -> None:
    rows = masses(*STEADY, 0.65)
    rows[-1] = replace(rows[-1], mass_sigma_kg=0.03)
    assert judged(rows).outliers == ()


def test_few_sessions_say_nothing() -> None:
    assert judged(masses(*STEADY[: FEWEST - 2], 0.65)).outliers == ()
    assert judged(masses(*STEADY[: FEWEST - 1])).trends == ()
    assert len(judged(masses(*STEADY[:FEWEST])).trends) == 1


@pytest.mark.parametrize("count", [20, 700])
def test_a_drift_is_told_with_its_slope(count: int) -> None:
    rng = np.random.default_rng(3)
    values = 5 + 0.2 * np.arange(count) * 10 / 365.25 + rng.normal(0, 0.02, count)
    rows = [row(n, force_bias_x_N=float(value)) for n, value in enumerate(values)]
    rows[7] = replace(rows[7], force_bias_x_N=9.0)
    found = judged(rows, date(2050, 1, 1))
    (trend,) = found.trends
    assert trend.drifts
    assert trend.per_year == pytest.approx(0.2, abs=0.05)
    assert trend.quantity == "force bias x"
    (outlier,) = found.outliers
    assert outlier.place == "/s/7"
    assert "from the trend" in outlier.sentence


def test_noise_alone_hardly_ever_drifts() -> None:
    rng = np.random.default_rng(5)
    rows = [
        row(n, sensor=f"SN {sensor}", force_bias_x_N=float(rng.normal()), place=f"/{sensor}/{n}")
        for sensor in range(300)
        for n in range(12)
    ]
    assert sum(trend.drifts for trend in judged(rows).trends) <= 1
    few = [each for each in rows if int(each.place.rpartition("/")[2]) < FEWEST]
    assert len(judged(few).outliers) <= 3  # of 2400


def test_the_newest_calibration_and_the_certificate_say_what_is_due() -> None:
    def due(*rows: FleetRow, **rules: Any) -> list[tuple[str, int, str]]:
        return [(each.due, each.days, each.sentence) for each in judged(list(rows), **rules).due]

    assert due(row(0)) == []
    assert due(row(0), max_age=100) == [
        ("2026-04-11", -51, "Calibrated on 2026-01-01; due after 100 days, on 2026-04-11.")
    ]
    assert due(row(0), row(12), max_age=100) == []  # calibrated again
    assert due(row(0), max_age=160) == [
        ("2026-06-10", 9, "Calibrated on 2026-01-01; due after 160 days, on 2026-06-10.")
    ]
    assert due(row(0), max_age=160, soon=8) == []
    ((day, days, words),) = due(row(0, due=date(2026, 5, 31)))
    assert (day, days) == ("2026-05-31", -1)
    assert words == "The sensor's certificate ran out on 2026-05-31."
    assert due(row(0, due=date(2026, 6, 1)))[0][1] == 0
    assert due(row(0, calibrated=None)) == [("", 0, "Never calibrated.")]


def test_a_sensor_without_a_number_hides_no_other() -> None:
    old, new = row(0, sensor=""), row(15, sensor="")
    (due,) = judged([old, new], max_age=100).due
    assert due.place == "/s/0"
    assert "Serial number missing" in due.sentence
    assert judged(masses(*STEADY)).trends
    unnamed = [replace(each, sensor="") for each in masses(*STEADY, 0.65)]
    found = judged(unnamed)
    assert found.trends == found.outliers == ()
    page = fleet_html(table_of(unnamed), found, (), BEGIN)
    assert ">13</" in page.replace("\n", "")  # sensors, as many as sessions
    assert page.count("<svg") == 1


def test_a_date_in_the_future_hides_nothing_and_is_told() -> None:
    today = date(2026, 6, 1)
    later = row(1, calibrated=datetime(2026, 6, 2, tzinfo=UTC))
    found = judged([row(0), later], today, max_age=100)
    assert [(each.place, each.days) for each in found.due] == [("/s/0", -51)]
    assert [(each.place, each.reason) for each in found.outliers] == [("/s/1", "future")]
    (due,) = judged([later], today).due
    assert "date in the future" in due.sentence
    assert not judged([replace(later, calibrated=datetime(2026, 6, 1, 23, 59, tzinfo=UTC))], today).outliers


def test_what_a_session_says_of_itself_is_told() -> None:
    found = judged([row(0, verdict="refuse"), row(1, stale=True), row(2, verification_passed=False), row(3)])
    assert [(each.place, each.reason) for each in found.outliers] == [
        ("/s/0", "refused"),
        ("/s/1", "stale"),
        ("/s/2", "failed"),
    ]


# ---- exit codes and the page -----------------------------------------------------------------------


def test_exit_codes(sessions: Path, tmp_path: Path, calibrated: datetime) -> None:
    over = str(calibrated.date() + timedelta(days=100))
    assert fleet(sessions / "a", sessions / "b", code=0)["due"] == []
    found = fleet(sessions / "a", "--max-age", 100, "--report", tmp_path / "f.html", code=1)
    assert found["due"][0]["days"] == -51
    page = (tmp_path / "f.html").read_text("utf-8")
    assert "SN 7" in page
    assert over in page
    fleet(sessions / "a", "--max-age", 160, code=0)  # soon, not yet
    result = invoke("fleet", sessions / "a", "--max-age", "100")
    assert f"due after 100 days, on {over}" in " ".join(result.output.split())


def test_the_page_is_the_same_again_and_escapes_names() -> None:
    rows = [replace(each, tool="<b>x</b>") for each in masses(*STEADY, 0.65)]
    table = table_of(rows)
    found = judge(table, DueRules(date(2026, 6, 1)))
    pages = {fleet_html(table, found, (Skipped("p", "<i>broken</i>"),), BEGIN) for _ in range(2)}
    (page,) = pages
    assert "<b>x" not in page
    assert "<i>broken" not in page
    assert "&lt;b&gt;x" in page
    assert page.count("<svg") == 2  # of the verdict and of the one sensor with its tool
    assert "<script" not in page
    assert "The mass is 650" in page


def test_every_column_has_a_type() -> None:
    assert [each.name for each in schema()] == list(FleetRow.__dataclass_fields__)
