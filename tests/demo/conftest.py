from collections.abc import Iterator
from typing import Any

import pytest

from contactbench.pipeline import demo
from contactbench.pipeline.demo import bench, gravity, housing
from contactbench.pipeline.errors import InputError

TOUCHES = 40


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Most tests are about numbers: rendering would only take their time."""
    monkeypatch.setattr(bench, "draw", lambda _: b"")
    monkeypatch.setattr(gravity, "write_report", lambda *_, **__: None)


@pytest.fixture(autouse=True, scope="package")
def prepared(prepare_once: Any) -> Iterator[None]:
    """Prepare each probe once: that is the longest part of a demo."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "prepare_probe", prepare_once)
        patch.setattr(housing, "_CAD_FACETS", 10_000)
        yield


def missing() -> Any:
    raise InputError("the virtual bench needs MuJoCo: pip install 'contactbench[sim]'")


@pytest.fixture(scope="package")
def done(prepared: None, once: Any) -> demo.DemoReport:
    """Every probe, without the physics, which takes most of the time."""
    del prepared
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "draw", lambda _: b"")
        patch.setattr(bench, "physics", missing)
        return once("demo", lambda folder: demo.run(folder, touches=TOUCHES, seed=3))[1]


@pytest.fixture(scope="package")
def benched(prepared: None, once: Any) -> demo.DemoReport:
    """The convex probe on the virtual bench."""
    del prepared
    pytest.importorskip("mujoco", reason="the virtual bench needs MuJoCo (extra sim)")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "draw", lambda _: b"")
        return once("bench", lambda folder: demo.run(folder, ["convex"], TOUCHES, seed=3))[1]


@pytest.fixture
def no_bench(monkeypatch: pytest.MonkeyPatch) -> None:
    """A test of something else does without physics."""
    monkeypatch.setattr(bench, "physics", missing)
