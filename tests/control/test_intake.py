from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from control.closed_loop import gravity

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import Gates, WrenchNoise
from contactbench.pipeline.control import contact_reason as table
from contactbench.pipeline.control.contact_reason import HEED, NEAR_M, NEAR_S, Heed, SurePlace, heed
from contactbench.pipeline.control.intake import SampleIntake, SensingFault
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.simulation.marker_touches import model_of

GRAVITY = GravityModel([0, 0, -4.4], [1.0, -2.0, 3.0], [0.003, -0.002, 0.06], [0.01, 0.02, -0.01])
PRESSED = np.array([0.0, 0.0, -7.0, 0.0, -7.0 * -0.004, 0.0])  # 4 mm off in +x: M_y = -x F_z
DOWN = np.diag([1.0, -1.0, -1.0])


@pytest.fixture
def intake():
    return SampleIntake(model_of("convex", 1000), GRAVITY, WrenchNoise(), Gates())


def sample(time, wrench=PRESSED, seed=None, **more):
    noise = np.zeros(6) if seed is None else np.random.default_rng(seed).normal(0, 1e-3, 6)
    reading = (wrench + GRAVITY.predict(DOWN) + noise).tolist()
    return WrenchSample(time, tuple(reading[:3]), tuple(reading[3:]), **more)


def four(time, seed=1, **more):
    return [sample(time - 0.015 + 0.005 * k, seed=4 * seed + k, **more) for k in range(4)]


def test_weight_and_bias_are_gone_and_the_place_is_where_it_is(intake):
    sensed = intake.take(1.0, four(1.0), DOWN)
    np.testing.assert_allclose(sensed.wrench, PRESSED, atol=3e-3)
    assert sensed.contact.point[0] == pytest.approx(-0.004 if PRESSED[4] < 0 else 0.004, abs=1e-3)
    assert (sensed.fault, sensed.count, sensed.fresh) == (None, 4, True)
    assert sensed.time == pytest.approx(0.9925)
    assert sensed.age == 0.0


def test_what_is_added_is_added(intake):
    added = np.array([0.1, 0.2, 0.3, 0.01, 0.02, 0.03])
    np.testing.assert_allclose(intake.take(1.0, four(1.0), DOWN, added).wrench, PRESSED + added, atol=3e-3)


def test_a_light_touch_has_no_place(intake):
    sensed = intake.take(1.0, [sample(1.0, wrench=0.05 * PRESSED)], DOWN)
    assert sensed.contact is None
    assert sensed.fresh


def test_torsion_is_learned_while_a_press_lasts(intake):
    since = []
    for k in range(50):
        wrench = (0.02 if k in (40, 41, 42) else 1.0) * PRESSED + [0, 0, 0, 0, 0, 0.03 * np.sin(0.3 * k)]
        contact = intake.take(0.02 * k, [sample(0.02 * k, wrench, k)], DOWN).contact
        since.append(contact and contact.torsion_since)
    assert since[39] == pytest.approx(0.78)
    assert since[49] < 0.2, "the next press is another"


@pytest.mark.parametrize("flag", [Status.INVALID, Status.ERROR])
def test_what_the_device_calls_no_measurement_is_left_out(intake, flag):
    samples = four(1.0)
    samples[2] = replace(samples[2], status=flag, force=(99.0, 0.0, 0.0))
    sensed = intake.take(1.0, samples, DOWN)
    assert sensed.count == 3
    np.testing.assert_allclose(sensed.wrench, PRESSED, atol=3e-3)


@pytest.mark.parametrize("number", [np.nan, np.inf])
def test_what_is_no_number_is_left_out(intake, number):
    samples = four(1.0)
    samples[0] = replace(samples[0], torque=(0.0, number, 0.0))
    samples[1] = replace(samples[1], time=number)
    assert intake.take(1.0, samples, DOWN).count == 2
    assert intake.take(1.02, four(1.02, 2), DOWN).count == 4


def test_one_spike_is_left_out_and_two_are_believed(intake):
    intake.take(1.0, four(1.0), DOWN)
    intake.take(1.02, four(1.02, 2), DOWN)
    hit = PRESSED + [0, 0, -9.0, 0, 0, 0]
    alone = four(1.04, 3)
    alone[1] = sample(1.03, wrench=hit)
    assert intake.take(1.04, alone, DOWN).count == 3
    real = [sample(1.045 + 0.005 * k, wrench=hit, seed=50 + k) for k in range(4)]
    assert intake.take(1.06, real, DOWN).count == 3
    assert intake.take(1.08, [sample(1.08, wrench=hit, seed=99)], DOWN).wrench[2] < -15


def test_the_same_reading_again_and_again_is_a_sensor_that_hangs(intake):
    same = sample(1.0)
    first = intake.take(1.0, [replace(same, time=0.985 + 0.005 * k) for k in range(4)], DOWN)
    assert first.fault is None
    then = intake.take(1.02, [replace(same, time=1.005 + 0.005 * k) for k in range(4)], DOWN)
    assert then.fault is SensingFault.STUCK
    assert np.isnan(then.wrench).all()
    assert intake.take(1.04, four(1.04, 7), DOWN).fresh


