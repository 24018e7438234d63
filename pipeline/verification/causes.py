"""How much of the errors each cause explains: linear models of what it would do, compared by likelihood."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.model import cross_matrix, prediction_jacobian
from contactbench.pipeline.calibration.suggest import contact_sensitivity
from contactbench.pipeline.preparation.alignment.alignment import across
from contactbench.pipeline.verification.figures import ErrorCause

Array = NDArray[np.float64]

# What each cause usually comes to, one standard deviation; the likelihood chooses the size in steps around it.
_TURN, _SHIFT = np.radians(1.5), 0.0015  # rad and m of a probe on its sensor
_WEIGHT, _FORCE_BIAS, _CENTRE, _TORQUE_BIAS = 0.2, 0.2, 0.003, 0.010  # N, N, m, N·m
_YIELD = 0.008  # rad/(N·m) of a mount
# N and N·m that a sensor reads otherwise on its way up than on its way down
_LOOP = np.repeat([0.06, 0.0024], 3)
# Error of a gain; share of a channel that shows in another; m that goes with a share of a torque.
_GAIN, _MIXED, _LEVER = 0.03, 0.003, 0.05
_UNSEEN = np.repeat([0.1, 0.004], 3)  # N and N·m of drift that a zero that follows has not seen
_HEIGHT = 0.0003  # m of the mesh at a marker, beyond what the marker itself says
_SIZES = (0.1, 0.3, 1.0, 3.0)
_SCALES = np.geomspace(0.3, 100.0, 50)  # of the noise
_DRIFT = np.repeat([0.3, 0.010], 3)  # N and N·m of a zero, from the first touch to the last
_PULL, _AT = 0.3, 0.1  # N of a cable, and m from the sensor
_STRETCH = 0.03  # of the mesh's scale
_FLOOR = 5e-5  # m: nobody places a marker better
_FEWEST_MARKERS = 5
_PLACE = 0.001  # m of a marker along the surface
_TIP = 0.002  # m: radius of a ball that is aimed at it
EVIDENCE = 4.0  # gain of log likelihood that is not chance
CONFIRMED = 0.05  # share of a cause that is worth a word
# Times the noise within touches, and times any: what scatters more between them is not noise.
_RESTLESS, _ABSURD = 1.5, 10.0
_ONE_ORIENTATION, _ONE_WAY = np.cos(np.radians([10.0, 45.0]))  # of the sensor, and of the forces
# The kinds of causes; a zero drifts without one that follows, and is left drifting by one.
ALIGNMENT, GRAVITY, DRIFT, LEFT, CABLE = "alignment", "gravity", "drift", "left drift", "cable"
MESH, SCALE, TORSION, MOUNT, LOOP = "mesh", "scale", "torsion", "mount", "hysteresis"
GAIN, CROSSTALK, LEAN, PLACES = "gain", "crosstalk", "lean", "places"
REST, STRANGE = "rest", "strange"  # what no kind explains, and what is more of it than any noise makes


@dataclass(frozen=True, eq=False)
class TouchEvidence:
    """Accepted touches, n of them, in the order of time."""

    errors: Array  # (n, 3) located minus marker, S, m
    markers: NDArray[np.intp]  # (n,) which marker
    # (n, 3) of these markers, S
    points: Array
    normals: Array
    heights: Array  # (n,) of these markers over the mesh, m
    wrenches: Array  # (n, 6) compensated means, S
    R_WS: Array  # (n, 3, 3)
    torques: Array  # (n,) located local torques, N·m
    noise: Array  # (6, 6) covariance of such a mean by the sensor's noise alone
    theta: Array  # (12,) parameters of the calibration
    measured: bool = False  # whether the noise is what was seen within the touches, not what somebody said
    # (n, 3) normals where the touches were located, S; None: those of the markers
    facets: Array | None = None
    starts: Array | None = None  # (n,) s; None: not known
    taken: Array | None = None  # (n, 6) what a zero that follows took off, S; None: it does not follow

    def only(self, kept: NDArray[np.bool_] | NDArray[np.intp]) -> TouchEvidence:
        """Return some of the touches, or all in another order."""
        whole = {"noise", "theta", "measured"}
        given = {each.name: getattr(self, each.name) for each in fields(self) if each.name not in whole}
        rows: dict[str, Any] = {name: each[kept] for name, each in given.items() if each is not None}
        return replace(self, **rows)

    @property
    def along(self) -> Array:
        """(n, 3) along the force, as far as leads 1 m along the marker's normal."""
        F = self.wrenches[:, :3]
        return np.asarray(F / np.einsum("nk,nk->n", F, self.normals)[:, None])

    @property
    def sensitivities(self) -> Array:
        """(n, 3, 6) how each contact moves with its wrench, m/N and m/(N·m)."""
        return sensitivities(self.points, self.normals, self.wrenches[:, :3])


