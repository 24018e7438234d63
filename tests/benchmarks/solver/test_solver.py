"""The judge of the solver finds it exact, and finds out when it is not."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import pytest
from benchmarks.solver import bits, exact, ties
from benchmarks.solver import hard_meshes as hm
from benchmarks.solver.bits import Build, Row, Workshop
from config.runtime import bundle_reference

from contactbench.pipeline.contact import ContactSolver, Gates
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.stability import press

if TYPE_CHECKING:
    from contactbench.pipeline.mesh import Probe

needs_compiler = pytest.mark.skipif(shutil.which("g++") is None, reason="no g++")


def missed(rows: list[Row]) -> list[Row]:
    return [row for row in rows if not row.met]


@dataclass(frozen=True, eq=False)
class Bent(hm.SolidBody):
    """A body whose probe is a little larger than itself: what a wrong solver would look like."""

    by: float = 0.0

    def probe(self, faces: object = None) -> Probe:
        assert faces is None
        return hm.SolidBody(self.vertices * (1 + self.by), self.faces).probe()


def bent(by: float) -> Bent:
    body = hm.ellipsoid()
    return Bent(body.vertices, body.faces, by)


@pytest.fixture(scope="module")
def workshop() -> Iterator[Workshop]:
    with Workshop() as made:
        yield made


@pytest.fixture(scope="module")
def scene() -> tuple[ContactSolver, np.ndarray]:
    return bits.hard_wrenches(40, 2)


def test_the_bits_are_the_same_in_other_threads_and_processes() -> None:
    rows = bits.bit_rows(50, 1, None, quick=True)
    assert {"2 threads", "2 new processes", "wrenches in reverse order"} <= {row.by for row in rows}
    assert all(row.worst == 0 and row.tries == 300 for row in rows)


@needs_compiler
def test_an_unoptimised_build_gives_the_kernels_bits(
    workshop: Workshop, scene: tuple[ContactSolver, np.ndarray]
) -> None:
    solver, wrenches = scene
    located, tracked = workshop.solve(Build("plain", "g++", ("-O0",)), solver, wrenches)
    assert not bits.differing(located, bits.kernel_rows(solver.locate_batch(wrenches))).any()
    assert not bits.differing(tracked, bits.tracked(solver, wrenches)).any()
    assert (located["reason"] <= 1).sum() > 50
    assert bits.differing(located, tracked).any(), "a stream prefers what is near"


def test_a_build_that_fails_or_is_not_there_names_itself(
    workshop: Workshop, scene: tuple[ContactSolver, np.ndarray]
) -> None:
    with pytest.raises(InputError, match="gone: no-such-compiler cannot be run"):
        workshop.solve(Build("gone", "no-such-compiler", ()), *scene)
    clipped = ContactSolver(hm.box().probe(), gates=Gates(saturation=(1.0,) * 6))
    with pytest.raises(InputError, match="without regions and saturation"):
        workshop.solve(Build("plain", "g++", ("-O0",)), clipped, np.zeros((1, 6)))


def test_rows_differ_by_any_bit_and_nan_is_nan() -> None:
    rows = np.zeros(4, bits.ROW)
    other = rows.copy()
    rows["point"][0], other["point"][0] = np.nan, -np.float64(np.nan)
    other["normal"][1, 2] = np.nextafter(0.0, 1.0)
    other["face"][2] = 1
    other["covariance"][3, 1, 1] = -0.0
    assert bits.differing(rows, other).tolist() == [False, True, True, True]


def test_units_change_nothing_but_gates_that_are_forgotten_do() -> None:
    rows = exact.unit_rows(60, 1)
    assert not missed(rows)
    forgotten = {row.x: row.worst for row in rows if row.figure == exact.FORGOTTEN}
    assert forgotten[1.0] == 0.0
    # In mm what is the same touch is left to its deviations; in km every touch of the probe is within 5 "mm".
    assert forgotten[1e-3] > 0.0


def test_exact_arithmetic_agrees() -> None:
    rows = exact.exact_rows(12, 1)
    assert not missed(rows)
    assert sum(row.worst for row in rows if row.figure == exact.OTHERWISE) > 0
    convex = {row.case for row in rows if row.figure == exact.SPREAD}
    assert convex == {row.case for row in rows if row.case.startswith("ellipsoid")}


def test_exact_arithmetic_notices_a_lost_answer_and_one_where_there_is_none() -> None:
    body, rng = hm.ellipsoid(), np.random.default_rng(0)
    inside, gaps = (press(*hm.places(body, 5, rng, place), rng, pitch=0.03) for place in ("facet", "cone"))
    lost = {row.figure: row.worst for row in missed(exact._compared("case", bent(-0.99), inside))}
    assert lost[exact.NONE] == 5.0
    assert lost[exact.DEPTH] > 1e-3
    assert not missed(exact._compared("case", body, gaps))


def test_exact_arithmetic_notices_a_mesh_that_is_off_by_a_picometre() -> None:
    rng = np.random.default_rng(0)
    drawn = press(*hm.places(hm.ellipsoid(), 5, rng), rng)
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
    assert max(exact._margins(body, top, force, exact._cross(middle, force))) < 0
    outside = (Fraction(-1), Fraction(0), Fraction(1, 16))
    assert max(exact._margins(body, top, force, exact._cross(outside, force))) > 0
    on_edge = tuple((x + y) / 2 for x, y in zip(a, b, strict=True))
    assert max(exact._margins(body, top, force, exact._cross(on_edge, force))) == 0


def test_ties_are_broken_alike_and_by_more_than_the_least_number(monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(ties.meshes()) == 30
    assert ties.run(wrenches=300, seed=1).passed
    monkeypatch.setattr(bundle_reference.Wrench, "least", lambda _self, key, _points: int(key.argmin()))
    (plates,) = [probe for probe in ties.meshes() if probe.name == "plates 0.4 mm apart"]
    pruned, told = ties.differences(plates, ties.draw(plates, 100, np.random.default_rng(1)))
    assert pruned == 0 < told
