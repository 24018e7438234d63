"""Every line of the table in `contactbench.pipeline.control.states`, and that nothing else happens."""

from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.control.intake import Sensed, SensingFault
from contactbench.pipeline.control.inverse import JointStep, MotionLimit
from contactbench.pipeline.control.settings import ControlSettings
from contactbench.pipeline.control.states import ControlState, Safety
from contactbench.pipeline.kernel import Reason

DT = 0.02
SETTINGS = ControlSettings()
FREE = JointStep(np.zeros(6), 1.0, (), None, 1.0)
WORKING = (ControlState.APPROACH, ControlState.CONTACT, ControlState.TRACK)
CONTACT_FOUND = object()
USUAL = {"travelled": 0.0, "last": FREE, "probed": True, "follows": True}
USUAL |= dict.fromkeys(("turned", "rising", "swinging", "poses_late"), 0.0)


class Drive:
    """A state machine with a clock."""

    def __init__(self, state=ControlState.APPROACH, settings=SETTINGS):
        self.safety, self.now = Safety(settings), 0.0
        self.safety.state = state

    def __call__(self, seconds=DT, force=7.0, now=None, **what):
        read = {name: what.pop(name) for name in ("fault", "contact", "count", "reason") if name in what}
        told = USUAL | what
        for _ in range(max(round(seconds / DT), 1)):
            self.now += DT
            sensed = self.sensed(force, **read)
            felt = force if sensed.fresh else np.nan
            self.safety.update(self.now if now is None else now, sensed, felt, **told, dt=DT)
        return self.safety.state

    def sensed(self, force, fault=None, contact=CONTACT_FOUND, count=4, reason=None):
        fresh = fault is None and count > 0
        wrench = np.array([0, 0, -force, 0, 0, 0]) if fresh else np.full(6, np.nan)
        return Sensed(self.now, wrench, contact, fault, 0.0, count if fresh else 0, reason)

    @property
    def reason(self):
        return self.safety.changes[-1].reason


def test_the_usual_course():
    drive = Drive()
    assert drive(0.5, force=0.0) is ControlState.APPROACH
    assert drive(force=1.0) is ControlState.CONTACT
    assert drive(force=4.0) is ControlState.CONTACT
    assert drive(0.4, force=7.0) is ControlState.CONTACT, "not before the force has grown"
    assert drive(0.5, force=7.0, probed=False) is ControlState.CONTACT, "not before the stiffness is known"
    assert drive(0.3, force=7.0) is ControlState.TRACK
    assert drive(5.0, force=7.0) is ControlState.TRACK
    drive.safety.stop()
    assert drive() is ControlState.RETRACT
    assert drive(force=0.0, travelled=SETTINGS.retract_travel) is ControlState.SAFE
    assert drive(1.0, force=29.0, fault=None) is ControlState.SAFE
    assert [each.after for each in drive.safety.changes] == [
        ControlState.CONTACT, ControlState.TRACK, ControlState.RETRACT, ControlState.SAFE,
    ]  # fmt: skip


@pytest.mark.parametrize("state", [*WORKING, ControlState.HOLD])
@pytest.mark.parametrize(
    ("what", "says"),
    [
        ({"force": 24.5}, "too close to the limit of 30 N"),
        ({"fault": SensingFault.SATURATED}, "end of its range"),
    ],
)
def test_danger_makes_it_go_back_from_anywhere(state, what, says):
    drive = Drive(state)
    assert drive(**what) is ControlState.RETRACT
    assert says in drive.reason


def test_a_force_from_the_side_and_a_torque_count_too():
    for wrench in ([25.0, 0, 0, 0, 0, 0], [0, 0, -7.0, 5.0, 0, 0]):
        safety = Safety(SETTINGS)
        safety.state = ControlState.TRACK
        sensed = Sensed(0.0, np.array(wrench), None, None, 0.0, 4)
        after = safety.update(0.0, sensed, 0.0, travelled=0, last=FREE, probed=True, dt=DT)
        assert after is ControlState.RETRACT


