"""``contactbench run``: a runtime config on live streams."""

from __future__ import annotations

import inspect
import math
import queue
import time
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import PatchOption
from contactbench.pipeline.commands.record import Changes, broken, check_seconds
from contactbench.pipeline.console import (
    Ended,
    Noun,
    answer,
    as_json,
    ended_by_signals,
    output_is_data,
    report_error,
    say,
    say_all,
)
from contactbench.pipeline.runtime.outputs import OUTPUTS, open_outputs

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.contact.patch import PatchReader
    from contactbench.pipeline.devices.sample import WrenchSample
    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.kernel import RuntimeContact
    from contactbench.pipeline.runtime import Answer, Run
    from contactbench.pipeline.streams import Pair

run_app = Noun()

_OUTPUT_OPTIONS = [
    inspect.Parameter(
        each.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=None,
        annotation=Annotated[str | None, typer.Option(metavar=each.metavar, help=each.help)],
    )
    for each in OUTPUTS.values()
]

_LOOK_S = 0.05
_STEPS = 500  # samples between looks at Ctrl-C
_SETTLED_S = 2.0  # a rate is known after that
_PATCH_S = 1.0  # a line about the patch in so long


@run_app.command(
    example=(
        "run runtime.zip --source sri+serial:///dev/ttyUSB0 --pose elfin+tcp://10.0.0.2 --udp 127.0.0.1:9000"
    )
)
def run(
    bundle: Path,
    /,
    source: str,
    pose: str,
    patch: PatchOption = None,
    seconds: float | None = None,
    unverified: bool = False,
    other_sensor: bool = False,
    allow_remote: bool = False,
    **addresses: Annotated[str | None, _OUTPUT_OPTIONS],
) -> None:
    """Run a bundle on live streams, and locate the contact at every sample.

    It ends with Ctrl-C, after --seconds, or at the end of a replay.

    Contacts are lines of JSON, on standard output unless another output is given; act only on
    those whose accepted is true. A sample uses the orientation at its own time, interpolated between two
    poses or extrapolated from the last one as far as the bundle allows; without one its reason is stale. A
    typed pose (still://) never becomes stale. Each contact contains its age (latency_s) and the state of
    sensor and poses (health); while no samples arrive, ten lines per second report silent. While nothing
    touches the probe, the sensor's zero is watched; each contact reports it (zero): confirmed,
    with its age; off, which is an alarm; doubtful, if something may touch the probe; or unknown. If the bundle
    says so (zero.follow), the zero follows: what was seen is subtracted, and each contact says how much. With
    --patch, one line per second on standard error reports how the probe lies on the surface it presses; the
    contacts do not change. An output that is too slow loses contacts, and their
    number is reported; it never delays the sensor. Exit code 1: no sample arrived, more than 5 % of them
    could not be used, a stream failed, or a replay could not be read to its end; 2: the
    bundle is refused, or an output failed or published nothing. --json reports the counts at the end; contacts
    then have to go elsewhere than to standard output.

    Parameters
    ----------
    bundle
        Folder or zip file of a runtime config.
    source : ADDRESS
        Address of the force/torque sensor, or a replay.
    pose : ADDRESS
        Address of the robot's flange: elfin+tcp://, ur+tcp://, igtl+tcp://, the same replay:// address,
        poses:///file.csv, still://?rpy=0,90,0 (degrees).
    seconds
        Duration, s [until Ctrl-C].
    unverified
        Accept a bundle that is not verified.
    other_sensor
        Also run with a sensor of another serial number.
    allow_remote
        Outputs may reach other machines, neither encrypted nor signed.
    """
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.contact.patch import Bed, PatchReader
    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.runtime import Outlet, Run
    from contactbench.pipeline.runtime.outlet import OutputContext
    from contactbench.pipeline.runtime.run import (
        check_runnable,
        check_sensor,
        fit_words,
        hold_for,
        load_from_now,
        rate_that_fits,
        responsive,
    )
    from contactbench.pipeline.streams import open_pair

    check_seconds(seconds)
    wanted = {name: address for name, address in addresses.items() if address is not None} or {"out": "-"}
    if wanted.get("out") == "-":
        output_is_data()
    if as_json() and wanted.get("out") == "-":
        raise typer.BadParameter(
            "--json and the contacts both use standard output: give --out a file name, or another output."
        )
    config = RuntimeConfig.load(bundle)
    check_runnable(config, unverified=unverified)
    patches = None if patch is None else PatchLines(PatchReader(config.probe, Bed.parse(patch)))
    runner: Run
    # Said in the main thread: a terminal that hangs must not hang the sensor.
    changes: queue.SimpleQueue[tuple[str, Health]] = queue.SimpleQueue()
    told = Changes()
    poses = DeviceAddress.parse(pose)
    pair = open_pair(
        source,
        poses,
        lambda samples: runner.wrenches(samples),
        lambda samples: runner.poses(samples),
        lambda health: changes.put(("sensor", health)),
        lambda health: changes.put(("robot", health)),
    )
    with ended_by_signals() as ended, ExitStack() as stack:
        stack.callback(pair.stop)  # a replay has its file open before it begins
        check_sensor(config, pair.about().devices[0].serial, other=other_sensor)
        targets = open_outputs(wanted, OutputContext(pair.about(), config.probe, allow_remote))
        outlets = [Outlet(target, patient=pair.player is not None) for target in targets.values()]
        live = pair.player is None
        keep = None if patches is None else patches.take
        runner = Run(config, outlets, hold=hold_for(poses), clock=pair.now if live else None, on_answer=keep)
        _say_begin(config, pair)
        if live:
            words, slow = fit_words(config, rate_that_fits(config, targets))
            say(words, "yellow" if slow else "")
        load = load_from_now()
        with responsive(), runner, pair:
            _wait(pair, runner, config, lambda: _say_changes(changes, told, patches), seconds, ended, load)
            share = load()
    _say_changes(changes, told, patches)
    told.end()
    _say_end(config, pair, runner, share if live else 0.0)
    failed = [str(outlet.error) for outlet in outlets if outlet.error is not None and not outlet.gone]
    good = not broken(pair) and runner.good and not failed
    if failed:
        report_error(failed[0], as_json=False)
    answer(_facts(pair, runner, good=good) | ({"error": failed[0]} if failed else {}))
    if not good:
        raise typer.Exit(2 if failed else 1)


