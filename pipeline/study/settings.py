"""What a person chooses for a study: the options of its command, which are also the command that repeats it."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any, cast

from pydantic import Field

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.knobs import Settings, knob

_SAVED = "Save the results in this folder, with a page of tables and plots."


class StudySettings(Settings):
    """What every study has."""

    out: Path | None = knob(None, _SAVED, metavar="DIR")

    def command(self, *given: str) -> str:
        """Return the command as it is typed, without the folders of files: `given` and what is not left out."""
        words = ["contactbench", "study", *given]
        for name, field in type(self).model_fields.items():
            value, extra = getattr(self, name), cast("dict[str, str]", field.json_schema_extra)
            option, _, no = extra["option"].partition("/")
            option = option or f"--{name.replace('_', '-')}"
            if name in _UNTOLD or value is None:
                continue
            if isinstance(value, bool):
                words += [option] if value and not no else [no] if not value and no else []
            else:
                for each in value if isinstance(value, tuple) else (value,):
                    words += [option, Path(str(each)).name]
        return shlex.join(words)


_UNTOLD = ("out", "workers", "scheduler", "part", "dry_run")  # the figures are the same with any


class SeededSettings(StudySettings):
    """What a study has that draws touches of its own."""

    seed: Annotated[int, Field(ge=0)] = knob(0, "Seed of the touches and the noise.")


class ProbesSettings(SeededSettings):
    """Whose probes are measured."""

    probe: tuple[str, ...] = knob(
        (), "Bundled probe or prepared .ply in S; may be repeated [the bundled ones]."
    )
    quick: bool = knob(False, "Quick look: few touches, coarse meshes.")


class StabilitySettings(ProbesSettings):
    """How much is tried of each figure of stability."""

    samples: int = knob(1_000, "Touches per figure, at least 50.")


class ConfidenceSettings(ProbesSettings):
    """How much is tried of each figure of confidence."""

    touches: Annotated[int, Field(ge=100)] | None = knob(None, "Touches for each figure and seed [10,000].")
    seeds: Annotated[int, Field(ge=1)] | None = knob(None, "Repetitions, for the spread [5].")


class SceneSettings(SeededSettings):
    """Which effects of which benches are taken apart."""

    probe: tuple[str, ...] = knob((), "Bundled probe; may be repeated [all].")
    seeds: int = knob(5, "Number of benches, with seeds from --seed on.")
    reality: tuple[str, ...] = knob(
        (), "Mix to take apart, MIX or EFFECT=SIZE,...; may be repeated [typical and harsh]."
    )
    moving: bool = knob(False, "Instead: leave out single effects of the platform and the arm.")
    period: float = knob(2.0, "With --moving: period of the platform's motion, s.")


class SweepSettings(StudySettings):
    """Which plan is swept, what of it is changed, and who computes it."""

    out: Path = knob(
        Path("contactbench-study"), "Folder for the results; finished cells are kept.", metavar="DIR"
    )
    preset: str | None = knob(None, "Instead of a file: one of paper, resolution, quick, steep.")
    probe: tuple[str, ...] = knob((), "Bundled probe or prepared .ply in S; may be repeated [the plan's].")
    workers: Annotated[int, Field(ge=1)] | None = knob(
        None,
        "Number of processes [one per core]. For timing use 1, because processes share the machine.",
    )
    scheduler: str | None = knob(None, "Address of a Dask scheduler, tcp://HOST:PORT [this machine].")
    touches: int | None = knob(None, "Touches per cell [the plan's].")
    seed: int | None = knob(None, "Seed of the touches [the plan's].")
    times: bool = knob(True, "Also measure times.", option="--times/--no-times")
    part: str | None = knob(
        None,
        "Compute only this of N parts, each on a machine of its own, into one shared folder [1/1].",
        metavar="K/N",
    )
    dry_run: bool = knob(False, "Measure a few cells, and estimate the time and memory of all.")

    @property
    def share(self) -> tuple[int, int]:
        """Which part of how many."""
        number, slash, of = (self.part or "1/1").partition("/")
        if not (
            slash and number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of) <= _MOST_PARTS
        ):
            raise InputError(
                f"--part {self.part}: give which of how many, such as 2/8, and at most {_MOST_PARTS:,}."
            )
        return int(number), int(of)


_MOST_PARTS = 1_000_000


def sized(sizes: Any, settings: StudySettings, *names: str) -> Any:
    """Return how much is measured, with what the settings say of it; what is None is left as it is."""
    from dataclasses import replace

    given = {name: getattr(settings, name) for name in names}
    return replace(sizes, **{name: value for name, value in given.items() if value is not None})
