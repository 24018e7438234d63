"""
A bench that is not there, on a clock of its own: the same seed and the same commands give the same bytes.

The scene, the sensor's faults and the commands are stepped together. A sample of time t is what is there when the
step at t begins, after the commands that took effect then.
"""

import threading
from collections import deque
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.reality import Reality
from contactbench.pipeline.simulation.reality import LateLine, RealProbe, WrenchDisturbance, chance
from contactbench.pipeline.simulation.scenes.indenter import BenchScene
from contactbench.pipeline.simulation.scenes.physics import Payload, SceneMoment, TrueSurface
from contactbench.pipeline.simulation.sensor_model import SensorModel, SensorSettings, preset
from contactbench.pipeline.simulation.virtual.commands import (
    Batch,
    Bump,
    Command,
    CommandError,
    Done,
    End,
    Release,
    ScriptError,
    SecretRezero,
    Slip,
    Timed,
    TouchCommand,
    TurnTo,
    Warm,
)
from contactbench.pipeline.simulation.virtual.markers import COUNTS, markers, markers_on

RATE, POSE_RATE = 200.0, 50.0
FASTEST = 1000.0
_FACETS = 20_000


class VirtualBench:
    """
    A probe on a wrist, read by a sensor.

    Commands may come from any thread; `advance` is for one at a time.

    Parameters
    ----------
    probe : Probe or str
        As it really is, or the name of a bundled one.
    sensor : SensorSettings or str
        Or the name of a preset.
    seed : int
        Of the sensor's noise.
    rate, pose_rate : float
        Wrenches and poses a second, up to 1000 Hz; each is taken at the nearest step of 0.5 ms.
    R_SE : (3, 3), optional
        How the sensor is mounted: turns components in the flange E into S. Both have the same origin.
    script : sequence of Timed
        Commands to do by themselves.
    reality : Reality, optional
        What it adds to the ideal bench; the probe is then what the program is told of, not what is there.

    Raises
    ------
    InputError
        A name, a rate or the mounting is wrong, or MuJoCo is missing.
    """

    def __init__(
        self,
        probe: Probe | str = "t-shape",
        sensor: SensorSettings | str = "paper",
        *,
        seed: int = 0,
        rate: float = RATE,
        pose_rate: float = POSE_RATE,
        payload: Payload | None = None,
        R_SE: ArrayLike | None = None,
        script: Sequence[Timed] = (),
        reality: Reality | None = None,
    ) -> None:
        for what, value in (("rate", rate), (message("pose rate"), pose_rate)):
            if not 0 < value <= FASTEST:
                raise InputError(
                    f"virtual bench: {arg(what)} {arg(value):g} Hz: give one above 0, up to {arg(FASTEST):g}."
                )
        if seed < 0:
            raise InputError(f"virtual bench: seed {arg(seed)}: give a whole number of 0 or more.")
        settings = preset(sensor) if isinstance(sensor, str) else sensor
        truth = bundled(probe) if isinstance(probe, str) else TrueSurface(probe)
        self.probe = truth.probe
        self.markers = markers(probe) if isinstance(probe, str) else markers_on(probe)
        self.rate, self.pose_rate = rate, pose_rate
        self.R_SE = _mounting(R_SE)
        self.reality, payload = reality or Reality(), payload or Payload()
        self.real = RealProbe.of(truth, self.markers, self.reality, seed)
        self._disturbance = (
            WrenchDisturbance(self.reality, self.real, seed, payload) if self.reality.on else None
        )
        if self.reality.on:
            settings = settings.with_(self.reality, chance(seed, "crosstalk"))
        self.sensor = SensorModel(settings.at(rate), seed)
        if self.reality.warming:
            self.sensor.warm(self.reality.warming, 0.0)
        self.scene = BenchScene(self.real.truth, payload=payload)
        self._line: LateLine[tuple[WrenchSample, SceneMoment]] | None = None
        if self.reality.latency or self.reality.jitter:
            late, jitter = self.reality.latency / 1e3, self.reality.jitter / 1e3
            self._line = LateLine(late, jitter, chance(seed, "jitter"))
        # (time, R_WS) of the last steps, where poses are old when they are told
        self._turned: deque[tuple[float, Floats]] = deque()
        self.log: list[Done] = []
        self._script = deque(script)
        self._queue: deque[tuple[Command, Future[Done]]] = deque()
        self._lock = threading.Lock()
        self._step = self._wrenches = self._poses = 0
        self._turning, self._leaving = 0.0, np.inf
        self._last_end = self._bumped = self._gone = 0.0
        self._slips = SlipWatch()
        self._ended = self._closed = False
        self._prepare()

    @property
    def time(self) -> float:
        """Of the bench's clock, s since it was switched on."""
        return self._step * self.scene.step_s

    @property
    def ended(self) -> bool:
        """Whether a command ended the run: nothing more comes."""
        return self._ended

    @property
    def scripted(self) -> bool:
        """Whether commands of the script are still to come."""
        return bool(self._script)

    @property
    def pending(self) -> tuple[Timed, ...]:
        """The commands of the script that are still to come."""
        return tuple(self._script)

    @property
    def idle_from(self) -> float:
        """When all commands that took effect are over, s."""
        return max(self._last_end, self._turning, self._bumped, self._gone)

    @property
    def slips(self) -> tuple[Slip, ...]:
        """Touches that were found to press nothing."""
        return tuple(self._slips.slips)

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong now, in sentences."""
        return self._slips.findings()

    # ---- commands ------------------------------------------------------------------------------

    def send(self, command: Command) -> Future[Done]:
        """
        Queue a command for the next step.

        Returns
        -------
        Future of Done
            Set once it took effect; its exception is a CommandError where the bench could not do it.
        """
        answer: Future[Done] = Future()
        self._queue.append((command, answer))
        if self._closed:
            self.close()
        return answer

    def close(self) -> None:
        """Refuse every command that waits, and all that come: the clock does not go on."""
        self._closed = True
        while self._queue:
            command, answer = self._queue.popleft()
            answer.set_exception(CommandError(f"{arg(command.name)}: the bench is closed: open it again."))

    def turn_to(
        self, R_WS: ArrayLike | None = None, *, rpy: ArrayLike | None = None, seconds: float | None = None
    ) -> Future[Done]:
        """Queue a turn of the wrist; see `TurnTo`."""
        rows = None if R_WS is None else tuple(tuple(row) for row in np.asarray(R_WS, float).tolist())
        angles = None if rpy is None else tuple(np.asarray(rpy, float).tolist())
        return self.send(TurnTo(angles, rows, seconds))  # type: ignore[arg-type]  # it checks the shapes

    def touch(
        self, marker: int | None = None, *, point_S: ArrayLike | None = None, **how: float | None
    ) -> Future[Done]:
        """Queue a touch of a marker (from 1) or a point, m; `how` is as in `TouchCommand`."""
        place = None if point_S is None else tuple(np.asarray(point_S, float).tolist())
        return self.send(TouchCommand(marker, place, **how))  # type: ignore[arg-type]

    def release(self) -> Future[Done]:
        """Queue the end of a touch."""
        return self.send(Release())

    def bump(self, force: ArrayLike, seconds: float = 0.2) -> Future[Done]:
        """Queue a push of the tool, N in S."""
        return self.send(Bump(tuple(np.asarray(force, float).tolist()), seconds))

    def warm(self, kelvin: float) -> Future[Done]:
        """Queue a change of what the sensor stands on."""
        return self.send(Warm(kelvin))

    def rezero(self) -> Future[Done]:
        """Queue a re-zero of the sensor, of which only `log` tells."""
        return self.send(SecretRezero())

    # ---- time ----------------------------------------------------------------------------------

    def advance(self, seconds: float) -> Batch:
        """
        Go on by this time, to the nearest step, and return what came.

        Raises
        ------
        ScriptError
            A command of the script cannot be done.
        """
        return self._go(self._step + max(0, round(seconds / self.scene.step_s)), np.inf)

    def advance_samples(self, count: int) -> Batch:
        """Go on until so many wrenches and poses came, or the run ended; errors as `advance`."""
        return self._go(np.inf, count)

    def _go(self, last: float, count: float) -> Batch:
        wrenches: list[WrenchSample] = []
        flanges: list[FlangeSample] = []
        truths: list[SceneMoment] = []
        with self._lock:
            known, slips = len(self.log), len(self._slips.slips)
            while self._step < last and not self._ended and len(wrenches) + len(flanges) < count:
                self._obey()
                if self.ended:
                    break
                self._sample(wrenches, flanges, truths)
                self.scene.step()
                self._step += 1
                self._slips.look(self.time, self.scene.data.ncon > 0)
            done, slipped = tuple(self.log[known:]), self.slips[slips:]
            return Batch(tuple(wrenches), tuple(flanges), tuple(truths), done, slipped)

    def _sample(
        self, wrenches: list[WrenchSample], flanges: list[FlangeSample], truths: list[SceneMoment]
    ) -> None:
        self._carried(wrenches, truths)
        if self.reality.pose_latency:
            self._turned.append((self.time, self.scene.data.site("S").xmat.reshape(3, 3).copy()))
        wrench = self._step >= round(self._wrenches / (self.rate * self.scene.step_s))
        pose = self._step >= round(self._poses / (self.pose_rate * self.scene.step_s))
        if not (wrench or pose):
            return
        # The step counts exactly; the scene's own clock adds up rounding.
        truth = replace(self.scene.moment(), time=self.time)
        if wrench:
            truth = truth if self._disturbance is None else self._disturbance.of(truth)
            sample = self._read(truth)
            if self._line is None:
                wrenches.append(sample)
                truths.append(truth)
            else:
                arrival = self._line.arrival(self.time)
                self._line.send(arrival, (replace(sample, arrival=arrival), truth))
            self._wrenches += 1
        if pose:
            flanges.append(FlangeSample(self.time, self._told(truth.R_WS) @ self.R_SE, self._place.copy()))
            self._poses += 1

    def _carried(self, wrenches: list[WrenchSample], truths: list[SceneMoment]) -> None:
        """Give what has arrived by now; what is under way at the end of the run is lost."""
        for sample, truth in [] if self._line is None else self._line.due(self.time):
            wrenches.append(sample)
            truths.append(truth)

    def _told(self, R_WS: Floats) -> Floats:
        """Return the orientation that is told now: where poses are late, that of a while ago."""
        oldest = self.time - self.reality.pose_latency / 1e3
        while len(self._turned) > 1 and self._turned[1][0] <= oldest + 1e-9:
            self._turned.popleft()
        return self._turned[0][1] if self._turned else R_WS

    def _read(self, truth: SceneMoment) -> WrenchSample:
        # One at a time: how many are read together must not change a bit of them.
        given = self.sensor.read(truth.time, truth.reading)
        fx, fy, fz, mx, my, mz = given.wrenches[0].tolist()
        status = Status.OVERRANGE if given.saturated[0] else Status.OK
        temperature = float(given.temperatures[0])
        force, torque = (fx, fy, fz), (mx, my, mz)
        return WrenchSample(truth.time, force, torque, self._wrenches, status, truth.time, temperature)

    # ---- what commands do ----------------------------------------------------------------------

    def _obey(self) -> None:
        now = self.time
        if now >= self._leaving - 1e-9:
            self._leave()
        while self._queue:
            command, answer = self._queue.popleft()
            try:
                done = self._do(command)
            except InputError as error:
                answer.set_exception(error)
            except BaseException as error:
                # Whoever waits for the answer must not wait for ever.
                answer.set_exception(CommandError(f"{arg(command.name)}: the bench failed: {arg(error)!r}."))
                raise
            else:
                answer.set_result(done)
        while self._script and not self._ended and now >= self._when(self._script[0]) - 1e-9:
            timed = self._script.popleft()
            try:
                self._do(timed.command)
            except InputError as error:
                raise ScriptError(f"{arg(timed.where)}: {arg(error)}") from error

    def _when(self, timed: Timed) -> float:
        return timed.at if timed.at is not None else self._last_end + (timed.after or 0.0)

    def _do(self, command: Command) -> Done:
        if self._ended:
            raise CommandError(f"{arg(command.name)}: the run has ended.")
        done = Done(self.time, command, self._act(command))
        self._last_end = max(done.until, done.time)
        self.log.append(done)
        if isinstance(command, TouchCommand) and command.force > 0:
            self._slips.begin(done)
        return done

    def _act(self, command: Command) -> float:
        """Do it, and return when it is over."""
        now = self.time
        if isinstance(command, TurnTo):
            self._turning = float(now + self.scene.turn_to(command.rotation, command.seconds))
            return self._turning
        if isinstance(command, TouchCommand):
            return self._touch(command)
        if isinstance(command, Release):
            self._leave()
        elif isinstance(command, Bump):
            self.scene.bump(command.force, command.seconds, command.lever)
            self._bumped = now + command.seconds
            return self._bumped
        elif isinstance(command, Warm):
            self.sensor.warm(command.kelvin, now)
        elif isinstance(command, SecretRezero):
            now_there = replace(self.scene.moment(), time=now)
            self.sensor.rezero(
                (now_there if self._disturbance is None else self._disturbance.of(now_there)).reading, now
            )
        elif isinstance(command, End):
            self._ended = True
        return now

    def _touch(self, command: TouchCommand) -> float:
        now = self.time
        if now < self._turning - 1e-9:
            raise CommandError(f"touch: the wrist turns until {arg(self._turning):.3f} s: touch after that.")
        if command.marker is None:
            place = np.array(command.point_S)
        elif 1 <= command.marker <= len(self.markers):
            place = self.real.targets[command.marker - 1]
        else:
            raise CommandError(
                f"touch: there is no marker {arg(command.marker)}: choose 1 to {arg(len(self.markers))}."
            )
        self.scene.aim(self.real.aimed(place, command.press))
        self.scene.press(command.press)
        self._slips.end()
        self._leaving = np.inf if command.seconds is None else now + command.seconds
        self._gone = now if command.seconds is None else self._leaving
        return now if command.seconds is None else self._leaving

    def _leave(self) -> None:
        if self.scene.aimed_S is not None:
            self.scene.release()
            self._gone = self.time
        self._slips.end()
        self._leaving = np.inf

    def _prepare(self) -> None:
        # The first touch prepares the whole surface: half a second that would be missing on the clock later.
        self.scene.aim(self.markers[0])
        self._leave()
        self._place: Floats = self.scene.data.site("S").xpos.copy()


@cache
def bundled(name: str) -> TrueSurface:
    """
    Return the true surface of a bundled probe, in facets of about a millimetre.

    Raises
    ------
    InputError
        There is no such probe.
    """
    if name not in COUNTS:
        raise InputError(f"there is no probe {arg(name)!r}: choose one of {arg(', '.join(COUNTS))}.")
    vertices, faces = assets.make(name, _FACETS)
    plain = Probe.from_arrays(vertices, faces, name=name)
    return TrueSurface(plain.with_region(assets.contact_region(name, vertices, faces)))


def _mounting(R_SE: ArrayLike | None) -> Floats:
    R = np.eye(3) if R_SE is None else np.array(R_SE, dtype=np.float64)
    if R.shape != (3, 3) or not np.allclose(R @ R.T, np.eye(3), atol=1e-6) or np.linalg.det(R) < 0:
        raise InputError(
            "virtual bench: the mounting R_SE is not a rotation: give three rows of three numbers."
        )
    return np.asarray(Rotation.from_matrix(R).as_matrix())


# ---- watches whether a tip that was told to press does -------------------------------------------


SLIPPED_S = 0.5
_SENTENCE = message(
    "The tip slid off the probe and presses nothing. Release it, and touch elsewhere or with less tilt."
)


class SlipWatch:
    """
    Finds touches that press nothing.

    Attributes
    ----------
    slips : list of Slip
        Found so far, each once as long as it lasts.
    """

    def __init__(self) -> None:
        self.slips: list[Slip] = []
        self._touch: Done | None = None
        self._pressed_at, self._slipped = 0.0, False

    def begin(self, touch: Done) -> None:
        """Watch a touch from now on."""
        self._touch, self._pressed_at, self._slipped = touch, touch.time, False

    def end(self) -> None:
        """Watch nothing: the tip is away."""
        self._touch, self._slipped = None, False

    def look(self, time: float, pressing: bool) -> None:
        """See how it is at a time of the bench's clock, s."""
        if self._touch is None:
            return
        if pressing:
            self._pressed_at, self._slipped = time, False
        elif not self._slipped and time > self._pressed_at + SLIPPED_S - 1e-9:
            self._slipped = True
            self.slips.append(Slip(time, self._touch))

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong now, in sentences."""
        return (_SENTENCE,) if self._slipped else ()