class PatchLines:
    """Says how the probe lies on what it presses: contacts come in the sensor's thread, words in the main one."""

    def __init__(self, reader: PatchReader) -> None:
        from contactbench.pipeline.contact.patch import LivePatch

        self._live, self._said_at = LivePatch(reader), -math.inf
        self._newest: RuntimeContact | None = None

    def take(self, _: WrenchSample, found: Answer) -> None:
        """Take a contact; it is only kept."""
        self._newest = found.contact

    def say_new(self) -> None:
        """Say what the newest contact tells, once a second."""
        contact, self._newest = self._newest, None
        if contact is None or contact.wrench is None:
            return
        patch = self._live.read(contact.time, contact.wrench[:3], contact)
        if patch is not None and not 0 <= contact.time - self._said_at < _PATCH_S:
            self._said_at = contact.time
            _say(f"{contact.time:.1f} s: {patch.sentence}")


# ---- while it runs -----------------------------------------------------------------------------


def _wait(
    pair: Pair,
    runner: Run,
    config: RuntimeConfig,
    say_changes: Callable[[], None],
    seconds: float | None,
    ended: Ended,
    load: Callable[[], float],
) -> None:
    """Wait until the time or the source is over, a stream or an output has failed, or somebody has ended it."""
    begun = time.monotonic()
    zero = "unknown"
    deadline = math.inf if seconds is None else begun + seconds
    settled, slow = False, set[str]()
    while not (
        pair.finished or broken(pair) or ended.asked or any(o.failed.is_set() for o in runner.outlets)
    ):
        now = time.monotonic()
        if now >= deadline:
            return
        say_changes()
        zero = _say_zero(runner, zero)
        if pair.player is None and not pair.stepwise:
            runner.heartbeat(pair.now())
        for outlet in runner.outlets:
            if outlet.lost and outlet.name not in slow:
                slow.add(outlet.name)
                _say(
                    outlet.trouble
                    or f"{outlet.name}: contacts are lost there: it is too slow, or nobody takes them."
                    " They are counted.",
                    "yellow",
                )
        if not settled and now - begun > _SETTLED_S:
            settled = True  # said early, not only at the end
            _say_warnings(config, pair, runner, load())
        if pair.stepwise:
            pair.step(_STEPS)
        else:
            time.sleep(min(deadline - now, _LOOK_S))


def _say_begin(config: RuntimeConfig, pair: Pair) -> None:
    from contactbench.pipeline.runtime.run import sensor_warnings

    model = config.model
    known = pair.about().devices[0]
    say(
        f"{model.probe.name}: {model.probe.facets:,} facets, {'verified' if model.verified else 'NOT VERIFIED'},"
        f" exported {model.provenance.created}.",
        "" if model.verified else "red",
    )
    say_all(model.provenance.stale, "red")
    say_all(config.notes, "yellow")
    say_all(sensor_warnings(config, known.model, known.serial), "yellow")
    if model.frames.quaternion_ES is None:
        say(
            "The bundle does not know the mounting: poses are treated as those of the sensor itself.",
            "yellow",
        )


