"""
Contacts as lines of JSON: byte for byte what the C++ example ``contactbench-locate`` prints.

Both write the fewest digits that read back as the same double, in the shorter of the two notations.
"""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pipeline import kernel

_STALE = "stale"  # as the kernel names it
_NOWHERE = (
    ',"accepted":false,"point_S_m":null,"filtered_point_S_m":null,"normal_S":null,"torque_Nm":null,"force_S_N":null,'
    '"torque_S_Nm":null,"covariance_S_m2":null,"face":-1,"vertex":-1,"region":0,"candidates":0,"confidence":0,'
    '"misfit":null,"left_over_Nm":null,"arm_m":null,"runner_up_S_m":null,"second_S_m":null}\n'
)


class Answer:
    """
    What the runtime says of one sample.

    Parameters
    ----------
    time : float
        Of the sample, s of its own clock.
    contact : kernel.RuntimeContact or None
        None: there was no pose young enough, and the kernel was not asked.

    Attributes
    ----------
    time, contact
        As given.
    """

    __slots__ = ("_line", "_reason", "contact", "time")

    def __init__(self, time: float, contact: kernel.RuntimeContact | None) -> None:
        self.time, self.contact = time, contact
        self._line: bytes | None = None
        self._reason: str | None = None

    def let_go(self) -> None:
        """Keep the line and the reason, not the contact: nothing of the kernel may outlive a program."""
        self._line, self._reason = self.line, self.reason
        self.contact = None

    @property
    def reason(self) -> str:
        """Why there is a contact, or none; ``stale`` also where a pose is missing."""
        if self._reason is not None:
            return self._reason
        return _STALE if self.contact is None else self.contact.reason_name

    @property
    def line(self) -> bytes:
        """One line of JSON, its end included; made once, however many publish it."""
        # Two threads may both make it: it is the same.
        if self._line is None:
            self._line = _line(self.time, self.contact).encode("ascii")
        return self._line


def _line(time: float, contact: kernel.RuntimeContact | None) -> str:
    if contact is None:
        return f'{{"time":{number(time)},"reason":"{_STALE}"{_NOWHERE}'
    wrench = contact.wrench
    covariance = contact.covariance
    return (
        f'{{"time":{number(time)},"reason":"{contact.reason_name}"'
        f',"accepted":{"true" if contact.accepted else "false"}'
        f',"point_S_m":{_array(contact.point)},"filtered_point_S_m":{_array(contact.filtered_point)}'
        f',"normal_S":{_array(contact.normal)},"torque_Nm":{number(contact.torque)}'
        f',"force_S_N":{_array(None if wrench is None else wrench[:3])}'
        f',"torque_S_Nm":{_array(None if wrench is None else wrench[3:])}'
        f',"covariance_S_m2":{_array(None if covariance is None else covariance.ravel())}'
        f',"face":{_index(contact.face)},"vertex":{_index(contact.vertex)},"region":{contact.region}'
        f',"candidates":{contact.candidates},"confidence":{number(contact.confidence)}'
        f',"misfit":{number(contact.misfit)},"left_over_Nm":{number(contact.left_over)}'
        f',"arm_m":{number(contact.arm)},"runner_up_S_m":{_array(contact.runner_up)}'
        f',"second_S_m":{_array(contact.second)}}}\n'
    )


def _index(index: int | None) -> int:
    return -1 if index is None else index


def _array(values: NDArray[np.float64] | None) -> str:
    return "null" if values is None else "[" + ",".join(map(number, values.tolist())) + "]"


def number(value: float) -> str:
    """
    Return a double as JSON, as ``std::to_chars`` writes it; ``null`` for what is not finite.

    The fewest digits that read back as the same, with an exponent only where that is shorter.
    """
    if not isfinite(value):
        return "null"
    text = repr(value)
    # Python's own notation is the shorter one here, but for the ".0" of whole numbers.
    if 1e-3 <= abs(value) < 1e5 or value == 0.0:
        return text.removesuffix(".0")
    return _shorter(text, value)


def _shorter(text: str, value: float) -> str:
    sign = "-" if text[0] == "-" else ""
    mantissa, _, exponent = text.removeprefix("-").partition("e")
    whole, _, part = mantissa.partition(".")
    written = (whole + part).lstrip("0")
    # Of 0.ddd × 10^power.
    power = len(whole) + int(exponent or 0) - (len(whole + part) - len(written) if whole == "0" else 0)
    digits = written.rstrip("0") or "0"
    point = "." if len(digits) > 1 else ""
    scientific = f"{digits[0]}{point}{digits[1:]}e{'-' if power < 1 else '+'}{abs(power - 1):02d}"
    if power <= 0:
        fixed = "0." + "0" * -power + digits
    elif power >= len(digits):
        fixed = str(abs(int(value)))  # all digits of a double above 2^53, not zeros
    else:
        fixed = digits[:power] + "." + digits[power:]
    return sign + (scientific if len(scientific) < len(fixed) else fixed)
