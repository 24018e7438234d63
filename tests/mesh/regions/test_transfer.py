"""Regions carried from one mesh to another."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshWarning, Probe
from contactbench.pipeline.mesh.regions import (
    FacetGraph,
    Region,
    RegionError,
    RegionSet,
    carry_labels,
    transfer,
)


def sphere(level: int, turn: float = 0.0) -> Probe:
    mesh = trimesh.creation.icosphere(level, radius=0.05)
    mesh.apply_transform(trimesh.transformations.rotation_matrix(turn, [1, 2, 3]))
    return Probe.from_arrays(mesh.vertices, mesh.faces)


def centroids(probe: Probe) -> np.ndarray:
    return probe.vertices[probe.faces].mean(axis=1)


def caps(probe: Probe) -> RegionSet:
    z = centroids(probe)[:, 2]
    labels = np.where(z > 0.03, 1, np.where(z < -0.02, 2, 0)).astype(np.int32)
    return RegionSet((Region("top", "#e69f00"), Region("bottom", "#56b4e9")), labels)


@pytest.mark.parametrize(("old", "new"), [(4, 3), (3, 4), (4, 4)])
def test_a_sphere_meshed_anew(old: int, new: int) -> None:
    one, other = sphere(old), sphere(new, 0.3)
    regions = caps(one)
    result = transfer(regions, one, other)
    assert result.regions.regions == regions.regions
    assert result.unmatched == 0
    truth = caps(other).labels
    edge = 0.005 * 2 ** (4 - min(old, new))
    z = centroids(other)[:, 2]
    inner = (np.abs(z - 0.03) > edge) & (np.abs(z + 0.02) > edge)
    assert np.count_nonzero(inner) > len(z) / 3
    assert result.regions.labels[inner].tolist() == truth[inner].tolist()
    for rank, part in enumerate(result.report, 1):
        assert part.before == pytest.approx(one.areas[regions.labels == rank].sum())
        assert part.after == pytest.approx(other.areas[result.regions.labels == rank].sum())
        assert abs(part.change) < 0.1
        assert 0 <= part.lost < 0.15 * part.before
        assert 0 <= part.gained < 0.15 * part.before


def test_the_same_mesh_renumbered_is_exact(rng: np.random.Generator) -> None:
    old = sphere(3)
    regions = caps(old)
    vertices, facets = rng.permutation(len(old.vertices)), rng.permutation(len(old.faces))
    number = np.argsort(vertices)
    new = Probe.from_arrays(old.vertices[vertices], np.roll(number[old.faces[facets]], 1, axis=1))
    for given in (vertices, None):
        result = transfer(regions, old, new, given)
        assert result.regions.labels.tolist() == regions.labels[facets].tolist()
        assert [(part.lost, part.gained) for part in result.report] == [(0, 0), (0, 0)]
        assert result.warnings == ()


def test_a_vertex_map_wins_over_place(rng: np.random.Generator) -> None:
    old = sphere(2)
    labels = rng.integers(0, 3, len(old.faces)).astype(np.int32)
    far = (old.vertices + 5.0, old.faces)
    identity = np.arange(len(old.vertices))
    carried, unmatched = carry_labels((old.vertices, old.faces), labels, far, vertex_map=identity, reach=0.01)
    assert carried.tolist() == labels.tolist()
    assert unmatched == 0
    some = identity.copy()
    some[old.faces[7]] = -1
    carried, unmatched = carry_labels((old.vertices, old.faces), labels, far, vertex_map=some, reach=0.01)
    touched = np.isin(old.faces, old.faces[7]).any(axis=1)
    assert carried[~touched].tolist() == labels[~touched].tolist()
    assert unmatched == np.count_nonzero(touched)


def test_a_thin_wall_does_not_take_the_other_side(plate: FacetGraph) -> None:
    """The new mesh is 0.7 mm lower than the old wall of 1 mm: the nearest facets are often the wrong side's."""
    old = plate.probe
    labels = np.where(old.normals[:, 2] > 0.5, 1, np.where(old.normals[:, 2] < -0.5, 2, 0)).astype(np.int32)
    new = (old.vertices - np.array([0, 0, 0.0007]), old.faces)
    carried, unmatched = carry_labels((old.vertices, old.faces), labels, new)
    flat = np.abs(old.normals[:, 2]) > 0.5
    assert carried[flat].tolist() == labels[flat].tolist()
    assert unmatched == 0


def test_a_region_that_vanished_is_told() -> None:
    old, new = sphere(4), sphere(0)
    labels = np.zeros(len(old.faces), dtype=np.int32)
    # A speck at a corner of the coarse mesh, where none of its centroids is.
    labels[np.argmin(np.linalg.norm(centroids(old) - new.vertices[0], axis=1))] = 1
    with pytest.warns(MeshWarning, match="speck .* vanished"):
        result = transfer(RegionSet((Region("speck", "#000000"),), labels), old, new, reach=0.02)
    (part,) = result.report
    assert part.vanished
    assert part.lost == part.before > 0
    assert "VANISHED" in part.sentence
    assert part.to_json()["after_mm2"] == 0


def test_what_is_far_away_belongs_to_nothing() -> None:
    old = sphere(3)
    new = Probe.from_arrays(old.vertices + [0.01, 0, 0], old.faces)
    with pytest.warns(MeshWarning, match="no part of the old surface near"):
        result = transfer(caps(old), old, new)
    assert result.unmatched > 100
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        assert transfer(caps(old), old, new, reach=0.02).unmatched < result.unmatched


def test_an_empty_region_did_not_vanish() -> None:
    probe = sphere(1)
    result = transfer(RegionSet((Region("a", "#000000"),), np.zeros(80, dtype=np.int32)), probe, probe)
    assert not result.report[0].vanished
    assert np.isnan(result.report[0].change)
    assert "empty before" in result.report[0].sentence


@pytest.mark.parametrize(
    ("vertex_map", "message"),
    [
        (np.zeros(3, dtype=int), "42 vertices"),
        (np.zeros(42), "float64"),
        (np.full(42, 42), "belongs to another mesh"),
        (np.full(42, -2), "belongs to another mesh"),
    ],
)
def test_wrong_maps_are_refused(vertex_map: Any, message: str) -> None:
    probe = sphere(1)
    with pytest.raises(RegionError, match=message):
        transfer(RegionSet.empty(80), probe, probe, vertex_map)


def test_regions_of_another_mesh_are_refused() -> None:
    with pytest.raises(RegionError, match="for 5 facets, but the old mesh has 80"):
        transfer(RegionSet.empty(5), sphere(1), sphere(1))