@dataclass(frozen=True)
class Explained:
    """What the errors bear the marks of."""

    shares: dict[ErrorCause, float]  # Of the squared error; 1 together
    gains: dict[ErrorCause, float]  # Of log likelihood, by allowing for this cause alone
    scale: float  # Of the noise
    # What explains the errors about as well as the cause with the largest share
    rivals: tuple[ErrorCause, ...]
    # (n,) how far the marker of each touch seems to be from its place, m; 0 unless the markers are a cause
    moved: Array
    kind: str  # Of the first cause
    # Of the odds that a zero that follows took off what was drift, whatever explains the rest
    log_taken: float

    @property
    def first(self) -> ErrorCause:
        """The cause with the largest share."""
        return max(self.shares, key=lambda cause: self.shares[cause])

    @property
    def aligned(self) -> bool:
        """Whether correcting the alignment would not cure what another cause did."""
        told = self.first is not ErrorCause.ALIGNMENT or not self.rivals
        return (
            self.shares[ErrorCause.ALIGNMENT] >= CONFIRMED
            and told
            and ErrorCause.ALIGNMENT not in self.rivals
        )


def sensitivities(points: Array, normals: Array, forces: Array) -> Array:
    """Return (n, 3, 6) how contacts at `points` move with their wrenches."""
    rows = [contact_sensitivity(p, n, F[None])[0] for p, n, F in zip(points, normals, forces, strict=True)]
    return np.array(rows).reshape(-1, 3, 6)


def alignment_columns(J: Array, wrenches: Array) -> Array:
    """
    Return (n, 3, 6) how contacts move when the probe is turned by omega (rad) and shifted by t (m) under a wrench.

    In the probe's frame the wrench becomes F - omega x F, M - omega x M - t x F.
    """
    A = np.zeros((len(wrenches), 6, 6))
    A[:, :3, :3] = A[:, 3:, 3:] = cross_matrix(wrenches[:, :3])
    A[:, 3:, :3] = cross_matrix(wrenches[:, 3:])
    return J @ A


def explain(evidence: TouchEvidence) -> Explained:
    """
    Ask which causes the errors bear the marks of, and how much of their squares each explains.

    The errors are taken as Gaussian: noise of the predicted shape and unknown size, and for each allowed cause its
    columns with normally distributed sizes. Causes are allowed for one after the other, the one first that raises
    the likelihood most, with all sizes integrated out, so that a cause with many unknowns has no advantage.
    """
    J = evidence.sensitivities
    whiten = _whitening(J @ evidence.noise @ J.transpose(0, 2, 1))
    repeated = _repeated(evidence.markers)
    # What drifts evenly is a part of what a zero that follows has left.
    without = {DRIFT if evidence.taken is not None else LEFT, *(() if repeated else (PLACES,))}
    columns = {kind: make(evidence, J) for kind, (_, make, _) in _KINDS.items() if kind not in without}
    y = np.einsum("nij,nj->ni", whiten, evidence.errors).ravel()
    Z = {kind: (whiten @ X).reshape(len(y), -1) for kind, X in columns.items()}
    base, scale = _likelihood(y, np.zeros((len(y), 0)))
    chosen: dict[str, float] = {}
    best = base
    gains = dict.fromkeys(ErrorCause, 0.0)
    while len(chosen) < len(Z):
        tries = [
            (*_likelihood(y, _stack(Z, {**chosen, kind: size})), kind, size)
            for kind in Z
            if kind not in chosen
            for size in _SIZES
        ]
        if not chosen:
            for value, _, kind, _ in tries:
                gains[_cause(kind)] = max(gains[_cause(kind)], float(value - base))
        value, new_scale, kind, size = max(tries, key=lambda each: each[0] - _KINDS[each[2]][2])
        if value - _KINDS[kind][2] - best < EVIDENCE:
            break
        best, scale, chosen[kind] = value, new_scale, size
    parts = _parts(y, Z, columns, chosen, scale)
    of_kinds = _shares(evidence.errors, parts)
    # Noise that was measured within touches and is too little for what lies between them is not noise.
    rest = REST
    if scale > (_RESTLESS if evidence.measured else _ABSURD):
        rest = STRANGE if scale > _ABSURD else LOOP
        of_kinds[rest] = of_kinds.get(rest, 0.0) + of_kinds.pop(REST)
    shares = dict.fromkeys(ErrorCause, 0.0)
    for kind, share in of_kinds.items():
        shares[_cause(kind)] += share
    first = max(shares, key=lambda cause: shares[cause])
    # What raised the likelihood first: of kinds that are alike, shares go by their unknowns.
    own = [each for each in chosen if _cause(each) is first]
    kind = rest if _cause(rest) is first and (not own or of_kinds[own[0]] < of_kinds[rest]) else own[0]
    moved = np.linalg.norm(parts.get(PLACES, np.zeros((len(J), 3))), axis=1)
    rivals = _rivals(first, gains, {_cause(each) for each in chosen}, evidence)
    return Explained(
        shares, gains, scale, rivals, moved, kind, _rightly_taken(evidence, J, y, whiten, Z, chosen)
    )


