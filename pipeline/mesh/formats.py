"""What a mesh file is, which its content decides and not its name, and the mesh that it holds."""

import codecs
import gzip
import io
import re
import stat
import zlib
from collections.abc import Callable
from dataclasses import replace
from itertools import chain, islice
from pathlib import PurePath

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.mesh.engines.operations import read_dae, read_step, read_vtk
from contactbench.pipeline.mesh.gltf import read_gltf
from contactbench.pipeline.mesh.obj import read_obj
from contactbench.pipeline.mesh.off import read_off
from contactbench.pipeline.mesh.parse import RawMesh, Reading, refuse_too_many
from contactbench.pipeline.mesh.ply import read_ply
from contactbench.pipeline.mesh.stl import is_binary, read_stl
from contactbench.pipeline.mesh.threemf import read_threemf
from contactbench.pipeline.settings import MESH_FORMATS

_LARGEST_FILE = 2**29
_HEAD, _NOTED = 2**12, 2**16

# Each takes the bytes of a whole file; facets stay in its order.
_READERS: dict[str, Callable[[bytes], RawMesh]] = {
    ".stl": read_stl, ".ply": read_ply, ".obj": read_obj, ".off": read_off, ".3mf": read_threemf, ".glb": read_gltf,
}  # fmt: skip
# These work in another process, and can be stopped.
_FOREIGN: dict[str, Callable[[bytes, Reading], RawMesh]] = {
    ".dae": read_dae, ".vtk": read_vtk, ".step": read_step,
}  # fmt: skip
IN_METRES = (".glb", ".dae")
SUFFIXES = (*chain(*MESH_FORMATS.values()), ".gz")

# What is no mesh, or none yet: what to do instead.
_OTHERS = {
    ".iges": message(
        "this is an IGES file: it contains the curved surfaces of a CAD program but no triangles. Open it in a CAD"
        " program and export the part as STEP or 3MF, or as STL in millimetres, with a tolerance of 0.01 mm."
    ),
    ".lfs": message(
        "this is a Git LFS pointer; the mesh itself was not downloaded. Run 'git lfs pull' in its repository."
    ),
    ".html": message(
        "this is a web page, not a mesh. Download the file itself ('Raw' or 'Download' on the page)."
    ),
}
_SAME = {each: first for first, *others in MESH_FORMATS.values() for each in others}
_SAME |= {".p21": ".step", ".igs": ".iges"}

# How files begin. OBJ, and STL that is not text, have no sign of their own.
_SIGNS = {
    suffix: re.compile(sign, re.I | re.S)
    for suffix, sign in {
        ".lfs": rb"version https://git-lfs\.github\.com/",
        ".html": rb"\s*<(?:!doctype\s+)?html\b",
        ".step": rb"\s*ISO-10303-21\s*;",
        # Column 73 of an IGES line names its section, the first of which is S, and then it is numbered.
        ".iges": rb"[ -~]{72}S {0,6}0*1(?!\d)",
        ".3mf": rb"PK\x03\x04",
        ".glb": rb'glTF[\x00-\x09]|\s*\{.*"asset"\s*:',
        ".ply": rb"ply\s+(?:format|comment|obj_info)\s",
        ".off": rb"(?:ST|C|N){0,3}OFF\s+[#\d]",
        ".vtk": rb"# vtk DataFile Version|\s*<(?:\?xml[^>]*>\s*<)?(?:!--[^>]*>\s*<)?VTKFile\b",
        ".dae": rb"\s*<(?:\?xml[^>]*>\s*<)?(?:!--[^>]*>\s*<)?COLLADA\b",
        ".stl": rb"\s*solid\b.*\bfacet\s+normal\b",
    }.items()
}


