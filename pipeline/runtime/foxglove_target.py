"""Contacts for Foxglove: a WebSocket server with numbers to plot and a picture of the probe."""

import json
import logging
import math
import socket
import threading
from collections.abc import Sequence

import foxglove
import numpy as np
from foxglove.channels import LogChannel, SceneUpdateChannel
from foxglove.messages import (
    ArrowPrimitive,
    Color,
    Log,
    LogLevel,
    Point3,
    Pose,
    Quaternion,
    SceneEntity,
    SceneEntityDeletion,
    SceneUpdate,
    SpherePrimitive,
    Timestamp,
    TriangleListPrimitive,
    Vector3,
)
from foxglove.websocket import ChannelView, Client, ServerListener
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from scipy.special import chdtri

from contactbench.pipeline import kernel
from contactbench.pipeline.errors import RunError, arg
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.runtime.lines import CONTACT_SCHEMA, Answer, contact_schema, health_names
from contactbench.pipeline.runtime.outlet import FRESH_S, OutletTarget, OutputContext, resolve

CONTACT, WRENCH, SCENE, HEALTH = "/contact", "/wrench", "/scene", "/health"
"""Topics."""

_FRAME = "sensor"
_SCENE_S = 0.02  # a picture is not looked at more often
_BACKLOG = 512  # messages for one client, a quarter of a second at 1 kHz; then the oldest are dropped
_M_PER_N, _LONGEST_M = 0.005, 0.1  # length of an arrow
_SHAFT_M, _HEAD_M = 0.002, 0.006
_THINNEST_M = 1e-4
_SIGMAS_95 = math.sqrt(chdtri(3, 0.05))
_GREY = Color(r=0.7, g=0.7, b=0.72, a=0.6)
_RED = Color(r=0.85, g=0.2, b=0.15, a=1.0)
_BLUE = Color(r=0.1, g=0.4, b=0.85, a=0.5)


