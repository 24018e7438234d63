"""A session that a window works on: its writes happen one after the other, in a thread of their own."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from contactbench.pipeline.session import Session, State

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
    refuses : bool
        Whether the last write failed, as on a full disk; see `Session.recover`.
    closed : bool
        Nothing may be asked of it any more.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._state, self._stale = session.state, session.stale()
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

    @property
    def state(self) -> State:
        """What the session amounts to, after the newest action that is done."""
        return self._state

    @property
    def stale(self) -> dict[tuple[str, str], tuple[str, ...]]:
        """Why each current result is stale; empty for one that holds."""
        return self._stale

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
        before = self._state.count
        try:
            return action(self._session)
        finally:
            self.refuses = self._session.refuses
            state = self._session.state
            if state.count != before:
                self._state, self._stale = state, self._session.stale()
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
