import threading
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from waiting import until

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.pose_source import LONGEST_AHEAD_S, PoseTrack
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.verification.source import TouchRecording
from contactbench.pipeline.workbench.live import LiveMoment, Ring, Tap
from contactbench.pipeline.workbench.live_trial import trial_of

STEPWISE = "virtual://bench?probe=convex&sensor=paper&speed=step"
EMPTY = np.zeros(3)


def turned(degrees, time):
    return FlangeSample(time, Rotation.from_euler("z", degrees, degrees=True).as_matrix(), EMPTY)


@pytest.fixture
def blocks(live):
    """What a follower gets of a bench that is stepped."""
    got = []
    live.open(STEPWISE, STEPWISE)
    live.follow(got.append)
    return got


# ---- orientation ---------------------------------------------------------------------------------


def test_mount_turns_the_sensor_on_the_flange():
    R_ES = Rotation.from_euler("x", 90, degrees=True).as_matrix()
    track = PoseTrack(R_ES)
    track.add([turned(90, 0.0), turned(90, 0.1)])
    expected = turned(90, 0).R_BE @ R_ES
    assert track.at(np.array([0.05]))[0] == pytest.approx(expected)


# ---- memory --------------------------------------------------------------------------------------


def test_ring_keeps_the_newest_in_their_order():
    ring = Ring(10)
    for start in range(0, 24, 4):
        times = np.arange(start, start + 4, dtype=float)
        wrenches = np.repeat(times[:, None], 6, axis=1)
        ring.add(times, wrenches, 10 * wrenches, np.tile(np.eye(3), (4, 1, 1)))
    times, raw, compensated = ring.last(100.0)
    assert times.tolist() == list(range(14, 24))
    assert raw[:, 5].tolist() == times.tolist()
    assert (compensated == 10 * raw).all()
    assert ring.last(2.0)[0].tolist() == [21, 22, 23]
    ring.add(np.arange(24.0, 36.0), np.zeros((12, 6)), np.zeros((12, 6)), np.zeros((12, 3, 3)))
    assert ring.last(100.0)[0].tolist() == list(range(26, 36))
    assert ring.count == 36


def test_what_is_live_follows_the_zero_as_its_recording_does(live, blocks):
    off = np.array([0.1, -0.05, 0.08, 0.002, 0.001, -0.001])
    live.pair.step(400)
    assert np.isnan(live.history(10.0)[2]).all()
    model = GravityModel(EMPTY, live.reading().raw[:3] - off[:3], EMPTY, live.reading().raw[3:] - off[3:])
    live.set_model(model)
    assert live.zero is None
    _, raw, compensated = live.history(10.0)
    assert compensated == pytest.approx(model.compensate(np.eye(3), raw))
    live.set_model(model, follow=True)
    assert live.zero.taken == pytest.approx(off, abs=0.02)
    live.pair.bench.touch(point_S=live.pair.bench.markers[2], force=9.0, seconds=2.0)
    live.pair.step(420)
    parts = ("times", "wrenches", "R_WS", "saturated")
    recording = TouchRecording(*(np.concatenate([getattr(b, part) for b in blocks]) for part in parts))
    followed = recording.compensated(model, follow=True)
    assert live.history(1e9)[2] == pytest.approx(followed.wrenches, abs=1e-12)
    assert live.zero.taken.tobytes() == followed.zero.taken.tobytes()
    reading = live.reading()
    assert reading.raw - reading.compensated == pytest.approx(
        model.vector[[3, 4, 5, 9, 10, 11]] + live.zero.taken
    )


# ---- the path of samples -------------------------------------------------------------------------


def test_followers_get_every_sample_once_in_order_with_its_orientation(live):
    blocks = []
    live.open(STEPWISE, STEPWISE)
    end = live.follow(blocks.append)
    live.pair.step(500)
    times = np.concatenate([block.times for block in blocks])
    R_WS = np.concatenate([block.R_WS for block in blocks])
    assert (np.diff(times) > 0).all()
    assert np.diff(times) == pytest.approx(0.005, abs=1e-6)
    assert np.isfinite(R_WS).all()
    assert sum(block.saturated.sum() for block in blocks) == 0
    end()
    seen = len(blocks)
    live.pair.step(50)
    assert len(blocks) == seen


