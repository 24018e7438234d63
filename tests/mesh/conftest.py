"""Small meshes with known answers, in millimetres, and the files that hold them."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

REAL = Path(__file__).parents[2].parent / "shared" / "data" / "probes"


@pytest.fixture(scope="session")
def ball() -> trimesh.Trimesh:
    """A closed mesh of 320 facets whose coordinates are exact in float32 and in text."""
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=40.0)
    vertices = np.round(mesh.vertices * 1024) / 1024 + [0.0, 0.0, 120.0]
    return trimesh.Trimesh(vertices, mesh.faces, process=False)


@pytest.fixture(scope="session")
def box() -> tuple[np.ndarray, np.ndarray]:
    """A closed box of 60 x 40 x 20 mm in metres, 8 vertices and 12 facets, facing outwards."""
    mesh = trimesh.creation.box(extents=(0.06, 0.04, 0.02))
    return np.array(mesh.vertices), np.array(mesh.faces)


FORMATS = {
    "binary.stl": lambda mesh: mesh.export(file_type="stl"),
    "text.stl": lambda mesh: mesh.export(file_type="stl_ascii").encode(),
    "binary.ply": lambda mesh: mesh.export(file_type="ply"),
    "text.ply": lambda mesh: mesh.export(file_type="ply", encoding="ascii"),
    "mesh.obj": lambda mesh: mesh.export(file_type="obj").encode(),
}


@pytest.fixture(params=sorted(FORMATS))
def format_name(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="session")
def encode() -> Callable[[trimesh.Trimesh, str], bytes]:
    return lambda mesh, name: FORMATS[name](mesh)


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, bytes | str], Path]:
    def write(name: str, data: bytes | str) -> Path:
        path = tmp_path / name
        path.write_bytes(data.encode() if isinstance(data, str) else data)
        return path

    return write


@pytest.fixture(scope="session")
def ply_text() -> Callable[..., str]:
    """A text PLY from its rows: `vertices` are x y z rows, `faces` are rows as they stand in the file."""

    def make(
        vertices: list[str],
        faces: list[str],
        *,
        face_properties: tuple[str, ...] = ("list uchar int vertex_indices",),
        before: str = "",
        rows_before: tuple[str, ...] = (),
    ) -> str:
        out = io.StringIO()
        out.write("ply\nformat ascii 1.0\ncomment made by hand\n" + before)
        out.write(f"element vertex {len(vertices)}\n")
        out.writelines(f"property double {axis}\n" for axis in "xyz")
        out.write(f"element face {len(faces)}\n")
        out.writelines(f"property {text}\n" for text in face_properties)
        out.write("end_header\n")
        out.writelines(row + "\n" for row in (*rows_before, *vertices, *faces))
        return out.getvalue()

    return make


@pytest.fixture(params=["linear-l14-5.stl", "convex-c5-2.stl"])
def real_file(request: pytest.FixtureRequest) -> Path:
    path = REAL / request.param
    if not path.is_file():
        pytest.skip(f"the real probe mesh {path.name} is not beside the repository")
    return path