def _rightly_taken(
    evidence: TouchEvidence, J: Array, y: Array, whiten: Array, Z: dict[str, Array], chosen: dict[str, float]
) -> float:
    """Compare the errors with those that there would be with the drift left in, which a drift may explain too."""
    if evidence.taken is None:
        return 0.0
    moved = np.einsum("nij,njk,nk->ni", whiten, J, evidence.taken).ravel()
    drift = (whiten @ _drift(evidence, J)).reshape(len(y), -1)
    rest = {kind: size for kind, size in chosen.items() if kind != LEFT}
    tries = [_stack({**Z, DRIFT: drift}, {**rest, DRIFT: size}) for size in (0.0, *_SIZES)]
    off, on = (max(_likelihood(each, columns)[0] for columns in tries) for each in (y, y + moved))
    return off - on


def _rivals(
    first: ErrorCause, gains: dict[ErrorCause, float], chosen: set[ErrorCause], evidence: TouchEvidence
) -> tuple[ErrorCause, ...]:
    """Return the causes that might as well be the first one; one that adds to it is none."""
    if first in (ErrorCause.NOISE, ErrorCause.SENSOR):
        return ()
    able = [cause for cause in gains if cause is not first and gains[cause] >= EVIDENCE]
    close = [c for c in able if c not in chosen and gains[c] > gains[first] - EVIDENCE]
    # Pressed one way in one orientation, a wrench that is turned and one that is shifted differ by next to nothing:
    # what the likelihood makes of the little is not to be relied on.
    pair = {ErrorCause.ALIGNMENT, ErrorCause.GRAVITY}
    if first in pair and _one_way(evidence):
        close += [cause for cause in able if cause in pair and cause not in close]
    return tuple(close)


def _one_way(evidence: TouchEvidence) -> bool:
    """Tell whether all touches were made in one orientation, and pressed one way."""
    F = evidence.wrenches[:, :3] / np.linalg.norm(evidence.wrenches[:, :3], axis=1, keepdims=True)
    cosines = 0.5 * (np.einsum("nij,ij->n", evidence.R_WS, evidence.R_WS[0]) - 1)
    mean = F.mean(axis=0)
    return bool(cosines.min() > _ONE_ORIENTATION and (F @ mean).min() > _ONE_WAY * np.linalg.norm(mean))


def _repeated(markers: NDArray[np.intp]) -> bool:
    """Tell whether enough markers were touched again to tell their places from noise."""
    counts = np.unique(markers, return_counts=True)[1]
    return bool(len(counts) >= _FEWEST_MARKERS and 2 * np.count_nonzero(counts > 1) >= len(counts))


# ---- what each cause does ----------------------------------------------------------------------


def _alignment(evidence: TouchEvidence, J: Array) -> Array:
    return np.asarray(alignment_columns(J, evidence.wrenches) * np.repeat([_TURN, _SHIFT], 3))


def _gravity(evidence: TouchEvidence, J: Array) -> Array:
    sizes = np.repeat([_WEIGHT, _FORCE_BIAS, _CENTRE, _TORQUE_BIAS], 3)
    return np.asarray(J @ prediction_jacobian(evidence.R_WS.transpose(0, 2, 1), evidence.theta) * sizes)


def _mesh(evidence: TouchEvidence, _J: Array) -> Array:
    """Where the mesh lies lower than the probe, the force is followed further: along F, by the height over n.F."""
    along = evidence.along
    names, place = np.unique(evidence.markers, return_inverse=True)
    columns = np.zeros((len(along), 3, 1 + len(names)))
    columns[:, :, 0] = evidence.heights[:, None] * along
    columns[np.arange(len(along)), :, 1 + place] = _HEIGHT * along
    return columns


