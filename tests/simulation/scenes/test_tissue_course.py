"""Tissue that becomes stiffer or softer while it is pressed."""

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import truth_of
from contactbench.pipeline.simulation.scenes.platform import PlatformScene, Tissue, TissueCourse

QUICK = {"step": 0.002, "places": 40}


def forces(course, until=0.5):
    # So soft that the mount does not yield.
    tissue = Tissue(1e5, 2e3, 0.0, course=course)
    scene = PlatformScene(truth_of("t-shape"), tissue=tissue, gap=-0.002, **QUICK)
    found = []
    while scene.time < until - 1e-9:
        scene.advance(0.05)
        found.append(scene.moment().force)
    return np.array(found)


def test_between_two_times_the_logarithm_goes_evenly():
    course = TissueCourse((1.0, 1.2), (1.0, 4.0))
    assert [course.at(time) for time in (0.0, 1.0, 1.1, 1.2, 9.0)] == pytest.approx([1, 1, 2, 4, 4])


def test_what_is_three_times_as_stiff_pushes_three_times_as_hard():
    steady, stiffer = forces(None), forces(TissueCourse((0.2, 0.3), (1.0, 3.0)))
    np.testing.assert_array_equal(stiffer[:4], steady[:4])
    assert stiffer[-1] == pytest.approx(3 * steady[-1], rel=0.03)
    assert steady[-1] < stiffer[4] < stiffer[-1]


def test_it_may_begin_as_another():
    assert forces(TissueCourse((0.0,), (0.5,)))[-1] == pytest.approx(0.5 * forces(None)[-1], rel=0.03)


@pytest.mark.parametrize(
    ("times", "factors"),
    [((), ()), ((0.0, 1.0), (1.0,)), ((1.0, 1.0), (1.0, 2.0)), ((0.0,), (0.0,)), ((np.nan,), (1.0,))],
)
def test_what_is_no_course_is_refused(times, factors):
    with pytest.raises(InputError, match="course"):
        TissueCourse(times, factors)
