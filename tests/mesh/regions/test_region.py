"""Regions as values."""

from __future__ import annotations

import numpy as np
import pytest

from contactbench.pipeline.mesh import MeshError
from contactbench.pipeline.mesh.regions import PALETTE, Region, RegionError, RegionSet
from contactbench.pipeline.mesh.regions.region import MOST_REGIONS, free_colour, free_name


def test_names_and_colours_are_normalised() -> None:
    assert Region("  Le\u0301ns ", "#E69F00") == Region("L\u00e9ns", "#e69f00")


@pytest.mark.parametrize("name", ["", "   ", "x" * 65, "a\nb", "a\x00b", "\u202eevil", "\ud800"])
def test_names_that_cannot_be_shown_are_refused(name: str) -> None:
    with pytest.raises(RegionError, match="name"):
        Region(name, "#000000")


@pytest.mark.parametrize("colour", ["", "red", "#12345", "#1234567", "#12345g", "#123456\n", " #123456"])
def test_colours_that_are_none_are_refused(colour: str) -> None:
    with pytest.raises(RegionError, match="#rrggbb"):
        Region("a", colour)


def test_labels_must_be_ranks() -> None:
    one = (Region("a", "#000000"),)
    with pytest.raises(RegionError, match="facet 2 has the region 2, but there are 1"):
        RegionSet(one, np.array([0, 1, 2], dtype=np.int32))
    with pytest.raises(MeshError, match="row 0 is -1"):
        RegionSet(one, np.array([-1], dtype=np.int32))
    with pytest.raises(RegionError, match="two regions are called 'a'"):
        RegionSet(one + one, np.zeros(3, dtype=np.int32))


def test_a_set_does_not_follow_the_array_it_was_made_of() -> None:
    labels = np.array([0, 1], dtype=np.int32)
    made = RegionSet((Region("a", "#000000"),), labels)
    labels[:] = 0
    assert made.labels.tolist() == [0, 1]
    assert not made.labels.flags.writeable


def test_labels_alone_get_names_and_colours() -> None:
    made = RegionSet.from_labels([0, 3, 1], [Region("Lens", PALETTE[0])])
    assert [region.name for region in made.regions] == ["Lens", "Region 2", "Region 3"]
    assert [region.colour for region in made.regions] == list(PALETTE[:3])
    with pytest.raises(RegionError, match="at most 255"):
        RegionSet.from_labels([MOST_REGIONS + 1])


def test_free_names_and_colours() -> None:
    taken = [Region("Region 3", PALETTE[1]), Region("x", PALETTE[0])]
    assert free_name(taken) == "Region 4"
    assert free_colour(taken) == PALETTE[2]
    every = [Region(str(number), colour) for number, colour in enumerate(PALETTE)]
    assert free_colour(every) == PALETTE[0]


def test_areas_and_ranks() -> None:
    made = RegionSet.from_labels([0, 1, 2, 1], [Region("a", "#000000"), Region("b", "#000000")])
    np.testing.assert_allclose(made.areas(np.array([1.0, 2.0, 4.0, 8.0])), [10, 4])
    assert RegionSet.empty(4).areas(np.ones(4)).shape == (0,)
    assert made.rank_of(" b ") == 2
    with pytest.raises(RegionError, match="choose one of: a, b"):
        made.rank_of("c")


def test_ranks_that_nothing_can_touch() -> None:
    regions = (Region("Lens", "#e69f00"), Region("Clamp", "#000000", untouchable=True))
    made = RegionSet.from_labels([0, 2, 4, 3], regions, untouchable=(1, 4))
    # What is known of a region counts more than what the labels' file says of its number.
    assert made.untouchable == (2, 4)
    assert RegionSet.from_labels([1]).untouchable == ()
