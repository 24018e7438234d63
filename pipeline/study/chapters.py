"""What the chapters of the results page share: tables and pictures put together, and how pictures look."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

# Okabe and Ito: everybody can tell them apart.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#6b6b6b", "#000000")
STYLE: dict[Any, Any] = {
    "font.size": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e3e5e7",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.0,
    "legend.frameon": False,
}


def chapter(
    title: str,
    about: str,
    tables: Sequence[tuple[str, str]],
    pictures: Mapping[str, bytes],
    said: Mapping[str, str],
    folder: Path,
) -> str:
    """
    Write pictures into a folder and return a chapter: a heading, what it is about, tables, pictures with captions.

    Parameters
    ----------
    title, about : str
    tables : sequence of (str, str)
        Titles and Markdown.
    pictures : mapping
        File name -> PNG.
    said : mapping
        File name -> caption.
    folder : Path

    Raises
    ------
    InputError
        A picture cannot be written.
    """
    parts = [f"## {title}", about]
    for heading, text in tables:
        parts += [f"### {heading}", text]
    for name, data in pictures.items():
        try:
            write_durably(folder / name, data)
        except OSError as error:
            raise InputError(
                f"{folder / name}: cannot be written ({error}): choose another folder."
            ) from error
        parts.append(f"![{said[name]}]({name})\n\n{said[name]}")
    return "\n\n".join(parts)


def png(figure: Any) -> bytes:
    """Return a Matplotlib figure as a PNG image; the same figure gives the same bytes."""
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()
