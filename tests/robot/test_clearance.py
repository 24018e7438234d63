"""Conflicts against hand-made poses and against distances found by brute force."""

from math import pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import ELFIN3, Clearance, ClearanceCheck
from contactbench.pipeline.robot.clearance import Capsule

pytest.importorskip("mujoco")

DOWN = np.array([0, 0, pi / 2, 0, pi / 2, 0])  # the flange 303.5 mm above the table, looking down
NO_FLOOR = -np.inf
inside = st.tuples(*(st.floats(joint.lower, joint.upper) for joint in ELFIN3.joints)).map(np.array)


def check(**options) -> ClearanceCheck:
    return ClearanceCheck(ELFIN3, Clearance(**options))


def test_standing_up_and_looking_down_are_clear():
    assert check().conflict(np.zeros(6)) is None
    assert check().conflict(DOWN) is None


@pytest.mark.parametrize("radius", [0.03, 0.05])
@pytest.mark.parametrize("z_min", [-0.1, 0.0, 0.05])
def test_the_floor_counts_from_the_tip(radius, z_min):
    length = 0.3035 - z_min - radius - 0.02
    options = {"tool_radius": radius, "z_min": z_min}
    assert check(p_ET_E=(0, 0, length - 1e-9), **options).conflict(DOWN) is None
    assert check(p_ET_E=(0, 0, length + 1e-9), **options).conflict(DOWN) == "tool to floor"


def test_without_tool_or_floor_less_is_in_the_way():
    sunk = [0, 2.0, 0, 0, 0, 0]  # forward and down: the whole arm lies below the table
    assert check(p_ET_E=(0, 0, 0)).conflict(sunk) == "elbow to floor"
    assert check(p_ET_E=(0, 0, 0), z_min=NO_FLOOR).conflict(sunk) is None


def test_a_long_tool_folded_back_meets_the_forearm():
    folded = [0, 0, 0, 0, 2.3, 0]
    assert check(p_ET_E=(-0.1, -0.1, 0.2)).conflict(folded) == "tool to forearm"
    assert check(p_ET_E=(0, 0, 0)).conflict(folded) is None


def test_gaps_that_no_joint_changes_are_not_watched():
    sunk = [0, 2.0, 0, 0, 0, 0]
    assert check().conflict(sunk, moving=[0, 0, 0, 1, 1, 1]) == "forearm to floor"
    assert check(p_ET_E=(0, 0, 0)).conflict(sunk, moving=[0, 0, 0, 0, 0, 0]) is None
    # J1 swings the whole arm over the floor, but nothing on the arm comes nearer to anything else on it.
    folded = [0, 0, 0, 0, 2.56, 0]
    assert check().conflict(folded) == "hand to elbow"
    assert check().conflict(folded, moving=[1, 0, 0, 0, 0, 0]) is None
    assert check().path_conflict(folded, [1, 0, 0, 0, 2.56, 0]) is None


def test_the_tool_is_fixed_to_the_flange():
    # A tool sideways along -x of E points forward when the arm looks down: it misses the table.
    assert check(p_ET_E=(0, 0, 0.4)).conflict(DOWN) == "tool to floor"
    assert check(p_ET_E=(-0.4, 0, 0)).conflict(DOWN) is None


def brute_gap(poses, distance_of: Clearance) -> float:
    """Smallest gap between capsules that may touch, from points along their axes."""
    tip = np.add(ELFIN3.flange_xyz, distance_of.p_ET_E)
    capsules = [*ELFIN3.capsules, Capsule("tool", 6, ELFIN3.flange_xyz, tuple(tip), distance_of.tool_radius)]
    s = np.linspace(0, 1, 201)[:, None]
    axes = []
    for capsule in capsules:
        points = (1 - s) * capsule.start_xyz + s * capsule.end_xyz
        axes.append(points @ poses[capsule.body][:3, :3].T + poses[capsule.body][:3, 3])
    gaps = [np.inf]
    for i, a in enumerate(capsules):
        for j, b in enumerate(capsules[:i]):
            if abs(a.body - b.body) > 1 and (b.name, a.name) not in ELFIN3.never_touch:
                apart = np.linalg.norm(axes[i][:, None] - axes[j], axis=-1).min()
                gaps.append(apart - a.radius - b.radius)
        if a.body > 0:
            gaps.append(axes[i][:, 2].min() - a.radius - distance_of.z_min)
    return min(gaps)


@settings(max_examples=60, deadline=None)
@given(q=inside, z_min=st.sampled_from([-1e3, 0.0]))
def test_conflicts_are_those_of_brute_force(link_poses, q, z_min):
    clearance = Clearance(z_min=z_min, p_ET_E=(0.03, 0, 0.2))
    gap = brute_gap(link_poses(ELFIN3, q), clearance)
    assume(abs(gap - clearance.distance) > 1e-4)  # what the points miss
    assert (ClearanceCheck(ELFIN3, clearance).conflict(q) is None) == (gap > clearance.distance)


def test_a_way_between_clear_ends_may_not_be_clear():
    long_tool = check(p_ET_E=(0, 0, 0.3))
    left, right = DOWN + [0, 0, 0, -0.8, 0, 0], DOWN + [0, 0, 0, 0.8, 0, 0]
    assert long_tool.conflict(left) is None
    assert long_tool.conflict(right) is None
    assert long_tool.path_conflict(left, right) == "tool to floor"
    assert check().path_conflict(left, right) is None
    assert long_tool.path_conflict(left, left) is None


@settings(max_examples=30, deadline=None)
@given(a=inside, b=inside)
def test_a_clear_way_stays_clear_between_the_samples(a, b):
    # A sample every 0.02 rad with gaps of 20 mm: in between, at least 20 mm - 0.01 rad x 1.2 m = 8 mm remain.
    coarse, fine = check(distance=0.02, z_min=-0.3), check(distance=0.008, z_min=-0.3)
    if coarse.path_conflict(a, b) is None:
        assert fine.path_conflict(a, b, step=0.005) is None


def test_unusable_questions_are_refused():
    with pytest.raises(InputError, match="finite"):
        check().conflict([np.nan] * 6)
    with pytest.raises(InputError, match="finite"):
        check().path_conflict(np.zeros(6), [np.inf] * 6)
    with pytest.raises(InputError, match="moving"):
        check().conflict(np.zeros(6), moving=[True])
    with pytest.raises(InputError, match="step"):
        check().path_conflict(np.zeros(6), np.ones(6), step=0)