def test_a_sample_waits_for_the_pose_after_it(live, blocks):
    base = 1000.0
    live._take_flanges([turned(0, base)])
    live._take_wrenches([WrenchSample(base + 0.01, (0, 0, 0), (0, 0, 0), status=Status.OVERRANGE)])
    assert not blocks
    live._take_flanges([turned(20, base + 0.02)])
    angles = Rotation.from_matrix(blocks[-1].R_WS[-1]).as_euler("zyx", degrees=True)
    assert angles[0] == pytest.approx(10)
    assert blocks[-1].saturated.all()


def test_samples_go_on_when_poses_stop(live, blocks):
    base = 1000.0
    live._take_flanges([turned(30, base)])
    for index in range(200):
        live._take_wrenches([WrenchSample(base + 0.005 * index, (0, 0, 0), (0, 0, 0))])
    times = np.concatenate([block.times for block in blocks])
    R_WS = np.concatenate([block.R_WS for block in blocks])
    known = np.isfinite(R_WS).all(axis=(1, 2))
    assert times[-1] > base + 0.8  # nobody waits for ever
    assert times[known].max() <= base + LONGEST_AHEAD_S + 1e-9
    assert times[known].max() > base + LONGEST_AHEAD_S - 0.06


def test_a_follower_that_fails_stops_nothing(live, blocks):
    errors = []
    live.on_error.append(errors.append)

    def fails(_block):
        blocks.clear()
        raise ValueError("a mistake")

    live.follow(fails)
    live.follow(blocks.append)
    live.pair.step(100)
    assert blocks
    assert {str(error) for error in errors} == {"a mistake"}


def test_a_tap_gets_what_devices_give_until_they_are_closed(live):
    wrenches, flanges, health, closed = [], [], [], []
    live.open(STEPWISE, STEPWISE)
    live.tap(
        Tap(wrenches.extend, flanges.extend, lambda *told: health.append(told), lambda: closed.append(True))
    )
    live.pair.step(250)
    assert len(wrenches) + len(flanges) == 250
    assert isinstance(wrenches[0], WrenchSample)
    assert isinstance(flanges[0], FlangeSample)
    assert {device for device, _ in health} == {"sensor", "robot"}
    live.close()
    assert closed == [True]
    assert live.health is None


# ---- the newest moment ---------------------------------------------------------------------------


def test_reading_is_the_filter_of_all_samples(live):
    live.open(STEPWISE, STEPWISE)
    assert live.reading() is None
    live.pair.step(600)
    times, raw, _ = live.history(1e9)
    reading = live.reading()
    assert reading.time == times[-1]
    following = KalmanFilter(200.0, sigma=[0.05] * 3 + [0.002] * 3)
    assert reading.raw == pytest.approx(following.filter(raw, times)[-1], abs=1e-6)
    assert np.isnan(reading.compensated).all()
    assert reading.contact is None


def test_reading_finds_the_contact_once_for_each_sample(live):
    live.open(STEPWISE, STEPWISE)
    bench = live.pair.bench
    live.pair.step(200)
    raw = live.reading().raw
    live.set_model(GravityModel(EMPTY, raw[:3], EMPTY, raw[3:]))
    solver = ContactSolver(bench.probe.with_invented(np.ones(len(bench.probe.faces), dtype=bool)))
    asked = []

    class Counting:
        reset, on = solver.reset, solver.on

        def track(self, wrench, *_told):
            asked.append(wrench)
            return solver.track(wrench)

    live.solver = Counting()
    reading = live.reading()
    assert reading.contact is reading.on is None  # nothing touches
    point = bench.markers[2]
    bench.touch(point_S=point, force=9.0, seconds=2.0)
    live.pair.step(420)
    assert live.reading() is live.reading()
    assert len(asked) == 2
    contact = live.reading().contact
    assert contact.accepted
    assert live.reading().on == "invented"
    assert np.linalg.norm(contact.point - point) < 0.004
    times, points = live.contacts(10.0)
    assert np.isnan(points[0]).all()
    assert points[-1] == pytest.approx(contact.point)
    assert (np.diff(times) > 0).all()


