"""
Runs commands with a clock that stands still, and writes down what they say and the files they leave.

``python recorder.py FOLDER`` works in FOLDER, new or empty, and writes one text file a command beside it, in
``FOLDER.said``. Every command is a fork of one process that has imported what commands import.
"""

import datetime as dt
import hashlib
import html
import itertools
import os
import re
import secrets
import shlex
import sys
from pathlib import Path

# In this order: a command may read what an earlier one wrote.
COMMANDS = {
    "tutorial": "tutorial data --seed 2 --json",
    "fit": "calibrate fit data/poses.csv --out calibration.json --report calibration.html --json",
    "captures": "calibrate captures data/gravity.mcap --out captures.csv --json",
    "diagnose": "calibrate diagnose data/poses.csv --mass 0.6",
    "still": "calibrate check still calibration.json data/held-out.csv --json",
    "compensate": "calibrate compensate calibration.json data/recording.csv --out compensated.csv --json",
    "inspect": "probe inspect data/housing.stl --json",
    "prepare": "probe prepare data/housing.stl --close auto --place 0,0,150,90,0,0 --facets 400 --out probe.ply --json",
    "region-add": "probe regions add probe.ply tip --colour #ff8800",
    "region-box": "probe regions box probe.ply tip --low=-40,-40,140 --high 40,40,160",
    "region-list": "probe regions list probe.ply --json",
    "locate": "locate --probe probe.ply compensated.csv --compensated --track --region-only --out contacts.csv --json",
    "touches": "verify touches data/touches.mcap --probe probe.ply --calibration calibration.json"
    " --markers data/markers.csv --force 7,11 --out verification.json",
    "report": "verify report --verification verification.json --probe probe.ply --calibration calibration.json"
    " --operator Ada --out report.html --json",
    "export": "bundle export --calibration calibration.json --probe probe.ply --verification verification.json"
    " --model M8128 --saturation 200,200,400,10,10,10 --region-only --out bundle --json",
    "check": "bundle check bundle --json",
    "run": "run bundle --source replay://FOLDER/data/touches.mcap?speed=step --pose replay://FOLDER/data/touches.mcap?speed=step"
    " --out live.jsonl --json",
    "recording": "record info data/touches.mcap --json",
    "convert": "record convert data/touches.mcap --out touches.csv --json",
    "devices": "record devices --json",
    "new": "session new session --json",
    "add-poses": "session add session data/poses.csv --kind poses --serial M42 --json",
    "add-mesh": "session add session probe.ply --kind mesh --json",
    "add-markers": "session add session data/markers.csv --kind markers --json",
    "add-touches": "session add session few.csv --kind recording --json",
    "set": "session set session calibration.tip=[0,0,120] verification.samples=12 devices.serial=M42",
    "compute-calibration": "session compute session calibration calibration.json --json",
    "compute-probe": "session compute session probe probe.ply --set facets=300 --json",
    "compute-verification": "session compute session verification verification.json --json",
    "set-again": "session set session calibration.tip=[0,0,100] verification.mean_limit_mm=2",
    "info": "session info session",
    "again": "session compute session calibration calibration.json",
    "verified-again": "session compute session verification verification.json --json",
    "from-session": "bundle export session --model M8128 --rate 200 --out session-bundle --unverified --json",
    "schema": "bundle schema",
    "old": "session import-archive OLD/session.zip --out old",
    "old-replay": "session replay old",
    "old-info": "session info old --json",
    "old-bundle": "bundle check OLD/bundle.zip --json",
}
_OLD = Path(__file__).parent / "old"
_READABLE = 2_500  # bytes of a file that is shown whole; of a longer one its hash
# What a computer's speed decides, and nothing else.
_SPEEDS = re.compile(
    rb'("(?:solve_\w+|seconds|latency\w*|\w*_us|median(?:_s)?|p99\w*|\w*per_second)": ?)[-\d.e]+'
    rb"|((?:a solve takes|latency:|process|compensated,| speed ) ).*"
    rb"|^(?:(?:robot|sensor): (?:streaming|closed)|The inertia of .*)\n",  # in the order in which threads say it
    re.MULTILINE,
)
_TIME = dt.datetime(2026, 1, 2, 3, 4, 5, 678900, tzinfo=dt.UTC)


