"""
What a real bench adds to the ideal one: each effect declared once, with its size, and off unless it is asked for.

An address takes it as ``reality=``, commands as ``--reality``, a study effect by effect. Here is what each is called,
what it means and how large it may be; what it does is in `contactbench.pipeline.simulation.reality`.
"""

from typing import Annotated, Self

from pydantic import Field, ValidationError

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.knobs import Settings, first_fault, knob


class Reality(Settings):
    """
    One field an effect, in the unit that its sentence begins with.

    What differs from bench to bench although it has the same size (where a marker lies, where the cable comes from) is
    drawn from the bench's seed, each effect from a stream of its own: to turn one on does not move another.
    """

    # What the sensor feels beside the touch and the weight.
    cable: Annotated[float, Field(ge=0, le=20)] = knob(
        0.0, "N: pull of the cable when the tool is turned away from the cable's free hanging direction."
    )
    drag: Annotated[float, Field(ge=0, le=1)] = knob(
        0.0, "share: of the cable's pull held by friction, so that it depends on the way the tool got there."
    )
    mount: Annotated[float, Field(ge=0, le=100)] = knob(
        0.0, "mrad/N·m: rotation of the probe against its sensor under a torque."
    )
    second: Annotated[float, Field(ge=0, le=1)] = knob(
        0.0, "share: a second tip presses with this part of the force, 30 mm away."
    )
    patch: Annotated[float, Field(ge=0, le=30)] = knob(
        0.0, "mm: radius of a soft pad that presses in place of the tip."
    )
    lean: Annotated[float, Field(ge=0, le=30)] = knob(0.0, "deg: tilt of the pad on the surface.")
    twist: Annotated[float, Field(ge=-1, le=1)] = knob(
        0.0, "share: of the pad's friction (0.4 times its pressure) used by a twist."
    )
    hand: Annotated[float, Field(ge=0, le=20)] = knob(
        0.0, "N: pull of an operator's hand at the handle while the probe is pressed, root mean square."
    )
    # What the sensor makes of it.
    hysteresis: Annotated[float, Field(ge=0, le=5)] = knob(
        0.0, "% of full scale: width of the loop between loading and unloading."
    )
    hysteresis_of_load: Annotated[float, Field(ge=0, le=5)] = knob(
        0.0, "% of the largest load so far: the same, growing with it."
    )
    creep: Annotated[float, Field(ge=0, le=5)] = knob(
        0.0, "% of a load: added to the reading after the load has stayed for minutes."
    )
    crosstalk: Annotated[float, Field(ge=0, le=10)] = knob(
        0.0, "% of a channel's load: crosstalk into the others."
    )
    warming: Annotated[float, Field(ge=-50, le=50)] = knob(
        0.0, "K: warming of the sensor after the calibration."
    )
    # What the probe is, against what the program is told.
    seat: Annotated[float, Field(ge=0, le=10)] = knob(
        0.0, "deg: error of the probe's declared rotation, with a shift of 1 mm per degree."
    )
    lens: Annotated[float, Field(ge=-3, le=3)] = knob(
        0.0, "mm: distance of the acoustic face outside its mesh."
    )
    scale: Annotated[float, Field(ge=0.9, le=1.1)] = knob(
        1.0, "times: size of the probe relative to its mesh."
    )
    bend: Annotated[float, Field(ge=0, le=10)] = knob(0.0, "deg: bend of the head against the handle.")
    # Where the tip touches.
    markers: Annotated[float, Field(ge=0, le=5)] = knob(
        0.0, "mm: position error of marked points, root mean square in each direction along the surface."
    )
    tip: Annotated[float, Field(ge=0, le=10)] = knob(
        0.0, "mm: radius of the ball aimed at a mark; a tilted one touches beside it by this times sin(tilt)."
    )
    # When samples come.
    latency: Annotated[float, Field(ge=0, le=500)] = knob(0.0, "ms: delay of the wrenches.")
    jitter: Annotated[float, Field(ge=0, le=100)] = knob(0.0, "ms: additional random delay, on average.")
    pose_latency: Annotated[float, Field(ge=0, le=500)] = knob(0.0, "ms: age of poses at their stated time.")

    @classmethod
    def parse(cls, text: str) -> Self:
        """
        Read a mix, effects with their sizes, or both: ``typical``, ``cable=0.2,mount=5``, ``harsh,cable=0``.

        Raises
        ------
        InputError
            A mix or an effect is unknown, twice there, or out of its range.
        """
        values: dict[str, float] = {}
        given: set[str] = set()
        for number, part in enumerate(each.strip() for each in text.split(",")):
            name, equals, size = (each.strip() for each in part.partition("="))
            if not equals:
                if number or name not in MIXES:
                    what = (
                        message(f"{arg(name)!r} must stand alone")
                        if number
                        else message(f"there is no mix {arg(name)!r}")
                    )
                    raise InputError(
                        f"reality: {arg(what)}: start with one of {arg(', '.join(MIXES))}, and write effects"
                        " as NAME=SIZE."
                    )
                values = MIXES[name].model_dump()
                continue
            if name not in cls.model_fields:
                raise InputError(
                    f"reality: there is no effect {arg(name)!r}: choose from {arg(', '.join(cls.model_fields))}."
                )
            if name in given:
                raise InputError(f"reality: {arg(name)} appears twice: keep one.")
            given.add(name)
            values[name] = _number(name, size)
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            where, what = first_fault(error)
            raise InputError(
                f"reality: {arg(where)} {arg(values[where]):g}: {arg(what)} ({arg(cls.unit(where))})."
            ) from error

    def __str__(self) -> str:
        """Return the shortest text that `parse` reads back: the nearest mix, and what differs from it."""
        texts = [_differences(name, mix, self) for name, mix in MIXES.items()]
        return min(texts, key=lambda text: (text.count(","), len(text)))

    @property
    def on(self) -> tuple[str, ...]:
        """The effects that are there."""
        fields = type(self).model_fields.items()
        return tuple(name for name, field in fields if getattr(self, name) != field.default)

    def only(self, *names: str) -> Self:
        """Return these effects alone."""
        return type(self)(**{name: getattr(self, name) for name in names})

    def without(self, *names: str) -> Self:
        """Return all but these effects."""
        return self.only(*(name for name in self.on if name not in names))

    @classmethod
    def unit(cls, name: str) -> str:
        """Return what an effect is measured in."""
        return str(cls.model_fields[name].description).partition(":")[0]

    @classmethod
    def limits(cls, name: str) -> tuple[float, float]:
        """Return the smallest and the largest size of an effect."""
        least, most = (
            next(getattr(each, end) for each in cls.model_fields[name].metadata if hasattr(each, end))
            for end in ("ge", "le")
        )
        return float(least), float(most)


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(
            f"reality: {arg(name)} {arg(text[:40])!r}: give a number, {arg(Reality.unit(name))}."
        ) from None


