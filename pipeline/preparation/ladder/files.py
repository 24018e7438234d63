"""A ladder's files: data, table and picture, written as a whole or not at all."""

from __future__ import annotations

import csv
import json
from io import StringIO
from typing import TYPE_CHECKING

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg
from contactbench.pipeline.preparation.ladder.errors import LadderError
from contactbench.pipeline.preparation.ladder.picture import draw_ladder

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.preparation.ladder.ladder import Ladder


def save_ladder(ladder: Ladder, folder: Path) -> tuple[Path, ...]:
    """
    Write ladder.json, ladder.csv, ladder.svg and ladder.png.

    Parameters
    ----------
    ladder : Ladder
        What to write.
    folder : Path
        Exists; files that are there are replaced, each in one step.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    LadderError
        A file cannot be written; one that was there is left as it was.
    """
    contents = {
        "ladder.json": json.dumps(ladder.to_json(), indent=2, allow_nan=False).encode() + b"\n",
        "ladder.csv": _csv(ladder),
        "ladder.svg": draw_ladder(ladder, "svg"),
        "ladder.png": draw_ladder(ladder, "png"),
    }
    for name, data in contents.items():
        try:
            write_durably(folder / name, data)
        except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
            raise LadderError(
                f"{arg(folder / name)}: the file cannot be written ({arg(error)}): choose a folder that"
                " exists, is writable and has space."
            ) from error
    return tuple(folder / name for name in contents)


def _csv(ladder: Ladder) -> bytes:
    columns, rows = ladder.csv_rows()
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return text.getvalue().encode()
