"""The report: what stands in it, that it needs nothing beside itself, and that it is the same every time."""

import hashlib
import os
import re
import subprocess
import sys
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from page_reader import Reader
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import (
    ContactTask,
    GravityModel,
    Level,
    PoseNoise,
    PoseSample,
    calibrate,
)
from contactbench.pipeline.calibration.comparison import Cause
from contactbench.pipeline.calibration.files.calibration_file import SourceFile
from contactbench.pipeline.calibration.orientation import plain, with_sigma
from contactbench.pipeline.calibration.report.figures import (
    _signed,
    error_map,
    in_time,
    lambert,
    numbers,
    steps,
    upright,
)
from contactbench.pipeline.calibration.report.page import report_html, tilt_of, write_report
from contactbench.pipeline.errors import InputError

MODEL = GravityModel([0.05, -0.1, -9.0], [3.0, -4.0, 6.0], [0.004, -0.002, 0.06], [0.1, 0.05, -0.2])
NOISE = PoseNoise(0.012, 0.0004)
SOURCE = SourceFile("poses.csv", hashlib.sha256(b"poses").hexdigest())
CREATED = datetime(2026, 11, 21, 17, 5, tzinfo=UTC)


def taken(R_WS, bumped=(), names=None, live=True, seed=0):
    rng = np.random.default_rng(seed)
    poses = []
    for index, R in enumerate(R_WS):
        wrench = MODEL.predict(R) + rng.normal(size=6) * NOISE.sigmas
        if index in bumped:
            wrench = wrench + [0.6, -0.3, 0.2, 0.02, 0.05, -0.01]
        spread = {"force_sd": np.full(3, 0.05), "torque_sd": np.full(3, 0.0014), "count": 20} if live else {}
        poses.append(PoseSample(R, wrench[:3], wrench[3:], name=names[index] if names else "", **spread))
    return poses


def turned(count, seed=1):
    return Rotation.random(count, rng=np.random.default_rng(seed)).as_matrix()


def spun(count):
    """About the vertical, the sensor pointing straight down."""
    down = Rotation.from_rotvec([np.pi, 0, 0])
    return [(Rotation.from_rotvec([0, 0, angle]) * down).as_matrix() for angle in np.linspace(0, 5, count)]


@pytest.fixture(scope="module")
def good():
    return calibrate(taken(turned(12)), NOISE)


@pytest.fixture(scope="module")
def good_page(good):
    return report_html(good, source=SOURCE, created=CREATED)


@pytest.fixture(scope="module")
def refused():
    return calibrate(taken(spun(6)), NOISE)


# ---- content -----------------------------------------------------------------------------------


def test_verdict_number_parameters_and_provenance_are_said(good, good_page):
    text = Reader(good_page).text
    assert good.verdict.level is Level.GOOD
    assert text.startswith("Gravity calibration Gravity calibration 12 of 12 poses used")
    for words in (
        "Good Use this calibration.",
        good.verdict.reasons[0],
        f"{1e3 * good.contact_error:.2g} mm What this calibration adds",
        "noise of a single sample (0.050 N and 1.4 mN·m per axis)",
        "noise of a pose's mean (0.012 N and 0.40 mN·m per axis)",
        f"{good.mass:.5f} ± {good.model.mass_sigma:.5f} kg",
        "All 12 poses agree with one another.",
        "rank 12 of 12",
        "The noise of a pose's mean was given",
        "That fits.",
        SOURCE.sha256,
        "poses.csv",
        "2026-11-21 17:05 UTC",
        "contactbench",
    ):
        assert words in text


def test_numbers_beside_the_one_number_are_the_sensors_share(good, good_page):
    text = Reader(good_page).text
    single = good.task.sensor_error(np.repeat([0.05, 0.0014], 3))
    mean = good.task.sensor_error(NOISE.sigmas)
    assert f"{plain(1e3 * single)} mm What the noise of a single sample" in text
    assert f"{plain(1e3 * mean)} mm What the noise of a pose's mean" in text


