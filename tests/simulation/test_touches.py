"""Simulated touches obey the model that the solvers assume."""

import numpy as np
import pytest
from slides import draw_slide

from contactbench import assets
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.simulation import add_noise, draw_touches


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
def test_touches_satisfy_the_contact_equation(name):
    touches = draw_touches(assets.surface(name), 500, np.random.default_rng(1), force=(2, 12), angle=(10, 40))
    force, torque = touches.wrenches[:, :3], touches.wrenches[:, 3:]
    left = np.cross(touches.points, force) + touches.torques[:, None] * touches.normals
    assert np.allclose(left, torque, atol=1e-15)
    size = np.linalg.norm(force, axis=1)
    assert size.min() >= 2
    assert size.max() <= 12
    cosine = -np.einsum("ij,ij->i", force, touches.normals) / size
    assert np.allclose(np.arccos(cosine), touches.angles)
    assert np.degrees(touches.angles).min() >= 10 - 1e-9
    assert np.degrees(touches.angles).max() <= 40 + 1e-9


def test_touches_can_be_kept_to_the_face():
    touches = draw_touches(assets.surface("linear"), 300, np.random.default_rng(2), above=0.1, facing=0.9)
    assert touches.points[:, 2].min() > 0.1
    assert touches.normals[:, 2].min() >= 0.9
    assert len(touches) == 300


def test_a_slide_stays_on_the_surface_and_moves_little_between_samples():
    surface = assets.surface("t-shape")
    slide = draw_slide(surface, 4_000, np.random.default_rng(3))
    foot, _, distance = surface.project(slide.points[::40])
    assert np.abs(distance).max() < 1e-6
    assert foot.shape == (100, 3)
    assert np.percentile(np.linalg.norm(np.diff(slide.points, axis=0), axis=1), 99) < 1e-3
    assert np.any(np.all(slide.wrenches == 0, axis=1))


def test_noise_has_the_covariance_it_was_given():
    noise = WrenchNoise(force=(0.1, 0.2, 0.0), torque=0.01)
    sampled = np.cov(add_noise(np.zeros((200_000, 6)), noise, np.random.default_rng(4)).T)
    assert np.allclose(np.diag(sampled), np.diag(noise.covariance), rtol=0.02, atol=1e-12)


def test_same_seed_same_bytes():
    first, second = (
        draw_slide(assets.surface("convex"), 500, np.random.default_rng(5)).wrenches.tobytes()
        for _ in range(2)
    )
    assert first == second
