"""
A verification as one HTML page for people who have never seen the program.

The page needs nothing beside itself: no script, no font, no other file. The same content gives the same bytes.
"""

from __future__ import annotations

import base64
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from contactbench import __version__
from contactbench.pipeline.calibration.budget import (
    COVERAGE,
    SOURCE_WORDS,
    BudgetSource,
    budget_table,
    length_mm,
)
from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, FORCE_BIAS, TORQUE_BIAS
from contactbench.pipeline.calibration.orientation import plain, signed, with_sigma
from contactbench.pipeline.errors import ALIGN, InputError, arg
from contactbench.pipeline.mesh.regions.exchange import mesh_hash
from contactbench.pipeline.page import moment, render
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT
from contactbench.pipeline.verification.model_error import model_error_words

if TYPE_CHECKING:
    from collections.abc import Mapping
    from datetime import datetime

    from contactbench.pipeline.calibration.files.calibration_file import CalibrationRecord
    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.verification.figures import ForceAccuracy, Summary, TouchFigure, Verification

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
            f"{arg(content.probe.probe.name)}: the probe is not aligned with the sensor: {arg(ALIGN)}."
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
    from contactbench.pipeline.report.picture import MOST_SHOWN, draw_touches, error_map, marker_views

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


# ---- what a report says in tables: numbers as text -----------------------------------------------


# Kind, what it is called, and what it rests on.
_CHECKS = ((WEIGHT, "Known weight", ("calibration",)), (TOUCH, "Known touch", ("calibration", "probe")))
MOST_TOUCHES = 400  # rows of the last table
NOTHING = "\N{EN DASH}"
# Of a verification's settings: how they are called on the page. What is not here is shown by its own name.
_SETTINGS = {
    "windows": "force windows, N",
    "samples": "samples of a touch",
    "repeats": "touches wanted of each marker",
    "order": "order of the markers",
    "left_out": "markers left out on purpose",
    "touch_N": "touched above, N",
    "release_N": "released below, N",
    "settle_s": "time to settle, s",
    "steady_N": "steady within, N",
    "slip_m": "slipped beyond, m",
    "gap_s": "longest gap, s",
    "noise_force": "noise of a force sample, N",
    "noise_torque": "noise of a torque sample, N·m",
    "resamples": "resamples of the bootstrap",
    "seed": "seed of the bootstrap",
    "rate_hz": "readings a second, Hz",
}
_UNSAID = {
    "noise_force": "measured within the touches",
    "noise_torque": "measured within the touches",
    "order": "any",
    "filters": "none",
    "mount": "none given: the sensor is not turned against the flange",
}


def about(content: ReportContent, when: str | None) -> list[tuple[str, str]]:
    """Return what the head of the page says of the measurement."""
    verification, record = content.verification, content.calibration
    accepted = [touch for touch in verification.touches if touch.accepted]
    markers = len(verification.per_marker)
    calibrated = ""
    if record is not None:
        facts = calibration_facts(record)
        calibrated = ", ".join(filter(None, (facts["word"], facts["created"])))
    return [
        ("Report made", when or ""),
        ("Probe", content.probe.probe.name),
        (
            "Touches",
            f"{len(accepted)} used of {len(verification.touches)}, on {markers} marker{'s' * (markers != 1)}",
        ),
        ("Gravity calibration", calibrated or "not in this report: add --calibration"),
        ("Session", content.session or "none: made from files"),
        ("Software", f"contactbench {__version__}"),
    ]


# What stands in a budget instead of a contribution.
_NO_PART = {BudgetSource.MOUNT: "in the model error", BudgetSource.MESH: "not known"}


def budget_facts(verification: Verification) -> dict[str, Any] | None:
    """Return the uncertainty budget, and how the errors compare with it; None: the verification has none."""
    table, u, overall = (
        budget_table(verification.budget, _NO_PART),
        verification.combined_mm,
        verification.overall,
    )
    if table is None or u is None or overall is None:
        return None
    largest = max(verification.budget, key=lambda row: row.variance_mm2).source
    return {
        **table,
        "observed": f"{length_mm(overall.rms_mm)} mm",
        "ratio": _times(overall.rms_mm / u) if u > 0 else NOTHING,
        "beyond": overall.rms_mm > COVERAGE * u,
        "measured": verification.model_error is not None,
        "unsure": SOURCE_WORDS[largest] if COVERAGE * u > 1e3 * verification.limits.max_m else "",
    }


def ratio_rows(verification: Verification, record: CalibrationRecord | None) -> list[tuple[str, str]]:
    """Return every ratio of errors that the report or its sources give, and what it compares."""
    rows = []
    u, overall = verification.combined_mm, verification.overall
    if u and overall is not None:
        rows.append(
            (_times(overall.rms_mm / u), "errors of the touches (rms) over the whole uncertainty budget")
        )
    if verification.ratio is not None:
        words = "errors of the touches (rms) over noise and calibration alone, without model error, markers and mesh"
        rows.append((_times(verification.ratio), words))
    if verification.diagnosis is not None:
        words = "what no cause explains of these errors over the sensor's noise alone"
        rows.append((_times(verification.diagnosis.noise_scale), words))
    if record is not None:
        words = "residuals of the gravity calibration's poses over the noise of a pose: nothing of the touches is in it"
        rows.append((_times(float(np.sqrt(record.calibration.scatter))), words))
    return rows