def test_silence_is_stale_after_a_while(intake):
    intake.take(1.0, four(1.0), DOWN)
    soon = intake.take(1.02, [], DOWN)
    assert (soon.fault, soon.fresh) == (None, False)
    assert intake.take(1.08, [], DOWN).fault is SensingFault.STALE
    assert intake.take(1.10, four(1.10, 3), DOWN).fresh


def test_nothing_yet_is_stale(intake):
    assert intake.take(1.0, [], DOWN).fault is SensingFault.STALE


def test_old_samples_do_not_come_back(intake):
    intake.take(1.0, four(1.0), DOWN)
    assert intake.take(1.02, four(1.0), DOWN).count == 0


def test_the_end_of_the_range_is_said_by_the_device_or_the_gates():
    samples = four(1.0)
    samples[3] = replace(samples[3], status=Status.OVERRANGE)
    intake = SampleIntake(model_of("convex", 1000), GRAVITY)
    assert intake.take(1.0, samples, DOWN).fault is SensingFault.SATURATED
    ends = Gates(saturation=(50.0, 50.0, 8.0, 5.0, 5.0, 5.0))
    gated = SampleIntake(model_of("convex", 1000), GRAVITY, None, ends)
    assert gated.take(1.0, four(1.0), DOWN).fresh
    assert gated.take(1.02, [sample(1.02, wrench=3 * PRESSED)], DOWN).fault is SensingFault.SATURATED


@pytest.mark.parametrize("back", [0.5, np.nan])
def test_a_clock_that_goes_back_is_not_believed(intake, back):
    intake.take(1.0, four(1.0), DOWN)
    assert intake.take(back, four(1.02, 2), DOWN).fault is SensingFault.CLOCK
    assert intake.take(1.04, four(1.04, 3), DOWN).fresh


def test_the_noise_of_a_mean(intake):
    assert intake.sigmas(4) == (pytest.approx(0.025), pytest.approx(0.001))
    assert intake.sigmas(0) == intake.sigmas(1)


def test_there_must_be_such_a_method():
    with pytest.raises(InputError, match="no method"):
        SampleIntake(model_of("convex", 1000), GRAVITY, method="guess")


# ---- every reason has its line in the table of `contactbench.pipeline.control.contact_reason` ------------


@dataclass
class Told:
    reason: Reason
    accepted: bool = False
    point: np.ndarray | None = field(default_factory=lambda: np.array([0.01, 0.0, 0.1]))
    second: np.ndarray | None = None


def test_every_reason_is_in_the_table_and_in_its_words():
    assert set(HEED) == set(Reason.__members__.values())
    for reason in HEED:
        assert reason.name.lower() in table.__doc__


@pytest.mark.parametrize("reason", [Reason.OK, Reason.VERTEX, Reason.BY_REGION])
def test_what_the_gates_accept_is_turned_by(reason):
    told = Told(reason, accepted=True)
    assert heed(told) is Heed.TURN
    assert SurePlace().take(told, 0.0) is told.point


def test_an_ambiguous_one_is_turned_by_where_it_goes_on_from_the_last_sure_place():
    sure = SurePlace()
    assert sure.take(Told(Reason.AMBIGUOUS), 0.0) is None, "nothing was sure yet"
    sure.take(Told(Reason.OK, accepted=True), 1.0)
    near = Told(Reason.AMBIGUOUS, point=np.array([0.015, 0.0, 0.1]), second=np.array([0.2, 0.0, 0.0]))
    assert sure.take(near, 1.1) is near.point
    other = Told(Reason.AMBIGUOUS, point=np.array([0.2, 0.0, 0.0]), second=np.array([0.016, 0.0, 0.1]))
    assert sure.take(other, 1.2) is other.second, "the second place, where the likeliest is elsewhere"
    far = Told(Reason.BY_REGION, point=np.array([0.016 + 1.1 * NEAR_M, 0.0, 0.1]))
    assert sure.take(far, 1.3) is None
    assert sure.take(other, 1.0 + 1.1 * NEAR_S) is None, "what was sure is too long ago"


@pytest.mark.parametrize("reason", [r for r, what in HEED.items() if what is Heed.KEEP])
def test_others_keep_the_force_without_a_place(reason):
    sure = SurePlace()
    sure.take(Told(Reason.OK, accepted=True), 1.0)
    assert sure.take(Told(reason), 1.02) is None


@pytest.mark.parametrize(
    ("reason", "fault"),
    [
        *((r, SensingFault.UNHEALTHY) for r, what in HEED.items() if what is Heed.HOLD),
        (Reason.SATURATED, SensingFault.SATURATED),
        (Reason.TWO_TOUCHES, None),
        (Reason.OK, None),
    ],
)
def test_readings_that_a_method_does_not_believe_are_a_fault(reason, fault):
    intake = SampleIntake(model_of("t-shape", 1000), gravity(), WrenchNoise(), Gates())

    class Method:
        engine = None

        @staticmethod
        def locate(_):
            return Told(reason, accepted=reason is Reason.OK)

    intake._method = Method
    sensed = intake.take(0.02, [WrenchSample(0.01, (0.0, 0.0, -7.0), (0.0, 0.0, 0.0))], np.eye(3))
    assert sensed.fault is fault
    assert sensed.fresh is (fault is None)
    assert sensed.reason is reason
    assert (sensed.point is None) is (reason is not Reason.OK)
