"""Which operations there are, which library does each, and, in the child process only, how it is asked to."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError, message
from contactbench.pipeline.installation import remedy

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy.typing as npt

_Arrays = dict[str, "npt.NDArray[Any]"]


class EngineError(InputError):
    """A mesh library that is missing, refused the mesh, or died on it: names the library and the remedy."""


class Cancelled(Exception):  # noqa: N818 -- not an error: the caller asked for it
    """The caller cancelled the work; the engine that did it was stopped and nothing was changed."""


class Library(StrEnum):
    """A mesh library, each with a child process of its own."""

    MESHLAB = "meshlab"
    CGAL = "cgal"

    @property
    def install(self) -> str:
        """What installs it, in the imperative."""
        return remedy("meshlab")


class Operation(StrEnum):
    """What an engine can do; the functions of this package say what each takes and gives."""

    ALPHA_WRAP = message("alpha wrap")
    CUT = message("cut along crossings")

    @property
    def library(self) -> Library:
        """The library that does it."""
        return Library.CGAL if self is Operation.CUT else Library.MESHLAB


# What the libraries raise for a mesh they do not want; anything else is a defect and ends the child.
REFUSALS = (RuntimeError, ValueError)


def perform(
    module: Any, operation: Operation, arrays: Mapping[str, npt.NDArray[Any]], fields: Mapping[str, Any]
) -> _Arrays:
    """
    Do one operation.

    Parameters
    ----------
    module : module
        The operation's library.
    operation : Operation
        What to do.
    arrays : mapping
        ``vertices`` (n, 3) float64, ``faces`` (m, 3) int32, and what else the operation takes.
    fields : mapping
        The operation's parameters.

    Returns
    -------
    dict
        float64, int32 or bool arrays.
    """
    return _OPERATIONS[operation](module, arrays, fields)


def _alpha_wrap(module: Any, arrays: Mapping[str, npt.NDArray[Any]], fields: Mapping[str, Any]) -> _Arrays:
    meshes = module.MeshSet(verbose=False)
    meshes.add_mesh(module.Mesh(vertex_matrix=arrays["vertices"], face_matrix=arrays["faces"]))
    meshes.generate_alpha_wrap(
        alpha=module.PureValue(fields["alpha"]), offset=module.PureValue(fields["offset"])
    )
    mesh = meshes.current_mesh()
    return _mesh(mesh.vertex_matrix(), mesh.face_matrix())


def _cut(module: Any, arrays: Mapping[str, npt.NDArray[Any]], _fields: Mapping[str, Any]) -> _Arrays:
    vertices, faces, _, born, _ = module.remesh_self_intersections(
        arrays["vertices"], arrays["faces"].astype(np.int64), stitch_all=True
    )
    return _mesh(vertices, faces) | {"born": np.asarray(born, dtype=np.int32).reshape(-1)}


def _mesh(vertices: Any, faces: Any) -> _Arrays:
    return {
        "vertices": np.asarray(vertices, dtype=np.float64).reshape(-1, 3),
        "faces": np.asarray(faces, dtype=np.int32).reshape(-1, 3),
    }


_OPERATIONS: dict[Operation, Callable[[Any, Mapping[str, npt.NDArray[Any]], Mapping[str, Any]], _Arrays]] = {
    Operation.ALPHA_WRAP: _alpha_wrap,
    Operation.CUT: _cut,
}
