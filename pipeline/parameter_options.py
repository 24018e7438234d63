"""
Options and arguments of a command, made of the parameters of a function or a dataclass.

Type and default stand in the signature, the help in the docstring, under Parameters; what follows a name there after
" : " is how the value is written on the command line.
"""

import inspect
import math
from collections.abc import Callable
from functools import partial
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

import typer

from contactbench.pipeline.errors import arg, message

Notes = dict[str, tuple[str | None, str]]
"""How each parameter is written on the command line, and what it is for."""


def documented(made: Callable[..., Any]) -> tuple[str, Notes]:
    """
    Return the docstring of a function or a class up to its parameters, and what it says about these.

    Raises
    ------
    ValueError
        It describes a parameter that is not there.
    """
    text, _, rest = (inspect.getdoc(made) or "").partition("\n\nParameters\n----------\n")
    notes: Notes = {}
    name, metavar = "", ""
    for line in rest.partition("\n\n")[0].splitlines():
        if line.startswith(" "):
            sentence = f"{notes[name][1]} {line.strip()}".strip()
        else:
            name, _, metavar = line.partition(" : ")
            sentence = ""
        notes[name] = metavar or None, sentence
    if unknown := notes.keys() - inspect.signature(made).parameters:
        raise ValueError(
            message(
                f"{arg(made.__name__)} documents {arg(', '.join(sorted(unknown)))}, but has no such parameter"
            )
        )
    return text, notes


def numbers(text: str, count: int, option: str) -> list[float]:
    """Return `count` finite numbers from an option's comma separated text.

    Raises
    ------
    typer.BadParameter
        There are others.
    """
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(math.isfinite(value) for value in values):
        raise typer.BadParameter(
            message(
                f"{arg(option)} needs {arg(count)} finite numbers separated by commas, not {arg(text)!r}."
            )
        )
    return values


def declared(
    parameter: inspect.Parameter, notes: Notes
) -> tuple[inspect.Parameter, Callable[[Any], Any] | None]:
    """
    Return a parameter as typer takes it, and what makes its value of what typer gives; None: it stays as it is.

    One that is positional only is an argument, any other an option. A flag that is False can only be given; one that is
    True can be given with ``--no-``. Several numbers are written between commas. A trailing underscore is dropped.
    """
    if get_origin(parameter.annotation) is Annotated:
        return parameter.replace(kind=parameter.KEYWORD_ONLY), None
    metavar, text = notes.get(parameter.name, (None, ""))
    kind, default, names = parameter.annotation, parameter.default, []
    option = f"--{parameter.name.rstrip('_').replace('_', '-')}"
    if default is False or parameter.name.endswith("_"):
        names.append(option)
    parse = None
    if (count := _count(kind)) is not None:
        parse = partial(_vectors, count, option)
        kind = list[str] if get_origin(_bare(kind)) is list else str
        if default is None:
            kind = kind | None
        elif isinstance(default, tuple):
            default = ",".join(f"{number:g}" for number in default)
    note: Any
    if parameter.kind is parameter.POSITIONAL_ONLY:
        own = parameter.name.upper()
        note = typer.Argument(
            metavar=metavar or (own if default is parameter.empty else f"[{own}]"), help=text
        )
    else:
        note = typer.Option(*names, metavar=metavar, help=text)
    made = parameter.replace(kind=parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, note])
    return made, parse


def _bare(kind: Any) -> Any:
    """Return a type without the None that it may also be."""
    if get_origin(kind) in (Union, UnionType):
        kind = next(each for each in get_args(kind) if each is not NoneType)
    return kind


def _count(kind: Any) -> int | None:
    """Return how many numbers a value has, or each of its values, if it is a tuple or a list of tuples."""
    kind = _bare(kind)
    if get_origin(kind) is list:
        kind = get_args(kind)[0]
    return len(get_args(kind)) if get_origin(kind) is tuple else None


def _vectors(count: int, option: str, given: Any) -> Any:
    if isinstance(given, list):
        return [tuple(numbers(text, count, option)) for text in given]
    return None if given is None else tuple(numbers(given, count, option))
