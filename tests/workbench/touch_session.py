"""A session of the virtual bench, calibrated on it and with its true probe: ready to be verified."""

from functools import cache
from pathlib import Path

import numpy as np
from weighing_files import planned

from contactbench import assets
from contactbench.pipeline.calibration import PoseSample, calibrate
from contactbench.pipeline.calibration.files.calibration_file import save_calibration
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile, save_probe_file
from contactbench.pipeline.session import Session
from contactbench.pipeline.simulation.virtual.bench import VirtualBench
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live import Live
from contactbench.pipeline.workbench.markers import keep, spread
from contactbench.pipeline.workbench.verify import VerifyWork, tool_of

NAME = "linear"
ADDRESS = f"virtual://bench?probe={NAME}&sensor=paper"
STEPWISE = f"{ADDRESS}&speed=step"


@cache
def weighed():
    """Weigh the virtual bench's tool, as a technician would turn it."""
    bench, poses = VirtualBench(NAME, "paper"), []
    for R_WS in planned(8):
        bench.turn_to(R_WS, seconds=0.5)
        bench.advance(1.2)
        read = np.array([[*each.force, *each.torque] for each in bench.advance(0.5).wrenches])
        mean, sd = read.mean(axis=0), read.std(axis=0)
        poses.append(PoseSample(R_WS, mean[:3], mean[3:], len(read), sd[:3], sd[3:]))
    bench.close()
    return calibrate(poses)


@cache
def surface():
    """Return the probe in S, with its acoustic face as a region."""
    vertices, faces = assets.make(NAME, 3_000)
    return Probe.from_arrays(vertices, faces, assets.contact_region(NAME, vertices, faces), name=NAME)


@cache
def face_markers(count):
    """Return markers spread over its acoustic face."""
    return spread(surface(), count, 1)


def make_session(folder: Path, scratch: Path) -> Path:
    """Make a session with a calibration and a probe, and the bench's address as its devices."""
    save_calibration(weighed(), scratch / "calibration.json")
    save_probe_file(ProbeFile(surface(), RegionSet.from_labels(surface().region), "S"), scratch / "probe.ply")
    with Session.create(folder, by="ada") as session:
        read = {
            name: (scratch / name).read_bytes() for name in ("calibration.json", "probe.ply", "probe.json")
        }
        session.set_parameter("devices.sensor", ADDRESS)
        session.set_parameter("devices.poses", ADDRESS)
        session.set_parameter("devices.serial", "VB-1")
        session.add_result(
            "calibration", "calibration.json", {"calibration.json": read["calibration.json"]}, {}, {}
        )
        files = {"probe.ply": read["probe.ply"], "probe.json": read["probe.json"]}
        session.add_result("probe", "probe.ply", files, {}, {})
    return folder


def press(live, point, force=9.0, seconds=0.7):
    """Press a point on a bench that goes by steps, and let go."""
    live.pair.bench.touch(point_S=point, force=force, seconds=seconds)
    live.pair.step(round((seconds + 0.3) * 250))


def touch_all(live, work, most=30):
    """Press every marker that is wanted."""
    for _ in range(most):
        view = work.touches.view()
        if view.next_one is None:
            return
        press(live, work.touches.markers[view.next_one].point_S)
    raise AssertionError(f"not all markers were accepted: {work.touches.view().last}")


def side():
    """Return a point on the side of the head, 30 mm below its end."""
    _, _, feet = SurfaceIndex(surface().vertices, surface().faces).closest(
        np.array([[0.04, 0.0, surface().vertices[:, 2].max() - 0.03]])
    )
    return feet[0]


def verify(folder, markers=2):
    """Verify a session on a bench that goes by steps."""
    desk, live = Desk(Session.open(folder, by="ada")), Live()
    try:
        live.open(STEPWISE, STEPWISE)
        live.pair.step(400)
        tool = tool_of(desk.folder, desk.state)
        wanted = face_markers(markers)
        desk.do(lambda session: keep(session, wanted)).result()
        work = VerifyWork(desk, live)
        work.start(tool, wanted)
        touch_all(live, work)
        work.finish()
    finally:
        live.close()
        desk.close()
    return folder
