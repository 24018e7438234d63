"""
How each kind of result is computed from inputs and parameters; the same ones give the same bytes.

A function gets its inputs as files under the names they came with, because some of those names are written into
results, and gives the result's files. The parameters are those of the command of the same purpose, lengths in mm.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from pipeline.session.errors import SessionError
from pipeline.session.identity import main_file

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from pipeline.calibration.files.calibration_file import Mount
    from pipeline.calibration.orientation import Convention
    from pipeline.session.actions import Record
    from pipeline.session.state import State
    from pipeline.session.store import Session

Recompute = Callable[[Mapping[str, Path], Mapping[str, Any], str | None], dict[str, bytes]]
_P = TypeVar("_P", bound=BaseModel)

_Three = tuple[float, float, float]


def compute(
    session: Session, kind: str, name: str, inputs: Mapping[str, str], parameters: Mapping[str, Any]
) -> Record:
    """
    Compute a result from what the session holds, and record it.

    Parameters
    ----------
    session : Session
        Open for writing.
    kind, name : str
        The kind is one of RECOMPUTE; for a probe and a calibration the name is the file's.
    inputs : mapping
        Role -> SHA-256.
    parameters : mapping
        See the kind.

    Raises
    ------
    InputError
        Nothing here computes that kind, an input is missing, or the computation refuses them.
    """
    created = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    files = recomputed(session.folder, session.state, kind, inputs, {**parameters, "name": name}, created)
    return session.add_result(kind, name, files, inputs, parameters, created=created)


def recomputed(
    folder: Path,
    state: State,
    kind: str,
    inputs: Mapping[str, str],
    parameters: Mapping[str, Any],
    created: str | None,
) -> dict[str, bytes]:
    """Return the files that a computation gives; the parameter ``name`` says what the main one is called."""
    if kind not in RECOMPUTE:
        raise SessionError(
            f"{kind}: nothing here computes this kind of result: known are {', '.join(RECOMPUTE)}."
        )
    with tempfile.TemporaryDirectory(prefix="contactbench-") as scratch:
        files = {}
        for number, (role, sha256) in enumerate(inputs.items()):
            files[role] = _laid_out(folder, state, sha256, Path(scratch) / str(number))
        return RECOMPUTE[kind](files, parameters, created)


def _laid_out(folder: Path, state: State, sha256: str, target: Path) -> Path:
    """Copy an input, under the name it came with, where a computation may read it; return where."""
    target.mkdir()
    used = state.input_with(sha256)
    made = None if used is not None else state.result_with(sha256)
    if used is not None:
        names, main = {used.name: used.file}, used.name
    elif made is not None:  # with what belongs to it, such as the names of a probe's regions
        names, main = dict(made.action.files), main_file(made.action)
    else:
        raise SessionError(f"the session holds nothing with the hash {sha256[:12]}: add it first.")
    try:
        for name, ref in names.items():
            shutil.copyfile(folder / ref.path, target / name)
    except OSError as error:
        raise SessionError(f"{folder}: an input cannot be read ({error}): see `session verify`.") from error
    return target / main


# ---- calibration -------------------------------------------------------------------------------


class _Parameters(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str


class CalibrationParameters(_Parameters):
    """As the options of ``contactbench calibrate``; angles of the mount in degrees."""

    euler: str | None = None
    rotation_vector: bool = False
    robot: str | None = None
    radians: bool = False
    inverse: bool = False
    mount: _Three | None = None
    estimate_mount: bool = False
    noise_force: float | None = None
    noise_torque: float | None = None
    tip: _Three = (0.0, 0.0, 100.0)
    contact_force: float = 10.0

    def convention(self) -> Convention | None:
        """Return how orientations are written; None: as the file's columns say."""
        from pipeline.calibration.orientation import Convention, Kind

        if sum(map(bool, (self.euler, self.rotation_vector, self.robot))) > 1:
            raise SessionError("euler, rotation_vector and robot contradict each other: give one.")
        degrees = not self.radians
        if self.euler:
            return Convention(Kind.EULER, order=self.euler, degrees=degrees, inverse=self.inverse)
        if self.rotation_vector:
            return Convention(Kind.ROTATION_VECTOR, degrees=degrees, inverse=self.inverse)
        if self.robot:
            return Convention(Kind.JOINTS, degrees=degrees, robot=self.robot, inverse=self.inverse)
        return Convention(inverse=True) if self.inverse else None

    def rotation(self) -> NDArray[np.float64] | None:
        """Return R_ES (3, 3), if it was given."""
        from scipy.spatial.transform import Rotation

        if self.mount is None:
            return None
        return Rotation.from_euler("xyz", self.mount, degrees=True).as_matrix()


