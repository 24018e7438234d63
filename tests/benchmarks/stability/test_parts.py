"""Each part of the study finds the solver steady, and finds out when it is not."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import pytest

from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study import stability

from . import (
    amplification,
    bias,
    edges,
    exact,
    repeat,
    rounding,
    theory,
    thin,
    units,
)
from .theory import Row, of_part

if TYPE_CHECKING:
    from contactbench.pipeline.mesh import Probe

SAMPLES = 60


def missed(rows: list[Row]) -> list[Row]:
    return [row for row in rows if not row.met]


@dataclass(frozen=True, eq=False)
class Bent(hm.Body):
    """A body whose probe is a little larger than itself: what a wrong solver would look like."""

    by: float = 0.0

    def probe(self, faces: object = None) -> Probe:
        assert faces is None
        return hm.Body(self.vertices * (1 + self.by), self.faces).probe()


def bent(by: float) -> Bent:
    body = hm.ellipsoid()
    return Bent(body.vertices, body.faces, by)


def test_amplification_is_first_order() -> None:
    rows = amplification.run(SAMPLES, 1)
    assert not missed(rows)
    assert {row.x for row in of_part(rows, amplification.PART, figure=amplification.GROWS)} == {
        *stability.COSINES
    }


def test_a_wrong_prediction_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = theory.moved
    monkeypatch.setattr(theory, "moved", lambda *a: 1.02 * right(*a))
    broken = missed(amplification.run(SAMPLES, 1))
    assert {row.figure for row in broken} == {amplification.OFF}
    assert len(broken) == len(stability.COSINES) + 9


def test_rounding_stays_within_the_condition() -> None:
    rows = rounding.run(SAMPLES, 1, None, quick=True)
    assert not missed(rows)
    assert {row.by for row in rows} == {stability.DOUBLE, stability.ALGORITHM1}
    assert all(row.most is None for row in rows if row.by == stability.ALGORITHM1)
    worst = {
        row.by: row.worst for row in rows if row.figure == stability.RATIO and row.axis == rounding.FACETS
    }
    assert worst[stability.DOUBLE] < worst[stability.ALGORITHM1]


def test_a_solver_off_by_more_than_rounding_is_noticed() -> None:
    touches = theory.touch(hm.ellipsoid(), SAMPLES, np.random.default_rng(0))
    for by, broken in ((0.0, False), (1e-13, True)):
        body = bent(by)
        rows = rounding.measure(
            "rounding", "case", body, touches, rounding.both_precisions(body, touches, None)
        )
        assert bool(missed(rows)) is broken


def test_the_bits_are_the_same_in_other_threads_and_processes() -> None:
    rows = repeat.run(50, 1, None, quick=True)
    assert {"2 threads", "2 new processes", "wrenches in reverse order"} <= {row.by for row in rows}
    assert all(row.worst == 0 and row.tries == 300 for row in rows)


def test_edges_leave_no_gap_and_jumps_are_predicted() -> None:
    rows = edges.run(SAMPLES, 1, None)
    assert not missed(rows)
    jumps = {row.x: row.median for row in rows if row.figure == edges.JUMP and row.by == edges.MEASURED}
    assert jumps[1.0] > 20 * jumps[0.03] > 0


def test_thin_facets_cost_digits_in_proportion() -> None:
    rows = thin.run(SAMPLES, 1, None)
    assert not missed(rows)
    error = {row.x: row.median for row in rows if row.figure == thin.FROM_TRUTH and row.case == thin.CAP}
    assert 1e4 < error[1e-8] / error[1e-3] < 1e6
    assert {row.x for row in rows if row.figure == thin.REFUSED} >= {1e-14, 1e-15}


def test_units_change_nothing_but_gates_that_are_forgotten_do() -> None:
    rows = units.run(SAMPLES, 1, None)
    assert not missed(rows)
    forgotten = {row.x: row.worst for row in rows if row.figure == units.FORGOTTEN}
    assert forgotten[1.0] == 0.0
    # In mm what is the same touch is left to its deviations; in km every touch of the probe is within 5 "mm".
    assert forgotten[1e-3] > 0.0


def test_a_bias_costs_what_the_reading_rounds_to() -> None:
    rows = bias.run(SAMPLES, 1, None)
    assert not missed(rows)
    error = {(row.by, row.x): row.worst for row in rows if row.figure == bias.ERROR}
    assert error[stability.DOUBLE, 1e8] < 1e-4 < error[bias.WIRE, 1e4]


def test_exact_arithmetic_agrees() -> None:
    rows = exact.run(12, 1)
    assert not missed(rows)
    assert sum(row.worst for row in rows if row.figure == exact.OTHERWISE) > 0
    convex = {row.case for row in rows if row.figure == exact.SPREAD}
    assert convex == {row.case for row in rows if row.case.startswith("ellipsoid")}


def test_exact_arithmetic_notices_a_lost_answer_and_one_where_there_is_none() -> None:
    body, rng = hm.ellipsoid(), np.random.default_rng(0)
    inside, gaps = (hm.press(*hm.places(body, 5, rng, place), rng, pitch=0.03) for place in ("facet", "cone"))
    away = Bent(body.vertices, body.faces, -0.99)
    lost = {row.figure: row.worst for row in missed(exact._compared("case", away, inside))}
    assert lost[exact.NONE] == 5.0
    assert lost[exact.DEPTH] > 1e-3
    assert not missed(exact._compared("case", body, gaps))
    assert not {exact.ERROR, exact.LONG} & {row.figure for row in exact._compared("case", body, gaps)}


def test_exact_arithmetic_notices_a_mesh_that_is_off_by_a_picometre() -> None:
    rng = np.random.default_rng(0)
    drawn = hm.press(*hm.places(hm.ellipsoid(), 5, rng), rng)
    assert not missed(exact._compared("case", bent(0.0), drawn))
    assert exact.ERROR in {row.figure for row in missed(exact._compared("case", bent(1e-11), drawn))}


def test_rational_numbers_by_hand() -> None:
    body = hm.box()
    top = int(np.flatnonzero(body.normals[:, 2] > 0.5)[0])
    third = Fraction(1, 3)
    point = (third / 8, third / 16, Fraction(1, 16))
    force = (Fraction(1), Fraction(-2), Fraction(-8))
    moment = exact._cross(point, force)
    assert exact._facet_point(body, top, force, (moment[0], moment[1], moment[2] + 1)) == point
    a, b, c = exact._corners(body, top)
    middle = tuple((x + y + z) / 3 for x, y, z in zip(a, b, c, strict=True))
    margins = exact._margins(body, top, force, exact._cross(middle, force))
    assert max(margins) < 0
    outside = exact._margins(
        body, top, force, exact._cross((Fraction(-1), Fraction(0), Fraction(1, 16)), force)
    )
    assert max(outside) > 0
    on_edge = tuple((x + y) / 2 for x, y in zip(a, b, strict=True))
    assert max(exact._margins(body, top, force, exact._cross(on_edge, force))) == 0
