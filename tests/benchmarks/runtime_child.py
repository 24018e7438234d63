"""A child process of the study: runs a bundle, and notes when contacts were there or how much memory it took.

Started as ``python -m benchmarks.runtime_child FOLDER live SECONDS URL...`` or ``... FOLDER
replay TAPE``; the last line that it writes is JSON.
"""

from __future__ import annotations

import json
import math
import sys
import time
from array import array
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.live.reader import GIVEN, resident

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.recording import RecordingInfo
from contactbench.pipeline.runtime import Outlet, Run
from contactbench.pipeline.runtime.outlet import OutputContext
from contactbench.pipeline.runtime.run import responsive
from contactbench.pipeline.runtime.targets import LineTarget, McapTarget, UdpTarget
from contactbench.pipeline.streams import open_pair

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import BinaryIO

    from contactbench.pipeline.devices.sample import WrenchSample
    from contactbench.pipeline.runtime import Answer

_PATIENCE_S = 10.0
_POLL_S = 0.01
_STEPS = 500
_NOWHERE = "127.0.0.1:9"  # datagrams to the discard port
_STILL = "still://?rpy=0,0,0"


def live(folder: Path, seconds: float, urls: Sequence[str]) -> dict[str, float]:
    """Run on sensors for a time, and note each contact of the n-th in given-n.bin when it is there."""
    config = RuntimeConfig.load(folder / "bundle")
    context = OutputContext(RecordingInfo(time.time_ns(), time.monotonic(), ()), config.probe)
    outlets: list[Outlet] = []
    runners = []
    with ExitStack() as stack:
        stack.enter_context(responsive())
        for number, url in enumerate(urls):
            lines = folder / f"live-{number}.jsonl"
            lines.unlink(missing_ok=True)
            outlets += (own := (Outlet(LineTarget.new(lines)), Outlet(UdpTarget(_NOWHERE, context))))
            file = stack.enter_context((folder / f"given-{number}.bin").open("wb"))

            def note(sample: WrenchSample, _: Answer, file: BinaryIO = file) -> None:
                file.write(GIVEN.pack(time.monotonic(), sample.sequence or 0, *sample.force, *sample.torque))

            runner = stack.enter_context(Run(config, own, hold=math.inf, on_answer=note))
            stack.enter_context(open_pair(url, _STILL, runner.wrenches, runner.poses))
            runners.append(runner)
        deadline = time.monotonic() + _PATIENCE_S
        while not all(runner.reasons for runner in runners):
            if time.monotonic() > deadline:
                raise TimeoutError(f"a sensor gave nothing for {_PATIENCE_S:g} s")
            time.sleep(_POLL_S)
        used, begun = time.process_time(), sum(sum(runner.reasons.values()) for runner in runners)
        time.sleep(seconds)
        ended, processor = time.monotonic(), time.process_time() - used
        located = sum(sum(runner.reasons.values()) for runner in runners) - begun
    lost = sum(outlet.lost for outlet in outlets)
    return {"ended": ended, "processor": processor / max(located, 1), "lost": lost}


def replay(folder: Path, tape: Path) -> dict[str, float]:
    """Run on a recording as fast as it can be read."""
    config = RuntimeConfig.load(folder / "bundle")
    address = f"replay://{tape}?speed=step"
    runner: Run
    pair = open_pair(address, address, lambda s: runner.wrenches(s), lambda s: runner.poses(s))
    outlets = (
        Outlet(LineTarget.new(folder / "replay.jsonl"), patient=True),
        Outlet(
            McapTarget(str(folder / "replay.mcap"), OutputContext(pair.about(), config.probe)), patient=True
        ),
    )
    runner = Run(config, outlets)
    used = array("q")  # a list of numbers would itself grow by a share of what may grow
    begun = time.monotonic()
    with responsive(), runner, pair:
        while pair.step(_STEPS):
            used.append(resident() or 0)
    warm = used[len(used) // 10 :] or array("q", [0])
    return {
        "seconds": time.monotonic() - begun,
        "located": sum(runner.reasons.values()),
        "lost": sum(outlet.lost for outlet in outlets),
        "resident_early": warm[0],
        "resident_most": max(warm),
        "resident_end": warm[-1],
    }


def main(folder: str, what: str, *arguments: str) -> None:
    """Run, and write what it took to standard output as JSON."""
    if what == "live":
        seconds, *urls = arguments
        said = live(Path(folder), float(seconds), urls)
    else:
        said = replay(Path(folder), Path(arguments[0]))
    sys.stdout.write(json.dumps(said) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
