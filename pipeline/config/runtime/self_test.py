"""
``self_test.csv``: samples in a bundle, and the answers that every runtime must give to them; see docs/bundle.md.

A runtime that answers otherwise is another one than the bundle is for, or somebody edited the bundle.
"""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256
from math import isfinite, isnan, nan
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from contactbench.pipeline.config.runtime.model import RuntimeModel, SelfTestPart
from contactbench.pipeline.config.runtime.pack import SELF_TEST
from contactbench.pipeline.config.runtime.synthetic import Row, StreamPose, StreamSample, synthetic_stream
from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.errors import ConfigError, arg, message

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from contactbench.pipeline import kernel
    from contactbench.pipeline.config.runtime.config import RuntimeConfig

SAMPLES: Final = 300
_TOLERANCE = 1e-9  # other processors and libraries round otherwise
_DECIMALS = 12
_AGAIN = message("Export the config again.")
_MOST_FLAGS = 255
_LARGEST = 4 * 2**20

_POSE = ("pose", "time_s", *(f"R{row}{column}" for row in "123" for column in "123"), "x_m", "y_m", "z_m")
_INPUTS = ("sample", "time_s", "arrival_s", "flags", "Fx_N", "Fy_N", "Fz_N", "Mx_Nm", "My_Nm", "Mz_Nm")
_NAMES = ("reason", "accepted", "health")
_NUMBERS = (
    "pose_age_s",
    *(
        f"{what}_{axis}_{unit}"
        for what, unit in (("force", "N"), ("torque", "Nm"), ("point", "m"))
        for axis in "xyz"
    ),
    *(f"normal_{axis}" for axis in "xyz"),
    *(f"{what}_{axis}_m" for what in ("filtered", "second", "sigma") for axis in "xyz"),
    "confidence",
    "misfit",
    "left_over_Nm",
)
_SAMPLE = (*_INPUTS, *_NAMES, *_NUMBERS)
_HEAD = (",".join(_POSE), ",".join(_SAMPLE))


def with_self_test(config: RuntimeConfig) -> RuntimeConfig:
    """Return a config with test vectors, made by the runtime of this contactbench."""
    data = _encoded(config)
    model, files = config.model, dict(sorted({**config.files, SELF_TEST: data}.items()))
    hashes = {**model.provenance.files, SELF_TEST: sha256(data).hexdigest()}
    part = SelfTestPart(file=SELF_TEST, samples=SAMPLES)
    provenance = model.provenance.model_copy(update={"files": hashes})
    model = model.model_copy(update={"self_test": part, "provenance": provenance})
    return replace(config, model=model, files=MappingProxyType(files))


def check_self_test(model: RuntimeModel, files: Mapping[str, bytes]) -> None:
    """Refuse a model that says something else of test vectors than the files; ConfigError."""
    told = None if model.self_test is None else model.self_test.file
    if told != (SELF_TEST if SELF_TEST in files else None):
        raise ConfigError(
            f"self_test.file is {arg(told)!r}, and that is not what the bundle holds. {arg(_AGAIN)}"
        )


def replay(config: RuntimeConfig, name: str) -> int | None:
    """
    Replay a config's test vectors.

    Parameters
    ----------
    config : RuntimeConfig
    name : str
        What messages call the bundle.

    Returns
    -------
    int or None
        How many samples there were; None where the config has no test vectors.

    Raises
    ------
    ConfigError
        The file is none of this kind, or the runtime gives another answer; names the first line that differs, and how
        far contacts moved.
    """
    part = config.model.self_test
    if part is None:
        return None
    where = f"{name}: {part.file}"
    lines = _lines_of(config.files[part.file], where)
    rows = [_row_of(cells, where, line) for line, cells in lines]
    samples = sum(isinstance(row, StreamSample) for row in rows)
    if samples != part.samples:
        raise ConfigError(
            f"{arg(where)}: there are {arg(samples)} samples, but self_test.samples is {arg(part.samples)}."
            f" {arg(_AGAIN)}"
        )
    first, differing, moved = "", 0, 0.0
    for (line, cells), contact in zip(lines, _answers(config, rows), strict=True):
        if contact is not None and (found := _difference(cells[len(_INPUTS) :], contact)):
            first, differing = (
                first or message(f"{arg(where)}: line {arg(line)}: {arg(found)}"),
                differing + 1,
            )
            moved = max(moved, _moved(cells[len(_INPUTS) + len(_NAMES) :], contact))
    if first:
        raise ConfigError(
            f"{arg(first)}: the bundle was edited, or is for another runtime: {arg(differing)} of {arg(samples)}"
            f" answers differ, and contacts moved by up to {arg(1e3 * moved):.3g} mm. Export the config again with"
            " this contactbench."
        )
    return samples


# ---- parts -------------------------------------------------------------------------------------


def _encoded(config: RuntimeConfig) -> bytes:
    """Return a synthetic stream, and what the runtime says of it."""
    lines = list(_HEAD)
    rows = synthetic_stream(config, SAMPLES)
    for row, contact in zip(rows, _answers(config, rows), strict=True):
        if isinstance(row, StreamPose):
            lines.append(",".join(["pose", *map(_cell, (row.time, *row.R, *row.p))]))
        elif contact is not None:
            given = ["sample", _cell(row.time), _cell(row.arrival), str(row.flags), *map(_cell, row.wrench)]
            numbers = (_cell(round(value, _DECIMALS)) for value in _numbers_of(contact))
            lines.append(",".join([*given, *_names_of(contact), *numbers]))
    return ("\n".join(lines) + "\n").encode("ascii")