@pytest.mark.parametrize("state", WORKING)
def test_a_force_that_would_soon_be_over_the_limit_makes_it_go_back(state):
    drive = Drive(state)
    drive(force=7.0)
    assert drive(force=11.0) is not ControlState.RETRACT, "200 N/s for 0.08 s: 27 N"
    drive = Drive(state)
    drive(force=7.0)
    assert drive(force=13.0) is ControlState.RETRACT
    assert "soon exceed the limit of 30 N" in drive.reason


def test_the_rate_counts_from_the_newest_reading_there_was():
    drive = Drive(ControlState.TRACK)
    drive(force=7.0)
    drive(2 * DT, count=0)
    assert drive(force=14.0) is ControlState.TRACK, "7 N in 60 ms"


def test_standing_still_is_no_way_to_be_squeezed():
    drive = Drive(ControlState.HOLD)
    assert drive(force=10.0, follows=False) is ControlState.HOLD
    assert drive(force=11.0, follows=False) is ControlState.RETRACT
    assert "stands still" in drive.reason


@pytest.mark.parametrize(("rising", "seconds"), [(0.0, 0.2), (50.0, 0.2), (100.0, 0.09), (300.0, 0.0)])
def test_blind_on_tissue_that_moves_it_waits_no_longer_than_it_may(rising, seconds):
    drive = Drive(ControlState.TRACK)
    drive(force=7.0)
    assert drive(fault=SensingFault.STALE, rising=rising) is ControlState.HOLD
    if seconds > DT:
        assert drive(seconds - DT, fault=SensingFault.STALE) is ControlState.HOLD
    assert drive(2 * DT, fault=SensingFault.STALE) is ControlState.RETRACT


@pytest.mark.parametrize("state", [ControlState.CONTACT, ControlState.TRACK])
def test_turned_too_far_it_goes_back(state):
    drive = Drive(state)
    assert drive(turned=0.99 * SETTINGS.max_tilt, probed=False) is state
    assert drive(turned=1.01 * SETTINGS.max_tilt) is ControlState.RETRACT
    assert "turned by 29 degrees" in drive.reason


@pytest.mark.parametrize(("error", "word"), [(2.2, "degraded"), (-2.2, "degraded"), (1.9, "")])
def test_a_force_that_strays_is_told_within_half_a_second_and_so_is_its_return(error, word):
    drive = Drive(ControlState.TRACK)
    drive(0.4, force=7.0 + error)
    assert drive.safety.word == word
    assert drive(0.6) is ControlState.TRACK
    assert drive.safety.word == ""
    assert not word or "back in its band" in drive.reason


def test_a_force_that_alternates_is_told_to_swing_and_one_blow_is_nothing():
    drive = Drive(ControlState.TRACK)
    assert drive(0.2, force=10.0) is ControlState.TRACK
    for k in range(40):
        drive(force=7.0 + 4.0 * np.sin(k), swings=True)
    assert [each.reason.split(":")[0] for each in drive.safety.changes] == ["swinging"]


def test_held_while_it_tracked_it_tracks_again():
    drive = Drive(ControlState.TRACK)
    assert drive(fault=SensingFault.STALE) is ControlState.HOLD
    assert drive() is ControlState.TRACK
    assert drive(fault=SensingFault.STALE) is ControlState.HOLD
    assert drive(force=0.1) is ControlState.APPROACH


@pytest.mark.parametrize("state", WORKING)
@pytest.mark.parametrize("fault", [SensingFault.STALE, SensingFault.STUCK, SensingFault.CLOCK])
def test_old_readings_make_it_stand_still_then_go_back(state, fault):
    drive = Drive(state)
    assert drive(fault=fault) is ControlState.HOLD
    assert fault.value in drive.reason
    assert drive(SETTINGS.give_up - 2 * DT, fault=fault) is ControlState.HOLD
    assert drive(3 * DT, fault=fault) is ControlState.RETRACT


