"""How a setting is declared: its range, default, unit and sentence in one field. Quick to import."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from contactbench.pipeline.errors import InputError, arg

# Kilometres and whole turns are mistakes, and squares of much more overflow.
Number = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, le=1e6, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]
Three = tuple[Number, Number, Number]


@dataclass(frozen=True)
class Row:
    """How a form asks for a number, which has its unit from `knob`; in the annotation of the field."""

    title: str
    """What stands beside the field."""
    span: tuple[float, float]
    """The smallest and the largest number that it takes."""
    decimals: int = 0
    step: float = 1.0
    start: float = 0.0
    """What is offered where there is no default."""
    suffix: str = ""
    """What follows the number, where that is not its unit."""
    none: str = ""
    """What the smallest number stands for: that nothing is given."""


def knob(
    default: Any = ...,
    text: str = "",
    *,
    unit: str = "",
    scale: float = 1.0,
    none: str = "",
    why: str = "",
    metavar: str = "",
    option: str = "",
    hidden: bool = False,
) -> Any:
    """
    Return a field that a command has as an option.

    Parameters
    ----------
    default
        Left out: it must be given.
    text : str
        One sentence of help; the unit is put in where it ends.
    unit : str
        Of the number that a person reads and types.
    scale : float
        How many of that unit one of the field is: 1000 for a field in m that people give in mm.
    none : str
        What holds if the value is left out.
    why : str
        Why the default is what it is; for the documentation.
    metavar : str
        How a value is written on the command line, where that is not plain to see.
    option : str
        Its name on the command line, if it is not that of the field.
    hidden : bool
        Of earlier versions, and without effect.
    """
    return Field(
        default,
        description=text,
        json_schema_extra={
            "unit": unit, "scale": scale, "none": none, "why": why,
            "metavar": metavar, "option": option, "hidden": hidden,
        },
    )  # fmt: skip


def with_unit(text: str, unit: str, after: str = "") -> str:
    """Return a sentence of help with the unit, and what comes after it, at the end of its first sentence."""
    first, rest = (text.removesuffix("."), "") if ". " not in text else text.split(". ", 1)
    return f"{first}{f', {unit}' if unit else ''}{after}.{f' {rest}' if rest else ''}"


class Settings(BaseModel):
    """What is chosen for a step."""

    # Built when the first is made: most commands take a few of them.
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    overlay: ClassVar[bool] = False  # What a command is not given stays unset: a session may know it

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> Self:
        """Return settings; InputError, with the first that is wrong."""
        try:
            return cls.model_validate(dict(values))
        except ValidationError as error:
            where, what = first_fault(error)
            raise InputError(f"parameter {arg(where)}: {arg(what)}: correct it.") from error


def first_fault(error: ValidationError) -> tuple[str, str]:
    """Return the field that is wrong, and what is wrong with it."""
    first = error.errors(include_url=False)[0]
    raised = first.get("ctx", {}).get("error")  # of our own: its text is a message
    what = str(raised) if isinstance(raised, ValueError) else first["msg"]
    return ".".join(map(str, first["loc"])), what
