"""What samples are worth: settled ones, their noise, and the errors of a verification's touches."""

import json
from dataclasses import replace

import numpy as np
import pytest
from report.report_cases import probe_file, verification
from terminal import invoke
from weighing_files import weighed

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.heatmap import HeatmapError, heatmap
from contactbench.pipeline.heatmap.contacts import measured_noise, settled, touches_of, with_calibration
from contactbench.pipeline.mesh.sidecar import save_probe_file


def test_a_press_is_settled_between_its_ramps():
    times = np.arange(3000) * 1e-3
    forces = np.interp(times, [0.5, 1.0, 2.0, 2.5], [0.1, 9.0, 9.0, 0.1])
    forces += np.random.default_rng(1).normal(0, 0.2, len(times))
    steady = settled(times, forces)
    # 5 % of 9 N over the 0.1 s between the two means: the bends themselves may count a little.
    assert steady[1120:1880].all()
    assert not steady[550:920].any()
    assert not steady[2080:2400].any()
    assert not settled(times[:20], forces[:20]).any()


def test_nothing_is_settled_beside_a_gap():
    times = np.concatenate([np.arange(500), 2000 + np.arange(500)]) * 1e-3
    steady = settled(times, np.full(1000, 9.0))
    assert steady[200:300].all()
    assert not steady[480:520].any()


def test_noise_is_measured_while_the_force_changes():
    rng = np.random.default_rng(2)
    times = np.arange(4000) * 1e-3
    sigma = np.array([0.05, 0.06, 0.1, 0.002, 0.002, 0.001])
    wrenches = rng.normal(0, sigma, (4000, 6)) + 9 * times[:, None]
    found = np.sqrt(np.diag(measured_noise(times, wrenches).covariance))
    assert found == pytest.approx(sigma, rel=0.1)
    assert measured_noise(times[:40], wrenches[:40]) is None
    assert measured_noise(times, np.ones((4000, 6))) is None


def test_the_calibration_adds_to_the_noise():
    model = calibrate(weighed().poses).model
    R = np.eye(3)[None].repeat(5, axis=0)
    added = with_calibration(WrenchNoise(), model, R).covariance - WrenchNoise().covariance
    assert added == pytest.approx(model.wrench_covariance(np.eye(3)), rel=1e-9, abs=1e-15)


def test_one_wrong_contact_does_not_take_all_colours():
    probe = probe_file().probe
    points = probe.vertices[::3]
    errors = np.full(len(points), 1e-3)
    errors[0] = 0.1
    made = heatmap(probe, points, None, "error", 0.002, values=errors)
    assert made.largest > 10
    assert made.scale.top < made.largest / 2
    assert heatmap(
        probe, points, None, "error", 0.002, values=np.full(len(points), 1e-3)
    ).scale.top == pytest.approx(1.0)


@pytest.fixture(scope="module")
def verified(tmp_path_factory):
    folder = tmp_path_factory.mktemp("verified")
    content = probe_file()
    save_probe_file(content, folder / "p.ply")
    save_probe_file(replace(content, frame="P"), folder / "loose.ply")
    made = verification(content.probe)
    (folder / "v.json").write_bytes(made.to_bytes())
    (folder / "other.json").write_bytes(replace(made, sources={"probe": "0" * 64}).to_bytes())
    return folder


def drawn(folder, *arguments, code=0):
    done = invoke("heatmap", "draw", *arguments, "--out", folder / "e.ply", "--json")
    assert done.exit_code == code, done.output
    return done


def test_errors_of_a_verification_are_those_of_its_touches(verified):
    made = verification(probe_file().probe)
    done = drawn(verified, verified / "v.json", "--probe", verified / "p.ply", "--quantity", "error")
    said = json.loads(done.stdout)
    assert (said["contacts"], said["counted"]) == (made.overall.touches, "touches")
    assert said["total"] == pytest.approx(made.overall.mean_mm)
    assert said["left_out"] == {"slipped": 1}
    assert "slipped (1)" in done.output


@pytest.mark.parametrize(
    ("contacts", "probe", "words"),
    [("other.json", "p.ply", "not the probe that was verified"), ("v.json", "loose.ply", "not aligned")],
)
def test_what_does_not_belong_together_is_refused(verified, contacts, probe, words):
    done = drawn(verified, verified / contacts, "--probe", verified / probe, code=2)
    assert words in " ".join(done.output.split())


def test_a_verification_without_touches_has_no_map():
    made = verification(probe_file().probe)
    with pytest.raises(HeatmapError, match="no accepted touch"):
        touches_of(replace(made, touches=made.touches[-1:]))
