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
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from types import TracebackType

    import numpy.typing as npt

    Mesh = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]

_MODULES = {
    "fast-simplification": "fast_simplification",
    "pymeshlab": "pymeshlab",
    "open3d": "open3d",
    "point_cloud_utils": "point_cloud_utils",
}
LIBRARIES = tuple(_MODULES)
RIVALS = LIBRARIES[:2]  # those that are measured wherever probes are prepared


@dataclass(frozen=True, eq=False)
class BareResult:
    """What a library made, and how long it took."""

    vertices: npt.NDArray[np.float64]  # (n, 3) float64. In the unit of what was given.
    faces: npt.NDArray[np.int32]  # (m, 3) int32
    seconds: float  # Of the library's own calls


class Rival:
    """A library's own process; a context manager."""

    def __init__(self, library: str, folder: Path) -> None:
        self.library = library
        self._folder = folder
        self._child = subprocess.Popen(
            [sys.executable, "-m", "benchmarks.preparation.rivals", library],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        try:
            self._answer()
        except InputError:
            self.close()
            extra = "meshlab" if library in RIVALS else "rivals"
            raise InputError(f"{library} is not installed: pip install contactbench[{extra}]") from None

    def __enter__(self) -> Rival:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def simplify(
        self, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], count: int
    ) -> BareResult:
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
    module = importlib.import_module(_MODULES[library])
    simplify = {
        "fast-simplification": _fast,
        "pymeshlab": _meshlab,
        "open3d": _open3d,
        "point_cloud_utils": _point_cloud_utils,
    }[library]
    # What the libraries print must not get between the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    _say(answers, {"ready": True})
    for line in sys.stdin:
        call = json.loads(line)
        with np.load(call["given"], allow_pickle=False) as arrays:
            vertices, faces = arrays["vertices"], arrays["faces"]
        began = time.perf_counter()
        made, facets = simplify(module, vertices, faces, call["count"])
        seconds = time.perf_counter() - began
        np.savez(call["made"], vertices=np.asarray(made, np.float64), faces=np.asarray(facets, np.int32))
        _say(answers, {"seconds": seconds})


def _fast(
    module: Any, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], count: int
) -> tuple[Any, Any]:
    made, facets = module.simplify(vertices, faces, target_count=count)
    return made, facets


def _meshlab(
    module: Any, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], count: int
) -> tuple[Any, Any]:
    meshes = module.MeshSet(verbose=False)
    meshes.add_mesh(module.Mesh(vertex_matrix=vertices, face_matrix=faces))
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=count)
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


def _open3d(
    module: Any, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], count: int
) -> tuple[Any, Any]:
    vector = module.utility
    mesh = module.geometry.TriangleMesh(vector.Vector3dVector(vertices), vector.Vector3iVector(faces))
    made = mesh.simplify_quadric_decimation(target_number_of_triangles=count)
    return made.vertices, made.triangles


def _point_cloud_utils(
    module: Any, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], count: int
) -> tuple[Any, Any]:
    made, facets, *_ = module.decimate_triangle_mesh(vertices, faces, max_faces=count)
    return made, facets


def _say(answers: IO[str], line: dict[str, Any]) -> None:
    answers.write(json.dumps(line) + "\n")
    answers.flush()


if __name__ == "__main__":
    _serve(sys.argv[1])
