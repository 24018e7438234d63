"""The runtime, against the project's own filters and solver run one after the other."""

from typing import Any

import numpy as np
import pytest
from config.runtime.bundles import example
from kernel.runtime_cases import columns, stream, with_faults, with_surprises
from numpy.typing import NDArray
from scipy.signal import sosfilt, sosfilt_zi

from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime.values import kernel_arguments
from contactbench.pipeline.filtering import KalmanFilter

CONFIG = example(clamped=True)
FIXED = np.append(kernel_arguments(CONFIG)["kalman"][:5], np.zeros(6))  # the paper's filter
LOW_FORCE, STALE, NOT_FINITE, SATURATED, NOT_A_ROTATION = 3, 8, 9, 7, 10
SIGMA = np.array([0.05] * 3 + [0.002] * 3)  # of a reading, as CONFIG has it


def runtime(**changes: Any) -> kernel.Runtime:
    given = kernel_arguments(CONFIG)
    gates = {name: changes.pop(name) for name in given["gates"].keys() & changes.keys()}
    return kernel.Runtime(**{**given, **changes, "gates": {**given["gates"], **gates}})


class LowPass:
    """Of contact points; while there is none the last answer is held."""

    def __init__(self, sections: Any) -> None:
        self.sections = np.array(sections)
        self.reset()

    def reset(self) -> None:
        self.memory, self.last = None, np.full(3, np.nan)

    def update(self, point: NDArray[Any]) -> NDArray[Any]:
        if np.isfinite(point).all():
            memory = sosfilt_zi(self.sections)[:, :, None] * point if self.memory is None else self.memory
            (self.last,), self.memory = sosfilt(self.sections, point[None], axis=0, zi=memory)
        return self.last


class Reference:
    """What the runtime does, said with the project's other parts."""

    def __init__(self) -> None:
        a = kernel_arguments(CONFIG)
        rate, q, r, tuned, per_sample = FIXED[:5].tolist()
        self.kalman = KalmanFilter(rate, q=q, r=r, tuned_rate=tuned, per_sample=bool(per_sample))
        location = CONFIG.model.filters.location
        assert location is not None
        self.low_pass = LowPass(location.sections)
        self.limits, self.max_age = np.array(a["gates"]["saturation"]), a["gates"]["max_age"]
        beside = {"gravity_covariance", "orientation_sigma", "follow"}  # of the zero: no contact changes
        streams = {"R_ES", "pose_gap", "pose_ahead", "silence", "frozen_chance", "motion", *beside}
        solver = {k: v for k, v in a.items() if k not in {"gravity", "kalman", "sections", *streams}}
        self.solver = kernel.Solver(**{**solver, "gates": {**a["gates"], "saturation": (np.inf,) * 6}})
        self.last: float | None = None
        self.stale: list[float] = []

    def compensated(self, wrench: NDArray[Any], R: NDArray[Any]) -> NDArray[Any]:
        g = CONFIG.gravity
        weight = g.gravity_W[0] * R[0] + g.gravity_W[1] * R[1] + g.gravity_W[2] * R[2]
        L = g.centre_of_mass_S
        torque = np.array([L[i - 2] * weight[i - 1] - L[i - 1] * weight[i - 2] for i in range(3)])
        return wrench - np.concatenate([weight + g.force_bias, torque + g.torque_bias])

    def update(self, wrench: NDArray[Any], R: NDArray[Any], time: float) -> tuple[int, Any, Any, Any]:
        if not (np.isfinite(wrench).all() and np.isfinite(R).all()):
            return NOT_FINITE, None, None, None
        if self.last is not None and time <= self.last:
            self.stale = [*self.stale, time] if self.stale and time > self.stale[-1] else [time]
            if len(self.stale) <= 50 and time - self.stale[0] <= self.max_age:
                return STALE, None, None, None
            self.reset()
        if abs(R @ R.T - np.eye(3)).max() > 1e-3 or np.linalg.det(R) < 0:
            return NOT_A_ROTATION, None, None, None
        if self.last is not None and time - self.last > self.max_age:
            self.reset()
        dt = None if self.last is None else time - self.last
        self.last, self.stale = time, []
        if (abs(wrench) >= self.limits).any():
            filtered = self.kalman.update(np.full(6, np.nan), dt)
            self.solver.track(np.zeros(6), np.nan)
            return SATURATED, filtered, None, self.held()
        filtered = self.kalman.update(self.compensated(wrench, R), dt)
        contact = self.solver.track(filtered, 0.0, dt or 0.0)
        point = contact.point
        held = self.low_pass.update(point) if contact.accepted and point is not None else self.held()
        return int(contact.reason), filtered, contact, held

    def reset(self) -> None:
        self.kalman.reset(), self.low_pass.reset(), self.solver.reset()
        self.last, self.stale = None, []

    def held(self) -> NDArray[Any]:
        if self.solver.previous is None:
            self.low_pass.reset()
        return self.low_pass.update(np.full(3, np.nan))


