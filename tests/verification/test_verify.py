import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.verification import bench
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation
from terminal import invoke
from typer.testing import CliRunner
from verification.touch_cases import MODEL, Push, markers, probe, stream
from weighing_files import draw_weighing

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import save_calibration
from contactbench.pipeline.cli import app
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import save_probe
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.recording.messages import FLANGE_TOPIC, WRENCH_TOPIC
from contactbench.pipeline.verification.figures import ErrorCause, VerificationLimits
from contactbench.pipeline.verification.markers import make_markers
from contactbench.pipeline.verification.protocol import Touch, measured_noise, resting
from contactbench.pipeline.verification.reference import force_accuracy
from contactbench.pipeline.verification.result import (
    VerificationParameters,
    load_surface,
    verification,
    verify_files,
)
from contactbench.pipeline.verification.source import TouchRecording, clock_sentences, read_touch_recording
from contactbench.pipeline.verification.verdict import crowded
from contactbench.pipeline.verification.verify import VerifySettings, verify


@pytest.fixture(scope="module")
def good():
    return bench(None, np.random.default_rng(5))


@pytest.fixture(scope="module")
def files(tmp_path_factory, good):
    """A bench as files, its recording read anew with a calibration that a file can hold."""
    folder = tmp_path_factory.mktemp("bench")
    weighing = draw_weighing(
        np.random.default_rng(3), poses=(12, 12), force_noise=(0.01, 0.02), torque_noise=(3e-4, 5e-4)
    )
    calibration = calibrate(weighing.poses, weighing.noise)
    save_probe(good.probe, folder / "probe.ply")
    save_calibration(calibration, folder / "calibration.json")
    good.markers.save(folder / "markers.csv")
    rec = good.recording
    raw = rec.wrenches - good.model.predict(rec.R_WS) + calibration.model.predict(rec.R_WS)
    q = Rotation.from_matrix(rec.R_WS).as_quat()[:, [3, 0, 1, 2]]
    table = np.column_stack([rec.times, raw, q])
    header = "t,fx,fy,fz,mx,my,mz,qw,qx,qy,qz"
    np.savetxt(folder / "touches.csv", table, delimiter=",", fmt="%.17g", header=header, comments="")
    devices = (
        DeviceInfo("wrench", WRENCH_TOPIC, "virtual://a", "a", rate=200.0),
        DeviceInfo("flange", FLANGE_TOPIC, "virtual://a", "a", rate=200.0),
    )
    with RecordingWriter(
        folder / "touches.mcap", RecordingInfo(10**18, 0.0, devices), clock=lambda: 0.0
    ) as writer:
        for number, (time, wrench) in enumerate(zip(rec.times.tolist(), raw.tolist(), strict=True)):
            writer.wrench(WrenchSample(time, tuple(wrench[:3]), tuple(wrench[3:]), number, Status.OK))
            writer.flange(FlangeSample(time, rec.R_WS[number], np.full(3, np.nan)))
    np.savetxt(
        folder / "reference.csv", [[0.0, 9.0], [100.0, 9.0]], delimiter=",", header="t,force", comments=""
    )
    return folder


def inputs(folder, recording="touches.csv"):
    names = {"probe": "probe.ply", "calibration": "calibration.json", "markers": "markers.csv"}
    return {**{role: folder / name for role, name in names.items()}, "recording": folder / recording}


def arguments(folder, recording="touches.csv"):
    given = inputs(folder, recording)
    options = [
        part for role in ("probe", "calibration", "markers") for part in (f"--{role}", str(given[role]))
    ]
    return ["verify", "touches", *options, str(given["recording"])]


def test_a_good_bench_passes_and_every_touch_is_accounted_for(good):
    found = good.verified()
    assert found.verdict.passed, found.verdict.reasons
    assert found.overall.mean_mm < 0.3
    assert 0.5 < found.ratio < 1.6
    assert len(found.touches) == 34
    assert sum(found.rejected.values()) + found.overall.touches == 34
    assert {touch.marker for touch in found.touches if touch.accepted} == set(good.markers.names)
    assert sum(group.touches for group in found.per_angle) == found.overall.touches
    assert sum(group.touches for group in found.per_marker) == found.overall.touches
    assert found.times is None


