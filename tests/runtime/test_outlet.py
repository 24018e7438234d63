import json
import os
import socket
import threading
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from config.runtime.bundles import example
from mcap.reader import make_reader
from runtime.runtime_recordings import ABOUT, BEGIN, CONTEXT, REMOTE

from contactbench.pipeline.runtime import Answer, Outlet, OutputError, RunError, make_runtime
from contactbench.pipeline.runtime.targets import LineTarget, McapTarget, UdpTarget


class Slow:
    """A target that takes nothing until it is let."""

    name, pace, trouble, fresh = "slow", 0.0, "", np.inf

    def __init__(self) -> None:
        self.open = threading.Event()
        self.got: list[float] = []
        self.closed = False

    def write(self, answers: Sequence[Answer]) -> int:
        assert self.open.wait(10)
        self.got += [answer.time for answer in answers]
        return len(answers)

    def flush(self) -> None: ...

    def close(self) -> None:
        self.closed = True


def answers_at(times: Sequence[float]) -> list[Answer]:
    runtime = make_runtime(example())  # nothing of the kernel may outlive the test
    contacts = [runtime.locate(np.zeros(6), time) for time in times]
    return [Answer(contact, contact.latency, runtime.zero()) for contact in contacts]


def answers(count: int, begin: float = BEGIN) -> list[Answer]:
    return answers_at([begin + 0.001 * i for i in range(count)])


