"""How a long computation is followed and stopped."""

from collections.abc import Callable

from contactbench.pipeline.errors import message


class Cancelled(Exception):  # noqa: N818 -- not an error: the caller asked for it
    """The caller cancelled the work; the engine that did it was stopped and nothing was changed."""


class Monitor:
    """
    Whoever waits for a computation: is told the share that is done, and may stop it; all in the caller's thread.

    Parameters
    ----------
    progress : callable, optional
        Takes the share that is done, 0 to 1. What it raises stops the work and reaches the caller.
    cancelled : callable, optional
        Asked often; once it answers True, the work stops.
    """

    def __init__(
        self, progress: Callable[[float], None] | None = None, cancelled: Callable[[], bool] | None = None
    ) -> None:
        self._progress, self._cancelled = progress, cancelled
        self._from, self._to, self._done = 0.0, 1.0, 0.0

    def check(self, words: str = "") -> None:
        """Raise Cancelled, in these words, if the work is to stop."""
        if self._cancelled is not None and self._cancelled():
            raise Cancelled(words or message("the work was cancelled: the mesh is unchanged."))

    def tell(self, share: float, words: str = "") -> None:
        """Tell how much of the work, or of its present step, is done; raises as `check`."""
        self.check(words)
        if self._progress is not None:
            self._progress(self._from + share * (self._to - self._from))

    def upto(self, share: float) -> "Monitor":
        """Begin the step that ends at `share` of the whole; returns what follows it."""
        self._from, self._to, self._done = self._done, share, share
        self.tell(0.0)
        return self

    def part(self, low: float = 0.0, high: float = 1.0) -> "Monitor":
        """Return what follows a part of the work, which may have steps of its own."""
        begun, whole = self._from + low * (self._to - self._from), (high - low) * (self._to - self._from)
        told = self._progress
        progress = None if told is None else lambda share: told(begun + share * whole)
        return Monitor(progress, self._cancelled)


NOBODY = Monitor()  # waits
