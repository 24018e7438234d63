"""What to fix first, in a paragraph; and an alignment refined from the touches themselves."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.verification import causes
from contactbench.pipeline.verification.causes import (
    CONFIRMED,
    EVIDENCE,
    Explained,
    TouchEvidence,
    alignment_columns,
    explain,
    sensitivities,
)
from contactbench.pipeline.verification.figures import DriftTaken, ErrorCause, ErrorDiagnosis, Refined, Share
from contactbench.pipeline.verification.markers import MarkerSet
from contactbench.pipeline.verification.statistics import vector

FEWEST_TOUCHES = 6
_FEWEST_MARKERS = 6  # three on each side
_TRUST = 0.0005  # m: what is left when the alignment is right
_USUAL = np.repeat([np.radians(2.0), 0.003], 3)
_RELOCATIONS = 6
_BETTER = 0.9
_THERE = 0.3  # of its error: a touch that is nearer to another marker belongs to that
_MOST_ODDS = 1e6  # that are told
_SAME_FACE, _NEARLY = 0.5, 0.7  # cosine between normals of one face; share of the touches that are nearly all
_MISPLACED = 3.0  # times the usual: such a marker stands out

_REMEDIES = {
    causes.ALIGNMENT: message(
        "Realign the probe with touches on all of its sides. If the refined alignment helps, it is enough."
    ),
    causes.CABLE: message(
        "Something pulls that stays in the room: loosen cables and hoses, fix them to the flange, and recalibrate."
    ),
    causes.DRIFT: message(
        "The sensor's zero drifts from touch to touch: let it warm up and recalibrate, or let the zero follow."
    ),
    causes.SCALE: message(
        "Mesh and markers seem to have another scale than the probe: check the unit of the mesh file, and measure"
        " the probe."
    ),
    causes.LEAN: message(
        "The contact moves as that of a ball that leans: press along the surface's normal, or with a sharper tip."
    ),
    **dict.fromkeys(
        (causes.GAIN, causes.CROSSTALK),
        message(
            "Contacts move in proportion to the load, as with a wrong gain or crosstalk of the sensor: hang a known"
            " weight on the tool to see it, and have the sensor recalibrated."
        ),
    ),
    causes.STRANGE: message(
        "No cause that is known here explains so much: check the units, the gains and the signs of the sensor, its"
        " mount, and what else touched the probe."
    ),
    causes.GRAVITY: message(
        "Recalibrate bias and weight with poses tilted about two axes, with the sensor warm and"
        " the cable routed as in use."
    ),
    causes.REST: message(
        "Average more samples, use a stronger filter or press harder. Look for vibration, and for"
        " markers that were not hit exactly."
    ),
    causes.MESH: message(
        "Use a finer mesh, or rescan the probe where the markers do not lie on its surface."
    ),
    causes.TORSION: message(
        "Press with a tip that turns freely and does not grip, or at smaller angles: the torque"
        " at the contact is not about the surface normal."
    ),
    causes.MOUNT: message(
        "The probe rotates against its sensor under load: tighten or stiffen its mount, then"
        " realign and verify again."
    ),
    causes.LOOP: message(
        "Touches differ by more than their own noise, and not as a wrong weight, alignment, mesh"
        " or marker would make them: hysteresis or creep of the sensor, a dragging cable, or a"
        " hand on the handle. More samples do not help. Let the sensor rest between touches,"
        " route the cable freely, and hold nothing else."
    ),
    causes.LEFT: message(
        "The zero drifts more than was seen between touches: lift the probe clear for half a second before"
        " each, and let the sensor warm up."
    ),
}
_DRIFT_IS_OFF = message(
    "Recalibrate bias and weight with poses tilted about two axes. Drift is already subtracted: a warmer"
    " sensor does not help."
)
# What was told before there were others; those are listed where they are found.
_LISTED = tuple(ErrorCause)[:6]


def diagnose(
    evidence: TouchEvidence, within: bool, names: Sequence[str] = (), passed: bool | None = None
) -> ErrorDiagnosis:
    """
    Rank the causes of the errors of accepted touches.

    Parameters
    ----------
    evidence : TouchEvidence
    within : bool
        Whether the errors keep the limits.
    names : sequence of str
        Of the markers; left out, they are counted from 1.
    passed : bool, optional
        Whether the verification did; left out: where the errors keep the limits.
    """
    if pairs := _swapped(evidence):
        return _of_labels(evidence, pairs, names)
    evidence = _on_their_faces(evidence)
    found = explain(evidence)
    shares = _told(found.shares, found)
    remedy = message("No action needed.")
    if within and passed is False:
        remedy = message("What fails the verification is not the size of the errors: see its reasons.")
    drift = None if evidence.taken is None else _taken(evidence, evidence.taken, found)
    if not within:
        remedies = {**_REMEDIES, causes.GRAVITY: _DRIFT_IS_OFF} if drift else _REMEDIES
        remedy = _undecided(found) or remedies.get(found.kind) or _places(evidence, found, names)
    text = message(f"{arg(_paragraph(shares, found, within))} {arg(remedy)}")
    if drift:
        text = message(f"{arg(text)} {arg(_drift_words(drift, found))}")
    return ErrorDiagnosis(found.first, text, shares, found.scale, drift)


def _taken(evidence: TouchEvidence, taken: NDArray[np.float64], found: Explained) -> DriftTaken:
    """Say how much drift was taken off, and whether that was right."""
    moved = np.einsum("nij,nj->ni", evidence.sensitivities, taken)
    force, torque, size = (
        float(np.sqrt((part**2).sum(axis=1).mean())) for part in (taken[:, :3], taken[:, 3:], 1e3 * moved)
    )
    return DriftTaken(force, torque, size, found.log_taken)


def _drift_words(drift: DriftTaken, found: Explained) -> str:
    """Say how much drift was taken off, whether that was right, and what of it is left."""
    odds = min(float(np.exp(min(abs(drift.evidence), 50.0))), _MOST_ODDS)
    judged = message("these touches do not tell whether that helps")
    if drift.evidence >= EVIDENCE:
        judged = message(f"the errors speak for that, {arg(odds):,.0f} to 1")
    elif drift.evidence <= -EVIDENCE:
        judged = message(f"the errors speak against that, {arg(odds):,.0f} to 1: verify as calibrated")
    share = found.shares[ErrorCause.DRIFT]
    left = message("no drift shows in what is left")
    if share > 0:
        left = message(f"drift explains {arg(100 * share):.0f} % of what is left")
    return message(
        f"The zero that follows took off {arg(drift.force_N):.2g} N and {arg(1e3 * drift.torque_Nm):.2g} mN·m of"
        f" drift, which would move the contacts by {arg(drift.moved_mm):.2g} mm; {arg(judged)}; {arg(left)}."
    )


def _on_their_faces(evidence: TouchEvidence) -> TouchEvidence:
    """Leave out the few touches that were located on another face: what a cause does there is not linear."""
    facets = evidence.normals if evidence.facets is None else evidence.facets
    near = np.einsum("ni,ni->n", facets, evidence.normals) > _SAME_FACE
    return evidence.only(near) if near.mean() >= _NEARLY else evidence


def _told(shares: Mapping[ErrorCause, float], found: Explained) -> tuple[Share, ...]:
    return tuple(
        Share(cause, share, found.gains[cause])
        for cause, share in sorted(shares.items(), key=lambda each: -each[1])
        if share > 0 or cause in _LISTED
    )


def _paragraph(shares: tuple[Share, ...], found: Explained, within: bool) -> str:
    first = shares[0]
    named = join(message(" or "), (first.cause, *found.rivals))
    part = message("most") if first.share > 0.5 else message("the largest part")
    start = message(f"Fix first: {arg(named)}. It explains {arg(part)} of the squared error")
    if within:
        start = message(
            f"The errors are within the limits; {arg(part)} of the remaining error comes from {arg(named)}"
        )
    others = [
        message(f"{arg(each.cause)} {arg(100 * each.share):.0f} %")
        for each in shares[1:]
        if each.share >= CONFIRMED
    ]
    also = "" if found.rivals else message("; no other cause shows")
    if others:
        also = message(f"; then {arg(join(', ', others))}")
    left = message(f" The unexplained scatter is {arg(found.scale):.1f} times the expected noise.")
    return message(f"{arg(start)} ({arg(100 * first.share):.0f} %{arg(also)}).{arg(left)}")


def _undecided(found: Explained) -> str:
    """Return what would tell the first cause from those that might as well be it; empty: there are none."""
    if not found.rivals:
        return ""
    if {found.first, *found.rivals} == {ErrorCause.ALIGNMENT, ErrorCause.GRAVITY}:
        more = message("touch in a second orientation, or on other sides.")
    else:
        more = message("touch more markers, from other angles and in other orientations.")
    return message(f"These touches cannot tell which it is; {arg(more)}")


def _swapped(evidence: TouchEvidence) -> list[tuple[int, int]]:
    """Return the pairs of markers, as rows of the unique ones, each touched where the other is said to be."""
    _, rows, place = np.unique(evidence.markers, return_index=True, return_inverse=True)
    said = evidence.points[rows]
    touched = np.array(
        [np.median((evidence.points + evidence.errors)[place == k], axis=0) for k in range(len(rows))]
    )
    apart = np.linalg.norm(touched[:, None] - said, axis=2)
    nearest = apart.argmin(axis=1)
    own = np.arange(len(rows))
    there = (nearest != own) & (apart[own, nearest] < _THERE * apart[own, own]) & (nearest[nearest] == own)
    return [(int(k), int(nearest[k])) for k in own if k < nearest[k] and there[k] and there[nearest[k]]]


def _of_labels(evidence: TouchEvidence, pairs: list[tuple[int, int]], names: Sequence[str]) -> ErrorDiagnosis:
    """Say which labels are swapped; what is left when they are put right has the other causes."""
    markers, rows, place = np.unique(evidence.markers, return_index=True, return_inverse=True)
    right = np.arange(len(rows))
    for one, other in pairs:
        right[[one, other]] = other, one
    there = rows[right][place]
    mended = replace(
        evidence,
        errors=evidence.points + evidence.errors - evidence.points[there],
        markers=evidence.markers[there],
        points=evidence.points[there],
        normals=evidence.normals[there],
        heights=evidence.heights[there],
    )
    found = explain(mended)
    rest = min(float((mended.errors**2).sum() / (evidence.errors**2).sum()), 1.0)
    shares = {cause: rest * share for cause, share in found.shares.items()}
    shares[ErrorCause.MARKERS] += 1 - rest
    called = [names[int(each)] if names else str(each + 1) for each in markers]
    said = join("; ", (message(f"{arg(called[a])} and {arg(called[b])}") for a, b in pairs))
    text = message(
        f"Fix first: the labels of markers are swapped: {arg(said)}. Each was touched where the other is said to"
        f" be, which explains {arg(100 * (1 - rest)):.0f} % of the squared error. Swap them, and verify again."
    )
    return ErrorDiagnosis(ErrorCause.MARKERS, text, _told(shares, found), found.scale)


def _places(evidence: TouchEvidence, found: Explained, names: Sequence[str]) -> str:
    """Return which markers to look at: those that stand out, or all."""
    markers, rows = np.unique(evidence.markers, return_index=True)
    moved = found.moved[rows]
    # What is a tenth of the largest is not what anybody looks for: a ball that leans moves all of them a little.
    least = max(_MISPLACED * float(np.median(moved)), 0.1 * float(moved.max()))
    out = [int(each) for each in markers[moved > least]]
    called = [names[each] if names else str(each + 1) for each in out]
    which = message(f" {arg(', '.join(called))}") if called else ""
    several = message("markers") if out else message("the markers")
    them = message("the marker") if len(out) == 1 else several
    return message(
        "The error is the same at each touch of a marker but differs between markers: check the"
        f" positions of {arg(them)}{arg(which)}."
    )


def refine(evidence: TouchEvidence, solver: ContactSolver, markers: MarkerSet) -> Refined | None:
    """
    Correct the alignment on every second marker, and judge it on the others; None: too few markers.

    The wrenches are moved into the corrected probe's frame and located anew, until nothing changes (Gauss-Newton on
    the six numbers of a rigid motion, with what is usual as a prior: a flat face does not show all six). It helps only
    where the diagnosis says that it is the alignment: six numbers make up for much that another cause did, on these
    touches and not on the next.
    """
    touched = np.unique(evidence.markers)
    if len(touched) < _FEWEST_MARKERS:
        return None
    halves = touched[::2], touched[1::2]
    fit, judge = (evidence.only(np.isin(evidence.markers, half)) for half in halves)
    R, t = _fitted(fit, solver)
    sizes = [
        float(np.linalg.norm(each, axis=1).mean() * 1e3)
        for each in (fit.errors, _errors(fit, solver, R, t), judge.errors, _errors(judge, solver, R, t))
    ]
    fitted, judged = (tuple(markers[int(place)].name for place in half) for half in halves)
    turn = np.degrees(Rotation.from_matrix(R).as_rotvec())
    return Refined(
        fitted=fitted,
        judged=judged,
        turn_deg=vector(turn),
        shift_mm=vector(1e3 * t),
        fitted_before_mm=sizes[0],
        fitted_after_mm=sizes[1],
        judged_before_mm=sizes[2],
        judged_after_mm=sizes[3],
        helps=sizes[3] < _BETTER * sizes[2] and explain(evidence).aligned,
    )


def _fitted(fit: TouchEvidence, solver: ContactSolver) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return R and t of p_new = R p + t."""
    x, prior = np.zeros(6), np.diag((_TRUST / _USUAL) ** 2)
    for _ in range(_RELOCATIONS):
        R, t = Rotation.from_rotvec(x[:3]).as_matrix(), x[3:]
        wrenches = _moved(fit.wrenches, R, t)
        errors = _located(wrenches, solver, fit.points) - fit.points
        known = np.isfinite(errors).all(axis=1)
        J = sensitivities(fit.points[known], fit.normals[known], wrenches[known, :3])
        A = alignment_columns(J, wrenches[known]).reshape(-1, 6)
        step = np.linalg.solve(A.T @ A + prior, -A.T @ errors[known].ravel() - prior @ x)
        x = x + step
        if np.abs(step / _USUAL).max() < 1e-4:
            break
    return Rotation.from_rotvec(x[:3]).as_matrix(), x[3:]


def _errors(
    evidence: TouchEvidence, solver: ContactSolver, R: NDArray[np.float64], t: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the errors (n, 3) with a corrected alignment; where nothing is located any more, the old ones."""
    found = _located(_moved(evidence.wrenches, R, t), solver, evidence.points) - evidence.points
    return np.where(np.isfinite(found), found, evidence.errors)


def _moved(
    wrenches: NDArray[np.float64], R: NDArray[np.float64], t: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return wrenches in the frame of a probe that lies at R, t."""
    F, M = wrenches[:, :3], wrenches[:, 3:]
    return np.concatenate([F @ R, (M - np.cross(t, F)) @ R], axis=1)


def _located(
    wrenches: NDArray[np.float64], solver: ContactSolver, near: NDArray[np.float64]
) -> NDArray[np.float64]:
    return np.array(solver.locate_batch_after(np.ascontiguousarray(wrenches), near).points)
