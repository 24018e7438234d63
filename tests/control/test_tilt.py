import numpy as np
import pytest

from contactbench.pipeline.control.upright import Tilt, TiltReading

DT, FORCE = 0.02, 7.0
SIGMA_N, SIGMA_NM, LEVER = 0.025, 0.0007, 0.14


def readings(tilts, gain, *, drag=0.0, error=0.0, seed=0):
    rng = np.random.default_rng(seed)
    for tilt in tilts:
        n_F, n_M = rng.normal(0, SIGMA_N / FORCE), rng.normal(0, SIGMA_NM / FORCE)
        place = gain * tilt + error + LEVER * n_F + n_M
        yield TiltReading(tilt + drag + n_F, place, gain, LEVER, SIGMA_N / FORCE, SIGMA_NM / FORCE)


def found(tilts, gain, **how):
    axis = Tilt(error_sigma=2e-4)
    return np.array([axis.update(each, DT) for each in readings(tilts, gain, **how)])


@pytest.mark.parametrize("gain", [0.003, 0.007, 0.056, 0.3, LEVER])
def test_without_friction_it_is_the_tilt_with_less_noise_than_either_alone(gain):
    tilts = np.radians(10) * np.sin(np.arange(500) * DT)
    off = (found(tilts, gain) - tilts)[100:]
    by_place = np.hypot(LEVER * SIGMA_N, SIGMA_NM) / FORCE / gain
    # Drag could be there: what is not known of it is what a narrow face leaves uncertain.
    assert abs(off.mean()) < np.radians(0.5)
    assert np.std(off) < 1.02 * min(by_place, np.radians(1.5))
    if gain < 0.005:
        # From one reading to the next the drag stays: of a narrow face, better than by the force alone.
        assert np.std(np.diff(off)) < np.sqrt(2) * SIGMA_N / FORCE


def test_a_narrow_face_tells_a_lasting_drag_from_a_tilt():
    drag = np.radians(3)
    wide, narrow = (found(np.zeros(1500), gain, drag=drag)[500:].mean() for gain in (0.02, 0.003))
    assert abs(wide) < 0.6 * drag
    # Of a face that is too narrow to tell, the force alone is believed.
    assert narrow == pytest.approx(drag, rel=0.3)


def test_what_the_calibration_leaves_is_not_taken_for_a_tilt_of_a_narrow_face():
    # 0.2 mm of place would be 3.8 degrees of tilt at 3 mm/rad.
    assert abs(found(np.zeros(1500), 0.003, error=2e-4).mean()) < np.radians(0.5)


def test_reset_forgets():
    axis = Tilt()
    for each in readings(np.zeros(200), 0.02, drag=0.05):
        axis.update(each, DT)
    assert axis.drag != 0.0
    axis.reset()
    assert (axis.drag, axis.error) == (0.0, 0.0)
