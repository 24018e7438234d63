"""The colours of fields: zero is the surface itself, steps are even to the eye, and one wrong value takes none away."""

import numpy as np
import pytest

from contactbench.pipeline.colour_ramp import PLAIN, ColourScale, colour_ramp, end_of_colours
from contactbench.pipeline.mesh.colours import PLAIN as PLAIN_HEX


def oklab(srgb):
    """Return Oklab (n, 3) of sRGB (n, 3), as Ottosson (2020) defines it."""
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    cones = (
        linear
        @ np.array(
            [
                [0.4122214708, 0.5363325363, 0.0514459929],
                [0.2119034982, 0.6806995451, 0.1073969566],
                [0.0883024619, 0.2817188376, 0.6299787005],
            ]
        ).T
    )
    return (
        np.cbrt(cones)
        @ np.array(
            [
                [0.2104542553, 0.7936177850, -0.0040720468],
                [1.9779984951, -2.4285922050, 0.4505937099],
                [0.0259040371, 0.7827717662, -0.8086757660],
            ]
        ).T
    )


def test_zero_is_the_grey_of_the_surface():
    assert f"#{PLAIN:02x}{PLAIN:02x}{PLAIN:02x}" == PLAIN_HEX
    np.testing.assert_allclose(255 * colour_ramp()[0], PLAIN)


def test_steps_are_even_to_the_eye_and_it_only_grows_darker():
    lab = oklab(colour_ramp(52))
    steps = np.linalg.norm(np.diff(lab, axis=0), axis=1)
    assert (np.diff(lab[:, 0]) < 0).all()
    assert lab[0, 0] - lab[-1, 0] > 0.45
    assert steps.std() < 0.12 * steps.mean()


def test_values_have_their_colours_and_what_is_beyond_has_the_last():
    table = colour_ramp()
    found = ColourScale(4.0).colours(np.array([0.0, 2.0, 4.0, 9.0, np.nan]))
    np.testing.assert_allclose(found, table[[0, 128, 255, 255, 0]], atol=0.01)


@pytest.mark.parametrize("wrong", [1, 8])
def test_wrong_values_do_not_swallow_the_scale(wrong):
    rng = np.random.default_rng(3)
    values = np.concatenate([rng.uniform(0.1, 0.5, 100 - wrong), np.full(wrong, 20.0)])
    assert 0.4 < end_of_colours(values) < 2.0
    assert end_of_colours(values[: 100 - wrong]) == pytest.approx(0.5, abs=0.03)  # without them, all of it


def test_what_varies_over_decades_keeps_its_scale():
    density = np.exp(np.linspace(-9.0, 3.0, 1000))
    assert end_of_colours(density) == pytest.approx(np.percentile(density, 95.0))


def test_the_scale_of_what_is_alike_ends_at_it():
    assert end_of_colours(np.full(9, 3.0)) == 3.0
    assert end_of_colours(np.array([np.nan, 2.0])) == 2.0
    assert end_of_colours(np.full(3, np.nan)) == 0.0
