"""
Measure contactbench itself: `packaging/run benchmark NAME [options]`.

Each benchmark is a function whose arguments are its options. It gives a report that says whether it passed. Exit
codes: 0 every figure reached its target, 1 one did not, 2 wrong usage.
"""

import argparse
import inspect
import json
import os
import re
import sys
from importlib import import_module
from pathlib import Path

from contactbench.app.commands import check_screen
from contactbench.pipeline.errors import InputError

# As the command line does; before a benchmark loads numpy.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Name: where the function is. The first line of its module's docstring is its help.
BENCHMARKS = {
    "ablation": "ablation.study:run",
    "alignment": "preparation.alignment:run",
    "bundles": "bundle_fuzz:run",
    "calibration-doubt": "calibration_doubt:run",
    "chain": "chain:run",
    "confidence": "confidence:run",
    "control-safety": "control_safety:run",
    "control-scenarios": "control_scenarios:run",
    "day": "day:run",
    "days": "whole_day:run",
    "faults": "faults:run",
    "fleet": "fleet:run",
    "gravity": "gravity:run",
    "hard-cases": "solver.hard_cases:run",
    "memory": "memory:run",
    "mesh-fuzz": "mesh_fuzz.fuzz:run",
    "mistakes": "mistakes:run",
    "outputs": "outputs:run",
    "prepared-meshes": "prepared_meshes:run",
    "protocols": "soak:run",
    "rays": "rays.contest:run",
    "real": "real:run",
    "regions": "preparation.regions:run",
    "reproduce-dynamic": "reproduce.dynamic:run",
    "reproduce-mixes": "reproduce.mixes:run",
    "reproduce-static": "reproduce.static:run",
    "ros": "ros:run",
    "runtime": "runtime:run",
    "sessions": "session_crash:run",
    "simplify": "preparation.simplify:run",
    "solver": "solver.exact:run",
    "ties": "solver.ties:run",
    "torsion": "torsion:run",
    "verification": "verification:run",
    "waiting": "waiting:run",
    "window-brush": "window.brush:run",
    "window-charts": "window.charts:run",
    "window-kill": "window.kill:run",
    "window-leaks": "window.leaks:run",
    "window-pictures": "window.screenshots:run",
    "window-stalls": "window.stalls:run",
    "window-startup": "window.startup:run",
}


def main(words: list[str]) -> int:
    """Run the benchmark that the first word names."""
    os.environ["CONTACTBENCH_CACHE"] = "off"  # work is timed, not what was kept of it
    parser = argparse.ArgumentParser(prog="packaging/run benchmark", description=__doc__)
    parser.add_argument("name", choices=[*BENCHMARKS])
    name = parser.parse_args(words[:1]).name
    function = function_of(name)
    given = options_of(name, function).parse_args(words[1:])
    out, as_json = given.__dict__.pop("out_file"), given.__dict__.pop("as_json")
    try:
        if name.startswith("window-"):
            check_screen()
        report = function(**{key: value for key, value in vars(given).items() if value is not None})
    except InputError as error:
        print(json.dumps({"error": str(error)}) if as_json else "", end="")  # noqa: T201
        progress(f"error: {error}")
        return 2
    return finish(report, out, as_json=as_json)


def progress(*told: object) -> None:
    """Tell how far a benchmark is."""
    print(*told, file=sys.stderr, flush=True)  # noqa: T201


def function_of(name: str):
    """Import the function of a benchmark."""
    module, function = BENCHMARKS[name].split(":")
    return getattr(import_module(f"benchmarks.{module}"), function)


def options_of(name: str, function) -> argparse.ArgumentParser:
    """Make the options of a benchmark from the arguments of its function."""
    told = (sys.modules[function.__module__].__doc__ or "").strip().partition("\n\n")[0]
    parser = argparse.ArgumentParser(prog=f"packaging/run benchmark {name}", description=told)
    for parameter in inspect.signature(function).parameters.values():
        # As it is written, whether or not the module keeps its annotations as text.
        kind = re.sub(
            r"^'|'$|\b(pathlib|collections\.abc)\.", "", inspect.formatannotation(parameter.annotation)
        )
        option = "--" + parameter.name.replace("_", "-")
        if parameter.name == "progress":
            parser.set_defaults(progress=progress)
        elif parameter.name == "settings" or parameter.kind in (
            parameter.VAR_POSITIONAL,
            parameter.VAR_KEYWORD,
        ):
            continue
        elif kind == "bool":
            parser.add_argument(option, action="store_true")
        elif kind.startswith("tuple["):
            parser.add_argument(option, metavar="WxH", type=lambda text: tuple(map(int, text.split("x"))))
        elif kind.startswith("Sequence["):
            item = (
                float
                if "float" in kind
                else int
                if kind == "Sequence[int]"
                else Path
                if "PathLike" in kind
                else str
            )
            parser.add_argument(
                option, metavar="A,B", type=lambda text, item=item: [item(each) for each in text.split(",")]
            )
        else:
            item = {"int": int, "float": float, "Path": Path}.get(kind.partition(" |")[0], str)
            required = parameter.default is inspect.Parameter.empty
            parser.add_argument(
                option, type=item, required=required, help=None if required else f"[{parameter.default}]"
            )
    parser.add_argument(
        "--write", dest="out_file", type=Path, help="A Markdown file, or a folder for tables and plots."
    )
    parser.add_argument(
        "--json", dest="as_json", action="store_true", help="Print the figures as one JSON object."
    )
    return parser


def finish(report, out: Path | None, *, as_json: bool) -> int:
    """Write and print a report; give the exit code."""
    if isinstance(report, int):
        return report
    if out is not None:
        report.write(out)
    if as_json:
        print(json.dumps(report.to_json()))  # noqa: T201
    else:
        from rich.console import Console

        Console().print(*report.tables())
    return 0 if report.passed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