def _mount(evidence: TouchEvidence, J: Array) -> Array:
    """
    Where the mount yields by ``c M``, the probe turns under all that presses and hangs: the torque grows.

    By ``c [(M x p) x F + (M_c x s) x G]``, M of touch and weight together, M_c of the touch; G hangs at s. What the
    weight does alone is in the calibration.
    """
    F, M = evidence.wrenches[:, :3], evidence.wrenches[:, 3:]
    G, centre = np.einsum("nij,i->nj", evidence.R_WS, evidence.theta[:3]), evidence.theta[6:9]
    turned = M + np.cross(centre, G)
    grown = np.cross(np.cross(turned, evidence.points), F) + np.cross(np.cross(M, centre), G)
    return np.asarray(_YIELD * J[:, :, 3:] @ grown[:, :, None])


def _loop(evidence: TouchEvidence, J: Array) -> Array:
    """Return what hysteresis makes of a load, by each channel's sign."""
    return np.asarray(J * (_LOOP * np.sign(evidence.wrenches))[:, None, :])


def _gain(evidence: TouchEvidence, J: Array) -> Array:
    """Return what the gains of the channels make of a load."""
    return np.asarray(_GAIN * J * evidence.wrenches[:, None, :])


def _crosstalk(evidence: TouchEvidence, J: Array) -> Array:
    """Return what a share of each channel in each makes of a load."""
    scale, W = np.repeat([1.0, _LEVER], 3), evidence.wrenches
    mixed = J[:, :, :, None] * _MIXED * (W[:, None, :] * (scale[:, None] / scale))[:, None]
    return np.asarray(mixed.reshape(*J.shape[:2], 36))


def _drift(_evidence: TouchEvidence, J: Array) -> Array:
    """Return what a zero does that goes away evenly from the first touch on."""
    return np.asarray(J * _DRIFT * np.linspace(0.0, 1.0, len(J))[:, None, None])


def _cable(evidence: TouchEvidence, J: Array) -> Array:
    """Return what a pull does that stays in the room, at a point of the probe."""
    R_SW = evidence.R_WS.transpose(0, 2, 1)
    torques = [J[:, :, 3:] @ cross_matrix(axis) @ R_SW for axis in _AT * np.eye(3)]
    return np.asarray(_PULL * np.concatenate([J[:, :, :3] @ R_SW, *torques], axis=2))


def _scale(evidence: TouchEvidence, J: Array) -> Array:
    """
    Return what another scale of mesh and markers does, about the markers' middle and from there about the sensor.

    The contact stays on its line of force, where that meets the surface that has moved; the marker moves with the mesh.
    """
    middle = evidence.points.mean(axis=0)
    moved = _STRETCH * np.stack([evidence.points - middle, np.tile(middle, (len(J), 1))], axis=2)
    met = np.einsum("nk,nkj->nj", evidence.normals, moved)
    return np.asarray(evidence.along[:, :, None] * met[:, None] - moved)


def _left(evidence: TouchEvidence, J: Array) -> Array:
    """Return what is left where too little, or too much, was taken off; and a drift in time that was never seen."""
    assert evidence.taken is not None and evidence.starts is not None  # noqa: S101, PT018 - asked by its caller
    since = evidence.starts - evidence.starts.mean()
    grown = J * (_UNSEEN * (since / max(np.abs(since).max(), 1e-9))[:, None])[:, None, :]
    return np.concatenate([J @ evidence.taken[:, :, None], grown], axis=2)


def _torsion(evidence: TouchEvidence, _J: Array) -> Array:
    """Return what a torque that is not about the normal does: the point moves along F x n, by k over |F|²."""
    F = evidence.wrenches[:, :3]
    side = np.cross(F, evidence.normals) / (F**2).sum(axis=1)[:, None]
    return np.asarray((evidence.torques[:, None] * side)[:, :, None])


def _places(evidence: TouchEvidence, _J: Array) -> Array:
    """Where a marker is not where it is said to be, all its touches are off alike, along the surface."""
    sides = across(evidence.normals)
    names, place = np.unique(evidence.markers, return_inverse=True)
    columns = np.zeros((len(place), 3, 2 * len(names)))
    columns[np.arange(len(place)), :, 2 * place] = _PLACE * sides[:, 0]
    columns[np.arange(len(place)), :, 2 * place + 1] = _PLACE * sides[:, 1]
    return columns


def _lean(evidence: TouchEvidence, _J: Array) -> Array:
    """Return what a ball of radius r does that leans: it touches beside its mark, by ``-r F_t / |F|``."""
    F = evidence.wrenches[:, :3]
    lean = F - np.einsum("nk,nk->n", F, evidence.normals)[:, None] * evidence.normals
    return np.asarray((-_TIP * lean / np.linalg.norm(F, axis=1, keepdims=True))[:, :, None])


