"""In the child process: how each operation is asked of its library. Never used in the parent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.mesh.engines.operation import Operation

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy.typing as npt

_Arrays = dict[str, "npt.NDArray[Any]"]

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
    meshes = _mesh_set(module, arrays)
    meshes.generate_alpha_wrap(
        alpha=module.PureValue(fields["alpha"]), offset=module.PureValue(fields["offset"])
    )
    return _current(meshes)


def _close_holes(module: Any, arrays: Mapping[str, npt.NDArray[Any]], fields: Mapping[str, Any]) -> _Arrays:
    meshes = _mesh_set(module, arrays)
    edge = fields["edge"]
    meshes.meshing_close_holes(
        maxholesize=int(fields["longest"]),
        selfintersection=bool(fields["avoid_self_intersections"]),
        newfaceselected=True,
        refinehole=edge > 0,
        **({"refineholeedgelen": module.PureValue(edge)} if edge > 0 else {}),
    )
    # The filter leaves the facets it adds selected; its refinement selects the finer ones instead.
    added = np.asarray(meshes.current_mesh().face_selection_array(), dtype=np.bool_)
    return _current(meshes) | {"added": added}


def _self_intersections(
    module: Any, arrays: Mapping[str, npt.NDArray[Any]], _fields: Mapping[str, Any]
) -> _Arrays:
    meshes = _mesh_set(module, arrays)
    meshes.compute_selection_by_self_intersections_per_face()
    return {"selected": np.asarray(meshes.current_mesh().face_selection_array(), dtype=np.bool_)}


def _cut(module: Any, arrays: Mapping[str, npt.NDArray[Any]], _fields: Mapping[str, Any]) -> _Arrays:
    vertices, faces, _, born, _ = module.remesh_self_intersections(
        arrays["vertices"], arrays["faces"].astype(np.int64), stitch_all=True
    )
    return _mesh(vertices, faces) | {"born": np.asarray(born, dtype=np.int32).reshape(-1)}


def _orient(module: Any, arrays: Mapping[str, npt.NDArray[Any]], _fields: Mapping[str, Any]) -> _Arrays:
    meshes = _mesh_set(module, arrays)
    meshes.meshing_re_orient_faces_coherently()
    return _current(meshes)


def _mesh_set(module: Any, arrays: Mapping[str, npt.NDArray[Any]]) -> Any:
    meshes = module.MeshSet(verbose=False)
    meshes.add_mesh(module.Mesh(vertex_matrix=arrays["vertices"], face_matrix=arrays["faces"]))
    return meshes


def _current(meshes: Any) -> _Arrays:
    mesh = meshes.current_mesh()
    return _mesh(mesh.vertex_matrix(), mesh.face_matrix())


def _mesh(vertices: Any, faces: Any) -> _Arrays:
    return {
        "vertices": np.asarray(vertices, dtype=np.float64).reshape(-1, 3),
        "faces": np.asarray(faces, dtype=np.int32).reshape(-1, 3),
    }


_OPERATIONS: dict[Operation, Callable[[Any, Mapping[str, npt.NDArray[Any]], Mapping[str, Any]], _Arrays]] = {
    Operation.ALPHA_WRAP: _alpha_wrap,
    Operation.CLOSE_HOLES: _close_holes,
    Operation.SELF_INTERSECTIONS: _self_intersections,
    Operation.CUT: _cut,
    Operation.ORIENT: _orient,
}
