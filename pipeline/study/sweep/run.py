"""Computing a sweep: in processes on this machine, or on a cluster through Dask."""

from __future__ import annotations

import json
import os
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from itertools import groupby
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from threading import Thread
from time import process_time
from types import TracebackType
from typing import Any, Self, TypeVar
from uuid import uuid4

from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.study.pages import PASSING, cores, environment, write_results
from contactbench.pipeline.study.sweep import cell as cells_module
from contactbench.pipeline.study.sweep.cell import forget, gates_for, run_cell
from contactbench.pipeline.study.sweep.plan import Cell, SweepPlan, file_facets, identity, label, mesh_of

Kind = tuple[str, str, int]  # method, probe, facets: what cells are alike in that cost the same

KIND = "sweep"  # of the results
_TOGETHER = 24  # cells of a task at most: few enough that little is lost when it is cancelled
_EACH = 4  # tasks of a worker at least, if there are as many cells: so that all end together


@dataclass(frozen=True)
class Swept:
    """What a run did."""

    results: Path | None  # the Parquet file; None: cancelled before all was done, or parts are missing
    # cells, computed, failed: all of them, those computed now, and those that could not be
    cells: int
    computed: int
    failed: int
    left_out: tuple[str, ...] = ()  # meshes that a file cannot be made into, and why
    faults: tuple[str, ...] = ()  # what could not be computed, and why
    strange: tuple[str, ...] = ()  # files of other plans, where cells are missing: what differs

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return asdict(self) | {"results": None if self.results is None else str(self.results)}


def run(
    plan: SweepPlan,
    out: Path,
    *,
    command: str = "contactbench study run",
    scheduler: str | None = None,
    workers: int | None = None,
    part: tuple[int, int] = (1, 1),
    progress: Progress = unheard,
    cancelled: Callable[[], bool] = lambda: False,
) -> Swept:
    """
    Compute every cell that is not done yet, and write the results.

    Errors do not depend on `workers` or `scheduler`: each cell has a seed of its own. Times are those of a busy machine
    where several workers share it: for times, give one worker.

    Parameters
    ----------
    out : Path
        Folder; what is done in it is not done again, but what failed.
    command : str
        What repeats it, kept with the results.
    scheduler : str, optional
        Address of a Dask scheduler, tcp://...; left out, processes on this machine.
    workers : int, optional
        Processes on this machine; left out, one for each core. 1: in this process, without a cluster.
    part : (int, int)
        Which of how many parts to compute, from 1: others compute the others into the same folder, which machines may
        share. Who finds all done writes the results.
    progress : callable, optional
        Gets the number of cells that are done, and of all of the part.
    cancelled : callable
        Asked between cells.

    Raises
    ------
    InputError
        The folder or the scheduler cannot be used.
    """
    cells, left_out = distinct(plan)
    count = workers or cores()
    told = plan.told()
    facts = {"workers": count, "scheduler": "a cluster" if scheduler else "this machine"}
    with Store(out, {"plan": told, "environment": environment(**facts)}) as store:
        mine = share(cells, *part)
        todo = [cell for cell in mine if store.rows.get(cell.key, {"failed": "not yet"})["failed"]]
        computed = 0
        for row in _rows(todo, scheduler, count, cancelled):
            store.keep(row)
            computed += 1
            progress(len(mine) - len(todo) + computed, len(mine))
        store.look()
        rows = [store.rows[cell.key] for cell in cells if cell.key in store.rows]
    failed, faults = sum(bool(row["failed"]) for row in rows), tuple(faults_of(rows))
    if computed < len(todo):
        return Swept(None, len(cells), computed, failed, left_out, faults)
    if len(rows) < len(cells):
        return Swept(None, len(cells), computed, failed, left_out, faults, tuple(_strange(store, told)))
    known = environment(**facts, machines=store.machines(cell.key for cell in cells))
    named = plan.model_copy(update={"probes": tuple(map(label, plan.probes))})  # without paths
    about = {"plan": named.model_dump(mode="json"), "left_out": list(left_out)}
    file = write_results(out, KIND, command, rows, known, about)
    return Swept(file, len(cells), computed, failed, left_out, faults)


def _strange(store: Store, told: Mapping[str, Any]) -> Iterator[str]:
    """Say which files in the folder were made from another plan than what is told here."""
    for name, about in store.about.items():
        other = about["plan"]
        if differ := [
            f"{what} {other.get(what)}, here {mine}" for what, mine in told.items() if other.get(what) != mine
        ]:
            yield (
                f"{store.folder / name}: made by another plan ({'; '.join(differ)}): for one result, give the same plan"
                " and options on every machine."
            )


