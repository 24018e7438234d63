"""What the next frames need of a new probe, computed beside the window: it must not stand still for it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from contactbench.widgets.scene.hatch import hatches, narrow_patches
from contactbench.widgets.scene.shapes import thinned
from contactbench.widgets.scene.smooth import SmoothSurface, crease_edges, long_creases, smoothed

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe

MANY = 30_000
"""Facets from which on a likeness stands in while all moves."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """What was computed of a probe."""

    probe: Probe
    # (vertices, faces, kept) or None: See `contactbench.widgets.scene.shapes.thinned`; None: it has few
    # facets
    likeness: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]] | None
    creases: NDArray[np.float64]  # (2 k, 3): Ends of its sharp and open edges that are drawn, S, m
    smooth: SmoothSurface
    narrow: NDArray[np.bool_]  # (m,) See `contactbench.widgets.scene.hatch.narrow_patches`
    hatched: NDArray[np.float64]  # (2 l, 3): Ends of the lines across what was made up, S, m


class Ahead(QObject):
    """Prepares a probe in a thread; what has become old meanwhile is dropped."""

    _came = Signal(object)

    def __init__(self, take: Callable[[Prepared], None], parent: QObject | None) -> None:
        super().__init__(parent)
        self._take = take
        self._wanted: Probe | None = None
        # One that stays: to begin a thread is to wait until it runs, which on a busy machine takes long.
        self._pool = ThreadPoolExecutor(1, "ahead")
        self._newest: Prepared | None = None
        self._came.connect(self._taken)

    @property
    def busy(self) -> bool:
        """Whether something is still to come."""
        return self._wanted is not None

    def begin(self, probe: Probe | None) -> None:
        """Prepare a probe, instead of any other; None: none."""
        if self._newest is not None and self._newest.probe is probe:  # as when a page is shown again
            self._wanted = None
            self._take(self._newest)
            return
        self._wanted = probe
        if probe is not None:
            self._pool.submit(self._work, probe)

    def close(self) -> None:
        """End it; waits for what is under way, for it tells an object that is gone soon, and drops the rest."""
        self._wanted = self._newest = None
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _work(self, probe: Probe) -> None:
        if probe is not self._wanted:
            return  # another was shown meanwhile
        prepared = prepare(probe)
        with suppress(RuntimeError):  # the scene is gone
            self._came.emit(prepared)

    def _taken(self, prepared: Prepared) -> None:
        if prepared.probe is self._wanted:
            self._wanted, self._newest = None, prepared
            self._take(prepared)


def prepare(probe: Probe) -> Prepared:
    """Compute what is needed of a probe; NumPy leaves the interpreter to others while it sorts."""
    likeness = thinned(probe.vertices, probe.faces) if len(probe.faces) > MANY else None
    edges, clear = crease_edges(probe.faces, probe.normals, len(probe.vertices))
    drawn, narrow = edges[clear], narrow_patches(probe)
    drawn = drawn[long_creases(drawn, probe.vertices, probe.size)]
    return Prepared(
        probe,
        likeness,
        probe.vertices[drawn].reshape(-1, 3),
        smoothed(probe.vertices, probe.faces, probe.normals, edges),
        narrow,
        hatches(probe, narrow),
    )
