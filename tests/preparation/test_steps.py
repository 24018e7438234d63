"""The steps from a mesh file to a probe, and all of them in one go."""

import math

import numpy as np
import pytest
from contact_cases import ball, bundled
from mesh.shell.housings import HEIGHT, housing, write_stl

from contactbench.pipeline.mesh import Probe, load_probe, save_probe
from contactbench.pipeline.mesh.engines import NOBODY, Cancelled, Monitor
from contactbench.pipeline.mesh.shell import Closing
from contactbench.pipeline.mesh.sidecar import load_probe_file, save_probe_file
from contactbench.pipeline.mesh.simplify import Count, MaxDeviation, simplify
from contactbench.pipeline.preparation.alignment.alignment import from_angles
from contactbench.pipeline.preparation.ladder.compare import ExpectedTouches
from contactbench.pipeline.preparation.prepare import (
    align_step,
    contact_error_criterion,
    contact_target,
    import_mesh,
    prepared,
    shell_step,
    simplify_step,
)
from contactbench.pipeline.settings import ProbeSettings

MOUNT = from_angles([0, 0, 40], [0, 0, 90])
LENGTHS = {"alpha": 0.002, "gap": 0.004}


@pytest.fixture
def hollow(tmp_path):
    return write_stl(tmp_path / "housing.stl", housing())


def prepare(file, monitor=NOBODY, **settings):
    return prepared({"mesh": file}, ProbeSettings(**settings), monitor=monitor)


def steps_of(content):
    return [step["step"] for step in content.history]


def test_import_says_how_the_unit_was_found(hollow):
    content = import_mesh(hollow)
    assert content.probe.size == pytest.approx(HEIGHT)
    assert steps_of(content) == ["import"]
    parameters = content.history[0]["parameters"]
    assert (parameters["file"], parameters["units"]) == ("housing.stl", "mm")
    assert "100 mm is a probe" in content.history[0]["result"]["why_units"]
    assert any("open" in note for note in content.notes) or content.probe.health.watertight


def test_the_steps_one_by_one_give_what_prepare_gives(hollow, tmp_path):
    pytest.importorskip("pymeshlab", reason="the outer shell is wrapped by pymeshlab (extra 'meshlab')")
    together = prepare(
        hollow, units="mm", close=("hull",), mount=(0, 0, 40, 0, 0, 90), facets=300, alpha=2, gap=4
    )
    save_probe_file(together.content, tmp_path / "together.ply")
    content = import_mesh(hollow, "mm")
    for number, step in enumerate(
        (
            lambda given: shell_step(given, Closing.HULL, **LENGTHS)[0],
            lambda given: align_step(given, MOUNT),
            lambda given: simplify_step(given, Count(300))[0],
        )
    ):
        file = tmp_path / f"{number}.ply"
        save_probe_file(step(content), file)
        content = import_mesh(file)  # as the commands do: through the file
    assert steps_of(content) == ["import", "shell", "align", "simplify"]
    for suffix in (".ply", ".json"):
        assert (tmp_path / f"2{suffix}").read_bytes() == (tmp_path / f"together{suffix}").read_bytes()
    assert together.ready
    assert together.content.frame == "S"
    assert together.content.probe.bounds[:, 2] == pytest.approx([0.04, 0.04 + HEIGHT], abs=2e-4)
    assert together.content.probe.invented.any()
    assert not any("own frame" in sentence for sentence in together.sentences)


def test_a_history_goes_on_where_it_was(hollow, tmp_path):
    content = align_step(import_mesh(hollow), MOUNT)
    save_probe_file(content, tmp_path / "a.ply")
    again = import_mesh(tmp_path / "a.ply", "mm")  # whatever is said: the file knows that it is in metres
    assert again.history == content.history
    assert np.array_equal(again.probe.vertices, content.probe.vertices)


def test_a_probe_without_history_gets_one(tmp_path):
    save_probe(bundled("linear", 500), tmp_path / "bare.ply")
    content = import_mesh(tmp_path / "bare.ply")
    assert steps_of(content) == ["import"]
    assert content.history[0]["parameters"]["units"] == "m"


def test_regions_and_names_survive_simplification(tmp_path):
    save_probe(bundled("convex", 2000, regions=True), tmp_path / "probe.ply")
    content = import_mesh(tmp_path / "probe.ply")
    done, made, _ = simplify_step(content, Count(600), region_ratio=4.0)
    assert done.probe.region.max() == content.probe.region.max() == 1
    (carried,) = done.history[-1]["result"]["carried"]
    assert carried["after_mm2"] == pytest.approx(carried["before_mm2"], rel=0.05)
    assert carried["lost_mm2"] < 0.05 * carried["before_mm2"]
    assert set(done.history[-1]["result"]["regions"]) == {"0", "1"}
    assert made.count == len(done.probe.faces)


