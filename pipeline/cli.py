"""The command line: ``contactbench``.

Wrong input ends with exit code 2 and one red line that says what is wrong, where, and what to do; Ctrl-C with 130. With
``--json`` standard output carries exactly one JSON object, also for an error. A noun is imported when one of its
commands is asked for, and whatever takes long to import by the command that needs it, so that ``--help`` and
``--version`` answer at once.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Annotated, Any

import typer

from contactbench.pipeline.console import Nouns, print_json, report_error
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.installation import remedy

# Set before a command loads numpy. Matrices here are small: with two threads a decomposition of one of 77 rows took
# 0.4 ms instead of 0.3 on idle cores, and 37 ms on busy ones, where each thread spins until the other gets its turn.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

_WRONG_INPUT, _INTERRUPTED = 2, 130
_COMMANDS = "contactbench.pipeline.commands"
_WORDS = "contactbench.words"
# Typer brings a click of its own, or uses click itself: this is either's.
_UsageError: Any = typer.BadParameter.__base__


@dataclass(frozen=True)
class Entry:
    """
    A noun of the command line, not imported yet.

    Attributes
    ----------
    section : str
        Where it stands in the list.
    place : str
        ``module:name`` of its `Noun`.
    text : str
        One line about it.
    """

    section: str
    place: str
    text: str


ENTRIES = {
    "demo": Entry(
        "Begin", f"{_COMMANDS}.demo:demo_app", "Run the whole job on simulated probes, without files"
    ),
    "tutorial": Entry(
        "Begin", f"{_COMMANDS}.demo:tutorial_app", "Write sample data to follow the manual with"
    ),
    "info": Entry(
        "Begin", f"{_COMMANDS}.info:info_app", "Show versions, the kernel in use and optional packages"
    ),
    "record": Entry(
        "At the bench", f"{_COMMANDS}.record:record_app", "Record a sensor and a robot; convert recordings"
    ),
    "calibrate": Entry(
        "At the bench", f"{_COMMANDS}.calibrate:calibrate_app", "Bias, weight and centre of mass"
    ),
    "probe": Entry(
        "At the bench", f"{_COMMANDS}.probe:probe_app", "Turn a mesh into a probe; its regions and markers"
    ),
    "verify": Entry(
        "At the bench", f"{_COMMANDS}.verify:verify_app", "Judge contacts by touches of markers; report"
    ),
    "session": Entry(
        "At the bench", f"{_COMMANDS}.session:session_app", "Keep everything about a probe in one folder"
    ),
    "fleet": Entry(
        "At the bench",
        f"{_COMMANDS}.fleet:fleet_app",
        "Many sessions in one table: drifts, due dates, outliers",
    ),
    "locate": Entry("Use", f"{_COMMANDS}.locate:locate_app", "Locate the contact of each wrench in a file"),
    "heatmap": Entry("Use", f"{_COMMANDS}.heatmap:heatmap_app", "Show where the probe was touched"),
    "bundle": Entry("Use", f"{_COMMANDS}.bundle:bundle_app", "Export, check and compare a robot's bundles"),
    "run": Entry("Use", f"{_COMMANDS}.run:run_app", "Run a bundle on live streams"),
    "ros": Entry("Use", f"{_COMMANDS}.ros:ros_app", "Run a bundle as a node of ROS 2"),
    "bench": Entry("Try", f"{_COMMANDS}.bench:bench_app", "Simulated bench, devices and motion control"),
    "study": Entry(
        "Try", "contactbench.pipeline.study.commands:study_app", "Measure accuracy, speed and robustness"
    ),
}
_SECTIONS = ("Begin", "At the bench", "Use", "Try")

# Who needs a package that is not there, by the name that is imported: the extra that brings it.
_EXTRAS = {
    **dict.fromkeys(("PySide6", "pyvista", "pyvistaqt", "pyqtgraph", "vtkmodules"), "gui"),
    **dict.fromkeys(("imageio", "imageio_ffmpeg"), "video"),
    "mujoco": "sim",
    "weasyprint": "pdf",
    **dict.fromkeys(("dask", "distributed"), "study"),
    "pyarrow": "fleet",
    **dict.fromkeys(("pymeshlab", "igl"), "meshlab"),
    "embreex": "embree",
    **dict.fromkeys(
        ("rclpy", "diagnostic_msgs", "geometry_msgs", "sensor_msgs", "visualization_msgs"), "ros"
    ),
}


class _Commands(Nouns):
    """The nouns, with every expected end of a command turned into a sentence and an exit code."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002
        return list(ENTRIES)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002
        if cmd_name not in ENTRIES:
            return None
        module, _, name = ENTRIES[cmd_name].place.partition(":")
        command = typer.main.get_command(getattr(import_module(module), name))
        command.name = cmd_name
        return command

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        self.commands = dict.fromkeys(ENTRIES, self)  # what a misspelt name is compared with
        return super().resolve_command(ctx, args)

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write a screen of 80 by 24: no blank line that is not needed."""
        formatter.write(f"Usage: {ctx.command_path} [OPTIONS] COMMAND [ARGS]...\n{self.help}\n")
        widest = max(map(len, ENTRIES))
        for section in _SECTIONS:
            formatter.write(f"{section}:\n")
            for name, entry in ENTRIES.items():
                if entry.section == section:
                    formatter.write(f"  {name:<{widest}}  {entry.text}\n")
        formatter.write("More: COMMAND -h. Options: --version, --install-completion, --show-completion.\n")

    def parse_args(self, ctx: Any, args: list[str]) -> Any:
        ctx.meta[_WORDS] = tuple(args)
        with _told(ctx):
            return super().parse_args(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        with _told(ctx):
            return super().invoke(ctx)


@contextmanager
def _told(ctx: Any) -> Iterator[None]:
    """Say what went wrong, once, in the form that was asked for; what is wrong usage, typer itself says."""
    as_json = "--json" in ctx.meta[_WORDS]  # it may not have been read before the word that was wrong
    try:
        yield
    except _UsageError as error:
        if as_json:
            print_json({"error": error.format_message()})
        raise
    except InputError as error:
        report_error(str(error), as_json=as_json)
        raise typer.Exit(_WRONG_INPUT) from None
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        if name not in _EXTRAS:
            raise
        report_error(f"this needs {name}, which is not installed: {remedy(_EXTRAS[name])}.", as_json=as_json)
        raise typer.Exit(_WRONG_INPUT) from None
    except KeyboardInterrupt:
        report_error("interrupted: the command was stopped before it finished.", as_json=as_json)
        raise typer.Exit(_INTERRUPTED) from None


app = typer.Typer(
    name="contactbench",
    cls=_Commands,
    help="Find where a medical robot's probe is touched, from one force/torque sensor.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def main() -> None:
    """Run the command line; the entry point of ``contactbench``."""
    app()


def _show_version(ctx: typer.Context, value: bool) -> None:
    if value:
        from contactbench import __version__
        from contactbench.pipeline import kernel
        from contactbench.pipeline.kernel.build import build

        built = build()
        if "--json" in ctx.meta[_WORDS]:
            told = {"contactbench": __version__, "kernel": kernel.variant, "commit": built.commit}
            print_json(told | {"build_type": built.kind})
        else:
            typer.echo(f"contactbench {__version__} (kernel {kernel.variant}, {built})")
        raise typer.Exit


def _refuse_json(value: bool) -> None:
    if value:
        raise typer.BadParameter("it goes with --version here, or behind a command.")


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version",
            help="Print the version, the kernel and its build.",
            callback=_show_version,
            is_eager=True,
        ),
    ] = False,
    json: Annotated[
        bool, typer.Option("--json", help="With --version: one JSON object.", callback=_refuse_json)
    ] = False,
) -> None:
    pass


if __name__ == "__main__":
    main()
