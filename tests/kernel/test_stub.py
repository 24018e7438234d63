"""The hand-written stub of the compiled kernel says what is there at run time: no more, no less."""

import ast
import enum
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contactbench.pipeline import kernel
from contactbench.pipeline.gates import Gates

PACKAGE = Path(__file__).parents[2] / "pipeline" / "kernel"
STUB = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
VARIABLES = {
    node.target.id: ast.unparse(node.annotation)
    for node in STUB.body
    if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
}
FUNCTIONS = {node.name for node in STUB.body if isinstance(node, ast.FunctionDef)}
# What every class has; __len__ and __getitem__ are part of the interface, __repr__ is on every object.
PROTOCOL = {"__len__", "__getitem__"}


def methods(name: str) -> set[str]:
    return {node.name for node in CLASSES[name].body if isinstance(node, ast.FunctionDef)} - {"__init__"}


def properties(name: str) -> dict[str, str]:
    """Return the types of a class's properties."""
    found = {
        node.target.id: ast.unparse(node.annotation)
        for node in CLASSES[name].body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
    }
    assert all(each.startswith("Final[") for each in found.values())
    return {name: each.removeprefix("Final[")[:-1] for name, each in found.items()}


def solver(layers: int = 1, apart: tuple[float, float, float] = (0.0, 0.0, 0.02)) -> kernel.Solver:
    """Facets above each other, all of which answer a push from above; or `apart` in another direction."""
    triangle = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]])
    return kernel.Solver(
        np.concatenate([triangle + i * np.array(apart) for i in range(layers)]),
        np.arange(3 * layers, dtype=np.int32).reshape(layers, 3),
        np.zeros(layers, dtype=np.int32),
        np.diag([0.0025] * 3 + [4e-6] * 3),
        bonus=np.zeros(layers),
        torsion_arm=0.001,
        mesh_deviation=0.0,
        mesh_curved=True,
        gates=Gates().kernel_values(),
    )


ON_FACE = np.array([0.0, 0.0, -5.0, -0.01, 0.01, 0.0])
ON_NEXT = np.array([0.0, 0.0, -5.0, -0.01, 0.51, 0.0])  # 100 mm along x
OFF_FACE = np.array([0.0, 0.0, -5.0, 1.0, 1.0, 0.0])


def instances(name: str) -> list[Any]:
    s = solver()
    if name == "Contact":
        pair = solver(2, (0.1, 0.0, 0.0))
        pair.track_batch(np.tile(ON_FACE, (50, 1)))
        return [s.locate(ON_FACE), s.locate(OFF_FACE), pair.track(ON_FACE + ON_NEXT)]
    if name == "Batch":
        return [s.locate_batch([ON_FACE, OFF_FACE]), s.locate_batch(np.zeros((0, 6)))]
    if name == "Solver":
        tracked = solver()
        tracked.track(ON_FACE)
        return [s, tracked]
    return []


def test_module_names() -> None:
    assert set(CLASSES) | set(VARIABLES) | FUNCTIONS == set(kernel.__all__)
    assert VARIABLES == {"variant": "str", "compiler": "str"}
    assert isinstance(kernel.variant, str)
    assert isinstance(kernel.compiler, str)


@pytest.mark.parametrize("name", sorted(set(CLASSES) - {"Reason"}))
def test_members(name: str) -> None:
    cls = getattr(kernel, name)
    public = {each for each in vars(cls) if not each.startswith("_") or each in PROTOCOL}
    assert methods(name) | set(properties(name)) == public
    assert set(properties(name)) == {each for each, value in vars(cls).items() if isinstance(value, property)}


def test_reason() -> None:
    assert issubclass(kernel.Reason, enum.IntEnum)
    stub = {
        node.targets[0].id: ast.literal_eval(node.value)
        for node in CLASSES["Reason"].body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    assert stub == {reason.name: int(reason) for reason in kernel.Reason}


DTYPES = {"_Floats": np.float64, "_Ints": np.int32, "_Bytes": np.uint8, "_Bools": np.bool_}


def matches(value: object, annotation: str) -> bool:
    """Return whether a value is what one of the annotation's alternatives says."""
    for part in annotation.split(" | "):
        if part in DTYPES:
            if isinstance(value, np.ndarray) and value.dtype == DTYPES[part]:
                return True
        elif part == "None":
            if value is None:
                return True
        elif part.startswith("list["):
            if isinstance(value, list):
                return True
        elif type(value).__name__ == part:
            return True
    return False


@pytest.mark.parametrize("name", ["Contact", "Batch", "Solver"])
def test_property_types(name: str) -> None:
    """Each alternative of each annotation is one that occurs, and nothing else does."""
    for member, annotation in properties(name).items():
        values = [getattr(instance, member) for instance in instances(name)]
        for value in values:
            assert matches(value, annotation), f"{name}.{member}: {annotation}, got {value!r}"
        # A facet contact has no vertex number; every other optional is seen both ways.
        if " | None" in annotation and member != "vertex":
            assert {value is None for value in values} == {True, False}, f"{name}.{member}"


def test_candidate_property_types() -> None:
    contact = solver(layers=2).locate(ON_FACE)
    assert contact.candidates
    for member, annotation in properties("Candidate").items():
        value = getattr(contact.candidates[0], member)
        assert matches(value, annotation), f"Candidate.{member}: {value!r}"


def test_calls_that_the_stub_allows() -> None:
    s = solver()
    assert s.locate(list(ON_FACE)).reason is kernel.Reason.OK
    assert s.locate(ON_FACE, None).reason is kernel.Reason.OK
    assert s.locate(ON_FACE, previous=np.zeros(3)).reason is kernel.Reason.OK
    assert s.locate_exhaustively(ON_FACE).reason is kernel.Reason.OK
    assert s.track(ON_FACE, age=0.2).reason is kernel.Reason.STALE
    assert len(s.track_batch([ON_FACE], np.zeros(1))) == 1
    assert len(s.track_batch(ON_FACE[None])) == 1
    assert s.locate_batch([ON_FACE])[-1].reason is kernel.Reason.OK
    paraboloid = kernel.Iterative(s, np.zeros(3), np.eye(3), np.zeros(6), 0.1)
    for method in (kernel.Scan(s), kernel.Algorithm1(s), paraboloid):
        assert method.locate(ON_FACE).reason is kernel.Reason.OK
        assert len(method.locate_batch([ON_FACE, OFF_FACE])) == 2
        assert method.time_each(ON_FACE[None]).shape == (1,)
