"""The cases of the benchmark are what they say, and it judges what it should."""

import json

import numpy as np
import pytest
from benchmarks import confidence as cases


@pytest.mark.parametrize("thickness", cases.FINS_M)
def test_a_fin_is_a_closed_body_and_its_edge_is_the_outermost(thickness):
    probe, edge = cases.make_fin(thickness)
    assert probe.health.watertight
    assert probe.health.outward
    assert probe.health.components == 1
    points, normals = edge.sample(200, np.random.default_rng(0))
    assert points[:, 0] == pytest.approx(0.027)
    assert np.abs(points[:, 1]).max() <= thickness / 2
    assert normals == pytest.approx(np.tile([1.0, 0.0, 0.0], (200, 1)))


def test_the_command_judges_fins_regions_and_gentle_pulls(benchmark):
    ran = benchmark(
        "confidence", "--probes", "linear", "--touches", 100, "--seeds", 1, "--facets", 500, "--json"
    )
    report = json.loads(ran.stdout)
    assert ran.exit_code == (0 if report["passed"] else 1), ran.stderr
    judged = {figure["subject"] for figure in report["figures"] if figure["target"]}
    assert len(judged) == 6 + 1 + 4
    assert not any("0.5 N" in subject for subject in judged)
