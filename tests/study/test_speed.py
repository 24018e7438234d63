"""The speed study in short: its figures exist and agree with each other; no time is asserted."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from contactbench.pipeline.cli import app
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study import speed


@pytest.fixture(scope="module")
def report() -> speed.SpeedReport:
    return speed.run("linear", (500, 1000), touches=1_000, stream=3_000, rounds=1, seed=3)


def test_every_method_is_measured_at_every_resolution(report):
    compiled = {(r.method, r.facets) for r in report.rows if r.language == "C++"}
    for method in ("algorithm1", "iterative", "scan", "contactbench", "contactbench, tracking"):
        assert len([m for m, _ in compiled if m == method]) == 2
    assert all(0 < r.timing.median <= r.timing.p99 for r in report.rows)
    batched = {r.method for r in report.rows if r.language == "Python, batch"}
    assert "contactbench" in batched
    if any(r.method == "embree, one ray" for r in report.rows):
        assert batched == {"contactbench", "embree, first hit", "embree, every hit"}


def test_every_hit_of_a_ray_through_a_box_is_found():
    pytest.importorskip("embreex", reason="Embree's bindings are an extra")
    from benchmarks.plane import _block

    from contactbench.pipeline.contact import ContactSolver
    from contactbench.pipeline.contact.wrench_axis import EmbreeAxis

    axis = EmbreeAxis(ContactSolver(_block()))
    origins = np.array(
        [[0.001, 0.002, 1.0], [1.0, 0.0, 1.0]], np.float32
    )  # about the box's middle: 0.1 m high
    rays, distances = speed.every_hit(axis, origins, np.array([[0, 0, -1.0]] * 2, np.float32))
    assert rays.tolist() == [0, 0]
    assert distances == pytest.approx([0.95, 1.05], abs=1e-4)


def test_errors_are_reported_in_mm_and_over_the_bound(report):
    [ours] = [r for r in report.rows if r.method == "contactbench" and r.mean_mm and r.facets > 700]
    assert 0.3 < ours.mean_mm < 3
    # A thousand flat facets add to the noise; the bound knows only the noise, and nothing of a small torsion.
    assert 0.9 < ours.over_bound < 1.6
    assert 0.9 < ours.settled <= ours.answered <= 1


def test_tracking_never_differs_and_the_count_could_say_otherwise(report):
    assert report.stream_samples == 3_000
    assert report.stream_differences == 0

    class Forgetful:
        """A tracker that is a sample late."""

        def __init__(self, solver):
            self._solver, self.gates = solver, solver.gates

        def reset(self):
            self._solver.reset()

        def track_batch(self, wrenches):
            return self._solver.track_batch(np.roll(wrenches, 1, axis=0))

        def locate_batch_after(self, wrenches, previous):
            return self._solver.locate_batch_after(wrenches, previous)

    from contact_cases import bundled, random_wrenches

    from contactbench.pipeline.contact import ContactSolver

    probe = bundled("linear", 500)
    wrenches = random_wrenches(probe, 100, np.random.default_rng(0), pitch=0.0, angle=30)
    assert speed.stream_differences(Forgetful(ContactSolver(probe)), wrenches) > 50


def test_report_is_plain_data(report):
    data = json.loads(json.dumps(report.to_json()))
    assert {t["verdict"] for t in data["targets"]} <= {"met", "missed"}
    text = report.markdown()
    assert "contactbench, tracking" in text
    assert "differed from cold solves on 0 samples" in text
    assert len(report.tables()) == 2


def test_targets_are_judged_both_ways():
    assert speed.SpeedTarget("a", 2.0, 1.0).verdict == "missed"
    assert speed.SpeedTarget("a", 2.0, 1.0, at_least=True).verdict == "met"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--probe", "banana"], "choose one of linear, convex, t-shape"),
        (["--facets", "10"], "too coarse"),
        (["--facets", "many"], "not a whole number"),
        (["--touches", "5"], "at least 1000"),
        (["--facets", "500,501"], "too close to tell apart"),
    ],
)
def test_wrong_options_are_named(arguments, said):
    result = CliRunner().invoke(app, ["study", "speed", *arguments])
    assert result.exit_code == 2
    assert said in result.stderr


def test_unknown_probe_in_the_library():
    with pytest.raises(InputError, match="banana"):
        speed.run("banana")
