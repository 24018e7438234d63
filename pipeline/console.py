"""
What every command shares: how a command is declared, its results, one JSON object, progress.

Results go to standard output, warnings and errors to standard error. Where standard output is data, one JSON object or
lines for another program, results go to standard error, too.
"""

from __future__ import annotations

import inspect
import json
import signal
import sys
import threading
import time
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, is_dataclass
from functools import wraps
from typing import TYPE_CHECKING, Annotated, Any, get_args

import typer
from typer.core import TyperCommand, TyperGroup

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from types import FrameType

    from rich.table import Table

    from contactbench.pipeline.parameter_options import Notes

_JSON = "contactbench.json"
_PATIENCE_S = 0.5
_CONTROLS = {code: "\N{REPLACEMENT CHARACTER}" for code in (*range(0x20), *range(0x7F, 0xA0)) if code != 0x0A}
_LOUD = ("red", "yellow")  # what --quiet leaves: errors and warnings


_running: ContextVar[typer.Context] = ContextVar("running")
# Hold True while a quiet command runs, or one whose standard output is data: of the process, for streams speak from
# threads.
_quiet: set[bool] = set()
_data: set[bool] = set()


def _remember(ctx: typer.Context, value: bool) -> bool:
    ctx.meta[_JSON] = value  # shared by all levels of commands
    _running.set(ctx)
    if value:
        output_is_data()
    return value


def output_is_data() -> None:
    """Keep what is said out of standard output, for as long as the command runs; only for commands with ``--json``."""
    _data.add(True)
    # Of the root: where a word is wrong, the command's own context is never closed.
    _running.get().find_root().call_on_close(_data.clear)


def _hush(ctx: typer.Context, value: bool) -> bool:
    if value and not ctx.resilient_parsing:
        _quiet.add(True)
        ctx.find_root().call_on_close(_quiet.clear)
    return value


JsonOption = Annotated[
    bool,
    typer.Option(
        "--json", help="Print one JSON object on standard output.", callback=_remember, is_eager=True
    ),
]
QuietOption = Annotated[
    bool, typer.Option("--quiet", "-q", help="Print only warnings and errors.", callback=_hush, is_eager=True)
]


# ---- commands ----------------------------------------------------------------------------------


class _Leaf(TyperCommand):
    """A command whose examples stay on one line each, to be copied."""

    def format_epilog(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002
        """Write the examples."""
        for line in (self.epilog or "").splitlines():
            formatter.write(f"\n  {line}\n")


class Nouns(TyperGroup):
    """Commands, listed with the whole first paragraph of their help."""

    format_epilog = _Leaf.format_epilog

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list."""
        commands = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl([(name, summary(each)) for name, each in commands if each and not each.hidden])


def summary(command: Any) -> str:
    """Return the first paragraph of a command's help, uncut."""
    text = inspect.cleandoc(command.help or "").partition("\n\n")[0]
    return " ".join(text.split()).removesuffix(".")


class Noun(typer.Typer):
    """
    Commands about one thing: their help is their docstring, and each has ``--json``, ``--quiet`` and an example.

    A parameter becomes an argument if it is positional only, else an option; one that is a dataclass, or settings,
    becomes the options that its fields declare, and one with ``**`` those that it is annotated with, a list of
    `inspect.Parameter`.

    Parameters
    ----------
    text : str
        Help of the group; without it, the noun is its only command.
    """

    def __init__(self, text: str = "") -> None:
        super().__init__(
            cls=Nouns, help=text, no_args_is_help=True, add_completion=False, rich_markup_mode=None
        )
        if text:
            self.callback()(_nothing)  # one command alone is still a command of the group

    def command(  # type: ignore[override]
        self, name: str | None = None, *, example: str | tuple[str, ...], as_json: bool = True
    ) -> Callable[[Callable[..., None]], Callable[..., None]]:
        """Add a command; without `as_json` it has no ``--json``."""
        examples = (example,) if isinstance(example, str) else example

        def add(function: Callable[..., None]) -> Callable[..., None]:
            epilog = "\n".join(f"Example: contactbench {each}" for each in examples)
            super(Noun, self).command(name, cls=_Leaf, epilog=epilog)(flat(function, as_json=as_json))
            return function

        return add


def _nothing() -> None:
    pass


def flat(function: Callable[..., None], *, as_json: bool = True) -> Callable[..., None]:
    """
    Return a command whose options are its own, those of its settings and dataclasses, and the common ones.

    What an option is for stands in the docstring of the function or the dataclass, under Parameters.
    """
    from contactbench.pipeline.parameter_options import declared, documented  # not for a list of commands

    parameters: list[inspect.Parameter] = []
    parsers: dict[str, Callable[[Any], Any]] = {}
    models: dict[str, tuple[Callable[..., Any], list[str]]] = {}
    places: list[str] = []

    def take(parameter: inspect.Parameter, notes: Notes) -> str:
        option, parse = declared(parameter, notes)
        parameters.append(option)
        if parse is not None:
            parsers[option.name] = parse
        return option.name

    text, about = documented(function)
    for parameter in inspect.signature(function, eval_str=True).parameters.values():
        kind: Any = parameter.annotation
        if parameter.kind is parameter.VAR_KEYWORD:
            parameters += get_args(kind)[1]
        elif isinstance(kind, type) and is_dataclass(kind):
            fields, (_, told) = inspect.signature(kind, eval_str=True).parameters, documented(kind)
            models[parameter.name] = kind, [take(each, told) for each in fields.values()]
        elif hasattr(kind, "model_fields"):
            from contactbench.pipeline.setting_options import options_of  # not for those who need none

            model, options = options_of(kind)
            models[parameter.name] = model, [each.name for each in options]
            parameters += options
        else:
            take(parameter, about)
            if parameter.kind is parameter.POSITIONAL_ONLY:
                places.append(parameter.name)
    common = {"as_json": JsonOption, "quiet": QuietOption} if as_json else {"quiet": QuietOption}
    parameters += [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=False, annotation=option)
        for name, option in common.items()
    ]

    @wraps(function)
    def command(**given: Any) -> None:
        for name in common:
            given.pop(name)
        given |= {name: parse(given[name]) for name, parse in parsers.items()}
        made = {
            name: model(**{each: given.pop(each) for each in names})
            for name, (model, names) in models.items()
        }
        arguments = [given.pop(name) for name in places]
        function(*arguments, **given, **made)

    command.__doc__ = text
    command.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return command


