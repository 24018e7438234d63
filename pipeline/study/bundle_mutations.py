"""
Bundles that were damaged, edited or made in bad faith: what a loader has to refuse.

Each kind of mutation is drawn from a random generator. Some keep the hashes as they were, as a damaged copy does;
others make all hashes anew, so that what lies behind them is put to the test.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from pipeline.config.runtime.config import checksum
from pipeline.config.runtime.pack import CHECKSUM, CONFIG, PROBE, encode_zip

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np

    Files = dict[str, bytes]
    Mutate = Callable[["Files", np.random.Generator], "Files"]

# "any": a changed number may be as good as the one before; what matters then is that nothing but a typed error comes.
Expected = Literal["refused", "any"]


@dataclass(frozen=True)
class Mutant:
    """
    A mutated bundle.

    Attributes
    ----------
    kind : str
    expected : {"refused", "any"}
    files : dict or None
        Its files; None for one that exists as a zip file only.
    packed : bytes or None
        The zip file.
    sealed : bool
        All hashes fit.
    """

    kind: str
    expected: Expected
    files: Files | None
    packed: bytes | None = None
    sealed: bool = False


def seal(files: Files) -> Files:
    """Make all hashes anew, as far as the JSON can be read."""
    try:
        content = json.loads(files[CONFIG])
        others = {name: data for name, data in files.items() if name not in (CONFIG, CHECKSUM)}
        content["provenance"]["files"] = {
            name: hashlib.sha256(data).hexdigest() for name, data in others.items()
        }
        config = json.dumps(content, sort_keys=True, separators=(",", ":")).encode() + b"\n"
    except (ValueError, KeyError, TypeError):
        config = files[CONFIG]
    return {**files, CONFIG: config, CHECKSUM: checksum(config)}


def mutant(files: Files, other: Files, rng: np.random.Generator) -> Mutant:
    """
    Draw a mutated bundle.

    Parameters
    ----------
    files : dict
        The sound one.
    other : dict
        Another sound one, to take files from.
    rng : numpy.random.Generator
    """
    kinds = [*_DAMAGE, *_EDITS, *_TEXTS, *_ZIPS, "swapped mesh", "swapped file", "sealed flip"]
    kind = kinds[int(rng.integers(len(kinds)))]
    if kind in _DAMAGE:
        return Mutant(kind, "refused", _DAMAGE[kind](dict(files), rng))
    if kind in _EDITS:
        content = json.loads(files[CONFIG])
        _EDITS[kind](content, rng)
        return Mutant(kind, "refused", seal({**files, CONFIG: json.dumps(content).encode()}), sealed=True)
    if kind in _TEXTS:
        config = _TEXTS[kind](files[CONFIG], rng)
        return Mutant(kind, "refused", {**files, CONFIG: config, CHECKSUM: checksum(config)}, sealed=True)
    if kind in _ZIPS:
        expected, packed = _ZIPS[kind](dict(files), rng)
        return Mutant(kind, expected, None, packed)
    if kind == "swapped mesh":
        return Mutant(kind, "refused", seal({**files, PROBE: other[PROBE]}), sealed=True)
    if kind == "swapped file":
        names = sorted(name for name in files if files[name] != other.get(name, files[name]))
        name = names[int(rng.integers(len(names)))]
        return Mutant(kind, "refused", {**files, name: other[name]})
    return Mutant(kind, "any", seal(_flip(dict(files), rng)), sealed=True)


# ---- damage: the hashes stay -------------------------------------------------------------------


def _pick(files: Files, rng: np.random.Generator) -> str:
    names = sorted(files)
    return names[int(rng.integers(len(names)))]


def _flip(files: Files, rng: np.random.Generator) -> Files:
    name = _pick(files, rng)
    data = bytearray(files[name])
    for _ in range(int(rng.integers(1, 4))):
        data[int(rng.integers(len(data)))] ^= 1 << int(rng.integers(8))
    # Two flips may undo each other.
    return {**files, name: bytes(data) if bytes(data) != files[name] else bytes(data) + b" "}


def _missing(files: Files, rng: np.random.Generator) -> Files:
    del files[_pick(files, rng)]
    return files


def _cut(files: Files, rng: np.random.Generator) -> Files:
    name = _pick(files, rng)
    return {**files, name: files[name][: int(rng.integers(len(files[name])))]}


def _longer(files: Files, rng: np.random.Generator) -> Files:
    name = _pick(files, rng)
    return {**files, name: files[name] + rng.bytes(int(rng.integers(1, 100)))}


def _stranger(files: Files, rng: np.random.Generator) -> Files:
    return {**files, ("notes.txt", "probe.obj", "lib.so")[int(rng.integers(3))]: b"x"}


_DAMAGE: dict[str, Mutate] = {
    "bit flip": _flip,
    "missing file": _missing,
    "truncated file": _cut,
    "longer file": _longer,
    "unknown file": _stranger,
}

# ---- edits: the hashes are made anew -----------------------------------------------------------


def _paths(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of all values, lists of numbers included."""
    if isinstance(value, dict):
        return [path, *(each for key in value for each in _paths(value[key], (*path, key)))]
    if isinstance(value, list):
        return [path, *(each for i in range(min(len(value), 12)) for each in _paths(value[i], (*path, i)))]
    return [path]