def test_a_clock_that_stands_does_not_stop_it_from_going_back():
    drive = Drive(ControlState.TRACK)
    assert drive(SETTINGS.give_up + 3 * DT, fault=SensingFault.CLOCK, now=1.0) is ControlState.RETRACT


@pytest.mark.parametrize(("force", "after"), [(5.0, ControlState.CONTACT), (0.1, ControlState.APPROACH)])
def test_fresh_readings_let_it_go_on(force, after):
    assert Drive(ControlState.HOLD)(force=force) is after


def test_one_step_without_a_sample_is_no_fault():
    assert Drive(ControlState.TRACK)(count=0) is ControlState.TRACK


@pytest.mark.parametrize("state", WORKING)
def test_an_arm_that_does_not_follow_is_held_then_drawn_back(state):
    drive = Drive(state)
    force = 0.0 if state is ControlState.APPROACH else 7.0
    assert drive(2 * DT, force=force, follows=False, probed=False) is state
    assert drive(2 * DT, force=force, follows=False) is ControlState.HOLD
    assert "commanded position" in drive.reason
    assert drive(SETTINGS.give_up + 3 * DT, force=force, follows=False) is ControlState.RETRACT
    assert drive(1.2, force=force, follows=False) is ControlState.SAFE
    assert "cannot retract farther" in drive.reason


def test_an_arm_that_stays_behind_again_and_again_goes_back():
    drive = Drive(ControlState.TRACK, replace(SETTINGS, attempts=1))
    assert drive(3 * DT, follows=False) is ControlState.HOLD
    assert drive() is ControlState.TRACK
    assert drive(3 * DT, follows=False) is ControlState.RETRACT
    assert "2 times" in drive.reason


def test_no_tissue_makes_it_go_back():
    drive = Drive()
    assert drive(force=0.0, travelled=SETTINGS.approach_travel + 1e-6) is ControlState.RETRACT
    assert "no tissue found within 50 mm" in drive.reason


def test_a_first_touch_that_presses_a_little_less_is_one_yet():
    drive = Drive(ControlState.CONTACT)
    assert drive(0.2, force=0.9 * SETTINGS.touch_force) is ControlState.CONTACT
    assert drive(0.2, force=0.4 * SETTINGS.touch_force) is ControlState.APPROACH


def test_lost_tissue_is_looked_for_so_many_times():
    settings = replace(SETTINGS, attempts=2)
    drive = Drive(ControlState.TRACK, settings)
    for _ in range(2):
        assert drive(0.08, force=0.2) in (ControlState.TRACK, ControlState.CONTACT)
        assert drive(0.06, force=0.2) is ControlState.APPROACH
        assert drive(force=2.0) is ControlState.CONTACT
    assert drive(0.14, force=0.2) is ControlState.RETRACT
    assert "lost 3 times" in drive.reason


def test_a_place_that_is_lost_stops_the_turning_then_all():
    drive = Drive(ControlState.TRACK)
    drive(0.28, contact=None)
    assert drive.safety.turning
    drive(0.06, contact=None)
    assert not drive.safety.turning
    drive()
    assert drive.safety.turning
    assert drive(1.9, contact=None) is ControlState.TRACK
    assert drive(0.2, contact=None) is ControlState.RETRACT


@pytest.mark.parametrize("state", WORKING)
@pytest.mark.parametrize(
    "held",
    [
        JointStep(np.zeros(6), 0.2, (MotionLimit.LIMIT,), 3, 1.0),
        JointStep(np.zeros(6), 1.0, (MotionLimit.SINGULAR,), None, 0.01),
    ],
)
def test_an_arm_at_its_end_goes_back(state, held):
    drive = Drive(state)
    force = 0.0 if state is ControlState.APPROACH else 7.0
    assert drive(0.28, force=force, last=held, probed=False) is state
    assert drive(0.06, force=force, last=held) is ControlState.RETRACT