@pytest.mark.parametrize("leaning", [False, True])
def test_where_the_zero_follows_each_touch_says_what_was_taken_off_and_when_it_was_seen(leaning):
    times, wrenches, R_WS = stream(*[Push(marker, held=0.6) for marker in (0, 1, 2)] * 2)
    off = np.array([0.1, -0.05, 0.08, 0.002, 0.001, -0.001])
    raw = wrenches - MODEL.compensate(R_WS, 0 * wrenches) + off
    raw[180:240, 0] += 0.4 * leaning  # between the first touch and the second
    recording = TouchRecording(times, raw, R_WS, np.zeros(len(times), dtype=bool))
    found, without = (
        verify(probe(), MODEL, markers(), recording, VerifySettings(follow=follow))
        for follow in (True, False)
    )
    assert all(np.allclose(each.zero.taken, off, atol=0.03) for each in found.touches)
    assert [each.zero.seen_s < 0.5 for each in found.touches] == [True, not leaning, True, True, True, True]
    said = "not seen just before 1 of 6 touches (2)" if leaning else "seen before every touch, at most 0."
    assert said in " ".join(found.warnings)
    assert found.diagnosis.drift.evidence > 0
    assert all("zero" not in each for each in without.to_json()["touches"])
    assert without.diagnosis is None or "drift" not in without.to_json()["diagnosis"]


def test_the_figures_are_those_of_the_vectors(good):
    found = good.verified()
    errors = np.array([touch.error_mm for touch in found.touches if touch.accepted])
    np.testing.assert_allclose(found.bias_mm, errors.mean(axis=0), atol=1e-12)
    assert found.overall.max_mm == pytest.approx(np.linalg.norm(errors, axis=1).max())
    content = json.loads(found.to_bytes())
    assert content["schema"] == "contactbench.verification"
    assert content["bias_mm"] == pytest.approx(errors.mean(axis=0))
    assert found.to_bytes() == good.verified().to_bytes()


