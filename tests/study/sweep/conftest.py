"""A small sweep, computed once."""

import pytest

from contactbench.pipeline.study.sweep.plan import SweepPlan
from contactbench.pipeline.study.sweep.run import run

SMALL = {
    "name": "small",
    "methods": ["contactbench", "wrench_axis"],
    "probes": ["linear"],
    "facets": [300, 600, 1200],
    "forces": [2, 9, 20],
    "angles": [0, 30, 60],
    "noises": ["none", "paper"],
    "touches": 60,
}


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    """The folder of a sweep of 108 cells, times and all."""
    folder = tmp_path_factory.mktemp("studies") / "small"
    run(SweepPlan.of(SMALL), folder, workers=1, command="contactbench study run small.toml")
    return folder


@pytest.fixture(scope="session")
def rows(small):
    from contactbench.pipeline.study.pages import read_results

    return list(read_results(small).rows)
