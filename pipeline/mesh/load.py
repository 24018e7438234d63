"""From a mesh file to a probe in S: units, mount, merging, and refusing what cannot be right."""

import math
import os
import re
import warnings
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import MeshError, MeshWarning, arg, capitalised, join, message
from contactbench.pipeline.files import File, as_file
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.mesh.formats import IN_METRES, plain_name, read_format
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.mesh.parse import MERGE, RawMesh, Reading
from contactbench.pipeline.mesh.probe import (
    LARGEST_M,
    SMALLEST_M,
    Probe,
    build_probe,
    check_faces,
    check_invented,
    check_region,
    check_vertices,
    degenerate_facets,
    extent,
    refuse_size,
)
from contactbench.pipeline.mesh.triangles import flip_flat_facets, merge_vertices
from contactbench.pipeline.settings import MeshSettings

Units = Literal["m", "cm", "mm", "in"]

# Metres per unit as a fraction: 120 / 1000 is the float nearest to 0.12, 120 * 0.001 need not be.
METRES: dict[Units, tuple[int, int]] = {"m": (1, 1), "cm": (1, 100), "mm": (1, 1000), "in": (127, 5000)}

NAMES: dict[Units, str] = {"mm": "millimetres", "m": "metres", "cm": "centimetres", "in": "inches"}

# How often CAD programs and scanners write them.
_USUAL: tuple[Units, ...] = ("mm", "m", "cm", "in")

# A probe's largest extent is nearly always between these.
LIKELY_M = (0.03, 0.6)
_TYPICAL_M = 0.07

_NAMED: dict[Units, str] = {
    "mm": r"mm|millimet(?:er|re)s?", "cm": r"cm|centimet(?:er|re)s?", "in": r"inch(?:es)?", "m": r"met(?:er|re)s?",
}  # fmt: skip
_WORD = "|".join(_NAMED.values())

# A unit in a comment may be that of a tolerance or a screw: only a declaration tells what the numbers are. "in" and "m"
# alone are a word and a letter, so they count only right after it.
_DECLARED = re.compile(
    r"(?<![a-z])(?:(?:length|linear|file)[ _-]?)?units?(?:[ _-]of[ _-](?:length|measure(?:ment)?))?"
    r"(?:[ \t]*[:=(][ \t]*|[ \t]+(?:is|are)[ \t]+(?:in[ \t]+)?|[ \t]+in[ \t]+|[ \t]+)"
    rf"({_WORD}|(?:m|in)(?![ \t]*[a-z0-9]))(?![a-z])"
    r"|(?<![a-z])(?:exported|saved|written|modelled|drawn|lengths?|dimensions?|coordinates?|vertices|numbers|values)"
    rf"[ \t]+(?:is[ \t]+|are[ \t]+)?(?:given[ \t]+)?in[ \t]+({_WORD})(?![a-z])",
    re.I | re.ASCII,
)  # fmt: skip


@dataclass(frozen=True)
class UnitGuess:
    """
    The unit that a file's numbers are most likely in.

    Attributes
    ----------
    units : {"mm", "m", "cm", "in"}
        The best guess.
    certain : bool
        Nothing else makes sense; where False, a person has to say.
    reason : str
        In sentences; where not certain they end in the question.
    alternatives : tuple of units
        Others that are possible, the more usual first.
    """

    units: Units
    certain: bool
    reason: str
    alternatives: tuple[Units, ...]

    @property
    def doubt(self) -> str:
        """What to say to whoever goes on with the guess; empty where it is certain."""
        return (
            ""
            if self.certain
            else message(f"{arg(self.reason)} {arg(capitalised(NAMES[self.units]))} are assumed.")
        )


