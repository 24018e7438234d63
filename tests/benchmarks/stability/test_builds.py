"""Builds of the solver: the kernel's bits from other options, and floats only from the single-precision one."""

from __future__ import annotations

import shutil
from collections.abc import Iterator

import numpy as np
import pytest

from contactbench.pipeline.contact import ContactSolver, Gates
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study import hard_meshes as hm
from contactbench.pipeline.study import stability

from . import builds, precision, repeat, rounding, theory
from .builds import SINGLE, Build, Workshop

needs_compiler = pytest.mark.skipif(shutil.which("g++") is None, reason="no g++")


@pytest.fixture(scope="module")
def workshop() -> Iterator[Workshop]:
    with Workshop() as made:
        yield made


@pytest.fixture(scope="module")
def scene() -> tuple[ContactSolver, np.ndarray]:
    return repeat.inputs(40, 2)


@needs_compiler
def test_an_unoptimised_build_gives_the_kernels_bits(
    workshop: Workshop, scene: tuple[ContactSolver, np.ndarray]
) -> None:
    solver, wrenches = scene
    located, tracked = workshop.solve(Build("plain", "g++", ("-O0",)), solver, wrenches)
    assert not builds.differing(located, builds.kernel_rows(solver.locate_batch(wrenches))).any()
    solver.reset()
    assert not builds.differing(tracked, builds.kernel_rows(solver.track_batch(wrenches))).any()
    assert (located["reason"] <= 1).sum() > 50
    assert builds.differing(located, tracked).any(), (
        "a stream prefers what is near: were it not tracked, they were equal"
    )


@needs_compiler
def test_single_precision_is_single_throughout(
    workshop: Workshop, scene: tuple[ContactSolver, np.ndarray]
) -> None:
    solver, wrenches = scene
    located, _ = workshop.solve(SINGLE, solver, wrenches)
    for name in ("point", "normal", "torque"):
        values = located[name]
        assert np.array_equal(values, values.astype(np.float32), equal_nan=True)
    double = builds.kernel_rows(solver.locate_batch(wrenches))
    answered = np.isfinite(double["point"][:, 0])
    assert not np.array_equal(located["point"][answered], double["point"][answered].astype(np.float32))


@needs_compiler
def test_single_precision_is_enough_in_the_cone(workshop: Workshop) -> None:
    rows = precision.run(60, 1, workshop, quick=True)
    assert [row for row in rows if not row.met] == []
    steep = [row.worst for row in rows if row.figure == precision.APART and row.axis == precision.ANGLE]
    assert max(steep) > 20 * min(steep)


@needs_compiler
def test_single_precision_rounds_a_billion_times_more(workshop: Workshop) -> None:
    body = hm.ellipsoid()
    touches = theory.touch(body, 50, np.random.default_rng(0))
    answers = rounding.both_precisions(body, touches, workshop)
    rows = rounding.measure("rounding", "case", body, touches, answers)
    assert all(row.met for row in rows)
    error = {row.by: row.median for row in rows if row.figure == stability.ERROR}
    assert 1e8 < error[rounding.SINGLE] / error[stability.DOUBLE] < 1e10


@needs_compiler
def test_a_build_that_fails_names_itself(workshop: Workshop, scene: tuple[ContactSolver, np.ndarray]) -> None:
    with pytest.raises(InputError, match=r"odd: g\+\+ failed .*-fno-such-option"):
        workshop.solve(Build("odd", "g++", ("-fno-such-option",)), *scene)


def test_a_compiler_that_is_not_there_is_named(
    workshop: Workshop, scene: tuple[ContactSolver, np.ndarray]
) -> None:
    with pytest.raises(InputError, match="gone: no-such-compiler cannot be run"):
        workshop.solve(Build("gone", "no-such-compiler", ()), *scene)


def test_what_the_file_cannot_hold_is_refused(workshop: Workshop) -> None:
    body = hm.box()
    ranked = Probe.from_arrays(body.vertices, body.faces, region=np.ones(len(body.faces), int))
    clipped = ContactSolver(body.probe(), gates=Gates(saturation=(1.0,) * 6))
    for solver in (
        ContactSolver(ranked),
        clipped,
        ContactSolver(body.probe(), gates=Gates(region_only=True)),
    ):
        with pytest.raises(InputError, match="without regions and saturation"):
            workshop.solve(SINGLE, solver, np.zeros((1, 6)))


def test_rows_differ_by_any_bit_and_nan_is_nan() -> None:
    rows = np.zeros(4, builds.ROW)
    other = rows.copy()
    rows["point"][0], other["point"][0] = np.nan, -np.float64(np.nan)
    other["normal"][1, 2] = np.nextafter(0.0, 1.0)
    other["face"][2] = 1
    other["covariance"][3, 1, 1] = -0.0
    assert builds.differing(rows, other).tolist() == [False, True, True, True]


def test_builds_are_those_of_the_compilers_that_are_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: name if name == "g++" else None)
    assert [b.name for b in builds.available(quick=True)] == ["g++ -O0"]
    every = builds.available()
    assert {b.compiler for b in every} == {"g++"}
    assert [b.name for b in every if not b.same_bits] == ["g++ -O3 -march=native -ffp-contract=fast"]
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert builds.available() == []