def read_format(file: File, reading: Reading) -> tuple[RawMesh, bytes, str]:
    """
    Read a file by what it holds.

    Parameters
    ----------
    file : path
        Its suffix counts where the content has no sign; a file that gzip packed is unpacked.
    reading : Reading

    Returns
    -------
    raw : RawMesh
        With a note where the suffix was wrong.
    notes : bytes
        What the file says to people, see `notes_in`.
    suffix : str
        That of the format which was read.

    Raises
    ------
    MeshError
        It cannot be reached, is too large, or holds no mesh; says what it is instead.
    Cancelled
        As asked for.
    """
    data = _content(file)
    named = plain_name(file).suffix.lower()
    suffix = _found(data, _SAME.get(named, named))
    if suffix in _OTHERS:
        raise MeshError(_OTHERS[suffix])
    if suffix not in _READERS and suffix not in _FOREIGN:
        raise MeshError(
            f"the suffix {arg(named)!r} is not one of {arg(', '.join(SUFFIXES))}, and the content is none of these"
            " formats: export the part as one of them."
        )
    raw = _FOREIGN[suffix](data, reading) if suffix in _FOREIGN else _READERS[suffix](data)
    refuse_too_many(len(raw.faces))
    if raw.settled and file.suffix.lower() != ".ply":
        raise MeshError("this is a probe that contactbench wrote: unpack it, and end its name in .ply.")
    if suffix != _SAME.get(named, named):
        note = message(f"The file's name ends in {arg(named)!r}, but it holds {arg(suffix[1:].upper())}.")
        raw = replace(raw, notes=(*raw.notes, note))
    return raw, notes_in(data, suffix), suffix


def plain_name(file: File) -> PurePath:
    """Return a file's name without what gzip adds to it."""
    name = PurePath(file.name)
    return PurePath(name.stem) if name.suffix.lower() == ".gz" else name


def _found(data: bytes, named: str) -> str:
    """Return the suffix of what the bytes are, `named` where nothing tells."""
    if named == ".stl" and is_binary(data):  # whatever its header says
        return named
    head = data[:_HEAD].removeprefix(codecs.BOM_UTF8)
    signed = next((suffix for suffix, sign in _SIGNS.items() if sign.match(head)), None)
    return signed or (".stl" if is_binary(data) else named)


def _content(file: File) -> bytes:
    try:
        status = file.stat()
    except FileNotFoundError:
        raise MeshError("there is no such file: check the path.") from None
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise MeshError(f"the file cannot be reached ({arg(error)}): check the path.") from error
    _check_file(status.st_mode, status.st_size)
    try:
        data = file.read_bytes()
    except OSError as error:
        raise MeshError(f"the file cannot be read ({arg(error)}): check its permissions.") from error
    return _unpacked(data) if data.startswith(b"\x1f\x8b") else data


def _unpacked(data: bytes) -> bytes:
    """Unpack what gzip packed, whatever length it says that is."""
    try:
        with gzip.open(io.BytesIO(data)) as stream:
            # In pieces: room for all that is asked for is taken at once.
            data = b"".join(islice(iter(lambda: stream.read(2**20), b""), _LARGEST_FILE // 2**20 + 1))
    except (OSError, EOFError, zlib.error) as error:
        raise MeshError(f"the gzip file is damaged ({arg(error)}): copy or pack it again.") from error
    _check_file(stat.S_IFREG, len(data))
    return data


def notes_in(data: bytes, suffix: str) -> bytes:
    """
    Give the part of a file that is meant for people: comments, or an STL file's header.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        ".stl", ".ply", ".obj" or ".off"; another has no such part.

    Returns
    -------
    bytes
        At most 64 KiB.
    """
    head = data[:_NOTED]
    match suffix:
        case ".stl":
            return head[:80].partition(b"\n")[0]
        case ".ply":
            header = head.partition(b"end_header")[0]
            return b"\n".join(re.findall(rb"^(?:comment|obj_info)\b(.*)$", header, re.M))
        case ".obj" | ".off":
            return b"\n".join(re.findall(rb"#(.*)", head))
        case _:
            return b""


def _check_file(mode: int, size: int) -> None:
    if stat.S_ISDIR(mode):
        raise MeshError("this is a folder: choose a mesh file inside it.")
    if not stat.S_ISREG(mode):
        raise MeshError("this is a device or a pipe, not a file: choose a mesh file.")
    if size == 0:
        raise MeshError("the file is empty: copy or export it again.")
    if size > _LARGEST_FILE:
        raise MeshError(
            f"the file has {arg(size)} bytes, more than 512 MiB: export the part with fewer facets."
        )
