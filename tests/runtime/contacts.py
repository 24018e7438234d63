"""Contacts of a probe that is pushed with 8 N, for tests of outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from config.runtime.bundles import example
from runtime.runtime_recordings import BEGIN, flange, wrench

from contactbench.pipeline.runtime import Engine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.runtime import Answer

STEP = 0.001


def touch() -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Return a place on the acoustic face (3,), its normal (3,), and what a push of 8 N there does (6,)."""
    probe = example().probe
    face = int(np.argmax(probe.region == 1))
    point = probe.vertices[probe.faces[face]].mean(axis=0)
    force = -8.0 * probe.normals[face]
    return point, probe.normals[face], np.concatenate([force, np.cross(point, force)])


def touching(count: int, *, free: int = 0) -> list[Answer]:
    """Return `count` accepted contacts at 1 kHz, and before them `free` answers without a touch."""
    engine = Engine(example(), hold=np.inf)
    engine.poses([flange(BEGIN, np.eye(3))])
    rng, weight = np.random.default_rng(5), example().gravity.predict(np.eye(3))
    found: list[Answer] = []
    accepted = step = 0
    while accepted < count:
        step += 1
        pushed = touch()[2] if step > free else np.zeros(6)
        noise = rng.normal(0, [0.02] * 3 + [5e-4] * 3)
        answer = engine.locate(wrench(BEGIN + STEP * step, weight + pushed + noise))
        assert answer.contact is not None
        accepted += answer.contact.accepted
        if step <= free or answer.contact.accepted:
            found.append(answer)
    return found
