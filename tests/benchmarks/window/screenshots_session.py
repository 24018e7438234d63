"""A session for pictures: everything done on a virtual bench whose clock goes by steps, the same each time."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from contactbench.app.pages.virtual_mesh import bench_address, take_housing
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT
from contactbench.pipeline.workbench import gravity_fit
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.gravity import GravityWork
from contactbench.pipeline.workbench.gravity_fit import gravity_settings
from contactbench.pipeline.workbench.live import Live
from contactbench.pipeline.workbench.markers import keep, spread
from contactbench.pipeline.workbench.probe import ProbePlan, ProbeWork, commit
from contactbench.pipeline.workbench.regions_session import apply, open_work
from contactbench.pipeline.workbench.regions_session import keep as keep_regions
from contactbench.pipeline.workbench.tape import SessionTape
from contactbench.pipeline.workbench.verify import (
    KnownChecks,
    PressReading,
    StillReading,
    VerifyWork,
    tool_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from contactbench.pipeline.workbench.verify_touches import LiveTouches

STEPWISE = "virtual://bench?probe=t-shape&sensor=paper&speed=step"
_STEPS_A_SECOND = 250
_FACETS, _MARKERS, _FORCE = 2_000, 12, 9.0
_PATIENCE_S, _MOST = 120.0, 40
_HUNG_S = 60.0  # the known weight


def make_session(folder: Path, say: Callable[[str], None] = lambda _: None) -> None:
    """Make a session that is calibrated, has a probe with a region, and is verified; takes about half a minute."""
    session = Session.create(folder, by="technician")
    for key, value in (
        ("devices.sensor", STEPWISE),
        ("devices.poses", STEPWISE),
        ("devices.serial", "VB-0001"),
    ):
        session.set_parameter(key, value)
    desk, live = Desk(session), Live()
    try:
        live.open(STEPWISE, STEPWISE)
        go_on(live, 1.0)
        for title, work in (
            ("gravity", _weigh),
            ("probe", _prepare),
            ("region", _paint),
            ("known weight and known point", _check),
            ("touches", _verify),
        ):
            say(title)
            work(desk, live)
    finally:
        live.close()
        desk.close()


def go_on(live: Live, seconds: float) -> None:
    """Let the bench's clock go."""
    if live.pair is not None:
        live.pair.step(round(seconds * _STEPS_A_SECOND))


def turn(live: Live, R_WS: np.ndarray, seconds: float = 3.0) -> None:
    """Turn the virtual wrist, and keep it still."""
    if live.pair is not None and live.pair.bench is not None:
        live.pair.bench.turn_to(R_WS)
        go_on(live, seconds)


def press(live: Live, point: np.ndarray, held: float = 0.7, after: float = 0.3) -> None:
    """Press a point, S, m, and go on."""
    if live.pair is not None and live.pair.bench is not None:
        live.pair.bench.touch(point_S=point, force=_FORCE, seconds=held)
        go_on(live, held + after)


def touch_all(live: Live, touches: LiveTouches, most: int = _MOST) -> None:
    """Press the markers that are wanted, one after the other."""
    for _ in range(most):
        view = touches.view()
        if view.next_one is None:
            return
        press(live, touches.markers[view.next_one].point_S)


def _weigh(desk: Desk, live: Live) -> None:
    work = GravityWork(gravity_settings(desk.state), live_R_ES=live.R_ES)
    tape = SessionTape.start(desk, live, gravity_fit.next_name(desk.state, desk.folder)).result()
    end = live.follow(work.feed)
    try:
        for _ in range(_MOST):
            view = _solved(work)
            if view.solved.enough:
                break
            if view.solved.proposal is not None:
                turn(live, view.solved.proposal.R_WS)
            else:
                go_on(live, 1.0)
    finally:
        end()
        tape.keep().result()
        work.finish()
        work.wait()
        work.close()
    left = work.left_out
    desk.do(lambda session: gravity_fit.finish(session, tape.name, left, None)).result()


def _solved(work: GravityWork):  # type: ignore[no-untyped-def]
    until = time.monotonic() + _PATIENCE_S
    while (view := work.view()).busy:
        if time.monotonic() > until:
            raise InputError("The calibration of the pictures' session took too long: try again.")
        time.sleep(0.01)
    return view


def _prepare(desk: Desk, _live: Live) -> None:
    address = bench_address(desk.state)
    assert address is not None
    work = ProbeWork(desk)
    try:
        housing = take_housing(work, address)
        plan = ProbePlan(
            units=housing.units,
            close=housing.close,
            alpha=housing.alpha_mm,
            alignment=housing.alignment,
            facets=_FACETS,
        )
        preview = work.preview(housing.mesh, plan)
        desk.do(lambda session: commit(session, preview)).result()
    finally:
        work.close()


def _paint(desk: Desk, _live: Live) -> None:
    """Make the head's face a region."""
    regions = open_work(desk)
    probe = regions.probe
    centres = probe.vertices[probe.faces].mean(axis=1)
    face = np.flatnonzero((centres[:, 2] > centres[:, 2].max() - 0.01) & (probe.normals[:, 2] > 0.5))
    regions.step(lambda model: model.add("Face"))
    regions.step(lambda model: model.assign(face, 1))
    snapshot, shell = regions.model.snapshot(), regions.shell
    desk.do(lambda session: keep_regions(session, snapshot, shell)).result()
    desk.do(apply(desk)).result()


def _check(desk: Desk, live: Live) -> None:
    """Hang a kilogram on the tool, and press the marker that is farthest off the axis."""
    work, bench = KnownChecks(desk, live), live.pair.bench if live.pair is not None else None
    reading = live.reading()
    assert bench is not None
    assert reading is not None
    unloaded = _read(work, live, StillReading())
    bench.bump((reading.R_WS.T @ [0.0, 0.0, -STANDARD_GRAVITY]).tolist(), _HUNG_S)
    go_on(live, 1.0)
    loaded = _read(work, live, StillReading())
    bench.bump([0.0, 0.0, 0.0], 0.01)
    go_on(live, 1.0)
    given = {"mass": 1.0, "mass_sigma": 0.0005, "certificate": "DKD-K-1234"}
    work.compute(WEIGHT, {"unloaded": unloaded, "loaded": loaded}, given)
    tool = tool_of(desk.folder, desk.state)
    points = spread(tool.probe, _MARKERS).as_set().points
    point = points[int(np.argmax(np.hypot(points[:, 0], points[:, 1])))]
    bench.touch(point_S=point, force=_FORCE, seconds=1.3)
    touch = _read(work, live, PressReading(tool.model))
    work.compute(TOUCH, {"touch": touch}, {"point": (1e3 * point).tolist()})


def _read(work: KnownChecks, live: Live, reading: StillReading | PressReading) -> str:
    work.start(reading)
    for _ in range(_MOST):
        if reading.done:
            return work.keep()
        go_on(live, 0.5)
    raise InputError(f"The reading did not end: {reading.sentence}")


def _verify(desk: Desk, live: Live) -> None:
    tool = tool_of(desk.folder, desk.state)
    markers = spread(tool.probe, _MARKERS)
    desk.do(lambda session: keep(session, markers)).result()
    work = VerifyWork(desk, live)
    work.start(tool, markers)
    if work.touches is not None:
        touch_all(live, work.touches)
    work.finish()