def _times(ratio: float) -> str:
    return f"{plain(ratio)} ×"


def tiles(verification: Verification) -> list[tuple[str, str, bool]]:
    """Return the main numbers: what, in words, and whether it is beyond its limit."""
    limits, overall, times = verification.limits, verification.overall, verification.times
    if overall is None:
        return []
    found = [
        (
            f"{overall.mean_mm:.2f} mm",
            f"mean error; the limit is {1e3 * limits.mean_m:g} mm{_interval(verification)}",
            overall.mean_mm > 1e3 * limits.mean_m,
        ),
        (
            f"{overall.max_mm:.2f} mm",
            f"largest error; the limit is {1e3 * limits.max_m:g} mm",
            overall.max_mm > 1e3 * limits.max_m,
        ),
    ]
    if times is not None:
        words = f"to find one contact, in 99 of 100 cases; the limit is {1e3 * limits.p99_s:g} ms"
        found.append((f"{1e6 * times.p99_s:.0f} µs", words, times.p99_s > limits.p99_s))
    if verification.force is not None:
        found.append(_force_tile(verification.force))
    return found


def _force_tile(force: ForceAccuracy) -> tuple[str, str, bool]:
    """Return the mean deviation of the force, and how many touches, the largest and the share in words."""
    of = f" of {force.of}" if force.of > force.touches else ""
    touches = f"{force.touches}{of} touch{'es' * (max(force.touches, force.of) != 1)}"
    scatter = f", ± {_number(force.sd_N)} N" if force.touches > 1 else ""
    words = (
        f"deviation of the force from the reference{scatter}; largest {force.max_N:.2f} N, {force.rms_percent:.1f} %"
        f" (rms) of the force, over {touches}"
    )
    return f"{signed(f'{force.mean_N:.2f}')} N", words, False


def _interval(verification: Verification) -> str:
    if verification.ci is None:
        return ""
    low, high = verification.ci.mean_mm
    return f"; with {100 * verification.ci.level:g} % confidence {low:.2f} to {high:.2f} mm"


def summaries(verification: Verification) -> list[tuple[str, list[dict[str, str]]]]:
    """Return tables of errors: a title and rows. Those with one row say nothing that is not in the first."""
    tables = [
        ("marker", verification.per_marker),
        ("repeat", verification.per_repeat),
        ("force", verification.per_force),
        ("angle to the surface's normal", verification.per_angle),
    ]
    found = [
        (title, [_summary(each) for each in rows])
        for title, rows in tables
        if len(rows) > 1 or title == "marker"
    ]
    if verification.overall is not None and found:
        found[0][1].append(_summary(verification.overall) | {"name": "all", "last": "yes"})
    return found


def _summary(each: Summary) -> dict[str, str]:
    numbers: dict[str, float | None] = {"mean": each.mean_mm, "p95": each.p95_mm, "max": each.max_mm}
    numbers |= {"bias": float(np.linalg.norm(each.bias_mm)), "sd": each.sd_mm, "scatter": each.scatter_mm}
    if each.touches < 2:  # one touch has no spread, and its 95 % are the touch itself
        numbers |= {"sd": None, "scatter": None, "p95": None}
    return {"name": each.name, "touches": str(each.touches), "last": ""} | {
        name: _number(value) for name, value in numbers.items()
    }


