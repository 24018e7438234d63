"""A figure keeps its bound or does not; rows survive being kept; sentences say what broke."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from contactbench.pipeline.study.stability.rows import PARTS, Row, of_part
from contactbench.pipeline.study.stability.verdicts import number, verdicts

ROW = Row("bias", "case", "double", "figure", "mm", 3, 1.0, 2.0, x=10.0, axis="ratio", most=2.0)


@pytest.mark.parametrize(
    ("worst", "most", "met"),
    [(2.0, 2.0, True), (2.1, 2.0, False), (9.0, None, True), (np.nan, 2.0, False), (np.inf, 2.0, False)],
)
def test_a_bound_is_kept_or_not(worst: float, most: float | None, met: bool) -> None:
    assert replace(ROW, worst=worst, most=most).met is met


def test_values_are_summed_up_without_those_that_are_none() -> None:
    row = Row.of("bias", "case", "double", "figure", "mm", [3.0, np.nan, 1.0, 2.0])
    assert (row.tries, row.median, row.worst) == (3, 2.0, 3.0)
    empty = Row.of("bias", "case", "double", "figure", "mm", [], most=1.0)
    assert empty.tries == 0
    assert not empty.met


@pytest.mark.parametrize("row", [ROW, replace(ROW, x=None, most=None, worst=np.nan)])
def test_rows_are_plain_data_and_come_back(row: Row) -> None:
    data = json.loads(json.dumps(row.to_json(), allow_nan=False))
    assert repr(Row.from_json(data)) == repr(row)


def test_rows_are_picked_by_their_fields() -> None:
    rows = [ROW, replace(ROW, by="single"), replace(ROW, part="units")]
    assert of_part(rows, "bias") == rows[:2]
    assert of_part(rows, "bias", by="single") == [rows[1]]


def test_a_part_that_was_not_measured_says_so() -> None:
    said = verdicts([])
    assert [v.part for v in said] == list(PARTS)
    assert all(v.passed is None and "Not measured" in v.words for v in said)


def test_figures_for_people() -> None:
    assert number(0.012345) == "0.0123"
    assert number(float("nan")) == "-"
