"""A press on a known point finds a wrong sign or unit of the torques, and a probe that is turned on the sensor."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.verification import mesh
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.verification.known_check import CheckOutcome
from contactbench.pipeline.verification.known_touch import MISTAKES, TouchParameters, check_touch
from contactbench.pipeline.verification.markers import MarkerError
from contactbench.pipeline.verification.source import TouchRecording

RATE = 200.0
MODEL = GravityModel(
    np.array([0.1, 0, -5.0]), np.array([1.0, 2, -3]), np.array([0, 0, 0.05]), np.array([0.1, 0, 0.05])
)
R_WS = Rotation.from_euler("xyz", [150.0, 20, 10], degrees=True).as_matrix()


# This press has little force along x and little torque about z: a calibration shows these by its residuals.
HARDLY_SHOWN = ("the channel fx has the wrong sign", "the channel mz has the wrong sign")


def surface_point(towards):
    """Return the point of the probe that is nearest to a place, and its normal."""
    _, faces, feet = SurfaceIndex(mesh(2_000).vertices, mesh(2_000).faces).closest(
        np.array([towards], dtype=float)
    )
    return feet[0], mesh(2_000).normals[faces[0]]


SIDE, SIDE_NORMAL = surface_point([0.03, 0.008, 0.2])


def pressed(point, normal, *, T=None, force=10.0, presses=1, aim=0.0, torsion=0.002, seed=0):
    """Return raw samples of presses along the inward normal, with a finger's torsion and tremor."""
    rng = np.random.default_rng(seed)
    rows = [np.zeros((200, 6))]
    for _ in range(presses):
        n = 240
        size = np.full(n, force) + 0.05 * np.sin(np.arange(n) / RATE * 2 * np.pi * 5)
        size[:20] = np.linspace(0.2, force, 20)
        f = -size[:, None] * normal
        at = point + aim * rng.standard_normal(3)
        rows += [np.hstack([f, np.cross(at, f) + torsion * f]), np.zeros((100, 6))]
    w = np.vstack(rows) + MODEL.predict(R_WS)
    w += rng.standard_normal(w.shape) * np.repeat([0.05, 0.0014], 3)
    w = w if T is None else w @ np.linalg.inv(T).T
    n = len(w)
    return TouchRecording(np.arange(n) / RATE, w, np.tile(R_WS, (n, 1, 1)), np.zeros(n, dtype=bool))


def transformed(T):
    """Return the calibration that a sensor with a mistake would have got: everything it read, in its own numbers."""
    inverse = np.linalg.inv(T)

    class Model(GravityModel):
        def compensate(self, rotations, wrenches):
            return wrenches - MODEL.predict(rotations) @ inverse.T

    return Model(MODEL.gravity_W, MODEL.force_bias, MODEL.centre_of_mass_S, MODEL.torque_bias)


def check(point=SIDE, normal=SIDE_NORMAL, T=None, **more):
    settings = {key: more.pop(key) for key in ("limit", "point_sigma", "faults") if key in more}
    model = MODEL if T is None else transformed(T)
    return check_touch(mesh(2_000), model, point, pressed(point, normal, T=T, **more), **settings)


def test_a_press_on_the_side_passes():
    found = [check(seed=seed, aim=0.001) for seed in range(10)]
    assert all(each.passed for each in found), [each.sentence for each in found]
    assert all(each.error < 0.006 and each.lever > 0.01 for each in found)
    assert "signs and units are correct" in found[0].sentence
    assert found[0].presses == 1
    assert found[0].force == pytest.approx(10, abs=0.3)


def test_several_presses_are_averaged():
    found = check(presses=3, aim=0.001)
    assert found.presses == 3
    assert found.passed


@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda each: each.words)
def test_every_mistake_that_moves_the_line_of_force_is_named_or_undecided(mistake):
    found = check(T=mistake.T, force=40.0)
    if mistake.words in HARDLY_SHOWN:
        return
    assert not found.passed
    if found.outcome is CheckOutcome.FAILED:
        assert mistake.words in found.sentence or "Also possible" in found.sentence


