"""How much memory commands take for recordings and tables of several lengths: those that read on take no more."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from string import Formatter
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from benchmarks.bundle_example import example_config

from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import RecordingWriter, read_recording
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from contactbench.pipeline.devices.sample import WrenchSample
    from contactbench.pipeline.recording.reader import FlangeTrack

_MORE_MB = 25.0  # more for the longest input than for the next: what a heap may waste
_PAUSE_S = 0.005  # between two copies
_CLI = (sys.executable, "-m", "contactbench.pipeline.cli")
# Of itself a child has what its parent had when it was made: this one has next to nothing.
_LAUNCHER = (
    "import resource, subprocess, sys\n"
    "code = subprocess.call(sys.argv[1:], stdout=subprocess.DEVNULL)\n"
    "print(code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
)


@dataclass(frozen=True)
class Command:
    """A command; {gravity}, {touches}, {readings}, {wrenches} and {contacts} stand for files of some length."""

    words: str
    of: str  # Which of them its length is
    flat: bool = True  # It reads on, and keeps nothing
    codes: tuple[int, ...] = (0,)


COMMANDS = {
    "record info": Command("record info {gravity}", "gravity"),
    "record convert to .csv": Command("record convert {gravity} --out {out}.csv", "gravity"),
    "record convert to .npz": Command("record convert {gravity} --out {out}.npz", "gravity"),
    "record delay": Command("record delay {gravity}", "gravity", flat=False, codes=(0, 1)),
    "record start from a replay": Command(
        "record start replay://{gravity}?speed=step --pose replay://{gravity}?speed=step --out {out}.mcap",
        "gravity",
    ),
    "run from a replay": Command(
        "run {bundle} --source replay://{gravity}?speed=step --pose replay://{gravity}?speed=step --out {out}.jsonl"
        " --mcap {out}.mcap --other-sensor",
        "gravity",
        codes=(0, 1),
    ),
    "calibrate captures": Command("calibrate captures {gravity} --out {out}.csv", "gravity", flat=False),
    "calibrate captures of a table": Command(
        "calibrate captures {readings} --out {out}.csv", "readings", codes=(0, 1)
    ),
    "calibrate compensate": Command(
        "calibrate compensate {calibration} {readings} --out {out}.csv", "readings"
    ),
    "locate": Command("locate --probe {probe} {wrenches} --out {out}.csv", "wrenches", codes=(0, 1)),
    "locate --track": Command(
        "locate --probe {probe} {wrenches} --track --out {out}.csv", "wrenches", codes=(0, 1)
    ),
    "verify touches": Command(
        "verify touches {touches} --probe {probe} --calibration {calibration} --markers {markers} --force 7,11",
        "touches",
        flat=False,
        codes=(0, 1),
    ),
    "heatmap draw of a recording": Command(
        "heatmap draw {touches} --probe {probe} --calibration {calibration} --out {out}.ply",
        "touches",
        flat=False,
    ),
    "heatmap draw of contacts": Command(
        "heatmap draw {contacts} --probe {probe} --out {out}.ply", "contacts", flat=False
    ),
    "session add": Command("session add {session} {gravity} --kind recording --name {name}.mcap", "gravity"),
}


def run(
    copies: Sequence[float] = (5, 50, 150),
    only: Sequence[str] = (),
    *,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure commands on the tutorial's recordings, so many copies of each behind one another."""
    lengths = sorted({int(each) for each in copies})
    if len(lengths) < 2 or lengths[0] < 1:
        raise InputError(f"--copies {','.join(map(str, copies))}: give two numbers of copies or more.")
    if unknown := [name for name in only if name not in COMMANDS]:
        raise InputError(f"--only {unknown[0]}: choose from {', '.join(COMMANDS)}.")
    chosen = only or [*COMMANDS]
    needs = {field for name in chosen for _, field, _, _ in Formatter().parse(COMMANDS[name].words) if field}
    rows = []
    figures = []
    with TemporaryDirectory(prefix="contactbench-") as place:
        folder = Path(place)
        files = _sample(folder, needs)
        samples = {}
        for number in lengths:
            progress(f"{number} copies of the tutorial's recordings")
            samples[number] = _copies(folder, files, number, needs)
        for name in chosen:
            command = COMMANDS[name]
            peaks = []
            for number in lengths:
                peaks.append(peak([*_CLI, *_words(folder, command, number), "--quiet"], command.codes))
                progress(f"{name}, {number} copies: {peaks[-1]:.0f} MB")
            more = peaks[-1] - peaks[0]
            each = 1e6 * more / (samples[lengths[-1]][command.of] - samples[lengths[0]][command.of])
            rows.append((name, *peaks, each))
            most = _MORE_MB if command.flat else None
            figures.append(
                Figure(
                    name, "more memory for the longest than the next", peaks[-1] - peaks[-2], "MB", most=most
                )
            )
    lengths_s = [f"{max(samples[number].values()):,} samples, MB" for number in lengths]
    sheet = Sheet("memory", "Most memory", ("command", *lengths_s, "bytes a sample more"), tuple(rows))
    note = "Those without a target hold all samples at once. A sample is a reading and a pose, or a row of a table."
    return StudyReport("Memory", {"copies": lengths}, tuple(figures), (note,), sheets=(sheet,))


