"""Arms as MuJoCo models, and any arm from its URDF or MJCF file: its chain to the flange becomes a description."""

import importlib
import itertools
import threading
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.robot.robots import TOOL, Capsule, Joint, RobotDescription, Triple

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


SUFFIXES = (".urdf", ".xml", ".mjcf")
FLANGES = ("tool0", "attachment_site", "flange")
"""
Names that a flange has by convention, alone or after the arm's own; the first one counts: a UR's ``tool0`` is what its
controller reports, and its ``flange`` is turned against that.
"""

_LARGEST_FILE = 20_000_000
_MOST_BODIES = 500
_RADIUS_M = 0.06  # of a link whose outline is not known
_SHORTEST_M = 0.01
_MARGIN_M = 0.05  # more than what a clearance keeps free
_TURNS = 2 * np.pi  # to either side, of a joint without an end
_SPEED, _TORQUE = 1.0, 100.0  # rad/s, N·m, where the file tells none
_LEAST_MASS = 1e-3
_LONGEST_M = 100.0  # from one frame to the next; beyond, its unit is another one
_MOST_TURNED = 4 * np.pi  # rad, of a limit
_NAMES = ("name", "link", "class", "childclass")  # attributes that may read like a number and are none
_MULTIPLIED = ("replicate", "composite")  # one element makes any number of bodies
# What neither kinematics nor limits need, and what would make MuJoCo look for other files.
_NEEDLESS = {
    "urdf": ("visual", "collision", "transmission", "gazebo", "ros2_control", "mujoco"),
    "mjcf": (
        "geom", "asset", "actuator", "contact", "custom", "deformable", "equality", "extension", "flexcomp",
        "keyframe", "camera", "light", "option", "plugin", "sensor", "size", "skin", "statistic", "tendon", "visual",
    ),
}  # fmt: skip


def names_file(name: str) -> bool:
    """Tell whether a robot's name is that of a file, with or without ``@FRAME``."""
    return _split(name)[0].suffix.lower() in (*SUFFIXES, ".xacro")


def read_robot(name: str) -> RobotDescription:
    """
    Return the arm in a file.

    The chain runs from the world of the file (which is B: a URDF's root link) to the flange, and its joints are all
    hinges. Where links have no known outline, their capsules are rough: lines between the joints' origins, 60 mm
    around.

    Parameters
    ----------
    name : str
        Of a URDF or MJCF file; with ``@FRAME``, the link, body or site that is the flange E. Without, it is the one of
        `FLANGES`, or else the only one at the end of the arm.

    Raises
    ------
    InputError
        The file cannot be read, is no arm of hinges, or has several frames that may be the flange: names them.
    """
    path, flange = _split(name)
    try:
        about = path.stat()
    except OSError as error:
        raise InputError(f"{arg(path)}: {arg(error.strerror)}: give a URDF or MJCF file.") from error
    if not path.is_file():  # a pipe would wait for its writer
        raise InputError(f"{arg(path)}: it is no file: give a URDF or MJCF file.")
    return _read(path, flange, about.st_mtime_ns, about.st_size)


def _split(name: str) -> tuple[Path, str]:
    file, _, frame = name.partition("@")
    return Path(file).expanduser(), frame


@lru_cache(maxsize=16)
def _read(path: Path, flange: str, changed: int, size: int) -> RobotDescription:
    del changed  # it says only that the file is another one
    if path.suffix.lower() == ".xacro":
        raise InputError(f"{arg(path)}: run xacro first, and give the URDF that it makes.")
    if size > _LARGEST_FILE:
        raise InputError(
            f"{arg(path)}: the file has more than {arg(_LARGEST_FILE)} bytes: give a robot's description."
        )
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{arg(path)}: {arg(error.strerror)}: check the file.") from error
    root = _parsed(path, data)
    told = _Told.of(root)
    mujoco = import_mujoco()
    try:
        model: Any = mujoco.MjModel.from_xml_string(_bare(path, root))
    except (ValueError, RecursionError, mujoco.FatalError) as error:
        raise InputError(
            f"{arg(path)}: it is no robot that MuJoCo can read ({arg(str(error).strip())})."
        ) from error
    if model.nbody > _MOST_BODIES:
        raise InputError(f"{arg(path)}: it has {arg(model.nbody)} bodies: give the file of one arm alone.")
    return _Arm(mujoco, model, path, told).description(flange)