def _any_path(content: Any, rng: np.random.Generator) -> tuple[Any, ...]:
    paths = [path for path in _paths(content) if path and path[:2] != ("provenance", "files")]
    return paths[int(rng.integers(len(paths)))]


def _at(content: Any, path: tuple[Any, ...]) -> Any:
    for part in path:
        content = content[part]
    return content


def _put(content: Any, path: tuple[Any, ...], value: Any) -> None:
    _at(content, path[:-1])[path[-1]] = value


def _wrong_type(content: Any, rng: np.random.Generator) -> None:
    # An object where none is meant; one with a field of its own is wrong everywhere.
    # A text is longer than the longest that is allowed anywhere.
    values: list[Any] = [{"x": 1}, [[[]]], "\x00?" * 5_100, {"": None}]
    _put(content, _any_path(content, rng), values[int(rng.integers(len(values)))])


def _absent(content: Any, rng: np.random.Generator) -> None:
    path = _any_path(content, rng)
    while path[-1] in ("rank",) or path[0] == "provenance":
        path = _any_path(content, rng)
    holder = _at(content, path[:-1])
    if path[0] == "regions" and len(path) <= 2:  # fewer regions than the mesh has
        content["regions"] = []
    else:
        del holder[path[-1]]


def _extra(content: Any, rng: np.random.Generator) -> None:
    path = _any_path(content, rng)
    while not isinstance(_at(content, path), dict):
        path = path[:-1]
    _at(content, path)["extra"] = 0


# What physics or another part of the bundle tells: (path, factor). A bias times 1000 is caught by ros2.yaml.
_UNITS: tuple[tuple[tuple[Any, ...], float], ...] = (
    (("gravity", "gravity_W_N"), 1e3),
    (("gravity", "gravity_W_N"), 1e-3),
    (("gravity", "force_bias_N"), 1e3),
    (("gravity", "torque_bias_Nm"), 1e3),
    (("gravity", "torque_bias_Nm"), 1e-3),
    (("gravity", "centre_of_mass_S_m"), 1e3),
    (("gravity", "centre_of_mass_S_m"), 1e-3),
    (("noise", "force_N"), 1e3),
    (("noise", "torque_Nm"), 1e3),
    (("noise", "torque_Nm"), 1e-3),
    (("probe", "bounds_S_m"), 1e3),
    (("filters", "location", "cutoff_Hz"), 1e3),
    (("filters", "location", "rate_Hz"), 1e-3),
    (("filters", "wrench", "q"), 1e3),
    (("touch", "torsion_arm_m"), 1e3),
    (("touch", "model_error", "force_N"), 1e4),
    (("touch", "model_error", "torque_Nm"), 1e5),
)


def _unit(content: Any, rng: np.random.Generator) -> None:
    path, factor = _UNITS[int(rng.integers(len(_UNITS)))]
    _put(content, path, _times(_at(content, path), factor))


def _times(value: Any, factor: float) -> Any:
    return [_times(each, factor) for each in value] if isinstance(value, list) else value * factor


def _untrue(content: Any, rng: np.random.Generator) -> None:
    """Say something that the rest of the bundle denies."""
    lies: list[tuple[tuple[Any, ...], Any]] = [
        (("verification", "passed"), False),
        (("provenance", "stale"), ["the sensor was zeroed"]),
        (("verification",), None),
        (("frames", "quaternion_ES"), [1.0, 0.1, 0.0, 0.0]),
        (("frames", "rotation"), "R_SW"),
        (("probe", "facets"), 2_000_000),
        (("probe", "vertices"), 4),
        (("planes", "count"), 2**31 - 1),
        (("planes", "file"), "probe.ply"),
        (("probe", "file"), "../probe.ply"),
        (("regions", 0, "rank"), 2),
        (("regions", 0, "facets"), 0),
        (("regions", 0, "odds"), 0.0),
        (("regions", 0, "odds"), 0.5),
        (("regions", 0, "untouchable"), True),
        (("regions", 1, "untouchable"), False),
        (("touch", "mesh_deviation_m"), -1e-4),
        (("version",), 4),
        (("version",), 2),
        (("version",), 1),
        (("version",), 0),
        (("version",), True),
        (("schema",), "contactbench.session"),
        (("units", "length"), "mm"),
        (("noise", "force_N"), [0.0, 0.0, 0.0]),
        (("filters", "location", "order"), 3),
        (("filters", "location", "sections"), [[1.0, 0.0, 0.0, 1.0, 0.0, 0.0]]),
        (("gates", "friction_angle_rad"), 75.0),
        (("gates", "rival_odds"), 0.5),
        (("gates", "torque_ratio"), 1.5),
        (("gates", "implausible_misfit"), 1e3),
        (("gravity", "covariance", 0, 0), -1.0),
        (("gravity", "covariance", 0, 1), 1.0),
        (("noise", "wrench_covariance", 2, 2), 0.0),
        (("gravity", "gravity_W_N"), [0.0, 0.0, 5.0]),
        (("limits", "max_force_N"), 0.0),
        (("provenance", "created"), "yesterday"),
    ]
    path, value = lies[int(rng.integers(len(lies)))]
    _put(content, path, value)


