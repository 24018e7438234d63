"""The command line: ``contactbench``.

Wrong input ends with exit code 2 and one red line that says what is wrong, where, and what to do; Ctrl-C
with 130. With ``--json`` standard output carries exactly one JSON object, also for an error; everything
meant for people goes to standard error. Whatever takes long to import is imported by the command that
needs it, so that ``--help`` and ``--version`` answer at once.
"""

from __future__ import annotations

import os
import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from pipeline import __version__
from pipeline.commands.gravity import gravity_app
from pipeline.commands.options import numbers
from pipeline.commands.poses import poses_app
from pipeline.commands.probe import probe_app
from pipeline.commands.region import region_app
from pipeline.console import Bar, JsonOption, print_json, report_error, say, wants_json
from pipeline.errors import InputError
from pipeline.study.commands import study_app

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    import numpy.typing as npt

    from pipeline.contact import Gates, WrenchNoise
    from pipeline.contact.stream import LocateSummary, Locator
    from pipeline.mesh import Probe

_WRONG_INPUT, _INTERRUPTED = 2, 130


class _Commands(TyperGroup):
    """The commands, with every expected end of one turned into a sentence and an exit code."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
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
    add_completion=False,
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
    "fast_simplification": ("fast-simplification",),
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

    from pipeline import kernel

    optional = {
        name: _version(*distributions) if find_spec(name) else None
        for name, distributions in _OPTIONAL.items()
    }
    return {
        "contactbench": __version__,
        "python": platform.python_version(),
        **{name: _version(name) for name in ("numpy", "scipy", "trimesh")},
        "platform": platform.platform(),
        "cpu": _cpu_model(),
        "cpu_count": os.cpu_count(),
        "cpu_features": dict(import_module("pipeline.kernel._cpu").features()),
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


# ---- locate ------------------------------------------------------------------------------------


class Units(StrEnum):
    """What the numbers in a mesh file are."""

    mm = "mm"
    m = "m"
    cm = "cm"
    inch = "in"


class MethodName(StrEnum):
    """Ways to locate a contact, as in pipeline.contact.methods."""

    contactbench = "contactbench"
    scan = "scan"
    algorithm1 = "algorithm1"
    wrench_axis = "wrench_axis"
    iterative = "iterative"


_UNITS_PER_METRE = {Units.mm: 1000.0, Units.m: 1.0, Units.cm: 100.0, Units.inch: 1 / 0.0254}


@app.command(
    help=(
        "Locate the contact of each wrench in a CSV file.\n\n"
        "WRENCHES has the columns t,fx,fy,fz,mx,my,mz (s, N, N·m about the sensor origin, sensor frame S) in"
        " any order; - is standard input. The output has t,x,y,z,k,face,reason,candidates,sigma_max_mm (m,"
        " N·m, frame S) and is written as a whole or not at all."
    ),
    epilog=(
        "Example: contactbench locate --probe probe.stl --units mm --mount 0,0,45,0,0,90 wrenches.csv"
        " --out contacts.csv"
    ),
)
def locate(
    wrenches: Annotated[Path, typer.Argument(metavar="WRENCHES", help="CSV file, or - for standard input.")],
    probe: Annotated[Path, typer.Option(help="Mesh of the probe: .stl, .ply or .obj.")],
    out: Annotated[Path, typer.Option(help="CSV file to write, or - for standard output.")],
    units: Annotated[Units, typer.Option(help="Unit of the mesh's numbers.")] = Units.mm,
    mount: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z,RX,RY,RZ",
            help="Pose of the mesh in S: position in --units, rotations about the fixed axes x, then y, then"
            " z, degrees. Left out: the mesh is in S.",
        ),
    ] = None,
    method: Annotated[MethodName, typer.Option(help="Who answers.")] = MethodName.contactbench,
    track: Annotated[bool, typer.Option("--track", help="Follow the contact from row to row.")] = False,
    noise_force: Annotated[float, typer.Option(help="Standard deviation of a force, N.")] = 0.05,
    noise_torque: Annotated[float, typer.Option(help="Standard deviation of a torque, N·m.")] = 0.002,
    min_force: Annotated[float | None, typer.Option(help="low_force under this, N [0.5].")] = None,
    friction_angle: Annotated[
        float | None, typer.Option(help="tangential beyond this angle to the normal, degrees [75].")
    ] = None,
    ambiguity_distance: Annotated[
        float | None, typer.Option(help="ambiguous when a rival is this far, mm [5].")
    ] = None,
    follow_distance: Annotated[
        float | None, typer.Option(help="With --track: prefer candidates this near, mm [10].")
    ] = None,
    saturation: Annotated[
        str | None,
        typer.Option(
            metavar="FX,FY,FZ,MX,MY,MZ", help="saturated when a channel reaches this, N, N·m [none]."
        ),
    ] = None,
    region_only: Annotated[
        bool, typer.Option("--region-only", help="Refuse contacts outside every region of the mesh.")
    ] = False,
    allow_nan: Annotated[
        bool, typer.Option("--allow-nan", help="Answer NaN, infinity and empty cells with not_finite.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Locate the contact of each wrench in a CSV file."""
    _check_usage(out, method, track, as_json)
    T_SP = None if mount is None else _mount(mount, units)
    limits = None if saturation is None else tuple(numbers(saturation, 6, "--saturation"))
    from pipeline.contact import Gates, WrenchNoise
    from pipeline.contact.stream import locate_file, refuse_overwriting

    refuse_overwriting(out, probe)
    given = {
        "min_force": min_force,
        "friction_angle": friction_angle,
        "ambiguity_distance": None if ambiguity_distance is None else ambiguity_distance / 1000,
        "follow_distance": None if follow_distance is None else follow_distance / 1000,
        "saturation": limits,
        "region_only": region_only,
    }
    chosen: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    gates, noise = Gates(**chosen), WrenchNoise(noise_force, noise_torque)
    surface, warnings = _load(probe, units, T_SP)
    for sentence in warnings:
        say(f"warning: {sentence}", "yellow")
    locator = _locator(method, surface, noise, gates)
    dash = Path("-")
    with Bar("locating") as bar:
        summary = locate_file(
            locator,
            sys.stdin.buffer if wrenches == dash else wrenches,
            sys.stdout.buffer if out == dash else out,
            track=track,
            allow_nan=allow_nan,
            progress=bar,
        )
    for sentence in summary.warnings:
        say(f"warning: {sentence}", "yellow")
    _show(summary)
    if as_json:
        print_json({"out": str(out), **summary.facts(), "warnings": [*warnings, *summary.warnings]})