def _differences(name: str, mix: Reality, wanted: Reality) -> str:
    fields = [field for field in Reality.model_fields if getattr(mix, field) != getattr(wanted, field)]
    sizes = [f"{field}={_written(getattr(wanted, field))}" for field in fields]
    return ",".join(sizes if name == "ideal" and sizes else [name, *sizes])


def _written(size: float) -> str:
    return str(int(size)) if size.is_integer() else repr(size)


# A decent bench: a sensor of a good make that has warmed up, a cable led along the arm, a housing that was measured,
# markers set with a ruler. A harsh one: what is found where nobody has looked for any of it.
_TYPICAL = Reality(
    cable=0.05,
    drag=0.3,
    mount=1.5,
    hysteresis=0.005,
    hysteresis_of_load=0.05,
    creep=0.02,
    crosstalk=0.1,
    warming=1.0,
    seat=0.3,
    lens=0.1,
    scale=1.0005,
    bend=0.05,
    markers=0.3,
    tip=0.5,
    latency=3.0,
    jitter=1.0,
    pose_latency=8.0,
)
MIXES: dict[str, Reality] = {
    "ideal": Reality(),
    "typical": _TYPICAL,
    "harsh": Reality(
        cable=0.3,
        drag=0.5,
        mount=6.0,
        hand=0.1,
        hysteresis=0.02,
        hysteresis_of_load=0.1,
        creep=0.1,
        crosstalk=0.5,
        warming=4.0,
        seat=1.0,
        lens=0.5,
        scale=1.002,
        bend=0.5,
        markers=0.8,
        tip=1.5,
        latency=10.0,
        jitter=5.0,
        pose_latency=30.0,
    ),
    "tissue": _TYPICAL.model_copy(update={"patch": 15.0, "twist": 0.5, "lean": 3.0}),
}