class _Still(type):
    def __instancecheck__(cls, value: object) -> bool:
        return isinstance(value, type(_TIME))


class _Clock(type(_TIME), metaclass=_Still):
    @classmethod
    def now(cls, tz: dt.tzinfo | None = None) -> dt.datetime:
        return _TIME.astimezone(tz)


def hold_still() -> None:
    """Let time stand still and chance be counted, for everything that is imported afterwards."""
    numbers = itertools.count(1)
    dt.datetime = _Clock
    secrets.token_hex = lambda count=32: f"{next(numbers):0{2 * count}x}"
    os.environ.update(COLUMNS="120", SOURCE_DATE_EPOCH=str(int(_TIME.timestamp())), NO_COLOR="1")
    os.environ.update(
        OPENBLAS_NUM_THREADS="1", OPENBLAS_CORETYPE="Haswell", CONTACTBENCH_CACHE="off", TZ="UTC"
    )


def plain(data: bytes, name: str = "") -> bytes:
    """Return output without what is another one each time; of a page its words."""
    if name.endswith(".html"):
        words = re.sub(rb"(?s)<(style|script|svg)\b.*?</\1>|<[^>]*>", b"\n", data)
        data = re.sub(rb"\s*\n\s*", b"\n", html.unescape(words.decode()).encode())
    if b"\n speed " in data:  # a table is as wide as the speed in it
        data = re.sub(rb"(?m)(?<=\S) {2,}", b"  ", data)
    return _SPEEDS.sub(lambda found: found[1] + b"0" if found[1] else found[2] and found[2] + b"...", data)


def shown(file: Path, folder: Path) -> str:
    """Return a file as its pin has it."""
    name, data = file.relative_to(folder).as_posix(), plain(file.read_bytes(), file.name)
    if len(data) <= _READABLE and not data.count(0):
        return f"--- {name}\n{data.decode()}\n"
    return f"--- {name}: {len(data)} bytes, sha256 {hashlib.sha256(data).hexdigest()}\n"


def thin_out(file: Path, few: Path) -> None:
    """Write every fourth row, in fewer digits: small enough for a session that is checked in."""
    head, *rows = (line.split(",")[:11] for line in file.read_text(encoding="utf-8").splitlines())
    kept = [[f"{float(cell):.5g}" for cell in row] for row in rows[::4]]
    few.write_text("".join(",".join(row) + "\n" for row in [head, *kept]), encoding="utf-8")


def record(folder: Path) -> None:
    """Run all commands in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    said = folder.with_name(f"{folder.name}.said")
    said.mkdir()
    os.chdir(folder)
    from prompt import warm

    warm()
    from contactbench.app.cli import main

    before: dict[Path, bytes] = {}
    for name, command in COMMANDS.items():
        out = said / f"{name}.out"
        child = os.fork()
        if child == 0:
            for stream in (1, 2):
                os.dup2(os.open(out, os.O_WRONLY | os.O_CREAT | os.O_APPEND), stream)
            sys.argv = [
                "contactbench",
                *shlex.split(command.replace("FOLDER", str(folder)).replace("OLD", str(_OLD))),
            ]
            main()
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if name == "touches":
            verified = folder / "verification.json"  # the bundle has its hash
            verified.write_bytes(plain(verified.read_bytes()))
        if name == "convert":
            thin_out(folder / "touches.csv", folder / "few.csv")
        now = {file: file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}
        files = [shown(file, folder) for file, data in now.items() if before.get(file) != data]
        answer = plain(out.read_bytes()).decode().replace(str(folder), "FOLDER").replace(str(_OLD), "OLD")
        text = f"$ contactbench {command}\n{answer}exit code {code}\n{''.join(files)}"
        (said / f"{name}.txt").write_text(text, encoding="utf-8")
        out.unlink()
        before = now


if __name__ == "__main__":
    hold_still()
    record(Path(sys.argv[1]).resolve())
