"""
A verification as one HTML page for people who have never seen the program.

The page needs nothing beside itself: no script, no font, no other file. The same content gives the same bytes.
"""

from __future__ import annotations

import base64
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from contactbench import __version__
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.regions.exchange import mesh_hash
from contactbench.pipeline.page import moment, render
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.report.facts import (
    about,
    budget_facts,
    calibration_facts,
    check_rows,
    mesh_steps,
    ratio_rows,
    settings_rows,
    summaries,
    tiles,
    touch_rows,
    vector_words,
    versions,
)
from contactbench.pipeline.report.picture import MOST_SHOWN, error_map, marker_views
from contactbench.pipeline.verification.model_error import model_error_words

if TYPE_CHECKING:
    from collections.abc import Mapping
    from datetime import datetime

    from contactbench.pipeline.calibration.files.calibration_file import CalibrationRecord
    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.verification.figures import Verification

__all__ = ["ReportContent", "report_html"]

_PIXELS = 480  # of each look at the probe
_SMALLER = 0.75  # of that, on the first page


@dataclass(frozen=True, eq=False)
class ReportContent:
    """
    All that a report tells.

    Attributes
    ----------
    verification : Verification
    probe : ProbeFile
        The probe, in S.
    calibration : CalibrationRecord or None
    created : datetime or None
        When the report was made, with a time zone; the only time that is not in the inputs.
    details : ReportDetails
        Who, and with which sensor.
    session : str
        Of which session; empty: not said.
    files : mapping of str to str
        SHA-256 by name, of further files.
    checks : mapping of str to mapping
        By kind, what a known weight and a known touch showed; see `verification.known.read_check`.
    """

    verification: Verification
    probe: ProbeFile
    calibration: CalibrationRecord | None = None
    created: datetime | None = None
    details: ReportDetails = field(default_factory=ReportDetails)
    session: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    checks: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def report_html(content: ReportContent) -> str:
    """
    Return the page.

    Raises
    ------
    InputError
        The probe was not aligned with the sensor, or `created` has no time zone.
    """
    when = moment(content.created)
    if content.probe.frame != "S" and content.probe.history:
        raise InputError(
            f"{content.probe.probe.name}: the probe is not aligned with the sensor: run `contactbench probe align`."
        )
    details = content.details.table(content.created, about(content, when))
    return render(__package__, created=when, details=details, **_context(content), **_pictures(content))


def _context(content: ReportContent) -> dict[str, Any]:
    verification, probe = content.verification, content.probe.probe
    accepted = [touch for touch in verification.touches if touch.accepted]
    return {
        "probe": probe,
        "mesh_sha256": mesh_hash(probe),
        "v": verification,
        "passed": verification.verdict.passed,
        "reasons": [f"{reason[:1].upper()}{reason[1:]}." for reason in verification.verdict.reasons],
        "tiles": tiles(verification),
        "accepted": len(accepted),
        "total": len(verification.touches),
        "summaries": summaries(verification),
        "bias": vector_words(verification),
        "left": model_error_words(verification.model_error),
        "touches": touch_rows(verification),
        "calibration": None if content.calibration is None else calibration_facts(content.calibration),
        "checks": check_rows(content.checks, verification.sources),
        "settings": settings_rows(verification.settings),
        "versions": versions(),
        "steps": mesh_steps(content.probe),
        "budget": budget_facts(verification),
        "ratios": ratio_rows(verification, content.calibration),
        "files": {**{f"verified {role}": h for role, h in verification.sources.items()}, **content.files},
        "tool": f"contactbench {__version__}",
    }


def _pictures(content: ReportContent) -> dict[str, Any]:
    """Draw; what is drawn with takes a while to import."""
    from contactbench.pipeline.heatmap.picture import encode_png
    from contactbench.pipeline.report.figures import FEWEST_REPEATS, draw
    from contactbench.pipeline.report.picture import draw_touches

    verification, probe = content.verification, content.probe.probe
    accepted = [touch for touch in verification.touches if touch.accepted]
    views = marker_views(accepted, probe)
    largest = {each.name: each.max_mm for each in verification.per_marker}
    worst = {v.name for v in sorted(views, key=lambda v: -largest.get(v.name, 0.0))[:MOST_SHOWN]}
    shown = [view for view in views if view.name in worst]
    made = error_map(accepted, probe)
    limit = 1e3 * verification.limits.max_m
    errors = b"" if made is None else encode_png(made, pixels=_PIXELS, legend=False, limit=limit)
    seen = draw_touches(accepted, probe, verification.limits, round(_SMALLER * _PIXELS))
    figures = draw(
        accepted,
        verification.per_marker,
        shown,
        verification.limits,
        verification.diagnosis,
        passed=verification.verdict.passed,
    )
    hidden = len(views) - len(shown)
    return {
        "figures": figures,
        "picture": seen,
        "map": base64.b64encode(errors).decode(),
        "hidden": hidden,
        "fewest": FEWEST_REPEATS,
    }
