"""Which operations there are, which library does each, and, in the child process only, how it is asked to."""

import io
from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import InputError, message
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.mesh.parse import refuse_too_many

_Arrays = dict[str, "npt.NDArray[Any]"]


class EngineError(InputError):
    """A mesh library that is missing, refused the mesh, or died on it: names the library and the remedy."""


class Library(StrEnum):
    """A mesh library, each with a child process of its own."""

    MESHLAB = "meshlab"
    CGAL = "cgal"
    COLLADA = "pycollada"
    VTK = "vtk"
    CASCADIO = "cascadio"

    @property
    def install(self) -> str:
        """What installs it, in the imperative."""
        # pycollada comes with the package, whatever the extra.
        own = {Library.MESHLAB: "meshlab", Library.CGAL: "meshlab", Library.CASCADIO: "step"}
        return remedy(own.get(self, "gui"))


class Operation(StrEnum):
    """What an engine can do; the functions of this package say what each takes and gives."""

    ALPHA_WRAP = message("alpha wrap")
    CUT = message("cut along crossings")
    READ_DAE = message("read DAE")
    READ_VTK = message("read VTK")
    READ_STEP = message("read STEP")

    @property
    def library(self) -> Library:
        """The library that does it."""
        return _OPERATIONS[self][0]


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
        ``vertices`` (n, 3) float64 and ``faces`` (m, 3) int32; or ``file`` (n,) int8, the bytes of one.
    fields : mapping
        The operation's parameters.

    Returns
    -------
    dict
        float64, int32 or bool arrays.
    """
    return _OPERATIONS[operation][1](module, arrays, fields)


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


def _read_dae(module: Any, arrays: Mapping[str, npt.NDArray[Any]], _fields: Mapping[str, Any]) -> _Arrays:
    known = module.common
    points, corners, sizes, start = [], [], [], 0
    try:
        document = module.Collada(
            io.BytesIO(arrays["file"].tobytes()), ignore=[known.DaeUnsupportedError, known.DaeBrokenRefError]
        )
        for placed in document.scene.objects("geometry") if document.scene else ():
            for part in placed.primitives():
                if isinstance(part, module.lineset.BoundLineSet) or part.vertex is None:
                    continue
                points.append(part.vertex)
                corners.append(part.vertex_index.ravel() + start)
                sizes.append(getattr(part.original, "vcounts", np.full(len(part), 3)))
                start += len(part.vertex)
                refuse_too_many(sum(map(len, corners)) // 3)
    except (known.DaeError, ArithmeticError, AttributeError, LookupError, TypeError) as error:
        raise ValueError(f"{type(error).__name__}: {error}") from error
    asset = document.assetInfo
    told = [asset.unitmeter or 0.0, len(document.errors), "XYZ".index(asset.upaxis[0])]
    return _polygons(points, corners, sizes) | {"told": np.array(told, dtype=np.float64)}


def _read_vtk(module: Any, arrays: Mapping[str, npt.NDArray[Any]], _fields: Mapping[str, Any]) -> _Arrays:
    # Two of VTK's hundred modules, neither of which draws.
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkIOLegacy import vtkPolyDataReader

    data, told = arrays["file"].tobytes(), vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(told)
    if data.startswith(b"# vtk"):
        reader = vtkPolyDataReader()
        reader.SetBinaryInputString(data, len(data))  # type: ignore[arg-type]
    else:
        reader = module.vtkXMLPolyDataReader()
        reader.SetInputString(data)
    reader.ReadFromInputStringOn()
    reader.Update()
    surface = reader.GetOutput()
    # A file that is cut short gives what there is, and only the window says so, with addresses.
    if told.GetOutput() or not surface.GetNumberOfPoints():
        raise ValueError(message("it is damaged, or holds no surface of polygons (PolyData)"))
    if surface.GetNumberOfStrips():
        triangles = vtkTriangleFilter()
        triangles.SetInputData(surface)
        triangles.Update()
        surface = triangles.GetOutput()
    cells = surface.GetPolys()
    offsets, corners = (
        vtk_to_numpy(each) for each in (cells.GetOffsetsArray(), cells.GetConnectivityArray())
    )
    return _polygons([vtk_to_numpy(surface.GetPoints().GetData())], [corners], [np.diff(offsets)])


def _read_step(module: Any, arrays: Mapping[str, npt.NDArray[Any]], fields: Mapping[str, Any]) -> _Arrays:
    # In one thread: the same file gives the same bytes.
    made = module.load(
        arrays["file"].tobytes(), "step", fields["tolerance"], fields["angle"], use_parallel=False
    )
    if not made:
        raise ValueError(message("it is damaged, or holds no solids or surfaces"))
    return {"file": np.frombuffer(made, np.int8)}


def _polygons(points: list[Any], corners: list[Any], sizes: list[Any]) -> _Arrays:
    return {
        "vertices": np.concatenate([np.zeros((0, 3)), *points]).astype(np.float64),
        "corners": np.concatenate([np.zeros(0), *corners]).astype(np.int32),
        "sizes": np.concatenate([np.zeros(0), *sizes]).astype(np.int32),
    }


def _mesh(vertices: Any, faces: Any) -> _Arrays:
    return {
        "vertices": np.asarray(vertices, dtype=np.float64).reshape(-1, 3),
        "faces": np.asarray(faces, dtype=np.int32).reshape(-1, 3),
    }


_Function = Callable[[Any, Mapping[str, "npt.NDArray[Any]"], Mapping[str, Any]], _Arrays]
_OPERATIONS: dict[Operation, tuple[Library, _Function]] = {
    Operation.ALPHA_WRAP: (Library.MESHLAB, _alpha_wrap),
    Operation.CUT: (Library.CGAL, _cut),
    Operation.READ_DAE: (Library.COLLADA, _read_dae),
    Operation.READ_VTK: (Library.VTK, _read_vtk),
    Operation.READ_STEP: (Library.CASCADIO, _read_step),
}