def same(one: Any, other: Any) -> bool:
    """Whether two are equal to the bit, nothing and NaN included."""
    if one is None or other is None:
        return one is other
    return np.asarray(one, float).tobytes() == np.asarray(other, float).tobytes()


def test_agrees_with_filters_and_solver_one_after_the_other() -> None:
    readings, R, times = stream(CONFIG, 12_000)
    with_surprises(CONFIG, readings)
    with_faults(readings, R, times)
    live, reference = runtime(kalman=FIXED), Reference()
    reasons = set()
    for i in range(len(times)):
        told = live.update(readings[i], R[i], times[i])
        reason, filtered, contact, held = reference.update(readings[i], R[i], times[i])
        reasons.add(reason)
        assert told.reason == reason, i
        if filtered is None:
            assert told.wrench is None
            assert told.point is None
            continue
        assert told.wrench is not None
        assert told.wrench.tobytes() == filtered.tobytes(), i
        if contact is not None and contact.point is not None:
            assert told.point is not None
            assert told.point.tobytes() == contact.point.tobytes()
            if told.second is None:
                assert told.covariance is not None
                assert told.covariance.tobytes() == contact.covariance.tobytes()
            else:
                assert told.covariance is None
            assert (told.face, told.vertex, told.torque) == (contact.face, contact.vertex, contact.torque)
            others = sorted(contact.candidates, key=lambda each: each.delta)
            assert same(told.runner_up, others[0].point if others else None), i
        else:
            assert told.point is None
        if contact is not None:
            assert same(told.second, contact.second), i
            assert told.accepted == contact.accepted
            for name in ("misfit", "left_over", "arm", "confidence"):
                assert same(getattr(told, name), getattr(contact, name)), (i, name)
        else:
            assert not told.accepted
        # SciPy solves for the filter's first state by LU, the kernel in closed form: they differ by rounding.
        shown = np.full(3, np.nan) if told.filtered_point is None else told.filtered_point
        np.testing.assert_allclose(shown, held, rtol=0, atol=1e-12)
    assert {0, 2, 3, SATURATED, STALE, NOT_FINITE, NOT_A_ROTATION, 11, 12, 13} <= reasons


def test_compensation_is_that_of_the_gravity_model() -> None:
    readings, R, times = stream(CONFIG, 200)
    told = runtime(kalman=None).update_batch(readings, R, times).wrenches
    np.testing.assert_allclose(told, CONFIG.gravity.compensate(R, readings), rtol=0, atol=1e-12)


def test_a_batch_is_its_samples_one_by_one() -> None:
    readings, R, times = stream(CONFIG, 1_500)
    batch, single = runtime().update_batch(readings, R, times), runtime()
    for i, point in enumerate(batch.points):
        told = single.update(readings[i], R[i], times[i]).point
        assert np.array_equal(point, np.full(3, np.nan) if told is None else told, equal_nan=True)
    assert batch[-1].time == times[-1]
    assert len(batch) == len(times)