def _sample(folder: Path, needs: set[str]) -> dict[str, Path]:
    """Write sample data, and what is made of it: a calibration, a probe, a bundle, a session."""
    files = {name: folder / name for name in ("sample", "bundle", "session")}
    sample = files["sample"]
    _call("tutorial", sample)
    files |= {"calibration": sample / "calibration.json", "probe": sample / "probe.ply"}
    # Only what is needed: each takes a while.
    if needs & {"calibration", "wrenches", "contacts"}:
        _call("calibrate", "fit", sample / "poses.csv", "--out", files["calibration"])
    if needs & {"probe", "contacts"}:
        placed = (sample / "housing.stl", "--place", "0,0,150,90,0,0", "--close", "auto")
        _call("probe", "prepare", *placed, "--out", files["probe"])
    if "session" in needs:
        _call("session", "new", files["session"])
    if "bundle" in needs:
        example_config(1_000).write(files["bundle"])
    return files


def _copies(folder: Path, files: dict[str, Path], number: int, needs: set[str]) -> dict[str, int]:
    """Write the files of a length; return how many samples each holds."""
    at = folder / str(number)
    at.mkdir()
    counts = {}
    for name in {"gravity", "touches"} & needs:
        counts[name] = repeat(files["sample"] / f"{name}.mcap", at / f"{name}.mcap", number)
    if needs & {"readings", "wrenches", "contacts"}:
        counts["readings"] = _repeat_table(files["sample"] / "recording.csv", at / "readings.csv", number)
    if needs & {"wrenches", "contacts"}:
        compensated = (files["calibration"], at / "readings.csv", "--out", at / "wrenches.csv")
        _call("calibrate", "compensate", *compensated)
    if "contacts" in needs:
        located = ("--probe", files["probe"], at / "wrenches.csv", "--out", at / "contacts.csv")
        _call("locate", *located, codes=(0, 1))
    return counts | dict.fromkeys(("wrenches", "contacts"), counts.get("readings", 0))


def repeat(source: Path, target: Path, number: int) -> int:
    """Write a recording several times behind itself; return how many readings that makes."""
    recording = read_recording(source)
    (track,), (flange,) = recording.wrenches.values(), recording.flanges.values()
    samples: list[WrenchSample | FlangeSample] = sorted(
        [*track.samples(), *_poses(flange)], key=lambda sample: sample.time
    )
    span = samples[-1].time - samples[0].time + _PAUSE_S
    # Brought to the disk seldom: there is nothing to lose.
    with RecordingWriter(target, recording.info, chunk_seconds=1.0, sync_seconds=3_600.0) as writer:
        for turn in range(number):
            for sample in samples:
                moved = replace(sample, time=sample.time + turn * span, arrival=None)
                if isinstance(moved, FlangeSample):
                    writer.flange(moved)
                else:
                    writer.wrench(replace(moved, sequence=None))
    return number * len(track.times)


def _poses(track: FlangeTrack) -> Iterator[FlangeSample]:
    for time, R, p in zip(track.times.tolist(), track.R_BE, track.p_BE_B, strict=True):
        yield FlangeSample(time, R, p)


def _repeat_table(source: Path, target: Path, number: int) -> int:
    header, *lines = source.read_text("utf-8").splitlines()
    rows = [line.partition(",") for line in lines]
    span = float(rows[-1][0]) + _PAUSE_S
    with target.open("w", encoding="utf-8") as file:
        file.write(header + "\n")
        for turn in range(number):
            file.writelines(f"{float(time) + turn * span:.6f},{rest}\n" for time, _, rest in rows)
    return number * len(rows)


def _words(folder: Path, command: Command, number: int) -> list[str]:
    at, sample = folder / str(number), folder / "sample"
    names = {
        **{name: at / f"{name}.mcap" for name in ("gravity", "touches")},
        **{name: at / f"{name}.csv" for name in ("readings", "wrenches", "contacts")},
        **{name: folder / name for name in ("bundle", "session")},
        "calibration": sample / "calibration.json",
        "probe": sample / "probe.ply",
        "markers": sample / "markers.csv",
        "name": f"gravity-{number}",
        "out": at / f"out-{abs(hash(command))}",
    }
    return [word.format(**names) for word in command.words.split()]


def _call(*words: object, codes: tuple[int, ...] = (0,)) -> None:
    peak([*_CLI, *map(str, words), "--quiet"], codes)


def peak(command: Sequence[str], codes: tuple[int, ...]) -> float:
    """Run a program; return the most memory that it had, MB."""
    done = subprocess.run(
        [sys.executable, "-c", _LAUNCHER, *command], capture_output=True, text=True, check=False
    )
    code, most = (int(word) for word in done.stdout.split())
    if code not in codes:
        raise InputError(f"{' '.join(command)}: ended with {code}: {done.stderr[-1000:]}")
    return most / 1e6 * (1 if sys.platform == "darwin" else 1024)
