from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import Final, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int32]
_Longs = NDArray[np.int64]
_Bools = NDArray[np.bool_]
_Bytes = NDArray[np.uint8]

variant: str
compiler: str

class FrozenDetector:
    def __init__(self) -> None: ...
    def see(self, wrench: tuple[float, ...], chance: float) -> bool: ...

def frozen(wrenches: _Floats, chance: float) -> _Bools: ...
def collapse_edges(
    vertices: _Floats,
    faces: _Ints,
    wanted: tuple[int, int],
    second: _Bools,
    progress: Callable[[float], None],
    labels: _Ints | None = None,
) -> tuple[_Floats, _Ints, _Ints]: ...
def crossings(
    vertices: _Floats, faces: _Ints, limit: int = 100_000
) -> tuple[_Ints, _Bytes, _Longs, bool]: ...
def plain_rows(
    block: bytes,
    cells: int,
    columns: list[int],
    required: list[bool],
    text: int = -1,
    longest_text: int = 256,
) -> tuple[_Floats, _Longs, _Longs, _Bytes | None] | None: ...
def poses_at(
    moments: _Floats, R: _Floats, p: _Floats, times: _Floats, longest_gap: float, longest_ahead: float
) -> tuple[_Floats, _Floats]: ...

class Reason(IntEnum):
    OK = 0
    VERTEX = 1
    AMBIGUOUS = 2
    LOW_FORCE = 3
    TANGENTIAL = 4
    OFF_SURFACE = 5
    OUTSIDE_REGION = 6
    SATURATED = 7
    STALE = 8
    NOT_FINITE = 9
    NOT_A_ROTATION = 10
    BY_REGION = 11
    IMPLAUSIBLE = 12
    TWO_TOUCHES = 13
    UNHEALTHY = 14
    UNCERTAIN = 15

class Candidate:
    point: Final[_Floats]
    normal: Final[_Floats]
    torque: Final[float]
    face: Final[int]
    vertex: Final[int | None]
    region: Final[int]
    friction_angle: Final[float]
    distance: Final[float]
    misfit: Final[float]
    delta: Final[float]
    why: Final[str]

class Contact:
    reason: Final[Reason]
    accepted: Final[bool]
    point: Final[_Floats | None]
    normal: Final[_Floats | None]
    torque: Final[float]
    face: Final[int | None]
    vertex: Final[int | None]
    region: Final[int]
    friction_angle: Final[float]
    misfit: Final[float]
    left_over: Final[float]
    arm: Final[float]
    torsion_arm: Final[float]
    torsion_since: Final[float]
    confidence: Final[float]
    second: Final[_Floats | None]
    candidates: Final[list[Candidate]]
    covariance: Final[_Floats | None]
    sigma_max: Final[float]
    within: Final[float]
    ellipse: Final[_Floats | None]
    wrench: Final[_Floats]

class Batch:
    def __len__(self) -> int: ...
    def __getitem__(self, row: SupportsIndex) -> Contact: ...
    points: Final[_Floats]
    normals: Final[_Floats]
    torques: Final[_Floats]
    misfits: Final[_Floats]
    left_overs: Final[_Floats]
    arms: Final[_Floats]
    torsion_arms: Final[_Floats]
    confidences: Final[_Floats]
    seconds: Final[_Floats]
    accepted: Final[_Bools]
    faces: Final[_Ints]
    vertices: Final[_Ints]
    reasons: Final[_Bytes]
    candidates: Final[_Ints]
    covariances: Final[_Floats]
    sigma_max: Final[_Floats]

class RuntimeContact:
    reason: Final[int]
    reason_name: Final[str]
    accepted: Final[bool]
    health: Final[int]
    pose_age: Final[float]
    latency: Final[float]
    time: Final[float]
    point: Final[_Floats | None]
    normal: Final[_Floats | None]
    torque: Final[float]
    wrench: Final[_Floats | None]
    covariance: Final[_Floats | None]
    face: Final[int | None]
    vertex: Final[int | None]
    region: Final[int]
    candidates: Final[int]
    filtered_point: Final[_Floats | None]
    misfit: Final[float]
    left_over: Final[float]
    arm: Final[float]
    torsion_arm: Final[float]
    torsion_since: Final[float]
    confidence: Final[float]
    within: Final[float]
    runner_up: Final[_Floats | None]
    second: Final[_Floats | None]
    raw: Final[_Floats | None]
    taken: Final[_Floats | None]
    def line(self, zero: Zero, latency: float, on: int = -1, nulls: bool = True) -> bytes: ...