def guess_units(
    span: float,
    *,
    notes: bytes = b"",
    farthest: float = 0.0,
    stated: Units | None = None,
    defined: Units | None = None,
) -> UnitGuess:
    """
    Guess the unit of a mesh file's numbers.

    Parameters
    ----------
    span : float
        Largest extent of the surface along an axis, in the file's numbers.
    notes : bytes
        What the file says to people, see `notes_in`.
    farthest : float
        Largest absolute coordinate in the file's numbers: a probe lies within some metres of its origin.
    stated : {"mm", "m", "cm", "in"}, optional
        The unit that the file itself states; taken at its word where the size can be that of a probe.
    defined : {"mm", "m", "cm", "in"}, optional
        The unit that every file of the format should have, which many programs forget.

    Returns
    -------
    UnitGuess

    Raises
    ------
    MeshError
        With no unit is the size that of a probe, 5 mm to 2 m.
    """
    if stated is not None and SMALLEST_M <= in_metres(span, stated) <= LARGEST_M:
        return UnitGuess(
            stated, True, message(f"The file states that its numbers are {arg(NAMES[stated])}."), ()
        )
    possible = [unit for unit in _USUAL if SMALLEST_M <= in_metres(span, unit) <= LARGEST_M]
    if not possible:
        raise MeshError(
            f"the numbers span {arg(span):.4g}, which cannot be a probe in millimetres, metres,"
            " centimetres or inches (5 mm to 2 m). Check that the right part was exported."
        )
    likely = [unit for unit in possible if LIKELY_M[0] <= in_metres(span, unit) <= LIKELY_M[1]]
    # Where millimetres and metres are out of the question, the size of the usual probe decides.
    likely.sort(key=lambda unit: (unit not in _USUAL[:2], abs(math.log(in_metres(span, unit) / _TYPICAL_M))))
    near = [unit for unit in likely if in_metres(farthest, unit) <= 5 * LARGEST_M]
    ranked = [*near, *(u for u in likely if u not in near), *(u for u in possible if u not in likely)]
    declared = {whole} if (whole := defined or stated) else _declared(notes)
    if len(declared) == 1:
        (unit,) = declared
        others = tuple(other for other in ranked if other != unit)
        if unit in likely or (unit in possible and not likely):
            return UnitGuess(
                unit, True, message(f"{arg(_declares(unit, defined))}, and {arg(_says(span, unit))}."), others
            )
        said = message(
            f" {arg(_declares(unit, defined))}, but {arg(_unlikely(span, unit, unit in possible))}."
        )
        return UnitGuess(ranked[0], False, _question(span, ranked) + said, tuple(ranked[1:]))
    said = ""
    if declared:
        said = message(
            f" The file declares several units: {arg(', '.join(NAMES[unit] for unit in NAMES if unit in declared))}."
        )
    # Few programs write centimetres or inches; alone the size is too little to believe it. And nothing is as sure as
    # that where another unit makes a small probe, or the hub of a needle.
    smaller = any(in_metres(span, unit) < LIKELY_M[0] for unit in possible)
    if len(near or likely) == 1 and ranked[0] in ("mm", "m") and not declared and not smaller:
        return UnitGuess(ranked[0], True, _contrast(span, ranked), tuple(ranked[1:]))
    return UnitGuess(ranked[0], False, _question(span, ranked) + said, tuple(ranked[1:]))


def refuse_doubt(file: File, guess: UnitGuess | None) -> None:
    """Refuse to go on with numbers whose unit nobody can tell; MeshError with the sizes to choose from."""
    if guess is not None and not guess.certain:
        raise MeshError(f"{arg(file)}: the unit cannot be determined. {arg(guess.reason)}")


def refuse_to_guess(file: File, given: MeshSettings) -> None:
    """Refuse to make a probe of numbers whose unit nobody can tell; as `refuse_doubt`."""
    if given.units == "auto":
        refuse_doubt(file, read_mesh(file, tolerance=given.tolerance / 1000).guess)


def in_metres(length: float, units: Units) -> float:
    """Convert a length in a file's numbers to metres."""
    numerator, denominator = METRES[units]
    return length * numerator / denominator


def _declared(notes: bytes) -> set[Units]:
    """Find the units that notes declare."""
    words = [first or second for first, second in _DECLARED.findall(notes.decode("latin-1"))]
    return {
        unit
        for unit, names in _NAMED.items()
        if any(word.lower() == unit or re.fullmatch(names, word, re.I) for word in words)
    }


def _declares(unit: Units, defined: Units | None) -> str:
    return (
        message(f"The format is defined in {arg(NAMES[unit])}")
        if defined
        else message(f"The file declares {arg(NAMES[unit])}")
    )


