"""Options of a command, made of settings: each field becomes one, with its sentence, its default and its name."""

import inspect
from collections.abc import Callable
from enum import StrEnum
from functools import partial
from types import GenericAlias, NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import typer
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.knobs import Settings, first_fault, with_unit
from contactbench.pipeline.parameter_options import numbers


def options_of(model: type[Settings]) -> tuple[Callable[..., Settings], list[inspect.Parameter]]:
    """Return what makes settings of options, and the options: of all fields that have a sentence."""
    told = [name for name, field in model.model_fields.items() if field.description is not None]
    return partial(_chosen, model), [_option(model, name) for name in told]


def _option(model: type[Settings], name: str) -> inspect.Parameter:
    """Return the option of one field: numbers are written between commas, and a choice by its name."""
    field = model.model_fields[name]
    extra: Any = field.json_schema_extra
    kind, default = _kind_of(field), None if field.is_required() else field.default
    otherwise = default_text(field) if extra["none"] or extra["unit"] or model.overlay else ""
    if otherwise or model.overlay or default == ():
        default = None
    elif isinstance(default, tuple):
        default = ",".join(f"{number:g}" for number in default)
    elif default is not None and get_origin(_bare(field)) is Literal:
        default = kind(default)
    # Without a name of its own, an option that is only given or not would also have a --no-name.
    names = (
        (extra["option"] or option_name(name, field)).split(",") if kind is bool or extra["option"] else []
    )
    text = field.description or ""
    option = typer.Option(
        *names,
        metavar=extra["metavar"] or None,
        help=with_unit(text, extra["unit"], f" [{otherwise}]" if otherwise else ""),
        hidden=extra["hidden"],
    )
    if field.is_required():
        default = inspect.Parameter.empty
    elif default is None:
        kind = kind | None
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option]
    )


def default_text(field: FieldInfo) -> str:
    """Return what holds where a field is left out, in its unit; empty: nothing, or it may not be left out."""
    extra: Any = field.json_schema_extra
    if extra["none"] or field.is_required() or field.default is None:
        return str(extra["none"])
    return f"{extra['scale'] * field.default:g}" if isinstance(field.default, float) else str(field.default)


def _bare(field: FieldInfo) -> Any:
    """Return the type of a field, without its range, and whether it may be left out."""
    kind: Any = field.annotation
    if get_origin(kind) in (Union, UnionType):
        kind = next(each for each in get_args(kind) if each is not NoneType)
    while get_origin(kind) is Annotated:
        kind = get_args(kind)[0]
    return kind


def _kind_of(field: FieldInfo) -> Any:
    """Return what the command line takes for a field."""
    extra: Any = field.json_schema_extra
    kind = _bare(field)
    if get_origin(kind) is tuple and get_args(kind)[-1] is Ellipsis:
        item = get_args(kind)[0]
        return GenericAlias(list, (item if item is str else _choice(item),))
    return _choice(kind) if get_origin(kind) is Literal else str if extra["metavar"] else kind


def _choice(kind: Any) -> Any:
    return StrEnum("Choice", {each: each for each in get_args(kind)})


def option_name(name: str, field: FieldInfo) -> str:
    """Return what a field is called on the command line."""
    extra: Any = field.json_schema_extra
    return extra["option"].partition("/")[0] or f"--{name.replace('_', '-')}"


def _chosen(model: type[Settings], **given: Any) -> Settings:
    """Return settings from options; InputError if one is wrong."""
    values: dict[str, Any] = {}
    for name, value in given.items():
        field = model.model_fields[name]
        if isinstance(value, str) and get_origin(_bare(field)) is tuple:
            values[name] = numbers(value, len(get_args(_bare(field))), option_name(name, field))
        elif isinstance(value, float):
            extra: Any = field.json_schema_extra
            values[name] = value / extra["scale"]
        elif value is not None:
            values[name] = (
                [getattr(each, "value", each) for each in value] if isinstance(value, list) else value
            )
    try:
        return model.model_validate({n: v.value if isinstance(v, StrEnum) else v for n, v in values.items()})
    except ValidationError as error:
        where, what = first_fault(error)
        name = where.partition(".")[0]
        option = option_name(name, model.model_fields[name])
        raise InputError(f"{arg(option)}: {arg(what)}: correct it.") from None
