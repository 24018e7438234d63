"""The truth beside every wrench, as a table."""

from __future__ import annotations

import csv
import json
from typing import TYPE_CHECKING

from contactbench.pipeline.simulation.virtual.commands import command_fields

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TextIO

    from contactbench.pipeline.simulation.scenes import SceneMoment
    from contactbench.pipeline.simulation.virtual.given import Batch, Done

COLUMNS = (
    "time_s",
    "sequence",
    *(f"true_{part}" for part in ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")),
    *(f"contact_{part}" for part in ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")),
    "contacts",
    *(f"centroid_{axis}_m" for axis in "xyz"),
    *(f"point_{axis}_m" for axis in "xyz"),
    *(f"normal_{axis}" for axis in "xyz"),
    "torsion_Nm",
    *(f"R_WS_{row}{column}" for row in range(3) for column in range(3)),
    "command",
)


class TruthTable:
    """
    Writes the truth as it comes; everything in S, what is not there is empty.

    A command is in the first row from its time on, as JSON: also the ones that nobody else is told.

    Parameters
    ----------
    file : text file
        Opened with ``newline=""``.
    """

    def __init__(self, file: TextIO) -> None:
        self._rows = csv.writer(file, lineterminator="\n")
        self._rows.writerow(COLUMNS)
        self._waiting: list[Done] = []

    def add(self, batch: Batch) -> None:
        """Write what is true of each wrench of a batch."""
        self._waiting += batch.done
        for sample, truth in zip(batch.wrenches, batch.truths, strict=True):
            now = [done for done in self._waiting if done.time <= truth.time + 1e-9]
            self._waiting = self._waiting[len(now) :]
            commands = [{"at": done.time} | command_fields(done.command) for done in now]
            self._rows.writerow(
                [
                    f"{truth.time:.6f}",
                    sample.sequence,
                    *_numbers(truth),
                    json.dumps(commands) if commands else "",
                ]
            )


def _numbers(truth: SceneMoment) -> list[str]:
    if truth.contacts == 0:
        contact: list[str] = [""] * 10
    else:
        places = [*truth.centroid_S, *truth.point_S, *truth.normal_S, truth.torsion]
        contact = _written(places)
    return [
        *_written(truth.reading.tolist()),
        *_written(truth.contact.tolist()),
        str(truth.contacts),
        *contact,
        *_written(truth.R_WS.ravel().tolist()),
    ]


def _written(values: Sequence[float]) -> list[str]:
    return [f"{value:.9g}" for value in values]
