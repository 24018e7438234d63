"""Files that no touch explains: the usual mistakes are named, and only where they would explain most of it."""

import io
import json

import numpy as np
import pytest
from contact_cases import bundled
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.contact.plausibility import ROWS, Sample
from contactbench.pipeline.contact.stream import locate_file
from contactbench.pipeline.simulation import add_noise, draw_touches


@pytest.fixture(scope="module", params=assets.PROBE_NAMES)
def name(request) -> str:
    return request.param


def wrenches_of(name: str, count: int = 400) -> np.ndarray:
    """Touches all over the probe with 3 to 12 N, and a quarter of the rows in the air."""
    rng = np.random.default_rng(7)
    touches = draw_touches(assets.surface(name), count, rng, above=0.02, force=(3, 12)).wrenches
    touches[::4] = 0.0
    return add_noise(touches, WrenchNoise(), rng)


def located(name: str, wrenches: np.ndarray, **options):
    rows = (f"{0.01 * i}," + ",".join(map(repr, row)) for i, row in enumerate(wrenches.tolist()))
    source = io.BytesIO("\n".join(["t,fx,fy,fz,mx,my,mz", *rows]).encode() + b"\n")
    probe = bundled(name, 2000)
    return locate_file(ContactSolver(probe), source, io.BytesIO(), probe=probe, **options)


def turned(wrenches: np.ndarray, axis: str, degrees: float) -> np.ndarray:
    turn = Rotation.from_euler(axis, degrees, degrees=True).as_matrix()
    return np.hstack([wrenches[:, :3] @ turn.T, wrenches[:, 3:] @ turn.T])


def test_a_good_file_is_not_doubted(name):
    summary = located(name, wrenches_of(name))
    assert summary.plausibility is None
    assert summary.warnings == ()


def test_newton_millimetres(name):
    judged = located(name, wrenches_of(name) * [1, 1, 1, 1e3, 1e3, 1e3]).plausibility
    assert [trial.name for trial in judged.likely] == ["torques_in_Nmm"]
    assert judged.likely[0].share > 0.98
    assert judged.plausible == 0
    assert judged.arm_m > 100 * judged.reach_m
    assert "Most likely the torques are in N·mm" in judged.sentences()[1]
    assert json.loads(json.dumps(judged.facts()))["likely"] == ["torques_in_Nmm"]


def test_weight_that_nobody_took_off(name):
    load = np.array([0.5, 1.0, -6.0, 0.05, 0.02, 0.01])
    judged = located(name, wrenches_of(name) + load).plausibility
    assert [trial.name for trial in judged.likely] == ["not_compensated"]
    assert judged.likely[0].share > 0.98
    assert "contactbench calibrate compensate" in judged.sentences()[1]


@pytest.mark.parametrize(("axis", "degrees", "back"), [("x", 90, "90"), ("y", -90, "-90"), ("x", 180, "180")])
def test_a_mount_that_is_turned(name, axis, degrees, back):
    # Wrenches turned by an angle are those of a probe that is turned by the same.
    judged = located(name, turned(wrenches_of(name), axis, degrees)).plausibility
    assert judged.likely[0].remedy.startswith(f"Turn the mesh by {back}° about {axis}")
    assert judged.likely[0].share > 0.98
    assert judged.miss_m > 0.03


def test_what_no_usual_mistake_explains_is_not_given_one(name):
    wrenches = wrenches_of(name)
    wrenches[:, 3:] += np.cross([0.0, 0.0, 0.08], wrenches[:, :3])  # 80 mm too far
    judged = located(name, wrenches).plausibility
    assert judged.likely == ()
    assert "Check the position in --place" in judged.sentences()[1]
    assert judged.miss_m > 0.01


def test_opposite_signs_are_told_where_the_back_cannot_be_touched():
    # A tray, open to the back: reversed forces meet no facet that faces them.
    side = np.linspace(-0.04, 0.04, 9)
    x, y = np.meshgrid(side, side)
    vertices = np.column_stack([x.ravel(), y.ravel(), np.full(81, 0.1)])
    corner = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    faces = np.vstack(
        [
            np.column_stack([corner, corner + 1, corner + 10]),
            np.column_stack([corner, corner + 10, corner + 9]),
        ]
    )
    from contactbench.pipeline.mesh import Probe

    probe = Probe.from_arrays(vertices, faces)
    rng = np.random.default_rng(3)
    points = np.column_stack([rng.uniform(-0.03, 0.03, (50, 2)), np.full(50, 0.1)])
    force = np.column_stack([rng.uniform(-1, 1, (50, 2)), rng.uniform(-9, -4, 50)])
    wrenches = np.hstack([force, np.cross(points, force)])
    solver, sample = ContactSolver(probe), Sample()
    sample.add(-wrenches, solver.locate_batch(-wrenches).reasons)
    judged = sample.judge(solver, probe)
    assert (judged.plausible, judged.likely[0].name, judged.likely[0].plausible) == (0, "reversed", 50)


@pytest.mark.parametrize("block", [1, 37, 5000])
def test_the_sample_does_not_depend_on_the_blocks(block):
    probe = bundled("linear", 2000)
    solver = ContactSolver(probe)
    wrenches = np.tile(wrenches_of("linear"), (5, 1)) * [1, 1, 1, 1e3, 1e3, 1e3]
    reasons = solver.locate_batch(wrenches).reasons
    whole, parts = Sample(), Sample()
    whole.add(wrenches, reasons)
    for at in range(0, len(wrenches), block):
        parts.add(wrenches[at : at + block], reasons[at : at + block])
    assert parts.judge(solver, probe) == whole.judge(solver, probe)
    assert whole.judge(solver, probe).rows == ROWS


def test_few_bad_rows_are_no_reason_to_doubt():
    wrenches = wrenches_of("convex")
    wrenches[: len(wrenches) // 3, 3:] *= 1000
    assert located("convex", wrenches).plausibility is None
