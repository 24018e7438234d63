import numpy as np

from contactbench.pipeline.control.controller import Tare


def test_the_mean_of_all_readings_in_the_air_is_taken_off():
    tare = Tare(0.06)
    for value, count in ((1.0, 4), (2.0, 4), (7.0, 1)):
        assert not tare.over
        tare.take(0.01 * np.full(6, value), count, 0.02)
    assert tare.over
    np.testing.assert_allclose(tare.wrench, 0.01 * np.full(6, 19 / 9))
    tare.take(np.full(6, 9.0), 4, 0.02)
    np.testing.assert_allclose(tare.wrench, 0.01 * np.full(6, 19 / 9))


def test_what_may_be_a_touch_is_not():
    for wrench in (np.array([0, 0, -0.5, 0, 0, 0]), np.array([0, 0, 0, 0.05, 0, 0])):
        tare = Tare(0.02)
        tare.take(wrench, 4, 0.02)
        assert tare.over
        np.testing.assert_array_equal(tare.wrench, np.zeros(6))


def test_no_time_is_no_tare():
    assert Tare(0.0).over