# What a cause may be in detail: each kind does something else to the contacts, and is met more rarely by a logarithm.
_KINDS: dict[str, tuple[ErrorCause, Callable[[TouchEvidence, Array], Array], float]] = {
    ALIGNMENT: (ErrorCause.ALIGNMENT, _alignment, 0.0),
    GRAVITY: (ErrorCause.GRAVITY, _gravity, 0.0),
    DRIFT: (ErrorCause.GRAVITY, _drift, 0.0),
    LEFT: (ErrorCause.DRIFT, _left, 0.0),
    CABLE: (ErrorCause.GRAVITY, _cable, 1.0),
    MESH: (ErrorCause.MESH, _mesh, 0.0),
    SCALE: (ErrorCause.MESH, _scale, 1.0),
    TORSION: (ErrorCause.TORSION, _torsion, 0.0),
    MOUNT: (ErrorCause.MOUNT, _mount, 1.0),
    LOOP: (ErrorCause.SENSOR, _loop, 1.0),
    GAIN: (ErrorCause.SENSOR, _gain, 1.0),
    CROSSTALK: (ErrorCause.SENSOR, _crosstalk, 1.0),
    LEAN: (ErrorCause.MARKERS, _lean, 0.0),
    PLACES: (ErrorCause.MARKERS, _places, 0.0),
}


def _cause(kind: str) -> ErrorCause:
    rest = ErrorCause.NOISE if kind == REST else ErrorCause.SENSOR
    return _KINDS[kind][0] if kind in _KINDS else rest


# ---- likelihood --------------------------------------------------------------------------------


def _whitening(covariances: Array) -> Array:
    """Return (n, 3, 3) what turns noise of these covariances, and the floor, into unit noise."""
    values, vectors = np.linalg.eigh(covariances + _FLOOR**2 * np.eye(3))
    return np.asarray((vectors / np.sqrt(values)[:, None, :]).transpose(0, 2, 1))


def _stack(Z: dict[str, Array], sizes: dict[str, float]) -> Array:
    return np.concatenate([size * Z[cause] for cause, size in sizes.items()], axis=1)


def _likelihood(y: Array, Z: Array) -> tuple[float, float]:
    """Return the log likelihood of y ~ N(0, s² I + Z Z'), and the s that makes it largest."""
    s2 = _SCALES**2
    values, u2 = np.zeros(0), np.zeros(0)
    if Z.shape[1]:
        # Z Z' has the same eigenvalues as Z' Z but zeros: the smaller of the two is taken apart.
        wide = Z.shape[1] > len(y)
        values, vectors = np.linalg.eigh(Z @ Z.T if wide else Z.T @ Z)
        kept = values > 1e-12 * max(values[-1], 1e-300)
        values, vectors = values[kept], vectors[:, kept]
        u2 = (vectors.T @ y) ** 2 if wide else (vectors.T @ (Z.T @ y)) ** 2 / values
    both = s2[:, None] + values
    free, rest = len(y) - len(values), max(float(y @ y - u2.sum()), 0.0)
    log = -0.5 * ((np.log(both) + u2 / both).sum(axis=1) + free * np.log(s2) + rest / s2)
    best = int(np.argmax(log))
    return float(log[best]), float(_SCALES[best])


def _parts(
    y: Array, Z: dict[str, Array], columns: dict[str, Array], chosen: dict[str, float], scale: float
) -> dict[str, Array]:
    """Return (n, 3) what each chosen kind most likely did to the contacts, m."""
    if not chosen:
        return {}
    whole = _stack(Z, chosen)
    beta = np.linalg.solve(whole.T @ whole + scale**2 * np.eye(whole.shape[1]), whole.T @ y)
    borders = np.cumsum([Z[kind].shape[1] for kind in chosen])[:-1]
    sizes = zip(chosen.items(), np.split(beta, borders), strict=True)
    return {kind: size * columns[kind] @ part for (kind, size), part in sizes}


def _shares(errors: Array, parts: dict[str, Array]) -> dict[str, float]:
    """Return the shares: the projection of the errors on what each kind most likely did; the rest is of no kind."""
    total = float((errors**2).sum())
    found = {kind: max(float((done * errors).sum()) / total, 0.0) for kind, done in parts.items() if total}
    found[REST] = max(1.0 - sum(found.values()), 0.0)
    whole = sum(found.values())
    return {kind: share / whole for kind, share in found.items()}