def test_without_scatter_within_poses_no_single_sample_is_claimed():
    calibration = calibrate(taken(turned(9), live=False))
    text = Reader(report_html(calibration)).text
    assert "single sample (" not in text
    assert "How much single samples scatter was not recorded." in text
    assert "estimated from the residuals" in text
    force, torque = calibration.noise.freedom
    assert f"from {force:.0f} degrees of freedom for force and {torque:.0f} for torque" in text
    assert "with noise of a pose's mean" in text


def test_bumped_poses_are_named_with_their_reasons():
    names = [f"wrist {index}" for index in range(14)]
    calibration = calibrate(taken(turned(14, 3), bumped=(4, 9), names=names))
    assert [rejection.index for rejection in calibration.rejected] == [4, 9]
    text = Reader(report_html(calibration)).text
    assert "12 of 14 poses used" in text
    assert "2 of 14 poses are left out. The others agree with one another." in text
    for rejection in calibration.rejected:
        assert re.search(rf"Pose {rejection.index + 1} \(\s*{rejection.name}\s*\)", text)
        assert text.count(rejection.reason) == 2
    assert "pose left out (hollow marks)" in text


def test_refused_calibration_says_unknown_instead_of_numbers(refused):
    text = Reader(report_html(refused)).text
    assert refused.verdict.level is Level.REFUSE
    assert "Refused Do not use this calibration." in text
    assert "unknown What this calibration adds" in text
    assert "There is no map" in text
    assert re.search(r"Mass of the load, kg unknown", text)
    assert re.search(r"Tilt from the vertical, ° W unknown", text)
    assert f"rank {refused.rank} of 12" in text
    for sentence in refused.null_directions:
        assert sentence in text
    gravity = text[text.index("Gravity vector (weight), N") :]
    assert gravity[: gravity.index("Tilt")].count("unknown") == 1
    assert f"{refused.gravity_W[2]:.2f}" not in text


def test_weight_that_is_not_felt_leaves_the_centre_of_mass_unknown():
    rng = np.random.default_rng(0)
    poses = [PoseSample(R, rng.normal(0, 0.05, 3), rng.normal(0, 0.002, 3)) for R in turned(10)]
    text = Reader(report_html(calibrate(poses, PoseNoise(0.05, 0.002)))).text
    row = text[text.index("Centre of mass, mm") :]
    assert row[: row.index("Torque bias")].count("unknown") == 3


def test_three_poses_are_reported_without_a_limit():
    text = Reader(report_html(calibrate(taken(turned(3, 5), live=False)))).text
    assert "With 3 poses none can be checked against the others" in text
    assert "limit" not in text[text.index("Residuals") : text.index("Coverage")]


def test_poses_that_contradict_one_another_are_not_said_to_agree():
    rng = np.random.default_rng(0)
    poses = taken(turned(9, 7))
    for index in (0, 2, 4, 6, 8):
        pushed = poses[index]
        poses[index] = replace(
            pushed, force=pushed.force + rng.normal(0, 1, 3), torque=pushed.torque + rng.normal(0, 0.05, 3)
        )
    text = Reader(report_html(calibrate(poses, NOISE))).text
    assert "agree with one another" not in text
    assert "used although beyond the limit: the poses contradict one another" in text
    assert "the residuals contradict that" in text


def test_a_pose_that_is_used_beyond_the_limit_is_told():
    calibration = calibrate(taken(turned(12)), NOISE)
    far = calibration.deviates.copy()
    far[3, 0] = 4.2
    text = Reader(report_html(replace(calibration, deviates=far))).text
    assert "1 of 12 poses is used although beyond the limit: chance explains" in text
    assert "agree with one another" not in text


def test_a_cause_that_only_the_diagnosis_knows_is_no_agreement():
    calibration = calibrate(taken(turned(12)), NOISE)
    swapped = Cause("fx_fz_swapped", 0.98, "Channels are swapped: fx with fz.", believed=False)
    text = Reader(report_html(replace(calibration, causes=(swapped,)))).text
    assert "agree with one another" not in text
    assert "98 % Channels are swapped: fx with fz." in text


