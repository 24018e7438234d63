"""Faults on the line from a sensor: each does what its name says, and nothing else."""

import math

import pytest
from benchmarks.faulty_line import FaultKind, FaultyLine, ScriptedFault

from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.errors import InputError

JUMP = (1.0, 2.0, 3.0, 0.1, 0.2, 0.3)


def carried(*faults, count=40):
    line = FaultyLine(faults)
    sent = [WrenchSample(k * 0.005, (float(k), 0.0, -7.0), (0.0, 0.0, 0.0), k) for k in range(count)]
    return sent, [line.carry(each) for each in sent]


def test_without_faults_everything_arrives():
    sent, came = carried()
    assert came == sent


def test_a_dropout_gives_nothing_while_it_lasts():
    sent, came = carried(ScriptedFault(FaultKind.DROPOUT, 0.05, 0.02))
    missing = [each.time for each, got in zip(sent, came, strict=True) if got is None]
    assert missing == pytest.approx([0.05, 0.055, 0.06, 0.065, 0.07])


def test_a_short_spike_is_one_reading():
    sent, came = carried(ScriptedFault(FaultKind.SPIKE, 0.052, 0.0, JUMP))
    changed = [k for k, (a, b) in enumerate(zip(sent, came, strict=True)) if a != b]
    assert changed == [11]
    assert came[11].force == pytest.approx((12.0, 2.0, -4.0))
    assert came[11].torque == pytest.approx((0.1, 0.2, 0.3))


def test_a_long_spike_is_over_when_its_time_is():
    sent, came = carried(ScriptedFault(FaultKind.SPIKE, 0.05, 0.01, JUMP))
    assert [k for k, (a, b) in enumerate(zip(sent, came, strict=True)) if a != b] == [10, 11, 12]


def test_a_stuck_sensor_repeats_its_last_reading_with_new_times():
    sent, came = carried(ScriptedFault(FaultKind.STUCK, 0.05, math.inf))
    assert all(each.force == sent[9].force for each in came[10:])
    assert [each.time for each in came] == [each.time for each in sent]


def test_a_bias_jump_stays():
    sent, came = carried(ScriptedFault(FaultKind.BIAS_JUMP, 0.05, math.inf, JUMP))
    assert came[:10] == sent[:10]
    assert all(b.force[1] - a.force[1] == 2.0 for a, b in zip(sent[10:], came[10:], strict=True))


def test_faults_add_up():
    _, came = carried(
        ScriptedFault(FaultKind.BIAS_JUMP, 0.0, math.inf, JUMP),
        ScriptedFault(FaultKind.DROPOUT, 0.1, math.inf),
    )
    assert came[5].force[1] == 2.0
    assert came[25] is None


@pytest.mark.parametrize(
    "wrong",
    [{"start": -1.0}, {"start": math.nan}, {"start": 0.0, "seconds": -1.0}, {"start": 0.0, "wrench": (1.0,)}],
)
def test_impossible_faults_are_refused(wrong):
    with pytest.raises(InputError, match="fault"):
        ScriptedFault(FaultKind.SPIKE, **wrong)
