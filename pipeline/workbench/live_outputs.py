"""Contacts of the open devices to other programs, while the window is open: what ``contactbench run`` does."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.runtime import Outlet, Run
from contactbench.pipeline.runtime.outlet import OutputContext
from contactbench.pipeline.runtime.outputs import open_outputs
from contactbench.pipeline.runtime.run import check_runnable, check_sensor, hold_for
from contactbench.pipeline.workbench.live import Tap

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.workbench.live import Live


@dataclass(frozen=True)
class OutputState:
    """How one output is doing."""

    option: str  # of `OUTPUTS`
    published: int  # contacts
    lost: int
    error: str  # why it takes nothing, now or any more; empty: it does


class LiveOutputs:
    """
    The runtime on the devices that are open, with its outputs; any thread may call it.

    Parameters
    ----------
    live : Live
    """

    def __init__(self, live: Live) -> None:
        self._live, self._lock = live, threading.Lock()
        self._run: Run | None = None
        self._options: tuple[str, ...] = ()
        self._end: Callable[[], None] = _nothing

    @property
    def running(self) -> bool:
        """Whether contacts go out."""
        return self._run is not None

    def start(
        self,
        config: RuntimeConfig,
        addresses: Mapping[str, str],
        *,
        unverified: bool = False,
        remote: bool = False,
    ) -> None:
        """
        Begin to publish contacts; what was published before ends.

        Parameters
        ----------
        config : RuntimeConfig
        addresses : mapping
            Of outputs, by their names in `OUTPUTS`.
        unverified : bool
            Also with a bundle that is not verified.
        remote : bool
            Outputs may reach other machines.

        Raises
        ------
        InputError
            No sensor or no source of poses is open, the bundle or the sensor does not do, or an output cannot be
            opened.
        """
        self.stop()
        pair = self._live.pair
        if pair is None or pair.poses is None:
            raise InputError("Live outputs need a sensor and a source of poses: open them in step 1.")
        if not addresses:
            raise InputError("No output is chosen: choose one.")
        check_runnable(config, unverified=unverified)
        about = pair.about()
        check_sensor(config, about.devices[0].serial)
        targets = open_outputs(addresses, OutputContext(about, config.probe, remote))
        clock = pair.now if pair.player is None else None
        outlets = list(map(Outlet, targets.values()))
        run = Run(config, outlets, hold=hold_for(pair.poses.address), clock=clock)
        with self._lock:
            run.__enter__()  # its end is `stop`
            self._run, self._options = run, tuple(targets)
        self._end = self._live.tap(Tap(run.wrenches, run.poses, lambda *_: None, self.stop))

    def stop(self) -> None:
        """End; an output that hangs is left after 2 s."""
        with self._lock:
            run, self._run = self._run, None
            end, self._end = self._end, _nothing  # it holds the run, and with it the kernel
        end()
        if run is not None:
            run.__exit__(None, None, None)

    def look(self) -> tuple[OutputState, ...]:
        """Say that no sample comes, where that is so, and return how the outputs are doing; call it often."""
        run, pair = self._run, self._live.pair
        if run is None:
            return ()
        if pair is not None and pair.player is None and not pair.stepwise:
            run.heartbeat(pair.now())
        return tuple(
            OutputState(option, each.published, each.lost, each.trouble)
            for option, each in zip(self._options, run.outlets, strict=True)
        )


def _nothing() -> None:
    """Nothing is tapped."""
