"""What is measured in C++: the kernel's headers alone, and madmann91/bvh; compiled by g++ and called by ctypes."""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.solver.bits import INCLUDE, RULES, Build, gate_numbers, run_tool

from contactbench.pipeline import kernel
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.contact import ContactSolver

    Single = NDArray[np.float32]

_HERE = os.path.dirname(__file__)  # noqa: PTH120 - for a command
_SHARED = ("-O3", "-DNDEBUG", "-shared", "-fPIC", "-pthread")
_SECONDS = 300
ROOM = 32  # hits of a ray that are kept


def compile_touches(folder: Path) -> ctypes.CDLL:
    """Compile the kernel's headers as the kernel itself is compiled."""
    native = ("-march=x86-64-v3",) if kernel.variant == "avx2" else ()
    return _library(folder / "touches.so", (*RULES, *native, f"-I{INCLUDE}", f"{_HERE}/touches.cpp"))


def compile_hits(folder: Path, checkout: Path) -> ctypes.CDLL:
    """Compile madmann91/bvh as its own tests are compiled, for this very processor."""
    if not (checkout / "src/bvh/v2/bvh.h").is_file():
        raise InputError(f"{checkout}: no checkout of madmann91/bvh (v2): there is no src/bvh/v2/bvh.h.")
    given = ("-std=c++20", "-march=native", f"-I{checkout / 'src'}", f"{_HERE}/hits.cpp")
    return _library(folder / "hits.so", given)


def _library(out: Path, given: tuple[str, ...]) -> ctypes.CDLL:
    build = Build(out.stem, "g++", given)
    run_tool([build.compiler, *_SHARED, *given, "-o", str(out)], _SECONDS, build)
    return ctypes.CDLL(str(out))


class CompiledTouches:
    """A solver that was compiled from the headers."""

    def __init__(self, library: ctypes.CDLL, solver: ContactSolver) -> None:
        library.touches_new.restype = ctypes.c_void_p
        self._library = library
        vertices = np.ascontiguousarray(solver.probe.vertices, np.float64)
        facets = np.ascontiguousarray(solver.probe.faces, np.int32)
        covariance = np.ascontiguousarray(solver.covariance)
        gates, model = np.array(gate_numbers(solver.gates)), solver.model
        self._solver = ctypes.c_void_p(
            library.touches_new(
                *(_at(vertices), ctypes.c_int64(len(vertices)), _at(facets), ctypes.c_int64(len(facets))),
                *(_at(covariance), ctypes.c_double(model.torsion_arm), ctypes.c_double(model.mesh_deviation)),
                *(ctypes.c_int(model.mesh_curved), _at(gates)),
            )
        )

    def locate(self, wrenches: NDArray[np.float64], threads: int) -> NDArray[np.float64]:
        """Return points (n, 3), each wrench (n, 6) on its own."""
        points = np.empty((len(wrenches), 3))
        count = ctypes.c_int64(len(wrenches))
        self._library.touches_locate(self._solver, _at(wrenches), count, ctypes.c_int(threads), _at(points))
        return points

    def track(self, wrenches: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points (n, 3) of the next samples of one stream."""
        points = np.empty((len(wrenches), 3))
        count = ctypes.c_int64(len(wrenches))
        self._library.touches_track(self._solver, _at(wrenches), count, _at(points))
        return points

    def __del__(self) -> None:
        self._library.touches_drop(self._solver)


class CompiledHits:
    """A tree of facets that was compiled from madmann91/bvh."""

    def __init__(self, library: ctypes.CDLL, vertices: Single, facets: NDArray[np.int32]) -> None:
        library.hits_new.restype = ctypes.c_void_p
        self._library = library
        given = _at(np.ascontiguousarray(vertices)), _at(np.ascontiguousarray(facets))
        self._scene = ctypes.c_void_p(library.hits_new(*given, ctypes.c_int64(len(facets))))

    def first(self, origins: Single, directions: Single, threads: int) -> NDArray[np.int32]:
        """Return the first facet that each ray (n, 3), (n, 3) meets, (n,); -1 for none."""
        facets, far = np.empty(len(origins), np.int32), np.empty(len(origins), np.float32)
        self._ask("hits_first", origins, directions, threads, _at(facets), _at(far))
        return facets

    def all(self, origins: Single, directions: Single, threads: int) -> NDArray[np.int32]:
        """Return how many facets each ray (n, 3), (n, 3) meets, (n,); which ones is written, too."""
        counts = np.empty(len(origins), np.int32)
        facets, far = (np.empty((len(origins), ROOM), kind) for kind in (np.int32, np.float32))
        kept = ctypes.c_int32(ROOM), _at(counts), _at(facets), _at(far)
        self._ask("hits_all", origins, directions, threads, *kept)
        return counts

    def _ask(self, name: str, origins: Single, directions: Single, threads: int, *out: Any) -> None:
        rays = _at(origins), _at(directions), ctypes.c_int64(len(origins)), ctypes.c_int(threads)
        getattr(self._library, name)(self._scene, *rays, *out)

    def __del__(self) -> None:
        self._library.hits_drop(self._scene)


def _at(array: NDArray[Any]) -> ctypes.c_void_p:
    assert array.flags.c_contiguous
    return ctypes.c_void_p(array.ctypes.data)