def _check_usage(out: Path, method: MethodName, track: bool, as_json: bool) -> None:
    if track and method is not MethodName.contactbench:
        raise typer.BadParameter(f"--track works with --method contactbench only, not with {method.value}.")
    if as_json and out == Path("-"):
        raise typer.BadParameter("--json and --out - both want standard output: name a file.")


def _mount(text: str, units: Units) -> npt.NDArray[np.float64]:
    """T_SP (4, 4), metres, from x,y,z in units and rx,ry,rz in degrees: R_SP = Rz Ry Rx."""
    values = numbers(text, 6, "--mount")
    import numpy as np
    from scipy.spatial.transform import Rotation

    T_SP = np.eye(4)
    T_SP[:3, :3] = Rotation.from_euler("xyz", values[3:], degrees=True).as_matrix()  # lower case: fixed axes
    T_SP[:3, 3] = np.array(values[:3]) / _UNITS_PER_METRE[units]
    return T_SP


def _load(path: Path, units: Units, T_SP: npt.NDArray[np.float64] | None) -> tuple[Probe, Sequence[str]]:
    import warnings

    from pipeline.mesh import MeshWarning, load_probe

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # said below, in the words it would have used
        probe = load_probe(path, units.value, T_SP)
    return probe, [f"{path}: {sentence}" for sentence in probe.health.sentences]


def _locator(method: MethodName, probe: Probe, noise: WrenchNoise, gates: Gates) -> Locator:
    if method is MethodName.contactbench:
        from pipeline.contact import ContactSolver

        return ContactSolver(probe, noise, gates)
    from pipeline.contact import methods

    return methods.METHODS[method.value](probe, noise, gates)


def _show(summary: LocateSummary) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, show_header=False)
    table.add_column()
    table.add_column(justify="right")
    table.add_column(justify="right")
    table.add_row("rows", f"{summary.rows:,}", "")
    for reason, count in summary.reasons.items():
        if count:
            table.add_row(reason, f"{count:,}", f"{100 * count / summary.rows:.1f} %")
    if summary.median_sigma_max_mm is not None:
        table.add_row("median sigma_max", f"{summary.median_sigma_max_mm:.3g} mm", "")
    table.add_row("speed", f"{summary.rows_per_second:,.0f} rows/s", "")
    Console(stderr=True).print(table)


# ---- demo --------------------------------------------------------------------------------------


@app.command(
    help=(
        "Simulate touches of the bundled probes, locate them, and check the errors against the known truth.\n\n"
        "Needs no hardware and no files. Writes meshes, wrenches, contacts, a table of errors and a picture."
        " Exit code 1: the errors are larger than noise explains."
    ),
    epilog="Example: contactbench demo --out my-demo",
)
def demo(
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path("contactbench-demo"),
    probe: Annotated[str, typer.Option(metavar="linear|convex|t-shape|all", help="Which probe.")] = "all",
    touches: Annotated[int, typer.Option(help="Touches per probe, at least 10.")] = 1_000,
    seed: Annotated[int, typer.Option(help="Of chance: the same seed gives the same CSV files.")] = 0,
    as_json: JsonOption = False,
) -> None:
    """Do the main job on the bundled probes."""
    from rich.console import Console

    from pipeline.demo import PROBE_NAMES, run

    report = run(out, PROBE_NAMES if probe == "all" else (probe,), touches, seed, say)
    Console(stderr=as_json).print(report.table())
    for sentence in report.sentences():
        say(sentence, "red" if "FAILED" in sentence else "")
    if as_json:
        print_json(report.to_json())
    if not report.verified:
        raise typer.Exit(1)


# ---- more commands -----------------------------------------------------------------------------

# Their modules take options and output from pipeline.console and pipeline.commands, never from this one, and
# import nothing heavy at their top.
app.add_typer(gravity_app)
app.add_typer(poses_app)
app.add_typer(probe_app, name="probe")
app.add_typer(region_app, name="region")
app.add_typer(study_app, name="study")


if __name__ == "__main__":
    main()
