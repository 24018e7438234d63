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
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.config.consumers import ft_calib_yaml, ros2_yaml
from contactbench.pipeline.config.runtime.build import encode_planes
from contactbench.pipeline.config.runtime.canonical import encode_json
from contactbench.pipeline.config.runtime.config import checksum
from contactbench.pipeline.config.runtime.pack import (
    CHECKSUM,
    CONFIG,
    FT_CALIB,
    PLANES,
    PROBE,
    ROS2,
    encode_zip,
)
from contactbench.pipeline.config.runtime.values import low_pass_sections, wrench_covariance
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.colours import facet_colours
from contactbench.pipeline.mesh.ply import encode_ply, read_ply

if TYPE_CHECKING:
    from collections.abc import Callable

    Files = dict[str, bytes]
    Mutate = Callable[["Files", np.random.Generator], "Files"]

# "any": a changed number may be as good as the one before; what matters then is that nothing but a typed error comes.
Expected = Literal["refused", "any"]


@dataclass(frozen=True)
class Mutant:
    """A mutated bundle."""

    kind: str
    expected: Expected  # {"refused", "any"}
    files: Files | None  # Its files; None for one that exists as a zip file only
    packed: bytes | None = None  # The zip file
    sealed: bool = False  # All hashes fit


def seal(files: Files) -> Files:
    """Make all hashes anew, as far as the JSON can be read."""
    try:
        content = json.loads(files[CONFIG])
        others = {name: data for name, data in files.items() if name not in (CONFIG, CHECKSUM)}
        content["provenance"]["files"] = {
            name: hashlib.sha256(data).hexdigest() for name, data in others.items()
        }
        config = encode_json(content)
    except (ValueError, KeyError, TypeError):
        config = files[CONFIG]
    return {**files, CONFIG: config, CHECKSUM: checksum(config)}


def mutant(files: Files, plain: Files, other: Files, rng: np.random.Generator) -> Mutant:
    """Draw a mutated bundle."""
    kinds = [*_DAMAGE, *_EDITS, *_TEXTS, *_ZIPS, *_SEALED, "swapped mesh", "swapped file"]
    kind = kinds[int(rng.integers(len(kinds)))]
    if kind in _SEALED:
        expected, mutate = _SEALED[kind]
        return Mutant(kind, expected, mutate(dict(files if rng.integers(2) else plain), rng), sealed=True)
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
    names = sorted(name for name in files if files[name] != other.get(name, files[name]))
    name = names[int(rng.integers(len(names)))]
    return Mutant(kind, "refused", {**files, name: other[name]})


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