class RuntimeBatch:
    def __len__(self) -> int: ...
    def __getitem__(self, row: SupportsIndex) -> RuntimeContact: ...
    reasons: Final[_Ints]
    faces: Final[_Ints]
    vertices: Final[_Ints]
    regions: Final[_Ints]
    candidates: Final[_Ints]
    times: Final[_Floats]
    points: Final[_Floats]
    normals: Final[_Floats]
    torques: Final[_Floats]
    wrenches: Final[_Floats]
    covariances: Final[_Floats]
    filtered_points: Final[_Floats]
    accepted: Final[_Ints]
    healths: Final[NDArray[np.uint32]]
    misfits: Final[_Floats]
    left_overs: Final[_Floats]
    arms: Final[_Floats]
    torsion_arms: Final[_Floats]
    torsion_since: Final[_Floats]
    confidences: Final[_Floats]
    runners_up: Final[_Floats]
    seconds: Final[_Floats]
    taken: Final[_Floats]

class WrenchKalman:
    def __init__(self, kalman: _Floats) -> None: ...
    def reset(self) -> None: ...
    variance: Final[float]
    def update(self, rows: _Floats, steps: _Floats) -> _Floats: ...

def kalman(rows: _Floats, added: _Floats, r: float, state: _Floats, variance: _Floats) -> _Floats: ...

class Runtime:
    def __init__(
        self,
        vertices: _Floats,
        faces: _Ints,
        region: _Ints,
        noise: _Floats,
        gravity: _Floats,
        *,
        kalman: _Floats | None,
        sections: _Floats,
        bonus: _Floats,
        torsion_arm: float,
        torsion_learned: bool = False,
        mesh_deviation: float,
        mesh_curved: bool,
        R_ES: _Floats | None,
        pose_gap: float,
        pose_ahead: float,
        silence: float,
        frozen_chance: float,
        motion: tuple[float, float] | None,
        gravity_covariance: _Floats | None = None,
        orientation_sigma: float = ...,
        follow: bool = False,
        gates: Mapping[str, object],
    ) -> None: ...
    def pose(self, R: _Floats, p: _Floats, time: float) -> bool: ...
    def locate(
        self, wrench: _Floats, time: float, arrival: float = ..., flags: int = 0
    ) -> RuntimeContact: ...
    def silent(self, now: float) -> RuntimeContact | None: ...
    def update(self, wrench: _Floats, R_WS: _Floats, time: float) -> RuntimeContact: ...
    def update_batch(self, wrenches: _Floats, rotations: _Floats, times: _Floats) -> RuntimeBatch: ...
    def time_each(self, wrenches: _Floats, rotations: _Floats, times: _Floats) -> _Floats: ...
    def zero(self) -> Zero: ...
    def reset(self) -> None: ...

class Solver:
    def __init__(
        self,
        vertices: _Floats,
        faces: _Ints,
        region: _Ints,
        noise: _Floats,
        *,
        bonus: _Floats,
        torsion_arm: float,
        torsion_learned: bool = False,
        mesh_deviation: float,
        mesh_curved: bool,
        gates: Mapping[str, object],
    ) -> None: ...
    def locate(self, wrench: ArrayLike, previous: _Floats | None = ...) -> Contact: ...
    def locate_batch(self, wrenches: ArrayLike, threads: int = ...) -> Batch: ...
    def locate_exhaustively(self, wrench: ArrayLike) -> Contact: ...
    def time_each(self, wrenches: ArrayLike) -> _Floats: ...
    def track(self, wrench: ArrayLike, age: float = ..., step: float = ...) -> Contact: ...
    def locate_batch_after(self, wrenches: ArrayLike, previous: _Floats, threads: int = ...) -> Batch: ...
    def track_batch(
        self, wrenches: ArrayLike, ages: _Floats | None = ..., steps: _Floats | None = ...
    ) -> Batch: ...
    def time_tracking(self, wrenches: ArrayLike) -> _Floats: ...
    def search_differences(self, wrenches: ArrayLike, previous: _Floats | None) -> _Longs: ...
    def reset(self) -> None: ...
    previous: Final[_Floats | None]
    def foreign_batch(
        self, wrenches: ArrayLike, points: _Floats, faces: _Ints, torques: _Floats
    ) -> Batch: ...
    closed: Final[bool]

