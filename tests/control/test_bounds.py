import numpy as np
import pytest
from benchmarks.reproduce.mixes import tilt_bound

from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Foundation
from contactbench.pipeline.control.upright import Tilt, TiltReading
from contactbench.pipeline.simulation.marker_touches import model_of


@pytest.fixture(scope="module")
def foundation():
    return Foundation(model_of("convex", 1000))


def test_a_narrow_side_is_known_worse_and_never_worse_than_friction(foundation):
    settings = ControlSettings()
    across, along = tilt_bound(settings, foundation, USUAL_MODULUS)
    assert along < across < 1.05 * settings.lean[0]
    quiet = tilt_bound(settings, foundation, USUAL_MODULUS, noise=(1e-5, 1e-7))
    assert quiet[1] < 0.6 * along


def test_it_is_what_the_estimate_shows(foundation):
    settings, rng = ControlSettings(), np.random.default_rng(0)
    press = foundation.at(7.0, USUAL_MODULUS)
    sF, sM = 0.025 / 7.0, 0.0007 / 7.0
    left = np.hypot(settings.calibration_sigma[0] * foundation.height, settings.calibration_sigma[1]) / 7.0
    sigma, seconds = settings.lean
    kept = np.exp(-settings.period / seconds)
    for which, gain in enumerate((press.gain_y, press.gain_x)):
        off = []
        for _ in range(25):
            axis, drag, error = Tilt(sigma, seconds, left), rng.normal(0, sigma), rng.normal(0, left)
            for _ in range(200):
                drag = kept * drag + np.sqrt(1 - kept**2) * rng.normal(0, sigma)
                n = rng.normal(0, sF)
                place = error + foundation.height * n + rng.normal(0, sM)
                off.append(axis.update(TiltReading(drag + n, place, gain, foundation.height, sF, sM), 0.02))
        bound = tilt_bound(settings, foundation, USUAL_MODULUS, noise=(0.05, 0.0014))[which]
        assert np.std(off) == pytest.approx(bound, rel=0.25)