def _parsed(path: Path, data: bytes) -> ET.Element:
    text = data.decode("utf-8-sig", errors="replace")
    # Zeros: UTF-16 without a mark, which a parser of XML reads all the same.
    if "\ufffd" in text or "\0" in text:
        raise InputError(f"{arg(path)}: it is not UTF-8 text: save it as UTF-8.")
    # Without a document type there are no entities, so nothing is expanded and nothing fetched.
    if "<!DOCTYPE" in text.upper() or "<!ENTITY" in text.upper():
        raise InputError(
            f"{arg(path)}: it has a document type, which no robot's description needs: remove it."
        )
    try:
        root = ET.fromstring(text)  # noqa: S314 - without a document type there is nothing to expand
    except (ET.ParseError, LookupError, ValueError) as error:
        raise InputError(f"{arg(path)}: it is not XML ({arg(error)}): give a URDF or MJCF file.") from error
    if root.tag not in ("robot", "mujoco"):
        raise InputError(
            f"{arg(path)}: it begins with <{arg(root.tag[:40])}>: give a URDF (<robot>) or MJCF (<mujoco>) file."
        )
    if root.tag == "mujoco" and root.find(".//include") is not None:
        raise InputError(f"{arg(path)}: it includes other files: give the file that has the arm itself.")
    if root.tag == "mujoco" and any(root.find(f".//{each}") is not None for each in _MULTIPLIED):
        raise InputError(
            f"{arg(path)}: it multiplies bodies (<{arg('>, <'.join(_MULTIPLIED))}>): give the file of one arm alone."
        )
    return root


def _refuse_infinite(path: Path, root: ET.Element) -> None:
    for element in root.iter():
        for key, value in element.attrib.items():
            if key not in _NAMES and not all(map(_finite, value.split())):
                raise InputError(
                    f"{arg(path)}: <{arg(element.tag)}> has {arg(key)}={arg(value[:40])!r}: every number"
                    " must be finite. Correct it."
                )


def _finite(word: str) -> bool:
    """Tell whether a word is a finite number, or none at all, which is for MuJoCo to judge."""
    try:
        return bool(np.isfinite(float(word)))
    except ValueError:
        return True


def _bare(path: Path, root: ET.Element) -> str:
    """Return the file's kinematics alone, as XML: no meshes, so that their files need not be there."""
    needless = _NEEDLESS["urdf" if root.tag == "robot" else "mjcf"]
    _remove(root, needless)
    _refuse_infinite(path, root)
    limits = {"boundmass": "0.001", "boundinertia": "1e-6", "balanceinertia": "true"}
    if root.tag == "robot":
        extension = ET.SubElement(root, "mujoco")
        # Fixed links stay, since one of them is the flange.
        ET.SubElement(extension, "compiler", {"fusestatic": "false", **limits})
        for link in root.iter("link"):
            if not link.get("name"):
                raise InputError(f"{arg(path)}: a link has no name: give it one.")
    else:
        compiler = root.find("compiler")
        compiler = ET.SubElement(root, "compiler") if compiler is None else compiler
        for word in ("meshdir", "texturedir", "assetdir", "fusestatic", "inertiafromgeom"):
            compiler.attrib.pop(word, None)
        compiler.attrib.update(limits)
    return ET.tostring(root, encoding="unicode")


def _remove(element: ET.Element, tags: tuple[str, ...]) -> None:
    for child in list(element):
        if child.tag in tags:
            element.remove(child)
        else:
            _remove(child, tags)


@dataclass(frozen=True)
class _Told:
    """What a file tells and MuJoCo does not keep."""

    speeds: dict[str, float]  # the largest ones that a URDF tells, by joint, rad/s
    limits: dict[
        str, tuple[float, float]
    ]  # of a URDF's revolute joints, rad: MuJoCo has no end where they are wrong
    coupled: frozenset[str]  # joints that others move
    bound: frozenset[str]  # bodies that are held by others

    @classmethod
    def of(cls, root: ET.Element) -> "_Told":
        speeds, limits = {}, {}
        for joint in root.iter("joint"):
            limit, name = joint.find("limit"), joint.get("name") or ""
            if limit is None:
                continue
            speed = _float(limit.get("velocity"))
            if 0 < speed < np.inf:
                speeds[name] = speed
            if joint.get("type") == "revolute":
                limits[name] = _float(limit.get("lower")), _float(limit.get("upper"))
        held = [
            each
            for group in root.findall("equality")
            for each in group
            if each.get("active") not in ("false", "0")
        ]
        mimics = {
            joint.get("name") or "" for joint in root.findall("joint") if joint.find("mimic") is not None
        }
        return cls(
            speeds,
            limits,
            frozenset(mimics | {each.get("joint1", "") for each in held if each.tag == "joint"}),
            frozenset(each.get(key, "") for each in held for key in ("body1", "body2")) - {"", "world"},
        )


def _float(text: str | None) -> float:
    try:
        return float(text or 0.0)
    except ValueError:
        return 0.0


def _named(usual: str, names: Iterable[str]) -> list[str]:
    """Return those of that name, which may follow the arm's own."""
    return [name for name in names if name == usual or name.endswith(f"_{usual}")]


