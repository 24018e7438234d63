"""The command line: ``contactbench``.

Wrong input ends with exit code 2 and one red line that says what is wrong, where, and what to do; Ctrl-C
with 130. With ``--json`` standard output carries exactly one JSON object, also for an error; everything
meant for people goes to standard error. Whatever takes long to import is imported by the command that
needs it, so that ``--help`` and ``--version`` answer at once.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from contactbench import __version__
from contactbench.pipeline.commands.bench import bench_app
from contactbench.pipeline.commands.check import check_app
from contactbench.pipeline.commands.config import config_app
from contactbench.pipeline.commands.control import control_app
from contactbench.pipeline.commands.emulate import emulate_app
from contactbench.pipeline.commands.gravity import gravity_app
from contactbench.pipeline.commands.heatmap import heatmap_app
from contactbench.pipeline.commands.locate import locate_app
from contactbench.pipeline.commands.poses import poses_app
from contactbench.pipeline.commands.probe import probe_app
from contactbench.pipeline.commands.record import record_app
from contactbench.pipeline.commands.recording import recording_app
from contactbench.pipeline.commands.region import region_app
from contactbench.pipeline.commands.report import report_app
from contactbench.pipeline.commands.run import run_app
from contactbench.pipeline.commands.session import session_app
from contactbench.pipeline.commands.verify import markers_app, verify_app
from contactbench.pipeline.console import JsonOption, print_json, report_error, say, wants_json
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.commands import study_app

_WRONG_INPUT, _INTERRUPTED = 2, 130
_WORDS = "contactbench.words"
# Typer brings a click of its own, or uses click itself: this is either's.
_UsageError: Any = typer.BadParameter.__base__


class _Commands(TyperGroup):
    """The commands, with every expected end of one turned into a sentence and an exit code."""

    def parse_args(self, ctx: Any, args: list[str]) -> Any:
        ctx.meta[_WORDS] = tuple(args)
        return super().parse_args(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except _UsageError as error:
            if "--json" in ctx.meta[_WORDS]:  # it may not have been read before the word that was wrong
                print_json({"error": error.format_message()})
            raise
        except InputError as error:
            report_error(str(error), as_json=wants_json(ctx))
            raise typer.Exit(_WRONG_INPUT) from None
        except KeyboardInterrupt:
            report_error("interrupted: the command was stopped before its end.", as_json=wants_json(ctx))
            raise typer.Exit(_INTERRUPTED) from None


app = typer.Typer(
    name="contactbench",
    cls=_Commands,
    help="Find where a medical robot's probe is touched, from one force/torque sensor, and how sure that is.",
    epilog="Example: contactbench locate --probe probe.stl --units mm wrenches.csv --out contacts.csv",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def main() -> None:
    """Run the command line; the entry point of ``contactbench``."""
    app()


def _show_version(value: bool) -> None:
    if value:
        typer.echo(f"contactbench {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    pass


# ---- info --------------------------------------------------------------------------------------

# Name to import, and the distributions that provide it.
_OPTIONAL = {
    "embreex": ("embreex",),
    "pyvista": ("pyvista",),
    "PySide6": ("PySide6-Essentials", "PySide6"),
    "mujoco": ("mujoco",),
    "pymeshlab": ("pymeshlab",),
    "igl": ("libigl",),
}


@app.command(
    help="Show versions, the compiled kernel in use, the processor, and which optional packages are there.",
    epilog="Example: contactbench info --json",
)
def info(as_json: JsonOption = False) -> None:
    """Show versions and what this machine offers."""
    facts = _facts()
    if as_json:
        print_json(facts)
        return
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, show_header=False)
    for name, value in facts.items():
        table.add_row(name.replace("_", " "), _plain(value))
    Console().print(table)


def _facts() -> dict[str, Any]:
    import platform
    from importlib import import_module
    from importlib.util import find_spec

    from contactbench.pipeline import kernel

    optional = {
        name: _version(*distributions) if find_spec(name) else None
        for name, distributions in _OPTIONAL.items()
    }
    return {
        "contactbench": __version__,
        "python": platform.python_version(),
        **{name: _version(name) for name in ("numpy", "scipy", "manifold3d")},
        "platform": platform.platform(),
        "cpu": _cpu_model(),
        "cpu_count": os.cpu_count(),
        "cpu_features": dict(import_module("contactbench.pipeline.kernel._cpu").features()),
        "kernel": kernel.variant,
        "compiler": kernel.compiler,
        "optional": optional,
    }


def _version(*distributions: str) -> str:
    from importlib.metadata import PackageNotFoundError, version

    for name in distributions:
        try:
            return version(name)
        except PackageNotFoundError:
            continue
    return "unknown version"


def _cpu_model() -> str:
    import platform

    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass  # not Linux
    return platform.processor() or platform.machine() or "unknown"


def _plain(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_plain(item)}" for name, item in value.items()) or "none"
    return {None: "absent", True: "yes", False: "no"}[value] if value in (None, True, False) else str(value)


# ---- demo --------------------------------------------------------------------------------------


@app.command(
    help=(
        "Calibrate, prepare, press markers on a virtual bench, locate, and check against the known truth.\n\n"
        "Needs no hardware and no files. Writes recordings, meshes, contacts, reports, a runtime bundle, a table of"
        " errors and a picture. Exit code 1: the errors are larger than noise explains, a verification failed, or a"
        " bundle is refused."
    ),
    epilog="Example: contactbench demo --out my-demo",
)
def demo(
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path("contactbench-demo"),
    probe: Annotated[str, typer.Option(metavar="linear|convex|t-shape|all", help="Which probe.")] = "all",
    touches: Annotated[int, typer.Option(help="Drawn touches per probe, at least 10.")] = 1_000,
    seed: Annotated[int, typer.Option(help="Of chance: the same seed gives the same CSV files.")] = 0,
    as_json: JsonOption = False,
) -> None:
    """Do the main job on the bundled probes."""
    from rich.console import Console

    from contactbench.pipeline.demo import PROBE_NAMES, run

    report = run(out, PROBE_NAMES if probe == "all" else (probe,), touches, seed, say)
    Console(stderr=as_json).print(report.table())
    for sentence in report.sentences():
        say(sentence, "red" if "FAILED" in sentence else "")
    if as_json:
        print_json(report.to_json())
    if not report.verified:
        raise typer.Exit(1)


# ---- more commands -----------------------------------------------------------------------------

# Their modules take options and output from contactbench.pipeline.console and contactbench.pipeline.commands, never
# from this one, and import nothing heavy at their top.
app.add_typer(locate_app)
app.add_typer(heatmap_app)
app.add_typer(report_app)
app.add_typer(gravity_app)
app.add_typer(poses_app)
app.add_typer(probe_app, name="probe")
app.add_typer(region_app, name="region")
app.add_typer(emulate_app)
app.add_typer(bench_app, name="bench")
app.add_typer(record_app)
app.add_typer(recording_app, name="recording")
app.add_typer(session_app, name="session")
app.add_typer(verify_app)
app.add_typer(markers_app, name="markers")
app.add_typer(check_app, name="check")
app.add_typer(config_app, name="config")
app.add_typer(run_app)
app.add_typer(control_app, name="control")
app.add_typer(study_app, name="study")


if __name__ == "__main__":
    main()
