from __future__ import annotations

import shutil
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest

from contactbench.pipeline import demo
from contactbench.pipeline.demo import bench, gravity, housing
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

TOUCHES = 40


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Most tests are about numbers: rendering would only take their time."""
    monkeypatch.setattr(bench, "draw", lambda _: b"")
    monkeypatch.setattr(gravity, "write_report", lambda *_, **__: None)


@pytest.fixture(autouse=True, scope="package")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Prepare each probe once: it gives the same every time, and is the longest part of a demo."""
    prepare = housing.prepare_probe

    @cache
    def made(name: str) -> tuple[Path, Any]:
        folder = tmp_path_factory.mktemp(name)
        return folder, prepare(folder, name)

    def copy(folder: Path, name: str) -> Any:
        source, result = made(name)
        shutil.copytree(source, folder, dirs_exist_ok=True)
        return result

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "prepare_probe", copy)
        patch.setattr(housing, "_CAD_FACETS", 10_000)
        yield


def missing() -> Any:
    raise InputError("the virtual bench needs MuJoCo: pip install 'contactbench[sim]'")


@pytest.fixture(scope="package")
def done(prepared: None, tmp_path_factory: pytest.TempPathFactory) -> demo.DemoReport:
    """Every probe, without the physics, which takes most of the time."""
    del prepared
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "draw", lambda _: b"")
        patch.setattr(bench, "physics", missing)
        return demo.run(tmp_path_factory.mktemp("demo"), touches=TOUCHES, seed=3)


@pytest.fixture(scope="package")
def benched(prepared: None, tmp_path_factory: pytest.TempPathFactory) -> demo.DemoReport:
    """The convex probe on the virtual bench."""
    del prepared
    pytest.importorskip("mujoco", reason="the virtual bench needs MuJoCo (extra sim)")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "draw", lambda _: b"")
        return demo.run(tmp_path_factory.mktemp("bench"), ["convex"], TOUCHES, seed=3)


@pytest.fixture
def no_bench(monkeypatch: pytest.MonkeyPatch) -> None:
    """A test of something else does without physics."""
    monkeypatch.setattr(bench, "physics", missing)