def test_noise_is_measured_within_touches_even_where_nothing_is_between_them(good):
    kept = np.linalg.norm(good.recording.compensated(good.model).wrenches[:, :3], axis=1) > 4
    rec = good.recording
    pressed = replace(
        rec,
        times=np.arange(kept.sum()) / 200 + 2.0 * (np.arange(kept.sum()) // 100),
        wrenches=rec.wrenches[kept],
        R_WS=rec.R_WS[kept],
        saturated=rec.saturated[kept],
    )
    found = verify(good.probe, good.model, good.markers, pressed)
    assert len(found.touches) == 34
    assert 0.5 < found.ratio < 1.6


@pytest.mark.parametrize("cause", list(ErrorCause)[:-1])  # not drift: only a zero that follows leaves some
def test_the_cause_that_was_put_in_is_named(cause):
    found = bench(cause, np.random.default_rng(11)).verified()
    assert found.diagnosis.first is cause
    assert str(cause) in found.diagnosis.text
    assert sum(share.share for share in found.diagnosis.shares) == pytest.approx(1.0)


def test_touches_with_a_gripping_tip_speak_against_it_and_are_in_no_figure():
    found = bench(ErrorCause.TORSION, np.random.default_rng(11)).verified()
    assert found.rejected == {"no single touch explains it": 34}
    assert found.overall is None
    assert found.model_error is None
    assert found.unresolved.touches == found.unresolved.settled == 34
    assert any("no marker (34 no single touch explains it)" in reason for reason in found.verdict.reasons)
    assert any("34 of 34 settled touches leave a torque" in said for said in found.warnings)


def test_a_wrong_alignment_is_refined_and_judged_on_the_other_markers():
    wrong = bench(ErrorCause.ALIGNMENT, np.random.default_rng(5)).verified()
    refined = wrong.alignment_refined
    assert set(refined.fitted).isdisjoint(refined.judged)
    assert refined.helps
    assert refined.judged_after_mm < 0.4 * refined.judged_before_mm
    right = bench(None, np.random.default_rng(5)).verified().alignment_refined
    assert not right.helps
    assert np.linalg.norm(right.shift_mm) < 1.0


def test_limits_decide_the_verdict(good):
    strict = good.verified(VerifySettings(limits=VerificationLimits(mean_m=1e-5, max_m=2e-5)))
    assert not strict.verdict.passed
    assert "mean error" in strict.verdict.reasons[0]
    more = good.verified(replace(VerifySettings(), protocol=replace(VerifySettings().protocol, repeats=3)))
    assert more.missing == good.markers.names
    assert not more.verdict.passed


def test_a_marker_that_is_left_out_for_a_reason_is_not_missing_and_its_touches_count(good):
    first, *others = good.markers.names
    asked = replace(VerifySettings().protocol, repeats=3)
    found = good.verified(VerifySettings(asked, left_out={first: "nothing reaches it"}))
    assert found.missing == tuple(others)
    assert any(f"{first} (nothing reaches it)" in note for note in found.verdict.notes)
    assert found.settings["left_out"] == {first: "nothing reaches it"}
    assert found.overall == good.verified().overall
    assert "left_out" not in good.verified().settings
    with pytest.raises(InputError, match="no markers Nowhere"):
        good.verified(VerifySettings(left_out={"Nowhere": "why"}))
    with pytest.raises(InputError, match="give the reason"):
        VerifySettings(left_out={first: " "})


def test_nothing_touched_is_wrong_input(good):
    free = good.recording.wrenches[:10].copy()
    part = replace(
        good.recording,
        times=good.recording.times[:10],
        wrenches=free,
        R_WS=good.recording.R_WS[:10],
        saturated=good.recording.saturated[:10],
    )
    with pytest.raises(InputError, match="the recording contains no touch"):
        verify(good.probe, good.model, good.markers, part)


# ---- files -------------------------------------------------------------------------------------


def test_a_recording_reads_the_same_from_mcap_and_csv(files):
    table, tape = (read_touch_recording(files / name) for name in ("touches.csv", "touches.mcap"))
    np.testing.assert_allclose(tape.times, table.times, atol=1e-6)
    np.testing.assert_allclose(tape.wrenches, table.wrenches, atol=1e-6)
    np.testing.assert_allclose(tape.R_WS, table.R_WS, atol=1e-6)


def test_the_status_of_a_table_marks_clipped_readings(tmp_path):
    file = tmp_path / "t.csv"
    file.write_text(
        "t,fx,fy,fz,mx,my,mz,qw,qx,qy,qz,status\n0,1,2,3,4,5,6,1,0,0,0,1\n1,1,2,3,4,5,6,1,0,0,0,0\n",
        encoding="utf-8",
    )
    assert read_touch_recording(file).saturated.tolist() == [True, False]


def test_a_session_and_the_command_write_the_same_bytes(files, tmp_path):
    out = tmp_path / "v.json"
    ended = invoke(*arguments(files), "--out", out, "--json")
    assert ended.exit_code == 0, ended.output
    assert "Model error: 0.0" in ended.output
    told = json.loads(ended.stdout)
    assert told["model_error"]["force_N"] < 0.05
    given = {"name": "v.json", "times": [told["times"][key] for key in ("count", "median_s", "p99_s")]}
    made = [verification(inputs(files), given, created)["v.json"] for created in (None, "any")]
    assert made[0] == made[1] == out.read_bytes()
    untimed = json.loads(verification(inputs(files), {"name": "v.json"}, None)["v.json"])
    assert untimed["times"] is None
    assert untimed["verdict"]["notes"] == ["time: not measured"]
    assert told["verdict"]["notes"] == []
    assert {"rate_Hz", "mount", "filters", "gates"} <= set(told["settings"])
    assert told["settings"]["rate_Hz"] == 200.0
    assert told["times"]["p99_s"] < 1e-3
    assert set(told["sources"]) == {"probe", "calibration", "markers", "recording"}


def test_times_that_were_measured_before_are_judged(files):
    slow = VerificationParameters(name="v.json", times=(10, 0.001, 0.002))
    found = verify_files(inputs(files), slow)
    assert not found.verdict.passed
    assert "99 %" in found.verdict.reasons[0]


def test_forces_are_compared_with_a_reference(files):
    given = {**inputs(files), "reference": files / "reference.csv"}
    found = verify_files(given, VerificationParameters(name="v.json"))
    assert found.force is None  # its two samples are far from every touch
    times = np.arange(0, 30, 0.05)
    np.savetxt(
        files / "r2.csv",
        np.column_stack([times, np.full(len(times), 9.0)]),
        delimiter=",",
        header="t,force",
        comments="",
    )
    found = verify_files({**given, "reference": files / "r2.csv"}, VerificationParameters(name="v.json"))
    assert abs(found.force.mean_N) < 0.3
    assert found.force.max_N < 1.0


def test_the_unit_of_a_foreign_mesh_is_found_and_doubts_are_told(files, good, tmp_path):
    def obj(factor, head=""):
        file = tmp_path / "probe.obj"
        rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in (factor * good.probe.vertices).tolist()]
        rows += [f"f {a} {b} {c}" for a, b, c in (good.probe.faces + 1).tolist()]
        file.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
        return file

    for factor, head in ((1e3, ""), (1.0, "# units: m"), (100.0, "# units: cm")):
        assert load_surface(obj(factor, head)).size == pytest.approx(good.probe.size, rel=1e-9)
    given = VerificationParameters(name="v.json")
    for factor, doubtful in ((1e3, False), (100.0, True)):  # only hundredths need not be centimetres
        found = verify_files({**inputs(files), "probe": obj(factor)}, given)
        assert any("are assumed" in said for said in found.warnings) == doubtful
        assert any("prepare --units" in said for said in found.warnings) == doubtful
        assert not any(str(tmp_path) in said for said in found.warnings)


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({}, "name"),
        ({"name": "v.txt"}, "json"),
        ({"name": "../v.json"}, "json"),
        ({"name": "v.json", "what": 1}, "what"),
        ({"name": "v.json", "samples": 1}, "samples"),
        ({"name": "v.json", "noise_force": 0.1}, "both"),
        ({"name": "v.json", "euler": "xyz", "rotation_vector": True}, "contradict"),
    ],
)
def test_wrong_parameters_are_refused(files, parameters, said):
    with pytest.raises(InputError, match=said):
        verification(inputs(files), parameters, None)


