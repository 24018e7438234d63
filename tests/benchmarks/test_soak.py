"""Short runs of the trials of protocols and sessions."""

import json

import pytest
from benchmarks import session_crash
from benchmarks.soak import PROTOCOLS, SUBJECTS, damage, soak

from contactbench.pipeline.devices.protocols import ProtocolError

# A damaged number is seen only where there is a checksum.
_WITHOUT_CHECKSUM = {"kunwei", "line", "line-json"}
_CHECKED = [name for name, subject in SUBJECTS.items() if subject.false_bits is not None]


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_random_bytes_raise_nothing(protocol: str) -> None:
    false_frames, _ = soak(protocol, 300_000, seed=3)
    if protocol in _CHECKED:
        assert false_frames == 0


@pytest.mark.parametrize("protocol", _CHECKED)
def test_one_percent_of_damage_costs_hardly_an_intact_frame(protocol: str) -> None:
    report = damage(protocol, 4000, seed=5)
    assert report.intact > 1500
    # A line whose end is damaged takes the next one with it.
    assert report.recovered >= (0.98 if SUBJECTS[protocol].lines else 0.99) * report.intact
    if protocol in _WITHOUT_CHECKSUM:
        return
    # One byte holds the weakest checksum: one damaged frame in 256 at most passes it.
    assert report.false_frames <= (report.frames - report.intact) / 256 + 3


@pytest.mark.parametrize("protocol", SUBJECTS)
def test_an_undamaged_stream_comes_out_whole(protocol: str) -> None:
    report = damage(protocol, 1000, seed=7, share=0.0)
    assert (report.intact, report.recovered, report.false_frames) == (1000, 1000, 0)


def test_a_trial_repeats_by_its_seed() -> None:
    first, again, other = (damage("sri", 300, seed=seed) for seed in (1, 1, 2))
    assert first.intact == again.intact
    assert first.recovered == again.recovered
    assert first.intact != other.intact


def test_an_unknown_protocol_is_refused() -> None:
    with pytest.raises(ProtocolError, match="there is no protocol 'x'"):
        soak("x", 1, 0)
    with pytest.raises(ProtocolError, match="there is no sensor protocol 'elfin'"):
        damage("elfin", 1, 0)


def test_the_command_prints_one_object(benchmark) -> None:
    result = benchmark("protocols", "--count", 20000, "--frames", 200, "--json")
    assert result.exit_code == 0, result.stderr
    assert {figure["subject"] for figure in json.loads(result.stdout)["figures"]} == set(PROTOCOLS)


def test_a_killed_writer_loses_nothing() -> None:
    report = session_crash.run(3, seed=2)
    assert report.passed
    assert report.figures[0].measured > 0
