"""Ranks, conditions and words against the equations they summarise."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from weighing_files import draw_noise

from contactbench.pipeline.calibration import PoseNoise, calibrate
from contactbench.pipeline.calibration.model import cross_matrix
from contactbench.pipeline.calibration.observability import WEAK, observe
from contactbench.pipeline.simulation.loads import draw_load, weigh

DOWN = np.array([0.0, 0.0, -1.0])


def turns(*rotvecs: tuple[float, float, float]) -> np.ndarray:
    """R_WS, by rotation vectors in degrees."""
    return Rotation.from_rotvec(np.array(rotvecs, dtype=float), degrees=True).as_matrix()


def seen(R_WS: np.ndarray, gravity_W: np.ndarray = DOWN, **more):
    return observe(R_WS.swapaxes(1, 2), gravity_W, **more)


def directly(R_WS: np.ndarray) -> tuple[int, float, int, float]:
    """Rank and condition of [R | 1] and of [-[R g]x | 1], stacked, for a load of 1 N."""
    answers = []
    R_SW = R_WS.swapaxes(1, 2)
    for blocks in (R_SW, -cross_matrix(R_SW @ DOWN)):
        rows = np.concatenate([blocks, np.broadcast_to(np.eye(3), blocks.shape)], axis=2).reshape(-1, 6)
        values = np.linalg.svd(rows / np.sqrt(len(R_WS)), compute_uv=False)
        rank = int((values > 2e-3).sum())
        answers += [rank, values[0] / values[-1] if rank == 6 else np.inf]
    return tuple(answers)


FACES = turns((0, 0, 0), (180, 0, 0), (90, 0, 0), (-90, 0, 0), (0, 90, 0), (0, -90, 0))
REFERENCE = {
    "two poses": (turns((0, 0, 0), (50, 20, 0)), 5, 5, np.inf, np.inf),
    "four tilted about one axis": (turns((0, 0, 0), (30, 0, 0), (60, 0, 0), (90, 0, 0)), 5, 6, np.inf, None),
    "four spun about the vertical": (
        turns((0, 0, 0), (0, 0, 90), (0, 0, 180), (0, 0, -90)),
        5,
        3,
        np.inf,
        np.inf,
    ),
    "three poses": (turns((0, 0, 0), (90, 0, 0), (0, 90, 0)), 6, 6, 3.6, 2.5),
    "six faces": (FACES, 6, 6, 2.2, 1.2),
    "one pose four times": (turns(*[(20, 30, 40)] * 4), 3, 3, np.inf, np.inf),
}


@pytest.mark.parametrize("name", REFERENCE)
def test_reference_sets(name):
    R_WS, force_rank, torque_rank, force_condition, torque_condition = REFERENCE[name]
    sight = seen(R_WS)
    assert (sight.force_rank, sight.torque_rank) == (force_rank, torque_rank)
    assert sight.rank == force_rank + torque_rank
    assert sight.force_condition == pytest.approx(force_condition, abs=0.05)
    if torque_condition is not None:
        assert sight.torque_condition == pytest.approx(torque_condition, abs=0.05)
    assert sight.condition == max(sight.force_condition, sight.torque_condition)
    assert bool(sight.null_directions) == (sight.rank < 12)


def test_four_poses_within_ten_degrees_are_weak():
    conditions = []
    for seed in range(25):
        rng = np.random.default_rng(seed)
        sight = seen(turns(*rng.uniform(-10, 10, (4, 3))) @ Rotation.random(None, rng).as_matrix())
        assert (sight.force_rank, sight.torque_rank) == (6, 6)
        assert sight.condition > WEAK
        assert "of one another" in sight.weak
        conditions.append(sight.condition)
    # It depends on the draw: 16 is the best there can be, the usual one is some 40.
    assert 16 < np.min(conditions) < 27 < np.median(conditions) < 60
    corners = seen(turns((10, 0, 0), (-10, 0, 0), (0, 10, 0), (0, -10, 0)))
    assert corners.condition == pytest.approx(16.2, abs=0.05)


@given(st.integers(0, 10_000), st.integers(2, 12), st.floats(0.05, 3))
@settings(max_examples=50, deadline=None)
def test_ranks_and_conditions_are_those_of_the_stacked_equations(seed, count, spread):
    rng = np.random.default_rng(seed)
    axes = spread * rng.standard_normal((count, 3))
    R_WS = (Rotation.from_rotvec(axes) * Rotation.random(None, rng)).as_matrix()
    sight = seen(R_WS)
    expected = directly(R_WS)
    found = (sight.force_rank, sight.force_condition, sight.torque_rank, sight.torque_condition)
    assert found == pytest.approx(expected, rel=1e-6)


@given(st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_frames_loads_and_repetitions_do_not_matter(seed):
    rng = np.random.default_rng(seed)
    R_WS = Rotation.random(5, rng).as_matrix()
    turned = Rotation.random(None, rng).as_matrix()
    sight = seen(R_WS)
    for other in (
        seen(R_WS @ turned),
        seen(turned @ R_WS, turned @ DOWN),
        seen(R_WS, 1e-3 * DOWN),
        seen(np.tile(R_WS, (40, 1, 1))),
        seen(R_WS[::-1]),
    ):
        assert (other.force_rank, other.torque_rank) == (sight.force_rank, sight.torque_rank)
        assert other.force_condition == pytest.approx(sight.force_condition, rel=1e-6)
        assert other.torque_condition == pytest.approx(sight.torque_condition, rel=1e-6)


# ---- words -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("R_WS", "words"),
    [
        (turns((0, 0, 0), (0, 0, 90), (0, 0, 200)), "same tilt"),
        (turns((0, 0, 0), (0, 0, 90), (0, 0, 200)) @ turns((40, 20, 0))[0], "same tilt"),
        (turns((0, 0, 0), (60, 0, 0), (120, 0, 0)), r"one horizontal axis \(bearing 0°"),
        (turns((0, 0, 0), (0, 60, 0), (0, -120, 0)), r"one horizontal axis \(bearing 90°"),
        (turns((0, 0, 0), (-60, 60, 0), (-99, 99, 0)), r"one horizontal axis \(bearing 135°"),
        (turns((0, 0, 0), (60, 0, 60), (99, 0, 99)), r"one axis \(-?0\.71, -?0\.00, -?0\.71 in the world\)"),
        (turns(*[(0, 40, 0)] * 5), "same orientation"),
    ],
)
def test_words_for_forces_name_the_axis(R_WS, words):
    first, *_ = seen(R_WS).null_directions
    assert re.search(words, first)


def test_poses_that_wobble_are_as_alike_as_the_sensor_can_tell():
    wobble = turns((0.02, 0, 0), (0, 0.03, 0), (-0.03, 0, 0))
    sight = seen(wobble @ turns((0, 0, 0), (0, 0, 90), (0, 0, 200)))
    assert sight.force_rank == 5
    assert "same tilt" in sight.null_directions[0]


def test_words_for_torques():
    assert "same direction in the sensor" in " ".join(
        seen(REFERENCE["four spun about the vertical"][0]).null_directions
    )
    assert "only two directions" in " ".join(seen(turns((0, 0, 0), (80, 0, 0))).null_directions)


def test_a_load_that_is_not_felt_shows_no_centre_of_mass():
    sight = seen(FACES, weighs=False)
    assert (sight.rank, sight.torque_rank) == (9, 3)
    assert not sight.weighs
    assert any("feels no weight" in words for words in sight.null_directions)


@pytest.mark.parametrize("angle", [1.5, 4.5, 17.2, 28.7])
def test_poses_too_much_alike_are_told_how_much(angle):
    half = angle / 2
    sight = seen(turns((half, 0, 0), (-half, 0, 0), (0, half, 0), (0, 0, half / 2)))
    assert f"within about {np.ceil(angle):.0f}° of one another" in " ".join(
        [sight.weak, *sight.null_directions]
    )


def test_poses_well_apart_are_not_called_alike():
    assert seen(FACES).weak == ""
    # Nearly one axis: badly determined, but not for being alike.
    nearly = seen(turns((0, 0, 0), (40, 0, 0), (80, 0, 0), (120, 2, 0)))
    assert nearly.condition > WEAK
    assert nearly.weak == ""


def test_weak_poses_without_full_rank_are_undetermined():
    sight = seen(turns((0, 0, 0), (5, 0, 0), (10, 0, 0)))
    assert sight.rank < 12
    assert sight.weak == ""
    assert "of one another" in sight.null_directions[0]


# ---- as a calibration sees it ------------------------------------------------------------------


def test_spun_poses_hide_the_centre_of_mass_from_a_calibration():
    rng = np.random.default_rng(1)
    spun = Rotation.from_rotvec(np.outer(np.linspace(0, 5, 8), [0, 0, 1.0])) * Rotation.from_rotvec(
        [0.5, 0.2, 0]
    )
    noise = PoseNoise(0.05, 0.002)
    sight = calibrate(weigh(draw_load(rng, (1, 1)), spun.as_matrix(), noise, rng).poses, noise).observability
    assert (sight.force_rank, sight.torque_rank) == (5, 3)
    assert any("centre of mass" in words for words in sight.null_directions)


@pytest.mark.parametrize("tilt", [0.3, 0.7])
def test_a_weight_hidden_by_the_poses_is_not_called_none(tilt):
    """A hand that turns a probe about the vertical tilts it by some tenths of a degree."""
    silent = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        spins = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, 8), [0, 0, 1.0]))
        wobble = Rotation.from_rotvec(np.radians(tilt) * rng.standard_normal((8, 3)))
        noise = draw_noise(rng)
        calibration = calibrate(
            weigh(draw_load(rng, (0.5, 2)), (spins * wobble).as_matrix(), noise, rng).poses, noise
        )
        silent += "feels no weight" in " ".join(calibration.verdict.reasons)
    assert silent == 0
