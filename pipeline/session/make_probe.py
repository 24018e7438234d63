"""How a session computes a probe."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from functools import partial
from typing import TYPE_CHECKING, Any, cast, get_args

from contactbench.pipeline.calibration.parameters import Number, Parameters, check_roles
from contactbench.pipeline.session.errors import SessionError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from contactbench.pipeline.mesh.simplify import Engine
    from contactbench.pipeline.preparation.alignment import Alignment
    from contactbench.pipeline.preparation.prepare import Dense, Preparation

    Progress = Callable[[float], None] | None
    Cancel = Callable[[], bool] | None

# Of the work: making the outer surface.
_DENSE = 0.7
_REMEMBERED = 2


class ProbeParameters(Parameters):
    """As the options of ``contactbench probe prepare``; mount: mm, then degrees about the fixed axes."""

    endings = (".ply",)

    units: str = "auto"
    close: tuple[str, ...] = ()
    alpha: float | None = None
    gap: float | None = None
    mount: tuple[Number, Number, Number, Number, Number, Number] | None = None
    facets: int | None = None
    max_deviation: float | None = None
    max_contact_error: float | None = None
    forces: tuple[float, float] = (8.0, 10.0)
    engine: str = "auto"
    region_ratio: float = 1.0


def probe(
    inputs: Mapping[str, Path],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    progress: Progress = None,
    cancelled: Cancel = None,
    remember: bool = False,
) -> dict[str, bytes]:
    """
    Prepare a probe from ``mesh``: the bytes that ``contactbench probe prepare`` writes.

    ``alignment``, an input that may be left out, is what ``contactbench probe align --save`` wrote; ``regions``,
    another, what ``contactbench probe regions export`` wrote of the aligned outer surface: see
    `contactbench.pipeline.preparation.painted`. For `remember` see `dense_of`.
    """
    from contactbench.pipeline.mesh.sidecar import encode_probe_file

    given = ProbeParameters.checked(parameters)
    done = prepared(inputs, given, progress=progress, cancelled=cancelled, remember=remember)
    return encode_probe_file(done.content, given.name)


def prepared(
    inputs: Mapping[str, Path],
    given: ProbeParameters,
    *,
    progress: Progress = None,
    cancelled: Cancel = None,
    remember: bool = False,
) -> Preparation:
    """Prepare a probe from the same inputs as `probe`, and give it with what was done."""
    from contactbench.pipeline.mesh.simplify import Engine
    from contactbench.pipeline.preparation.painted import put_on
    from contactbench.pipeline.preparation.prepare import finish, place

    if given.engine not in get_args(Engine):
        raise SessionError(
            f"engine {given.engine!r}: there is no such engine: give one of {get_args(Engine)}."
        )
    check_roles(inputs, ("mesh",), ("alignment", "regions"))
    mesh = inputs["mesh"]
    if given.mount is not None and "alignment" in inputs:
        raise SessionError("mount and an alignment contradict each other: give one.")
    alignment, target = alignment_of(given, inputs.get("alignment")), target_of(given)
    dense = dense_of(
        mesh,
        given,
        aligned_later=alignment is not None,
        remember=remember,
        progress=_part(progress, 0.0, _DENSE),
        cancelled=cancelled,
    )
    painted = None if "regions" not in inputs else partial(put_on, file=inputs["regions"])
    return finish(
        dense,
        place(dense, alignment, painted),
        target,
        engine=cast("Engine", given.engine),
        region_ratio=given.region_ratio,
        progress=_part(progress, _DENSE, 1.0),
        cancelled=cancelled,
    )


# ---- the outer surface --------------------------------------------------------------------------

_dense: OrderedDict[tuple[object, ...], Dense] = OrderedDict()
_lock = threading.Lock()


def dense_of(
    mesh: Path,
    given: ProbeParameters,
    *,
    aligned_later: bool = False,
    remember: bool = False,
    progress: Progress = None,
    cancelled: Cancel = None,
) -> Dense:
    """
    Make the outer surface of a mesh file: most of the time that a probe takes.

    Parameters
    ----------
    mesh : path
        With its JSON file beside it, if it is contactbench's.
    given : ProbeParameters
    aligned_later : bool
        Refuse a mesh that is aligned already.
    remember : bool
        Whether one that was made before from the same bytes, name and parameters will do. Who checks results makes
        all of them anew.
    progress, cancelled : callable, optional
        The share that is done, and whether to stop.
    """
    from contactbench.pipeline.mesh.shell import Closing
    from contactbench.pipeline.preparation.prepare import make_dense
    from contactbench.pipeline.preparation.steps import refuse_aligned

    if not set(given.close) <= set(Closing):
        raise SessionError(f"close {given.close!r}: no such way to close: give some of {', '.join(Closing)}.")
    key = _key(mesh, given) if remember else ()
    with _lock:
        known = _dense.get(key) if remember else None
    if known is not None:
        if aligned_later:
            refuse_aligned(known.content, again=False)
        return known
    ways = [Closing(each) for each in given.close]
    made = make_dense(
        mesh,
        cast("Any", given.units),
        ways[0] if len(ways) == 1 else ways or Closing.AUTO,
        alpha=None if given.alpha is None else given.alpha / 1000,
        gap=None if given.gap is None else given.gap / 1000,
        aligned_later=aligned_later,
        progress=progress,
        cancelled=cancelled,
    )
    if remember:
        with _lock:
            _dense[key] = made
            while len(_dense) > _REMEMBERED:
                _dense.popitem(last=False)
    return made


def _key(mesh: Path, given: ProbeParameters) -> tuple[object, ...]:
    # Only a regular file has a hash; of others the reader says what is wrong.
    files = (each for each in (mesh, mesh.with_suffix(".json")) if each.is_file())
    hashes = tuple(hashlib.sha256(each.read_bytes()).hexdigest() for each in files)
    return (mesh.name, hashes, given.units, given.close, given.alpha, given.gap)


def _part(progress: Progress, low: float, high: float) -> Progress:
    if progress is None:
        return None
    return lambda share: progress(low + share * (high - low))


def alignment_of(given: ProbeParameters, file: Path | None) -> Alignment | None:
    """Return where a mesh is put: as the file says, or else the mount; None: it stays in its own frame."""
    from contactbench.pipeline.preparation.alignment import from_angles, from_json

    if file is not None:
        return from_json(file.read_bytes(), file.name)
    return None if given.mount is None else from_angles(list(given.mount[:3]), list(given.mount[3:]))


def target_of(given: ProbeParameters) -> Callable[[Any], Any]:
    """Return the target of a simplification, as `contactbench.pipeline.preparation.prepare.finish` takes it."""
    from contactbench.pipeline.mesh.simplify import Count, MaxDeviation
    from contactbench.pipeline.preparation.ladder import ExpectedTouches
    from contactbench.pipeline.preparation.targets import DEFAULT_LIMIT, ContactTarget

    if sum(each is not None for each in (given.facets, given.max_deviation, given.max_contact_error)) > 1:
        raise SessionError("facets, max_deviation and max_contact_error: give one of them.")
    if given.facets is not None:
        count = Count(given.facets)
        return lambda _: (count, None)
    if given.max_deviation is not None:
        deviation = MaxDeviation(given.max_deviation / 1000)
        return lambda _: (deviation, None)
    limit = DEFAULT_LIMIT if given.max_contact_error is None else given.max_contact_error / 1000
    wanted = ContactTarget(limit, ExpectedTouches(force=given.forces))
    return lambda content: wanted.of(content.probe)
