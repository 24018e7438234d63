from benchmarks.verification import SCENARIOS, clustered, run


def test_every_figure_is_measured_and_none_is_far_from_its_target():
    report = run(trials=20, seed=1)
    assert len(report.figures) == 4 + len(SCENARIOS) + 1
    # One bench of each scenario: its cause is told first, and nothing that is not there.
    assert report.passed, report.markdown()


def test_intervals_hold_where_the_touches_of_a_marker_are_alike():
    assert all(figure.passed for figure in clustered(40, 2))
