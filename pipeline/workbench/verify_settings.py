"""How a session verifies: settings ``verification.*``, which its computation takes as parameters of the same names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.verification.result import VerificationParameters

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from contactbench.pipeline.session import State

KIND, RESULT, REPORT = "verification", "verification.json", "report.html"
MOUNT = "devices.mount"
# Those that the desktop application asks for; the others of the computation stay as they are.
ASKED = ("windows", "repeats", "samples", "order", "mean_limit_mm", "max_limit_mm")


def parameters_of(state: State, given: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """
    Return the parameters that a session's verification is computed with, JSON values.

    Parameters
    ----------
    state : State
    given : mapping, optional
        Parameters that count more than the session's settings.

    Raises
    ------
    InputError
        One of them is wrong.
    """
    found = {
        key.removeprefix(f"{KIND}."): setting.value
        for key, setting in state.settings.items()
        if key.startswith(f"{KIND}.") and setting.value is not None
    }
    mount = state.settings.get(MOUNT)
    if mount is not None and mount.value is not None:
        found.setdefault("mount", mount.value)
    found.update(given or {})
    checked_parameters(found)
    return found


def checked_parameters(parameters: Mapping[str, Any]) -> VerificationParameters:
    """Return parameters as a verification has them; InputError, with the first that is wrong."""
    checked = VerificationParameters.checked({"name": RESULT, **parameters})
    checked.settings()
    return checked


def plain_parameters(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Return all parameters as JSON values, those that were left out as they are used."""
    plain: dict[str, Any] = checked_parameters(parameters).model_dump(mode="json", exclude={"name"})
    return plain


@dataclass
class Turns:
    """
    The order in which markers are touched, where it is given; it can be changed while touches go on.

    A protocol asks for ``order[accepted % len(order)]``; written out touch by touch, a marker can be left out, or
    touched again, without a change of what was asked before.

    Attributes
    ----------
    names : list of str
        One for each touch.
    """

    names: list[str]

    @classmethod
    def of(cls, order: Sequence[str], repeats: int, windows: int) -> Turns:
        """Return every marker in its turn, once per repeat and force window."""
        return cls([name for _ in range(repeats * windows) for name in order])

    def skip(self, accepted: int) -> bool:
        """Leave out the marker that would come next, this time and all others; whether there was one."""
        if accepted >= len(self.names):
            return False
        name = self.names[accepted]
        self.names[accepted:] = [each for each in self.names[accepted:] if each != name]
        return True

    def repeat(self, accepted: int, name: str) -> None:
        """Have a marker touched next."""
        self.names.insert(min(accepted, len(self.names)), name)