def test_missing_and_unknown_inputs_are_refused(files):
    with pytest.raises(InputError, match="markers"):
        verification({"probe": files / "probe.ply"}, {"name": "v.json"}, None)
    with pytest.raises(InputError, match="hat"):
        verification({**inputs(files), "hat": files}, {"name": "v.json"}, None)


def test_the_command_fails_with_1_and_refuses_with_2(files, tmp_path):
    run = CliRunner()
    assert run.invoke(app, [*arguments(files, "touches.mcap"), "--limit-mean", "0.01"]).exit_code == 1
    (tmp_path / "m.csv").write_text("name,x_mm,y_mm,z_mm\nA,900,0,0\n", encoding="utf-8")
    refused = run.invoke(app, [*arguments(files), "--markers", str(tmp_path / "m.csv"), "--json"])
    assert refused.exit_code == 2
    assert "off the probe" in json.loads(refused.stdout)["error"]
    assert run.invoke(app, [*arguments(files), "--force", "9"]).exit_code == 2
    assert run.invoke(app, [*arguments(files), "--out", str(files / "markers.csv")]).exit_code == 2


def test_the_command_leaves_markers_out(files, good, tmp_path):
    run, out, first = CliRunner(), tmp_path / "v.json", good.markers.names[0]
    given = [*arguments(files), "--repeats", "3", "--leave-out", f"{first}=nothing reaches it"]
    assert run.invoke(app, [*given, "--out", str(out)]).exit_code == 1
    said = json.loads(out.read_bytes())
    assert said["missing"] == list(good.markers.names[1:])
    assert f"{first} (nothing reaches it)" in " ".join(said["verdict"]["notes"])
    assert run.invoke(app, [*arguments(files), "--leave-out", first]).exit_code == 2
    assert run.invoke(app, [*arguments(files), "--leave-out", "Nowhere=why", "--json"]).exit_code == 2


