"""The report tells all, to anybody, from one file that is the same every time."""

import hashlib
import json
import os
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from page_reader import Reader
from report.report_cases import CREATED, content, with_marker_named
from terminal import invoke, said
from weighing_files import weighed

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import load_record, save_calibration
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.sidecar import save_probe_file
from contactbench.pipeline.page import print_pdf
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.report import read_verification, report_html
from contactbench.pipeline.report.figures import draw
from contactbench.pipeline.report.page import settings_rows, summaries
from contactbench.pipeline.report.picture import error_map, marker_views
from contactbench.pipeline.report.report_file import report as make
from contactbench.pipeline.verification.figures import ForceAccuracy, ModelError


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    file = tmp_path_factory.mktemp("calibration") / "c.json"
    save_calibration(calibrate(weighed().poses), file, created=CREATED)
    return replace(content(markers=5), calibration=load_record(file))


@pytest.fixture(scope="module")
def page(given):
    return report_html(given)


@pytest.fixture(scope="module")
def files(given, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    (folder / "v.json").write_bytes(given.verification.to_bytes())
    save_probe_file(given.probe, folder / "p.ply")
    save_calibration(calibrate(weighed().poses), folder / "c.json", created=CREATED)
    return folder


def test_the_page_is_one_file_without_scripts(page):
    assert all(link.startswith(("data:image/png;base64,", "#")) for link in Reader(page).links)
    assert "<script" not in page
    assert not re.search(r"url\((?!['\"]?#)", page)
    assert "size: A4" in page


def test_the_page_tells_what_was_found(page, given):
    text = Reader(page).text
    overall = given.verification.overall
    for words in (
        "Passed",
        f"{overall.mean_mm:.2f} mm",
        f"{overall.max_mm:.2f} mm",
        "1.3 × errors of the touches (rms) over noise and calibration alone",
        "9 µs",
        given.verification.diagnosis.text,
        "A. Technician",
        "sensor M8128: SN 7",
        "2026-03-04 05:06 UTC",
        "slipped (1)",
        "mean 1 mm, largest 2 mm",
        "simplify",
        "ab" * 32,
        "mass of probe and holder",
        "worth correcting",
    ):
        assert words in text
    for marker in given.verification.per_marker:
        assert marker.name in text


def test_the_same_content_gives_the_same_bytes_in_any_process(given, page, files):
    assert report_html(given) == page
    code = (
        "import sys; from pathlib import Path\n"
        "from contactbench.pipeline.report import page; from contactbench.pipeline.report.report_file import report\n"
        "page._PIXELS = 60\n"
        "f = Path(sys.argv[1]); i = {'verification': f / 'v.json', 'probe': f / 'p.ply', 'calibration': f / 'c.json'}\n"
        "sys.stdout.buffer.write(report(i, {}, '2026-03-04T05:06:00+00:00')['report.html'])"
    )
    inputs = {"verification": files / "v.json", "probe": files / "p.ply", "calibration": files / "c.json"}
    here = make(inputs, {}, "2026-03-04T05:06:00+00:00")["report.html"]
    environment = {**os.environ, "PYTHONHASHSEED": "7", "TZ": "Asia/Tokyo", "LC_ALL": "C"}
    there = subprocess.run(
        [sys.executable, "-c", code, str(files)], capture_output=True, check=True, env=environment
    )
    assert there.stdout == here


def test_a_failure_is_said_first(given):
    failed = replace(given, verification=content(passed=False, markers=3).verification)
    text = Reader(report_html(failed)).text
    assert "Failed" in text
    assert "The mean error is 1.20 mm, over 1 mm." in text
    assert "What to fix first" in text


def test_what_the_model_leaves_is_told(given):
    assert (
        "The model error was not measured; 0.05 N, 1.0 mN·m are assumed." in Reader(report_html(given)).text
    )
    left = ModelError(0.06, 0.0012, 0.05, 0.001, 0.08, 0.002, 12.4)
    measured = replace(given, verification=replace(given.verification, model_error=left))
    words = "Model error: 0.06 N, 1.2 mN·m (95 % upper limit 0.08 N, 2.0 mN·m; the touches count as 12"
    assert words in Reader(report_html(measured)).text


def test_names_cannot_become_markup(given):
    page = report_html(
        replace(
            with_marker_named(given, "<img src=x>&\u202e"), details=ReportDetails("<script>alert(1)</script>")
        )
    )
    assert "<img src=x" not in page
    assert "<script" not in page
    assert "\u202e" not in page


def test_a_verification_without_a_single_accepted_touch_has_a_page(given):
    v = given.verification
    nothing = replace(
        v,
        touches=v.touches[-1:],
        per_marker=(),
        per_repeat=(),
        per_force=(),
        per_angle=(),
        overall=None,
        ci=None,
        ratio=None,
        times=None,
        diagnosis=None,
        alignment_refined=None,
        verdict=replace(v.verdict, passed=False, reasons=("no touch was accepted",)),
    )
    text = Reader(report_html(replace(given, verification=nothing, calibration=None))).text
    assert "No touch was accepted." in text
    assert "0 of 1 touches used" in text


def test_markers_are_seen_from_outside(given):
    probe = given.probe.probe
    accepted = [touch for touch in given.verification.touches if touch.accepted]
    views = marker_views(accepted, probe)
    assert [view.name for view in views] == [f"M{i + 1}" for i in range(5)]
    for view in views:
        sizes = [t.distance_mm for t in accepted if t.marker == view.name]
        assert ((view.flat_mm**2).sum(axis=1) ** 0.5 <= [1e-9 + size for size in sizes]).all()
    made = error_map(accepted, probe)
    assert made.contacts == len(accepted)
    assert made.total == pytest.approx(given.verification.overall.mean_mm)
    assert error_map([], probe) is None


def test_a_verification_is_read_back_as_it_was(given, files):
    assert read_verification(files / "v.json") == given.verification


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.update(schema="x"), "no verification"),
        (lambda d: d.update(version=9), "version 9"),
        (lambda d: d["overall"].update(mean_mm="much"), "overall.mean_mm"),
        (lambda d: d.pop("limits"), "limits"),
    ],
)
def test_a_wrong_verification_is_refused_by_name(files, tmp_path, change, words):
    data = json.loads((files / "v.json").read_bytes())
    change(data)
    (tmp_path / "v.json").write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(InputError, match=words):
        read_verification(tmp_path / "v.json")