class FoxgloveTarget(OutletTarget):
    """
    A server of the Foxglove WebSocket protocol, for several clients.

    ``/contact``: every contact as JSON with its schema, as in an MCAP file. ``/wrench``: the compensated wrench.
    ``/scene``: the probe, the force as an arrow whose tip is the contact, and the ellipsoid that holds the contact with
    95 %; 50 times a second at most. ``/health``: a log line when reason or health change. Everything is in S.

    The SDK serves clients in threads of its own. For a slow one it drops the oldest messages, and does not say so.

    Parameters
    ----------
    address : str
        HOST:PORT to listen on.
    context : OutputContext

    Raises
    ------
    RunError
        It is no address, one that other machines reach without leave, or in use.
    """

    fresh = FRESH_S

    def __init__(self, address: str, context: OutputContext) -> None:
        place = resolve("--foxglove", address, socket.SOCK_STREAM, remote=context.remote, listens=True)
        self._about = context.about
        foxglove.set_log_level(logging.CRITICAL)  # a client that leaves is no news for a terminal
        topics = self._context = foxglove.Context()  # the server holds no reference of its own
        contact = foxglove.Schema(name=CONTACT_SCHEMA, encoding="jsonschema", data=contact_schema())
        self._contact = foxglove.Channel(CONTACT, schema=contact, message_encoding="json", context=topics)
        self._wrench = foxglove.Channel(WRENCH, schema=_WRENCH_SCHEMA, context=topics)
        self._scene = SceneUpdateChannel(SCENE, context=topics)
        self._health = LogChannel(HEALTH, context=topics)
        self._probe = SceneUpdate(entities=[_probe_entity(context.probe)])
        self._subscribed = _Subscribed()
        try:
            self._server = foxglove.start_server(
                name="contactbench",
                host=place.host,
                port=place.port,
                context=topics,
                server_listener=self._subscribed,
                message_backlog_size=_BACKLOG,
            )
        except (OSError, RuntimeError, ValueError) as error:
            raise RunError(
                f"--foxglove {arg(address)}: nobody can listen there ({arg(error)}): choose another port."
            ) from error
        self.port: int = self._server.port
        self.name = f"Foxglove ws://{place.host}:{self.port}"
        self._said: tuple[str, bool, int] | None = None
        self._shown, self._shown_at = False, -math.inf

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`."""
        self.flush()
        written = 0
        for answer in answers:
            try:
                stamp = self._about.log_time(answer.time)
            except ValueError:  # its time is no time
                continue
            self._publish(answer, stamp)
            written += 1
        return written

    def flush(self) -> None:
        """As `OutletTarget`: whoever has just subscribed gets the probe and the health."""
        if self._subscribed.news.is_set():
            self._subscribed.news.clear()
            self._scene.log(self._probe)
            self._said = None

    def close(self) -> None:
        """As `OutletTarget`."""
        self._server.stop()

    def _publish(self, answer: Answer, stamp: int) -> None:
        self._contact.log(answer.message(stamp), log_time=stamp)
        contact = answer.contact
        if contact is None:
            return
        if contact.wrench is not None and self._wrench.has_sinks():
            self._wrench.log(_wrench_message(contact.wrench, stamp), log_time=stamp)
        if self._scene.has_sinks():
            self._show(contact, answer.time, stamp)
        says = answer.reason, contact.accepted, answer.health
        if says != self._said:
            self._said = says
            self._health.log(_log_line(*says, stamp), log_time=stamp)

    def _show(self, contact: kernel.RuntimeContact, time: float, stamp: int) -> None:
        entity = _contact_entity(contact, stamp)
        if entity is None and self._shown:
            self._scene.log(SceneUpdate(deletions=[SceneEntityDeletion(id="contact")]), log_time=stamp)
        elif entity is not None and not 0 <= time - self._shown_at < _SCENE_S:
            self._shown_at = time
            self._scene.log(SceneUpdate(entities=[entity]), log_time=stamp)
        elif entity is not None:
            return
        self._shown = entity is not None


class _Subscribed(ServerListener):
    """Notes, in the SDK's thread, that somebody has subscribed."""

    def __init__(self) -> None:
        self.news = threading.Event()

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:  # noqa: ARG002
        self.news.set()


# ---- messages ----------------------------------------------------------------------------------

_XYZ = {"type": "object", "properties": {axis: {"type": "number"} for axis in "xyz"}}
_WHOLE = {"type": "integer"}
_WRENCH_SCHEMA = {
    "title": "contactbench.Wrench",
    "type": "object",
    "properties": {
        "timestamp": {"type": "object", "properties": {"sec": _WHOLE, "nsec": _WHOLE}},
        "frame_id": {"type": "string"},
        "force": {**_XYZ, "description": "Of the tissue on the probe, compensated and filtered, N."},
        "torque": {**_XYZ, "description": "The same, about the sensor's origin, N·m."},
    },
}


def _stamp(nanoseconds: int) -> Timestamp:
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return Timestamp(sec=seconds, nsec=rest)


def _wrench_message(wrench: NDArray[np.float64], stamp: int) -> bytes:
    seconds, rest = divmod(stamp, 1_000_000_000)
    force, torque = (dict(zip("xyz", part.tolist(), strict=True)) for part in (wrench[:3], wrench[3:]))
    content = {
        "timestamp": {"sec": seconds, "nsec": rest},
        "frame_id": _FRAME,
        "force": force,
        "torque": torque,
    }
    return json.dumps(content).encode("ascii")


def _log_line(reason: str, accepted: bool, health: int, stamp: int) -> Log:
    names = health_names(health)
    level = LogLevel.Error if names else LogLevel.Info
    words = f"{reason}: {'accepted' if accepted else 'not accepted'}"
    text = f"{words}; unhealthy: {', '.join(names)}" if names else words
    return Log(timestamp=_stamp(stamp), level=level, message=text, name="contactbench")


def _probe_entity(probe: Probe) -> SceneEntity:
    points = [Point3(x=x, y=y, z=z) for x, y, z in probe.vertices.tolist()]
    surface = TriangleListPrimitive(
        pose=_pose(np.zeros(3), np.eye(3)), points=points, indices=probe.faces.ravel().tolist(), color=_GREY
    )
    return SceneEntity(frame_id=_FRAME, id="probe", frame_locked=True, triangles=[surface])


def _contact_entity(contact: kernel.RuntimeContact, stamp: int) -> SceneEntity | None:
    """Return the arrow and the ellipsoid of an accepted contact."""
    point, wrench, covariance = contact.point, contact.wrench, contact.covariance
    if not contact.accepted or point is None or wrench is None or covariance is None:
        return None
    force = wrench[:3]
    size = float(np.linalg.norm(force))
    if not size > 0 or not np.isfinite(covariance).all():
        return None
    length = min(size * _M_PER_N, _LONGEST_M)
    turn, _ = Rotation.align_vectors([force / size], [[1.0, 0.0, 0.0]])  # an arrow points along its x axis
    head = min(_HEAD_M, length / 2)
    arrow = ArrowPrimitive(
        pose=_pose(point - force / size * length, turn.as_matrix()),
        shaft_length=length - head,
        shaft_diameter=_SHAFT_M,
        head_length=head,
        head_diameter=2 * _SHAFT_M,
        color=_RED,
    )
    variances, axes = np.linalg.eigh(covariance)
    axes[:, 0] *= np.sign(np.linalg.det(axes))
    sizes = np.maximum(2 * _SIGMAS_95 * np.sqrt(np.maximum(variances, 0.0)), _THINNEST_M)
    x, y, z = sizes.tolist()
    ellipsoid = SpherePrimitive(pose=_pose(point, axes), size=Vector3(x=x, y=y, z=z), color=_BLUE)
    return SceneEntity(
        timestamp=_stamp(stamp), frame_id=_FRAME, id="contact", frame_locked=True,
        arrows=[arrow], spheres=[ellipsoid],
    )  # fmt: skip


def _pose(p: NDArray[np.float64], R: NDArray[np.float64]) -> Pose:
    x, y, z, w = Rotation.from_matrix(R).as_quat().tolist()
    px, py, pz = p.tolist()
    return Pose(position=Vector3(x=px, y=py, z=pz), orientation=Quaternion(x=x, y=y, z=z, w=w))