def test_markers_are_generated_and_snapped_by_command(files, tmp_path):
    run, made, moved = CliRunner(), tmp_path / "m.csv", tmp_path / "s.csv"
    ended = run.invoke(
        app,
        [
            "probe",
            "markers",
            "generate",
            str(files / "probe.ply"),
            "--all",
            "--count",
            "5",
            "--out",
            str(made),
        ],
    )
    assert ended.exit_code == 0, ended.output
    ended = run.invoke(
        app,
        [
            "probe",
            "markers",
            "snap",
            str(made),
            "--probe",
            str(files / "probe.ply"),
            "--out",
            str(moved),
            "--json",
        ],
    )
    assert ended.exit_code == 0
    assert max(json.loads(ended.stdout)["moved_mm"].values()) < 1e-4
    wrong = run.invoke(app, ["probe", "markers", "generate", str(files / "probe.ply"), "--out", str(made)])
    assert wrong.exit_code == 2


# ---- what must not pass ------------------------------------------------------------------------


def test_touches_far_from_every_marker_speak_against_it(good):
    far = replace(good, markers=make_markers(good.markers.points[2:], good.markers.names[2:]))
    found = far.verified()
    assert found.unresolved.touches >= 3
    assert not found.verdict.passed
    assert any("far from every marker" in reason for reason in found.verdict.reasons)


def test_with_an_order_a_wrong_contact_counts_as_the_error_that_it_is(good):
    names = [name for name in good.markers.names for _ in range(2)]
    protocol = replace(VerifySettings().protocol, order=(*names[2:], *names[:2]))
    found = good.verified(VerifySettings(protocol))
    assert found.overall.touches == len(names)
    assert found.overall.max_mm > 5
    assert any("largest error" in reason for reason in found.verdict.reasons)


def test_faults_of_the_inputs_and_few_markers_are_said(good):
    found = verify(
        good.probe, good.model, good.markers, good.recording, faults=("the probe was never aligned",)
    )
    assert "the probe was never aligned" in found.verdict.reasons
    few = replace(good, markers=make_markers(good.markers.points[:2], good.markers.names[:2])).verified()
    assert any("too few to judge" in note for note in few.verdict.notes)


def test_missing_is_told_per_window(good):
    protocol = replace(VerifySettings().protocol, windows=((4.0, 6.0), (8.0, 10.0)))
    found = good.verified(VerifySettings(protocol))
    assert found.missing == tuple(f"{name} (4 to 6 N)" for name in good.markers.names)


def test_close_markers_are_warned_of_and_refused(good):
    points = good.markers.points[:2].copy()
    points[1] = points[0] + [0.0, 0.0, 0.0]
    apart = make_markers(points + [[0, 0, 0], [0.005, 0, 0]], ["a", "b"])
    said, hopeless = crowded(apart, VerificationLimits())
    assert "5.0 mm apart" in said
    assert not hopeless
    assert crowded(apart, VerificationLimits(max_m=0.003))[1]
    assert crowded(apart, VerificationLimits(max_m=0.001)) == (None, False)


