"""From raw samples and poses to contacts: the kernel does all of it."""

from collections.abc import Callable, Sequence

import numpy as np

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.contact.facet_marks import facet_marks
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.runtime.lines import Answer

_UNKNOWN = np.full(3, np.nan)


class Engine:
    """
    One stream of wrenches and one of poses, into contacts.

    A sample takes the pose at its own time: between two poses, or carried on from the last one, as the config's
    ``streams`` allow. Without one the reason is ``stale``, and the filters are left as they were.

    Wrenches may come in one thread and poses in another.

    Parameters
    ----------
    config : RuntimeConfig
    hold : float, optional
        As for `make_runtime`; infinite for a pose that stands still.
    clock : callable, optional
        The present on the samples' clock, s: a contact's latency then runs until it is found. Left out, it ends with
        the sample's arrival.
    """

    def __init__(
        self, config: RuntimeConfig, *, hold: float | None = None, clock: Callable[[], float] | None = None
    ) -> None:
        self._runtime, self._clock = make_runtime(config, hold=hold), clock
        self._marks = facet_marks(config.probe)

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses of the flange, oldest first."""
        for sample in samples:
            R = np.ascontiguousarray(sample.R_BE, dtype=np.float64)
            p = np.ascontiguousarray(sample.p_BE_B, dtype=np.float64)
            self._runtime.pose(R, p if p.shape == (3,) else _UNKNOWN, sample.time)

    def locate(self, sample: WrenchSample) -> Answer:
        """Say where the probe is touched."""
        reading = np.array((*sample.force, *sample.torque))
        arrival = sample.time if sample.arrival is None else sample.arrival
        contact = self._runtime.locate(reading, sample.time, arrival, int(sample.status))
        latency = contact.latency if self._clock is None else contact.latency + (self._clock() - arrival)
        mark = -1 if contact.face is None else int(self._marks[contact.face])
        return Answer(contact, latency, self._runtime.zero(), mark)

    def silent(self, now: float) -> Answer | None:
        """Return an answer that says that no sample comes, or None while they do; `now` in s of the samples' clock."""
        contact = self._runtime.silent(now)
        return None if contact is None else Answer(contact, contact.latency, self._runtime.zero())