class _Arm:
    """A model, looked at as one chain."""

    def __init__(self, mujoco: Any, model: Any, path: Path, told: _Told) -> None:
        self._model, self._path, self._told = model, path, told
        self._hinge, self._slide = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)
        data = mujoco.MjData(model)
        hinges = [int(model.jnt_qposadr[j]) for j in range(model.njnt) if model.jnt_type[j] == self._hinge]
        data.qpos[hinges] = 0.0
        for what in (model.body_pos, model.jnt_pos, model.site_pos):
            if not (np.abs(what) <= _LONGEST_M).all():
                raise InputError(
                    f"{arg(path)}: a frame is more than {arg(_LONGEST_M):g} m from the one before it: give"
                    " positions in m."
                )
        mujoco.mj_kinematics(model, data)
        self._data = data

    def description(self, flange: str) -> RobotDescription:
        """Return the arm from the world to its flange."""
        chain_of = {name: self._chain(body) for name, body, _, _ in self._frames()}
        name = self._flange(flange, chain_of)
        chain = chain_of[name]
        self._refuse_coupled(chain)
        _, _, p_BE, R_BE = next(frame for frame in self._frames() if frame[0] == name)
        joints, p, R = [], np.zeros(3), np.eye(3)
        for number, joint in enumerate(chain):
            axis, anchor = self._data.xaxis[joint], self._data.xanchor[joint]
            R_next = _along(axis)
            mass = self._mass(joint, chain[number + 1] if number + 1 < len(chain) else None)
            joints.append(self._joint(joint, R.T @ (anchor - p), R.T @ R_next, mass))
            p, R = anchor.copy(), R_next
        origins = [self._data.xanchor[joint].copy() for joint in chain]
        frames = [np.eye(3), *(_along(self._data.xaxis[joint]) for joint in chain)]
        capsules, never = _envelope([np.zeros(3), *origins, p_BE], frames)
        return RobotDescription(
            f"{self._path.stem}@{name}",
            tuple(joints),
            _triple(R.T @ (p_BE - p)),
            _angles(R.T @ R_BE),
            capsules,
            never,
        )

    def _frames(self) -> list[tuple[str, int, NDArray[np.float64], NDArray[np.float64]]]:
        """Return name, body, position and rotation in B of every body and site."""
        model, data = self._model, self._data
        bodies = [
            (model.body(k).name, k, data.xpos[k].copy(), data.xmat[k].reshape(3, 3).copy())
            for k in range(1, model.nbody)
        ]
        sites = [
            (
                model.site(k).name,
                int(model.site_bodyid[k]),
                data.site_xpos[k].copy(),
                data.site_xmat[k].reshape(3, 3).copy(),
            )
            for k in range(model.nsite)
        ]
        return [frame for frame in (*sites, *bodies) if frame[0]]

    def _chain(self, body: int) -> tuple[int, ...]:
        """Return the joints between the world and a body, from the base on."""
        chain: list[int] = []
        while body:
            first, count = int(self._model.body_jntadr[body]), int(self._model.body_jntnum[body])
            chain = [*range(first, first + count), *chain] if count else chain
            body = int(self._model.body_parentid[body])
        return tuple(chain)

    def _flange(self, wanted: str, chain_of: dict[str, tuple[int, ...]]) -> str:
        arms = {
            name: chain
            for name, chain in chain_of.items()
            if chain and all(self._model.jnt_type[joint] == self._hinge for joint in chain)
        }
        if wanted and wanted not in chain_of:
            raise InputError(
                f"{arg(self._path)}: it has no frame {arg(wanted)!r}. Possible: {arg(', '.join(sorted(arms)))}."
            )
        if wanted and wanted not in arms:
            raise self._no_hinges(wanted)
        if wanted:
            return wanted
        if not arms:
            raise InputError(f"{arg(self._path)}: it has no joint that turns: give the file of an arm.")
        for usual in FLANGES:
            named, usable = _named(usual, chain_of), _named(usual, arms)
            if named and (not usable or (usual in named and usual not in usable)):
                raise self._no_hinges(named[0] if not usable else usual)
            if len(usable) == 1:
                return usable[0]
        most = max(map(len, arms.values()))
        last = [name for name, chain in arms.items() if len(chain) == most]
        end = arms[last[0]]
        if len(last) == 1 and not any(chain[:most] == end != chain for chain in chain_of.values()):
            return last[0]
        raise InputError(
            f"{arg(self._path)}: several frames may be the flange. Name it: {arg(self._path.name)}@FRAME, with one of"
            f" {arg(', '.join(sorted(last)))}."
        )

    def _no_hinges(self, flange: str) -> InputError:
        return InputError(
            f"{arg(self._path)}: between the base and {arg(flange)} there are no joints, or joints that do not turn:"
            " give an arm of hinges, or name another frame as its flange."
        )

    def _refuse_coupled(self, chain: tuple[int, ...]) -> None:
        names = [self._model.joint(joint).name for joint in chain]
        bodies = {self._model.body(int(self._model.jnt_bodyid[joint])).name for joint in chain}
        for found in (
            [name for name in names if name in self._told.coupled],
            sorted(bodies & self._told.bound),
        ):
            if found:
                raise InputError(
                    f"{arg(self._path)}: {arg(found[0])} is coupled to another joint or body (mimic or"
                    " equality): give an arm whose joints move by themselves."
                )

    def _joint(
        self, joint: int, position: NDArray[np.float64], rotation: NDArray[np.float64], mass: float
    ) -> Joint:
        model = self._model
        name = model.joint(joint).name or f"joint {joint + 1}"
        low, high = (float(end) for end in model.jnt_range[joint])
        if name in self._told.limits:
            low, high = self._told.limits[name]
        elif not model.jnt_limited[joint]:
            low, high = -_TURNS, _TURNS
        if not low < high:
            raise InputError(
                f"{arg(self._path)}: joint {arg(name)}: its limits are {arg(low):g} to {arg(high):g}: give a lower"
                ' limit below the upper one, or type="continuous" to a joint without an end.'
            )
        if max(abs(low), abs(high)) > _MOST_TURNED:
            raise InputError(
                f"{arg(self._path)}: joint {arg(name)}: its limits are {arg(low):g} to {arg(high):g} rad, more than"
                ' two turns: if they are degrees, give them in radians; a joint without an end has type="continuous".'
            )
        torque = float(max(abs(model.jnt_actfrcrange[joint]))) if model.jnt_actfrclimited[joint] else 0.0
        return Joint(
            name,
            _triple(position),
            _angles(rotation),
            low,
            high,
            self._told.speeds.get(name, _SPEED),
            torque or _TORQUE,
            mass,
        )

    def _mass(self, joint: int, following: int | None) -> float:
        """Return the mass that a joint moves and the next one does not, kg."""
        model = self._model
        whole = float(model.body_subtreemass[model.jnt_bodyid[joint]])
        rest = 0.0 if following is None else float(model.body_subtreemass[model.jnt_bodyid[following]])
        return max(whole - rest, _LEAST_MASS)


