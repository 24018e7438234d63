"""A sensor that is known exactly: every fault it has is one that was asked for."""

from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import Reality
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


# ---- what elements remember ----------------------------------------------------------------------


def _cycle() -> np.ndarray:
    up = np.linspace(0.0, 100.0, 200)
    return np.concatenate([up, up[::-1]])[:, None] * np.array([1.0, 0, 0, 0, 0, 0])


def test_a_loop_is_as_wide_as_the_data_sheet_says() -> None:
    settings = SensorSettings(hysteresis=np.array([0.6, 0, 0, 0, 0, 0]))
    x = _cycle()
    read = SensorModel(settings).read(np.arange(len(x)) / 200, x).wrenches[:, 0]
    assert read[200 + 99] - read[100] == pytest.approx(0.6)
    assert abs(read - x[:, 0]).max() == pytest.approx(0.3)


def test_a_loop_of_the_load_grows_with_it() -> None:
    settings = SensorSettings(hysteresis_of_load=0.01)
    x = _cycle()
    for times in (1.0, 2.0):
        read = SensorModel(settings).read(np.arange(len(x)) / 200, times * x).wrenches[:, 0]
        assert read[-100] - times * x[-100, 0] == pytest.approx(0.5 * times)


def test_creep_comes_to_63_percent_in_a_minute() -> None:
    times = np.arange(0, 601, 1.0)
    x = np.tile([10.0, 0, 0, 0, 0, 0], (len(times), 1))
    read = SensorModel(SensorSettings(creep=0.01)).read(times, x).wrenches[:, 0] - 10.0
    assert read[60] == pytest.approx(0.1 * (1 - np.exp(-1)), rel=1e-9)
    assert read[-1] == pytest.approx(0.1, rel=1e-3)


def test_how_many_are_read_together_changes_no_bit_of_what_it_remembers() -> None:
    settings = replace(preset("paper"), hysteresis=np.full(6, 0.1), hysteresis_of_load=0.002, creep=0.01)
    times, x = np.arange(60) / 200, np.random.default_rng(0).normal(size=(60, 6))
    whole = SensorModel(settings, 3).read(times, x).wrenches
    model = SensorModel(settings, 3)
    parts = [model.read(times[k : k + 7], x[k : k + 7]).wrenches for k in range(0, 60, 7)]
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_a_rezero_takes_what_it_remembers_with_it() -> None:
    model = SensorModel(SensorSettings(hysteresis=np.full(6, 0.2), creep=0.02))
    x = np.tile(np.arange(6.0), (200, 1))
    model.read(np.arange(200.0), x)
    model.rezero(x[0], 199.0)
    np.testing.assert_allclose(model.read(199.0, x[:1]).wrenches, 0.0, atol=1e-12)


def test_what_a_real_bench_adds_is_the_sensors_share_of_it() -> None:
    rng = np.random.default_rng(0)
    same = preset("paper").with_(Reality(cable=1.0), rng)
    np.testing.assert_array_equal(same.crosstalk, np.eye(6))
    assert not same.hysteresis.any()
    real = preset("paper").with_(
        Reality(hysteresis=0.05, hysteresis_of_load=0.1, creep=0.2, crosstalk=1.0), rng
    )
    np.testing.assert_allclose(real.hysteresis, [0.15, 0.15, 0.15, 0.006, 0.006, 0.006])
    assert (real.hysteresis_of_load, real.creep) == pytest.approx((0.001, 0.002))
    off = np.abs(real.crosstalk - np.eye(6)) * np.outer([1, 1, 1, 20, 20, 20], [1, 1, 1, 0.05, 0.05, 0.05])
    assert 0.004 < off.max() <= 0.01
    np.testing.assert_array_equal(np.diag(real.crosstalk), np.ones(6))
