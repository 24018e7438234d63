"""Sample data for the tutorials: what a technician's bench leaves of one probe, with the truth beside it."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PoseNoise, PoseSample, calibrate
from contactbench.pipeline.calibration.files.compensate_file import compensate_file
from contactbench.pipeline.calibration.files.pose_csv import read_poses, write_poses
from contactbench.pipeline.demo.compare import HELD_S, press_markers, read_wrenches
from contactbench.pipeline.demo.gravity import weigh_on_bench
from contactbench.pipeline.demo.housing import housing_of
from contactbench.pipeline.demo.tape import RATE_HZ, DemoTool, draw_tool, write_csv
from contactbench.pipeline.demo.verification import write_markers
from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.loads import orientations_in_use, weigh
from contactbench.pipeline.simulation.scenes.physics import physics
from contactbench.pipeline.simulation.virtual.bench import bundled
from contactbench.pipeline.simulation.virtual.markers import markers

PROBE = "linear"
_FACETS = 8_000  # of the housing: prepared in seconds
_HELD_OUT, _MEAN_OF = 4, 200  # poses that the calibration does not see, each a second long
_ALIGNED = ("marker", "px", "py", "pz", "fx", "fy", "fz", "mx", "my", "mz")


@dataclass(frozen=True)
class TutorialData:
    """What was written."""

    folder: Path
    files: tuple[str, ...]  # names, in the order in which a technician comes by them
    place: str  # how the housing sits on the sensor, as --place takes it: mm and degrees
    bumped: tuple[str, ...]  # names of the poses that somebody leaned on


def write_tutorial(
    folder: Path, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> TutorialData:
    """
    Write sample data of one probe into a new folder; the same seed gives the same bytes.

    Parameters
    ----------
    folder : Path
        New, or empty.
    seed : int
        Of chance, at least 0.
    progress : callable, optional
        Told what is being done, in a few words.

    Raises
    ------
    InputError
        The folder is not empty, the seed is negative, MuJoCo is missing, or a file cannot be written.
    """
    if seed < 0:
        raise InputError(f"--seed {seed}: give a number of 0 or more.")
    physics()  # before there is a folder
    make_folder(folder)
    if any(folder.iterdir()):
        raise InputError(f"{folder}: the folder is not empty: name a new one, or empty it.")
    tool, truth = draw_tool(_chance(seed, 0)), bundled(PROBE)
    progress("weighing the tool")
    bumped = weigh_on_bench(folder, tool, truth, _chance(seed, 1))
    write_poses(folder / "held-out.csv", _held_out(tool, seed))
    progress("pressing the markers")
    pressed = press_markers(folder, PROBE, tool, truth, _chance(seed, 4), rests=True)
    housing, T_SP, _ = housing_of(PROBE, _FACETS)
    write_file(folder / "housing.stl", housing)
    write_markers(folder, markers(PROBE))
    write_csv(folder / "alignment.csv", _ALIGNED, _alignment(folder, T_SP))
    data = TutorialData(folder, tuple(_FILES), _place(T_SP), bumped)
    write_file(folder / "truth.json", _truth(tool, data, pressed.slipped, seed))
    write_file(folder / "README.md", _readme(data).encode())
    return data


def _chance(seed: int, step: int) -> np.random.Generator:
    return np.random.default_rng([seed, step, 24])


def _held_out(tool: DemoTool, seed: int) -> tuple[PoseSample, ...]:
    noise = tool.noise(_MEAN_OF**-0.5)
    each = PoseNoise(float(np.max(noise.force)), float(np.max(noise.torque)))
    poses = orientations_in_use(_HELD_OUT, _chance(seed, 2))
    return weigh(tool.truth, poses, each, _chance(seed, 3)).poses


def _alignment(folder: Path, T_SP: Floats) -> list[list[object]]:
    """Return the touches once more, as `probe align --touches` takes them: points of the mesh, mean wrenches in S."""
    calibration = calibrate(read_poses(folder / "poses.csv").poses)
    with TemporaryDirectory() as scratch:
        file = Path(scratch, "wrenches.csv")
        compensate_file(calibration, folder / "recording.csv", file)
        times, wrenches = read_wrenches(file)
    points = (markers(PROBE) - T_SP[:3, 3]) @ T_SP[:3, :3]
    rows: list[list[object]] = []
    with (folder / "truth.csv").open(encoding="utf-8") as file_:
        next(file_)
        for line in file_:
            end, marker = line.split(",")[:2]
            held = (times > float(end) - HELD_S + 0.5 / RATE_HZ) & (times <= float(end) + 0.5 / RATE_HZ)
            mean = wrenches[held].mean(axis=0)
            rows.append([marker, *(1e3 * points[int(marker) - 1]).round(3).tolist(), *mean.tolist()])
    return rows


def _place(T_SP: Floats) -> str:
    angles = Rotation.from_matrix(T_SP[:3, :3]).as_euler("xyz", degrees=True)
    return ",".join(f"{round(value, 3) + 0.0:g}" for value in (*(1e3 * T_SP[:3, 3]), *angles))


def _truth(tool: DemoTool, data: TutorialData, slipped: int, seed: int) -> bytes:
    model = tool.truth
    return json.dumps(
        {
            "seed": seed,
            "probe": PROBE,
            "mass_kg": model.mass,
            "gravity_W_N": model.gravity_W.tolist(),
            "centre_of_mass_S_m": model.centre_of_mass_S.tolist(),
            "force_bias_N": model.force_bias.tolist(),
            "torque_bias_Nm": model.torque_bias.tolist(),
            "bumped_poses": list(data.bumped),
            "place_mm_deg": data.place,
            "touches_that_slipped": slipped,
        },
        indent=1,
    ).encode()


# What each file is, in the order in which a technician comes by them.
_FILES = {
    "gravity.mcap": "recording of sensor and robot while the tool is turned to nine poses; somebody leans on one",
    "poses.csv": "the still poses in it: mean readings (N, N·m) and orientations as quaternions",
    "held-out.csv": "four more poses, to check a calibration with",
    "housing.stl": "mesh of the hollow housing as a CAD program exports it, mm, in a frame of its own",
    "alignment.csv": "touches of marked points of the mesh (mm), with the compensated wrench of each",
    "markers.csv": "the marked points in the sensor frame, mm",
    "touches.mcap": "recording of sensor and robot while each marker is pressed, straight and at 30 degrees",
    "recording.csv": "the same recording as a table",
    "truth.csv": "TRUTH: where, how and how hard each touch really was",
    "truth.json": "TRUTH: weight, centre of mass, bias, mounting, and the pose that was bumped",
}


def _readme(data: TutorialData) -> str:
    rows = "\n".join(f"| `{name}` | {text} |" for name, text in _FILES.items())
    return f"""# Sample data

Made by `contactbench tutorial` on a virtual bench: a {PROBE} probe on a six-axis sensor. No real sensor was read.

| file | what it is |
|---|---|
{rows}

The housing sits on the sensor at `--place {data.place}` (mm, degrees). Touches have 8 to 10 N. Start here:

    contactbench calibrate fit poses.csv --out calibration.json
    contactbench probe prepare housing.stl --close auto --place {data.place} --out probe.ply

and compare with `truth.json`.
"""
