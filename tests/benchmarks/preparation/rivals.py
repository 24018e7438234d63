"""
The simplification libraries called bare, in a child process of the study: what anyone gets without this project.

The child imports its library by name, as the engines do: pymeshlab is GPL-3, and no module here imports it.
It takes its own time around nothing but the library's calls, so that starting it and passing meshes is not counted.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from types import TracebackType

    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Ints = npt.NDArray[np.int32]

LIBRARIES = ("fast-simplification", "pymeshlab", "open3d", "vtk", "vtk decimate pro", "meshoptimizer")


@dataclass(frozen=True, eq=False)
class BareResult:
    """What a library made, and how long it took."""

    vertices: Floats  # (n, 3) float64. In the unit of what was given.
    faces: Ints  # (m, 3) int32
    seconds: float  # Of the processor, in the library's own calls


class Rival:
    """A library's own process, under an interpreter that has it; a context manager."""

    def __init__(self, library: str, folder: Path, interpreter: Path | None = None) -> None:
        self.library = library
        self._folder = folder
        self._child = subprocess.Popen(
            [interpreter or sys.executable, "-m", "benchmarks.preparation.rivals", library],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        try:
            self._answer()
        except InputError:
            self.close()
            raise InputError(
                f"{library} is not installed: pip install contactbench[meshlab,rivals]"
            ) from None

    def __enter__(self) -> Rival:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def simplify(self, vertices: Floats, faces: Ints, count: int) -> BareResult:
        """Let the library simplify with its defaults."""
        given, made = self._folder / f"{self.library}-in.npz", self._folder / f"{self.library}-out.npz"
        np.savez(given, vertices=vertices, faces=faces)
        call = json.dumps({"given": str(given), "made": str(made), "count": count})
        assert self._child.stdin is not None
        try:
            self._child.stdin.write(call + "\n")
            self._child.stdin.flush()
        except BrokenPipeError:
            pass  # what came before it has ended the process, and so there is no answer
        seconds = float(self._answer()["seconds"])
        with np.load(made, allow_pickle=False) as arrays:
            return BareResult(arrays["vertices"], arrays["faces"], seconds)

    def close(self) -> None:
        """End the process."""
        self._child.kill()
        self._child.wait()
        for pipe in (self._child.stdin, self._child.stdout):
            if pipe is not None:
                # A call that was not sent is still in the buffer.
                with contextlib.suppress(BrokenPipeError):
                    pipe.close()

    def _answer(self) -> dict[str, Any]:
        assert self._child.stdout is not None
        line = self._child.stdout.readline()
        if not line:
            raise InputError(f"{self.library}, called bare, ended its process: try another mesh")
        answer: dict[str, Any] = json.loads(line)
        return answer


# ---- in the child --------------------------------------------------------------------------------


def _serve(library: str) -> None:
    name, simplify = {
        "fast-simplification": ("fast_simplification", _fast),
        "pymeshlab": ("pymeshlab", _meshlab),
        "open3d": ("open3d", _open3d),
        "vtk": ("vtkmodules.all", partial(_vtk, way="vtkQuadricDecimation")),
        "vtk decimate pro": ("vtkmodules.all", partial(_vtk, way="vtkDecimatePro")),
        "meshoptimizer": ("meshoptimizer", _meshoptimizer),
    }[library]
    module = importlib.import_module(name)
    # What the libraries print must not get between the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    _say(answers, {"ready": True})
    for line in sys.stdin:
        call = json.loads(line)
        with np.load(call["given"], allow_pickle=False) as arrays:
            vertices, faces = arrays["vertices"], arrays["faces"]
        began = time.process_time()
        made, facets = simplify(module, vertices, faces, call["count"])
        seconds = time.process_time() - began
        np.savez(call["made"], vertices=np.asarray(made, np.float64), faces=np.asarray(facets, np.int32))
        _say(answers, {"seconds": seconds})


def _fast(module: Any, vertices: Floats, faces: Ints, count: int) -> tuple[Any, Any]:
    made, facets = module.simplify(vertices, faces, target_count=count)
    return made, facets


def _meshlab(module: Any, vertices: Floats, faces: Ints, count: int) -> tuple[Any, Any]:
    meshes = module.MeshSet(verbose=False)
    meshes.add_mesh(module.Mesh(vertex_matrix=vertices, face_matrix=faces))
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=count)
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


def _open3d(module: Any, vertices: Floats, faces: Ints, count: int) -> tuple[Any, Any]:
    vector = module.utility
    mesh = module.geometry.TriangleMesh(vector.Vector3dVector(vertices), vector.Vector3iVector(faces))
    made = mesh.simplify_quadric_decimation(target_number_of_triangles=count)
    return made.vertices, made.triangles


def _vtk(module: Any, vertices: Floats, faces: Ints, count: int, way: str) -> tuple[Any, Any]:
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

    points, cells, mesh = module.vtkPoints(), module.vtkCellArray(), module.vtkPolyData()
    points.SetData(numpy_to_vtk(vertices))
    cells.SetData(3, numpy_to_vtkIdTypeArray(faces.astype(np.int64).ravel(), deep=True))
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    work = getattr(module, way)()
    work.SetInputData(mesh)
    work.SetTargetReduction(1 - (count + 0.5) / len(faces))
    work.Update()
    made, corners = work.GetOutput(), work.GetOutput().GetPolys().GetConnectivityArray()
    return vtk_to_numpy(made.GetPoints().GetData()), vtk_to_numpy(corners).reshape(-1, 3)


def _meshoptimizer(module: Any, vertices: Floats, faces: Ints, count: int) -> tuple[Any, Any]:
    made, corners = np.zeros(faces.size, np.uint32), faces.astype(np.uint32).ravel()
    kept = module.simplify(
        made, corners, vertices.astype(np.float32), target_index_count=3 * count, target_error=1e3
    )
    return vertices, made[:kept].reshape(-1, 3)


def _say(answers: IO[str], line: dict[str, Any]) -> None:
    answers.write(json.dumps(line) + "\n")
    answers.flush()


if __name__ == "__main__":
    _serve(sys.argv[1])
