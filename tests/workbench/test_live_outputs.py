"""Contacts of the open devices to other programs."""

from __future__ import annotations

import json
import shutil
import socket
from typing import TYPE_CHECKING

import pytest
from waiting import until
from workbench.touch_session import STEPWISE

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench.export import built
from contactbench.pipeline.workbench.live import Live, LiveOutputs

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from contactbench.pipeline.config.runtime import RuntimeConfig


@pytest.fixture(scope="module")
def config(calibrated: Path, tmp_path_factory: pytest.TempPathFactory) -> RuntimeConfig:
    folder = shutil.copytree(calibrated, tmp_path_factory.mktemp("made") / "s")
    with Session.open(folder, by="ada") as session:
        session.set_parameter("config.rate", 200.0)
        return built(session, unverified=True)


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4_000_000)
        found.bind(("127.0.0.1", 0))
        found.settimeout(10)
        yield found


def place(listener: socket.socket) -> str:
    return f"127.0.0.1:{listener.getsockname()[1]}"


def test_contacts_go_out_until_it_is_stopped(
    live: Live, config: RuntimeConfig, listener: socket.socket
) -> None:
    outputs = LiveOutputs(live)
    live.open(STEPWISE, STEPWISE)
    assert live.pair is not None
    live.pair.step(50)
    outputs.start(config, {"udp": place(listener)}, unverified=True)
    live.pair.step(500)
    until(lambda: outputs.look()[0].published > 300)
    reasons = [json.loads(listener.recv(65_536))["reason"] for _ in range(300)]
    assert reasons.count("stale") < 100  # until poses come
    assert outputs.running
    (state,) = outputs.look()
    assert (state.option, state.lost, state.error) == ("udp", 0, "")
    outputs.stop()
    assert not outputs.running
    assert outputs.look() == ()
    live.pair.step(100)


def test_why_a_broker_takes_nothing_is_told(live: Live, config: RuntimeConfig) -> None:
    pytest.importorskip("paho")
    outputs = LiveOutputs(live)
    live.open(STEPWISE, STEPWISE)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))  # nobody listens
        address = f"127.0.0.1:{free.getsockname()[1]}/bench"
        outputs.start(config, {"mqtt": address}, unverified=True)
        until(lambda: "nothing accepts a connection there" in outputs.look()[0].error)
        outputs.stop()


def test_what_cannot_be_is_refused(live: Live, config: RuntimeConfig) -> None:
    outputs = LiveOutputs(live)
    with pytest.raises(InputError, match="open them in step 1"):
        outputs.start(config, {"udp": "127.0.0.1:9"}, unverified=True)
    live.open(STEPWISE, STEPWISE)
    with pytest.raises(InputError, match="choose one"):
        outputs.start(config, {}, unverified=True)
    with pytest.raises(InputError, match="not verified"):
        outputs.start(config, {"udp": "127.0.0.1:9"})
    with pytest.raises(InputError, match="--allow-remote"):
        outputs.start(config, {"igtl": "127.0.0.1:0", "udp": "192.0.2.1:9"}, unverified=True)
    assert not outputs.running
