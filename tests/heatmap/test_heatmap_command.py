"""``contactbench heatmap draw`` on what ``locate`` wrote, and on a recording."""

import json
from pathlib import Path

import numpy as np
import pytest
from terminal import invoke
from weighing_files import weighed

from contactbench.assets import make
from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import save_calibration
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.mesh import Probe, save_probe
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.session import Session

N = 300


@pytest.fixture(scope="module", autouse=True)
def _coarsely_drawn():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("contactbench.pipeline.heatmap.subdivide._MOST_FACETS", 8_000)
        yield


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """Touches of two places, 6 and 9 N, as wrenches and as a recording with the weight in it."""
    folder = tmp_path_factory.mktemp("bench")
    probe = Probe.from_arrays(*make("linear", 1_500), name="linear")
    save_probe(probe, folder / "p.ply")
    centroids = probe.vertices[probe.faces].mean(axis=1)
    top = np.flatnonzero(probe.normals[:, 2] > 0.9)
    places = top[[0, len(top) // 2]]
    chosen = np.repeat(places, N // 2)
    size = np.repeat([6.0, 9.0], N // 2)
    force = -size[:, None] * probe.normals[chosen]
    wrenches = np.hstack([force, np.cross(centroids[chosen], force)])
    times = 100 + np.arange(N) * 0.01
    rows = "\n".join(
        ",".join(map(repr, [float(t), *w.tolist()])) for t, w in zip(times, wrenches, strict=True)
    )
    (folder / "w.csv").write_text(f"t,fx,fy,fz,mx,my,mz\n{rows}\n", encoding="utf-8")
    marks = "\n".join(
        f"M{i},{','.join(map(repr, (1e3 * centroids[f] + [0.3, 0, 0]).tolist()))}"
        for i, f in enumerate(places)
    )
    (folder / "m.csv").write_text(f"name,x_mm,y_mm,z_mm\n{marks}\n", encoding="utf-8")
    calibration = calibrate(weighed().poses)
    save_calibration(calibration, folder / "c.json")
    raw = wrenches + calibration.model.predict(np.eye(3))
    raw += np.random.default_rng(2).normal(0, 1e-9, raw.shape)  # without any noise a sensor counts as hung
    devices = (
        DeviceInfo("wrench", "/wrench", "sri://x", "M", "1", 100.0),
        DeviceInfo("flange", "/flange", "elfin://y"),
    )
    with RecordingWriter(folder / "r.mcap", RecordingInfo(0, 100.0, devices)) as writer:
        for t, w in zip(times.tolist(), raw.tolist(), strict=True):
            writer.wrench(WrenchSample(t, tuple(w[:3]), tuple(w[3:])))
            writer.flange(FlangeSample(t, np.eye(3), np.zeros(3)))
    run("locate", folder / "w.csv", "--probe", folder / "p.ply", "--out", folder / "contacts.csv")
    return folder


def run(*arguments, code=0):
    done = invoke(*arguments)
    assert done.exit_code == code, done.output
    return done


def facts(*arguments):
    return json.loads(run("heatmap", "draw", *arguments, "--json").stdout)


@pytest.mark.parametrize("suffix", ["png", "ply", "glb"])
def test_a_density_of_located_contacts(bench, suffix):
    out = bench / f"density.{suffix}"
    said = facts(bench / "contacts.csv", "--probe", bench / "p.ply", "--bandwidth", 2, "--out", out)
    assert (said["contacts"], said["total"], said["unit"], said["bandwidth_mm"]) == (N, N, "1/mm²", 2.0)
    assert out.stat().st_size > 10_000


def test_a_recording_gives_what_its_wrenches_give(bench):
    shared = ["--probe", bench / "p.ply", "--quantity", "force", "--out", bench / "force.ply"]
    recorded = facts(bench / "r.mcap", "--calibration", bench / "c.json", *shared)
    located = facts(bench / "contacts.csv", "--wrenches", bench / "w.csv", *shared)
    assert recorded["contacts"] == located["contacts"] == N
    assert recorded["total"] == pytest.approx(7.5, abs=1e-6)
    assert recorded["largest"] == pytest.approx(located["largest"], rel=1e-4)
    assert located["largest"] == pytest.approx(9.0, rel=1e-3)


def test_seconds_and_rate(bench):
    shared = [bench / "contacts.csv", "--probe", bench / "p.ply", "--out", bench / "d.ply", "--per"]
    assert facts(*shared, "seconds")["total"] == pytest.approx(N * 0.01)
    assert facts(*shared, "rate")["total"] == pytest.approx(100.0)


def test_error_and_uncertainty(bench):
    shared = [bench / "contacts.csv", "--probe", bench / "p.ply", "--out", bench / "d.ply", "--quantity"]
    assert facts(*shared, "error", "--markers", bench / "m.csv")["total"] == pytest.approx(0.3, abs=0.01)
    assert facts(*shared, "uncertainty")["unit"] == "mm"


def test_errors_of_a_recording_are_those_of_settled_samples(bench):
    shared = ["--probe", bench / "p.ply", "--out", bench / "d.ply"]
    shared += ["--quantity", "error", "--markers", bench / "m.csv"]
    said = facts(bench / "r.mcap", "--calibration", bench / "c.json", *shared)
    # The ends, and where one touch follows the other: 0.1 s before and after.
    assert N - 50 < said["contacts"] < N - 35
    assert said["left_out"]["not settled"] == N - said["contacts"]
    assert said["total"] == pytest.approx(0.3, abs=0.02)
    assert len(said["noise"]["force_N"]) == 3
    unknown = facts(bench / "contacts.csv", *shared)
    assert unknown["noise"] is None
    assert unknown["contacts"] == N
    assert "unsettled samples" in unknown["warnings"][0]


def test_a_session_gives_its_newest_files(bench, tmp_path):
    with Session.create(tmp_path / "s", by="ada") as session:
        for kind, name in (("recording", "r.mcap"), ("probe", "p.ply"), ("calibration", "c.json")):
            session.add_input(bench / name, kind)
    said = facts(tmp_path / "s", "--quantity", "force", "--out", tmp_path / "f.ply")
    assert (said["contacts"], said["counted"]) == (N, "samples")


@pytest.mark.parametrize(
    "given", [["r.mcap", "--calibration", "c.json"], ["contacts.csv", "--wrenches", "w.csv"]]
)
def test_a_window_of_time_and_a_range_of_force(bench, monkeypatch, given):
    monkeypatch.chdir(bench)
    shared = [*given, "--probe", "p.ply", "--quantity", "force"]
    whole = facts(*shared, "--out", "whole.ply")
    assert facts(*shared, "--out", "all.ply", "--from", 0, "--to", 60)["left_out"] == whole["left_out"]
    assert (bench / "all.ply").read_bytes() == (bench / "whole.ply").read_bytes()
    early = facts(*shared, "--out", "early.ply", "--to", 0.999)
    assert (early["contacts"], early["left_out"]["outside the time window"]) == (100, 200)
    assert early["total"] == pytest.approx(6.0, abs=1e-6)
    hard = facts(*shared, "--out", "hard.ply", "--force-from", 8)
    assert (hard["contacts"], hard["left_out"]["outside the force range"]) == (150, 150)
    assert hard["total"] == pytest.approx(9.0, abs=1e-6)


def without(file, column):
    """Return a copy of a table without a column."""
    rows = [line.split(",") for line in file.read_text(encoding="utf-8").splitlines()]
    place = rows[0].index(column)
    copy = file.with_name(f"without-{column}.csv")
    copy.write_text(
        "".join(",".join(row[:place] + row[place + 1 :]) + "\n" for row in rows), encoding="utf-8"
    )
    return copy


def test_weighed_by_confidence(bench):
    shared = ["--probe", bench / "p.ply", "--out", bench / "sure.ply"]
    old = without(bench / "contacts.csv", "confidence")
    assert facts(old, *shared)["total"] == N
    done = run("heatmap", "draw", old, *shared, "--by-confidence", code=2)
    assert "without-confidence.csv: these contacts have no confidence" in " ".join(done.output.split())
    rows = old.read_text(encoding="utf-8").splitlines()
    file = bench / "half.csv"
    sure = [1.0 if number < N // 2 else 0.5 for number in range(N)]
    file.write_text(
        "\n".join([f"{rows[0]},confidence", *(f"{row},{c}" for row, c in zip(rows[1:], sure, strict=True))]),
        encoding="utf-8",
    )
    said = facts(file, *shared, "--by-confidence")
    assert (said["by_confidence"], said["total"]) == (True, pytest.approx(0.75 * N))
    assert facts(file, *shared)["total"] == N
    located = facts(bench / "contacts.csv", *shared, "--by-confidence")["total"]
    recorded = [bench / "r.mcap", "--calibration", bench / "c.json", *shared, "--by-confidence"]
    assert N / 2 < located <= N
    assert N / 2 < facts(*recorded)["total"] <= N


def test_a_confidence_that_is_none_is_refused(bench):
    text = (bench / "contacts.csv").read_text(encoding="utf-8").splitlines()
    place = text[0].split(",").index("confidence")
    cells = text[3].split(",")
    cells[place] = "1.5"
    wrong = bench / "wrong.csv"
    wrong.write_text("\n".join([*text[:3], ",".join(cells), *text[4:]]), encoding="utf-8")
    done = run("heatmap", "draw", wrong, "--probe", bench / "p.ply", "--out", bench / "x.ply", code=2)
    assert "wrong.csv: row 3: the confidence is 1.5" in " ".join(done.output.split())


@pytest.mark.parametrize("doubt", ["ambiguous", "uncertain"])
def test_only_sure_places_are_shown(bench, doubt):
    text = (bench / "contacts.csv").read_text(encoding="utf-8").splitlines()
    rows = [
        row.replace(",ok,", f",{reason},")
        for row, reason in zip(
            text[1:],
            ("ok", "vertex", "by_region", doubt, "two_touches", "outside_region", *["ok"] * N),
            strict=False,
        )
    ]
    file = bench / "reasons.csv"
    file.write_text("\n".join([text[0], *rows]), encoding="utf-8")
    said = facts(file, "--probe", bench / "p.ply", "--out", bench / "d.ply", "--bandwidth", 3)
    assert said["contacts"] == N - 3
    assert said["left_out"] == {doubt: 1, "outside_region": 1, "two_touches": 1}
    assert said["warnings"] == []
    file.write_text(
        "\n".join(
            [text[0], *(row.replace(",ok,", f",{doubt},") for row in text[1 : N // 2]), *text[N // 2 :]]
        ),
        encoding="utf-8",
    )
    said = facts(file, "--probe", bench / "p.ply", "--out", bench / "d.ply", "--bandwidth", 3)
    assert f"{N // 2 - 1} of {N} contacts are {doubt}" in said["warnings"][0]


def test_a_film_of_contacts(bench):
    out = bench / "film.gif"
    said = facts(
        bench / "contacts.csv", "--probe", bench / "p.ply", "--speed", 20, "--last", 0.5, "--out", out
    )
    assert said["contacts"] == N
    assert out.read_bytes().startswith(b"GIF8")
    errors = ["--quantity", "error", "--markers", bench / "m.csv", "--speed", 50]
    run("heatmap", "draw", bench / "contacts.csv", "--probe", bench / "p.ply", "--out", out, *errors)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["contacts.csv", "--out", "x.jpg"], ".png"),
        (["contacts.csv", "--out", "x.ply", "--last", "2"], "--last is for a film"),
        (["contacts.csv", "--out", "x.ply", "--from", "90"], "no contact from 90 s on"),
        (["contacts.csv", "--out", "x.ply", "--force-from", "2"], "forces"),
        (["contacts.csv", "--out", "x.gif", "--speed", "99"], "choose 0.1 to 50"),
        (["contacts.csv", "--out", "x.ply", "--quantity", "peak"], "--wrenches"),
        (["contacts.csv", "--out", "x.ply", "--quantity", "error"], "--markers"),
        (["r.mcap", "--out", "x.ply"], "--calibration"),
        (["contacts.csv", "--out", "contacts.ply", "--calibration", "c.json"], "recording"),
        (["m.csv", "--out", "x.ply"], "missing"),
        (["none.csv", "--out", "x.ply"], "check the path"),
        (["contacts.csv", "--out", "no/such/x.ply"], "cannot be written"),
        (["contacts.csv", "--out", "x.ply", "--bandwidth", "0"], "bandwidth"),
        (["contacts.csv", "--out", "x.ply", "--quantity", "error", "--markers", "w.csv"], "x_mm"),
    ],
)
def test_wrong_use_is_refused(bench, monkeypatch, arguments, words):
    monkeypatch.chdir(bench)
    done = run("heatmap", "draw", *arguments, "--probe", "p.ply", code=2)
    assert words in " ".join(done.output.split())
    assert not Path("x.ply").exists()