def test_samples_that_are_refused_leave_no_trace() -> None:
    readings, R, times = stream(CONFIG, 1_000)
    plain = runtime().update_batch(readings, R, times)
    disturbed = runtime()
    for i in range(len(times)):
        for bad in (
            (readings[i] * np.nan, R[i], times[i]),
            (readings[i], R[i], np.nan),
            (readings[i], R[i], np.inf),
            (readings[i], 1.001 * R[i], times[i]),
            (readings[i], -R[i], times[i]),
        ):
            assert disturbed.update(*bad).reason in {NOT_FINITE, NOT_A_ROTATION}
        told = disturbed.update(readings[i], R[i], times[i])
        assert told.reason == plain.reasons[i]
        assert told.wrench is not None
        assert told.wrench.tobytes() == plain.wrenches[i].tobytes()
        assert disturbed.update(readings[i], R[i], times[i]).reason == STALE


@pytest.mark.parametrize("how", ["gap", "reset"])
def test_after_a_gap_or_reset_the_next_sample_is_the_first(how: str) -> None:
    readings, R, times = stream(CONFIG, 1_200)
    live = runtime()
    live.update_batch(readings[:600], R[:600], times[:600])
    late = times[600:] + (1.0 if how == "gap" else -times[600])
    if how == "reset":
        live.reset()
    after = columns(live.update_batch(readings[600:], R[600:], late))
    fresh = columns(runtime().update_batch(readings[600:], R[600:], late))
    for name, values in fresh.items():
        assert values.tobytes() == after[name].tobytes(), name


@pytest.mark.parametrize("max_age", [0.02, 1e6])
def test_one_time_far_ahead_does_not_block_for_ever(max_age: float) -> None:
    readings, R, times = stream(CONFIG, 400)
    live = runtime(max_age=max_age)
    live.update_batch(readings[:200], R[:200], times[:200])
    live.update(readings[199], R[199], 1e5)
    after = live.update_batch(readings[200:], R[200:], times[200:])
    new = int(np.argmax(after.reasons != STALE))
    assert (after.reasons[:new] == STALE).all()
    assert STALE not in after.reasons[new:]
    assert new == (50 if max_age > 1 else int(np.argmax(times[200:] - times[200] > max_age)))
    fresh = runtime(max_age=max_age).update_batch(readings[200 + new :], R[200 + new :], times[200 + new :])
    assert fresh.wrenches.tobytes() == after.wrenches[new:].tobytes()


def test_times_that_only_jump_back_stay_stale() -> None:
    readings, R, times = stream(CONFIG, 200)
    live = runtime()
    live.update_batch(readings, R, times)
    for i in range(1, 150):
        assert live.update(readings[-i], R[-i], times[-i]).reason == STALE
    for _ in range(5):  # late ones, each followed by one in time
        assert live.update(readings[9], R[9], times[9]).reason == STALE


def test_the_location_is_held_for_a_moment_and_then_forgotten() -> None:
    readings, R, times = stream(CONFIG, 3_000)
    accepted = (batch := runtime().update_batch(readings, R, times)).accepted
    shown = ~np.isnan(batch.filtered_points[:, 0])
    recent = CONFIG.model.gates.recent_samples
    misses = recent + 1
    for i, good in enumerate(accepted):
        misses = 0 if good else misses + 1
        assert shown[i] == (misses <= recent), i
    assert not shown.all()


def test_arguments_without_sense_are_refused() -> None:
    with pytest.raises(ValueError, match="gravity model is not finite"):
        runtime(gravity=np.full(12, np.nan))
    with pytest.raises(ValueError, match="must be positive"):
        runtime(kalman=np.zeros(11))
    with pytest.raises(ValueError, match="a0 other than 1"):
        runtime(sections=np.zeros((1, 6)))
    with pytest.raises(ValueError, match="one row per sample"):
        runtime().update_batch(np.zeros((2, 6)), np.zeros((1, 3, 3)), np.zeros(2))


