"""
The library on one page: what ``import contactbench as cb`` offers.

Each function is one step, takes files as strings or paths, and gives what the command of the same step writes. Settings
are those of the command, by the same names and in the same units: ``cb.prepare_probe("probe.stl", facets=2000)`` is
``contactbench probe prepare probe.stl --facets 2000``. What a file, a row or a setting lacks raises
`contactbench.pipeline.errors.InputError`, which is a ValueError.
"""

import io
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

from contactbench.pipeline.calibration import Calibration, PoseSample
from contactbench.pipeline.calibration import calibrate as calibrate_poses
from contactbench.pipeline.calibration.assumptions import assumed
from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
from contactbench.pipeline.calibration.files.calibration_file import Mount, creation_time, save_calibration
from contactbench.pipeline.calibration.files.calibration_file import load_calibration as load_calibration_file
from contactbench.pipeline.calibration.files.capture_file import read_any_poses
from contactbench.pipeline.calibration.files.pose_csv import PoseTable
from contactbench.pipeline.calibration.files.pose_csv import read_poses as read_csv
from contactbench.pipeline.calibration.orientation import convention_of
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.bench import export_from_files
from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.contact import Batch, Gates, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.contact import ContactSolver as Solver
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.kernel import Runtime
from contactbench.pipeline.knobs import Settings
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.load import refuse_to_guess
from contactbench.pipeline.mesh.sidecar import check_target, load_probe_file, save_probe_file
from contactbench.pipeline.preparation.prepare import Preparation, prepared
from contactbench.pipeline.setting_options import option_name
from contactbench.pipeline.settings import CalibrationSettings, PosesSettings, ProbeSettings
from contactbench.pipeline.verification import Verification
from contactbench.pipeline.verification.result import VerificationParameters, verify_files

__all__ = [
    "Gates",
    "Solver",
    "TouchModel",
    "WrenchNoise",
    "calibrate",
    "export",
    "load_bundle",
    "load_calibration",
    "load_probe",
    "load_runtime",
    "prepare_probe",
    "read_poses",
    "to_pandas",
    "verify",
]

FileName = str | os.PathLike[str]
Chosen = TypeVar("Chosen", bound=Settings)


class Frame(Protocol):
    """A `pandas.DataFrame`, of which one method is needed."""

    def to_csv(self, *, index: bool) -> str:
        """Return it as CSV."""


def read_poses(source: FileName | Frame, **settings: Any) -> PoseTable:
    """
    Read still, contact-free poses.

    Parameters
    ----------
    source : str, path or pandas.DataFrame
        A table with a row a pose (fx, fy, fz, mx, my, mz, N and N·m in S, and the orientation, qw, qx, qy, qz if the
        settings do not say otherwise), or a recording, in which they are found.
    **settings
        How orientations are written, as for ``contactbench calibrate fit``: ``euler``, ``mount``, ...
    """
    return _table(source, _chosen(PosesSettings, settings))


def _table(source: FileName | Frame, given: PosesSettings) -> PoseTable:
    convention = convention_of(given)
    if isinstance(source, str | os.PathLike):
        return read_any_poses(Path(source), convention, R_ES=given.R_ES)
    return read_csv(io.BytesIO(source.to_csv(index=False).encode()), convention, R_ES=given.R_ES)


def calibrate(
    poses: FileName | Frame | PoseTable | Sequence[PoseSample], out: FileName | None = None, **settings: Any
) -> Calibration:
    """
    Find bias, weight and centre of mass from still, contact-free poses.

    Parameters
    ----------
    poses : str, path, pandas.DataFrame, PoseTable or sequence of PoseSample
    out : str or path, optional
        File for it, JSON.
    **settings
        As for ``contactbench calibrate fit``; those of `read_poses` count where `poses` are still to be read.

    Returns
    -------
    Calibration
        Look at its ``verdict`` first.
    """
    given = _chosen(CalibrationSettings, settings)
    source = Path(poses) if isinstance(poses, str | os.PathLike) else None
    if given.estimate_mount:
        raise InputError(
            "estimate_mount: use contactbench.pipeline.calibration.mount.estimate_mount, which returns it."
        )
    if isinstance(poses, str | os.PathLike) or hasattr(poses, "to_csv"):
        poses = _table(poses, given)
    if isinstance(poses, PoseTable):
        raw = RawOrientations(poses.raw, poses.convention)
        found = calibrate_poses(poses.poses, raw=raw, **assumed(given))
    else:
        found = calibrate_poses(poses, **assumed(given))
    if out is not None:
        mount = None if given.R_ES is None else Mount.of(given.R_ES.T)
        save_calibration(found, Path(out), source=source, created=creation_time(), mount=mount)
    return found


def load_calibration(file: FileName) -> Calibration:
    """Read a calibration that `calibrate` or the command wrote."""
    return load_calibration_file(Path(file))


