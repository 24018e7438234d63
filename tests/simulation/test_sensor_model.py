"""A sensor that is known exactly: every fault it has is one that was asked for."""

from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.sensor_model import PRESETS, SensorModel, SensorSettings, preset

_TIMES = np.arange(4000) / 200.0


def test_the_ideal_sensor_reads_the_truth() -> None:
    wrenches = np.random.default_rng(1).normal(size=(50, 6))
    readings = SensorModel(preset("ideal")).read(np.arange(50), wrenches)
    np.testing.assert_array_equal(readings.wrenches, wrenches)
    assert not readings.saturated.any()


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_noise_has_the_standard_deviation_it_is_said_to_have(name: str) -> None:
    settings = replace(PRESETS[name], drift=np.zeros(6))
    readings = SensorModel(settings, seed=3).read(_TIMES, np.zeros((len(_TIMES), 6))).wrenches
    expected = np.sqrt(settings.noise**2 + settings.resolution**2 / 12)
    np.testing.assert_allclose(readings.std(axis=0), expected, rtol=0.06, atol=1e-12)
    np.testing.assert_allclose(readings.mean(axis=0), settings.bias, atol=5 * expected.max() / 60 + 1e-12)


def test_readings_are_whole_steps() -> None:
    settings = PRESETS["paper"]
    readings = SensorModel(settings, seed=1).read([0.0, 0.005], np.ones((2, 6))).wrenches
    steps = readings / settings.resolution
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)


def test_a_warmer_sensor_moves_its_zero_with_its_own_time_constant() -> None:
    settings = SensorSettings(drift=np.arange(6) * 0.01, warm_up=(0.0, 100.0))
    sensor = SensorModel(settings)
    sensor.warm(10.0, 50.0)
    readings = sensor.read([0.0, 50.0, 150.0, 1e5], np.zeros((4, 6)))
    np.testing.assert_allclose(readings.temperatures, 22 + 10 * np.array([0, 0, 1 - np.exp(-1), 1]))
    np.testing.assert_allclose(readings.wrenches, np.outer(readings.temperatures - 22, settings.drift))


def test_a_rezero_makes_the_load_of_that_moment_the_zero() -> None:
    sensor = SensorModel(replace(PRESETS["noisy"], noise=np.zeros(6), resolution=np.zeros(6)))
    load = np.array([1.0, 2, -3, 0.1, 0.2, 0.3])
    sensor.rezero(load, 30.0)
    np.testing.assert_allclose(sensor.read([30.0], load[None]).wrenches, 0, atol=1e-12)
    assert np.abs(sensor.read([30.0], np.zeros((1, 6))).wrenches).max() > 1


def test_a_reading_beyond_the_range_is_the_limit_and_says_so() -> None:
    sensor = SensorModel(SensorSettings(limit=np.full(6, 5.0)))
    readings = sensor.read([0.0, 1.0], [[9.0, 0, 0, 0, 0, 0], [-4.9, 0, 0, 0, 0, 0]])
    assert readings.saturated.tolist() == [True, False]
    assert readings.wrenches[:, 0].tolist() == [5.0, -4.9]


def test_the_same_seed_gives_the_same_bytes() -> None:
    once, twice = (SensorModel(PRESETS["paper"], 7).read(_TIMES, np.zeros((4000, 6))) for _ in range(2))
    assert once.wrenches.tobytes() == twice.wrenches.tobytes()


@pytest.mark.parametrize(
    "wrong",
    [
        {"rate": 0.0},
        {"rate": 2000.0},
        {"noise": np.full(6, -1.0)},
        {"bias": np.full(6, np.nan)},
        {"limit": np.full(5, 1.0)},
        {"crosstalk": np.eye(3)},
        {"warm_up": (1.0, 0.0)},
    ],
)
def test_a_sensor_that_cannot_be_is_refused(wrong: dict) -> None:
    with pytest.raises(InputError, match="sensor model"):
        SensorSettings(**wrong)


def test_an_unknown_preset_is_refused_with_those_there_are() -> None:
    with pytest.raises(InputError, match="ideal, paper, noisy"):
        preset("perfect")
