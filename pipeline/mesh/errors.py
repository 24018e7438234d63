"""What the mesh package raises and warns with."""

from contactbench.pipeline.errors import InputError


class MeshError(InputError):
    """A mesh, or a file that should hold one, that cannot be used: names where it is wrong and the remedy."""


class MeshWarning(UserWarning):
    """A usable mesh with defects that may spoil contacts: says what, why it matters, and what to do."""
