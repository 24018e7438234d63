"""The bench stepwise: same seed, same bytes; commands do what they say, when they say."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from simulation.virtual.script_text import script_text

from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import MIXES, Reality
from contactbench.pipeline.simulation.scenes.physics import Payload, PhysicsError
from contactbench.pipeline.simulation.sensor_model import SensorSettings
from contactbench.pipeline.simulation.virtual.bench import VirtualBench
from contactbench.pipeline.simulation.virtual.commands import (
    CommandError,
    End,
    ScriptError,
    Timed,
    parse_script,
)

SCRIPT = """
{"at": 0.1, "do": "turn_to", "rpy": [0, 40, 10], "seconds": 0.4}
{"after": 0.1, "do": "touch", "marker": 3, "force": 9, "seconds": 0.6}
{"after": 0.2, "do": "bump", "force": [20, 0, 0], "seconds": 0.1}
{"after": 0.2, "do": "warm", "kelvin": 5}
{"after": 0.0, "do": "rezero"}
{"after": 0.3, "do": "end"}
"""


def everything(bench, slice_s=0.1):
    batches = []
    while not bench.ended:
        batches.append(bench.advance(slice_s))
    wrenches = [sample for batch in batches for sample in batch.wrenches]
    flanges = [sample for batch in batches for sample in batch.flanges]
    truths = [truth for batch in batches for truth in batch.truths]
    return wrenches, flanges, truths


def scripted(**how):
    return VirtualBench(script=parse_script(SCRIPT), **how)


def test_the_same_seed_gives_the_same_whatever_the_slices():
    first, poses, _ = everything(scripted(sensor="noisy", seed=3))
    again, others, _ = everything(scripted(sensor="noisy", seed=3), slice_s=0.0135)
    assert first == again
    assert all(np.array_equal(a.R_BE, b.R_BE) for a, b in zip(poses, others, strict=True))
    other, *_ = everything(scripted(sensor="noisy", seed=4))
    assert first != other


def test_a_script_is_done_and_can_be_done_again_from_the_log():
    bench = scripted(sensor="ideal")
    wrenches, flanges, truths = everything(bench)
    assert [done.command.name for done in bench.log] == ["turn_to", "touch", "bump", "warm", "rezero", "end"]
    turn, touch, bump, warm, rezero, end = (done.time for done in bench.log)
    assert (turn, touch) == pytest.approx((0.1, 0.6))
    assert (bump, warm, rezero, end) == pytest.approx((1.4, 1.7, 1.7, 2.0))
    assert [sample.sequence for sample in wrenches] == list(range(len(wrenches)))
    np.testing.assert_allclose(np.diff([sample.time for sample in wrenches]), 0.005, atol=1e-12)
    np.testing.assert_allclose(np.diff([sample.time for sample in flanges]), 0.02, atol=1e-12)

    # The wrist is where it was told to be.
    wanted = Rotation.from_euler("xyz", [0, 40, 10], degrees=True).as_matrix()
    np.testing.assert_allclose(flanges[-1].R_BE, wanted, atol=1e-5)
    # The touch is of 9 N at the marker while it lasts, and nowhere after.
    pressed = [truth for truth in truths if touch + 0.4 < truth.time < touch + 0.59]
    assert all(truth.force == pytest.approx(9.0, abs=0.05) for truth in pressed)
    assert all(np.linalg.norm(truth.point_S - bench.markers[2]) < 5e-4 for truth in pressed)
    assert not any(truth.contacts for truth in truths if truth.time > touch + 0.6)
    # The bump is in the readings while it lasts, and the re-zero takes away the weight.
    times = np.array([sample.time for sample in wrenches])
    forces = np.array([sample.force for sample in wrenches])
    pushed = forces[(times > bump + 0.05) & (times < bump + 0.095)].mean(axis=0)
    before = forces[(times > bump - 0.05) & (times < bump)].mean(axis=0)
    np.testing.assert_allclose(pushed - before, [20, 0, 0], atol=0.5)
    assert np.linalg.norm(forces[(times > rezero + 0.01)], axis=1).max() < 0.05
    assert np.linalg.norm(before) == pytest.approx(0.45 * 9.80665, rel=1e-3)

    script = script_text(Timed(done.command, at=done.time) for done in bench.log)
    again, *_ = everything(VirtualBench(sensor="ideal", script=parse_script(script)))
    assert again == wrenches


def test_the_truth_is_that_of_the_scene_at_the_sample_s_time():
    bench = VirtualBench(sensor="ideal", rate=1000.0)
    bench.touch(4, tilt=20.0)
    batch = bench.advance(0.4)
    truth = bench.scene.moment()
    following = bench.advance(0.0005)
    assert truth.contacts > 0
    assert following.truths[0].time == pytest.approx(truth.time, abs=1e-9)
    assert np.array_equal(following.truths[0].reading, truth.reading)
    assert np.array_equal(following.truths[0].centroid_S, truth.centroid_S)
    assert [sample.force for sample in batch.wrenches] == [tuple(truth.reading[:3]) for truth in batch.truths]


def test_poses_are_those_of_the_flange_that_the_sensor_is_mounted_on():
    R_SE = Rotation.from_euler("z", 30, degrees=True).as_matrix()
    bench = VirtualBench(sensor="ideal", R_SE=R_SE)
    bench.turn_to(rpy=(20, 0, 0), seconds=0.3)
    batch = bench.advance(0.6)
    np.testing.assert_allclose(batch.flanges[-1].R_BE @ R_SE.T, batch.truths[-1].R_WS, atol=1e-6)


def test_a_sensor_says_when_it_is_at_its_limit_and_how_warm_it_is():
    bench = VirtualBench(sensor=SensorSettings(limit=np.array([5.0, 5.0, 5.0, 1.0, 1.0, 1.0])))
    bench.advance(0.1)
    bench.bump([10.0, 0.0, 0.0], 0.2)
    sample = bench.advance(0.1).wrenches[-1]
    assert sample.status is Status.OVERRANGE
    assert sample.force[0] == 5.0
    warming = VirtualBench(sensor=SensorSettings(warm_up=(4.0, 0.5)))
    given = [sample.temperature for sample in warming.advance(0.5).wrenches]
    assert given[0] == 22.0
    assert given[-1] > 24.0


def test_what_cannot_be_done_is_said_to_who_asked():
    bench = VirtualBench(sensor="ideal")
    turn = bench.turn_to(rpy=(0, 90, 0))
    early, wrong = bench.touch(1), bench.touch(18)
    bench.advance(0.01)
    assert turn.result(0).until == pytest.approx(1.5)
    with pytest.raises(CommandError, match=r"turns until 1\.500 s"):
        early.result(0)
    bench.advance(1.6)
    wrong = bench.touch(18)
    touch, move = bench.touch(1), bench.turn_to(rpy=(0, 0, 0))
    bench.advance(0.01)
    with pytest.raises(CommandError, match="choose 1 to 17"):
        wrong.result(0)
    assert touch.result(0).time == pytest.approx(1.61)
    with pytest.raises(InputError, match="release it first"):
        move.result(0)
    bench.send(End())
    assert not bench.advance(0.1).wrenches
    bench.close()
    with pytest.raises(CommandError, match="closed"):
        bench.release().result(0)


def test_a_script_that_asks_for_the_impossible_ends_with_its_line():
    script = parse_script(
        '{"at": 0, "do": "turn_to", "rpy": [0, 90, 0]}\n{"at": 0.1, "do": "touch", "marker": 1}', "a"
    )
    with pytest.raises(ScriptError, match=r"a, line 2: touch: the wrist turns"):
        VirtualBench(script=script).advance(0.2)


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"rate": 2000.0}, "rate 2000 Hz"),
        ({"seed": -1}, "seed -1"),
        ({"probe": "axe"}, "no probe 'axe'"),
        ({"sensor": "best"}, "choose one of ideal"),
        ({"R_SE": -np.eye(3)}, "not a rotation"),
    ],
)
def test_a_bench_that_cannot_be_is_refused(how, message):
    with pytest.raises(InputError, match=message):
        VirtualBench(**how)


def test_another_payload_weighs_what_it_weighs():
    bench = VirtualBench(sensor="ideal", payload=Payload(mass=1.0))
    assert np.linalg.norm(bench.advance(0.01).wrenches[0].force) == pytest.approx(9.80665, rel=1e-6)


def test_nothing_leaps_when_a_tip_comes_or_goes():
    bench = VirtualBench(sensor="ideal", rate=1000.0)
    bench.turn_to(rpy=(0, 90, 0), seconds=0.3)
    still = np.array(bench.advance(0.5).wrenches[-1].force)
    touch = bench.touch(3, force=0.0)
    assert bench.advance(0.02).done[0].time == touch.result(0).time
    bench.touch(3, force=0.0)
    near = [sample.force for sample in bench.advance(0.02).wrenches]
    bench.release()
    near += [sample.force for sample in bench.advance(0.02).wrenches]
    assert np.abs(np.array(near) - still).max() < 1e-3


def test_a_touch_that_slides_off_is_found_once():
    bench = VirtualBench(sensor="ideal")
    touch = bench.touch(3, tilt=80.0)
    batch = bench.advance(2.5)
    (slip,) = batch.slips
    assert slip.touch is touch.result(0)
    assert 0.5 < slip.time < 1.5
    assert not any(truth.contacts for truth in batch.truths if slip.time - 0.49 < truth.time <= slip.time)
    assert "slid off" in bench.findings()[0]
    bench.release()
    assert not bench.advance(1.0).slips
    assert bench.findings() == ()
    bench.touch(3)
    assert not bench.advance(1.2).slips


def test_a_run_lasts_until_all_that_was_begun_is_over():
    bench = VirtualBench(sensor="ideal")
    bench.touch(3, seconds=2.0)
    bench.bump([1.0, 0.0, 0.0], 0.1)
    bench.advance(0.1)
    assert bench.idle_from == pytest.approx(2.0)
    bench.release()
    bench.advance(0.1)
    assert bench.idle_from == pytest.approx(0.1)


def test_who_asked_hears_of_a_mistake_of_the_program(monkeypatch):
    bench = VirtualBench(sensor="ideal")

    def broken(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(bench.scene, "bump", broken)
    answer = bench.bump([1.0, 0.0, 0.0])
    with pytest.raises(ZeroDivisionError):
        bench.advance(0.01)
    with pytest.raises(CommandError, match="the bench failed"):
        answer.result(0)


def test_physics_that_comes_apart_ends_the_samples():
    bench = VirtualBench(sensor="ideal")
    bench.scene.data.qvel[0] = 1e20
    with pytest.raises(PhysicsError):
        bench.advance(0.1)


# ---- a bench that is not ideal ---------------------------------------------------------------------


def test_an_ideal_reality_changes_no_bit() -> None:
    plain, ideal = VirtualBench(seed=5), VirtualBench(seed=5, reality=Reality())
    for bench in (plain, ideal):
        bench.touch(2, force=9.0, tilt=20.0)
    ours, theirs = plain.advance(0.5), ideal.advance(0.5)
    assert ours.wrenches == theirs.wrenches
    assert all((a.reading == b.reading).all() for a, b in zip(ours.truths, theirs.truths, strict=True))


def test_a_real_bench_gives_the_same_bytes_for_the_same_seed_and_others_for_another() -> None:
    found = []
    for seed in (5, 5, 6):
        bench = VirtualBench(seed=seed, reality=MIXES["typical"])
        bench.touch(2, force=9.0, tilt=20.0)
        found.append(bench.advance(0.5).wrenches)
    assert found[0] == found[1] != found[2]


def test_a_late_line_gives_every_sample_once_in_order_and_as_late_as_it_says() -> None:
    bench = VirtualBench(sensor="ideal", reality=Reality(latency=20, jitter=2))
    samples = bench.advance(0.5).wrenches
    assert [sample.sequence for sample in samples] == list(range(len(samples)))
    late = [sample.arrived - sample.time for sample in samples]
    assert min(late) >= 0.02
    assert np.mean(late) == pytest.approx(0.022, abs=0.002)
    assert 93 <= len(samples) <= 96


def test_a_late_pose_is_the_one_of_a_while_ago() -> None:
    now, late = VirtualBench(pose_rate=100.0), VirtualBench(pose_rate=100.0, reality=Reality(pose_latency=20))
    turns = []
    for bench in (now, late):
        bench.turn_to(rpy=[0, 60, 0], seconds=1.0)
        turns.append([sample.R_BE for sample in bench.advance(0.8).flanges])
    for early, then in zip(turns[0][10:-2], turns[1][12:], strict=True):
        np.testing.assert_allclose(then, early, atol=2e-3)
    assert np.abs(turns[0][40] - turns[1][40]).max() > 0.01


def test_the_truth_beside_a_wrench_is_what_is_felt() -> None:
    bench = VirtualBench(sensor="ideal", reality=Reality(cable=1.0, seat=1.0))
    bench.touch(3, force=9.0)
    batch = bench.advance(0.6)
    sample, truth = batch.wrenches[-1], batch.truths[-1]
    np.testing.assert_allclose([*sample.force, *sample.torque], truth.reading)
    assert truth.contacts > 0
    np.testing.assert_allclose(truth.point_S, bench.real.targets[2], atol=2e-4)
    assert np.linalg.norm(truth.point_S - bench.markers[2]) > 5e-4
