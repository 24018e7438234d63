import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from workbench.gravity_bench import batches, block

from contactbench.pipeline.calibration import Level
from contactbench.pipeline.calibration.stillness import StillState
from contactbench.pipeline.session.state import State
from contactbench.pipeline.workbench.gravity import GravityCheck, GravityWork
from contactbench.pipeline.workbench.gravity_fit import PoseState, gravity_settings
from contactbench.pipeline.workbench.live import LiveBlock

PLAIN = gravity_settings(State())


@pytest.fixture
def work():
    made = []

    def make(*args, **given):
        made.append(GravityWork(*args, **given))
        return made[-1]

    yield make
    for each in made:
        each.close()


def test_each_still_pose_is_taken_and_the_contact_error_shrinks(work):
    run = work(PLAIN)
    run.wait()
    assert "mm" not in run.view().solved.proposal.sentence  # planned: nobody knows the noise yet
    for batch in batches():
        run.feed(block(batch))
    run.wait()
    view = run.view()
    assert [row.state for row in view.rows] == [PoseState.TAKEN] * 6
    assert view.count == view.expected == 6
    assert view.solved.calibration.verdict.level is Level.GOOD
    assert view.solved.calibration.mass == pytest.approx(0.452, abs=0.02)
    assert view.errors[-1] < 0.0005
    assert view.captured
    assert view.state is StillState.STILL
    assert "mm (1 sigma" in view.solved.proposal.sentence
    assert not view.solved.findings
    assert run.left_out == ()


def test_by_key_only_the_poses_that_were_asked_for_count(work):
    run = work(PLAIN, automatic=False)
    assert run.view().state is StillState.STALE
    said = []
    for number, batch in enumerate(batches(3)):
        run.feed(block(batch))
        if number == 5:  # the first pose: it is still
            said.append(run.take())
    run.wait()
    view = run.view()
    assert [row.state for row in view.rows] == [PoseState.TAKEN, PoseState.LEFT_OUT, PoseState.LEFT_OUT]
    assert len(run.left_out) == 2
    assert "keep still" in said[0] or said[0] == "Taken."
    assert run.take() == "Taken."  # the present one, which was not taken
    run.wait()
    assert run.view().count == 2
    assert "already" in run.take()


def test_a_bumped_pose_is_named_left_out_and_can_be_taken_back(work):
    run = work(PLAIN)
    for batch in batches(6, bumped=2):
        run.feed(block(batch))
    run.wait()
    view = run.view()
    rejected = [row for row in view.rows if row.state is PoseState.REJECTED]
    assert rejected
    assert all(row.reason for row in rejected)
    outlier = next(row for row in rejected if row.changeable)
    (finding,) = [each for each in view.solved.findings if each.key == f"rejected {outlier.name}"]
    assert "Retake it" in finding.sentence
    run.set_left_out([outlier.time], True)
    run.wait()
    assert not run.view().solved.findings
    assert [row.name for row in run.view().rows if row.state is PoseState.LEFT_OUT] == [outlier.name]
    (moment,) = run.left_out
    assert moment == outlier.time
    run.set_left_out([outlier.time], False)
    run.wait()
    assert run.left_out == ()


@pytest.mark.parametrize("degrees", [90, 180])
def test_a_wrong_mount_is_found_and_confirming_it_mends_the_poses(work, degrees):
    turn = Rotation.from_euler("z", -degrees, degrees=True).as_matrix()
    run = work(PLAIN)
    for batch in batches():
        run.feed(block(batch, turn))
    run.wait()
    assert run.view().solved.calibration.verdict.level is Level.REFUSE
    finding = run.view().solved.findings[0]
    ((key, angles),) = finding.settings
    assert key == "devices.mount"
    assert Rotation.from_euler("xyz", angles, degrees=True).magnitude() == pytest.approx(np.radians(degrees))
    assert finding.remedy
    run.apply(gravity_settings(_state({key: angles})))
    run.wait()
    assert run.view().solved.calibration.verdict.level is Level.GOOD
    assert not run.view().solved.findings


def test_a_mount_that_is_no_quarter_turn_is_found_too(work):
    run = work(PLAIN)
    turn = Rotation.from_euler("xyz", [0, 20, -37], degrees=True).as_matrix().T
    for batch in batches():
        run.feed(block(batch, turn))
    run.wait()
    finding = run.view().solved.findings[0]
    assert finding.key == "mount"
    run.apply(gravity_settings(_state(dict(finding.settings))))
    run.wait()
    assert run.view().solved.calibration.verdict.level is not Level.REFUSE


def test_a_mount_is_estimated_also_from_inverse_orientations(work):
    turn = Rotation.from_euler("z", -90, degrees=True).as_matrix()
    given = {"calibration.inverse": True, "calibration.estimate_mount": True}
    run = work(gravity_settings(_state(given)))
    for each in (block(batch, turn) for batch in batches()):
        run.feed(LiveBlock(each.times, each.wrenches, each.R_WS.swapaxes(1, 2), each.saturated))
    run.wait()
    assert run.view().solved.calibration.verdict.level is not Level.REFUSE
    assert run.view().solved.calibration.mass == pytest.approx(0.452, abs=0.02)


def test_without_orientations_it_says_what_is_missing(work):
    run = work(PLAIN)
    first = block(batches()[0])
    run.feed(LiveBlock(first.times, first.wrenches, np.full_like(first.R_WS, np.nan), first.saturated))
    assert run.view().state is StillState.STALE
    assert "orientation" in run.view().sentence


def test_silence_is_said(work):
    run = work(PLAIN)
    some = block(batches()[0])
    run.feed(some)
    assert run.view(now=some.times[-1] + 0.1).state is not StillState.STALE
    assert run.view(now=some.times[-1] + 3.0).state is StillState.STALE


def test_times_that_go_back_begin_the_captures_anew(work):
    run = work(PLAIN)
    for batch in batches(2):
        run.feed(block(batch))
    run.feed(block(batches()[0]))
    run.wait()
    assert run.view().rows == ()


def test_a_pose_that_was_held_out_checks_the_calibration(work):
    run = work(PLAIN)
    for batch in batches()[: 9 * 5]:
        run.feed(block(batch))
    run.wait()
    fitted = run.view().solved.calibration
    check = GravityCheck(fitted, PLAIN)
    for batch in batches()[: 9 * 1]:
        check.feed(block(batch))
    assert check.found is None
    assert "turn the tool further" in check.sentence
    check = GravityCheck(fitted, PLAIN)
    assert check.state is StillState.SETTLING
    assert "keep still" in check.sentence
    for batch in batches()[9 * 5 :]:
        check.feed(block(batch))
    assert check.found is not None
    assert check.found.passed


def test_settings_that_make_no_sense_are_refused_with_a_remedy():
    with pytest.raises(ValueError, match="set it again"):
        gravity_settings(_state({"devices.max_tilt": "steep"}))
    with pytest.raises(ValueError, match="correct it"):
        gravity_settings(_state({"devices.mount": [1, 2]}))
    later = _state({"calibration.mount": [0.0, 0.0, 1.0], "devices.mount": [0.0, 0.0, 90.0]})
    assert gravity_settings(later).given == {"mount": [0.0, 0.0, 90.0]}


def _state(values):
    from contactbench.pipeline.session.state import Setting

    return State(
        settings={key: Setting(value, number, "") for number, (key, value) in enumerate(values.items())}
    )
