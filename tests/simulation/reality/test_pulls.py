"""What a sensor feels beside the touch and the weight."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.reality import MIXES, Reality
from contactbench.pipeline.simulation.reality import Pad, RealProbe, WrenchDisturbance
from contactbench.pipeline.simulation.scenes.indenter import TipPress
from contactbench.pipeline.simulation.scenes.physics import Payload, TrueSurface
from contactbench.pipeline.simulation.virtual.bench import bundled
from contactbench.pipeline.simulation.virtual.markers import markers

Array = NDArray[np.float64]
_PAYLOAD = Payload()


def _disturbance(seed: int = 0, **sizes: float) -> WrenchDisturbance:
    truth = bundled("linear")
    return WrenchDisturbance(Reality(**sizes), RealProbe(truth, markers("linear")), seed, _PAYLOAD)


def _in_air(disturbance: WrenchDisturbance, R_WS: Array) -> Array:
    n = len(R_WS)
    return disturbance.wrenches(
        np.arange(n) * 0.1, R_WS, np.zeros((n, 6)), np.zeros((n, 3)), np.zeros((n, 3))
    )


def _pressed(disturbance: WrenchDisturbance, count: int = 1, force: float = 10.0) -> tuple[Array, Array]:
    """Return what is felt while the middle of the face is pressed straight, and that press alone."""
    point, normal = bundled("linear").nearest(markers("linear")[2])
    F = -force * normal
    contact = np.concatenate([F, np.cross(point, F)])
    rows = [np.tile(each, (count, 1)) for each in (contact, point, normal)]
    return disturbance.wrenches(np.arange(count) * 0.005, np.tile(np.eye(3), (count, 1, 1)), *rows), contact


def _turned(degrees: Array) -> Array:
    return np.asarray(Rotation.from_rotvec(np.outer(np.radians(degrees), [1.0, 0.0, 0.0])).as_matrix())


def test_an_ideal_bench_feels_the_touch_alone() -> None:
    felt, contact = _pressed(_disturbance())
    np.testing.assert_array_equal(felt[0], contact)
    np.testing.assert_array_equal(_in_air(_disturbance(), _turned(np.arange(4.0))), np.zeros((4, 6)))


def test_a_cable_pulls_nowhere_where_it_hangs_free_and_with_its_size_the_other_way_round() -> None:
    felt = _disturbance(cable=2.0)
    rest = felt._free
    away = Rotation.align_vectors([rest], [[0, 1, 0]])[0].as_matrix()
    opposite = Rotation.align_vectors([-rest], [[0, 1, 0]])[0].as_matrix()
    wrenches = _in_air(felt, np.array([away, opposite]))
    np.testing.assert_allclose(wrenches[0], 0.0, atol=1e-12)
    assert np.linalg.norm(wrenches[1, :3]) == pytest.approx(2.0)
    np.testing.assert_allclose(opposite @ wrenches[1, :3], 2.0 * rest, atol=1e-6)
    np.testing.assert_allclose(wrenches[1, 3:], np.cross([0, 0.02, 0.06], wrenches[1, :3]), atol=1e-12)


def test_a_cable_does_no_work_that_stays_without_drag_and_some_with_it() -> None:
    there_and_back = _turned(np.concatenate([np.arange(0.0, 90, 5), np.arange(90.0, -1, -5)]))
    for drag, closes in ((0.0, True), (0.5, False)):
        F = _in_air(_disturbance(cable=1.0, drag=drag), there_and_back)
        half = len(F) // 2
        assert np.allclose(F[5], F[len(F) - 6], atol=1e-12) is closes, half


def test_a_mount_that_yields_turns_the_probe_as_a_finite_turn_would() -> None:
    compliance = 2e-3
    felt, contact = _pressed(_disturbance(mount=1e3 * compliance))
    point, _ = bundled("linear").nearest(markers("linear")[2])
    weight = np.array([0, 0, -_PAYLOAD.mass * 9.80665])
    torque = contact[3:] + np.cross(_PAYLOAD.centre_of_mass_S, weight)
    R = Rotation.from_rotvec(compliance * torque).as_matrix()
    moved = np.cross(R @ point - point, contact[:3])
    moved += np.cross((R - np.eye(3)) @ _PAYLOAD.centre_of_mass_S, weight)
    np.testing.assert_allclose(felt[0, 3:] - contact[3:], moved, atol=0.01 * np.abs(moved).max())
    np.testing.assert_array_equal(felt[0, :3], contact[:3])


def test_a_second_tip_presses_beside_the_first() -> None:
    felt, contact = _pressed(_disturbance(second=0.5))
    other = felt[0] - contact
    assert np.linalg.norm(other[:3]) == pytest.approx(5.0)
    # Where its line comes nearest to the first place: some 30 mm away.
    F, M = other[:3], other[3:]
    point, _ = bundled("linear").nearest(markers("linear")[2])
    arm = np.linalg.norm(M - np.cross(point, F)) / 5.0
    assert 0.002 < arm < 0.06


def test_a_hand_pulls_only_while_something_presses() -> None:
    assert not _in_air(_disturbance(hand=1.0, seed=4), _turned(np.zeros(3))).any()
    wrenches, contact = _pressed(_disturbance(hand=1.0, seed=4), 40_000)
    pull = wrenches[:, :3] - contact[:3]
    assert np.sqrt((pull**2).sum(axis=1).mean()) == pytest.approx(1.0, rel=0.15)


def test_turning_one_effect_on_moves_no_other() -> None:
    R = _turned(np.linspace(0, 120, 9))
    alone = _in_air(_disturbance(seed=3, cable=0.4), R)
    with_others = _in_air(_disturbance(seed=3, cable=0.4, hand=0.5), R)
    np.testing.assert_array_equal(alone, with_others)


def test_asked_twice_about_the_same_moment_it_answers_the_same() -> None:
    reality = MIXES["harsh"]
    truth = bundled("linear")
    felt = WrenchDisturbance(reality, RealProbe.of(truth, markers("linear"), reality, 0), 0, _PAYLOAD)
    R = _turned(np.array([0.0, 40.0, 40.0]))
    times = np.array([0.0, 0.5, 0.5])
    point, normal = truth.nearest(markers("linear")[2])
    F = -9 * normal
    contact = np.concatenate([F, np.cross(point, F)])
    rows = [np.tile(each, (3, 1)) for each in (contact, point, normal)]
    wrenches = felt.wrenches(times, R, *rows)
    np.testing.assert_array_equal(wrenches[1], wrenches[2])


# ---- the probe on the bench, beside the one that the program is told of --------------------------


_NAME = "convex"


def _real(seed: int = 0, **sizes: float) -> RealProbe:
    return RealProbe.of(bundled(_NAME), markers(_NAME), Reality(**sizes), seed)


def test_an_ideal_bench_has_the_probe_itself() -> None:
    real = _real()
    assert real.truth is bundled(_NAME)
    np.testing.assert_array_equal(real.targets, markers(_NAME))


def test_a_lens_lifts_the_face_and_nothing_else() -> None:
    told = bundled(_NAME).probe
    away = _real(lens=0.5).truth.probe.vertices - told.vertices
    on_face = np.unique(told.faces[told.region > 0])
    elsewhere = np.setdiff1d(np.arange(len(told.vertices)), on_face)
    assert not away[elsewhere].any()
    assert np.linalg.norm(away, axis=1).max() == pytest.approx(0.5e-3, rel=1e-6)
    assert np.median(away[on_face][:, 2]) > 0.3e-3
    assert _real(lens=0.5).targets[2, 2] - markers(_NAME)[2, 2] == pytest.approx(0.5e-3, rel=0.02)


def test_scale_is_about_the_flange() -> None:
    told = bundled(_NAME).probe.vertices
    np.testing.assert_allclose(_real(scale=1.01).truth.probe.vertices, 1.01 * told)


def test_a_bent_head_is_turned_by_so_much_and_the_handle_is_not() -> None:
    told, real = bundled(_NAME).probe.vertices, _real(bend=2.0).truth.probe.vertices
    share = (told[:, 2] - told[:, 2].min()) / np.ptp(told[:, 2])
    np.testing.assert_allclose(real[share < 0.4], told[share < 0.4], atol=1e-15)
    head = share > 0.6
    turn, _ = Rotation.align_vectors(
        real[head] - real[head].mean(axis=0), told[head] - told[head].mean(axis=0)
    )
    assert np.degrees(turn.magnitude()) == pytest.approx(2.0, rel=1e-6)


def test_a_seat_turns_and_shifts_the_whole() -> None:
    real = _real(seat=1.5)
    moved = bundled(_NAME).probe.vertices @ real.T_said[:3, :3].T + real.T_said[:3, 3]
    np.testing.assert_allclose(real.truth.probe.vertices, moved)
    assert np.degrees(Rotation.from_matrix(real.T_said[:3, :3]).magnitude()) == pytest.approx(1.5)
    assert np.linalg.norm(real.T_said[:3, 3]) == pytest.approx(1.5e-3)


@pytest.mark.parametrize("mix", ["typical", "harsh"])
def test_targets_lie_on_the_true_surface(mix: str) -> None:
    real = RealProbe.of(bundled(_NAME), markers(_NAME), MIXES[mix], 5)
    for target in real.targets:
        np.testing.assert_allclose(real.truth.nearest(target)[0], target, atol=1e-9)
    assert not real.truth.probe.health.sentences


def test_markers_are_off_by_what_they_are_said_to_be() -> None:
    away = np.concatenate([_real(seed, markers=0.4).targets - markers(_NAME) for seed in range(12)])
    assert 1e3 * np.sqrt((away**2).sum(axis=1).mean() / 2) == pytest.approx(0.4, rel=0.12)


def test_a_ball_that_leans_touches_beside_its_mark_against_the_lean() -> None:
    real = _real(tip=1.5)
    place = real.targets[2]
    np.testing.assert_array_equal(real.aimed(place, TipPress(9.0)), place)
    off = 1e3 * (real.aimed(place, TipPress(9.0, tilt=30.0, azimuth=0.0)) - place)
    np.testing.assert_allclose(off[:2], [-0.75, 0.0], atol=0.02)


# ---- A soft pad: its pressures are what it is pressed with, and its torsion arm that of theory ----


_UP = np.array([0.0, 0.0, 1.0])
_FRICTION = 0.4


def _flat() -> TrueSurface:
    x = 0.1
    vertices = np.array([[sx * x, sy * x, z] for z in (0.0, -0.02) for sx in (-1, 1) for sy in (-1, 1)])
    faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
             [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]  # fmt: skip
    return TrueSurface(Probe.from_arrays(vertices, np.array(faces)))


def test_a_straight_pad_presses_its_centre_with_what_it_is_given() -> None:
    point = np.array([0.01, -0.02, 0.0])
    press = Pad(_flat(), 0.015).press(point, _UP, np.array([0.0, 0.0, -9.0]))
    np.testing.assert_allclose(press.contact[:3], [0, 0, -9], atol=1e-9)
    np.testing.assert_allclose(press.contact[3:], np.cross(point, [0, 0, -9]), atol=9 * 2e-4)
    np.testing.assert_allclose(press.centre_of_pressure, point, atol=2e-4)


@pytest.mark.parametrize(("twist", "share"), [(1.0, 1.0), (-1.0, -1.0), (0.5, 0.5)])
def test_a_pad_that_twists_has_the_torsion_arm_of_theory(twist: float, share: float) -> None:
    """Two thirds of friction times radius, for even pressure (Howe and Cutkosky 1996)."""
    press = Pad(_flat(), 0.015, twist=twist).press(np.zeros(3), _UP, np.array([0.0, 0.0, -9.0]))
    assert press.contact[5] / 9 == pytest.approx(-share * 2 / 3 * _FRICTION * 0.015, rel=0.03)


def test_what_pulls_along_the_surface_leaves_less_for_a_twist_and_slips_beyond_friction() -> None:
    pad = Pad(_flat(), 0.015, twist=1.0)
    half = pad.press(np.zeros(3), _UP, np.array([0.2 * 9, 0.0, -9.0]))
    assert half.contact[0] == pytest.approx(1.8)
    assert half.contact[5] / 9 == pytest.approx(-np.sqrt(0.75) * 2 / 3 * _FRICTION * 0.015, rel=0.03)
    slips = pad.press(np.zeros(3), _UP, np.array([9.0, 0.0, -9.0]))
    assert slips.contact[0] == pytest.approx(_FRICTION * 9)
    assert slips.contact[5] == pytest.approx(0.0, abs=1e-6)


def test_a_pad_askew_presses_beside_its_centre() -> None:
    """By theta R² / 4 d for one that touches all over, d the depth in the middle."""
    radius, degrees = 0.015, 3.0
    press = Pad(_flat(), radius, lean=degrees).press(np.zeros(3), _UP, np.array([0.0, 0.0, -9.0]))
    depth = 9.0 / (3e6 * np.pi * radius**2)
    expected = np.tan(np.radians(degrees)) * radius**2 / (4 * depth)
    assert np.linalg.norm(press.centre_of_pressure) == pytest.approx(expected, rel=0.05)
    assert len(press.places) == len(press.pressures)
    assert press.pressures.sum() == pytest.approx(9.0)


def test_a_pad_that_pulls_or_meets_nothing_is_refused() -> None:
    pad = Pad(_flat(), 0.015)
    with pytest.raises(InputError, match="soft pad"):
        pad.press(np.zeros(3), _UP, np.array([0.0, 0.0, 9.0]))
    with pytest.raises(InputError, match="soft pad"):
        pad.press(np.array([1.0, 0.0, 0.0]), _UP, np.array([0.0, 0.0, -9.0]))
