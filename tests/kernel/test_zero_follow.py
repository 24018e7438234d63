"""A zero that follows, against zeros that are known, and against what must not become one."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from config.runtime.bundles import example
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime.values import kernel_arguments

RATE, NOISE = 100.0, np.repeat([0.04, 1e-3], 3)
LEAST_N = 0.5
TIP = np.array([0.0, 0.0, 0.1])


def at_tip(force: Any) -> NDArray[Any]:
    return np.concatenate([force, np.cross(TIP, force)])


class Bench:
    """A sensor whose zero drifts, and has a part that is drawn anew at every attitude."""

    def __init__(
        self, seed: int, cable: float = 0.0, offset: Any = 0.0, drift: Any = 0.0, touched: float = 1.0
    ) -> None:
        self.touched, self.force = (
            touched,
            np.zeros((0, 3)),
        )  # how much of a touch there is; what was taken off
        self.rng, self.zero = np.random.default_rng(seed), kernel.ZeroFollow(LEAST_N)
        self.cable = cable * np.repeat([1.0, 0.04], 3)
        self.offset, self.drift = np.broadcast_to(offset, 6), np.broadcast_to(drift, 6)
        self.time = 0.0
        self.turn()

    def turn(self, degrees: float = 60.0) -> None:
        axis = self.rng.normal(size=3)
        self.R = Rotation.from_rotvec(np.radians(degrees) * axis / np.linalg.norm(axis)).as_matrix()
        self.pull = self.cable * self.rng.normal(size=6)

    @property
    def off(self) -> NDArray[Any]:
        return np.asarray(self.offset + self.drift * self.time + self.pull)

    def hold(
        self, seconds: float, wrench: Any = 0.0, size: Callable[[NDArray[Any]], Any] = np.ones_like
    ) -> None:
        """Stand still; `wrench` acts on the probe, times `size` of the seconds since it began."""
        times = self.time + (1 + np.arange(round(seconds * RATE))) / RATE
        off = self.offset + self.drift * times[:, None] + self.pull
        acts = size(times - self.time)[:, None] * np.broadcast_to(wrench, 6)
        self.time = float(times[-1])
        w = off + self.touched * acts + NOISE * self.rng.standard_normal((len(times), 6))
        R = np.ascontiguousarray(np.repeat(self.R[None], len(times), axis=0))
        self.force = np.concatenate([self.force, self.zero.taken(w, R, times, LEAST_N)[:, :3]])

    @property
    def told(self) -> kernel.Zero:
        return self.zero.at(self.time)

    def work(self, touches: int) -> None:
        """Lift, touch with 5 N, and turn."""
        for _ in range(touches):
            self.turn()
            self.hold(0.5)
            self.hold(0.5, at_tip([0.0, 0.0, -5.0]))
            self.time += 1.5


@pytest.mark.parametrize("cable", [0.0, 0.008, 0.02, 0.08, 0.11])
def test_what_it_says_of_itself_is_right(cable: float) -> None:
    ratios = []
    for seed in range(20):
        bench = Bench(seed, cable, offset=np.repeat([0.05, 1e-3], 3), drift=np.repeat([2e-5, 1e-6], 3))
        bench.work(25)
        for _ in range(8):
            bench.turn()
            bench.hold(0.25 if seed % 2 else 0.5)
            assert bench.told.taken is not None
            assert bench.told.taken_sigma is not None
            ratios.append((bench.told.taken - bench.off) / bench.told.taken_sigma)
    assert 0.8 < np.sqrt(np.mean(np.square(ratios))) < 1.25


def test_a_good_zero_is_left_alone_and_a_bad_one_is_followed_at_once() -> None:
    good, bad = Bench(1), Bench(1, 0.08)
    for bench in (good, bad):
        bench.work(40)
        bench.turn()
        bench.hold(0.5)
    assert good.told.taken is not None
    assert bad.told.taken is not None
    assert np.abs(good.told.taken[:3]).max() < 0.006
    assert np.abs((bad.told.taken - bad.off)[:3]).max() < 0.03
    assert bad.told.follows == good.told.follows == "following"


def grows(bench: Bench) -> None:
    bench.hold(60.0, at_tip([0.0, 0.0, -2.0]), lambda t: t / 60.0)


def grows_while_it_turns(bench: Bench) -> None:
    for turn in range(30):
        bench.turn(20.0)
        bench.hold(2.0, at_tip([0.0, 0.0, -2.0]), lambda t, turn=turn: (2.0 * turn + t) / 60.0)


def rests(bench: Bench) -> None:
    force = bench.rng.uniform(0.1, 0.45)
    for _ in range(30):
        bench.turn(20.0)
        bench.hold(2.0, np.concatenate([[force, 0, 0], np.cross([0.0, 0.0, 0.03], [force, 0, 0])]))


def catches(bench: Bench) -> None:
    for _ in range(15):
        bench.turn(30.0)
        bench.hold(0.5)
        pull = bench.rng.uniform(0.2, 1.5) * bench.rng.normal(size=3)
        bench.hold(3.0, np.concatenate([pull, np.cross([0.0, 0.02, 0.06], pull)]))


def creeps(bench: Bench) -> None:
    for _ in range(5):
        bench.turn(20.0)
        bench.hold(12.0, at_tip([0.0, 0.0, -bench.rng.uniform(0.5, 1.5)]), lambda t: np.exp(-t / 8.0))


def never_lifts(bench: Bench) -> None:
    for _ in range(15):
        bench.turn(10.0)
        bench.hold(4.0, at_tip([0.0, 0.0, -bench.rng.uniform(0.3, 6.0)]))


@pytest.mark.parametrize("attack", [grows, grows_while_it_turns, rests, catches, creeps, never_lifts])
@pytest.mark.parametrize(("begun", "cable"), [(False, 0.0), (True, 0.0), (True, 0.015)])
def test_what_leans_on_the_probe_does_not_become_zero(
    attack: Callable[[Bench], None], begun: bool, cable: float
) -> None:
    wrong = 0.0
    for seed in range(10):
        with_it, without = (Bench(seed, cable, touched=share) for share in (1.0, 0.0))
        for bench in (with_it, without):
            if begun:
                touched, bench.touched = bench.touched, 1.0
                bench.work(20)
                bench.touched = touched
            attack(bench)
        wrong = max(wrong, float(np.linalg.norm(with_it.force - without.force, axis=1).max()))
    assert wrong <= 0.5 * LEAST_N


def test_it_says_that_it_has_stopped_and_goes_on_when_the_probe_is_free() -> None:
    bench = Bench(3)
    assert bench.told.follows == "waiting"
    bench.work(5)
    assert bench.told.follows == "following"
    assert bench.told.seen < 3
    bench.turn()
    bench.hold(5.0, at_tip([0.0, 0.0, -0.4]))
    assert bench.told.follows == "stopped"
    assert bench.told.seen > 5
    assert np.linalg.norm(bench.told.taken[:3]) < 0.5 * LEAST_N
    assert bench.told.taken_sigma[2] > 0.4 - 0.5 * LEAST_N  # what is beyond the limit
    bench.hold(0.5)
    assert bench.told.follows == "following"


def test_a_runtime_takes_it_off_only_where_the_bundle_says_so() -> None:
    arguments = kernel_arguments(example())
    R = np.ascontiguousarray(np.repeat(np.eye(3)[None], 2000, axis=0))
    times = np.arange(1, 2001) / 1000
    off = np.array([0.1, -0.05, 0.1, 0.002, 0.003, -0.001])
    load = example().gravity.predict(R) + off
    noise = np.random.default_rng(1).normal(0, [0.05] * 3 + [0.002] * 3, (2000, 6))
    push = np.zeros((2000, 6))
    push[1500:] = at_tip([0.0, 0.0, -5.0])
    with_it, without = (
        kernel.Runtime(**{**arguments, "follow": follow}).update_batch(load + noise + push, R, times)
        for follow in (True, False)
    )
    same = kernel.Runtime(**{**arguments, "follow": True})
    one = [same.update(*row) for row in zip(load + noise + push, R, times, strict=True)]
    assert not without.taken.any()
    assert with_it.taken[-1] == pytest.approx(off, abs=0.02)
    assert (with_it.wrenches[-1] - without.wrenches[-1])[:3] == pytest.approx(-off[:3], abs=0.02)
    assert one[-1].taken.tobytes() == with_it.taken[-1].tobytes()
    assert one[-1].raw == pytest.approx((load + noise + push)[-1])
    # What is not sure of it makes the contact less sure.
    sizes = [np.trace(b.covariances[-1]) * (b.wrenches[-1, :3] ** 2).sum() for b in (with_it, without)]
    assert sizes[0] > sizes[1]
    same.reset()
    assert same.zero().follows == "waiting"
    assert same.zero().taken is None