@pytest.mark.parametrize("number", range(5), ids=lambda number: MISTAKES[number].words)
def test_signs_and_usual_units_are_named_first(number):
    found = check(T=MISTAKES[number].T, force=15.0)
    assert found.outcome is CheckOutcome.FAILED
    assert f"Likely cause: {MISTAKES[number].words}." in found.sentence


def test_a_press_along_the_axis_cannot_tell_a_sign_and_does_not_pass():
    tip, normal = surface_point([0.0, 0.0, 0.3])
    found = check(point=tip, normal=normal)
    assert found.outcome is CheckOutcome.UNDECIDED
    assert "a wrong sign or unit of the torques would not show" in found.sentence
    assert "on the side of the probe" in found.sentence


def test_a_lever_that_is_short_but_shows_a_sign_is_enough():
    point, normal = surface_point([0.008, 0.0, 0.3])
    found = check(point=point, normal=normal)
    assert 0.006 < found.lever < 0.01
    assert found.passed


def test_where_the_line_meets_the_probe_twice_the_known_point_counts():
    shoulder, normal = surface_point([0.0235, -0.0025, 0.1])
    assert normal[2] < -0.9  # the line goes on through the top, where it would be as good a press
    found = check(point=shoulder, normal=normal)
    assert found.passed, found.sentence


@pytest.mark.parametrize(
    ("recorded", "words"),
    [
        (np.repeat([1.0, 1000.0], 3), "the torques are in N·mm"),
        (np.repeat([1.0, -1.0], 3), "the torques have the wrong sign"),
        (np.repeat([1 / 9.80665, 1.0], 3), "the forces are in kgf"),
        (np.repeat([1.0, 8.8507], 3), "the torques are in lbf·in"),
    ],
)
def test_what_a_sensor_sends_instead_of_newtons(recorded, words):
    """The factors, written down here once more: what the wrong sensor multiplies right readings by."""
    found = check(T=np.diag(1 / recorded), force=40.0)
    assert found.outcome is CheckOutcome.FAILED
    assert f"Likely cause: {words}" in found.sentence


def test_another_place_than_the_point_fails_without_a_wrong_cause():
    there, normal = surface_point([-0.03, -0.008, 0.2])
    found = check_touch(mesh(2_000), MODEL, SIDE, pressed(there, normal))
    assert found.outcome is CheckOutcome.FAILED


def test_an_aim_that_is_hardly_known_decides_nothing():
    found = check(point_sigma=0.02)
    assert found.outcome is CheckOutcome.UNDECIDED
    assert "hit the point to within 2.5 mm" in found.sentence


def test_a_refused_calibration_passes_nothing():
    found = check(faults=("The calibration was refused: too few poses.",))
    assert found.outcome is CheckOutcome.FAILED
    assert "was refused" in found.sentence


def test_nothing_pressed_is_wrong_input():
    with pytest.raises(InputError, match=r"No steady press: \|F\| reaches 1\.\d N"):
        check(force=1.0)


def test_a_point_off_the_probe_is_wrong_input():
    with pytest.raises(MarkerError, match="the point"):
        check_touch(mesh(2_000), MODEL, [0.5, 0, 0], pressed(SIDE, SIDE_NORMAL))


def test_an_unbelievable_limit_is_wrong_input():
    with pytest.raises(InputError, match="limit"):
        check(limit=0.0)


def test_parameters_need_a_point():
    with pytest.raises(InputError, match="parameter point"):
        TouchParameters.checked({"name": "t.json"})


def test_a_press_that_never_settles_is_no_evidence():
    recording = pressed(SIDE, SIDE_NORMAL)
    cut = replace(
        recording,
        times=recording.times[:230],
        wrenches=recording.wrenches[:230],
        R_WS=recording.R_WS[:230],
        saturated=recording.saturated[:230],
    )
    with pytest.raises(InputError, match="No steady press"):
        check_touch(mesh(2_000), MODEL, SIDE, cut)
