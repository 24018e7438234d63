from __future__ import annotations

import contextlib
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.devices.emulate import possible_faults
from contactbench.pipeline.devices.faults import (
    SYNTHETIC,
    EmulatorError,
    Fault,
    FaultEvent,
    Mangler,
    Script,
    Truth,
    constant,
    recorded,
    sine,
)
from contactbench.pipeline.devices.protocols.rdt import RdtModel
from contactbench.pipeline.devices.protocols.sri import SriModel, sri_frame


def test_events_are_read():
    assert FaultEvent.parse("stall@2+0.5") == FaultEvent(2.0, Fault.STALL, 0.5)
    assert FaultEvent.parse("wrong-rate@1+2x0.5") == FaultEvent(1.0, Fault.WRONG_RATE, 2.0, 0.5)
    assert FaultEvent.parse("clock-jump@0x-3").amount == -3
    assert FaultEvent.parse("drift@0+5").amount == 10


@pytest.mark.parametrize(
    "text", ["", "stall", "stall@", "rest@1+1", "stall@1+0", "stall@1.2.3", "wrong-rate@1+1x0"]
)
def test_wrong_events_are_refused(text: str):
    with pytest.raises(EmulatorError, match="fault"):
        FaultEvent.parse(text)


@given(st.text(max_size=30))
def test_any_text_is_an_event_or_an_error(text: str):
    with contextlib.suppress(EmulatorError):
        FaultEvent.parse(text)


def test_a_script_finds_what_goes_on():
    script = Script([(2.0, Fault.STALL, 0.5), FaultEvent(1.0, Fault.SPLIT, 2.0)])
    assert [event.fault for event in script.events] == [Fault.SPLIT, Fault.STALL]
    assert [event.fault for event in script.active(2.0)] == [Fault.SPLIT, Fault.STALL]
    assert not script.active(2.5, Fault.STALL)
    with pytest.raises(EmulatorError, match="not available for rdt"):
        Script([(0, Fault.HEADER, 1)]).check(possible_faults("rdt"), "rdt")


def test_signals():
    assert constant(SYNTHETIC)(3.0) == SYNTHETIC
    assert sine((1.0,) * 6, 0.5)(0.5)[0] == pytest.approx(1.0)
    steps = recorded([10.0, 11.0, 12.0], [[k] * 6 for k in (1.0, 2.0, 3.0)])
    assert [steps(t)[0] for t in (0.0, 1.5, 2.9, 3.0, -0.5)] == [1, 2, 3, 1, 3]
    with pytest.raises(EmulatorError, match="increasing"):
        recorded([0.0, 0.0], [[1.0] * 6] * 2)
    with pytest.raises(EmulatorError, match="six"):
        recorded([0.0, 1.0], [[1.0] * 5] * 2)


def truth(*events: FaultEvent) -> Truth:
    return Truth(lambda t: (t,) * 6, Script(events), SriModel.trap, SriModel.full_scale)


def test_faults_of_value():
    assert truth(FaultEvent(1, Fault.STUCK)).reading(1.7).values[0] == pytest.approx(1.0)
    assert truth(FaultEvent(1, Fault.REZERO)).reading(5.0).values[0] == pytest.approx(4.0)
    assert truth(FaultEvent(1, Fault.SATURATION)).reading(1.5).saturated
    assert not truth(FaultEvent(1, Fault.SATURATION)).reading(2.5).saturated
    warm = truth(FaultEvent(1, Fault.DRIFT, 2.0)).reading(2.0)
    assert warm.temperature == pytest.approx(30.0)
    assert warm.values[0] == pytest.approx(2.25)
    jumped = truth(FaultEvent(1, Fault.CLOCK_JUMP, 1, 7.0)).moment(3.0, 4)
    assert (jumped.number, jumped.clock, jumped.jump) == (4, 10.0, 7.0)
    assert truth(FaultEvent(1, Fault.WRONG_RATE, 1, 0.5)).rate_factor(1.5) == 0.5
    trap = truth(FaultEvent(1, Fault.HEADER)).reading(1.0).values
    assert b"\xaa\x55\x00\x1b" * 6 in sri_frame(trap, 0)
    assert all(map(math.isfinite, trap))


def mangler(fault: Fault, *, seed: int = 0, datagrams: bool = False) -> Mangler:
    model = RdtModel() if datagrams else SriModel()
    return Mangler(model, Script([(0.0, fault, 1.0)]), seed, datagrams=datagrams)


FRAME = sri_frame(SYNTHETIC, 5)


def test_faults_of_the_line():
    split = mangler(Fault.SPLIT).mangle(FRAME, 0.0, 0)
    assert len(split.pieces) > 1
    assert b"".join(split.pieces) == FRAME
    assert split.intact
    assert not mangler(Fault.SPLIT, datagrams=True).mangle(FRAME, 0.0, 0).intact

    merged = mangler(Fault.MERGED)
    assert [merged.mangle(FRAME, 0.0, k).pieces for k in range(3)] == [(), (), (FRAME * 3,)]
    assert merged.mangle(FRAME, 0.5, 3).pieces == ()
    assert merged.mangle(FRAME, 1.5, 4).pieces == (FRAME, FRAME)

    garbage, frame = mangler(Fault.GARBAGE).mangle(FRAME, 0.0, 0).pieces
    assert garbage
    assert frame == FRAME
    bad = mangler(Fault.BAD_CHECKSUM).mangle(FRAME, 0.0, 0)
    assert bad.pieces[0][:-1] == FRAME[:-1]
    assert not bad.intact
    stalled = mangler(Fault.STALL).mangle(FRAME, 0.0, 0)
    assert stalled.pieces == ()
    assert not stalled.intact

    broken = mangler(Fault.DISCONNECT)
    first, second = broken.mangle(FRAME, 0.0, 0), broken.mangle(FRAME, 0.1, 1)
    assert first.pieces == (FRAME[:15],)
    assert first.away is not None
    assert second.away is None
    assert mangler(Fault.RECONNECT).mangle(FRAME, 0.0, 0).pieces == ()


@pytest.mark.parametrize("fault", [Fault.SPLIT, Fault.GARBAGE])
def test_the_same_seed_gives_the_same_bytes(fault: Fault):
    def run(seed: int) -> list[tuple[bytes, ...]]:
        line = mangler(fault, seed=seed)
        return [line.mangle(FRAME, k / 100, k).pieces for k in range(50)]

    assert run(3) == run(3)
    assert run(3) != run(4)