@pytest.mark.parametrize("factor", [0.1, 40])
def test_noise_given_wrong_is_said_with_both_figures(factor):
    given = PoseNoise(factor * 0.012, factor * 0.0004)
    calibration = calibrate(taken(turned(10)), given)
    text = Reader(report_html(calibration)).text
    assert f"was given as {plain(given.force)} N and {plain(1e3 * given.torque)} mN·m" in text
    force, torque = (plain(value) for value in calibration.noise_factor)
    assert f"which is {force} times as much for forces and {torque} times for torques" in text
    assert ("No pose stands out, but together" in text) == (factor < 1)
    assert ("agree with one another" in text) == (factor > 1)


def test_orientation_noise_is_told():
    calibration = calibrate(taken(turned(10)), NOISE, orientation_sigma=np.radians(0.02))
    assert calibration.noise.orientation == pytest.approx(np.radians(0.02))
    assert "The orientations count as known to 0.020°" in Reader(report_html(calibration)).text


# ---- time --------------------------------------------------------------------------------------

DRIFT = np.array([0.3, -0.2, 0.1, 0.02, 0.01, -0.01])  # N, N·m over the session


def in_the_order_of_time(before, count=12):
    """Poses a minute apart whose readings have an offset, the session's `before` times DRIFT."""
    poses = taken(turned(count))
    return [
        replace(pose, time=60.0 * i, force=pose.force + w * DRIFT[:3], torque=pose.torque + w * DRIFT[3:])
        for i, (pose, w) in enumerate(zip(poses, before, strict=True))
    ]


@pytest.fixture(scope="module")
def drifted():
    return calibrate(in_the_order_of_time(np.linspace(1, 0, 12)), NOISE)


@pytest.fixture(scope="module")
def rezeroed():
    return calibrate(in_the_order_of_time([1] * 5 + [0] * 7), NOISE)


def test_drift_is_told_and_the_bias_is_of_the_end(drifted):
    text = Reader(report_html(drifted)).text
    assert drifted.causes[0].key == "drift"
    assert "With the drift taken off, all 12 poses agree with one another." in text
    assert "All 12 poses agree" not in text
    assert f"over 99 % {drifted.causes[0].sentence}" in text
    for name in ("Force bias", "Torque bias"):
        assert f"{name} at the end of the session" in text
    x, sigma = with_sigma(3600 * drifted.drift_rate[0], 3600 * drifted.drift_rate_sigma[0])
    assert f"Drift of the force bias, N/h S {x} ± {sigma}" in text


def test_without_drift_no_end_is_spoken_of(good_page):
    text = Reader(good_page).text
    assert "end of the session" not in text
    assert "N/h" not in text


def test_a_rezero_is_told(rezeroed):
    text = Reader(report_html(rezeroed)).text
    assert "With the re-zero taken off, all 12 poses agree with one another." in text
    assert rezeroed.causes[0].sentence in text
    assert "Force bias at the end of the session" in text
    assert "N/h" not in text


def test_what_follows_the_orientation_is_no_agreement():
    turn = Rotation.from_rotvec([0.05, -0.03, 0.02]).as_matrix()
    poses = [replace(pose, R_WS=pose.R_WS @ turn) for pose in taken(turned(14))]
    calibration = calibrate(poses, NOISE)
    text = Reader(report_html(calibration)).text
    assert calibration.causes[0].key == "mount"
    assert "No pose stands out, but together they do not fit the model" in text
    assert "agree with one another" not in text
    assert f"{plain(1e3 * calibration.model_error)} mm of that is what the model leaves out" in text


@pytest.mark.parametrize(("name", "style"), [("drifted", "default"), ("rezeroed", "steps-mid")])
def test_signed_residuals_stand_about_what_was_found(name, style, request):
    calibration = request.getfixturevalue(name)
    figure = _signed(calibration)
    scale = np.repeat([1.0, 1e3], 3)
    for channel, axes in enumerate(figure.axes):
        line, used = axes.lines[0], axes.lines[1]
        assert line.get_drawstyle() == style
        assert np.allclose(line.get_xdata(), np.arange(12))
        assert np.allclose(line.get_ydata(), scale[channel] * calibration.offsets[:, channel])
        read = calibration.offsets[:, channel] + calibration.residuals[:, channel]
        assert np.allclose(used.get_ydata(), scale[channel] * read)
        # Of the truth, that is: what was put in, at the first pose.
        assert line.get_ydata()[0] == pytest.approx(
            scale[channel] * DRIFT[channel], abs=scale[channel] * 0.06
        )


