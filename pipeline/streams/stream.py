"""What every source of samples has in common, whatever is behind it."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Any, Self

    from contactbench.pipeline.devices.drive import Health, KeptStream
    from contactbench.pipeline.devices.url import DeviceAddress


class Stream(Protocol):
    """
    Samples from a device, a recording or a file.

    It is started once and stopped once; as a context manager it is both. Samples and changes of its health
    come in a thread of its own to the callables that it was opened with.
    """

    @property
    def address(self) -> DeviceAddress:
        """What was opened."""

    @property
    def health(self) -> Health:
        """How it is now."""

    @property
    def done(self) -> threading.Event:
        """Set when the source is at its end: nothing more will come. Devices have none."""

    def start(self) -> Self:
        """Begin."""

    def stop(self) -> None:
        """End it; returns when no more samples come."""

    def acknowledge(self) -> None:
        """Drop the suspicions in its health: somebody has read them."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


class DeviceStream:
    """A device as a `Stream`: one without an end.

    Parameters
    ----------
    kept : KeptStream
        Not yet started.
    """

    def __init__(self, kept: KeptStream[Any]) -> None:  # Any: of wrenches or of poses
        self._kept = kept
        self.address: DeviceAddress = kept.address
        self.done = threading.Event()

    @property
    def health(self) -> Health:
        """How the device is now."""
        return self._kept.health

    def start(self) -> Self:
        """Begin; the line is opened in the background."""
        self._kept.start()
        return self

    def stop(self) -> None:
        """Stop the device and close the line."""
        self._kept.stop()

    def acknowledge(self) -> None:
        """Drop the suspicions: somebody has read them."""
        self._kept.acknowledge()

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()
