"""Each choice alone: its error is there without it, and gone with it."""

import numpy as np
import pytest
from benchmarks.plane import _block

from contactbench.pipeline.study.ablation import effects, location_choices, sensor_choices
from contactbench.pipeline.study.ablation.effects import compared, effect
from contactbench.pipeline.study.ablation.records import drawn
from contactbench.pipeline.study.ablation.scenery import foremost


@pytest.fixture(scope="module")
def record():
    return drawn("linear", 300, np.random.default_rng(1))


def test_figures_are_of_rows_that_are_sure_and_not_grossly_off():
    truth = np.zeros((4, 3))
    without = 1e-3 * np.array([[2.0, 0, 0], [20.0, 0, 0], [4.0, 0, 0], [np.nan] * 3])
    made = 1e-3 * np.array([[1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0]])
    sure = np.array([True, True, False, True])
    found = compared(truth, without, made, np.ones(4, dtype=bool), sure)
    assert (found["touches"], found["common"]) == (4, 1)
    assert (found["without_mean_mm"], found["made_mean_mm"], found["bought_mm"]) == pytest.approx((2, 1, 1))
    assert (found["without_gross"], found["made_gross"]) == (0.5, 0.0)
    assert (found["without_answered"], found["made_answered"]) == (0.75, 1.0)


def test_without_axial_torque_no_local_torque_is_left(record):
    plain = location_choices.without_axial(record.contacts)
    assert np.allclose(np.einsum("nd,nd->n", plain[:, :3], plain[:, 3:]), 0.0, atol=1e-12)
    made = location_choices.locators("linear", 500, 0.0).ours.locate_batch(plain)
    explained = made.misfits < 1e-9  # at the others' edges and corners the axis passes the coarse mesh by
    assert explained.mean() > 0.95
    assert np.abs(made.torques[explained]).max() < 1e-9


def test_local_torque_buys_more_the_more_it_twists(record):
    little = effect(location_choices.LOCAL_TORQUE, record, 2_000, 0.0, 0)
    twisted = drawn("linear", 300, np.random.default_rng(1), torsion=0.003)
    much = effect(location_choices.LOCAL_TORQUE, twisted, 2_000, 0.0, 0)
    assert 0 < little["bought_mm"] < 0.2 < much["bought_mm"]


@pytest.mark.parametrize("choice", sensor_choices.CHOICES)
def test_what_a_sensor_does_wrong_is_taken_off_again(record, choice):
    found = effect(choice, record, 2_000, effects.FILTERED, 0)
    clean = effect(location_choices.LOCAL_TORQUE, record, 2_000, effects.FILTERED, 0)["made_mean_mm"]
    assert found["without_mean_mm"] > 1.3 * clean
    assert found["made_mean_mm"] < 1.15 * clean
    none = effect(choice, record, 2_000, effects.FILTERED, 0, amount=0.0)
    assert abs(none["bought_mm"]) < 0.1 * clean


def test_a_robot_sees_the_mount_turned_even_where_the_sensor_does_not(record):
    found = effect(sensor_choices.MOUNT, record, 2_000, effects.FILTERED, 0)
    # 2 degrees at 100 mm and more from the sensor.
    assert found["flange_without_mean_mm"] > 1.0
    assert found["flange_made_mean_mm"] < 0.5


def test_ten_times_the_facets_are_nearer(record):
    found = effect(location_choices.FINER, record, 500, 0.0, 0)
    assert found["made_mean_mm"] < 0.3 * found["without_mean_mm"]


def test_the_same_seed_gives_the_same(record):
    one, other = (effect(location_choices.GATE, record, 500, 1.0, 5) for _ in range(2))
    assert one == other
    assert one != effect(location_choices.GATE, record, 500, 1.0, 6)


def test_a_rigid_plane_touches_what_is_foremost():
    into = np.array([[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.1, 0.1, 1.0]])
    middle, edge, corner = foremost(_block().vertices, into)
    assert middle == pytest.approx([0, 0, 0.1])
    assert edge == pytest.approx([0.03, 0, 0.1])
    assert corner == pytest.approx([0.03, 0.03, 0.1])


def test_inertia_means_something_only_where_something_moves():
    assert effects.meaningful(effects.INERTIA, "arm")
    assert not effects.meaningful(effects.INERTIA, "touch")
