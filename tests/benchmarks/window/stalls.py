"""How long the window stands still while all that it does at a bench happens at once."""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.live.trial import sensor_process
from benchmarks.window.balls import ball
from benchmarks.window.driver import load as machine_load
from benchmarks.window.driver import loaded, opened, own_home, rest, shown_window, until
from PySide6.QtCore import QObject, QTimer

from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.steps import Step
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.workbench.live import Ring
from contactbench.widgets.scene.views import turned

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from contactbench.app.bench import Bench
    from contactbench.app.pages.probe import ProbePage
    from contactbench.app.window import MainWindow
    from contactbench.pipeline.devices.sample import WrenchSample

_RATE_HZ = 1000.0
_STREAMS = 3
_TURN_MS = 33  # as the mouse gives it
_STILL_SHARE = 0.25  # of the time nobody turns: the fine picture is drawn then
_ROUND_S = 2.0
_LONGEST_MS = 100.0
_KEPT = 120_000


def run(
    seconds: float = 60.0, facets: int = 100_000, *, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """
    Measure the event loop of the real window in its worst hour.

    Three emulated SRI sensors stream at 1 kHz, one of them into charts and pages, while on the Probe page a mesh is
    given an outer surface, measured and simplified again and again, and somebody turns the scene.
    """
    before = machine_load()
    figures: tuple[Figure, ...] = ()
    with own_home() as home, ExitStack() as stack:
        mesh = _mesh_file(home, facets)
        progress("starting three sensors")
        urls = [
            stack.enter_context(sensor_process(home / f"sent-{number}.bin", _RATE_HZ))
            for number in range(_STREAMS)
        ]
        window = stack.enter_context(shown_window())
        rest(1.0)
        window.heartbeat.restart()
        bench = opened(window, lambda: window.sessions.new(home / "session"))
        until(lambda: window.pages.made, "the pages to be made")
        figures += _opening(window)
        sinks = [Sink() for _ in urls[1:]]
        for url, sink in zip(urls[1:], sinks, strict=True):
            stack.enter_context(SensorStream(url, sink, lambda _health: None))
        bench.jobs.start("open", lambda _p, _c: bench.live.open(urls[0], "still://?rpy=0,0,0"))
        until(lambda: bench.live.ring.count > 0 and all(sink.count for sink in sinks), "samples to come")
        window.show_step(Step.PROBE)
        probe = _probe_page(window)
        rest(1.0)
        quiet = _measured(window, min(5.0, seconds / 4), "at rest, three streams at 1 kHz", bench, sinks)
        progress(f"simplifying {facets} facets and turning the scene for {seconds:g} s")
        loop = Simplifying(probe, mesh)
        turner = Turning(window)
        busy = _measured(window, seconds, "simplifying, turning, three streams", bench, sinks)
        turner.stop()
        loop.stop()
        rounds = loop.rounds
    figures += (*quiet, *busy, Figure("simplifying, turning, three streams", "meshes begun", rounds, least=1))
    settings = {"seconds": seconds, "facets": facets, "streams": _STREAMS, "rate": f"{_RATE_HZ:g} Hz"}
    return StudyReport("The window standing still", settings, figures, (loaded(before),))


class Sink:
    """Keeps samples as the application does, in memory that never grows."""

    def __init__(self) -> None:
        self._ring = Ring(_KEPT)

    @property
    def count(self) -> int:
        """Samples that came."""
        return self._ring.count

    def __call__(self, samples: Sequence[WrenchSample]) -> None:
        """Take samples."""
        times = np.array([sample.time for sample in samples])
        wrenches = np.array([(*sample.force, *sample.torque) for sample in samples])
        self._ring.add(times, wrenches, wrenches, np.tile(np.eye(3), (len(samples), 1, 1)))


class Simplifying(QObject):
    """Has the Probe page make the surface of a mesh, measure and simplify it, again as soon as it is done."""

    def __init__(self, page: ProbePage, mesh: Path) -> None:
        super().__init__(page)
        self._page, self._mesh, self.rounds = page, mesh, 0
        self._timer = QTimer(self, interval=50)
        self._timer.timeout.connect(self._go_on)
        self._timer.start()

    def stop(self) -> None:
        """Let it be."""
        self._timer.stop()
        self._page.stages.worker.stop()

    def _go_on(self) -> None:
        stages = self._page.stages
        if stages.worker.busy:
            return
        if stages.mesh is None or stages.preview is not None:
            self.rounds += 1
            stages.take(self._mesh)
        elif stages.asked:
            stages.say_unit("mm")
        elif not stages.in_sensor_frame:
            stages.put(from_angles([0.0, 0.0, 80.0], [0.0, 0.0, 0.0]))


class Turning(QObject):
    """Turns the scene as a hand does: for a while, then not for a moment."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window, self._began = window, time.monotonic()
        self._timer = QTimer(self, interval=_TURN_MS)
        self._timer.timeout.connect(self._turn)
        self._timer.start()

    def stop(self) -> None:
        """Let go."""
        self._timer.stop()

    def _turn(self) -> None:
        scene = self._window.scene
        share = ((time.monotonic() - self._began) / _ROUND_S) % 1.0
        if scene is not None and share > _STILL_SHARE:
            scene.move_camera(turned(scene.projection().look, 0.05, 0.01))


def _opening(window: MainWindow) -> tuple[Figure, ...]:
    """Return how long the window stood still while a session was opened and its pages were made."""
    stalls, subject = window.heartbeat.stalls(), "opening a session, making its pages"
    return (
        Figure(subject, "longest stall", 1e3 * stalls.longest, "ms", most=_LONGEST_MS),
        Figure(subject, "longest work of the window itself between two beats", 1e3 * stalls.worked, "ms"),
    )


def _measured(
    window: MainWindow, seconds: float, subject: str, bench: Bench, sinks: Sequence[Sink]
) -> tuple[Figure, ...]:
    counts = [bench.live.ring.count, *(sink.count for sink in sinks)]
    frames: list[float] = []
    assert window.scene is not None
    window.scene.drawn.connect(frames.append)
    window.heartbeat.restart()
    began = time.monotonic()
    rest(seconds)
    took = time.monotonic() - began
    window.scene.drawn.disconnect(frames.append)
    stalls = window.heartbeat.stalls()
    now = [bench.live.ring.count, *(sink.count for sink in sinks)]
    came = min(after - before for after, before in zip(now, counts, strict=True))
    return (
        Figure(subject, "longest stall", 1e3 * stalls.longest, "ms", most=_LONGEST_MS),
        Figure(subject, "99 of 100 beats at most late by", 1e3 * stalls.p99, "ms"),
        Figure(subject, "longest work of the window itself between two beats", 1e3 * stalls.worked, "ms"),
        Figure(subject, "longest frame, from its beginning to the screen", max(frames, default=0.0), "ms"),
        Figure(subject, "samples a second, slowest stream", came / took, "Hz", least=0.98 * _RATE_HZ),
        Figure(subject, "frames of the scene a second", len(frames) / took, "Hz"),
    )


def _probe_page(window: MainWindow) -> ProbePage:
    from contactbench.app.pages.probe import ProbePage

    page = window.pages.current
    assert isinstance(page, ProbePage)
    return page


def _mesh_file(home: Path, facets: int) -> Path:
    """Write a ball in millimetres, as another program would."""
    probe = ball(facets)
    file = home / "ball.obj"
    with file.open("wb") as stream:
        np.savetxt(stream, 1e3 * probe.vertices, "v %.9g %.9g %.9g")
        np.savetxt(stream, probe.faces + 1, "f %d %d %d")
    return file
