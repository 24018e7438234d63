"""A verification with all its parts, from made-up touches of a bundled probe."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

from contactbench.assets import make
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.report import ReportContent
from contactbench.pipeline.verification.figures import (
    ErrorCause,
    ErrorDiagnosis,
    Refined,
    Share,
    Times,
    TouchFigure,
    Verification,
    VerificationLimits,
    VerificationVerdict,
)
from contactbench.pipeline.verification.statistics import intervals, summarise, summarise_by

CREATED = datetime(2026, 3, 4, 5, 6, tzinfo=UTC)


def probe_file(facets: int = 1_500) -> ProbeFile:
    probe = Probe.from_arrays(*make("convex", facets), name="convex")
    first = ProbeFile(probe, RegionSet.from_labels(probe.region, []), "P")
    return first.after("simplify", probe, {"facets": facets}, {"deviation_mm": 0.05}, frame="S")


def touches(probe: Probe, markers: int = 9, repeats: int = 4, seed: int = 0) -> list[TouchFigure]:
    rng = np.random.default_rng(seed)
    top = np.flatnonzero(probe.vertices[:, 2] > probe.bounds[1, 2] - 0.012)
    chosen = top[np.linspace(0, len(top) - 1, markers).astype(int)]
    found = []
    for number, (marker, repeat) in enumerate((m, r) for r in range(repeats) for m in range(markers)):
        force = float(rng.uniform(4, 6) if repeat % 2 else rng.uniform(8, 10))
        error = np.array([0.35, -0.1, 0.05]) + rng.normal(0, 2.0 / force, 3)
        point = 1e3 * probe.vertices[chosen[marker]] + error
        found.append(
            TouchFigure(
                number + 1,
                3.0 * number,
                3.0 * number + 1.5,
                True,
                "",
                f"M{marker + 1}",
                repeat + 1,
                force,
                (4.0, 6.0) if repeat % 2 else (8.0, 10.0),
                float(rng.uniform(0, 30)),
                tuple(point.tolist()),
                tuple(error.tolist()),
                float(np.linalg.norm(error)),
                4.0 / force,
                0.2,
            )
        )
    bad = TouchFigure(len(found) + 1, 500.0, 501.0, False, "slipped", "M2", None, 7.0)
    return [*found, bad]


def verification(probe: Probe, *, passed: bool = True, markers: int = 9) -> Verification:
    all_touches = touches(probe, markers)
    used = [touch for touch in all_touches if touch.accepted]
    errors = 1e-3 * np.array([touch.error_mm for touch in used])

    def by(names: list[str]) -> tuple:
        return summarise_by(names, list(dict.fromkeys(names)), errors)

    shares = zip(list(ErrorCause)[:6], (0.42, 0.06, 0.45, 0.05, 0.02, 0.0), strict=True)
    shares = tuple(sorted((Share(cause, size, 3.0) for cause, size in shares), key=lambda s: -s.share))
    return Verification(
        touches=tuple(all_touches),
        rejected={"slipped": 1},
        per_marker=by([touch.marker for touch in used]),
        per_repeat=by([str(touch.repeat) for touch in used]),
        per_force=by([f"{touch.window_N[0]:g} to {touch.window_N[1]:g} N" for touch in used]),
        per_angle=by(["0 to 15°" if touch.angle_deg < 15 else "15 to 30°" for touch in used]),
        overall=summarise("all", errors),
        ci=intervals(errors, resamples=200, seed=0),
        ratio=1.3,
        times=Times(100, 4e-6, 9e-6),
        force=None,
        verdict=VerificationVerdict(passed, () if passed else ("the mean error is 1.20 mm, over 1 mm",)),
        diagnosis=ErrorDiagnosis(
            ErrorCause.ALIGNMENT,
            "The probe sits 0.4 mm beside where the program believes. Align it again with more points.",
            shares,
            1.1,
        ),
        alignment_refined=Refined(
            ("M1", "M3"), ("M2", "M4"), (0.1, 0.0, 0.2), (0.3, -0.1, 0.0), 0.6, 0.4, 0.6, 0.45, True
        ),
        missing=(),
        limits=VerificationLimits(),
        settings={"samples": 200},
        sources={"recording": "ab" * 32, "markers": "cd" * 32},
    )


def content(*, passed: bool = True, markers: int = 9, facets: int = 1_500) -> ReportContent:
    file = probe_file(facets)
    return ReportContent(
        verification(file.probe, passed=passed, markers=markers),
        file,
        created=CREATED,
        details=ReportDetails("A. Technician", "M8128", "DKD-K-7", "2026-12-31", {"sensor M8128": "SN 7"}),
        session="bench 3",
    )


def with_marker_named(given: ReportContent, name: str) -> ReportContent:
    verified = given.verification
    renamed = tuple(replace(t, marker=name) if t.marker == "M1" else t for t in verified.touches)
    first, *others = verified.per_marker
    return replace(
        given,
        verification=replace(verified, touches=renamed, per_marker=(replace(first, name=name), *others)),
    )