def faults_of(rows: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return what could not be computed, each reason once with the methods and probes that it stopped."""
    found: dict[str, set[str]] = {}
    for row in rows:
        if row["failed"]:
            found.setdefault(row["failed"], set()).add(f"{row['method']} on {row['probe']}")
    return [f"{', '.join(sorted(who))}: {reason}" for reason, who in found.items()]


def distinct(plan: SweepPlan) -> tuple[list[Cell], tuple[str, ...]]:
    """
    Return the cells of a plan, and which meshes a file cannot be made into, and why.

    Of meshes finer than a file's own there is only the coarsest, because all are the file's.
    """
    some: dict[str, tuple[int, int]] = {}
    left_out = []
    for probe in plan.probes:
        identity(probe)  # says what is wrong with a name that is no probe
        own = file_facets(probe)
        enough = [facets for facets in plan.facets if own is not None and facets >= own]
        finest = min(enough, default=max(plan.facets))
        coarsest = min(plan.facets)
        for facets in [] if own is None else sorted(f for f in plan.facets if f < finest):
            coarsest = facets
            try:
                mesh_of(probe, facets)
            except InputError as error:
                left_out.append(f"{label(probe)} at {facets:,} facets: {error}")
                coarsest = finest
            else:
                break
        some[probe] = coarsest, finest
    return [c for c in plan.cells() if some[c.probe][0] <= c.facets <= some[c.probe][1]], tuple(left_out)


def share(cells: list[Cell], part: int, of: int) -> list[Cell]:
    """
    Return the part of the cells, from 1, that is computed here; all parts cost about the same.

    Raises
    ------
    InputError
        There is no such part.
    """
    if not 1 <= part <= of:
        raise InputError(f"--part {part}/{of}: give one of the parts 1/{of} to {of}/{of}.")
    return cells if of == 1 else [cell for task in tasks_of(cells, of)[part - 1 :: of] for cell in task]


def tasks_of(cells: list[Cell], workers: int = 1) -> list[list[Cell]]:
    """Return cells in parts that share a mesh and its methods: making them may take longer than locating by them."""
    together = max(1, min(_TOGETHER, len(cells) // (_EACH * workers)))
    ordered = sorted(cells, key=_heaviest_first)
    parts = []
    for _, group in groupby(ordered, key=_heaviest_first):
        alike = list(group)
        parts += [alike[first : first + together] for first in range(0, len(alike), together)]
    return parts


def _heaviest_first(cell: Cell) -> tuple[int, str, str, str, float]:
    return -cell.facets, identity(cell.probe), cell.noise, cell.filter, gates_for(cell.angle).friction_angle


def run_task(cells: list[Cell]) -> list[dict[str, Any]]:
    """Compute cells one after the other; what a worker does."""
    return [run_cell(cell) for cell in cells]


def _rows(
    cells: list[Cell], scheduler: str | None, workers: int, cancelled: Callable[[], bool]
) -> Iterator[dict[str, Any]]:
    if not cells:
        return
    if scheduler is None and workers == 1:
        try:
            for cell in sorted(cells, key=_heaviest_first):
                if cancelled():
                    return
                yield run_cell(cell)
        finally:
            forget()
        return
    if scheduler is None:
        yield from _in_processes(tasks_of(cells, workers), workers, cancelled)
    else:
        yield from _by_dask(cells, scheduler, cancelled)


def _in_processes(
    tasks: list[list[Cell]], workers: int, cancelled: Callable[[], bool]
) -> Iterator[dict[str, Any]]:
    """Compute tasks in processes; when one of these dies, what is left is tried once more."""
    spawn = get_context("spawn")
    count = min(workers, len(tasks), 61 if sys.platform == "win32" else workers)  # all are started at once
    for last in (False, True):
        heard, alive = spawn.Pipe(duplex=False)
        with ProcessPoolExecutor(count, spawn, initializer=_end_with, initargs=(heard,)) as pool:
            futures = {pool.submit(run_task, task): task for task in tasks}
            try:
                for future in as_completed(futures):
                    if cancelled():
                        return
                    rows = future.result()
                    tasks.remove(futures[future])
                    yield from rows
            except BrokenProcessPool as error:
                if last:
                    raise InputError(
                        f"{len(tasks)} parts of the study: their processes ended twice ({error}): free memory, or"
                        " use fewer --workers. What is done is kept."
                    ) from error
            else:
                return
            finally:
                alive.close()


def _end_with(parent: Connection) -> None:
    """End this process at once when its parent closes the other end or dies; Ctrl-C is the parent's."""

    def wait() -> None:
        parent.poll(None)
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=wait, daemon=True).start()


