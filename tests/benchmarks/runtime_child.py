"""A child process of the study: runs a bundle, and notes when contacts were there or how much memory it took.

Started as ``python -m benchmarks.runtime_child FOLDER live URL SECONDS FILE`` or ``... FOLDER
replay TAPE``; the
last line that it writes is JSON.
"""

from __future__ import annotations

import json
import math
import sys
import time
from array import array
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.live.reader import resident
from benchmarks.live.records import GIVEN

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.runtime import Outlet, Run
from contactbench.pipeline.runtime.run import responsive
from contactbench.pipeline.runtime.targets import LineTarget, McapTarget, UdpTarget
from contactbench.pipeline.streams import open_pair

if TYPE_CHECKING:
    from contactbench.pipeline.devices.sample import WrenchSample
    from contactbench.pipeline.runtime import Answer

_PATIENCE_S = 10.0
_POLL_S = 0.01
_STEPS = 500
_NOWHERE = "127.0.0.1:9"  # datagrams to the discard port
_STILL = "still://?rpy=0,0,0"


def live(folder: Path, url: str, seconds: float, notes: Path) -> dict[str, float]:
    """Run on a sensor for a time, and note each contact when it is there."""
    config = RuntimeConfig.load(folder / "bundle")
    lines = folder / "live.jsonl"
    lines.unlink(missing_ok=True)
    outlets = (Outlet(LineTarget.new(lines)), Outlet(UdpTarget(_NOWHERE)))
    with notes.open("wb") as file:

        def note(sample: WrenchSample, _: Answer) -> None:
            file.write(GIVEN.pack(time.monotonic(), sample.sequence or 0, *sample.force, *sample.torque))

        runner = Run(config, outlets, hold=math.inf, on_answer=note)
        with responsive(), runner, open_pair(url, _STILL, runner.wrenches, runner.poses):
            deadline = time.monotonic() + _PATIENCE_S
            while not runner.reasons:
                if time.monotonic() > deadline:
                    raise TimeoutError(f"the sensor gave nothing for {_PATIENCE_S:g} s")
                time.sleep(_POLL_S)
            used = time.process_time()
            time.sleep(seconds)
            ended, processor = time.monotonic(), time.process_time() - used
    return {"ended": ended, "processor": processor, "lost": sum(outlet.lost for outlet in outlets)}


def replay(folder: Path, tape: Path) -> dict[str, float]:
    """Run on a recording as fast as it can be read."""
    config = RuntimeConfig.load(folder / "bundle")
    address = f"replay://{tape}?speed=step"
    runner: Run
    pair = open_pair(address, address, lambda s: runner.wrenches(s), lambda s: runner.poses(s))
    outlets = (
        Outlet(LineTarget.new(folder / "replay.jsonl"), patient=True),
        Outlet(McapTarget(folder / "replay.mcap", pair.about()), patient=True),
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
        url, seconds, notes = arguments
        said = live(Path(folder), url, float(seconds), Path(notes))
    else:
        said = replay(Path(folder), Path(arguments[0]))
    sys.stdout.write(json.dumps(said) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
