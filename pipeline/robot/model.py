"""Arms as MuJoCo models: kinematics alone, nothing is ever simulated here."""

import importlib
import threading
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.robot.robots import Capsule, RobotDescription, Triple

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

FLANGE = "E"


class Kinematics:
    """A compiled arm and its scratch memory.

    Only ``mj_kinematics`` is called, plus ``mj_comPos`` where a Jacobian needs it. ``mj_forward`` would also
    factor the inertia matrix, look for contacts and solve for accelerations: several times the work, on
    inertias that the model does not know.

    Parameters
    ----------
    description : RobotDescription
        The arm.
    capsules : iterable of Capsule
        Geometry to carry along; none for plain kinematics, which are faster without.

    Raises
    ------
    InputError
        MuJoCo is not installed.
    """

    def __init__(self, description: RobotDescription, capsules: Iterable[Capsule] = ()) -> None:
        # Any: MuJoCo ships no type stubs. Imported here so that importing this package costs nothing.
        self.mujoco: Any = import_mujoco()
        self.model: Any = self.mujoco.MjModel.from_xml_string(mjcf(description, capsules))
        self.data: Any = self.mujoco.MjData(self.model)
        self._site: int = self.model.site(FLANGE).id
        # Views into MuJoCo's memory; looking them up again would take longer than the kinematics.
        self._qpos = self.data.qpos
        self._xmat, self._xpos = self.data.site_xmat[self._site], self.data.site_xpos[self._site]
        # MuJoCo releases the GIL while it works, so two threads would write into each other's poses.
        self.lock = threading.Lock()

    def flange(self, q: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """R_BE (3, 3) and p_BE_B (3,), m, of one configuration (n,), rad."""
        with self.lock:
            self.place(q)
            return self._xmat.reshape(3, 3).copy(), self._xpos.copy()

    def rotations(self, Q: NDArray[np.float64]) -> NDArray[np.float64]:
        """R_BE (m, 3, 3) of configurations (m, n), rad."""
        R_BE = np.empty((len(Q), 9))
        with self.lock:
            for row, q in zip(R_BE, Q, strict=True):
                self.place(q)
                row[:] = self._xmat
        return R_BE.reshape(-1, 3, 3)

    def jacobian(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Flange Jacobian (6, n) in B, linear rows before angular ones, of one configuration (n,), rad."""
        J = np.zeros((6, self.model.nv))
        with self.lock:
            self.place(q)
            # mj_jacSite reads the joint axes that mj_comPos derives from the poses.
            self.mujoco.mj_comPos(self.model, self.data)
            self.mujoco.mj_jacSite(self.model, self.data, J[:3], J[3:], self._site)
        return J

    def place(self, q: NDArray[np.float64]) -> None:
        """Compute every pose for q (n,), rad. The caller holds `lock` until it has read them."""
        self._qpos[:] = q
        self.mujoco.mj_kinematics(self.model, self.data)


def mjcf(description: RobotDescription, capsules: Iterable[Capsule] = ()) -> str:
    """Write the arm as a MuJoCo model.

    Rotations go in as quaternions: MJCF reads ``euler`` about the axes that turn along, and in degrees
    unless told otherwise; the description's convention is neither. Numbers are written so that they are read
    back to the last bit.

    Parameters
    ----------
    description : RobotDescription
        The arm.
    capsules : iterable of Capsule
        Geometry to carry along, which collides with nothing by itself.

    Returns
    -------
    str
        The XML of the model; body i is moved by joint i, and the site ``E`` is the flange.
    """
    root = ET.Element("mujoco", model=description.name)
    ET.SubElement(root, "compiler", angle="radian", inertiafromgeom="false")
    bodies = [ET.SubElement(root, "worldbody")]
    for joint in description.joints:
        body = ET.SubElement(bodies[-1], "body", _pose(joint.origin_xyz, joint.origin_rpy), name=joint.name)
        # The compiler insists on an inertia; a ball of 0.1 m stands in, for no dynamics are computed.
        inertia = 0.4 * joint.child_mass * 0.1**2
        ET.SubElement(
            body,
            "inertial",
            pos="0 0 0",
            mass=_numbers(joint.child_mass),
            diaginertia=_numbers(inertia, inertia, inertia),
        )
        ET.SubElement(body, "joint", name=joint.name, type="hinge", axis="0 0 1")
        bodies.append(body)
    ET.SubElement(bodies[-1], "site", _pose(description.flange_xyz, description.flange_rpy), name=FLANGE)
    for capsule in capsules:
        ET.SubElement(
            bodies[capsule.body],
            "geom",
            name=capsule.name,
            type="capsule",
            fromto=_numbers(*capsule.start_xyz, *capsule.end_xyz),
            size=_numbers(capsule.radius),
            contype="0",
            conaffinity="0",
        )
    return ET.tostring(root, encoding="unicode")


def fixed_axes(rpy: Triple) -> "Rotation":
    """Rotation by turns about the fixed x, then y, then z axis, rad."""
    from scipy.spatial.transform import Rotation  # a third of a second to import

    return Rotation.from_euler("xyz", rpy)  # lower case: fixed axes


def _pose(xyz: Triple, rpy: Triple) -> dict[str, str]:
    x, y, z, w = fixed_axes(rpy).as_quat()
    return {"pos": _numbers(*xyz), "quat": _numbers(w, x, y, z)}


def _numbers(*values: float) -> str:
    return " ".join(repr(float(value)) for value in values)


def import_mujoco(what: str = message("robot kinematics")) -> Any:  # there are no stubs to check against
    """Return MuJoCo, which `what` needs.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        mujoco = importlib.import_module("mujoco")
    except ImportError as error:
        raise InputError(
            f"{arg(what)} needs MuJoCo, which cannot be imported ({arg(error)}): pip install 'contactbench[sim]'"
        ) from error
    # Else every warning is written into MUJOCO_LOG.TXT in the user's folder.
    mujoco.set_mju_user_warning(lambda _: None)
    return mujoco