def test_too_fast_is_no_reason():
    slow = JointStep(np.zeros(6), 0.1, (MotionLimit.SPEED,), None, 1.0)
    assert Drive(ControlState.TRACK)(2.0, last=slow) is ControlState.TRACK


def test_what_was_travelled_before_is_not_the_way_back():
    drive = Drive(ControlState.TRACK)
    drive.safety.stop()
    assert drive(travelled=10.0) is ControlState.RETRACT


def test_back_means_away_and_free():
    drive = Drive(ControlState.RETRACT)
    far = SETTINGS.retract_travel
    assert drive(force=0.0, travelled=0.9 * far) is ControlState.RETRACT
    assert drive(force=5.0, travelled=1.1 * far) is ControlState.RETRACT
    assert drive(force=5.0, travelled=2.1 * far) is ControlState.SAFE
    blind = Drive(ControlState.RETRACT)
    assert blind(fault=SensingFault.STALE, travelled=1.1 * far) is ControlState.SAFE


def test_back_and_blocked_ends_where_it_is():
    stuck = JointStep(np.zeros(6), 0.0, (MotionLimit.LIMIT,), 0, 1.0)
    drive = Drive(ControlState.RETRACT)
    assert drive(0.9, last=stuck) is ControlState.RETRACT
    assert drive(0.2, last=stuck) is ControlState.SAFE
    assert "cannot retract farther" in drive.reason


def test_a_swing_makes_it_stand_still_then_measure_anew():
    drive = Drive(ControlState.TRACK, replace(SETTINGS, attempts=1))
    assert drive(swinging=3.2) is ControlState.HOLD
    assert "oscillates by 3.2 N although the gain was lowered" in drive.reason
    assert drive(0.26) is ControlState.HOLD, "it comes to rest first"
    assert drive(0.06) is ControlState.CONTACT, "what was known of the tissue is wrong"
    assert drive(1.0) is ControlState.TRACK
    assert drive(swinging=3.2) is ControlState.RETRACT
    assert "oscillated 2 times" in drive.reason


def test_standing_still_after_a_swing_it_still_goes_back_from_what_pushes_or_is_stale():
    drive = Drive(ControlState.TRACK)
    assert drive(swinging=3.2) is ControlState.HOLD
    assert drive(force=11.0) is ControlState.RETRACT
    drive = Drive(ControlState.TRACK)
    drive(swinging=3.2)
    assert drive(SETTINGS.give_up + 3 * DT, fault=SensingFault.STALE) is ControlState.RETRACT


@pytest.mark.parametrize("state", [ControlState.APPROACH, ControlState.CONTACT, ControlState.HOLD])
def test_a_swing_is_one_of_tracking(state):
    drive = Drive(state)
    drive(force=7.0, swinging=3.0, probed=False)
    assert all("swing" not in each.reason for each in drive.safety.changes)


@pytest.mark.parametrize("state", WORKING)
def test_late_poses_make_it_go_back(state):
    drive = Drive(state)
    force = 0.0 if state is ControlState.APPROACH else 7.0
    assert drive(force=force, poses_late=0.045, probed=False) is state
    assert drive(0.18, force=force, poses_late=0.1, probed=False) is state
    assert drive(0.06, force=force, poses_late=0.1) is ControlState.RETRACT
    assert "100 ms late" in drive.reason


def test_an_arm_whose_lag_is_known_may_be_as_late():
    drive = Drive(ControlState.TRACK, replace(SETTINGS, servo_lag=0.08))
    assert drive(1.0, poses_late=0.1) is ControlState.TRACK


def test_why_a_place_was_lost_is_said():
    drive = Drive(ControlState.TRACK)
    assert drive(2.1, contact=None, reason=Reason.TWO_TOUCHES) is ControlState.RETRACT
    assert "unknown for 2 s (two_touches)" in drive.reason