def test_a_deviation_is_kept_and_written_down(tmp_path):
    save_probe(bundled("linear", 2000), tmp_path / "probe.ply")
    done, made, _ = simplify_step(import_mesh(tmp_path / "probe.ply"), MaxDeviation(3e-4))
    assert made.deviation.hausdorff <= 3e-4
    step = done.history[-1]
    assert step["parameters"]["max_deviation_mm"] == pytest.approx(0.3)
    assert step["result"]["deviation"]["hausdorff_mm"] == pytest.approx(1e3 * made.deviation.hausdorff)
    assert step["result"]["facets"] < 2000


def test_prepare_leaves_a_mesh_in_its_own_frame_and_says_so(tmp_path):
    file = write_stl(tmp_path / "t.stl", bundled("t-shape", 2000))
    told = []
    done = prepare(file, facets=500, monitor=Monitor(told.append))
    assert steps_of(done.content) == ["import", "shell", "simplify"]
    assert done.shell.how == "unchanged"
    assert done.content.frame == "P"
    assert any("align it with the sensor before use" in sentence for sentence in done.sentences)
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1)
    assert done.to_json()["facets"] == 500


def test_the_result_is_checked_once(tmp_path, monkeypatch):
    """The simplification has checked what it gives, compared with the same shell."""
    file = write_stl(tmp_path / "t.stl", bundled("t-shape", 2000))
    monkeypatch.setattr(
        "contactbench.pipeline.preparation.prepare.check_soundness", lambda *_, **__: pytest.fail("again")
    )
    done = prepare(file, facets=500)
    assert done.ready
    assert done.soundness.largest_deviation_deg is not None


def test_prepare_can_be_stopped(hollow):
    with pytest.raises(Cancelled):
        prepare(hollow, facets=500, monitor=Monitor(cancelled=lambda: True))


def test_units_decide_the_size_and_nothing_else(tmp_path):
    probe = bundled("linear", 2000)
    made = []
    for scale, unit in ((1000.0, "mm"), (1.0, "m"), (1 / 0.0254, "in")):
        file = tmp_path / f"{unit}.obj"  # in full precision: STL rounds, and every unit otherwise
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (probe.vertices * scale).tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (probe.faces + 1).tolist()]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        made.append(prepare(file, units=unit, facets=400).content.probe)
    for other in made[1:]:
        assert np.array_equal(other.faces, made[0].faces)
        assert other.vertices == pytest.approx(made[0].vertices, abs=1e-6 * probe.size)


def test_a_saved_probe_can_be_used_at_once(tmp_path):
    file = write_stl(tmp_path / "t.stl", bundled("t-shape", 2000))
    save_probe_file(prepare(file, facets=500).content, tmp_path / "probe.ply")
    assert load_probe(tmp_path / "probe.ply", "m").health.sentences == ()
    assert len(load_probe_file(tmp_path / "probe.ply").history) == 3


def test_by_default_few_facets_are_kept_and_an_excess_is_told_first(tmp_path):
    file = write_stl(tmp_path / "t.stl", bundled("t-shape", 1_500))
    kept = prepare(file, units="mm")
    assert len(kept.content.probe.faces) == len(load_probe(file, units="mm").faces)
    spikes = prepare(file, units="mm", facets=4)
    assert spikes.sentences[0].endswith("on average.")
    assert "more than the requested 4" in spikes.sentences[0]


# ---- the fewest facets under a contact error: under it, and not many more than needed ------------


QUICK = ExpectedTouches(count=500)


def test_the_criterion_is_the_distance_that_contacts_move() -> None:
    full = bundled("convex", 5_000, regions=True)
    errors = {name: contact_error_criterion(full, QUICK, name) for name in ("mean", "p95", "max")}
    assert [error(full) for error in errors.values()] == [0, 0, 0]
    coarse = simplify(full, Count(300)).probe
    assert 0 < errors["mean"](coarse) < errors["p95"](coarse) < errors["max"](coarse) < 5e-3


def test_lost_touches_make_it_infinite() -> None:
    probe = ball(1280)
    away = Probe.from_arrays(probe.vertices + [0.5, 0, 0], probe.faces)
    assert contact_error_criterion(probe, QUICK)(away) == math.inf
    # Half the ball is left: what is settled on it is where it was, or at the rim, if noise may have put it beyond; but
    # half of the touches are lost.
    half = Probe.from_arrays(probe.vertices, probe.faces[probe.normals[:, 2] > 0])
    assert contact_error_criterion(probe, QUICK)(half) == math.inf
    assert contact_error_criterion(probe, QUICK, "mean", failed=1.0)(half) < 0.3e-3


def test_the_fewest_facets_keep_the_limit_and_a_tighter_one_needs_more() -> None:
    full = bundled("linear", 10_000, regions=True)
    measure = contact_error_criterion(full, QUICK)
    found = [simplify(full, contact_target(full, limit, QUICK)[0]) for limit in (0.2e-3, 0.05e-3)]
    assert [measure(one.probe) <= limit for one, limit in zip(found, (0.2e-3, 0.05e-3), strict=True)] == [
        True
    ] * 2
    assert 4 < found[0].count < found[1].count < 10_000
    fewer = simplify(full, Count(round(0.8 * found[1].count))).probe
    assert measure(fewer) > 0.02e-3
