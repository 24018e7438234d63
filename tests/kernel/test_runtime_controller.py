"""The controller of a bundle, as the C library tells it: of this version and of version 1, as Python reads it."""

from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING, Any

import pytest
from config.runtime.bundles import OLD_GAINS, example, of_version_1, of_version_2, of_version_3
from kernel.test_runtime_library import Library
from native import installed, needs_cmake

from contactbench.pipeline.config.runtime import RuntimeConfig

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.config.runtime.model import ControllerPart, LimitsPart

pytestmark = needs_cmake

# In the order of cb_controller: where in the bundle, and how many numbers.
DOUBLES = [
    ("desired_force_N", 1), ("period_s", 1), ("servo_lag_s", 1),
    ("force.mass_kg", 1), ("force.damping_Nspm", 1), ("force.stiffness_Npm", 1), ("force.gain_per_s", 1),
    ("angle.inertia", 2), ("angle.damping", 2), ("angle.stiffness", 2), ("angle.gain_per_s", 2),
    ("angle.settling_s", 1), ("lead.bandwidth_per_s", 3), ("lead.smoothing_s", 1), ("lead.lean_rad", 1),
    ("lead.lean_s", 1), ("touch.approach_speed_mps", 1), ("touch.approach_travel_m", 1),
    ("touch.retract_speed_mps", 1), ("touch.retract_travel_m", 1), ("touch.touch_force_N", 1),
    ("touch.low_force_N", 1), ("touch.ramp_s", 1), ("touch.probing_m", 1), ("tool.left_force_N", 1),
    ("tool.left_torque_Nm", 1), ("tool.taring_s", 1), ("tool.gyration_m", 1), ("watch.stale_s", 1),
    ("watch.give_up_s", 1), ("watch.following_s", 1), ("watch.max_tilt_rad", 1),
]  # fmt: skip
LIMITS = ("max_force_N", "max_torque_Nm", "max_speed_mps", "max_turn_radps")


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return Library(installed(tmp_path_factory.mktemp("installed")))


class Controller(ctypes.Structure):
    _fields_ = [
        ("size", ctypes.c_uint32),
        *((name, ctypes.c_int32) for name in ("aware", "attempts", "reserved")),
        *((name.replace(".", "_"), ctypes.c_double * count) for name, count in DOUBLES),
        *((name, ctypes.c_double) for name in LIMITS),
    ]


def told(library: Library, folder: Path, files: dict[str, bytes]) -> tuple[int, Controller]:
    folder.mkdir()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    handle, error = library.open(folder)
    assert handle, error.message
    found = Controller(size=ctypes.sizeof(Controller))
    library.c.cb_describe_controller.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    code = library.c.cb_describe_controller(handle, ctypes.byref(found))
    library.c.cb_close(handle)
    return code, found


def check(found: Controller, part: ControllerPart, limits: LimitsPart) -> None:
    for name, _ in DOUBLES:
        value: Any = part
        for step in name.split("."):
            value = getattr(value, step)
        assert list(getattr(found, name.replace(".", "_"))) == (
            value if isinstance(value, list) else [value]
        ), name
    assert (found.aware, found.attempts) == (part.variant == "aware", part.touch.attempts)
    for name in LIMITS:
        limit = getattr(limits, name)
        assert getattr(found, name) == (math.inf if limit is None else limit)


@pytest.mark.parametrize("version", [1, 2, 3, 4])
def test_the_library_tells_the_controller_that_python_reads(
    library: Library, tmp_path: Path, version: int
) -> None:
    files = example().encoded()
    older = {1: of_version_1, 2: of_version_2, 3: of_version_3}
    files = older[version](files) if version in older else files
    model = RuntimeConfig.from_files(files).model
    assert model.controller is not None
    code, found = told(library, tmp_path / "b", files)
    assert code == 0
    check(found, model.controller, model.limits)


def test_a_bundle_without_a_controller_tells_its_limits(library: Library, tmp_path: Path) -> None:
    code, found = told(library, tmp_path / "b", of_version_1(example().encoded(), None))
    assert code == 6
    assert (found.max_force_N, found.max_speed_mps, found.desired_force_N[0]) == (30.0, 0.1, 0.0)


@pytest.mark.parametrize(
    ("controller", "says"),
    [
        ({**OLD_GAINS, "extra": 1}, "controller.extra"),
        ({**OLD_GAINS, "angle_inertia": [0.1, 0.2]}, "controller.angle_inertia"),
        ({**OLD_GAINS, "force_damping_Nspm": 0.0}, "controller.force_damping_Nspm"),
        ({**OLD_GAINS, "desired_force_N": 30.0}, "controller.desired_force_N"),
    ],
)
def test_a_wrong_controller_of_version_1_is_refused(
    library: Library, tmp_path: Path, controller: dict[str, Any], says: str
) -> None:
    for name, data in of_version_1(example().encoded(), controller).items():
        (tmp_path / name).write_bytes(data)
    handle, error = library.open(tmp_path)
    assert not handle
    assert says in error.message.decode()


def test_wrong_sizes_and_null_are_refused(library: Library, tmp_path: Path) -> None:
    assert library.c.cb_describe_controller(None, None) == 1
    for name, data in example().encoded().items():
        (tmp_path / name).write_bytes(data)
    handle, _ = library.open(tmp_path)
    library.c.cb_describe_controller.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    assert library.c.cb_describe_controller(handle, ctypes.byref(Controller(size=4))) == 1
    library.c.cb_close(handle)
