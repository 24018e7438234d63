"""Locate the contact of every wrench in a file, whatever its size, and write a file of contacts."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Protocol, TypeVar

import numpy as np

from contactbench.pipeline.contact.contact_csv import HEADER, REASONS, ContactRows
from contactbench.pipeline.contact.facet_marks import INVENTED, MARKS, UNTOUCHABLE, facet_marks
from contactbench.pipeline.contact.plausibility import Plausibility, Sample, unexplained
from contactbench.pipeline.contact.wrench_csv import WrenchBlock, WrenchFileError, WrenchReader
from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.tables import BLOCK_BYTES, open_table

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.contact.patch import PatchReader
    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.mesh import Probe

__all__ = ["LocateSummary", "WrenchFileError", "ahead", "locate_file", "refuse_overwriting", "whole_output"]

_Block = TypeVar("_Block")
_Done = TypeVar("_Done")


class Locator(Protocol):
    """A solver or a method."""

    def locate_batch(self, wrenches: npt.NDArray[np.float64], /) -> Batch:
        """Locate each row of (n, 6) on its own."""


@dataclass(frozen=True)
class LocateSummary:
    """What came of a file."""

    rows: int  # Wrenches read and answered
    reasons: dict[str, int]  # Answers per reason, every reason named, in lower case
    method: str  # Who answered
    # Median of the largest standard deviation of the points, mm, to four digits; None without points
    median_sigma_max_mm: float | None
    # Contacts on facets that were made up, and on those of regions that nothing can touch
    on_invented: int
    on_untouchable: int
    # Least and largest torsion arm that rows were judged by, mm, where the rows are a stream and it is learned
    torsion_arm_mm: tuple[float, float] | None
    seconds: float  # From the first byte read to the last one written
    warnings: tuple[str, ...] = ()  # What should make one doubt the answers: sentences with a remedy
    # What may be wrong, where no touch explains more than half of the rows with force
    plausibility: Plausibility | None = None

    @property
    def rows_per_second(self) -> float:
        """Rows per second of wall time."""
        return self.rows / max(self.seconds, 1e-9)

    def facts(self) -> dict[str, Any]:
        """Return everything as values that JSON knows."""
        return {
            **asdict(self),
            "rows_per_second": self.rows_per_second,
            "warnings": list(self.warnings),
            "plausibility": None if self.plausibility is None else self.plausibility.facts(),
        }


def locate_file(
    solver_or_method: Locator,
    source: Path | BinaryIO,
    out: Path | BinaryIO,
    *,
    track: bool = False,
    allow_nan: bool = False,
    compensated: bool = False,
    probe: Probe | None = None,
    patches: PatchReader | None = None,
    progress: Progress = unheard,
    block_bytes: int = BLOCK_BYTES,
) -> LocateSummary:
    """
    Locate the contact of each row of a CSV file.

    The file is read in blocks, so that it may be larger than the memory. The output appears as a whole or
    not at all: a file that was there stays untouched until the last row is written.

    Parameters
    ----------
    solver_or_method : ContactSolver or ContactMethod
        Whose ``locate_batch`` answers.
    source : path or binary file
        Columns t, fx, fy, fz, mx, my, mz in any order, others are ignored; s, N and N·m about the sensor
        origin, in S. Columns that only a raw recording has are refused.
    out : path or binary file
        Gets columns t, x, y, z (S, m), k (N·m), face, reason, candidates, sigma_max_mm, misfit (sigma squared),
        confidence, on (what the facet is: measured, invented or untouchable); cells are empty where there is no such
        number, t is the text of the input, numbers are as ``repr`` writes them.
    track : bool
        Take the rows as one stream in which each contact follows the one before (``track_batch`` of a
        ContactSolver, which is reset first), and, unless the solver's model says otherwise, torsion is learned.
        A row whose t is not later than every t before it is answered with ``stale``.
    allow_nan : bool
        Answer rows with NaN, infinity or empty cells with ``not_finite`` instead of refusing the file.
    compensated : bool
        Take a file with the columns of a raw recording: somebody compensated it and left them in.
    probe : Probe, optional
        What is touched; that of the solver by default. Where it is given and no touch explains more than half of the
        rows with force, the usual mistakes are tried.
    patches : PatchReader, optional
        What each accepted contact says of the area that touches: its columns more. Some milliseconds a row.
    progress : callable, optional
        Called after each block with the bytes read and the size of the source (0 if that is unknown).
    block_bytes : int
        How much is read at a time. The output does not depend on it.

    Returns
    -------
    LocateSummary

    Raises
    ------
    WrenchFileError
        The source cannot be used, is a raw recording, or the output cannot be written; the message names file,
        line and column.
    InputError
        `track` with a method that cannot.
    """
    answer = _tracked(solver_or_method) if track else _Untracked(solver_or_method)
    refuse_overwriting(out, source)
    begin = time.perf_counter()
    surface = getattr(solver_or_method, "probe", None) if probe is None else probe
    tally, sample, mark = _Tally(), Sample(), _Marker(surface)
    with open_table(source, WrenchFileError) as (stream, name, size), whole_output(out, "contacts") as write:
        reader = WrenchReader(stream, name, timed=track, allow_nan=allow_nan, block_bytes=block_bytes)
        if not compensated:
            reader.refuse_raw()
        write(HEADER if patches is None else HEADER.rstrip() + b"," + patches.header)
        text = ContactRows()
        for rows, answers in ahead(reader, answer):
            sigma_mm = answers.sigma_max * 1e3
            marks = mark(answers.faces)
            more = None if patches is None else patches.rows(rows.wrenches, answers)
            write(text.encode(rows.times, answers, sigma_mm, marks, more))
            tally.add(answers.reasons, sigma_mm, marks)
            sample.add(rows.wrenches, answers.reasons)
            progress(reader.bytes_read, size)
    judged = None
    if probe is not None and unexplained(tally.reasons):
        judged = sample.judge(solver_or_method, probe)
    return LocateSummary(
        rows=sum(tally.reasons.values()),
        reasons=tally.reasons,
        method=str(getattr(solver_or_method, "name", "contactbench")),
        median_sigma_max_mm=tally.median(),
        on_invented=tally.on[INVENTED],
        on_untouchable=tally.on[UNTOUCHABLE],
        torsion_arm_mm=answer.torsion_arm_mm,
        seconds=time.perf_counter() - begin,
        warnings=(*answer.warnings(), *tally.warnings(), *(() if judged is None else judged.sentences())),
        plausibility=judged,
    )


# ---- answering ---------------------------------------------------------------------------------


class _Untracked:
    torsion_arm_mm: tuple[float, float] | None = None

    def __init__(self, locator: Locator) -> None:
        self._locator = locator

    def __call__(self, rows: WrenchBlock) -> Batch:
        return self._locator.locate_batch(rows.wrenches)

    def warnings(self) -> tuple[str, ...]:
        return ()


class _Tracked(_Untracked):
    """One stream, with the samples that come late or twice marked as stale."""

    def __init__(self, solver: Any) -> None:
        self._solver = solver
        self._latest = -np.inf
        self._stale = 0
        self._first_stale = 0
        solver.reset()

    def __call__(self, rows: WrenchBlock) -> Batch:
        assert rows.t is not None  # noqa: S101  (the reader was asked for it)
        # fmax: a NaN, where they are allowed, is not a time, but does not hide the times after it.
        newest = np.fmax.accumulate(np.concatenate(([self._latest], rows.t)))
        late = ~(rows.t > newest[:-1])
        self._latest = float(newest[-1])
        if late.any() and not self._stale:
            self._first_stale = int(rows.lines[np.argmax(late)])
        self._stale += int(np.count_nonzero(late))
        # An age of NaN is over any limit, even over none.
        steps = np.where(late, 0.0, rows.t - newest[:-1])
        answers: Batch = self._solver.track_batch(rows.wrenches, np.where(late, np.nan, 0.0), steps)
        arms = 1e3 * answers.torsion_arms[answers.accepted]
        if self._solver.model.torsion_learned and len(arms):
            low, high = self.torsion_arm_mm or (np.inf, 0.0)
            self.torsion_arm_mm = min(low, float(arms.min())), max(high, float(arms.max()))
        return answers

    def warnings(self) -> tuple[str, ...]:
        if not self._stale:
            return ()
        sentences = message(
            f"Rows that are not later than all rows before them: {arg(self._stale)}, the first on line"
            f" {arg(self._first_stale)}. Their answer is stale. If recordings were joined, split them."
        )
        return (sentences,)


def _tracked(locator: Locator) -> _Tracked:
    if not hasattr(locator, "track_batch"):
        name = getattr(locator, "name", type(locator).__name__)
        raise InputError(
            f"method {arg(name)} cannot track: only contactbench can. Choose it, or do not track."
        )
    return _Tracked(locator)


def ahead(blocks: Iterable[_Block], work: Callable[[_Block], _Done]) -> Iterator[tuple[_Block, _Done]]:
    """Do the work on each block in a second thread while the next is read and the one before is written.

    Solver and NumPy release the interpreter's lock, so this saves up to a quarter of the time where a second
    core is free. One thread, because a stream has an order.
    """
    with ThreadPoolExecutor(1, "ahead") as pool:
        waiting: tuple[_Block, Future[_Done]] | None = None
        try:
            for rows in blocks:
                following = pool.submit(work, rows)
                if waiting is not None:
                    yield waiting[0], waiting[1].result()
                waiting = rows, following
        except InputError:
            if waiting is not None:
                waiting[1].result()  # what is wrong further up in the file comes first
            raise
        if waiting is not None:
            yield waiting[0], waiting[1].result()


class _Marker:
    """Tells what facets are; of an unknown surface, and of no facet, nothing."""

    def __init__(self, probe: Probe | None) -> None:
        self._nothing = len(MARKS)
        of_facets = np.empty(0, dtype=np.uint8) if probe is None else facet_marks(probe)
        self._known = probe is not None
        self._of_facets = np.append(of_facets, np.uint8(self._nothing))  # -1, no facet, is the last

    def __call__(self, faces: npt.NDArray[np.int32]) -> npt.NDArray[np.uint8]:
        if not self._known:
            return np.full(len(faces), self._nothing, dtype=np.uint8)
        return self._of_facets[faces]


# ---- counting ----------------------------------------------------------------------------------

_MANTISSA_BITS = 12
_SHIFT = 52 - _MANTISSA_BITS
_SMALLEST, _LARGEST = 2.0**-30, 2.0**30  # mm
_FIRST_BIN = int(np.float64(_SMALLEST).view(np.int64)) >> _SHIFT
_BINS = (int(np.float64(_LARGEST).view(np.int64)) >> _SHIFT) - _FIRST_BIN + 1


class _Tally:
    """Counts per reason, and a histogram fine enough for a median of four digits."""

    def __init__(self) -> None:
        self.reasons = dict.fromkeys(REASONS, 0)
        self.on = [0] * (len(MARKS) + 1)  # the last: on no facet
        # A bin per exponent and first bits of the mantissa, 1/4096 wide: keeping all values of a large
        # file would take more memory than the solver.
        self._bins = np.zeros(_BINS, dtype=np.int64)

    def add(
        self, reasons: npt.NDArray[np.uint8], sigma_mm: npt.NDArray[np.float64], marks: npt.NDArray[np.uint8]
    ) -> None:
        for mark, count in enumerate(np.bincount(marks, minlength=len(self.on))):
            self.on[mark] += int(count)
        for name, count in zip(REASONS, np.bincount(reasons, minlength=len(REASONS)), strict=True):
            self.reasons[name] += int(count)
        given = np.clip(sigma_mm[~np.isnan(sigma_mm)], _SMALLEST, _LARGEST)
        found, counts = np.unique((given.view(np.int64) >> _SHIFT) - _FIRST_BIN, return_counts=True)
        self._bins[found] += counts

    def median(self) -> float | None:
        total = np.cumsum(self._bins)
        if not total[-1]:
            return None
        middle = int(np.searchsorted(total, (total[-1] + 1) // 2)) + _FIRST_BIN
        value = np.int64((middle << _SHIFT) + (1 << (_SHIFT - 1))).view(np.float64)
        return float(f"{value:.4g}")

    def warnings(self) -> tuple[str, ...]:
        contacts = self._bins.sum()
        sentences = {
            INVENTED: message(
                f"Contacts on invented facets: {arg(self.on[INVENTED])} of {arg(contacts)}. The mesh file had an"
                " opening there, so surface and contacts are guesses."
            ),
            UNTOUCHABLE: message(
                f"Contacts on untouchable regions: {arg(self.on[UNTOUCHABLE])} of {arg(contacts)}. Nothing should"
                " be able to touch there: check the region, then the mount and the compensation."
            ),
        }
        return tuple(text for mark, text in sentences.items() if self.on[mark])


# ---- files -------------------------------------------------------------------------------------


def refuse_overwriting(out: Path | BinaryIO, source: Path | BinaryIO) -> None:
    """
    Refuse an output that is one of the inputs, also by another name.

    Raises
    ------
    WrenchFileError
        Both are the same file.
    """
    if not (isinstance(source, Path) and isinstance(out, Path)):
        return
    try:
        same = out.samefile(source)
    except (OSError, ValueError):  # ValueError: a path that no file system can hold
        return  # one of them does not exist, or opening it will say what is wrong
    if same:
        raise WrenchFileError(
            f"{arg(out)}: the output would overwrite the input: choose another name for it."
        )


@contextmanager
def whole_output(out: Path | BinaryIO, what: str) -> Iterator[Callable[[bytes], object]]:
    """
    Take bytes that become a file when the block ends well; leave no trace when it does not.

    Parameters
    ----------
    out : path or binary file
        A path keeps what is there until the block has ended; a link stays one.
    what : str
        What messages call the content, in the plural.

    Yields
    ------
    write : callable
        Takes bytes, as often as there are some.

    Raises
    ------
    WrenchFileError
        `out` is no place for a file, or cannot be written.
    """
    if not isinstance(out, Path):
        yield out.write
        out.flush()
        return
    with _explained(out, what):
        # A link stays one: what it points at is replaced.
        file = out.resolve()
        if file.exists() and not file.is_file():
            raise WrenchFileError(f"{arg(out)}: this is a folder or a device: choose the name of a file.")
        scratch = scratch_beside(file)
        stream = scratch.open("xb")

    def write(data: bytes) -> None:
        with _explained(out, what):
            stream.write(data)

    try:
        with stream:
            yield write
            with _explained(out, what):
                stream.flush()
                os.fsync(stream.fileno())
        with _explained(out, what):
            scratch.replace(file)
    except BaseException:
        scratch.unlink(missing_ok=True)
        raise
    sync_folder(file.parent)


@contextmanager
def _explained(out: Path, what: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise WrenchFileError(
            f"{arg(out)}: the {arg(what)} cannot be written ({arg(error.strerror or error)}): choose a"
            " folder that exists, is writable and has space."
        ) from error