def settings_rows(settings: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return how it was verified, one row for each setting; what is grouped stands beside its group's name."""
    rows = []
    for name, value in settings.items():
        if isinstance(value, dict) and name not in _UNSAID:
            inner = settings_rows(value)
            rows += (
                inner if name == "protocol" else [(f"{_called(name)}: {row}", said) for row, said in inner]
            )
        else:
            said = _UNSAID.get(name, NOTHING) if value in (None, [], (), {}) else _value(value)
            rows.append((_called(name), said))
    return rows


def _called(name: str) -> str:
    return _SETTINGS.get(name, name.replace("_", " "))


def versions() -> list[tuple[str, str]]:
    """Return what computed this: packages and their versions."""
    return [
        ("contactbench and its kernel", __version__),
        ("numpy", np.__version__),
        ("scipy", scipy.__version__),
    ]


def vector_words(verification: Verification) -> str:
    """Return the bias that all touches share and the scatter about it, in a sentence."""
    overall, ci = verification.overall, verification.ci
    if overall is None:
        return ""
    parts = []
    for number, (name, value) in enumerate(zip("xyz", overall.bias_mm, strict=True)):
        range_ = ""
        if ci is not None:
            low, high = (signed(f"{end:.2f}") for end in ci.bias_mm[number])
            range_ = f" ({low} to {high})"
        parts.append(f"{name} {signed(f'{value:.2f}')}{range_}")
    size = float(np.linalg.norm(overall.bias_mm))
    shift = f"{size:.2f} mm in the sensor frame: {', '.join(parts)} mm."
    if overall.touches < 2:
        return f"The one touch is off by {shift}"
    words = f"On average the touches are off by {shift}"
    return f"{words} About that the points scatter by {_number(overall.scatter_mm)} mm (rms)."


def _number(value: float | None) -> str:
    return NOTHING if value is None else f"{value:.2f}"


def touch_rows(verification: Verification) -> list[dict[str, Any]]:
    """Return the rows of the table of touches, rejected ones too."""
    return [_touch(touch) for touch in verification.touches[:MOST_TOUCHES]]


def _touch(touch: TouchFigure) -> dict[str, Any]:
    error = touch.error_mm
    return {
        "number": touch.number,
        "marker": touch.marker or "",
        "force": f"{touch.force_N:.1f}",
        "angle": "" if touch.angle_deg is None else f"{touch.angle_deg:.0f}",
        "error": "" if error is None else " / ".join(signed(f"{value:.2f}") for value in error),
        "distance": "" if touch.distance_mm is None else f"{touch.distance_mm:.2f}",
        "predicted": "" if touch.predicted_mm is None else f"{touch.predicted_mm:.2f}",
        "reason": "" if touch.accepted else touch.reason or "rejected",
    }


def calibration_facts(record: CalibrationRecord) -> dict[str, Any]:
    """Return what the page says of the calibration."""
    calibration, created = record.calibration, record.created
    sigma = np.sqrt(np.diag(calibration.covariance))
    model = calibration.model
    rows = [("mass of probe and holder", "kg", [with_sigma(model.mass, model.mass_sigma)])]
    for name, unit, part, scale in (
        ("centre of mass", "mm", CENTRE_OF_MASS, 1e3),
        ("force offset", "N", FORCE_BIAS, 1.0),
        ("torque offset", "mN·m", TORQUE_BIAS, 1e3),
    ):
        pairs = zip(scale * model.vector[part], scale * sigma[part], strict=True)
        rows.append((name, unit, [with_sigma(float(value), float(s)) for value, s in pairs]))
    return {
        "word": {"good": "good", "usable": "usable", "refuse": "refused"}[calibration.verdict.level.value],
        "reasons": calibration.verdict.reasons,
        "rows": rows,
        "poses": len(calibration.poses),
        "used": int(calibration.kept.sum()),
        "share": plain(1e3 * calibration.contact_error),
        "created": moment(created),
        "tool": record.tool,
        "source": record.source,
    }


def check_rows(
    checks: Mapping[str, Mapping[str, Any]], sources: Mapping[str, str]
) -> list[tuple[str, str, str]]:
    """Return of each check that was made its name, a word and a paragraph; `sources`: what was verified, by role."""
    rows = []
    for kind, name, roles in _CHECKS:
        if kind not in checks:
            continue
        content = checks[kind]
        made_with = {role: content.get(f"{role}_sha256") for role in roles}
        others = [
            f"another {role}" for role in roles if made_with[role] != sources.get(role, made_with[role])
        ]
        outcome, words = content["outcome"], f"{content['sentence']} {_made_with(content)}".strip()
        if others:
            outcome = "not of this"
            words = f"It was made with {' and '.join(others)}: check again. {words}"
        rows.append((name, outcome, words))
    return rows


def _made_with(content: Mapping[str, Any]) -> str:
    """Say what a check was made with, and when."""
    said = [f"certificate {content['certificate']}"] if content.get("certificate") else []
    if content.get("created"):
        said.append(str(content["created"])[:16].replace("T", " ") + " UTC")
    return f"({', '.join(said)})" if said else ""


def mesh_steps(content: ProbeFile) -> list[dict[str, str]]:
    """Return the mesh's history: step, what was asked for, what came of it."""
    return [
        {
            "step": str(entry.get("step", "")),
            "asked": _words(entry.get("parameters")),
            "result": _words(entry.get("result")),
            "facets": str((entry.get("output") or {}).get("facets", "")),
            "tool": str(entry.get("tool", "")),
        }
        for entry in content.history
        if isinstance(entry.get("output") or {}, dict)
    ]


_LONGEST_WORDS = 240


def _words(value: Any) -> str:
    if not isinstance(value, dict):
        return ""
    words = "; ".join(
        f"{name.replace('_', ' ')} {_value(each)}"
        for name, each in value.items()
        if each not in (None, [], {}, "")
    )
    return words if len(words) <= _LONGEST_WORDS else f"{words[:_LONGEST_WORDS]}…"


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, dict):
        return ", ".join(f"{name.replace('_', ' ')} {_value(each)}" for name, each in value.items())
    if isinstance(value, list | tuple):
        pair = len(value) == 2 and all(isinstance(each, int | float) for each in value)
        return (" to " if pair else ", ").join(map(_value, value))
    return str(value)
