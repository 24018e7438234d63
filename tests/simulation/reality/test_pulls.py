"""What a sensor feels beside the touch and the weight."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.reality import MIXES, Reality
from contactbench.pipeline.simulation.reality import RealProbe, WrenchDisturbance
from contactbench.pipeline.simulation.scenes import Payload
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
        same = np.allclose(F[5], F[len(F) - 6], atol=1e-12)
        assert same is closes, half


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
    felt = _disturbance(hand=1.0, seed=4)
    assert not _in_air(felt, _turned(np.zeros(3))).any()
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