# What physics or another part of the bundle tells: (path, factor). Nothing tells a bias that is sealed anew.
_UNITS: tuple[tuple[tuple[Any, ...], float], ...] = (
    (("gravity", "gravity_W_N"), 1e3),
    (("gravity", "gravity_W_N"), 1e-3),
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
    (("noise", "orientation_rad"), 180 / np.pi * 60),
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
        (("frames", "world"), "W, z up"),
        (("world", "down_W"), [0.0, 0.0, 1.0]),
        (("world", "down_W"), [0.0, 0.0, -1.001]),
        (("zero", "measured"), "yesterday"),
        (("zero", "drift"), {}),
        (("noise", "orientation_rad"), -1e-3),
        (("checks", "known_weight", "outcome"), "failed"),
        (("checks", "known_touch", "outcome"), "failed"),
        (("checks", "known_touch", "outcome"), "good"),
        (("checks", "known_touch", "located_S_m"), None),
        (("checks", "known_weight", "mass_kg"), 0.0),
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
        (("version",), 5),
        (("version",), 3),
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


def _spelling(config: bytes, rng: np.random.Generator) -> bytes:
    """Say the same in another way; readers differ in what they make of some of these."""
    spelled = (
        (b'"passed":', b'"passed" :'),
        (b"{", b"{\n"),
        (b"\n", b""),
        (b"\n", b"\r\n"),
        (b"\n", b"\n\n"),
        (b"\n", b"\n\x00"),
        (b"\n", b"\n\t "),
        (b"{", b"\xef\xbb\xbf{"),
        (b"200.0", b"2e2"),
        (b"200.0", b"200.00"),
        (b"200.0", b"+200.0"),
        (b"200.0", b"0200.0"),
        (b"200.0", b"200."),
        (b"200.0", b"2E+2"),
        (b"0.0,", b"-0,"),
        (b"0.0,", b"0e0,"),
        (b"0.0,", b".0,"),
        (b"0.0,", b"1e-400,"),
        (b"0.0,", b"0.0,,"),
        (b"simulation", b"\\u0073imulation"),
        (b"simulation", b"\\ud83d\\ude00"),
        (b"simulation", b"\\ude00"),
        (b"simulation", b"\\/"),
        (b"simulation", b"\\u001F"),
        (b"simulation", b"\xed\xa0\x80"),
        (b"simulation", b"\xc0\xaf"),
        (b'"operator"', b'"\\u006fperator"'),
        (b"null", b"nul"),
        (b"true", b"True"),
    )
    old, new = spelled[int(rng.integers(len(spelled)))]
    return config.replace(old, new, 1) if old in config else config + b" "


def _many_keys(config: bytes, rng: np.random.Generator) -> bytes:
    count = int(rng.integers(1_000, 80_000))
    keys = "".join(f'"{number:06d}":0,' for number in range(count))
    twice = f'"{int(rng.integers(count)):06d}":0,' if rng.integers(2) else ""
    return config.replace(b"{", b"{" + (keys + twice).encode(), 1)


_TEXTS: dict[str, Callable[[bytes, np.random.Generator], bytes]] = {
    "not finite": _not_finite,
    "duplicate key": _duplicate,
    "deep nesting": _deep,
    "no JSON": _no_json,
    "other spelling": _spelling,
    "many keys": _many_keys,
}

# ---- made anew: an attacker computes every hash ------------------------------------------------


def _content_of(files: Files, content: Any) -> Files:
    """Seal; a content that has no canonical spelling goes in as it is."""
    return seal({**files, CONFIG: json.dumps(content).encode()})


def _any_value(files: Files, rng: np.random.Generator) -> Files:
    content = json.loads(files[CONFIG])
    path = _any_path(content, rng)
    old = _at(content, path)
    values: list[Any] = [
        0,
        1,
        -1,
        2,
        0.0,
        -0.0,
        1.0,
        5e-324,
        1e-300,
        1e-9,
        1e9,
        1e9 + 1,
        1e300,
        2**31,
        2**63,
        10**30,
    ]
    values += [
        0.05,
        0.0500001,
        1.5707963267948966,
        True,
        None,
        "",
        "\x00",
        "\x7f\u2028",
        "x" * 1_001,
        "\U0001f600",
        [],
        {},
    ]
    values += [f"{old}\n", [old], old]
    if isinstance(old, int | float):
        values += [
            old * float(factor) for factor in (-1, 0.95, 0.9499, 1.05, 1.0501, 1 + 1e-10, 1 + 1e-8, 1e3, 1e-3)
        ] * 2
    if isinstance(old, list) and old:
        values += [old[:-1], [*old, old[0]], old[::-1]] * 4
    _put(content, path, values[int(rng.integers(len(values)))])
    return _content_of(files, content)


def _json_byte(files: Files, rng: np.random.Generator) -> Files:
    config = bytearray(files[CONFIG])
    config[int(rng.integers(len(config)))] = b'0123456789eE+-.,:"{}[] \\\r\n\xff'[int(rng.integers(26))]
    return {**files, CONFIG: bytes(config), CHECKSUM: checksum(bytes(config))}


def _ply_bytes(files: Files, rng: np.random.Generator) -> Files:
    data = files[PROBE]
    header, body = (
        data[: data.index(b"end_header\n") + 11],
        bytearray(data[data.index(b"end_header\n") + 11 :]),
    )
    lines = header.split(b"\n")
    at = int(rng.integers(len(lines) - 1))
    kind = int(rng.integers(4))
    if kind == 0:
        changes: tuple[list[bytes], ...] = (
            [lines[at] + b" "],
            [lines[at] + b"\r"],
            [b"comment x", lines[at]],
            [lines[at].replace(b" ", b"  ")],
            [],
            [b""],
        )
        lines[at : at + 1] = changes[int(rng.integers(len(changes)))]
        header = b"\n".join(lines)
    elif kind == 1:
        at = int(rng.integers(len(body)))
        body[at] = int(rng.integers(256))
    elif kind == 2:
        at = 24 * int(rng.integers(100))
        values = (np.nan, np.inf, -0.0, 1e-320, 1e300, 1e3, 0.1)
        body[at : at + 8] = np.float64(values[int(rng.integers(len(values)))]).tobytes()
    else:
        body += rng.bytes(int(rng.integers(1, 30)))
    return seal({**files, PROBE: header + bytes(body)})


def _other_surface(
    vertices: Any, faces: Any, invented: Any, rng: np.random.Generator
) -> tuple[Any, Any, Any]:
    """Return vertices, the rows of facets that are kept with their corners, and which were made up."""
    some = rng.integers(len(faces), size=int(rng.integers(1, 4)))
    one, two = faces[some[0], :2]
    scale = float(rng.choice([1e-4, 0.05, 0.1, 20.0, 1e3]))
    turned, repeated, guessed, near, thin = (
        array.copy() for array in (faces, faces, invented, vertices, vertices)
    )
    turned[some], repeated[some] = faces[some][:, ::-1], faces[(some + 1) % len(faces)]
    guessed[some] = True
    near[one] = vertices[two] * float(rng.choice([1.0, 1 + 1e-15, 1 + 1e-12]))
    thin[:, int(rng.integers(3))] *= float(rng.choice([-1.0, 0.0, 1e-13]))
    changes = (
        (vertices, turned, invented),
        (vertices, faces[:, ::-1], invented),
        (vertices, repeated, invented),
        (vertices * scale, faces, invented),
        (vertices + float(rng.choice([0.5, 999.0, 1e6])), faces, invented),
        (near, faces, invented),
        (np.vstack([vertices, [[5.0, 0.0, 0.0]]]), faces, invented),  # a vertex that no facet uses
        (vertices, faces, guessed),
        (vertices + rng.normal(0, 1e-4, vertices.shape), faces, invented),
        (thin, faces, invented),
    )
    return changes[int(rng.integers(len(changes)))]


def _other_mesh(files: Files, rng: np.random.Generator) -> Files:
    """Give the probe another surface, sound or not, and make every file that speaks of it anew."""
    raw, content = read_ply(files[PROBE]), json.loads(files[CONFIG])
    vertices, faces, invented = _other_surface(raw.vertices, raw.faces, raw.invented, rng)
    kept = np.arange(int(rng.integers(2)), len(faces))  # with a hole, or without
    faces, invented, region = faces[kept], invented[kept], np.asarray(raw.region)[kept]
    shown = facet_colours(region, invented.astype(bool), [each["colour"] for each in content["regions"]])
    made = {PROBE: encode_ply(vertices, faces, region, invented, shown, raw.untouchable)}
    used = vertices[np.unique(faces)]
    content["probe"] |= {
        "facets": len(faces),
        "vertices": len(vertices),
        "bounds_S_m": [used.min(axis=0).tolist(), used.max(axis=0).tolist()],
    }
    content["planes"]["count"] = len(faces)
    for each in content["regions"]:
        each["facets"] = int(np.count_nonzero(region == each["rank"]))
    with suppress(InputError):  # facets without area have no planes
        probe = Probe.from_arrays(
            vertices, faces, region, invented=invented, check_size=False, untouchable=raw.untouchable
        )
        made[PLANES] = encode_planes(probe)
    return _content_of({**files, **made}, content)


_DOWNS = tuple(
    np.array(down) / np.linalg.norm(down)
    for down in (
        (0, 0, -1),
        (0, 0, 1),
        (0, 1, 0),
        (-1, 0, 0),
        (0.6, 0, 0.8),
        (0.08, 0, -1),
        (0.1, 0, 1),
        (0, 0.01, 1),
    )
)


def _other_gravity(files: Files, rng: np.random.Generator) -> Files:
    """Weigh another tool on a robot that stands, hangs or leans, and make every file that speaks of it anew."""
    content = json.loads(files[CONFIG])
    part = content["gravity"]
    down = _DOWNS[int(rng.integers(len(_DOWNS)))]
    content["world"]["down_W"] = down.tolist()
    weight = float(rng.choice([0.0, 1e-200, 0.05, 0.3, 6.0, 400.0, 600.0]))
    tilt = rng.normal(0, float(rng.choice([0.0, 1e-12, 1e-4, 0.02, 1.0])), 3)
    part["gravity_W_N"] = ((down + tilt) * weight).tolist()
    for name, size in (("force_bias_N", 3.0), ("torque_bias_Nm", 0.1), ("centre_of_mass_S_m", 0.05)):
        part[name] = rng.normal(0, size * float(rng.choice([0.0, 1e-9, 1.0])), 3).tolist()
    C = np.array(part["covariance"]) * float(rng.choice([0.0, 1e-8, 1.0, 1e4]))
    part["covariance"] = C.tolist()
    names = ("gravity_W_N", "force_bias_N", "centre_of_mass_S_m", "torque_bias_Nm")
    gravity, force, centre, torque = (np.array(part[name]) for name in names)
    model = GravityModel(gravity, force, centre, torque, C)
    noise, kalman = content["noise"], content["filters"]["wrench"]
    wrench_filter = (
        None
        if kalman is None
        else KalmanFilter(
            kalman["rate_Hz"],
            q=kalman["q"],
            r=kalman["r"],
            tuned_rate=kalman["tuned_rate_Hz"],
            per_sample=kalman["per_sample"],
        )
    )
    noise["wrench_covariance"] = wrench_covariance(
        noise["force_N"], noise["torque_Nm"], wrench_filter, model
    ).tolist()
    made = dict(files)
    named = {"sensor_name": "wrist/ft.1", "broadcaster": "/cell/broadcaster", "admittance": "no"}
    with np.errstate(all="ignore"):
        try:
            made[ROS2] = ros2_yaml(
                model,
                sensor_frame="tool0-ft",
                world_frame="base",
                down_W=down,
                **(named if rng.integers(2) else {}),
            ).encode()
            made[FT_CALIB] = ft_calib_yaml(model, com_frame="tool0-ft", down_W=down).encode()
        except InputError:
            del made[FT_CALIB]
    return _content_of(made, content)


def _other_filter(files: Files, rng: np.random.Generator) -> Files:
    """Filter otherwise, with the sections that belong to it."""
    content = json.loads(files[CONFIG])
    part = content["filters"]["location"]
    rate = float(rng.choice([1.0, 200.0, 1_000.0, 1_049.0, 1_060.0, 1e6]))
    cutoff = rate * float(10 ** rng.uniform(-6.5, -0.30104))
    order = int(rng.integers(1, 9))
    part |= {"rate_Hz": rate, "cutoff_Hz": cutoff, "order": order}
    part["sections"] = low_pass_sections(cutoff, rate, order).tolist()
    return _content_of(files, content)


_SEALED: dict[str, tuple[Expected, Mutate]] = {
    "sealed flip": ("any", lambda files, rng: seal(_flip(files, rng))),
    "any value": ("any", _any_value),
    "JSON byte": ("any", _json_byte),
    "PLY bytes": ("any", _ply_bytes),
    "other mesh": ("any", _other_mesh),
    "other gravity": ("any", _other_gravity),
    "other filter": ("any", _other_filter),
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
    return "refused", _packed({**files, _pick(files, rng): b"0" * 20_000_000}, zipfile.ZIP_DEFLATED)


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