def test_a_filtered_sensor_is_as_noisy_as_its_means_are(good):
    rng, a, recording = np.random.default_rng(8), 0.9, good.recording
    white = rng.standard_normal(recording.wrenches.shape) * np.repeat([0.05, 0.0014], 3)
    smooth = replace(recording, wrenches=9.0 + lfilter([1 - a], [1, -a], white, axis=0))
    noise, factor, said = measured_noise(smooth, VerifySettings().protocol, None)
    assert "correlated" in said[0]
    assert factor > 10
    # A first-order filter leaves the variance of long means as it was.
    np.testing.assert_allclose(np.asarray(noise.force), 0.05, rtol=0.25)
    plain = replace(recording, wrenches=9.0 + white)
    noise, factor, said = measured_noise(plain, VerifySettings().protocol, None)
    assert (factor, said) == (1.0, [])
    np.testing.assert_allclose(np.asarray(noise.force), 0.05, rtol=0.05)


@pytest.mark.parametrize("smoothed", [False, True])
def test_correlation_is_measured_at_rest_without_the_ramps(good, smoothed):
    rng, n = np.random.default_rng(9), 400
    ramp = np.interp(np.arange(n), [0, 120, 160, 240, 280, n], [0, 0, 9, 9, 0, 0])  # 40 samples up and down
    noise = rng.standard_normal((10 * n, 6)) * np.repeat([0.05, 0.0014], 3)
    if smoothed:
        noise = 4 * lfilter([0.1], [1, -0.9], noise, axis=0)
    wrenches = noise + np.tile(ramp, 10)[:, None] * [0, 0, 1.0, 0, 0, 0]
    recording = replace(
        good.recording,
        times=np.arange(10 * n) / 500.0,
        wrenches=wrenches,
        R_WS=np.tile(np.eye(3), (10 * n, 1, 1)),
        saturated=None,
    )
    _, factor, said = measured_noise(recording, VerifySettings().protocol, None)
    assert (factor > 5) is smoothed
    assert bool(said) is smoothed


def test_an_offset_at_rest_is_told(good):
    recording = good.recording.compensated(good.model)
    longer = np.repeat(np.arange(len(recording.times)), 5)
    held = replace(recording, wrenches=recording.wrenches[longer])
    assert resting(held, VerifySettings().protocol, 1000.0) is None
    off = replace(held, wrenches=held.wrenches + [1.2, 0, 0, 0, 0, 0])
    assert "reads 1.2 N with nothing touching" in resting(off, VerifySettings().protocol, 1000.0)


def test_a_clock_that_goes_back_or_stops_is_told():
    times = np.arange(100) / 100
    assert [*clock_sentences(times, "x")] == []
    times[50:] += 2.0
    times[70] = 0.1
    said = [*clock_sentences(times, "x")]
    assert "1 samples" in said[0]
    assert "1 gaps, the longest of 2.0 s" in said[1]
    with pytest.raises(InputError, match="sort them"):
        [*clock_sentences(times[::-1], "x")]


def test_a_reference_that_cannot_be_right_is_doubted():
    touches = [Touch(i, i + 1.0, None, 9.0, (8.0, 10.0), span=(i + 0.5, i + 0.9)) for i in range(10)]
    times = np.arange(0, 5, 0.05)
    found, said = force_accuracy(touches, times, np.full(len(times), 0.0))
    assert (found.touches, found.of, found.rms_percent) == (5, 10, pytest.approx(100.0))
    assert "5 of 10" in said[0]
    assert "reads 0.00 N" in said[1]


def test_a_window_for_a_light_hand_sets_where_touches_begin():
    protocol = VerificationParameters(name="v.json", windows=((1.0, 3.0),)).settings().protocol
    assert (protocol.touch_N, protocol.release_N) == (0.8, 0.4)
    given = VerificationParameters(name="v.json", touch_force=4.0, release_force=3.0).settings().protocol
    assert (given.touch_N, given.release_N) == (4.0, 3.0)
