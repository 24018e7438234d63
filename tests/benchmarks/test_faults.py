"""Short version of the study of faults on live lines."""

import dataclasses

import pytest
from benchmarks.faults import LINES, Outcome, cases, compare, run

from contactbench.pipeline.devices.emulate import possible_faults
from contactbench.pipeline.devices.faults import Fault

pytestmark = pytest.mark.alone  # it judges how soon things happen


def test_one_fault_of_each_kind_on_two_live_lines():
    said = []
    report = run(short=True, trials=25, seed=3, progress=said.append)
    assert report.passed, report.markdown()
    made_up = [figure for figure in report.figures if figure.name.startswith("made up")]
    assert [figure.measured for figure in made_up] == [0, 0]
    assert said


def test_all_faults_of_all_devices_are_played():
    played = list(cases())
    assert len(played) == sum(len(possible_faults(line.protocol)) for line in LINES)
    assert {fault for _, fault in played} == set(Fault)


def outcome(**more):
    fields = {
        "line": LINES[0],
        "fault": Fault.STALL,
        "expected": "shown",
        "detected": 0.13,
        "shown": "silent: a | b",
    }
    return Outcome(**{**fields, "flowing": 0.0, "well": 0.1, "samples": 9, "made_up": 0, "lost": 0, **more})


def test_an_outcome_is_judged():
    assert outcome().good
    assert not outcome(detected=None).good
    assert not outcome(detected=0.21).good
    assert not outcome(made_up=1).good
    assert not outcome(well=None).good
    unseen = outcome(expected="unseen", detected=None)
    assert unseen.good
    assert not dataclasses.replace(unseen, lost=1).good
    assert not dataclasses.replace(unseen, detected=0.1).good


def test_a_sample_that_was_never_sent_is_counted():
    from contactbench.pipeline.devices.emulate import Sent
    from contactbench.pipeline.devices.faults import FrameMoment, SensorReading
    from contactbench.pipeline.devices.protocols.registry import driver_for
    from contactbench.pipeline.devices.protocols.sri import sri_frame
    from contactbench.pipeline.devices.url import DeviceAddress

    address = DeviceAddress.parse("sri+tcp://h")
    frames = [sri_frame((float(k), 0, 0, 0, 0, 0), k) for k in range(4)]
    sent = [
        Sent(k, 0.0, 0.0, SensorReading((float(k), 0, 0, 0, 0, 0)), FrameMoment(k, 0.0), frame, True, None)
        for k, frame in enumerate(frames)
    ]
    given = driver_for(address).parser.feed(b"".join(frames), 0.0)
    assert compare(given, sent, address) == (0, 0)
    assert compare([given[0], given[3]], sent, address) == (0, 2)
    forged = dataclasses.replace(given[1], force=(1.5, 0.0, 0.0))
    assert compare([given[0], forged, given[2]], sent, address) == (1, 1)
