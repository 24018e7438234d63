"""Every reason has its line in the table of `contactbench.pipeline.control.intake`."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from control.closed_loop import gravity

from contactbench.pipeline.contact import Gates, WrenchNoise
from contactbench.pipeline.control import intake as table
from contactbench.pipeline.control.intake import (
    HEED,
    NEAR_M,
    NEAR_S,
    Heed,
    SampleIntake,
    SensingFault,
    SurePlace,
    heed,
)
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.simulation.marker_touches import model_of


@dataclass
class Told:
    reason: Reason
    accepted: bool = False
    point: np.ndarray | None = field(default_factory=lambda: np.array([0.01, 0.0, 0.1]))
    second: np.ndarray | None = None


def test_every_reason_is_in_the_table_and_in_its_words():
    assert set(HEED) == set(Reason.__members__.values())
    for reason in HEED:
        assert reason.name.lower() in table.__doc__


@pytest.mark.parametrize("reason", [Reason.OK, Reason.VERTEX, Reason.BY_REGION])
def test_what_the_gates_accept_is_turned_by(reason):
    told = Told(reason, accepted=True)
    assert heed(told) is Heed.TURN
    assert SurePlace().take(told, 0.0) is told.point


def test_an_ambiguous_one_is_turned_by_where_it_goes_on_from_the_last_sure_place():
    sure = SurePlace()
    assert sure.take(Told(Reason.AMBIGUOUS), 0.0) is None, "nothing was sure yet"
    sure.take(Told(Reason.OK, accepted=True), 1.0)
    near = Told(Reason.AMBIGUOUS, point=np.array([0.015, 0.0, 0.1]), second=np.array([0.2, 0.0, 0.0]))
    assert sure.take(near, 1.1) is near.point
    other = Told(Reason.AMBIGUOUS, point=np.array([0.2, 0.0, 0.0]), second=np.array([0.016, 0.0, 0.1]))
    assert sure.take(other, 1.2) is other.second, "the second place, where the likeliest is elsewhere"
    far = Told(Reason.BY_REGION, point=np.array([0.016 + 1.1 * NEAR_M, 0.0, 0.1]))
    assert sure.take(far, 1.3) is None
    assert sure.take(other, 1.0 + 1.1 * NEAR_S) is None, "what was sure is too long ago"


@pytest.mark.parametrize("reason", [r for r, what in HEED.items() if what is Heed.KEEP])
def test_others_keep_the_force_without_a_place(reason):
    sure = SurePlace()
    sure.take(Told(Reason.OK, accepted=True), 1.0)
    assert sure.take(Told(reason), 1.02) is None


@pytest.mark.parametrize(
    ("reason", "fault"),
    [
        *((r, SensingFault.UNHEALTHY) for r, what in HEED.items() if what is Heed.HOLD),
        (Reason.SATURATED, SensingFault.SATURATED),
        (Reason.TWO_TOUCHES, None),
        (Reason.OK, None),
    ],
)
def test_readings_that_a_method_does_not_believe_are_a_fault(reason, fault):
    intake = SampleIntake(model_of("t-shape", 1000), gravity(), WrenchNoise(), Gates())

    class Method:
        @staticmethod
        def locate(_):
            return Told(reason, accepted=reason is Reason.OK)

    intake._method = Method
    sensed = intake.take(0.02, [WrenchSample(0.01, (0.0, 0.0, -7.0), (0.0, 0.0, 0.0))], np.eye(3))
    assert sensed.fault is fault
    assert sensed.fresh is (fault is None)
    assert sensed.reason is reason
    assert (sensed.point is None) is (reason is not Reason.OK)
