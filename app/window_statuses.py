"""How the steps of an open session stand."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.app.bench import Bench
    from contactbench.pipeline.workbench.statuses import Facts
    from contactbench.pipeline.workbench.steps import Step, StepStatus


def is_connected(bench: Bench) -> bool:
    """Whether samples come."""
    from contactbench.pipeline.devices.stream import State

    health = bench.live.health
    return health is not None and health[0].state is State.STREAMING


def statuses_of(bench: Bench, facts: Facts | None) -> Mapping[Step, StepStatus]:
    """Return how the steps stand; `facts`: what the results said last."""
    from contactbench.pipeline.workbench.statuses import statuses

    desk = bench.desk
    return statuses(desk.state, desk.stale, bench.running, is_connected(bench), bench.failed, facts)
