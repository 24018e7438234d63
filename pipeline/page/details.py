"""Who, what, when, and with which sensor: the facts at the head of a report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

# Of each that is missing: the option of a command, and the setting of a session.
_WHERE = {
    "Operator": ("--operator", "report.operator"),
    "Sensor": ("--sensor", "report.sensor"),
    "Serial number": ("--serial", "devices.serial"),
    "Sensor certificate": ("--certificate", "report.certificate"),
    "Calibration due": ("--due", "report.due"),
}


@dataclass(frozen=True)
class ReportDetails:
    """
    What no measurement tells; empty: nobody said.

    Attributes
    ----------
    operator : str
        Who measured.
    sensor : str
        Model of the force/torque sensor.
    certificate : str
        Number of its calibration certificate.
    due : str
        Until when that is valid, ISO 8601: 2027-03-31.
    serials : mapping of str to str
        Serial number by device: ``{"M8128": "SN 7"}``.
    """

    operator: str = ""
    sensor: str = ""
    certificate: str = ""
    due: str = ""
    serials: Mapping[str, str] = field(default_factory=dict)

    def table(self, created: datetime | None, others: Sequence[tuple[str, str]]) -> dict[str, Any]:
        """
        Return the head of a report for the macro ``details``.

        Parameters
        ----------
        created : datetime, optional
            When the report was made: a certificate that was due before is told.
        others : sequence of (str, str)
            More facts: name and value.
        """
        own = {
            "Operator": self.operator,
            "Sensor": self.sensor,
            "Serial number": _listed(self.serials),
            "Sensor certificate": self.certificate,
            "Calibration due": self.due,
        }
        overdue = bool(self.due) and created is not None and created.date().isoformat() > self.due
        return {
            "rows": [*own.items(), *others],
            "missing": [_WHERE[name] for name, said in own.items() if not said],
            "overdue": f"The sensor's calibration was due on {self.due}, before this report was made."
            if overdue
            else "",
        }


def _listed(serials: Mapping[str, str]) -> str:
    """Return the numbers; with their devices if there are several, or one that is not just the sensor."""
    if list(serials) == ["sensor"]:
        return serials["sensor"]
    return ", ".join(f"{device}: {serial}" for device, serial in serials.items())
