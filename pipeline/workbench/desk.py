"""A session that a window works on: its writes happen one after the other, in a thread of their own."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

from contactbench.pipeline.session import Session

T = TypeVar("T")


class Desk:
    """
    A session, open for writing, and what it amounts to.

    Copying a mesh or waiting for a disk may take seconds: `do` never does. What was asked first is done first.
    `state` and `stale` may be read in any thread: they are values, replaced when an action is done.

    Parameters
    ----------
    session : Session
        Open for writing; the desk closes it.

    Attributes
    ----------
    state : State
        What the session amounts to, after the newest action that is done.
    stale : dict of (str, str) to tuple of str
        Why each current result is stale; empty for one that holds.
    refuses : bool
        Whether the last write failed, as on a full disk; see `Session.recover`.
    closed : bool
        Nothing may be asked of it any more.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self.state, self.stale = session.state, session.stale()
        self.refuses = False
        self.closed = False
        self._listeners: list[Callable[[], None]] = []
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="desk")

    @property
    def folder(self) -> Path:
        """Of the session."""
        return self._session.folder

    @property
    def notes(self) -> tuple[str, ...]:
        """What was noticed when the session was opened."""
        return self._session.notes

    def do(self, action: Callable[[Session], T]) -> Future[T]:
        """
        Have something done with the session.

        Parameters
        ----------
        action : callable
            Gets the session, in the desk's thread; it must not keep it.

        Returns
        -------
        Future
            Of what it returns or raises.
        """
        return self._thread.submit(self._done, action)

    def _done(self, action: Callable[[Session], T]) -> T:
        before = self.state.count
        try:
            return action(self._session)
        finally:
            self.refuses = self._session.refuses
            state = self._session.state
            if state.count != before:
                self.state, self.stale = state, self._session.stale()
                for listener in tuple(self._listeners):
                    listener()

    def subscribe(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Have `listener` called, in the desk's thread, after every change; returns what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def close(self) -> None:
        """Wait for what was asked, and close the session."""
        self.closed = True
        self._thread.shutdown(wait=True)
        self._session.close()
