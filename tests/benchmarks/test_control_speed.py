"""How quick control is: every figure is there and can be true; whether it is quick enough is for a quiet machine."""

from benchmarks.control_speed import run

from contactbench.pipeline.control.settings import Variant


def test_steps_and_simulation_are_timed_for_both_variants():
    told = []
    report = run("platform", "t-shape", seconds=5, progress=lambda done, total: told.append((done, total)))
    figures = {(f.subject, f.name): f.measured for f in report.figures}
    for variant in Variant:
        subject = f"platform, {variant}"
        median = figures[subject, "control step, median"]
        assert 0.01 < median <= figures[subject, "control step, 99th percentile"]
        assert figures[subject, "scene and controller, times real time"] > 0.05
        assert figures[subject, "time in track"] > 30
    assert (5, 5) in told
