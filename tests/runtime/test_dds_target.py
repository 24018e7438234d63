"""DDS, heard by a second participant in a process of its own, with ROS 2's own message types."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from runtime.contacts import touching
from runtime.runtime_recordings import ABOUT, CONTEXT, REMOTE
from waiting import until

from contactbench.pipeline.runtime import RunError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contactbench.pipeline.runtime.dds_target import DdsTarget

pytest.importorskip("cyclonedds")

DOMAIN = 100 + os.getpid() % 100  # two runs on one machine must not hear each other


@pytest.fixture
def target() -> Iterator[DdsTarget]:
    from contactbench.pipeline.runtime.dds_target import DdsTarget

    made = DdsTarget(str(DOMAIN), CONTEXT)
    yield made
    made.close()


def matched(target: DdsTarget) -> list[bool]:
    """Tell of each writer whether it knows of a reader: what it wrote before that, nobody gets."""
    return [bool(writer.get_matched_subscriptions()) for writer in target._writers]


def listener(count: int) -> subprocess.Popen[str]:
    words = [sys.executable, str(Path(__file__).with_name("dds_listener.py")), str(DOMAIN), str(count)]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True)


def test_ros_types_arrive_in_another_process(target: DdsTarget) -> None:
    given = touching(3, free=2)
    with listener(len(given)) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        until(lambda: all(matched(target)))
        assert target.write(given) == len(given)
        rows: list[dict[str, Any]] = [json.loads(line) for line in process.stdout]
    assert process.returncode == 0
    contacts = [row["contact"] for row in rows if "contact" in row]
    assert len(contacts) == len(given)
    for told, answer in zip(contacts, given, strict=True):
        assert told == json.loads(answer.message(ABOUT.log_time(answer.time)))
    heard = [row["wrench"]["wrench"] for row in rows if "wrench" in row]
    known = [a.contact.wrench.tolist() for a in given if a.contact and a.contact.wrench is not None]
    assert heard  # best effort: some may be missing
    assert all([*each["force"].values(), *each["torque"].values()] in known for each in heard)


def test_subscribers_that_come_and_go_cost_nothing(target: DdsTarget) -> None:
    given = touching(1)
    for _ in range(2):
        until(lambda: not any(matched(target)))
        with listener(1) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            until(lambda: all(matched(target)))
            assert target.write(given) == 1
            assert any('"contact"' in line for line in process.stdout)
        assert target.write(given * 200) == 200


def test_closed_it_leaves_the_network_though_somebody_holds_it(monkeypatch: pytest.MonkeyPatch) -> None:
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic

    from contactbench.pipeline.runtime.dds_target import _LOOPBACK, WRENCH, DdsTarget
    from contactbench.pipeline.runtime.dds_types import WrenchStamped

    # With leave it has no domain of its own, whose end would end all that is in it.
    monkeypatch.setenv("CYCLONEDDS_URI", _LOOPBACK)
    target = DdsTarget(str(DOMAIN), REMOTE)
    participant = DomainParticipant(DOMAIN)
    reader = DataReader(participant, Topic(participant, WRENCH, WrenchStamped))
    until(reader.get_matched_publications)
    target.close()
    until(lambda: not reader.get_matched_publications())


@pytest.mark.parametrize("domain", ["-1", "233", "a", "", "1.5"])
def test_no_domain(domain: str) -> None:
    from contactbench.pipeline.runtime.dds_target import DdsTarget

    with pytest.raises(RunError, match="--dds"):
        DdsTarget(domain, CONTEXT)
