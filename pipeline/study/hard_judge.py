"""Every facet judged by d2 as it is defined, and an answer by that: no hierarchy, and no code of the solver.

A touch at p on a facet with normal n leaves M - p x F = k n + an error of covariance B, and k is about 0 by the torsion
arm times |F|. So d2 is the least of ``|B^-1/2 (M - p x F - k n)|² + (k / (arm |F|))²`` over k and over p on the facet:
a least-squares problem, solved inside the facet, on its edges and at its corners, of which the best is taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import Reason
from contactbench.pipeline.gates import BEHIND_M

if TYPE_CHECKING:
    from contactbench.pipeline.contact import Contact, ContactSolver
    from contactbench.pipeline.study.hard_meshes import Bools, Float, Ints

_STEEPEST = 1e-3  # cosine: what is edge-on answers no wrench
_LEAST = 1e-6  # deviation that is always expected, of the mesh's size
_BORDER = 1.75  # mesh sizes: errors of axes further away are those of axes there
_SHARP = np.radians(40.0)
_GRAZING = 89.0  # degrees: steeper, a graze and a miss are one
_SAME_TOUCH, _MOST_PLACES = 4.5, 8
_D2, _POINT_M = 1e-6, 1e-9  # rounding


@dataclass(frozen=True, eq=False)
class FacetFits:
    """The best touch of each facet: d2 (m,), infinite outside the friction cone, and where, (m, 3) m."""

    d2: Float
    points: Float


class CaseJudge:
    """Judges the answers that a solver gives without regions and previous contacts."""

    def __init__(self, solver: ContactSolver) -> None:
        probe, model = solver.probe, solver.model
        self.gates, self.arm, self.noise = solver.gates, model.torsion_arm, solver.covariance
        self.corners = np.asarray(probe.vertices)[probe.faces]
        a, b, c = np.moveaxis(self.corners, 1, 0)
        areas = np.cross(b - a, c - a)
        self.normals = areas / np.linalg.norm(areas, axis=1, keepdims=True)
        low, high = self.corners.min(axis=(0, 1)), self.corners.max(axis=(0, 1))
        self.centre, self.size = (low + high) / 2, float((high - low).max() / 2)
        turn, arch = self._curvature(np.asarray(probe.faces)) if model.mesh_curved else np.zeros((2, len(a)))
        self.spread, self.bend = (0.7 / 8 * arch) ** 2 + model.mesh_deviation**2, (turn / 2) ** 2

    def fits(self, wrench: Float, friction_angle: float) -> FacetFits:
        """Judge every facet by a wrench (6,), N and N·m, S; degrees."""
        F, M = wrench[:3], wrench[3:]
        size, f = np.linalg.norm(F), F / np.linalg.norm(F)
        cosine = -(self.normals @ f)
        cone = cosine >= max(np.cos(np.radians(friction_angle)), _STEEPEST)
        faces = np.flatnonzero(cone)
        corners, n = self.corners[faces], self.normals[faces]
        foot = self.centre + np.cross(F, M - np.cross(self.centre, F)) / size**2
        depths = (corners - foot) @ f
        met = np.einsum("mi,mi->m", n, corners[:, 0] - foot) / -cosine[faces]
        depth = np.clip(met, depths.min(axis=1), depths.max(axis=1))
        whiten = self._whiten(faces, wrench, foot, depth)
        left = np.einsum("mij,mcj->mci", whiten, M - np.cross(corners, F))
        twist = self.arm * size * np.einsum("mij,mj->mi", whiten, n)
        # Rows: what is left in deviations, and k in its own.
        k = np.concatenate([-twist, np.ones((len(n), 1))], axis=1)[:, :, None]
        left = np.concatenate([left, np.zeros((*left.shape[:2], 1))], axis=2)
        d2, shares = np.full(len(n), np.inf), np.zeros((len(n), 3))

        def offer(tried: Float, where: Bools) -> None:
            at = np.einsum("mc,mci->mi", tried, left)
            rest = at + np.einsum("mik,mk->mi", k, _least(k, at))
            value = np.where(where, np.einsum("mi,mi->m", rest, rest), np.inf)
            better = value < d2
            d2[better], shares[better] = value[better], tried[better]

        inside = _least(
            np.concatenate([left[:, 1:].swapaxes(1, 2) - left[:, :1].swapaxes(1, 2), k], axis=2), left[:, 0]
        )
        tried = np.column_stack([1 - inside[:, 0] - inside[:, 1], inside[:, :2]])
        offer(tried, np.asarray((tried >= 0).all(axis=1)))
        for i in range(3):
            j = (i + 1) % 3
            along = _least(np.concatenate([(left[:, j] - left[:, i])[:, :, None], k], axis=2), left[:, i])
            tried = np.zeros((len(n), 3))
            tried[:, j] = np.clip(along[:, 0], 0.0, 1.0)  # convex: clipped is a corner
            tried[:, i] = 1 - tried[:, j]
            offer(tried, np.ones(len(n), dtype=bool))
        every = FacetFits(np.full(len(cone), np.inf), np.full((len(cone), 3), np.nan))
        every.d2[faces], every.points[faces] = d2, np.einsum("mc,mci->mi", shares, corners)
        return every

    def faults(self, wrench: Float, found: Contact) -> list[str]:
        """Return what is wrong with an answer, in words; nothing when it is right."""
        gates, cost = self.gates, self.gates.kernel_values()
        fits = self.fits(wrench, gates.friction_angle)
        d2, points, behind, most = fits.d2, fits.points, cost["behind_cost"], cost["implausible_misfit"]
        likely = np.flatnonzero(d2 <= most - _D2)
        if found.point is None or found.face is None:
            least = d2.min(initial=np.inf)
            if len(likely) or (np.isfinite(least) and not abs(found.misfit - least) <= _D2 * (1 + least)):
                return ["refused, or by how much, without cause"]
            steeper = self.fits(wrench, max(_GRAZING, gates.friction_angle)).d2.min(initial=np.inf)
            why = Reason.IMPLAUSIBLE if np.isfinite(least) else Reason.OFF_SURFACE
            why = Reason.TANGENTIAL if steeper <= most else why
            return (
                []
                if found.reason == why or abs(steeper - most) <= _D2
                else [f"refused, but not as {why.name}"]
            )
        places = [(found.face, found.point), *((c.face, c.point) for c in found.candidates)]
        faces, at = np.array([face for face, _ in places]), np.array([point for _, point in places])
        across = np.array([self.across(wrench, face, point) for face, point in places])
        f = wrench[:3] / np.linalg.norm(wrench[:3])
        cosines = -self.normals[faces] @ f
        slopes = f + cosines[:, None] * self.normals[faces]

        def apart(i: int, others: Float) -> Float:
            away = others - at[i]
            return np.asarray(np.sqrt(np.maximum(np.sum(away**2, axis=1) - (away @ slopes[i]) ** 2, 0.0)))

        said = np.array([found.misfit, *(c.misfit for c in found.candidates)])
        wrong = []
        if not np.all(np.abs(said - d2[faces]) <= _D2 * (1 + said)):
            wrong.append("d2 is another")
        if not np.all(np.linalg.norm(at - points[faces], axis=1) <= _POINT_M + _D2 * across / cosines):
            wrong.append("not the best point of its facet")
        radii = np.maximum(gates.ambiguity_distance, _SAME_TOUCH * across)
        depth = at @ f
        in_front = depth[:, None] - depth > BEHIND_M
        hidden = in_front & (d2[faces] <= d2[faces][:, None] + behind)
        left = likely[
            d2[likely] <= d2.min() + cost["rival_cost"] + behind * bool(hidden.any(axis=1)[0]) - _D2
        ]
        # Each the best of what lies outside the places of those before it, and nothing left in the end.
        for i in np.argsort(d2[faces], kind="stable"):
            if d2[faces[i]] > d2[left].min(initial=np.inf) + _D2:
                wrong.append("another facet is likelier")
            left = left[apart(i, points[left]) > radii[i] + _POINT_M]
        if len(left) and len(places) < _MOST_PLACES:
            wrong.append("a place that explains it is neither the point nor a candidate")
        total = d2[faces] + behind * hidden.any(axis=1)
        rival = total[1:] - total[0]
        if np.any(total[1:] < total[0] - _D2):
            wrong.append("a candidate is likelier")
        doubt = rival.min(initial=np.inf) - cost["rival_cost"]
        if abs(doubt) > _D2 and (doubt < 0) != (found.reason == Reason.AMBIGUOUS):
            wrong.append("sure, though another place would do, or the other way about")
        if not abs(found.confidence - 1 / (1 + np.exp(-rival / 2).sum())) <= _D2:
            wrong.append("the confidence is another")
        return wrong

    def across(self, wrench: Float, face: int, point: Float) -> float:
        """Return the largest standard deviation, m, of a touch on a facet's plane, seen along the force."""
        n, F = self.normals[face], wrench[:3]
        whiten = self._whiten(np.array([face]), wrench, point, np.zeros(1))[0]
        plane = np.linalg.svd(n[None])[2][1:]
        moved = np.column_stack([whiten @ np.cross(F, t) for t in plane])
        twist = whiten @ n * self.arm * np.linalg.norm(F)
        rows = np.vstack([np.column_stack([twist, moved]), [1.0, 0.0, 0.0]])
        # k first: what it leaves of the plane is the last block.
        spread = np.linalg.inv(np.linalg.qr(rows)[1][1:, 1:])
        return float(np.linalg.norm(np.linalg.svd(F[None])[2][1:] @ plane.T @ spread, 2))

    def _whiten(self, faces: Ints, wrench: Float, start: Float, depth: Float) -> Float:
        """Return B^-1/2 (m, 3, 3) of facets, so far along the force from a point: wrench, mesh, and a little."""
        F, M = wrench[:3], wrench[3:]
        size, f = np.linalg.norm(F), F / np.linalg.norm(F)
        foot = np.cross(f, np.cross(start - self.centre, f))
        away = max(1.0, float(np.linalg.norm(foot)) / (_BORDER * self.size))
        p = start + foot * (1 / away - 1) + depth[:, None] * f
        x, y, z = p.T
        zero = np.zeros_like(x)
        to_wrench = np.zeros((len(p), 3, 6))
        to_wrench[:, :, :3] = -np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
        to_wrench[:, :, 3:] = np.eye(3)
        n = self.normals[faces]
        moved, turned = np.cross(n, F), (M @ f / (n @ f)) ** 2 * self.bend[faces]
        covariance = to_wrench @ self.noise @ to_wrench.swapaxes(1, 2)
        covariance += (_LEAST * size * self.size) ** 2 * np.eye(3)
        covariance += self.spread[faces, None, None] * moved[:, :, None] * moved[:, None, :]
        covariance += turned[:, None, None] * (np.eye(3) - np.outer(f, f))
        return np.asarray(np.linalg.inv(np.linalg.cholesky(covariance)))

    def _curvature(self, faces: Ints) -> tuple[Float, Float]:
        """Return each facet's largest turn to a neighbour (m,), rad, and turn times distance (m,), m; no sharp ones."""
        turn, arch = np.zeros((2, len(faces)))
        start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
        twin = {edge: i // 3 for i, edge in enumerate(zip(end.tolist(), start.tolist(), strict=True))}
        middles = self.corners.mean(axis=1)
        for i, edge in enumerate(zip(start.tolist(), end.tolist(), strict=True)):
            f, g = i // 3, twin.get(edge)
            theta = np.pi if g is None else np.arccos(min(1.0, self.normals[f] @ self.normals[g]))
            if theta <= _SHARP:
                turn[f] = max(turn[f], theta)
                arch[f] = max(arch[f], theta * np.linalg.norm(middles[f] - middles[g]))
        return turn, arch


def _least(columns: Float, start: Float) -> Float:
    """Return what of the columns (m, 4, j), added to start (m, 4), leaves least."""
    size = np.linalg.norm(columns, axis=1)
    size[size == 0] = 1.0
    q, r = np.linalg.qr(columns / size[:, None])
    # A column that the others give already is not needed: it happens only where a facet is seen edge-on.
    flat = np.abs(np.einsum("mjj->mj", r)) < np.finfo(float).tiny
    r[flat[:, :, None] & np.eye(r.shape[1], dtype=bool)] = 1.0
    return np.asarray(-np.linalg.solve(r, np.einsum("mij,mi->mj", q, start)[:, :, None])[:, :, 0] / size)