def calibration(
    inputs: Mapping[str, Path], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """Calibrate from ``poses``: the bytes that ``contactbench calibrate`` writes at that time."""
    import numpy as np

    from pipeline.calibration import ContactTask, PoseNoise, calibrate
    from pipeline.calibration.files.calibration_file import save_calibration
    from pipeline.calibration.files.pose_csv import read_poses
    from pipeline.calibration.mounting import estimate_mount

    given = _read(CalibrationParameters, parameters)
    poses = _role(inputs, "poses")
    noise = None
    if (given.noise_force is None) != (given.noise_torque is None):
        raise SessionError("noise_force, noise_torque: give both or none.")
    if given.noise_force is not None and given.noise_torque is not None:
        noise = PoseNoise(given.noise_force, given.noise_torque)
    tip = np.array(given.tip) / 1000
    normal = np.array([0.0, 0.0, -1.0 if tip[2] < 0 else 1.0])
    task = ContactTask(tip, normal, given.contact_force)
    table = read_poses(poses, given.convention(), R_ES=given.rotation())
    mount = None
    if given.estimate_mount:
        mounted = estimate_mount(table.poses, noise, task=task)
        found, mount = mounted.calibration, _mount(mounted.R_SE, mounted.rotation_covariance)
    else:
        found = calibrate(table.poses, noise, task=task)
    time = None if created is None else datetime.fromisoformat(created)
    with _folder_for(given.name, ".json") as out:
        save_calibration(found, out, source=poses, created=time, mount=mount)
        return {given.name: out.read_bytes()}


def _mount(R_SE: NDArray[np.float64], covariance: NDArray[np.float64]) -> Mount:
    import numpy as np
    from scipy.spatial.transform import Rotation

    from pipeline.calibration.files.calibration_file import Mount

    x, y, z, w = Rotation.from_matrix(R_SE).as_quat(canonical=True)
    return Mount(np.array([w, x, y, z]), covariance)


# ---- probe -------------------------------------------------------------------------------------


class ProbeParameters(_Parameters):
    """As the options of ``contactbench probe prepare``; mount: mm, then degrees about the fixed axes."""

    units: str = "auto"
    close: list[str] = []
    alpha: float | None = None
    gap: float | None = None
    mount: tuple[float, float, float, float, float, float] | None = None
    facets: int | None = None
    max_deviation: float | None = None
    max_contact_error: float | None = None
    forces: tuple[float, float] = (8.0, 10.0)
    engine: str = "auto"
    region_ratio: float = 1.0


def probe(
    inputs: Mapping[str, Path], parameters: Mapping[str, Any], _created: str | None
) -> dict[str, bytes]:
    """Prepare a probe from ``mesh``: the bytes that ``contactbench probe prepare`` writes."""
    from typing import cast, get_args

    from pipeline.mesh.shell import Closing
    from pipeline.mesh.sidecar import save_probe_file, sidecar_of
    from pipeline.mesh.simplify import Engine
    from pipeline.preparation.alignment import from_angles
    from pipeline.preparation.prepare import prepare

    given = _read(ProbeParameters, parameters)
    if given.engine not in get_args(Engine) or not set(given.close) <= set(Closing):
        raise SessionError(f"engine {given.engine!r}, close {given.close!r}: no such engine or way to close.")
    ways = [Closing(each) for each in given.close]
    done = prepare(
        _role(inputs, "mesh"),
        cast("Any", given.units),
        ways[0] if len(ways) == 1 else ways or Closing.AUTO,
        alpha=_metres(given.alpha),
        gap=_metres(given.gap),
        alignment=None if given.mount is None else from_angles(list(given.mount[:3]), list(given.mount[3:])),
        target=_target(given),
        engine=cast("Engine", given.engine),
        region_ratio=given.region_ratio,
    )
    with _folder_for(given.name, ".ply") as out:
        save_probe_file(done.content, out)
        return {file.name: file.read_bytes() for file in (out, sidecar_of(out))}


def _target(given: ProbeParameters) -> Callable[[Any], Any]:
    from pipeline.mesh.simplify import Count, MaxDeviation
    from pipeline.preparation.ladder import ExpectedTouches
    from pipeline.preparation.targets import DEFAULT_LIMIT, ContactTarget

    if sum(each is not None for each in (given.facets, given.max_deviation, given.max_contact_error)) > 1:
        raise SessionError("facets, max_deviation and max_contact_error: give one of them.")
    if given.facets is not None:
        count = Count(given.facets)
        return lambda _: (count, None)
    if given.max_deviation is not None:
        deviation = MaxDeviation(given.max_deviation / 1000)
        return lambda _: (deviation, None)
    limit = DEFAULT_LIMIT if given.max_contact_error is None else given.max_contact_error / 1000
    wanted = ContactTarget(limit, ExpectedTouches(force=given.forces))
    return lambda content: wanted.of(content.probe)


RECOMPUTE: dict[str, Recompute] = {"calibration": calibration, "probe": probe}


# ---- shared ------------------------------------------------------------------------------------


def _read(kind: type[_P], parameters: Mapping[str, Any]) -> _P:
    try:
        return kind.model_validate(dict(parameters))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise SessionError(f"parameter {where}: {first['msg']}: correct it.") from error


def _role(inputs: Mapping[str, Path], role: str) -> Path:
    if set(inputs) != {role}:
        raise SessionError(f"inputs: one is needed, {role}; there are {', '.join(inputs) or 'none'}.")
    return inputs[role]


def _metres(millimetres: float | None) -> float | None:
    return None if millimetres is None else millimetres / 1000


@contextmanager
def _folder_for(name: str, suffix: str) -> Iterator[Path]:
    """Give a place for a file of this name that is gone afterwards."""
    if Path(name).name != name or not name.endswith(suffix):
        raise SessionError(f"{name}: a result of this kind is a file whose name ends in {suffix}.")
    with tempfile.TemporaryDirectory(prefix="contactbench-") as scratch:
        yield Path(scratch) / name
