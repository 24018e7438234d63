"""Steps of painting that outlive the window: in a file of the session's folder, bound to the regions they led to."""

from __future__ import annotations

import io
import json
import zipfile
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.regions.exchange import SIZE_LIMIT
from contactbench.pipeline.mesh.regions.history import RegionEdit, RegionSteps
from contactbench.pipeline.mesh.regions.region import Region

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.session import State

REGION_STEPS_FILE = "undo-regions.npz"
_VERSION, _MOST = 1, 200
_MOST_FACETS = 2**20  # of all steps together: written whenever somebody pauses


def write_region_steps(folder: Path, steps: RegionSteps, regions: str) -> None:
    """
    Write steps beside a session's journal; the oldest go where there are too many.

    A disk that takes nothing loses the steps, and nothing else.

    Parameters
    ----------
    folder : path
        Of the session.
    steps : RegionSteps
    regions : str
        SHA-256 of the regions in the session that they led to; see `regions_digest`.
    """
    steps = RegionSteps(_newest(steps.done), _newest(steps.undone))
    edits = (*steps.done, *steps.undone)
    about = {
        "version": _VERSION,
        "regions": regions,
        "done": len(steps.done),
        "steps": [_about(each) for each in edits],
    }
    arrays: dict[str, Any] = {
        "about": np.frombuffer(json.dumps(about, ensure_ascii=False).encode(), dtype=np.uint8),
        "faces": _joined((each.faces for each in edits), np.int32),
        "old": _joined((each.old for each in edits), np.uint8),
        "new": _joined((each.new for each in edits), np.uint8),
    }
    content = io.BytesIO()
    np.savez_compressed(content, allow_pickle=False, **arrays)
    try:
        write_durably(folder / REGION_STEPS_FILE, content.getvalue())
    except OSError:
        return


def read_region_steps(folder: Path, regions: str) -> RegionSteps:
    """
    Return the steps beside a session's journal; none where the file is missing, damaged, or led to other regions.

    Parameters
    ----------
    folder : path
    regions : str
        SHA-256 of the regions that the session has; see `regions_digest`.
    """
    try:
        with (folder / REGION_STEPS_FILE).open("rb") as stream:
            content = io.BytesIO(stream.read(SIZE_LIMIT))
        with np.load(content, allow_pickle=False) as arrays:
            about = json.loads(arrays["about"].tobytes())
            if about["version"] != _VERSION or about["regions"] != regions:
                return RegionSteps()
            faces, old, new = (arrays[name].astype(np.int32) for name in ("faces", "old", "new"))
        edits, begin = [], 0
        for each in about["steps"]:
            end = begin + int(each["facets"])
            edits.append(_edit(each, faces[begin:end], old[begin:end], new[begin:end]))
            begin = end
        done = int(about["done"])
    except (
        OSError,
        EOFError,
        ValueError,
        KeyError,
        TypeError,
        zipfile.BadZipFile,
        InputError,
        RecursionError,
    ):
        return RegionSteps()
    return RegionSteps(tuple(edits[:done]), tuple(edits[done:]))


def regions_digest(state: State) -> str:
    """Return the SHA-256 of the regions that a session keeps; empty: none."""
    kept = state.newest("regions")
    return "" if kept is None else kept.file.sha256


def _newest(edits: Sequence[RegionEdit]) -> tuple[RegionEdit, ...]:
    """Return the last ones that are not too many."""
    kept: list[RegionEdit] = []
    facets = 0
    for each in reversed(edits):
        facets += len(each.faces)
        if len(kept) == _MOST or facets > _MOST_FACETS:
            break
        kept.append(each)
    return tuple(reversed(kept))


def _joined(arrays: Iterable[NDArray[np.int32]], dtype: type[np.generic]) -> NDArray[Any]:
    return np.concatenate([np.empty(0, dtype=np.int32), *arrays]).astype(dtype)


def _about(edit: RegionEdit) -> dict[str, Any]:
    return {
        "text": edit.text,
        "key": edit.key,
        "before": [vars(each) for each in edit.before],
        "after": [vars(each) for each in edit.after],
        "table": None if edit.table is None else edit.table.tolist(),
        "facets": len(edit.faces),
    }


def _edit(
    about: dict[str, Any], faces: NDArray[np.int32], old: NDArray[np.int32], new: NDArray[np.int32]
) -> RegionEdit:
    before, after = (tuple(Region(**each) for each in about[name]) for name in ("before", "after"))
    table = None if about["table"] is None else np.array(about["table"], dtype=np.int32)
    return RegionEdit(str(about["text"]), before, after, table, faces, old, new, str(about["key"]))
