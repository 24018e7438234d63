import numpy as np
from benchmarks.reproduce.mixes import PAPER, press_cell, run

from contactbench.pipeline.reality import Reality


def test_a_round_tip_errs_only_where_it_leans():
    straight, leaning = (press_cell((cell, Reality(tip=3), 0)) for cell in list(PAPER)[:2])
    assert leaning.mean() > straight.mean() + 0.8


def test_a_mix_is_measured_effect_by_effect():
    report = run("mount=20,tip=3", seeds=2, seed=0, workers=1)
    (sheet,) = report.sheets
    assert [row[0] for row in sheet.rows] == [
        "the paper",
        "none",
        "mount alone",
        "tip alone",
        "mount=20,tip=3",
    ]
    assert len(report.figures) == len(PAPER)
    assert all(np.isfinite(figure.measured) for figure in report.figures)