def _answers(config: RuntimeConfig, rows: list[Row]) -> Iterator[kernel.RuntimeContact | None]:
    runtime = make_runtime(config)
    for row in rows:
        if isinstance(row, StreamSample):
            yield runtime.locate(np.array(row.wrench), row.time, row.arrival, row.flags)
        else:
            runtime.pose(np.array(row.R).reshape(3, 3), np.array(row.p), row.time)
            yield None


def _names_of(contact: kernel.RuntimeContact) -> tuple[str, ...]:
    return contact.reason_name, str(int(contact.accepted)), str(contact.health)


def _numbers_of(contact: kernel.RuntimeContact) -> tuple[float, ...]:
    covariance = contact.covariance
    sigmas = None if covariance is None else np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return (
        contact.pose_age,
        *_many(contact.wrench, 6),
        *_many(contact.point, 3),
        *_many(contact.normal, 3),
        *_many(contact.filtered_point, 3),
        *_many(contact.second, 3),
        *_many(sigmas, 3),
        contact.confidence,
        contact.misfit,
        contact.left_over,
    )


def _many(values: NDArray[np.float64] | None, count: int) -> list[float]:
    return [nan] * count if values is None else values.tolist()


def _cell(value: float) -> str:
    return repr(value) if isfinite(value) else ""


def _lines_of(data: bytes, where: str) -> list[tuple[int, list[str]]]:
    """Return line numbers and cells."""
    if len(data) > _LARGEST:
        raise ConfigError(f"{arg(where)}: the file is larger than {arg(_LARGEST >> 20)} MiB. {arg(_AGAIN)}")
    if not data.isascii() or not data.endswith(b"\n"):
        raise ConfigError(f"{arg(where)}: this is not ASCII, or its last line has no end. {arg(_AGAIN)}")
    lines = data.decode("ascii").split("\n")[:-1]
    if tuple(lines[:2]) != _HEAD:
        raise ConfigError(f"{arg(where)}: the first two lines are not those of test vectors. {arg(_AGAIN)}")
    return [(number, line.split(",")) for number, line in enumerate(lines[2:], 3)]


def _row_of(cells: list[str], where: str, line: int) -> Row:
    kinds = {"pose": _POSE, "sample": _SAMPLE}
    columns = kinds.get(cells[0])
    if columns is None or len(cells) != len(columns):
        raise ConfigError(f"{arg(where)}: line {arg(line)} is neither a pose nor a sample. {arg(_AGAIN)}")
    try:
        if columns is _POSE:
            time, *numbers = (_number(cell) for cell in cells[1:])
            return StreamPose(time, tuple(numbers[:9]), tuple(numbers[9:]))
        time, arrival = _number(cells[1]), _number(cells[2])
        for cell in cells[len(_INPUTS) + len(_NAMES) :]:
            _number(cell)
        return StreamSample(
            time, arrival, _flags(cells[3]), tuple(_number(cell) for cell in cells[4 : len(_INPUTS)])
        )
    except ValueError as error:
        raise ConfigError(
            f"{arg(where)}: line {arg(line)} holds something other than a number ({arg(str(error)[:60])})."
            f" {arg(_AGAIN)}"
        ) from None


def _number(cell: str) -> float:
    if not cell:
        return nan
    value = float(cell)
    # In the one spelling: readers differ in what else they take for a number.
    if not isfinite(value) or repr(value) != cell:
        raise ValueError(repr(cell))
    return value


def _flags(cell: str) -> int:
    flags = int(cell)
    if not 0 <= flags <= _MOST_FLAGS or str(flags) != cell:
        raise ValueError(repr(cell))
    return flags


def _difference(told: list[str], contact: kernel.RuntimeContact) -> str:
    """Say which of the answers in a line is not the runtime's; empty: none."""
    answers: tuple[str | float, ...] = (*_names_of(contact), *_numbers_of(contact))
    for column, cell, here in zip((*_NAMES, *_NUMBERS), told, answers, strict=True):
        if not (cell == here if isinstance(here, str) else _near(_number(cell), here)):
            shown = here if isinstance(here, str) else _cell(here)
            return message(
                f"{arg(column)} is {arg(cell or 'empty'):.40}, but this runtime says {arg(shown or 'nothing')}"
            )
    return ""


def _moved(numbers: list[str], contact: kernel.RuntimeContact) -> float:
    """Return how far the point of a contact is from the one in a line, m; 0 where one of them has none."""
    begin = _NUMBERS.index("point_x_m")
    told = [_number(cell) for cell in numbers[begin : begin + 3]]
    return float(np.nan_to_num(np.linalg.norm(np.subtract(told, _many(contact.point, 3)))))


def _near(told: float, here: float) -> bool:
    if isnan(told) or not isfinite(here):
        return isnan(told) and not isfinite(here)
    return abs(told - here) <= _TOLERANCE * max(1.0, abs(told))
