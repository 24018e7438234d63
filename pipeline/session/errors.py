"""What the session raises."""

from contactbench.pipeline.errors import InputError


class SessionError(InputError):
    """A session that cannot be used as asked: names what is wrong, where, and the remedy."""


class JournalError(SessionError):
    """A journal with damage that is not a torn tail, or with records that cannot be."""


class SchemaError(SessionError):
    """A session of a newer version, or of an older one that nothing here can migrate."""


class SessionLockedError(SessionError):
    """Another process writes this session."""


class SessionReadOnlyError(SessionError):
    """A session that this user or this disk does not let anybody write; it can be read."""


class ArchiveError(SessionError):
    """A zip file that holds no session, or one that must not be unpacked."""