# ---- now, not a while ago ------------------------------------------------------------------------


def presses(rate: float, seed: int, noise: float, ramp: float) -> tuple[NDArray[Any], ...]:
    """Return readings, R_WS, times and forces (n,): twelve touches of 0.7 to 10 N for 0.3 s, with rests."""
    rng = np.random.default_rng(seed)
    probe, rest = CONFIG.probe, np.zeros((round(0.3 * rate), 6))
    up = np.clip((np.arange(len(rest)) + 1) / max(ramp * rate, 1), 0, 1)[:, None]
    rows = [rest]
    for facet in rng.choice(np.flatnonzero(probe.region == 1), 12):
        force = -rng.choice([0.7, rng.uniform(2.2, 10)]) * probe.normals[facet]
        torque = np.cross(probe.vertices[probe.faces[facet]].mean(axis=0), force)
        rows += [np.minimum(up, up[::-1]) * [*force, *torque], rest]
    true = np.concatenate(rows)
    R = np.tile(np.eye(3), (len(true), 1, 1))
    readings = true + CONFIG.gravity.predict(R) + rng.normal(0, noise * SIGMA, true.shape)
    return readings, R, np.arange(len(true)) / rate, np.linalg.norm(true[:, :3], axis=1)


def since(begins: NDArray[Any], times: NDArray[Any]) -> NDArray[Any]:
    """Return for how long it has been so, s (n,)."""
    return times - times[np.maximum.accumulate(np.where(begins, 0, np.arange(len(times))))]


def at(rate: float) -> kernel.Runtime:
    return kernel.Runtime(**kernel_arguments(example(clamped=True, rate=rate)))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("rate", "noise", "ramp"),
    [(100.0, 1, 0), (200.0, 1, 0), (1000.0, 1, 0), (200.0, 0.3, 0), (200.0, 2, 0), (200.0, 1, 0.06)],
)
def test_releases_and_touches_are_told_within_25_ms(
    rate: float, noise: float, ramp: float, seed: int
) -> None:
    readings, R, times, forces = presses(rate, seed, noise, ramp)
    told = at(rate).update_batch(readings, R, times)
    accepted = told.accepted.astype(bool)
    assert not accepted[(forces < 0.3) & (since(forces < 0.3, times) > 0.025)].any()
    pressed = (forces > 2) & (since(forces > 0.3, times) > 0.025)
    assert accepted[pressed].mean() >= 0.995
    following = KalmanFilter(rate, sigma=SIGMA).filter(CONFIG.gravity.compensate(R, readings), times)
    np.testing.assert_allclose(told.wrenches, following, rtol=0, atol=1e-9)


def test_an_odd_reading_moves_nothing_and_an_empty_one_ends_a_contact_for_itself_alone() -> None:
    readings, R, times, forces = presses(200.0, 0, 1, 0)
    held = np.flatnonzero(forces > 2)[40]
    plain = at(200.0).update_batch(readings, R, times).wrenches
    around = slice(held - 9, held + 9)
    assert forces[around].min() > 2
    readings[held] += [30, 30, 30, 1, 1, 1]
    odd = at(200.0).update_batch(readings, R, times)
    assert odd.accepted[around].all()
    assert abs(odd.wrenches - plain)[around].max() < 0.1
    readings[held] = CONFIG.gravity.predict(R[:1])[0]
    empty = at(200.0).update_batch(readings, R, times)
    assert np.flatnonzero(empty.reasons[around] == LOW_FORCE).tolist() == [9]


def test_a_point_is_less_sure_right_after_a_change() -> None:
    readings, R, times, forces = presses(200.0, 0, 1, 0)
    begin = int(np.argmax(forces > 2))
    covariances = at(200.0).update_batch(readings, R, times).covariances[[begin + 1, begin + 4, begin + 50]]
    sigmas = np.sqrt(np.trace(covariances, axis1=1, axis2=2))
    assert sigmas[0] > 1.2 * sigmas[1] > 1.3 * sigmas[2]
