"""Two real probe files: hollow, open, inconsistently wound. Said in a warning, answered where that is sound."""

import json

import numpy as np
import pytest
from contact_cases import REAL_PROBES
from terminal import invoke

from contactbench.pipeline.contact import ContactSolver, Reason
from contactbench.pipeline.mesh import MeshWarning, load_probe


def outer_touches(probe, count, rng):
    """Perpendicular and tilted touches of facets that nothing lies in front of."""
    pytest.importorskip(
        "embreex", reason="Embree's bindings (extra 'rivals') tell the outside from the inside here"
    )
    from contactbench.pipeline.contact.methods import EmbreeAxis

    axis = EmbreeAxis(ContactSolver(probe))
    middle = probe.vertices[probe.faces].mean(axis=1)
    origins = (middle + 1e-4 * probe.normals - probe.bounds.mean(axis=0)).astype(np.float32)
    outer = np.flatnonzero(axis.scene.run(origins, probe.normals.astype(np.float32), query="INTERSECT") < 0)
    area = probe.areas[outer]
    chosen = rng.choice(outer, count, p=area / area.sum())
    points = np.einsum("ij,ijk->ik", rng.dirichlet([1, 1, 1], count), probe.vertices[probe.faces[chosen]])
    normals = probe.normals[chosen]
    tangents = np.cross(normals, rng.standard_normal((count, 3)))
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    theta = np.radians(rng.uniform(0, 20, count))[:, None]
    forces = 9 * (np.sin(theta) * tangents - np.cos(theta) * normals)
    return points, np.hstack([forces, np.cross(points, forces)])


def test_defects_are_said_in_one_warning():
    path = REAL_PROBES / "linear-l14-5.stl"
    if not path.exists():
        pytest.skip("the real probe meshes lie outside this repository and are not here")
    with pytest.warns(MeshWarning, match=r"open .* which side is outside"):
        load_probe(path, units="mm")


def test_answers_are_right_or_flagged(real_probe):
    points, wrenches = outer_touches(real_probe, 1_000, np.random.default_rng(1))
    batch = ContactSolver(real_probe).locate_batch(wrenches)
    error = np.linalg.norm(batch.points - points, axis=1)
    sure = batch.accepted
    assert sure.sum() > 10
    # Double walls lie a millimetre apart: within the ambiguity distance either may be given.
    assert error[sure].max() < 0.005
    assert np.mean(error[sure] < 1e-9) > 0.9
    # Inner walls answer nearly every wrench too: that is what `ambiguous` is for.
    doubted = batch.reasons == Reason.AMBIGUOUS
    assert (sure | doubted).mean() > 0.98
    assert np.mean(error[doubted] < 1e-3) > 0.93


def test_the_command_runs_on_it_and_says_what_is_wrong(real_probe, tmp_path):
    path = REAL_PROBES / f"{real_probe.name}.stl"
    _, wrenches = outer_touches(real_probe, 200, np.random.default_rng(2))
    rows = "\n".join(f"{i / 200},{','.join(map(repr, map(float, row)))}" for i, row in enumerate(wrenches))
    (tmp_path / "w.csv").write_text(f"t,fx,fy,fz,mx,my,mz\n{rows}\n", encoding="utf-8")
    arguments = ["locate", "--probe", str(path), "--units", "mm", "--place", "0,0,160,90,0,0", "--json"]
    result = invoke(*arguments, tmp_path / "w.csv", "--out", tmp_path / "c.csv")
    assert result.exit_code == 0, result.stderr
    summary = json.loads(result.stdout)
    assert summary["rows"] == 200
    assert summary["warnings"]
    assert len((tmp_path / "c.csv").read_text(encoding="utf-8").splitlines()) == 201
