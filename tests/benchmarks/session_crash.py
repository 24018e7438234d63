"""
Killing a process that adds to a session, and looking at what is left.

``python -m benchmarks.session_crash FOLDER`` adds without end, and says on standard output what it
was told is safe.
"""

import os
import random
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.check import check
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.store import Session
from contactbench.pipeline.study.report import Figure, StudyReport

_PATIENCE_S = 60.0
_LATEST_S = 0.05


@dataclass(frozen=True)
class KillReport:
    """What became of a session whose writer was killed again and again."""

    kills: int
    acknowledged: int  # Actions that writers were told are safe
    torn: int  # How often a record was cut off in the middle
    problems: tuple[str, ...]  # What was lost or is half there; empty when all is well


def run(kills: int = 200, *, seed: int = 0, progress: Callable[[str], None] = lambda _: None) -> StudyReport:
    """Kill a writing process again and again, and look what is left."""
    if kills < 1:
        raise InputError("give a number of kills above 0.")
    progress(f"killing a writer {kills} times")
    with TemporaryDirectory() as folder:
        report = kill_writers(Path(folder) / "session", kills, seed=seed)
    figures = (
        Figure("session", "actions acknowledged", report.acknowledged, least=1),
        Figure("session", "lost, or half there", len(report.problems), most=0),
        Figure("session", "records cut off in the middle", report.torn),
    )
    settings = {"kills": kills, "seed": seed}
    return StudyReport("Sessions whose writer is killed", settings, figures, report.problems)


def kill_writers(folder: Path, kills: int, *, seed: int = 0) -> KillReport:
    """Kill a process that adds to a session at random moments, and check the session after each."""
    moments = random.Random(seed)  # noqa: S311 moments, no secrets
    Session.create(folder, by="crash").close()
    problems: list[str] = []
    acknowledged: dict[int, str] = {}
    torn = 0
    for turn in range(kills):
        acknowledged |= _run_and_kill(folder, moments)
        with Session.open(folder, by="crash") as session:
            torn += bool(session.notes)
            known = {record.number: record.hash for record in session.records}
        problems += [
            f"kill {turn + 1}: record {n} is lost" for n, d in acknowledged.items() if known.get(n) != d
        ]
        problems += [f"kill {turn + 1}: {problem}" for problem in check(folder).problems]
    return KillReport(kills, len(acknowledged), torn, tuple(problems))


def _run_and_kill(folder: Path, moments: random.Random) -> dict[int, str]:
    """Return the number and hash of each record that the process was told is safe."""
    command = [sys.executable, "-m", "benchmarks.session_crash", str(folder)]
    early, wait = moments.random() < 0.2, moments.random() * _LATEST_S
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        stream = process.stdout
        if stream is None:
            return {}
        first = b"" if early else stream.readline()
        time.sleep(wait if not early else 4 * wait)
        alone = process.poll() is not None
        process.kill()
        lines = (first + stream.read()).split(b"\n")[:-1]
        process.wait(_PATIENCE_S)
    if alone:
        raise SessionError("the process that adds to the session ended by itself: its error is above.")
    return {int(number): digest.decode() for number, digest in (line.split() for line in lines)}


def add_forever(folder: Path) -> None:
    """Add notes, inputs and results, and write each one's number and hash to standard output."""
    with Session.open(folder, by="crash") as session:
        turn = len(session.records)
        while True:
            turn += 1
            if turn % 3 == 0:
                record = session.note(f"turn {turn} " + "x" * (turn % 4096))
            elif turn % 3 == 1:
                data = bytes([turn % 251]) * (1 + 997 * (turn % 40))
                inputs = {"mesh": session.state.mesh.file.sha256} if session.state.mesh else {}
                record = session.add_result(
                    "test", f"r{turn % 5}.bin", {f"r{turn % 5}.bin": data}, inputs, {}
                )
            else:
                record = session.add_input(turn.to_bytes(8, "little") * 700, "mesh", name="m.stl")
            os.write(1, f"{record.number} {record.hash}\n".encode())


if __name__ == "__main__":
    add_forever(Path(sys.argv[1]))
