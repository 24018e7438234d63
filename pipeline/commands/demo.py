"""``contactbench demo``: the main job on bundled probes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import Noun, answer, as_json, say

demo_app = Noun()


@demo_app.command(example="demo --out my-demo")
def demo(
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path("contactbench-demo"),
    probe: Annotated[str, typer.Option(metavar="linear|convex|t-shape|all", help="Which probe.")] = "all",
    touches: Annotated[int, typer.Option(help="Drawn touches per probe, at least 10.")] = 1_000,
    seed: Annotated[int, typer.Option(help="Of chance: the same seed gives the same CSV files.")] = 0,
) -> None:
    """Calibrate, prepare, press markers on a virtual bench, locate, and check against the known truth.

    Needs no hardware and no files. Writes recordings, meshes, contacts, reports, a runtime bundle, a
    table of errors and a picture. Exit code 1: the errors are larger than noise explains, a verification
    failed, or a bundle is refused.
    """
    from rich.console import Console

    from contactbench.pipeline.demo import PROBE_NAMES, run

    report = run(out, PROBE_NAMES if probe == "all" else (probe,), touches, seed, say)
    Console(stderr=as_json()).print(report.table())
    for sentence in report.sentences():
        say(sentence, "red" if "FAILED" in sentence else "")
    answer(report.to_json())
    if not report.verified:
        raise typer.Exit(1)