class Scan:
    def __init__(self, solver: Solver, /) -> None: ...
    def locate(self, wrench: ArrayLike) -> Contact: ...
    def locate_batch(self, wrenches: ArrayLike, threads: int = ...) -> Batch: ...
    def time_each(self, wrenches: ArrayLike) -> _Floats: ...

class Algorithm1:
    def __init__(self, solver: Solver, /) -> None: ...
    def locate(self, wrench: ArrayLike) -> Contact: ...
    def locate_batch(self, wrenches: ArrayLike, threads: int = ...) -> Batch: ...
    def time_each(self, wrenches: ArrayLike) -> _Floats: ...

class Iterative:
    def __init__(
        self, solver: Solver, origin: _Floats, axes: _Floats, coefficients: _Floats, reach: float
    ) -> None: ...
    def locate(self, wrench: ArrayLike) -> Contact: ...
    def locate_batch(self, wrenches: ArrayLike, threads: int = ...) -> Batch: ...
    def time_each(self, wrenches: ArrayLike) -> _Floats: ...

class SurfaceIndex:
    def __init__(self, vertices: _Floats, faces: _Ints) -> None: ...
    def __len__(self) -> int: ...
    def closest(self, points: _Floats) -> tuple[_Floats, _Ints, _Floats]: ...
    def best_aligned(
        self, points: _Floats, directions: _Floats, radius: _Floats, normals: _Floats, enough: float = ...
    ) -> tuple[_Floats, _Ints]: ...
    def first_hit(self, origins: _Floats, directions: _Floats) -> tuple[_Floats, _Ints]: ...
    def escapes(self, origins: _Floats, directions: _Floats) -> _Bools: ...

class Geodesic:
    def __init__(self, vertices: _Floats, faces: _Ints) -> None: ...
    def neighbours(self) -> tuple[_Ints, _Ints]: ...
    def around(self, faces: _Ints, points: _Floats, limit: float) -> tuple[_Longs, _Ints, _Floats]: ...
    def spread(self, faces: _Ints, points: _Floats, limit: float) -> tuple[_Ints, _Floats]: ...
    def path(self, from_face: int, from_point: _Floats, to_face: int, to_point: _Floats) -> _Floats: ...
    def begin(self, radius: float, geodesic: bool) -> None: ...
    def extend(self, face: int, point: _Floats, joined: bool) -> _Ints: ...

class Zero:
    state: Final[str]
    age: Final[float]
    offset: Final[_Floats | None]
    sigma: Final[_Floats | None]
    shift: Final[float]
    shift_sigma: Final[float]
    follows: Final[str]
    taken: Final[_Floats | None]
    taken_sigma: Final[_Floats | None]
    seen: Final[float]

class ZeroFollow:
    def __init__(self, min_force: float) -> None: ...
    def taken(self, wrenches: _Floats, rotations: _Floats, times: _Floats, touch_force: float) -> _Floats: ...
    def at(self, now: float) -> Zero: ...

class ZeroWatch:
    def __init__(
        self,
        gravity: _Floats,
        covariance: _Floats | None,
        places: _Floats,
        *,
        orientation_sigma: float,
        min_force: float,
    ) -> None: ...
    def see(self, wrenches: _Floats, rotations: _Floats, times: _Floats, touched: bool = False) -> None: ...
    def at(self, now: float) -> Zero: ...
