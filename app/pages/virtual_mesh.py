"""The mesh of the probe that hangs on the virtual bench, as a technician would get it, and how it is mounted."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contactbench.pipeline.devices.url import DeviceAddress, Protocol
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.preparation.alignment.alignment import Alignment, from_transform
from contactbench.pipeline.session.state import State
from contactbench.pipeline.workbench.probe import Mesh, ProbeWork

SENSOR = "devices.sensor"


@dataclass(frozen=True, eq=False)
class Housing:
    """A mesh with what is known about it."""

    mesh: Mesh
    alignment: Alignment | None  # None: it is aligned
    units: str
    alpha_mm: float | None  # Size of the outer surface's facets
    close: tuple[str, ...] = ()  # How openings are closed, as in `ProbePlan`


def bench_address(state: State) -> DeviceAddress | None:
    """Return the virtual bench that a session works with; None: it works with a real one."""
    setting = state.settings.get(SENSOR)
    if setting is None or not isinstance(setting.value, str):
        return None
    try:
        address = DeviceAddress.parse(setting.value)
    except InputError:  # the page on which it was typed says what is wrong
        return None
    return address if address.protocol is Protocol.VIRTUAL else None


def take_housing(work: ProbeWork, address: DeviceAddress, monitor: Monitor = NOBODY) -> Housing:
    """Take the virtual bench's mesh; as ``contactbench demo`` writes it, housing.stl. For a worker."""
    options = address.bench
    if options is None:
        raise InputError(f"{arg(address)}: this is no virtual bench: choose a mesh instead.")
    if options.mesh is not None:
        mesh = work.take(Path(options.mesh), "m", monitor)
        aligned = mesh.original.frame == "S"
        return Housing(mesh, None if aligned else from_transform(np.eye(4)), "m", None)
    from contactbench.pipeline.demo.housing import housing_of  # it brings what draws the demo's pictures

    content, T_SP, alpha = housing_of(options.probe)
    with tempfile.TemporaryDirectory(prefix="contactbench-") as scratch:
        file = Path(scratch) / f"{options.probe}-housing.stl"
        file.write_bytes(content)
        mesh = work.take(file, "mm", monitor)
    return Housing(mesh, from_transform(T_SP), "mm", 1e3 * alpha, ("auto",))