def test_a_pose_far_off_stands_hollow_at_the_edge():
    calibration = calibrate(taken(turned(14, 3), bumped=(4,)), NOISE)
    for channel, axes in enumerate(_signed(calibration).axes):
        hollow = [
            line for line in axes.lines if line.get_markerfacecolor() == "#fdfefd" and len(line.get_xdata())
        ]
        assert [line.get_xdata().tolist() for line in hollow] == [[5.0]]
        off = calibration.residuals[4, channel]
        assert hollow[0].get_marker() in ("^", "v", "o", "D")
        assert np.sign(hollow[0].get_ydata()[0]) == np.sign(off)
        assert np.abs(hollow[0].get_ydata()[0]) <= axes.get_ylim()[1]


def test_poses_without_times_stand_by_their_number(good):
    when, unit = in_time(good)
    assert (when.tolist(), unit) == (list(range(1, 13)), "pose")


# ---- robots that do not stand upright ----------------------------------------------------------


def test_a_robot_under_the_ceiling_is_level():
    flipped = Rotation.from_rotvec([np.pi, 0, 0]).as_matrix()
    poses = [replace(pose, R_WS=flipped @ pose.R_WS) for pose in taken(turned(12))]
    calibration = calibrate(poses, NOISE, down_W=(0, 0, 1))
    standing = calibrate(taken(turned(12)), NOISE)
    assert tilt_of(calibration) == pytest.approx(tilt_of(standing), rel=1e-3)
    assert "gravity was said to point along (0, 0, 1)" in Reader(report_html(calibration)).text
    # Gravity pulls the same way in the sensor: the discs show what they would for a robot that stands.
    assert np.allclose(upright(calibration)[:, 2], upright(standing)[:, 2])
    assert calibration.verdict.level is Level.GOOD


# ---- names from files --------------------------------------------------------------------------


def test_names_are_escaped_and_what_no_page_can_hold_is_replaced():
    nasty = "<script>alert('x')</script>&amp;\"\0\ud800\u202e$x^2$"
    names = [nasty, *(f"p{index}" for index in range(8))]
    calibration = calibrate(taken(turned(9), bumped=(0,), names=names), NOISE)
    assert calibration.rejected[0].name == nasty
    page = report_html(calibration, title=nasty, source=SourceFile(nasty, "0" * 64))
    reader = Reader(page)
    assert "<script" not in page
    assert "script" not in reader.tags
    assert "<script>alert('x')</script>&amp;\"\N{REPLACEMENT CHARACTER}" in reader.text
    assert not re.search("[\0\ud800\u202e]", page)
    page.encode()


# ---- the page itself ---------------------------------------------------------------------------


def test_nothing_outside_is_referred_to(good_page):
    reader = Reader(good_page)
    assert good_page.startswith("<!DOCTYPE html>")
    assert not re.search(r"https?:|//[a-z]|@import|url\((?!#)", good_page)
    assert all(link.startswith("#") and link[1:] in reader.ids for link in reader.links)
    assert all(name in reader.ids for name in re.findall(r"url\(#([^)]*)\)", good_page))
    assert not {"script", "link", "img", "iframe"} & set(reader.tags)
    assert reader.tags.count("svg") == 6  # the icon and five pictures


def test_pictures_take_colours_and_fonts_from_the_page(good_page):
    pictures = "".join(re.findall(r"<svg viewBox.*?</svg>", good_page, re.DOTALL))
    for role in ("currentColor", "var(--faint)", "var(--grid)", "var(--force)", "var(--torque)"):
        assert role in pictures
    assert not re.search("#01010|#02020|#03030|#fdfefd|#000000|DejaVu", pictures)
    for variable in re.findall(r"var\((--[a-z-]+)\)", good_page):
        assert f"{variable}: " in good_page


