"""The probe on a mount over a moving phantom: what it reads, how it stands to the phantom, what it is told."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes.physics import Payload, TrueSurface
from contactbench.pipeline.simulation.scenes.platform import (
    AXES,
    DOWN,
    PlatformMotion,
    PlatformScene,
    Tissue,
    TissueCylinder,
)

_G = np.array([0.0, 0.0, -9.80665])
_PERIOD = 0.02


def _weight(payload: Payload, R_BS: np.ndarray, acceleration: np.ndarray | None = None) -> np.ndarray:
    force = R_BS.T @ (payload.mass * (_G - (np.zeros(3) if acceleration is None else acceleration)))
    return np.concatenate([force, np.cross(payload.centre_of_mass_S, force)])


def _turned(axis: str, angle: float) -> PlatformMotion:
    """Return a motion that is at its largest, and all but still, after 1 s."""
    return PlatformMotion.along(axis, angle, 4.0)


def test_at_rest_it_reads_contact_and_weight(truth: TrueSurface) -> None:
    payload = Payload(0.6, np.array([0.01, -0.004, 0.05]))
    scene = PlatformScene(truth, payload=payload, gap=-0.002)
    for _ in range(10):
        scene.command(scene.start + [0, 0, 0, 0.02, 0.03, 0])
        scene.advance(_PERIOD)
    scene.advance(0.8)
    moment = scene.moment()
    assert moment.contact[2] < -2.0
    assert scene.joints[4] == pytest.approx(0.03, abs=1e-3)
    np.testing.assert_allclose(moment.reading, moment.contact + _weight(payload, moment.R_WS), atol=1e-3)


def test_in_motion_it_also_reads_the_inertia(truth: TrueSurface) -> None:
    payload = Payload()
    scene = PlatformScene(truth, payload=payload, gap=0.02)
    for k in range(20):
        scene.command(scene.start + 0.006 * np.sin(20 * k * _PERIOD) * np.array([1, 1, 1, 0, 0, 0]))
        scene.advance(_PERIOD)
    places = []
    for at in range(3):
        if at == 1:
            moment = scene.moment()
        places.append(scene.joints[:3])
        scene.step()
    acceleration = (places[2] - 2 * places[1] + places[0]) / scene.step_s**2
    assert np.abs(acceleration).max() > 0.1
    np.testing.assert_allclose(moment.reading, _weight(payload, moment.R_WS, acceleration), atol=0.02)


@pytest.mark.parametrize("angle", [0.1, -0.05])
def test_the_phantom_turns_about_the_axes_of_its_platform(truth: TrueSurface, angle: float) -> None:
    for axis, name in enumerate(("rx", "ry")):
        scene = PlatformScene(truth, motion=_turned(name, angle), gap=0.03)
        scene.advance(1.0)
        point, normal = scene.surface()
        np.testing.assert_allclose(point, 0, atol=1e-9)
        wanted = Rotation.from_rotvec(angle * np.eye(3)[axis]).apply([0, 0, 1])
        np.testing.assert_allclose(normal, wanted, atol=1e-5)
        # S's x is that of B, its y points the other way: (about y, about x).
        expected = (0.0, angle) if name == "rx" else (-angle, 0.0)
        np.testing.assert_allclose(scene.angles(), expected, atol=1e-5)


def test_a_probe_that_turns_by_the_angles_stands_upright(truth: TrueSurface) -> None:
    scene = PlatformScene(truth, motion=_turned("ry", 0.08), gap=0.03)
    scene.advance(1.0)
    about_y, about_x = scene.angles()
    # Small turns in S, from right of DOWN to left of it; the hinges stand on the left.
    turn = DOWN @ np.array([about_x, about_y, 0.0])
    for _ in range(20):
        scene.command(scene.start + np.concatenate([np.zeros(3), turn]))
        scene.advance(_PERIOD)
    left = scene.angles()
    wanted = scene.motion.at(scene.time)[4]  # type: ignore[union-attr]
    assert wanted < 0.08
    np.testing.assert_allclose(left, (0.08 - wanted, 0.0), atol=1e-4)


def test_where_the_phantom_is_deeper_the_contact_is(truth: TrueSurface) -> None:
    scene = PlatformScene(truth, motion=_turned("ry", 0.03), tissue=Tissue(friction=0.0), gap=-0.002)
    scene.advance(1.0)
    moment = scene.moment()
    # B's +x side went down: the phantom is turned by a negative angle about S's y, and presses where x is negative.
    assert scene.angles()[0] < 0
    assert moment.centroid_S[0] < -0.002


def test_the_phantom_goes_up_and_down_and_the_top_is_where_the_motion_says(truth: TrueSurface) -> None:
    motion = PlatformMotion(np.array([0.003, -0.002, 0.01, 0, 0, 0]), 2.0, start=0.1)
    scene = PlatformScene(truth, motion=motion, gap=0.03)
    for _ in range(8):
        scene.advance(0.1)
        np.testing.assert_allclose(scene.surface()[0], motion.at(scene.time)[:3], atol=2e-5)
        np.testing.assert_allclose(scene.surface()[1], [0, 0, 1], atol=1e-9)


def test_a_jump_in_speed_is_followed_without_overshoot(truth: TrueSurface) -> None:
    motion = PlatformMotion.along("ry", np.radians(10), 2.0, start=0.1)
    scene = PlatformScene(truth, motion=motion, gap=0.03)
    off = []
    for _ in range(200):
        scene.step()
        off.append(scene.angles()[0] + motion.at(scene.time)[4])
    assert np.abs(off).max() < 1e-3


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_command_that_is_not_finite_is_refused_and_changes_nothing(truth: TrueSurface, bad: float) -> None:
    scene = PlatformScene(truth)
    with pytest.raises(InputError, match="give 6 finite numbers"):
        scene.command(np.array([0, 0, bad, 0, 0, 0]))
    with pytest.raises(InputError, match="give 6 finite numbers"):
        scene.command(np.zeros(5))
    scene.advance(0.1)
    np.testing.assert_allclose(scene.joints, scene.start, atol=1e-6)


def test_a_command_out_of_reach_is_gone_to_within_the_mounts_limits(truth: TrueSurface) -> None:
    scene = PlatformScene(truth)
    before, fastest = scene.joints, np.zeros(6)
    for k in range(300):
        if k % round(_PERIOD / scene.step_s) == 0:
            scene.command(scene.start + [0, 0, 1.0, 0, 1.0, 0])
        scene.step()
        fastest = np.maximum(fastest, np.abs(scene.joints - before) / scene.step_s)
        before = scene.joints
    assert fastest[2] == pytest.approx(0.25, rel=0.03)
    assert fastest[4] == pytest.approx(np.pi / 2, rel=0.03)


def test_a_cylinder_twists_a_long_face_that_lies_askew_and_its_normal_is_local(truth: TrueSurface) -> None:
    def resting(askew: float) -> PlatformScene:
        tissue = Tissue(friction=0.0, cylinder=TissueCylinder(0.1, askew))
        scene = PlatformScene(truth, tissue=tissue, gap=-0.003)
        scene.advance(0.3)
        return scene

    torsions = [1e3 * resting(np.radians(angle)).moment().torsion for angle in (0.0, 40.0, -40.0)]
    assert abs(torsions[0]) < 0.05 < 0.5 < abs(torsions[1])
    assert torsions[2] == pytest.approx(-torsions[1], rel=0.05)
    # The axis lies along x; what was the top is 10 mm aside: there the normal leans by asin(10 / 100).
    scene = resting(0.0)
    scene.data.qpos[-5] = 0.01
    place, normal = scene.surface()
    assert np.degrees(np.arcsin(normal[1])) == pytest.approx(-np.degrees(np.arctan2(0.01, 0.1)), abs=0.3)
    assert np.linalg.norm(place - [place[0], 0.01, -0.1]) == pytest.approx(0.1, abs=1e-3)
    with pytest.raises(InputError, match="a cylinder of 0"):
        TissueCylinder(0.0)


# ---- how a platform moves ------------------------------------------------------------------------


@pytest.mark.parametrize("axis", AXES)
def test_it_rests_and_then_goes_as_a_sine_along_or_about_one_axis(axis: str) -> None:
    motion = PlatformMotion.along(axis, 0.01, 2.0, start=1.0)
    assert not motion.at(0.99).any()
    for time, share in ((1.5, 1.0), (2.0, 0.0), (2.5, -1.0)):
        wanted = 0.01 * share * np.eye(6)[AXES.index(axis)]
        np.testing.assert_allclose(motion.at(time), wanted, atol=1e-15)


def test_its_speed_is_the_derivative() -> None:
    motion = PlatformMotion(np.arange(1.0, 7.0) * 1e-3, 3.0, 0.5)
    np.testing.assert_allclose(
        motion.speed(1.1), 2 * np.pi / 3 * np.cos(0.4 * np.pi) * motion.amplitude, rtol=1e-6
    )
    assert not motion.speed(0.4).any()


def test_it_can_begin_gently() -> None:
    motion = PlatformMotion(np.eye(6)[2] * 0.01, 2.0, start=1.0, ease=2.0)
    assert motion.at(1.5)[2] == pytest.approx(0.0025)
    assert motion.at(5.5)[2] == pytest.approx(0.01)
    assert motion.speed(1.001)[2] < 1e-3 * motion.speed(5.0)[2] + 2e-4


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((np.zeros(5), 2.0), "six finite numbers"),
        ((np.full(6, np.nan), 2.0), "six finite numbers"),
        ((np.zeros(6), 0.0), "period"),
        ((np.zeros(6), np.nan), "period"),
        ((np.zeros(6), 2.0, -1.0), "start"),
        ((np.zeros(6), 2.0, 0.0, -1.0), "ease"),
    ],
)
def test_motions_that_are_none_are_refused(values: tuple, message: str) -> None:
    with pytest.raises(InputError, match=message):
        PlatformMotion(*values)


def test_an_axis_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="give one of x, y, z"):
        PlatformMotion.along("up", 0.01, 2.0)