def _unlikely(span: float, unit: Units, possible: bool) -> str:
    size = _size(span, unit)
    if not possible:
        return message(f"{arg(size)} is impossible")
    return (
        message(f"{arg(size)} is small for a probe")
        if in_metres(span, unit) < LIKELY_M[0]
        else message(f"{arg(size)} is large for a probe")
    )


def _says(span: float, unit: Units) -> str:
    return message(f"{arg(_size(span, unit))} is a probe")


def _contrast(span: float, ranked: list[Units]) -> str:
    others = join(
        "",
        (
            message(f"; it is {arg(_millimetres(span, unit))} long if they are {arg(NAMES[unit])}")
            for unit in ranked[1:]
        ),
    )
    return message(f"The numbers span {arg(_number(span))}: {arg(_says(span, ranked[0]))}{arg(others)}.")


def _question(span: float, ranked: list[Units]) -> str:
    first, *others = (
        message(f"{arg(_millimetres(span, unit))} if they are {arg(NAMES[unit])}") for unit in ranked[:3]
    )
    choices = (
        join("", (message(f", {arg(other)}") for other in others)) if others else message(", an unusual size")
    )
    options = ", ".join(ranked[:3])
    options = " or ".join(options.rsplit(", ", 1))
    return message(
        f"The numbers span {arg(_number(span))}: the longest side is {arg(first)}{arg(choices)}."
        f" Measure the probe and give --units {arg(options)}."
    )


def _millimetres(span: float, unit: Units) -> str:
    return f"{in_metres(span, unit) * 1000:.4g} mm"


def _size(span: float, unit: Units) -> str:
    return f"{_number(span)} {unit}"


def _number(span: float) -> str:
    return f"{span:.4g}" if span < 1e5 else f"{span:.0f}"


_RIGID = 1e-6
_FARTHEST_MOUNT_M = 10.0


@dataclass(frozen=True, eq=False)
class MeshFile:
    """
    A mesh file, read but not converted.

    Attributes
    ----------
    raw : RawMesh
        What it holds, with vertices that are finite and facets whose indices are in range.
    guess : UnitGuess or None
        What its numbers are, where that was to be found out.
    units : {"mm", "m", "cm", "in"}
        The unit to use.
    suffix : str
        That of the format that the content has: ".stl" whatever the file's name.
    """

    raw: RawMesh
    guess: UnitGuess | None
    units: Units
    suffix: str = ".ply"

    @property
    def notes(self) -> tuple[str, ...]:
        """What was repaired while it was read, and what is doubtful about its unit, in sentences."""
        doubt = () if self.guess is None or self.guess.certain else (self.guess.doubt,)
        return (*self.raw.notes, *doubt)


def load_probe(
    path: str | os.PathLike[str],
    units: Units | Literal["auto"] = "auto",
    mount: npt.ArrayLike | None = None,
    *,
    name: str | None = None,
) -> Probe:
    """
    Read a probe from a mesh file, or a STEP file tessellated to 0.02 mm.

    Polygons become triangles, vertices that coincide within 1e-7 of the size are merged, and unused vertices and
    facets without area are left out. A file written by `save_probe` is used unchanged. Repairs and remaining
    defects are reported in one `MeshWarning`; the defects are also in ``probe.health``.

    Parameters
    ----------
    path : str or path
        The file; its content determines the format.
    units : {"mm", "m", "cm", "in", "auto"}
        Unit of the file's numbers, which most files do not state. "auto" guesses from the size and the file's
        comments, and warns if that is uncertain, for example if both inches and centimetres give a probe. A 3MF
        file states its unit; a different one given here is used and reported. Files of `save_probe` are in metres.
    mount : (4, 4) array_like, optional
        T_SP, the rigid transform from the mesh's frame P to the sensor frame S, translation in metres:
        p_S = T_SP @ p_P, after the units are converted. Default: P equals S.
    name : str, optional
        Name of the probe. Default: the file's name without suffix.

    Returns
    -------
    Probe
        In metres and S. A PLY face property `region` of integers becomes ``probe.region``; files of `save_probe`
        also keep `untouchable`.

    Raises
    ------
    MeshError
        The file is missing, not a complete mesh, or holds bad numbers; the size is under 5 mm or over 2 m
        with these units, or with all of them; no facet has an area; the mount is not rigid. The message names the
        file.

    Notes
    -----
    The memory that a file can allocate is bounded, see `contactbench.pipeline.mesh.parse`: files over 512 MiB
    or with more than four million facets are refused.
    """
    T_SP = None if mount is None else _rigid(mount)
    file = as_file(path)
    read = read_mesh(file, units)
    probe = probe_of(file, read, T_SP, name)
    sentences = (*read.notes, *probe.health.sentences)
    if sentences:
        warnings.warn(f"{file}: " + join(" ", sentences), MeshWarning, stacklevel=2)
    return probe


