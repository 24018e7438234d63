"""``contactbench demo`` and ``tutorial``: the main job on bundled probes, and sample data to do it with by hand."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from contactbench.pipeline.console import Noun, answer, as_json, say, show_tables
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

demo_app = Noun()
tutorial_app = Noun()

_WIDE = 250  # a number that is cut short is wrong


@demo_app.command(example="demo --out my-demo")
def demo(
    out: Path = Path("contactbench-demo"),
    probe: str = "all",
    touches: int = 1_000,
    seed: int = 0,
    reality: list[str] | None = None,
    seeds: int | None = None,
    follow: bool = False,
) -> None:
    """Calibrate, prepare, press markers on a virtual bench, locate, and check against the known truth.

    Needs no hardware and no files. Writes recordings, meshes, contacts, reports, a runtime bundle, a
    table of errors and a picture. Exit code 1: the errors are larger than noise explains, a verification
    failed, or a bundle was refused.

    With --reality: calibrate, prepare, align, verify, export and run on a realistic bench, and
    compare with the truth. Exit code 1: on a typical bench a figure misses its target.

    Parameters
    ----------
    out : DIR
        Folder to write.
    probe : linear|convex|t-shape|all
        Probe to use.
    touches
        Random touches per probe, at least 10.
    seed
        Seed: the same seed gives the same CSV files.
    reality : MIX|EFFECT=SIZE,...
        Simulate a whole day on a bench with these effects instead, such as typical; may be repeated.
        `contactbench bench reality` lists them.
    seeds
        Days on each such bench, with seeds counted from --seed [1].
    follow
        Align, verify and run these days with a zero that follows.
    """
    from rich.console import Console

    from contactbench.pipeline.demo import PROBE_NAMES, run

    names = PROBE_NAMES if probe == "all" else (probe,)
    if reality:
        _days(out, reality, names, 1 if seeds is None else seeds, seed, follow=follow)
        return
    if seeds is not None:
        raise InputError("--seeds needs --reality: give a bench too, such as --reality typical.")
    report = run(out, names, touches, seed, say)
    Console(stderr=as_json()).print(report.table())
    for sentence in report.sentences():
        say(sentence, "red" if "FAILED" in sentence else "")
    answer(report.to_json(), good=report.verified)


def _days(
    out: Path, reality: list[str], probes: Sequence[str], seeds: int, seed: int, *, follow: bool
) -> None:
    from rich.console import Console

    from contactbench.pipeline.demo.day import run_days
    from contactbench.pipeline.reality import Reality

    benches = [Reality.parse(text) for text in reality]
    report = run_days(out, benches, probes, seeds, seed, say, follow=follow)
    tables = [report.table(), *(sheet.table() for sheet in report.sheets)]
    if as_json():
        show_tables(*tables)
    else:
        for table in tables:
            Console(width=_WIDE).print(table)
    answer(report.to_json(), good=report.passed)


@tutorial_app.command(example="tutorial my-first-probe")
def tutorial(folder: Path, /, seed: int = 0) -> None:
    """Write sample data for the tutorials: poses, recordings, a housing, touches, markers, and the truth.

    Simulated on the virtual bench, in seconds; README.md in the folder says what each file is.

    Parameters
    ----------
    folder : DIR
        Folder to write, new or empty.
    seed
        Of chance: the same seed gives the same bytes.
    """
    from contactbench.pipeline.demo.tutorial import write_tutorial

    data = write_tutorial(folder, seed, say)
    say(
        f"{folder}: {len(data.files)} files; README.md says what they are. Go there with: cd {folder}",
        "green",
    )
    answer({"out": str(folder), "files": list(data.files), "place": data.place, "bumped": list(data.bumped)})
