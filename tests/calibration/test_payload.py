"""What a robot carries, read back from each controller's own words."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.payload import CAUTIONS, payload_of
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.settings import RobotMaker

G = 9.80665
R_ES = Rotation.from_euler("xyz", [180, 0, 30], degrees=True).as_matrix()
P_ES, P_EB = np.array([0.001, -0.002, 0.0375]), np.array([0.0, 0.0, 0.018])
BODY_KG = 0.29
LOAD_KG, L = 0.8, np.array([0.031, -0.022, 0.085])
# Where a number is among those of a text, and what makes kg and m of it.
READ = {
    RobotMaker.UR: ((0, 1, 2, 3), 1.0),
    RobotMaker.FRANKA: ((0, 1, 2, 3), 1.0),
    RobotMaker.KUKA: ((1, 2, 3, 4), 1e-3),
    RobotMaker.ABB: ((1, 2, 3, 4), 1e-3),
    RobotMaker.DOOSAN: ((0, 1, 2, 3), 1e-3),
}


def model(sigma=None, g=LOAD_KG * G):
    C = np.zeros((12, 12)) if sigma is None else np.diag(np.square(sigma))
    return GravityModel([0, 0, -g], [1, 2, 3], L, [0.1, 0.2, 0.3], C)


def weighed(R_WE, with_body=True):
    """What a scale at the flange's origin feels, E: of the load and of the sensor's body, body by body."""
    bodies = [(LOAD_KG, P_ES + R_ES @ L)] + ([(BODY_KG, P_EB)] if with_body else [])
    down = R_WE.T @ [0, 0, -G]
    return (sum(kg * down for kg, _ in bodies), sum(np.cross(place, kg * down) for kg, place in bodies))


@pytest.mark.parametrize("maker", list(RobotMaker))
def test_a_robot_that_takes_the_text_feels_nothing_at_any_pose(maker):
    text = payload_of(model(), R_ES, P_ES, BODY_KG, P_EB).text(maker)
    read = [float(each) for each in re.findall(r"-?\d+\.?\d*", text)]
    places, unit = READ[maker]
    kg, *centre = (read[place] for place in places)
    for R_WE in Rotation.random(5, rng=3).as_matrix():
        force, torque = weighed(R_WE)
        told = kg * (R_WE.T @ [0, 0, -G])
        assert told == pytest.approx(force, abs=1e-3 * G)  # a gram
        # A gram at 0.1 m, and a tenth of a millimetre for a kilogram.
        assert np.cross(unit * np.array(centre), told) == pytest.approx(torque, abs=3e-3)


def test_the_uncertainty_is_that_of_drawn_calibrations():
    sigma = np.array([0, 0, 0.02, 0, 0, 0, 1e-3, 2e-3, 3e-3, 0, 0, 0])
    made = payload_of(model(sigma), R_ES, P_ES, BODY_KG, P_EB)
    rng = np.random.default_rng(7)
    drawn = [
        payload_of(
            GravityModel.from_vector(model().vector + sigma * rng.standard_normal(12), np.zeros((12, 12))),
            R_ES, P_ES, BODY_KG, P_EB,
        )
        for _ in range(4000)
    ]  # fmt: skip
    assert made.mass_sigma == pytest.approx(np.std([each.mass for each in drawn]), rel=0.05)
    spread = np.std([each.centre_E for each in drawn], axis=0)
    assert made.centre_sigma_E == pytest.approx(spread, rel=0.05)


@pytest.mark.parametrize(
    ("sigma", "known"),
    [((0.7, 0.001), True), ((0.9, 0.001), False), ((0.01, 0.009), True), ((0.01, 0.02), False)],
)
def test_what_is_too_unsure_says_so(sigma, known):
    weight, centre = sigma
    spread = np.array([0, 0, weight, 0, 0, 0, centre, centre, centre, 0, 0, 0])
    assert payload_of(model(spread), R_ES, P_ES).is_known is known
    # A heavy body that somebody said does not make the load known better.
    assert payload_of(model(spread), R_ES, P_ES, 50.0, P_EB).is_known is (weight < 0.8)


def test_the_line_for_abb_is_the_load_of_a_tool_in_the_wrist_frame():
    line = payload_of(model(), R_ES, P_ES, BODY_KG, P_EB).text(RobotMaker.ABB, 3)
    assert line.startswith("probe_tool3.tload:=[1.090,[")
    assert line.endswith("],[1,0,0,0],0,0,0];")
    assert "nothing touching the tool" in CAUTIONS[RobotMaker.UR]


def test_a_load_that_nobody_weighed_and_a_negative_body_are_refused():
    with pytest.raises(InputError, match="no load"):
        payload_of(model(g=0.0), R_ES, P_ES)
    with pytest.raises(InputError, match="not negative"):
        payload_of(model(), R_ES, P_ES, -0.1)
    with pytest.raises(InputError, match="finite"):
        payload_of(model(), R_ES, [np.nan, 0, 0])