def read_mesh(
    path: str | os.PathLike[str],
    units: Units | Literal["auto"] = "auto",
    *,
    tolerance: float = Reading.tolerance,
    monitor: Monitor = NOBODY,
) -> MeshFile:
    """
    Read a mesh file and settle what unit its numbers are in, before anything is merged or left out.

    Parameters
    ----------
    path : str or path
        The file; its content determines the format.
    units : {"mm", "m", "cm", "in", "auto"}
        See `load_probe`.
    tolerance : float
        How far facets may lie from the curved surfaces of a STEP file, m.
    monitor : Monitor
        Told and asked while a library reads the file in a process of its own.

    Returns
    -------
    MeshFile

    Raises
    ------
    MeshError
        As `load_probe`, except that facets without area and the size are not looked at. The message names the
        file.
    Cancelled
        As asked for.
    """
    if units not in (*get_args(Units), "auto"):
        raise MeshError(f"units={arg(units)!r} is not known: pass one of 'm', 'cm', 'mm', 'in', 'auto'.")
    file = as_file(path)
    try:
        raw, notes, suffix = read_format(file, Reading(tolerance, monitor))
        check_faces(raw.faces, len(raw.vertices))
        raw = _without_stray(raw)
        _refuse_not_finite(raw.vertices)
        check_vertices(raw.vertices)
        return _with_units(raw, notes, units, suffix)
    except MeshError as error:
        raise MeshError(f"{arg(file)}: {arg(error)}") from error


def _with_units(raw: RawMesh, notes: bytes, units: Units | Literal["auto"], suffix: str) -> MeshFile:
    if units != "auto" and not raw.settled:
        if raw.stated not in (None, units):
            told = message(
                f"The file states {arg(NAMES[raw.stated])}, but you asked for {arg(NAMES[units])}, which are used."
            )
            raw = replace(raw, notes=(*raw.notes, told))
        return MeshFile(raw, None, units, suffix)
    used = raw.vertices[raw.faces.ravel()]
    guess = guess_units(
        float(np.ptp(used, axis=0).max()),
        notes=notes,
        farthest=float(np.abs(used).max()),
        stated=raw.stated,
        defined="m" if suffix in IN_METRES else None,
    )
    return MeshFile(raw, guess, guess.units, suffix)


def _refuse_not_finite(vertices: Floats) -> None:
    bad: Mask = ~np.all(np.isfinite(vertices), axis=1)
    if bad.any():
        row, count = int(np.argmax(bad)), np.count_nonzero(bad)
        place = ", ".join(f"{value:g}" for value in vertices[row])
        all_ = (
            message(f"1 of {arg(len(bad))} vertices is")
            if count == 1
            else message(f"{arg(count)} of {arg(len(bad))} vertices are")
        )
        raise MeshError(
            f"vertex {arg(row + 1)} is ({arg(place)}); {arg(all_)} not finite. Repair the file or export it again."
        )


def _without_stray(raw: RawMesh) -> RawMesh:
    """Put points that are nowhere and that no facet uses, as scanners leave them, onto one that is used."""
    stray: Mask = ~np.all(np.isfinite(raw.vertices), axis=1)
    if raw.settled or not stray.any():
        return raw
    stray[raw.faces] = False
    if not stray.any():
        return raw
    vertices = raw.vertices.copy()
    vertices[stray] = vertices[raw.faces[0, 0]]
    count = np.count_nonzero(stray)
    note = message(f"Unused points that are not numbers were left out (points: {arg(count)}).")
    return replace(raw, vertices=vertices, notes=(*raw.notes, note))