def _along(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the least turn (3, 3) that takes z to an axis of length 1."""
    from scipy.spatial.transform import Rotation  # a third of a second to import

    z = np.array([0.0, 0.0, 1.0])
    normal = np.cross(z, axis)
    sine, cosine = float(np.linalg.norm(normal)), float(axis[2])
    if sine < 1e-12:
        return np.eye(3) if cosine > 0 else np.diag([1.0, -1.0, -1.0])
    return np.asarray(Rotation.from_rotvec(normal / sine * np.arctan2(sine, cosine)).as_matrix())


def _envelope(
    points: list[NDArray[np.float64]], frames: list[NDArray[np.float64]]
) -> tuple[tuple[Capsule, ...], tuple[tuple[str, str], ...]]:
    """Return capsules between the joints' origins, and the pairs that only short links keep apart."""
    lengths = [float(np.linalg.norm(b - a)) for a, b in itertools.pairwise(points)]
    capsules = []
    for body, (start, end, length) in enumerate(zip(points[:-1], points[1:], lengths, strict=True)):
        if length < _SHORTEST_M:
            continue
        # In the frame of the joint that moves it, whose origin is the start; the base's is B.
        local = frames[body].T @ (end - start)
        capsules.append(
            Capsule("base" if body == 0 else f"link {body}", body, (0.0, 0.0, 0.0), _triple(local), _RADIUS_M)
        )
    ends = [(capsule.name, capsule.body) for capsule in capsules] + [(TOOL, len(points) - 1)]
    near = 2 * _RADIUS_M + _MARGIN_M
    never = tuple(
        (a, b) for (a, i), (b, j) in itertools.combinations(ends, 2) if sum(lengths[i + 1 : j]) <= near
    )
    return tuple(capsules), never


def _triple(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _angles(rotation: NDArray[np.float64]) -> Triple:
    """Return turns about the fixed x, then y, then z axis, rad."""
    from scipy.spatial.transform import Rotation

    # Where y is a quarter turn the other two are one: any split of it is right.
    sy = -rotation[2, 0]
    if abs(sy) > 1 - 1e-12:
        sign = 1.0 if sy > 0 else -1.0
        x = float(np.arctan2(sign * rotation[0, 1], sign * rotation[0, 2]))
        return x, sign * np.pi / 2, 0.0
    return _triple(Rotation.from_matrix(rotation).as_euler("xyz"))