@pytest.mark.parametrize("theme", [0, 1])
def test_text_has_contrast_in_both_themes(good_page, theme):
    roots = re.findall(r":root \{(.*?)\}", good_page, re.DOTALL)
    colours = dict(re.findall(r"--([a-z-]+): #([0-9a-f]{6})", roots[0]))
    colours |= dict(re.findall(r"--([a-z-]+): #([0-9a-f]{6})", roots[theme]))
    for ground in ("paper", "card"):
        for ink in ("ink", "faint"):
            assert contrast(colours[ink], colours[ground]) >= 4.5
        for mark in ("force", "torque"):
            assert contrast(colours[mark], colours[ground]) >= 3
    for level in Level:
        assert contrast(colours[f"on-{level.value}"], colours[level.value]) >= 3


def contrast(one, other):
    """As WCAG 2 defines it."""

    def luminance(colour):
        parts = np.array([int(colour[i : i + 2], 16) for i in (0, 2, 4)]) / 255
        return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4) @ [
            0.2126,
            0.7152,
            0.0722,
        ]

    dark, light = sorted([luminance(one), luminance(other)])
    return (light + 0.05) / (dark + 0.05)


def test_long_names_and_many_poses_stay_small():
    names = [f"{'long name ' * 20}{index}" for index in range(40)]
    page = report_html(calibrate(taken(turned(40, 6), bumped=(2, 7, 21), names=names)))
    assert len(page.encode()) < 400_000
    Reader(page)


def test_hundreds_of_poses_are_drawn_without_their_numbers():
    page = report_html(calibrate(taken(turned(150), bumped=(7,)), NOISE))
    assert len(page.encode()) < 400_000
    assert "Each dot is a pose; gravity" in page
    drawn = re.findall(r"<svg viewBox.*?</svg>", page, re.DOTALL)[1]
    assert re.findall(r">(\d+)<", drawn) == ["8"]


