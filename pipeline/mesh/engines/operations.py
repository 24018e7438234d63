"""The operations as functions: they check the mesh on the way in and what the library made of it on the way out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.engines.child import run
from contactbench.pipeline.mesh.engines.libraries import EngineError, Library, Operation
from contactbench.pipeline.mesh.probe import check_faces, check_vertices

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Unpack

    import numpy.typing as npt

    from contactbench.pipeline.mesh.arrays import Floats, Ints, Surface


class Control(TypedDict, total=False):
    """`progress`, `cancelled` and `timeout_s` of `run`; every operation takes them."""

    progress: Callable[[float], None] | None
    cancelled: Callable[[], bool] | None
    timeout_s: float | None


def alpha_wrap(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    alpha: float,
    offset: float,
    **control: Unpack[Control],
) -> Surface:
    """
    Wrap a mesh, however broken, in a closed, orientable, manifold surface (Portaneri et al. 2022, CGAL).

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    alpha : float
        Gaps narrower than this are bridged, in the vertices' unit; above 0. The result's facets are of
        about this size, so the time grows with its inverse square.
    offset : float
        How far outside the mesh the wrap lies, in the same unit; above 0.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`; also for lengths that are not above 0.
    """
    _refuse_unless_positive(alpha=alpha, offset=offset)
    result = run(
        Operation.ALPHA_WRAP, _checked(vertices, faces), {"alpha": alpha, "offset": offset}, **control
    )
    return _mesh(Operation.ALPHA_WRAP, result)


def cut_along_crossings(
    vertices: npt.ArrayLike, faces: npt.ArrayLike, **control: Unpack[Control]
) -> tuple[Floats, Ints, Ints]:
    """
    Cut facets along the lines where they cross or touch others, exactly (CGAL, by libigl).

    New vertices are rounded to doubles, so that pieces may cross again by that much.

    Parameters
    ----------
    vertices : (n, 3) array_like
        Any length unit.
    faces : (m, 3) array_like
        Vertex indices.
    **control
        See `run`.

    Returns
    -------
    vertices : (k, 3) float64
    faces : (l, 3) int32
        Some may have no area after rounding.
    born : (l,) int32
        The facet that each is a piece of.

    Raises
    ------
    MeshError
        The arrays are no mesh.
    EngineError, Cancelled
        See `run`.
    """
    arrays = _checked(vertices, faces)
    result = run(Operation.CUT, arrays, {}, **control)
    new_vertices, new_faces = _mesh(Operation.CUT, result)
    born = result.get("born")
    right = born is not None and born.dtype == np.int32 and born.shape == (len(new_faces),)
    if born is None or not right or born.min() < 0 or born.max() >= len(arrays["faces"]):
        raise EngineError(
            f"{arg(Library.CGAL)} did not report which original facets its facets come from: use another mesh."
        )
    return new_vertices, new_faces, born


def _checked(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> dict[str, npt.NDArray[Any]]:
    points = check_vertices(vertices)
    return {"vertices": points, "faces": check_faces(faces, len(points))}


def _refuse_unless_positive(**lengths: float) -> None:
    for name, value in lengths.items():
        # not >, so that NaN is refused too.
        if not 0 < value < float("inf"):
            raise EngineError(f"{arg(name)} is {arg(value):g}: give a length above 0.")


def _mesh(operation: Operation, result: dict[str, npt.NDArray[Any]]) -> Surface:
    """Believe nothing: the libraries pass NaN on, and a heap they damaged may hold anything."""
    vertices, faces = result.get("vertices"), result.get("faces")
    match vertices, faces:
        case np.ndarray(ndim=2, shape=(_, 3)) as points, np.ndarray(ndim=2, shape=(count, 3)) as triangles:
            right = (
                points.dtype == np.float64 and triangles.dtype == np.int32 and bool(np.isfinite(points).all())
            )
            if right and count and triangles.min() >= 0 and triangles.max() < len(points):
                return points, triangles
    raise EngineError(
        f"{arg(operation.library)} produced no usable mesh from '{arg(operation)}': repair the mesh first,"
        " or use another engine."
    )
