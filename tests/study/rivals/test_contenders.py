"""The contenders themselves: ray tracers, and what is said of those that are missing."""

import numpy as np
import pytest

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.study.rivals import place, rays
from contactbench.pipeline.study.rivals.place import medians
from contactbench.pipeline.study.rivals.rows import OURS


@pytest.mark.parametrize("contender", list(rays.TRACERS), ids=lambda each: each.package)
def test_every_ray_tracer_that_is_there_enters_the_same_facets(contender):
    solver = ContactSolver(model_of("linear", 500))
    try:
        axis = rays.TRACERS[contender](solver)
    except (ImportError, InputError) as error:
        pytest.skip(str(error))
    touches = place.draw_touches(place.assets.surface("linear"), 200, np.random.default_rng(4), above=0.02)
    found = axis.locate_batch(touches.wrenches)
    # With so little torque the wrench axis is ours but for some hundredths of a millimetre, rims left aside.
    off = np.linalg.norm(found.points - solver.locate_batch(touches.wrenches).points, axis=1)
    assert np.nanmedian(off) < 2e-4
    call, prepare = rays.bare_ray(axis)
    origins, directions = axis.rays(touches.wrenches[:1])
    assert call(prepare(origins, directions)) is not None


def test_what_is_missing_is_said_and_the_rest_measured(monkeypatch):
    def nothing(_):
        raise ImportError("no such module")

    monkeypatch.setattr(rays, "import_module", nothing)
    monkeypatch.setattr(place, "_FEW", 20)
    rows = list(place.place_rows("linear", 500, 60, 1, 0))
    gone = {row["contender"] for row in rows if row["kind"] == "missing"}
    assert {rays.OPEN3D.name, rays.PCU.name} <= gone
    timed = {row["contender"] for row in rows if row["kind"] == "time"}
    assert {OURS, "Algorithm 1, C++", "Levenberg-Marquardt, SciPy"} <= timed
    assert not gone & timed


def test_rounds_are_interleaved_and_counted():
    order = []
    calls = {name: (lambda _, name=name: order.append(name), [0]) for name in "ab"}
    found = medians(calls, 2)
    assert {name: len(us) for name, us in found.items()} == {"a": 2, "b": 2}
    turns = [name for k, name in enumerate(order) if not k or order[k - 1] != name]
    assert turns == ["a", "b", "a", "b", "a", "b"]