def _say_changes(
    changes: queue.SimpleQueue[tuple[str, Health]], told: Changes, patches: PatchLines | None
) -> None:
    if patches is not None:
        patches.say_new()
    with suppress(queue.Empty):
        while True:
            told.tell(*changes.get_nowait())
    told.tick()


def _say_warnings(config: RuntimeConfig, pair: Pair, runner: Run, load: float) -> None:
    """Say where the rate is not the config's, and that the tool's inertia stays in."""
    from contactbench.pipeline.runtime.run import motion_warning, rate_warning

    rate = rate_warning(config, pair.sensor.health.rate, load)
    for words in filter(None, (rate, motion_warning(config, runner.positions))):
        _say(words, "yellow")


def _say_zero(runner: Run, before: str) -> str:
    """Say what is known of the sensor's zero where that is not what it was; returns what it is."""
    from contactbench.pipeline.runtime.run import zero_words

    zero = runner.zero
    if zero is None or zero.state == before:
        return before
    if zero.state != "unknown":
        _say(zero_words(zero), {"off": "red", "doubtful": "yellow"}.get(zero.state, ""))
    return zero.state


def _say_zero_at_end(config: RuntimeConfig, runner: Run) -> None:
    from contactbench.pipeline.contact.following import follow_words

    zero = runner.zero
    _say_zero(runner, "")
    if zero is not None and (words := follow_words(zero)):
        _say(words, "yellow" if zero.follows == "stopped" else "")
    if zero is not None and math.isfinite(zero.age):
        _say(f"zero: last seen {zero.age:.0f} s before the end.")
    elif zero is not None:
        measured = config.model.zero.measured
        since = "" if measured is None else f"; the calibration measured it at {measured}"
        _say(f"zero: not seen in this run{since}.", "yellow")


def _say_end(config: RuntimeConfig, pair: Pair, runner: Run, load: float) -> None:
    from contactbench.pipeline.runtime.run import load_words, mark_warnings

    _say_warnings(config, pair, runner, load)
    for device, health in pair.healths.items():
        rate = "an unknown rate" if health.rate is None else f"{health.rate:.1f} Hz"
        _say(f"{device}: {health.samples:,} samples at {rate}; lost {health.counters.lost}.")
        if health.failure is not None:
            _say(f"{device}: {health.failure}", "red")
    counted = ", ".join(f"{reason} {count:,}" for reason, count in runner.reasons.most_common())
    _say(f"located: {sum(runner.reasons.values()):,} samples: {counted or 'none'}.")
    for words in mark_warnings(runner.on):
        _say(words, "yellow")
    median, worst = runner.latencies.quantile(0.5), runner.latencies.quantile(0.99)
    if median is not None and worst is not None:
        _say(f"latency: median {1e3 * median:.1f} ms, 99th percentile {1e3 * worst:.1f} ms.")
    if fits := load_words(pair.sensor.health.rate, load):
        _say(fits)
    _say_zero_at_end(config, runner)
    if runner.unhealthy:
        wrong = ", ".join(f"{name} {count:,}" for name, count in runner.unhealthy.most_common())
        _say(f"unhealthy: {wrong}.", "yellow")
    if runner.reasons and not runner.good:
        _say(
            f"{runner.unusable:.0%} of the samples could not be used: check the reasons above,"
            " then sensor, poses and their rates.",
            "red",
        )
    for outlet in runner.outlets:
        _say(
            f"{outlet.name}: {outlet.published:,} contacts published, {outlet.lost:,} not.",
            "yellow" if outlet.lost else "",
        )
        if outlet.trouble and outlet.error is None:  # an error is said last
            _say(outlet.trouble, "yellow")


def _facts(pair: Pair, runner: Run, *, good: bool) -> dict[str, Any]:
    """Return what `_say_end` says, for ``--json``."""
    return {
        "good": good,
        "samples": runner.reasons.total(),
        "reasons": dict(runner.reasons),
        "unhealthy": dict(runner.unhealthy),
        "unusable": runner.unusable,
        "latency_s": {
            name: runner.latencies.quantile(share) for name, share in (("median", 0.5), ("p99", 0.99))
        },
        "streams": [
            {"device": device, "samples": health.samples, "failure": health.failure}
            for device, health in pair.healths.items()
        ],
        "outputs": [
            {"name": each.name, "published": each.published, "lost": each.lost, "error": each.trouble or None}
            for each in runner.outlets
        ],
    }


def _say(text: str, style: str = "") -> None:
    with suppress(OSError, SystemExit):  # a closed terminal is no reason to stop
        say(text, style)