_EDITS: dict[str, Callable[[Any, np.random.Generator], None]] = {
    "wrong type": _wrong_type,
    "missing field": _absent,
    "extra field": _extra,
    "swapped units": _unit,
    "untrue": _untrue,
}

# ---- texts: JSON that is none, or not one thing only -------------------------------------------


def _not_finite(config: bytes, rng: np.random.Generator) -> bytes:
    content = json.loads(config)
    part = ("gravity", "noise", "limits", "gates", "touch")[int(rng.integers(5))]
    numbers = [path for path in _paths(content[part]) if path and isinstance(_at(content[part], path), float)]
    _put(content[part], numbers[int(rng.integers(len(numbers)))], "@@@")
    word = (b"NaN", b"Infinity", b"-Infinity", b"1e999", b"9" * 5000)[int(rng.integers(5))]
    return json.dumps(content).encode().replace(b'"@@@"', word)


def _duplicate(config: bytes, rng: np.random.Generator) -> bytes:
    content = json.loads(config)
    name = sorted(content)[int(rng.integers(len(content)))]
    return config.replace(b"{", b"{" + f'"{name}":{json.dumps(content[name])},'.encode(), 1)


def _deep(config: bytes, rng: np.random.Generator) -> bytes:
    depth = int(rng.integers(300, 200_000))
    opened, closed = ((b"[", b"]"), (b'{"a":', b"}"))[int(rng.integers(2))]
    return config.replace(b"{", b'{"deep":' + opened * depth + b"0" + closed * depth + b",", 1)


def _no_json(config: bytes, rng: np.random.Generator) -> bytes:
    made = (
        b"",
        b"[]",
        b"null",
        b"\xff\xfe" + config,
        config[:-9],
        config + config,
        b'"\\ud800"',
        rng.bytes(99),
    )
    return made[int(rng.integers(len(made)))]


_TEXTS: dict[str, Callable[[bytes, np.random.Generator], bytes]] = {
    "not finite": _not_finite,
    "duplicate key": _duplicate,
    "deep nesting": _deep,
    "no JSON": _no_json,
}

# ---- zip files ---------------------------------------------------------------------------------


def _packed(files: dict[str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as packed:
        for name, data in files.items():
            packed.writestr(zipfile.ZipInfo(name), data, method)  # of a fixed date
    return out.getvalue()


def _traversal(files: Files, rng: np.random.Generator) -> tuple[Expected, bytes]:
    before = ("../", "/", "..\\", "C:", "a/../../", "./")[int(rng.integers(6))]
    name = _pick(files, rng)
    moved = {(before + each if each == name else each): data for each, data in files.items()}
    return "refused", _packed(moved)


def _many(files: Files, rng: np.random.Generator) -> tuple[Expected, bytes]:
    return "refused", _packed({**files, **{f"f{i}": b"" for i in range(int(rng.integers(60, 2_000)))}})


def _bomb(files: Files, rng: np.random.Generator) -> tuple[Expected, bytes]:
    name = _pick(files, rng)
    return "refused", _packed({**files, name: b"0" * 20_000_000}, zipfile.ZIP_DEFLATED)


def _link(files: Files, rng: np.random.Generator) -> tuple[Expected, bytes]:
    name, out = _pick(files, rng), io.BytesIO()
    with zipfile.ZipFile(out, "w") as packed:
        for each, data in files.items():
            member = zipfile.ZipInfo(each)
            member.create_system, member.external_attr = 3, (0o120777 if each == name else 0o100644) << 16
            packed.writestr(member, data)
    return "refused", out.getvalue()


def _short(files: Files, rng: np.random.Generator) -> tuple[Expected, bytes]:
    data = encode_zip(files)
    return "refused", data[: int(rng.integers(len(data) - 1))]


def _zip_flip(files: Files, rng: np.random.Generator) -> tuple[Expected, bytes]:
    """Flip bits; in a date or another field that nobody reads, the bundle is as it was."""
    data = bytearray(encode_zip(files))
    # The end of a zip file is its directory: small, and what a reader believes.
    low = 0 if rng.integers(2) else len(data) - 600
    for _ in range(int(rng.integers(1, 4))):
        data[int(rng.integers(low, len(data)))] ^= 1 << int(rng.integers(8))
    return "any", bytes(data)


_ZIPS: dict[str, Callable[[Files, np.random.Generator], tuple[Expected, bytes]]] = {
    "path traversal": _traversal,
    "many files": _many,
    "zip bomb": _bomb,
    "link in zip": _link,
    "truncated zip": _short,
    "flipped zip": _zip_flip,
}
