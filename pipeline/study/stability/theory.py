"""What first-order theory says of a contact, and the contact itself in long double."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.study import hard_meshes as hm

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Bools, Float, Ints, Long

DOUBLE, SINGLE = 2.0**-53, 2.0**-24  # half a unit in the last place of 1


@dataclass(frozen=True, eq=False)
class Touches:
    """
    Wrenches made to touch facets of one body well inside, or as near to their edges as told.

    Attributes
    ----------
    wrenches : (n, 6) N and N·m, S
    points : (n, 3) m, S
    faces : (n,)
    """

    wrenches: Float
    points: Float
    faces: Ints

    def __len__(self) -> int:
        return len(self.faces)

    def take(self, rows: Bools | Ints) -> Touches:
        """Return some of the rows."""
        return Touches(self.wrenches[rows], self.points[rows], self.faces[rows])


def touch(
    body: Body,
    count: int,
    rng: np.random.Generator,
    *,
    angle: tuple[float, float] | Float = (0.0, 60.0),
    arm: float = 0.0003,
    shares: Float | None = None,
    among: Ints | None = None,
) -> Touches:
    """
    Press on facets, 8 to 10 N.

    Parameters
    ----------
    angle, arm
        As for :func:`contactbench.pipeline.study.hard_meshes.press`.
    shares : (count, 3), optional
        Areal coordinates of the points; by default random ones of at least 0.1.
    among : (k,) of facets, optional
        Only these.
    """
    area = np.sqrt(np.einsum("fi,fi->f", body.areas, body.areas)).astype(np.float64)
    faces = np.arange(len(area)) if among is None else among
    chosen = rng.choice(faces, count, p=area[faces] / area[faces].sum())
    if shares is None:
        shares = 0.1 + 0.7 * rng.dirichlet([1.0, 1.0, 1.0], count)
    points = np.einsum("nc,ncx->nx", shares.astype(np.longdouble), body.corners[chosen])
    drawn = hm.press(points, body.normals[chosen], rng, angle=angle, arm=arm)
    return Touches(drawn.wrenches, drawn.points, chosen)


def answers_on(body: Body, faces: Ints, wrenches: Float) -> Long:
    """Return where wrenches (n, 6) put the contact on the planes of `faces` (n,), long double, m."""
    F, M = np.split(wrenches.astype(np.longdouble), 2, axis=1)
    n, a = body.areas[faces], body.corners[faces, 0]
    along = np.einsum("ni,ni->n", n, F)[:, None]
    return np.asarray((np.cross(n, M) + np.einsum("ni,ni->n", n, a)[:, None] * F) / along)


def errors(body: Body, points: Float, faces: Ints, vertices: Ints, wrenches: Float) -> Float:
    """
    Return how far answers (n, 3), m, are from the exact solution on the facet or vertex that they name, m.

    NaN without an answer.
    """
    truth = answers_on(body, np.maximum(faces, 0), wrenches)
    at_vertex = vertices >= 0
    truth[at_vertex] = body.vertices[vertices[at_vertex]]
    off = np.linalg.norm((points - truth).astype(np.float64), axis=1)
    return np.where(np.isfinite(points[:, 0]), off, np.nan)


def moved(normals: Float, points: Float, wrenches: Float, change: Float) -> Float:
    """Return how a change (n, 6) of wrenches moves their contacts, to first order (n, 3), m."""
    dF, dM = np.split(change, 2, axis=1)
    along = np.einsum("ni,ni->n", normals, wrenches[:, :3])[:, None]
    return np.asarray(np.cross(normals, dM - np.cross(points, dF)) / along)


def condition(normals: Float, points: Float, wrenches: Float) -> Float:
    """
    Return how far the contact moves for each unit of relative error of force and torque, at worst (n,), m.

    ``|J_F| |F| + |J_M| |M|`` with spectral norms, J_M = [n]x / (n . F), J_F = -J_M [p]x.
    """
    n, p = _skew(normals), _skew(points)
    along = np.abs(np.einsum("ni,ni->n", normals, wrenches[:, :3]))
    force, torque = (np.linalg.norm(part, axis=1) for part in np.split(wrenches, 2, axis=1))
    by_force = np.linalg.norm(n @ p, ord=2, axis=(1, 2))
    return np.asarray((by_force * force + torque) / along)  # |[n]x| = 1


def nudge(wrenches: Float, size: Float, rng: np.random.Generator) -> Float:
    """Return changes (n, 6) of wrenches: force and torque each by `size` (n,) of its length, any direction."""
    parts = []
    for part in np.split(wrenches, 2, axis=1):
        way = rng.standard_normal(part.shape)
        way *= np.linalg.norm(part, axis=1, keepdims=True) / np.linalg.norm(way, axis=1, keepdims=True)
        parts.append(size[:, None] * way)
    return np.hstack(parts)


def _skew(v: Float) -> Float:
    x, y, z = v.T
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
