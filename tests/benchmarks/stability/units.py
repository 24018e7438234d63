"""The same probe and wrenches in other units: whether the same answer comes back, and which limits have a unit."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver, Gates, TouchModel, WrenchNoise
from contactbench.pipeline.contact.touch_model import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study.stability import DOUBLE

from . import builds, theory
from .rounding import SINGLE
from .theory import Row, Where, count

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Float

    from .builds import Rows, Workshop

PART = "units"
DIFFER, ROUNDING = "answers that differ in any bit", "point, unscaled, off by, of the probe's size"
REASON, FORGOTTEN = "another reason", "another reason when the gates stay in metres and newtons"
LENGTH, FORCE = "numbers of length, of those in metres", "numbers of force, of those in newtons"
NAMED = {"µm": 1e6, "mm": 1e3, "m": 1.0, "km": 1e-3}
# Stated: unscaling is a matter of roundoffs.
MOST_ROUNDOFFS = {DOUBLE: 100 * theory.ROUNDOFF, SINGLE: 100 * theory.FLOAT_ROUNDOFF}
_MOST_REASONS = 0.1  # %, in single precision: answers on the border of a gate
# In single precision a covariance, m², loses bits where lengths are smaller or larger.
_SQUARES_FIT = (1e-9, 1e12)
# As delivered, on a mesh that is a little off; and without lengths of its own, for units in which 1 mm is more than a
# model allows.
USUAL, AXIS = TouchModel(mesh_deviation=1e-4), TouchModel(torsion_arm=0.0)
_MOST_LENGTH = 1e6


def run(samples: int, seed: int, workshop: Workshop | None) -> list[Row]:
    """Scale lengths and forces by powers of ten and of two."""
    body, rng = hm.bundled("t-shape", 1000), np.random.default_rng(seed)
    wrenches = theory.touch(body, samples, rng, angle=(0.0, 70.0)).wrenches
    scene, axis = (_Scene(body, wrenches, workshop, model) for model in (USUAL, AXIS))
    rows: list[Row] = []
    for factor in (*NAMED.values(), 1e-6, 1e-9, 1e-12):
        rows += scene.scaled("lengths in another unit", factor, 1.0, {"x": factor, "axis": LENGTH})
    rows += axis.scaled("lengths in another unit, wrench axis", 1e9, 1.0, {"x": 1e9, "axis": LENGTH})
    for factor in (1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9):
        rows += scene.scaled("forces in another unit", 1.0, factor, {"x": factor, "axis": FORCE})
    for power in (-40, -20, -1, 1, 20, 30):
        small = 2.0**power <= _MOST_LENGTH
        said = "lengths times a power of two" if small else "lengths times a power of two, wrench axis"
        rows += (scene if small else axis).scaled(
            said, 2.0**power, 1.0, {"x": 2.0**power, "axis": LENGTH}, exact=True
        )
        rows += scene.scaled(
            "forces times a power of two", 1.0, 2.0**power, {"x": 2.0**power, "axis": FORCE}, exact=True
        )
    for power in (-30, -60, -90, -120, -150):
        rows += scene.scaled(
            "lengths far out", 10.0**power, 1.0, {"x": 10.0**power, "axis": LENGTH}, single=False
        )
    return rows + [scene.forgotten(name, factor) for name, factor in NAMED.items()]


class _Scene:
    """One probe and its wrenches, to be scaled."""

    def __init__(self, body: Body, wrenches: Float, workshop: Workshop | None, model: TouchModel) -> None:
        self.body, self.wrenches, self.workshop, self.model = body, wrenches, workshop, model
        # What lies in front has odds of its own from 3 mm on, whatever the unit: without these, every limit scales.
        self.gates = Gates(first_odds=1.0)
        self.base = {by: self._answers(by, 1.0, 1.0, self.gates) for by in self._precisions}

    @property
    def _precisions(self) -> tuple[str, ...]:
        return (DOUBLE,) if self.workshop is None else (DOUBLE, SINGLE)

    def _answers(self, by: str, length: float, force: float, gates: Gates) -> Rows:
        probe = Probe.from_arrays(self.body.vertices * length, self.body.faces, check_size=False)
        noise = WrenchNoise(0.05 * force, 0.002 * force * length)
        model = replace(
            self.model,
            torsion_arm=self.model.torsion_arm * length,
            model_error=WrenchNoise(DEFAULT_FORCE_N * force, DEFAULT_TORQUE_NM * force * length),
            mesh_deviation=self.model.mesh_deviation * length,
        )
        solver = ContactSolver(probe, noise, gates, model)
        wrenches = self.wrenches * np.repeat([force, force * length], 3)
        if by == SINGLE and self.workshop is not None:
            return self.workshop.solve(builds.SINGLE, solver, wrenches)[0]
        return builds.kernel_rows(solver.locate_batch(wrenches))

    def _gates(self, length: float, force: float) -> Gates:
        return replace(
            self.gates,
            min_force=self.gates.min_force * force,
            ambiguity_distance=self.gates.ambiguity_distance * length,
            follow_distance=self.gates.follow_distance * length,
        )

    def scaled(
        self,
        case: str,
        length: float,
        force: float,
        more: Where,
        *,
        exact: bool = False,
        single: bool = True,
    ) -> list[Row]:
        """Scale probe, wrenches, noise, model and gates, solve, and unscale."""
        rows = []
        for by in self._precisions if single else (DOUBLE,):
            found, base = self._answers(by, length, force, self._gates(length, force)), self.base[by]
            for name, factor in (("point", length), ("torque", force * length), ("covariance", length**2)):
                found[name] /= factor
            reasons = 100.0 * float(np.mean(found["reason"] != base["reason"]))
            most = 0.0 if by == DOUBLE else _MOST_REASONS
            rows.append(Row(PART, case, by, REASON, "%", len(found), reasons, reasons, most=most, **more))
            if exact:
                bits = int(builds.differing(found, base).sum())
                within = by == DOUBLE or _SQUARES_FIT[0] < length < _SQUARES_FIT[1]
                rows.append(
                    count(PART, case, by, DIFFER, bits, len(found), most=0.0 if within else None, **more)
                )
            else:
                off = np.linalg.norm(found["point"] - base["point"], axis=1) / self.body.size
                rows.append(Row.of(PART, case, by, ROUNDING, "", off, most=MOST_ROUNDOFFS[by], **more))
        return rows

    def forgotten(self, unit: str, length: float) -> Row:
        """Scale all but the gates: the limits that have a unit decide otherwise then."""
        found = self._answers(DOUBLE, length, 1.0, self.gates)
        share = 100.0 * float(np.mean(found["reason"] != self.base[DOUBLE]["reason"]))
        more: Where = {"x": length, "axis": LENGTH}
        return Row(
            PART,
            f"lengths in {unit}, gates in metres",
            DOUBLE,
            FORGOTTEN,
            "%",
            len(found),
            share,
            share,
            **more,
        )