def wants_json(ctx: Any) -> bool:
    """Tell whether the command that runs was given ``--json``."""
    return bool(ctx.meta.get(_JSON))


def running_command() -> tuple[str, Mapping[str, Any]]:
    """Return the name of the command that runs, and its parameters; only for commands with ``--json``."""
    context = _running.get()
    return context.info_name or "", context.params


# ---- output ------------------------------------------------------------------------------------


def print_json(value: Mapping[str, Any]) -> None:
    """Write one JSON object on standard output."""
    typer.echo(json.dumps(value, allow_nan=False))


def as_json() -> bool:
    """Tell whether the command that runs was given ``--json``; only for commands that have it."""
    return wants_json(_running.get())


def answer(value: Mapping[str, Any], *, good: bool = True) -> None:
    """Write what came of the command that runs, if it was given ``--json``; what is not good ends with exit code 1."""
    if as_json():
        print_json(value)
    if not good:
        raise typer.Exit(1)


def say(text: str, style: str = "", *, aside: bool = False) -> None:
    """
    Write one line, styled on a terminal.

    Red and yellow ones, which ``--quiet`` leaves, go to standard error, and what is said aside, of work that goes on.
    """
    if _quiet and style not in _LOUD:
        return
    from rich.console import Console
    from rich.text import Text

    # File names need be neither printable nor UTF-8.
    line = " ".join(text.encode("utf-8", "replace").decode().splitlines())
    Console(stderr=bool(_data) or aside or style in _LOUD).print(
        Text(printable(line), style=style), soft_wrap=True
    )


def say_all(sentences: Iterable[str], style: str = "") -> None:
    """Write lines, see `say`."""
    for sentence in sentences:
        say(sentence, style)


def warn(sentences: Iterable[str]) -> None:
    """Write warnings."""
    say_all((f"warning: {sentence}" for sentence in sentences), "yellow")


def printable(text: str) -> str:
    """Replace control characters, all but the line feed: a name in a stranger's file shall not steer a terminal."""
    return text.translate(_CONTROLS)


def show_tables(*tables: Table) -> None:
    """Write tables, as wide as they are: a number cut short by a narrow terminal is wrong."""
    if _quiet:
        return
    from rich.console import Console

    console = Console(stderr=bool(_data))
    for table in tables:
        needed = console.measure(table, options=console.options.update(width=1000)).maximum
        console.width = max(console.width, needed)
    for table in tables:
        console.print(table)


def report_error(message: str, *, as_json: bool) -> None:
    """Write a red line on standard error and, when asked for, ``{"error": ...}`` on standard output."""
    say(f"error: {message}", "red")
    if as_json:
        print_json({"error": message})


class Bar:
    """A progress bar, on a terminal only, and only once the work has taken half a second.

    Parameters
    ----------
    what : str
        The word in front of it.
    counted : bool
        Steps are counted, not bytes.
    """

    def __init__(self, what: str, *, counted: bool = False) -> None:
        self._what = what
        self._counted = counted
        self._begin = time.perf_counter()
        self._progress: Any = None
        self._task: Any = None

    def __enter__(self) -> Bar:
        return self

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` bytes or steps are through; a total of 0 is unknown."""
        late = time.perf_counter() - self._begin > _PATIENCE_S
        if self._progress is None and late and not _quiet and sys.stderr.isatty():
            self._start(total)
        if self._progress is not None:
            self._progress.update(self._task, completed=done)

    def __exit__(self, *_: object) -> None:
        if self._progress is not None:
            self._progress.stop()

    def _start(self, total: int) -> None:
        from rich import progress
        from rich.console import Console

        self._progress = progress.Progress(
            progress.TextColumn("{task.description}"),
            progress.BarColumn(),
            progress.MofNCompleteColumn() if self._counted else progress.DownloadColumn(),
            progress.TimeRemainingColumn(),
            console=Console(stderr=True),
            transient=True,
        )
        self._task = self._progress.add_task(self._what, total=total or None)
        self._progress.start()


# ---- the end ------------------------------------------------------------------------------------

# A closed terminal ends it too: files that are to go would stay behind. Not all systems have SIGHUP.
_ENDS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


@dataclass
class Ended:
    """Whether somebody has asked a command to end: a flag, for an event's lock may be held by what a signal stops."""

    asked: bool = False


@contextmanager
def ended_by_signals() -> Iterator[Ended]:
    """
    Take the signals that end a process, so that a command ends well.

    Those that whoever started it has had ignored, as nohup does, stay so. Only the main thread can hear any.
    """
    ended = Ended()

    def take(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        ended.asked = True

    main = threading.current_thread() is threading.main_thread()
    heard = [each for each in _ENDS if main and signal.getsignal(each) is not signal.SIG_IGN]
    before = {each: signal.signal(each, take) for each in heard}
    try:
        yield ended
    finally:
        for each, handler in before.items():
            # Once asked to end, the process is about to: one more signal must not kill it while it says what it wrote.
            signal.signal(each, signal.SIG_IGN if ended.asked else handler)
