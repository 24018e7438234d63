"""Settings of a controller go into a bundle and come back as they were."""

import dataclasses

import pytest

from contactbench.pipeline.config.runtime.model import LimitsPart
from contactbench.pipeline.control.settings import (
    ControlSettings,
    Variant,
    controller_of,
    limits_of,
    settings_of,
)
from contactbench.pipeline.errors import InputError

LIMITS = LimitsPart(max_force_N=20.0, max_torque_Nm=2.0, max_speed_mps=None, max_turn_radps=0.5)
_WHOLE = {"attempts": 7, "variant": Variant.PLAIN}


def other(name, value):
    """Return a value that is none of the defaults, and may stand."""
    if name in _WHOLE:
        return _WHOLE[name]
    if isinstance(value, tuple):
        return tuple(1.01 * each + 0.001 * index for index, each in enumerate(value, 1))
    return 1.01 * value + 0.001


def test_every_setting_goes_through_a_bundle():
    settings = ControlSettings(
        **{each.name: other(each.name, each.default) for each in dataclasses.fields(ControlSettings)}
    )
    assert settings_of(controller_of(settings), limits_of(settings)) == settings


def test_a_bundles_limits_always_count():
    bare = settings_of(None, LIMITS)
    assert (bare.max_force, bare.max_torque, bare.max_turn) == (20.0, 2.0, 0.5)
    assert bare == dataclasses.replace(ControlSettings(), max_force=20.0, max_torque=2.0, max_turn=0.5)
    base = ControlSettings(max_speed=0.07, period=0.01)
    told = settings_of(controller_of(ControlSettings(desired_force=4.0)), LIMITS, base)
    assert (told.desired_force, told.max_speed, told.period) == (4.0, 0.07, 0.02)
    # Together, not one after the other: the force of the base would be too large for these limits.
    low = LIMITS.model_copy(update={"max_force_N": 6.0})
    assert settings_of(controller_of(ControlSettings(desired_force=4.0)), low).max_force == 6.0


def test_what_contradicts_is_refused():
    with pytest.raises(InputError, match="below 80 % of the limit of 20 N"):
        settings_of(controller_of(ControlSettings(desired_force=17.0)), LIMITS)
