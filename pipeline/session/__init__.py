"""
A bench session: a folder that keeps every action, sample and result.

``journal`` is the truth: records that are only ever appended, each bound to the one before by its hash. ``raw/``,
``meshes/`` and ``results/`` hold the files that it refers to by SHA-256. A file is on the disk before the record
that refers to it, and a record is on the disk before it is acknowledged.
"""

from contactbench.pipeline.session.journal import (
    ArchiveError,
    JournalError,
    SchemaError,
    SessionError,
    SessionLockedError,
    SessionReadOnlyError,
)
from contactbench.pipeline.session.state import State, fold
from contactbench.pipeline.session.store import Session

__all__ = [
    "ArchiveError",
    "JournalError",
    "SchemaError",
    "Session",
    "SessionError",
    "SessionLockedError",
    "SessionReadOnlyError",
    "State",
    "fold",
]
