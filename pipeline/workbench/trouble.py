"""
What is wrong with a session just now: the one place that knows it.

Steps, pages and the export all say it in these words. What a result itself says, such as that it did not pass, and what
is stale are no trouble: nothing is broken then.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import message
from contactbench.pipeline.session.actions import files_of
from contactbench.pipeline.session.check import file_problem
from contactbench.pipeline.session.state import Result

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from contactbench.pipeline.session import State
    from contactbench.pipeline.session.actions import FileRef
    from contactbench.pipeline.session.state import Input

DISK = message(
    "The last write failed, so nothing is written to this session at the moment. Free disk space,"
    " or check the disk; writing then resumes automatically."
)


@dataclass(frozen=True)
class SessionTrouble:
    """What is wrong, in sentences that say the remedy; empty ones: nothing."""

    disk: str = ""  # Why nothing is written
    devices: str = ""  # Why no readings, or no poses, come
    files: Mapping[str, str] = field(default_factory=dict)  # Place of a file -> what is wrong with it

    @property
    def sentences(self) -> tuple[str, ...]:
        """All of it."""
        return tuple(filter(None, (self.disk, self.devices, *self.files.values())))

    def behind(self, state: State, found: Result | Input | None) -> str:
        """Return what is wrong with a result, with an input, or with anything that it was computed from."""
        if found is None or not self.files:
            return ""
        return next(
            (self.files[ref.path] for ref in files_behind(state, found) if ref.path in self.files), ""
        )


NO_TROUBLE = SessionTrouble()


def files_behind(state: State, found: Result | Input) -> Iterator[FileRef]:
    """Yield the files of a result or an input, then of all that it was computed from."""
    waiting, met = [found], set[int]()
    while waiting:
        each = waiting.pop(0)
        if each.number in met:
            continue
        met.add(each.number)
        if not isinstance(each, Result):
            yield from (each.file, *each.companions.values())
            continue
        yield from each.action.files.values()
        for sha256 in each.action.inputs.values():
            sources = (state.input_with(sha256, each.number), state.result_with(sha256, each.number))
            waiting += [source for source in sources if source is not None]


class FileWatch:
    """
    Looks at the files of a session: the first time at every byte, after that at those that were touched since.

    Parameters
    ----------
    folder : Path
        Of the session.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._seen: dict[str, tuple[tuple[int, int, int] | None, str]] = {}

    def look(self, state: State, cancelled: Callable[[], bool] = lambda: False) -> dict[str, str]:
        """Return what is wrong: place of a file -> sentence. Stopped, it knows the rest as it was before."""
        refs = {ref.path: ref for each in state.inputs for ref in (each.file, *each.companions.values())}
        refs |= {ref.path: ref for each in state.results for ref in files_of(each.action)}
        for place, ref in refs.items():
            if cancelled():
                break
            mark = self._mark(place)
            if place not in self._seen or self._seen[place][0] != mark:
                self._seen[place] = (mark, file_problem(self._folder, ref))
        return {place: why for place, (_, why) in self._seen.items() if why and place in refs}

    def _mark(self, place: str) -> tuple[int, int, int] | None:
        """Return what changes when a file is touched; None: it is not there."""
        try:
            found = (self._folder / place).lstat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_size, found.st_ino
