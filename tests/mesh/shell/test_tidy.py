"""Slivers that cutting leaves are joined to what lies beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mesh.shell.housings import box

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.health import measure_health
from contactbench.pipeline.mesh.shell.result import HULL, Shell
from contactbench.pipeline.mesh.shell.shell import _tidied
from contactbench.pipeline.mesh.shell.tidy import without_slivers
from contactbench.pipeline.mesh.soundness import check_soundness

WIDTH = 1e-3
VERTICES, FACES = box([0, 0, 0], [1, 1, 1])


def inserted(point):
    """The unit box with a point put into its first facet, as three facets in its place; the last ones."""
    a, b, c = FACES[0]
    new = np.array([[a, b, 8], [b, c, 8], [c, a, 8]], dtype=np.int32)
    return np.concatenate((VERTICES, [point])), np.concatenate((FACES[1:], new))


def volume(vertices, faces):
    corners = vertices[faces]
    return np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6


A, B, C = VERTICES[FACES[0]]


@pytest.mark.parametrize(
    "point",
    [
        A + 1e-5 * (B - A) + 1e-6 * (C - A),  # beside a corner: needles
        0.5 * (A + B) + 1e-6 * (C - A),  # beside an edge: a facet with hardly any height
        0.5 * (A + B) - 1e-6 * (C - A),  # on its other side: folded over
        0.5 * (A + B) + 1e-5 * np.array([0, 0, 1]),  # and steep
    ],
)
def test_a_sliver_goes_and_the_surface_stays(point):
    vertices, faces = inserted(point)
    sliver = np.array([len(faces) - 3])
    tidy, of = without_slivers(vertices, faces, sliver, WIDTH)
    health = measure_health(vertices, tidy)
    assert health.watertight
    assert health.winding_consistent
    assert len(of) == len(tidy) == len(FACES)
    assert volume(vertices, tidy) == pytest.approx(1, abs=1e-4)
    assert check_soundness(vertices, tidy, (VERTICES, FACES)).sound


def test_what_is_wider_stays():
    vertices, faces = inserted(0.5 * (A + B) + 0.1 * (C - A))
    tidy, of = without_slivers(vertices, faces, np.arange(len(faces)), WIDTH)
    assert np.array_equal(tidy, faces)
    assert np.array_equal(of, np.arange(len(faces)))


def test_a_shell_that_folds_in_a_sliver_only_is_mended_and_says_what_is_invented():
    vertices, faces = inserted(0.5 * (A + B) - 2e-6 * (C - A) + 1e-5 * np.array([0, 0, 1]))
    base = Probe.from_arrays(VERTICES, FACES, check_size=False)
    invented = np.zeros(len(faces), dtype=bool)
    invented[0] = True
    made = Probe.from_arrays(vertices, faces, invented=invented, check_size=False)
    found = check_soundness(vertices, faces, (VERTICES, FACES), invented=invented)
    assert not found.sound
    shell = _tidied(replace(Shell(made, HULL, ()), soundness=found), base)
    assert shell.soundness.sound
    assert shell.probe.invented.sum() == 1
    assert shell.probe.areas[shell.probe.invented] == pytest.approx(0.5)
