"""The options of an address: what follows its question mark."""

from __future__ import annotations

import math
from dataclasses import dataclass
from urllib.parse import parse_qsl

from contactbench.pipeline.errors import InputError


class AddressError(InputError):
    """An address that names no device; the message names the part and the remedy."""


def read_options(query: str, known: tuple[str, ...], text: str) -> dict[str, str]:
    """
    Return the options of a query, each of which must be known.

    Raises
    ------
    AddressError
        It cannot be read, or has an unknown option, or one twice.
    """
    found: dict[str, str] = {}
    try:
        pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), errors="strict")
    except ValueError as error:
        raise AddressError(
            f"address {text!r}: options: {error}: write them as ?name=value&name=value."
        ) from error
    for name, value in pairs:
        if name not in known:
            allowed = ", ".join(known)
            raise AddressError(f"address {text!r}: option {name!r} is unknown here: it can have {allowed}.")
        if name in found:
            raise AddressError(f"address {text!r}: option {name!r} is there twice: keep one.")
        found[name] = value
    return found


def number_option(
    options: dict[str, str], name: str, default: float | None, unit: str, text: str
) -> float | None:
    """
    Return an option that is a positive number of a unit, or the default where it is left out.

    Raises
    ------
    AddressError
        It is none.
    """
    if name not in options:
        return default
    try:
        value = float(options[name])
    except ValueError:
        value = math.nan
    if not 1e-3 <= value <= 1e9:
        raise AddressError(f"address {text!r}: {name} {options[name]!r}: give a positive number of {unit}.")
    return value


def name_option(options: dict[str, str], name: str, text: str) -> str | None:
    """
    Return an option that is a name, or None where it is left out.

    Raises
    ------
    AddressError
        It is empty, or cannot be printed.
    """
    value = options.get(name)
    if value is not None and (not value.strip() or not value.isprintable()):
        raise AddressError(f"address {text!r}: {name} {value!r}: give its name, or leave the option out.")
    return value


def numbers_option(
    options: dict[str, str], name: str, counts: tuple[int, int], most: float, text: str
) -> tuple[float, ...] | None:
    """
    Return an option of numbers between commas, or None where it is left out.

    `counts` is how many there are at least and at most; none of them is beyond `most` either way.

    Raises
    ------
    AddressError
        It is not that.
    """
    if name not in options:
        return None
    cells = options[name].split(",")[: counts[1] + 1]
    try:
        values = tuple(map(float, cells))
    except ValueError:
        values = ()
    if not counts[0] <= len(values) <= counts[1] or not all(abs(value) <= most for value in values):
        many = str(counts[0]) if counts[0] == counts[1] else f"{counts[0]} to {counts[1]}"
        raise AddressError(
            f"address {text!r}: {name} {options[name][:80]!r}: give {many} numbers with commas between them, none"
            f" beyond {most:g}."
        )
    return values


BENCH_OPTIONS = ("probe", "mesh", "sensor", "seed", "rate", "pose_rate", "script", "speed")
_FASTEST_BENCH_HZ = 1000.0


@dataclass(frozen=True)
class BenchOptions:
    """What a virtual bench is made of; names are looked up by who opens it."""

    probe: str = "t-shape"  # name of a bundled probe
    mesh: str | None = None  # file of a probe to take instead, in metres and S
    sensor: str = "paper"  # name of a preset
    seed: int = 0  # of the noise
    pose_rate: float = 50.0  # poses a second
    script: str | None = None  # file of timed commands

    def values(self) -> dict[str, object]:
        """Return the options as they are written in an address."""
        probe = None if self.mesh is not None else self.probe
        return {
            "probe": probe,
            "mesh": self.mesh,
            "sensor": self.sensor,
            "seed": self.seed,
            "pose_rate": self.pose_rate,
            "script": self.script,
        }


def bench_options(options: dict[str, str], text: str) -> BenchOptions:
    """
    Return what an address says of a virtual bench.

    Raises
    ------
    AddressError
        An option is not what it should be, or two contradict each other.
    """
    if "probe" in options and "mesh" in options:
        raise AddressError(f"address {text!r}: probe and mesh: a bench has one of them.")
    seed = options.get("seed", "0")
    if not (seed.isascii() and seed.isdigit() and len(seed) <= 15):
        raise AddressError(f"address {text!r}: seed {seed!r}: give a whole number of 0 or more.")
    pose_rate = number_option(options, "pose_rate", 50.0, "Hz", text) or 50.0
    rate = number_option(options, "rate", None, "Hz", text)
    for name, value in (("rate", rate), ("pose_rate", pose_rate)):
        if value is not None and value > _FASTEST_BENCH_HZ:
            raise AddressError(f"address {text!r}: {name}: the bench gives at most {_FASTEST_BENCH_HZ:g} Hz.")
    return BenchOptions(
        probe=name_option(options, "probe", text) or "t-shape",
        mesh=name_option(options, "mesh", text),
        sensor=name_option(options, "sensor", text) or "paper",
        seed=int(seed),
        pose_rate=pose_rate,
        script=name_option(options, "script", text),
    )
