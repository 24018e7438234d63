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

    from contactbench.pipeline import kernel

HEALTH = ("frozen", "silent", "flagged", "no_pose", "clock")
"""Names of the bits of a health word, from the lowest."""


def health_names(word: int) -> tuple[str, ...]:
    """Return what is wrong, by a health word; empty: nothing."""
    return tuple(name for bit, name in enumerate(HEALTH) if word >> bit & 1)


class Answer:
    """
    What the runtime says of one sample.

    Parameters
    ----------
    contact : kernel.RuntimeContact
    latency : float
        How old what the contact rests on was when this was known, the lag of the wrench filter included, s; NaN: not
        known.
    zero : kernel.Zero
        What is known of the sensor's zero at this sample.
    on : str, optional
        What the contact lies on, one of `contactbench.pipeline.contact.facet_marks.MARKS`; None: there is none.

    Attributes
    ----------
    contact : kernel.RuntimeContact or None
    zero : kernel.Zero or None
        None after `let_go`.
    time : float
        Of the sample, s of its own clock.
    reason : str
        Why there is a contact, or none.
    health : int
        Health word; see `health_names`.
    latency, on
        As given.
    """

    __slots__ = ("_line", "contact", "health", "latency", "on", "reason", "time", "zero")

    def __init__(
        self, contact: kernel.RuntimeContact, latency: float, zero: kernel.Zero, on: str | None = None
    ) -> None:
        self.contact: kernel.RuntimeContact | None = contact
        self.zero: kernel.Zero | None = zero
        self.time, self.reason, self.health, self.latency = (
            contact.time,
            contact.reason_name,
            contact.health,
            latency,
        )
        self.on = on
        self._line: bytes | None = None

    def let_go(self) -> None:
        """Keep the line, not the contact: nothing of the kernel may outlive a program."""
        self._line = self.line
        self.contact = self.zero = None

    @property
    def line(self) -> bytes:
        """One line of JSON, its end included; made once, however many publish it."""
        # Two threads may both make it: it is the same.
        contact, zero = self.contact, self.zero
        if self._line is None and contact is not None and zero is not None:
            self._line = _line(contact, self.latency, zero, self.on).encode("ascii")
        return self._line or b""


def _line(contact: kernel.RuntimeContact, latency: float, zero: kernel.Zero, on: str | None) -> str:
    wrench = contact.wrench
    covariance = contact.covariance
    health = ",".join(f'"{name}"' for name in health_names(contact.health))
    return (
        f'{{"time":{number(contact.time)},"reason":"{contact.reason_name}"'
        f',"accepted":{"true" if contact.accepted else "false"},"health":[{health}]'
        f',"latency_s":{number(latency)},"pose_age_s":{number(contact.pose_age)}'
        f',"point_S_m":{_array(contact.point)},"filtered_point_S_m":{_array(contact.filtered_point)}'
        f',"normal_S":{_array(contact.normal)},"torque_Nm":{number(contact.torque)}'
        f',"force_S_N":{_array(None if wrench is None else wrench[:3])}'
        f',"torque_S_Nm":{_array(None if wrench is None else wrench[3:])}'
        f',"covariance_S_m2":{_array(None if covariance is None else covariance.ravel())}'
        f',"within_m":{number(contact.within)}'
        f',"face":{_index(contact.face)},"vertex":{_index(contact.vertex)},"region":{contact.region}'
        f',"on":{_text(on)}'
        f',"candidates":{contact.candidates},"confidence":{number(contact.confidence)}'
        f',"misfit":{number(contact.misfit)},"left_over_Nm":{number(contact.left_over)}'
        f',"arm_m":{number(contact.arm)},"torsion_arm_m":{number(contact.torsion_arm)}'
        f',"torsion_since_s":{number(contact.torsion_since)},"runner_up_S_m":{_array(contact.runner_up)}'
        f',"second_S_m":{_array(contact.second)},"zero":{_zero(zero, contact)}}}\n'
    )


def _zero(zero: kernel.Zero, contact: kernel.RuntimeContact) -> str:
    offset = zero.offset
    followed = ""
    if zero.follows != "off":
        followed = (
            f',"follows":"{zero.follows}","seen_s":{number(zero.seen)},"taken_S":{_array(contact.taken)}'
            f',"taken_sigma_S":{_array(zero.taken_sigma)},"raw_S":{_array(contact.raw)}'
        )
    return (
        f'{{"state":"{zero.state}","age_s":{number(zero.age)}'
        f',"force_S_N":{_array(None if offset is None else offset[:3])}'
        f',"torque_S_Nm":{_array(None if offset is None else offset[3:])}'
        f',"shift_m":{number(zero.shift)},"shift_sigma_m":{number(zero.shift_sigma)}{followed}}}'
    )


def _text(text: str | None) -> str:
    return "null" if text is None else f'"{text}"'


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