def _by_dask(cells: list[Cell], scheduler: str, cancelled: Callable[[], bool]) -> Iterator[dict[str, Any]]:
    import distributed

    try:
        client = distributed.Client(scheduler, timeout="10s")
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(f"scheduler {scheduler}: no connection ({error}): check the address.") from error
    with client:
        there = max(sum(client.nthreads().values()), 1)
        futures = client.map(run_task, tasks_of(cells, there), pure=False, retries=1)
        for future in distributed.as_completed(futures):
            if cancelled():
                client.cancel(futures)
                return
            yield from future.result()


# ---- where the cells of a sweep are kept, each as it is done -------------------------------------


_STEM, _SUFFIX = "done", ".jsonl"
DONE = _STEM + _SUFFIX  # of the first that writes; the others' names are longer


class Store:
    """
    The cells of a sweep that are done, in a folder; use it in a ``with`` statement.

    A file begins with the plan and the environment of who writes it. A line for each cell is appended when it is
    done; a last line that a crash cut off is not read. Cells of other plans may lie beside: a cell is known by what
    it is. Several processes, on several machines, may write into one folder: each has a file of its own there,
    because file systems of networks do not append for two.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    about : mapping
        What is said of the cells that are kept here: their ``plan`` and ``environment``, plain values.

    Raises
    ------
    InputError
        It cannot be read or written, or holds something else.
    """

    def __init__(self, folder: Path, about: Mapping[str, Mapping[str, Any]]) -> None:
        make_folder(folder)
        self.folder = folder
        self.rows: dict[str, dict[str, Any]] = {}
        self.about: dict[str, Mapping[str, Mapping[str, Any]]] = {}  # of each file, by its name
        self._mine = about
        self._source: dict[str, str] = {}  # key of a cell -> name of its file
        self._read: dict[Path, int] = {}  # bytes of each file that are known
        self.look()
        self._file = folder / DONE
        try:
            try:
                self._stream = self._file.open("xb")
            except FileExistsError:
                self._file = folder / f"{_STEM}-{uuid4().hex[:12]}{_SUFFIX}"
                self._stream = self._file.open("xb")
        except OSError as error:
            raise self._unkept(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        empty = not self._stream.tell()
        # What is kept is on the disk; what a full one did not take is tried once more.
        with suppress(OSError):
            self._stream.close()
        if empty:
            with suppress(OSError):
                self._file.unlink()

    def keep(self, row: dict[str, Any]) -> None:
        """Keep a cell's figures; they are on the disk when this returns. InputError: it is full, or the like."""
        self._take(row, self._file.name)
        first = not self._stream.tell()
        try:
            for line in ({"about": self._mine}, row) if first else (row,):
                self._stream.write(json.dumps(line, sort_keys=True).encode() + b"\n")
            self._stream.flush()
            os.fsync(self._stream.fileno())
        except OSError as error:
            raise self._unkept(error) from error

    def look(self) -> None:
        """Read what others have done meanwhile."""
        for file in sorted(self.folder.glob(f"{_STEM}*{_SUFFIX}")):
            known = self._read.get(file, 0)
            try:
                with file.open("rb") as stream:
                    stream.seek(known)
                    content = stream.read()
            except OSError as error:
                raise InputError(f"{file}: cannot be read ({error}): check the rights.") from error
            whole = content.rfind(b"\n") + 1  # what follows is torn, or is being written
            for number, line in enumerate(content[:whole].splitlines(), 1):
                try:
                    row = json.loads(line)
                    if "about" in row:
                        self.about[file.name] = {
                            name: dict(row["about"][name]) for name in ("plan", "environment")
                        }
                    else:
                        self._take(row | {"key": str(row["key"]), "failed": str(row["failed"])}, file.name)
                except (ValueError, KeyError, TypeError, RecursionError) as error:
                    raise InputError(
                        f"{file}, line {number}: no result of a study ({error}): choose an empty folder."
                    ) from error
            self._read[file] = known + whole

    def machines(self, keys: Iterable[str]) -> list[dict[str, Any]]:
        """Return the environments in which cells were computed, each once, with the number of ``cells``."""
        found: dict[str, dict[str, Any]] = {}
        for name, count in Counter(self._source[key] for key in keys).items():
            facts = self.about[name]["environment"] if name in self.about else {}
            lasting = {what: value for what, value in facts.items() if what not in PASSING}
            known = found.setdefault(json.dumps(lasting, sort_keys=True), {"cells": 0, **facts})
            known["cells"] += count
            known["load"] = max(known.get("load") or 0, facts.get("load") or 0)
        return list(found.values())

    def _unkept(self, error: OSError) -> InputError:
        return InputError(
            f"{self._file}: results cannot be kept ({error}): free disk space, or choose another folder."
        )

    def _take(self, row: dict[str, Any], name: str) -> None:
        before = self.rows.get(row["key"])
        if before is None or before["failed"] or not row["failed"]:  # one machine may lack what another has
            self.rows[row["key"]] = row
            self._source[row["key"]] = name


# ---- what a sweep will take, before it is begun: measured on a few of its cells ------------------


_T = TypeVar("_T")
_TRIED_TOUCHES, _FEWER = 1_000, 4  # touches that a cell is measured with, and with a quarter of them
_TOUCH_BYTES = 2_000  # of memory, for each touch of a cell: wrenches, answers and what they are judged by


@dataclass(frozen=True)
class Estimate:
    """What a sweep takes."""

    cells: int
    touches: int  # of all cells
    tasks: int
    measured: int  # cells that were tried
    core_hours: float  # processor time
    workers: int
    hours: float  # on so many cores that do nothing else
    worker_MB: float | None  # memory of each; None: this system does not say
    results_MB: float  # on the disk, while it is computed

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return asdict(self)


def estimate(
    plan: SweepPlan,
    *,
    workers: int | None = None,
    progress: Progress = unheard,
    clock: Callable[[], float] = process_time,
) -> Estimate:
    """
    Estimate what a plan takes: of each method on each mesh one cell is computed, with few touches.

    Parameters
    ----------
    workers : int, optional
        Cores, on one machine or on many; left out, those of this one.
    progress : callable, optional
        Gets the number of cells that are measured, and of all that will be.
    clock : callable
        Processor time, s.

    Raises
    ------
    InputError
        A probe of the plan cannot be read.
    """
    cells, _ = distinct(plan)
    count = workers or cores()
    tasks = tasks_of(cells, count)
    some = {_kind(cell): cell for cell in reversed(cells)}  # of each kind the first
    most = min(plan.touches, _TRIED_TOUCHES)
    making: dict[Kind, float] = {}
    costs: dict[Kind, float] = {}
    drawing: dict[str, float] = {}  # of all touches of a cell, for each probe
    line = 0
    for number, (kind, cell) in enumerate(sorted(some.items(), key=lambda each: cells.index(each[1])), 1):
        few, many = (replace(cell, touches=touches) for touches in (max(most // _FEWER, 10), most))
        cells_module.touches_of(few)  # drawn before, as by the method that had its turn before
        first, _ = _seconds(cells_module.run_cell, few, clock)
        again, _ = _seconds(cells_module.run_cell, few, clock)
        drawn, _ = _seconds(cells_module.touches_of, many, clock)
        full, row = _seconds(cells_module.run_cell, many, clock)
        drawing[cell.probe] = drawn * plan.touches / most
        each = max(full - again, 0.0) / max(most - few.touches, 1)
        making[kind] = max(first - again, 0.0)
        costs[kind] = full + each * (plan.touches - most)
        line = max(line, len(json.dumps(row)))
        progress(number, len(some))
    cells_module.forget()

    def taken(task: list[Cell]) -> float:
        # Methods take turns on the same touches.
        drawn = [probe for (probe, _), _ in groupby(task, lambda cell: (cell.probe, cell.touch_seed))]
        made = sum(making[kind] for kind in set(map(_kind, task)))
        return made + sum(costs[_kind(cell)] for cell in task) + sum(drawing[probe] for probe in drawn)

    by_task = [taken(task) for task in tasks]
    # Nobody ends before the longest task does.
    seconds = max(sum(by_task) / count, max(by_task, default=0.0))
    peak = _peak_bytes()
    return Estimate(
        cells=len(cells),
        touches=len(cells) * plan.touches,
        tasks=len(tasks),
        measured=len(some),
        core_hours=sum(by_task) / 3600,
        workers=count,
        hours=seconds / 3600,
        worker_MB=None if peak is None else (peak + _TOUCH_BYTES * plan.touches) / 1e6,
        results_MB=line * len(cells) / 1e6,
    )


def _kind(cell: Cell) -> Kind:
    return cell.method, cell.probe, cell.facets


def _seconds(work: Callable[[Cell], _T], cell: Cell, clock: Callable[[], float]) -> tuple[float, _T]:
    begin = clock()
    made = work(cell)
    return clock() - begin, made


def _peak_bytes() -> int | None:
    """Return the most memory that this process has had."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