class TestOutlet:
    def test_order_and_count(self) -> None:
        target = Slow()
        target.open.set()
        outlet = Outlet(target)
        outlet.start()
        given = answers(2_000)
        for answer in given:
            outlet.put(answer)
        outlet.close()
        assert target.got == [answer.time for answer in given]
        assert (outlet.published, outlet.lost, outlet.error, target.closed) == (2_000, 0, None, True)

    def test_a_slow_target_drops_and_counts_and_keeps_nobody_waiting(self) -> None:
        target = Slow()
        outlet = Outlet(target, most_waiting=100)
        outlet.start()
        for answer in answers(1_000):
            outlet.put(answer)  # would hang here if it waited
        target.open.set()
        outlet.close()
        assert outlet.published == len(target.got)
        assert outlet.published + outlet.lost == 1_000
        assert outlet.lost > 300
        assert target.got == sorted(target.got)

    def test_the_oldest_are_dropped_and_what_is_too_old_is_left_out(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        now = [0.0]
        monkeypatch.setattr("contactbench.pipeline.runtime.outlet.time.monotonic", lambda: now[0])
        for fresh, published in ((np.inf, 100), (0.495, 50)):
            target = Slow()
            target.fresh = fresh
            target.open.set()
            outlet = Outlet(target, most_waiting=100)
            given = answers(1_000)
            for i, answer in enumerate(given):
                now[0] = 0.01 * i
                outlet.put(answer)
            outlet.start()
            outlet.close()
            assert target.got == [answer.time for answer in given[-published:]]
            assert (outlet.published, outlet.lost) == (published, 1_000 - published)

    def test_a_patient_source_waits_and_loses_nothing(self) -> None:
        target = Slow()
        outlet = Outlet(target, patient=True, most_waiting=10)
        outlet.start()
        threading.Timer(0.05, target.open.set).start()
        for answer in answers(500):
            outlet.put(answer)
        outlet.close()
        assert (outlet.published, outlet.lost) == (500, 0)

    def test_a_target_that_hangs_is_left_behind(self) -> None:
        target = Slow()
        outlet = Outlet(target)
        outlet.start()
        for answer in answers(600):
            outlet.put(answer)
        outlet.close(patience=0.05)
        assert outlet.published == 0
        assert outlet.lost > 0
        target.open.set()

    def test_a_patient_source_does_not_wait_for_what_has_failed(self, tmp_path: Path) -> None:
        target = LineTarget("gone", os.open(tmp_path / "f", os.O_RDONLY | os.O_CREAT))
        outlet = Outlet(target, patient=True, most_waiting=5)
        outlet.start()
        for answer in answers(100):
            outlet.put(answer)
        outlet.close()
        assert outlet.failed.is_set()
        assert isinstance(outlet.error, OutputError)
        assert "gone: it cannot be written" in str(outlet.error)
        assert not outlet.gone
        assert outlet.lost == 100

    def test_one_that_published_nothing_has_failed(self) -> None:
        class Deaf(Slow):
            def write(self, answers: Sequence[Answer]) -> int:
                return sum(answer.time > BEGIN for answer in answers)

        for count, failed in ((1, True), (2, False), (0, False)):
            outlet = Outlet(Deaf())
            outlet.start()
            for answer in answers(count):
                outlet.put(answer)
            outlet.close()
            assert outlet.failed.is_set() == failed
            assert ("slow: no contact was published" in outlet.trouble) == failed

    def test_never_started(self) -> None:
        target = Slow()
        Outlet(target).close()
        assert target.closed


class TestLines:
    def test_a_closed_pipe_is_told_apart(self) -> None:
        reading, writing = os.pipe()
        os.close(reading)
        outlet = Outlet(LineTarget("pipe", writing))
        outlet.start()
        outlet.put(*answers_at([1.0]))
        outlet.close()
        assert outlet.gone

    def test_a_file_that_is_there_is_not_touched(self, tmp_path: Path) -> None:
        (tmp_path / "a").write_text("old", encoding="utf-8")
        with pytest.raises(OutputError, match="a: it already exists"):
            LineTarget.new(tmp_path / "a")
        with pytest.raises(OutputError, match="cannot be written"):
            LineTarget.new(tmp_path / "no" / "a")
        assert (tmp_path / "a").read_text(encoding="utf-8") == "old"


class TestUdp:
    def test_one_datagram_a_contact(self) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
            listener.bind(("127.0.0.1", 0))
            listener.settimeout(5)
            target = UdpTarget(f"127.0.0.1:{listener.getsockname()[1]}", CONTEXT)
            assert target.write(answers(3)) == 3
            target.close()
            got = [json.loads(listener.recv(4096))["time"] for _ in range(3)]
        assert got == [answer.time for answer in answers(3)]

    def test_nobody_listens(self) -> None:
        target = UdpTarget("127.0.0.1:9", CONTEXT)
        assert target.write(answers(5)) <= 5
        target.close()

    @pytest.mark.parametrize("address", ["127.0.0.1", "127.0.0.1:0", "127.0.0.1:70000", ":9000", "a b:9000"])
    def test_no_address(self, address: str) -> None:
        with pytest.raises(RunError, match="--udp"):
            UdpTarget(address, CONTEXT)

    @pytest.mark.parametrize("address", ["192.0.2.1:9000", "0.0.0.0:9000"])
    def test_another_machine_only_with_leave(self, address: str) -> None:
        with pytest.raises(RunError, match="--allow-remote"):
            UdpTarget(address, CONTEXT)
        UdpTarget(address, REMOTE).close()


class TestMcap:
    def test_others_can_read_it(self, tmp_path: Path) -> None:
        outlet = Outlet(McapTarget(str(tmp_path / "c.mcap"), CONTEXT))
        outlet.start()
        given = [*answers(1_200), *answers_at([1e300])]
        for answer in given:
            outlet.put(answer)
        outlet.close()
        assert (outlet.published, outlet.lost, outlet.error) == (1_200, 1, None)
        with (tmp_path / "c.mcap").open("rb") as file:
            found = list(make_reader(file, validate_crcs=True).iter_messages())
        assert len(found) == 1_200
        schema, channel, message = found[7]
        assert schema is not None
        assert (schema.name, channel.topic) == ("contactbench.Contact", "/contact")
        assert message.data == given[7].message(message.log_time)
        assert set(json.loads(given[7].line)) < set(json.loads(schema.data)["properties"])
        assert message.log_time == ABOUT.log_time(given[7].time)

    def test_a_file_that_is_there(self, tmp_path: Path) -> None:
        (tmp_path / "c.mcap").touch()
        with pytest.raises(OutputError, match=r"c\.mcap"):
            McapTarget(str(tmp_path / "c.mcap"), CONTEXT)