def test_what_is_no_verification_at_all_is_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        read_verification(tmp_path / "none.json")
    (tmp_path / "v.json").write_text('{"schema": NaN}', encoding="utf-8")
    with pytest.raises(InputError, match="not JSON"):
        read_verification(tmp_path / "v.json")


def test_a_probe_that_is_not_aligned_has_no_report(given):
    with pytest.raises(InputError, match="not aligned"):
        report_html(replace(given, probe=replace(given.probe, frame="P")))
    with pytest.raises(InputError, match="zone"):
        report_html(replace(given, created=CREATED.replace(tzinfo=None)))


@pytest.mark.parametrize("parameters", [{"name": "x.txt"}, {"name": "a/b.html"}, {"colour": 1}])
def test_wrong_parameters_are_refused(files, parameters):
    with pytest.raises(InputError):
        make({"verification": files / "v.json", "probe": files / "p.ply"}, parameters, None)


def test_a_pdf_or_the_remedy(page, monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.page.find_spec", lambda _: None)
    with pytest.raises(InputError, match=r"contactbench\[pdf\]"):
        print_pdf(page)
    monkeypatch.undo()
    pytest.importorskip("weasyprint")
    assert print_pdf(page).startswith(b"%PDF")


def test_the_command(files):
    out = files / "report.html"
    others = ("--calibration", files / "c.json", "--probe", files / "p.ply", "--out", out)
    options = (*others, "--serial=M8128=SN 7", "--operator=A. B.", "--json")
    done = invoke("verify", "report", "--verification", files / "v.json", *options)
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["bytes"] == out.stat().st_size
    assert "SN 7" in out.read_text("utf-8")
    wrong = invoke("verify", "report", "--verification", files / "c.json", *options)
    assert wrong.exit_code == 2
    assert "no verification" in wrong.output


def test_another_probe_than_the_verified_one_is_refused(given, files, tmp_path):
    verified = hashlib.sha256((files / "p.ply").read_bytes()).hexdigest()
    v = replace(given.verification, sources={"probe": verified, "calibration": "0" * 64})
    (tmp_path / "v.json").write_bytes(v.to_bytes())
    inputs = {"verification": tmp_path / "v.json", "probe": files / "p.ply"}
    assert make(inputs, {}, None)["report.html"]
    with pytest.raises(InputError, match=r"c\.json: this is not the calibration that was verified"):
        make({**inputs, "calibration": files / "c.json"}, {}, None)
    save_probe_file(content(facets=900).probe, tmp_path / "q.ply")
    with pytest.raises(InputError, match="not the probe that was verified"):
        make({**inputs, "probe": tmp_path / "q.ply"}, {}, None)


def test_one_touch_of_a_marker_tells_no_spread(given):
    v = given.verification
    once = tuple(replace(each, touches=1, sd_mm=0.0, scatter_mm=0.0) for each in v.per_marker)
    rows = dict(summaries(replace(v, per_marker=once)))["marker"]
    assert {rows[0][name] for name in ("sd", "scatter", "p95")} == {"–"}
    assert rows[0]["mean"] != "–"
    accepted = [touch for touch in v.touches if touch.accepted]
    pictures = [
        draw(accepted, [replace(each, touches=n) for each in v.per_marker], [], v.limits, None).parts
        for n in (1, 2, 3)
    ]
    assert [bool(picture) for picture in pictures] == [False, False, True]


def test_how_it_was_verified_is_told(given):
    settings = {
        "protocol": {"windows": [[8.0, 10.0]], "samples": 50, "order": []},
        "noise_force": None,
        "mount": [0.0, 0.0, 90.0],
        "rate_hz": 1000.0,
    }
    rows = settings_rows(settings)
    assert ("force windows, N", "8 to 10") in rows
    assert ("noise of a force sample, N", "measured within the touches") in rows
    assert ("mount", "0, 0, 90") in rows
    force = ForceAccuracy(17, -0.2, 0.1, 0.53, 4.2)
    v = replace(given.verification, settings=settings, force=force)
    text = Reader(report_html(replace(given, verification=v))).text
    assert "readings a second, Hz" in text
    assert f"numpy{np.__version__}" in text.replace("numpy ", "numpy")
    assert "largest 0.53 N, 4.2 % (rms) of the force, over 17 touches" in text


def test_a_name_that_the_font_lacks_is_kept_without_a_warning(given):
    assert "\u6807\u8bb0" in report_html(with_marker_named(given, "\u6807\u8bb0"))


# ---- known weight and known touch ----------------------------------------------------------------


def known(kind, outcome="passed", **more):
    words = {"passed": "The sensor reads 1.001 kg.", "failed": "The check failed. Torques in N·mm."}[outcome]
    return {
        "schema": f"contactbench.{kind}", "version": 1, "sentence": words, "outcome": outcome,
        "created": "2026-03-04T05:06:00Z", "calibration_sha256": "ab" * 32, "probe_sha256": "cd" * 32, **more,
    }  # fmt: skip


def test_a_report_says_when_nothing_known_was_checked(given):
    assert "Neither was checked:" in Reader(report_html(given)).text


def test_a_report_shows_both_checks(given):
    weight = known("known_weight", certificate="DKD-7")
    checks = {"known_weight": weight, "known_touch": known("known_touch", "failed")}
    text = Reader(report_html(replace(given, checks=checks))).text
    assert "Neither was checked" not in text
    for words in ("Known weight", "passed", "certificate DKD-7, 2026-03-04 05:06 UTC", "failed", "N·mm"):
        assert words in text


def test_a_check_of_another_calibration_is_not_shown_as_one_of_this(given):
    v = replace(given.verification, sources={"calibration": "0" * 64})
    checks = {"known_weight": known("known_weight")}
    text = Reader(report_html(replace(given, verification=v, checks=checks))).text
    assert "not of this" in text
    assert "made with another calibration: check again" in text


def test_the_command_takes_the_checks_and_refuses_other_files(files, tmp_path):
    (tmp_path / "w.json").write_text(json.dumps(known("known_weight")), encoding="utf-8")
    arguments = ["verify", "report", "--verification", files / "v.json", "--probe", files / "p.ply", "--out"]
    options = ["--known-weight", tmp_path / "w.json"]
    result = invoke(*arguments, tmp_path / "r.html", *options)
    assert result.exit_code == 0, result.stderr
    assert "The sensor reads 1.001 kg" in Reader((tmp_path / "r.html").read_text("utf-8")).text
    for wrong in ({"version": 2}, {"outcome": "perhaps"}, {"sentence": None}):
        (tmp_path / "w.json").write_text(json.dumps(known("known_weight") | wrong), encoding="utf-8")
        result = invoke(*arguments, tmp_path / "r.html", *options)
        assert result.exit_code == 2
        assert "not a contactbench.known_weight of version 1" in said(result)
