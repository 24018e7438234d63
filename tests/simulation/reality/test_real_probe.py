"""The probe on the bench, beside the one that the program is told of."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.reality import MIXES, Reality
from contactbench.pipeline.simulation.reality import RealProbe
from contactbench.pipeline.simulation.scenes import TipPress
from contactbench.pipeline.simulation.virtual.bench import bundled
from contactbench.pipeline.simulation.virtual.markers import markers

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
    told = bundled(_NAME).probe.vertices
    moved = told @ real.T_said[:3, :3].T + real.T_said[:3, 3]
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