def prepare_probe(
    mesh: FileName, out: FileName | None = None, *, alignment: FileName | None = None, **settings: Any
) -> Preparation:
    """
    Close, align and simplify a mesh.

    Parameters
    ----------
    mesh : str or path
        STL, OBJ, PLY, STEP, ...
    out : str or path, optional
        File for the probe, PLY; its regions and its history lie beside it.
    alignment : str or path, optional
        What ``contactbench probe align --save`` wrote.
    **settings
        As for ``contactbench probe prepare``: ``units``, ``facets``, ``close``, ``place`` (mm and degrees), ...

    Returns
    -------
    Preparation
        Its probe is ``content.probe``. One that is not ``ready`` is not written.
    """
    given, file = _chosen(ProbeSettings, settings), Path(mesh)
    refuse_to_guess(file, given)
    if out is not None:
        check_target(Path(out))  # before the work
    inputs = {"mesh": file} if alignment is None else {"mesh": file, "alignment": Path(alignment)}
    done = prepared(inputs, given, remember=True)
    if out is not None:
        if not done.ready:
            raise InputError(
                f"{arg(file)}: not fit for contacts, so nothing was written: {arg(' '.join(done.faults))}"
            )
        save_probe_file(done.content, Path(out))
    return done


def load_probe(file: FileName) -> Probe:
    """Read a prepared probe, PLY, with its regions, in S and m."""
    return load_probe_file(Path(file)).probe


def verify(
    probe: FileName,
    calibration: FileName,
    markers: FileName,
    recording: FileName,
    out: FileName | None = None,
    **settings: Any,
) -> Verification:
    """
    Judge contacts by touches of markers.

    Parameters
    ----------
    probe, calibration, markers, recording : str or path
        PLY, JSON, CSV (name, x_mm, y_mm, z_mm), and the touches, MCAP or CSV.
    out : str or path, optional
        File for it, JSON: what `export` takes.
    **settings
        As for ``contactbench verify touches``; forces as ``windows=[(8, 10)]``, N.
    """
    files = {"probe": probe, "calibration": calibration, "markers": markers, "recording": recording}
    name = "verification.json" if out is None else Path(out).name
    given = _chosen(VerificationParameters, {"name": name} | settings)
    found = verify_files({role: Path(file) for role, file in files.items()}, given, timed=True)
    if out is not None:
        write_file(Path(out), found.to_bytes())
    return found


def export(
    out: FileName,
    *,
    calibration: FileName,
    probe: FileName,
    verification: FileName | None = None,
    report: FileName | None = None,
    unverified: bool = False,
    **settings: Any,
) -> RuntimeConfig:
    """
    Write the bundle that a robot's runtime loads.

    Parameters
    ----------
    out : str or path
        A folder, or a zip file if it ends in .zip.
    calibration, probe, verification, report : str or path
        What the steps before wrote.
    unverified : bool
        Write it although nobody has shown that it is right; it says so.
    **settings
        As for ``contactbench bundle export``: ``rate`` (Hz), ``model``, ``serial``, ...
    """
    judged, told = (None if file is None else Path(file) for file in (verification, report))
    made = export_from_files(
        Path(calibration),
        Path(probe),
        judged,
        told,
        _chosen(ExportOptions, settings),
        created=creation_time(),
        unverified=unverified,
    )
    made.write(out)
    return made


def load_bundle(file: FileName) -> RuntimeConfig:
    """Read a bundle, and check everything in it."""
    return RuntimeConfig.load(file)


def load_runtime(bundle: FileName) -> Runtime:
    """Open a bundle for samples: ``pose(R, p, time)``, then ``locate(wrench, time, arrival, 0)``; N, N·m, m, s."""
    return make_runtime(RuntimeConfig.load(bundle))


def to_pandas(found: Batch | Verification | PoseTable) -> Any:
    """
    Return a table of contacts (a row a wrench), of verified touches, or of poses, in SI units.

    Raises
    ------
    ImportError
        pandas is not installed.
    """
    import pandas as pd

    if isinstance(found, Verification):
        return pd.DataFrame([vars(touch) for touch in found.touches])
    if isinstance(found, PoseTable):
        rows = [
            [*turned, *pose.force, *pose.torque] for turned, pose in zip(found.raw, found.poses, strict=True)
        ]
        return pd.DataFrame(rows, columns=[*found.convention.columns, "fx", "fy", "fz", "mx", "my", "mz"])
    vectors = {f"point_{axis}": found.points[:, k] for k, axis in enumerate("xyz")}
    vectors |= {f"normal_{axis}": found.normals[:, k] for k, axis in enumerate("xyz")}
    names = ("torques", "confidences", "misfits", "sigma_max", "faces", "candidates")
    reasons = [Reason(value).name for value in found.reasons.tolist()]
    columns = {"reasons": reasons, "accepted": found.accepted} | vectors
    return pd.DataFrame(columns | {name: getattr(found, name) for name in names})


def _chosen(model: type[Chosen], settings: Mapping[str, Any]) -> Chosen:
    """Return settings by the names of their options, some of which are not those of the fields."""
    fields = model.model_fields.items()
    names = {
        option_name(name, field)[2:].replace("-", "_"): name
        for name, field in fields
        if field.json_schema_extra
    }
    return model.checked({names.get(name, name): value for name, value in settings.items()})