class Following:
    """A solver that counts how often it began anew."""

    def __init__(self, *reasons):
        self.reasons, self.began = list(reasons), 0

    def track(self, wrench, *_told):
        return SimpleNamespace(reason=self.reasons.pop(0), point=wrench[:3])

    def reset(self):
        self.began += 1

    def on(self, _contact):
        return "measured"


def test_a_contact_is_followed_until_it_is_let_go():
    moment, model = LiveMoment(200.0), GravityModel(EMPTY, EMPTY, EMPTY, EMPTY)
    solver = Following(Reason.OK, Reason.TWO_TOUCHES, Reason.LOW_FORCE, Reason.OK, Reason.OK)
    seen, began = [], []
    for now in (1.0, 1.1, 1.2, 1.3, 2.0):  # the last after a pause in which nobody looked
        moment.add(np.array([now]), np.ones((1, 6)), np.eye(3)[None], np.zeros((1, 6)))
        contact = moment.reading(model, solver).contact
        seen.append(None if contact is None else contact.reason)
        began.append(solver.began)
    assert seen == [Reason.OK, Reason.TWO_TOUCHES, None, Reason.OK, Reason.OK]
    assert began == [1, 1, 2, 2, 3]


# ---- opening -------------------------------------------------------------------------------------


def test_a_wrong_address_leaves_what_is_open(live):
    live.open(STEPWISE, STEPWISE)
    pair = live.pair
    with pytest.raises(AddressError):
        live.open("sri://nowhere", None)
    assert live.pair is pair


def test_what_cannot_be_opened_leaves_nothing_open(live, tmp_path):
    live.open(STEPWISE, STEPWISE)
    with pytest.raises(InputError):
        live.open(f"replay://{tmp_path}/none.mcap", None)
    assert live.pair is None
    assert live.health is None


def test_ensure_opens_only_what_is_not_open(live):
    live.ensure(STEPWISE, STEPWISE)
    pair = live.pair
    live.ensure(STEPWISE, STEPWISE)
    assert live.pair is pair
    live.ensure(STEPWISE, None)
    assert live.pair is not pair
    live.pair.step(10)
    assert 0 < live.ring.count <= 10


def test_closing_while_samples_come_and_are_asked_for_waits_for_nobody(live):
    address, stop = "virtual://bench?probe=convex&sensor=paper", threading.Event()

    def ask():
        while not stop.is_set():
            live.reading()
            live.history(1)
            stop.wait(0.001)

    readers = [threading.Thread(target=ask) for _ in range(2)]
    for reader in readers:
        reader.start()
    for _ in range(3):
        live.open(address, address)
        until(lambda: live.ring.count > 5)
        live.close()
        assert live.pair is None
    stop.set()
    for reader in readers:
        reader.join(10)
        assert not reader.is_alive()


# ---- how good they are ---------------------------------------------------------------------------


def test_trial_measures_noise_and_margin(live):
    assert trial_of(live) is None
    live.open(STEPWISE, STEPWISE)
    live.pair.step(1500)
    trial = trial_of(live)
    assert (trial.state, trial.sentences) == (StreamState.STREAMING, ())
    assert trial.rate == pytest.approx(200, rel=0.01)
    assert trial.pose_rate == pytest.approx(50, rel=0.01)
    assert trial.noise[:3] == pytest.approx(0.05, rel=0.2)
    assert trial.noise[3:] == pytest.approx(0.0014, rel=0.2)
    assert (trial.range_used < 0.1).all()
    assert trial.gaps == 0


def test_trial_counts_gaps(live):
    live.open(STEPWISE, None)
    for index in range(300):
        shift = 0.2 if index >= 150 else 0.0
        live._take_wrenches([WrenchSample(100 + 0.005 * index + shift, (index % 2, 0, 0), (0, 0, 0))])
    trial = trial_of(live)
    assert trial.gaps == 1
    assert trial.longest_gap == pytest.approx(0.205)