MAKE = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from test_report import CREATED, SOURCE, calibrate, taken, turned, write_report
calibration = calibrate(taken(turned(14, 3), bumped=(4, 9)))
write_report(calibration, Path(sys.argv[2]), source=SOURCE, created=CREATED)
"""


def test_same_calibration_gives_the_same_bytes_in_another_process(tmp_path):
    pages = []
    for seed, settings in (("1", ""), ("2", "axes.facecolor: red\nsvg.hashsalt: other\nfont.size: 30\n")):
        (tmp_path / seed).mkdir()
        (tmp_path / seed / "matplotlibrc").write_text(settings, encoding="utf-8")
        environment = os.environ | {"PYTHONHASHSEED": seed, "MATPLOTLIBRC": str(tmp_path / seed)}
        file = tmp_path / f"{seed}.html"
        command = [sys.executable, "-c", MAKE, str(Path(__file__).parent), str(file)]
        subprocess.run(command, check=True, env=environment, timeout=120)
        pages.append(file.read_bytes())
    assert pages[0] == pages[1]


def test_matplotlib_is_not_imported_before_a_report_is_made():
    loaded = "'matplotlib' in sys.modules or 'jinja2' in sys.modules"
    code = f"import sys, contactbench.pipeline.calibration.report.page; sys.exit({loaded})"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_settings_of_matplotlib_are_left_as_they_were(good):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    report_html(good)
    assert dict(mpl.rcParams) == before


# ---- writing -----------------------------------------------------------------------------------


def test_file_holds_the_page(good, good_page, tmp_path):
    file = tmp_path / "report.html"
    write_report(good, file, source=SOURCE, created=CREATED)
    assert file.read_text(encoding="utf-8") == good_page
    assert [entry.name for entry in tmp_path.iterdir()] == ["report.html"]


@pytest.mark.parametrize("name", ["missing/report.html", "\0.html", "."])
def test_unwritable_file_is_an_input_error(good, tmp_path, name):
    with pytest.raises(InputError, match="the file cannot be written"):
        write_report(good, tmp_path / name)


def test_time_without_zone_is_refused(good):
    with pytest.raises(InputError, match="no zone"):
        report_html(good, created=datetime(2026, 11, 21))


# ---- numbers -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "sigma", "shown"),
    [
        (3.04217, 0.0351, ("3.042", "0.035")),
        (-0.0004, 0.01, ("0.000", "0.010")),
        (-4.0, 0.0996, ("−4.00", "0.10")),
        (123.4, 12.3, ("123", "12")),
        (1234.5, 123.0, ("1234", "123")),
        (2.0, 0.0, ("2.0000", "0")),
        (2.0, 2.9e-7, ("2.00000000", "0.00000029")),
        (2.0, 1e-12, ("2.000000000", "under 0.000000001")),
    ],
)
def test_values_have_the_digits_of_their_sigma(value, sigma, shown):
    assert with_sigma(value, sigma) == shown


@pytest.mark.parametrize(
    ("value", "shown"),
    [(0.0, "0"), (0.0123, "0.012"), (0.996, "1.0"), (1234.5, "1234"), (1e-9, "under 0.000001")],
)
def test_plain_numbers_have_no_exponent(value, shown):
    assert plain(value) == shown


def test_tilt_and_its_sigma_agree_with_sampling(good):
    rng = np.random.default_rng(0)
    sampled = rng.multivariate_normal(good.gravity_W, good.covariance[:3, :3], 20_000)
    tilts = np.arctan2(np.hypot(sampled[:, 0], sampled[:, 1]), -sampled[:, 2])
    tilt, sigma = tilt_of(good)
    assert tilt == pytest.approx(tilts.mean(), abs=3 * sigma / 100)
    assert sigma == pytest.approx(tilts.std(), rel=0.03)


# ---- pictures ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "task", [None, ContactTask(point=[0.03, 0.02, 0.12], normal=[0.6, 0.2, 0.7], friction=0.5)]
)
def test_map_agrees_with_the_number_at_the_top(task):
    calibration = calibrate(taken(turned(12)), NOISE, task=task)
    sigmas = np.repeat([0.05, 0.0014], 3)
    _, _, share, total = error_map(calibration, sigmas, np.degrees(calibration.task.friction))
    # Four sides behind the number, 72 on the map.
    assert calibration.contact_error <= share.max() * (1 + 1e-9)
    assert share.max() == pytest.approx(calibration.contact_error, rel=0.05)
    assert total[0, 0] == pytest.approx(np.hypot(share[0, 0], total[0, 0]), rel=0.2)
    assert (total > share).all()


def test_map_turns_forces_the_way_it_says():
    """To the right is +x for a normal along z: a pull that way weighs as the task's force along it."""
    task = ContactTask(friction=np.radians(60))
    calibration = calibrate(taken(turned(12)), NOISE, task=task)
    angles, around, share, _ = error_map(calibration, NOISE.sigmas, 60.0)
    for place, side in ((0, [1, 0]), (18, [0, 1]), (36, [-1, 0]), (54, [0, -1])):
        along = [
            f for f in task.forces if np.allclose(f[:2] / np.linalg.norm(f[:2] + 1e-12), side, atol=1e-6)
        ]
        single = ContactTask(friction=np.radians(60))
        object.__setattr__(single, "forces", np.array(along))
        expected = single.calibration_error(calibration.model.vector, calibration.covariance)
        assert share[-1, place] == pytest.approx(expected, rel=1e-6)
    assert angles[-1] == pytest.approx(np.radians(60))
    assert around[18] == pytest.approx(np.pi / 2)


def test_lambert_keeps_areas():
    directions = np.random.default_rng(0).normal(size=(20_000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    radii = np.linalg.norm(lambert(directions), axis=1)
    assert radii.max() <= 1
    assert (radii < np.sqrt(0.5)).mean() == pytest.approx(0.5, abs=0.02)


def test_numbers_of_poses_are_shortened():
    assert numbers([4]) == "5"
    assert numbers([1, 0, 2, 6]) == "1–3, 7"
    assert numbers([0, 1]) == "1, 2"
    assert numbers(range(0, 40, 3)) == "14 poses"


@pytest.mark.parametrize(
    ("low", "high"), [(0.05, 3.1), (0.31, 0.33), (1e-4, 1.01e-4), (0.001, 20), (0.5, 0.5)]
)
def test_levels_are_round_numbers_within(low, high):
    found = steps(low, high)
    assert found == sorted(set(found))
    assert all(low <= level <= high for level in found)
    assert len(found) <= 14
    if high > 2 * low:
        assert len(found) >= 4