def _rigid(mount: npt.ArrayLike) -> Floats:
    """Copy T_SP to (4, 4) float64, or say why it is not a rigid transform in metres."""
    try:
        T_SP = np.array(mount, dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise MeshError(
            f"mount is not a matrix of numbers ({arg(error)}): give a 4 x 4 transform T_SP."
        ) from error
    if T_SP.shape != (4, 4):
        raise MeshError(f"mount has shape {arg(T_SP.shape)}: give a 4 x 4 transform T_SP.")
    if not np.isfinite(T_SP).all():
        raise MeshError("mount holds NaN or infinity: give a finite 4 x 4 transform T_SP.")
    if np.abs(T_SP[3] - (0, 0, 0, 1)).max() > _RIGID:
        raise MeshError(
            f"mount has the last row {arg(T_SP[3].tolist())}, not [0, 0, 0, 1]: is it transposed?"
        )
    R_SP, p_SP_S = T_SP[:3, :3], T_SP[:3, 3]
    if np.abs(R_SP).max() > 1e3 or np.abs(R_SP.T @ R_SP - np.eye(3)).max() > _RIGID:
        raise MeshError(
            "mount scales or shears: its 3 x 3 part is not a rotation within 1e-6. Convert lengths with"
            " units, and give rotations with at least seven digits."
        )
    if np.linalg.det(R_SP) < 0:
        raise MeshError("mount mirrors the mesh (determinant -1): one axis has the wrong sign.")
    if np.abs(p_SP_S).max() > _FARTHEST_MOUNT_M:
        raise MeshError(f"mount moves the mesh by {arg(p_SP_S.tolist())} m: give the translation in metres.")
    return T_SP


def probe_of(file: File, read: MeshFile, T_SP: Floats | None = None, name: str | None = None) -> Probe:
    """Settle what `read_mesh` gave of a file, under the file's name unless told otherwise; an error names the file."""
    try:
        return settle(read, T_SP, plain_name(file).stem if name is None else name)
    except MeshError as error:
        raise MeshError(f"{arg(file)}: {arg(error)}") from error


def settle(read: MeshFile, T_SP: Floats | None, name: str) -> Probe:
    """
    Check, convert, merge, clean and move what a file holds.

    Parameters
    ----------
    read : MeshFile
        From `read_mesh`.
    T_SP : (4, 4) float64 or None
        Rigid, metres.
    name : str
        For people.

    Returns
    -------
    Probe

    Raises
    ------
    MeshError
        The size is that of no probe, or no facet has an area.
    """
    raw = read.raw
    vertices = check_vertices(raw.vertices)
    faces = check_faces(raw.faces, len(vertices))
    region = check_region(raw.region, len(faces))
    invented = check_invented(raw.invented, len(faces))
    _check_units(extent(vertices, faces), read.units)
    numerator, denominator = METRES[read.units]
    vertices = vertices * numerator / denominator
    if not raw.settled:
        vertices, faces = merge_vertices(vertices, faces, MERGE * extent(vertices, faces))
    dropped = int(np.count_nonzero(degenerate_facets(vertices, faces)))
    if dropped and not raw.settled:
        faces, origin = flip_flat_facets(vertices, faces)
        region, invented = region[origin], invented[origin]
    moved = vertices if T_SP is None else vertices @ T_SP[:3, :3].T + T_SP[:3, 3]
    # Moving rounds: a facet that is flat in the file may not be flat after it, and the other way round.
    flat = degenerate_facets(vertices, faces)
    if T_SP is not None:
        flat |= degenerate_facets(moved, faces)
    dropped = max(dropped, int(np.count_nonzero(flat)))
    if flat.all():
        raise MeshError(
            f"none of the {arg(len(faces))} facets has an area: export the part again, as a surface."
        )
    if flat.any():
        faces, region, invented = faces[~flat], region[~flat], invented[~flat]
    return build_probe(np.ascontiguousarray(moved), faces, region, name, dropped, invented, raw.untouchable)


def _check_units(size: float, units: Units) -> None:
    def remedy(_: bool) -> str:
        low, high = LIKELY_M
        likely = [unit for unit in NAMES if unit != units and low <= in_metres(size, unit) <= high]
        if not likely:
            return message(
                f"no probe has that size in {arg(NAMES[units])}. Check that the right part was exported."
            )
        return message(
            f"are the numbers {arg(NAMES[likely[0]])}? Give --units {arg(likely[0])} instead of {arg(units)}."
        )

    refuse_size(in_metres(size, units), remedy)
