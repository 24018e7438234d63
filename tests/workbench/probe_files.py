"""Small meshes as they come from a CAD program, and sessions around them."""

import numpy as np
import trimesh


def egg(folder, name="egg.stl", facets=3, scale=1.0):
    """Write a closed mesh, 40 x 30 x 70 mm; return its file."""
    ball = trimesh.creation.icosphere(facets, 1.0)
    ball.apply_scale(np.array([20.0, 15.0, 35.0]) * scale)
    file = folder / name
    file.write_bytes(ball.export(file_type=file.suffix[1:]))
    return file


def text_stl(vertices, faces):
    """Return an ASCII STL file, with whatever numbers it is given."""
    lines = ["solid a"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {' '.join(map(str, vertices[corner]))}" for corner in face]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid a"])


def bad_meshes(folder):
    """Write files that are no mesh: name -> word that the sentence about it must hold."""
    good = egg(folder, "good.stl").read_bytes()
    contents = {
        "cut.stl": good[: len(good) // 2],
        "empty.stl": b"",
        "letter.stl": b"Dear Sir or Madam,\n" * 20,
        "numbers.stl": text_stl([[0, 0, 0], [60, 0, 0], [0, float("nan"), 40]], [[0, 1, 2]]).encode(),
        "letter.txt": b"solid",
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    with (folder / "huge.stl").open("wb") as file:
        file.truncate(3 * 2**30)
    words = {"empty.stl": "empty", "numbers.stl": "not finite", "huge.stl": "512 MiB", "letter.txt": "suffix"}
    return {folder / name: words.get(name, name) for name in (*contents, "huge.stl")}
