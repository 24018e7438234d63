"""Every operation does what it says, and wrong input is refused before it reaches a library."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshError, engines
from contactbench.pipeline.mesh.engines.child import _CHILDREN, run
from contactbench.pipeline.mesh.engines.libraries import Library, Operation

Ball = tuple[np.ndarray, np.ndarray]


def _mesh(vertices: np.ndarray, faces: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(vertices, faces, process=False)


def test_alpha_wrap_takes_absolute_lengths(ball: Ball) -> None:
    open_ball = ball[1][50:]
    vertices, faces = engines.alpha_wrap(ball[0], open_ball, 20.0, 2.0)
    assert _mesh(vertices, faces).is_watertight
    radii = np.linalg.norm(vertices, axis=1)
    assert radii.max() == pytest.approx(52, abs=0.5)
    finer, _ = engines.alpha_wrap(ball[0], open_ball, 5.0, 2.0)
    assert len(finer) > 1.5 * len(vertices)


@pytest.mark.parametrize("lengths", [(0.0, 1.0), (1.0, -1.0), (float("nan"), 1.0), (1.0, float("inf"))])
def test_alpha_wrap_refuses_lengths_that_are_none(ball: Ball, lengths: tuple[float, float]) -> None:
    with pytest.raises(engines.EngineError, match="give a length above 0"):
        engines.alpha_wrap(*ball, *lengths)


def test_a_refusal_is_told_and_leaves_the_engine_warm(ball: Ball) -> None:
    engines.alpha_wrap(*ball, 20.0, 2.0)
    pid = _CHILDREN[Library.MESHLAB].pid
    beyond = {"vertices": ball[0], "faces": ball[1] + np.int32(1)}
    with pytest.raises(engines.EngineError, match=r"meshlab refused 'alpha wrap'"):
        run(Operation.ALPHA_WRAP, beyond, {"alpha": 20.0, "offset": 1.0})
    assert _CHILDREN[Library.MESHLAB].pid == pid


def coarse_wrap(vertices: np.ndarray, faces: np.ndarray) -> Ball:
    return engines.alpha_wrap(vertices, faces, 20.0, 2.0)


@pytest.mark.parametrize("operation", [coarse_wrap, engines.cut_along_crossings])
def test_what_would_crash_a_library_is_refused_at_the_door(ball: Ball, operation: object) -> None:
    with pytest.raises(MeshError, match="refers to vertex"):
        operation(ball[0], ball[1] + 1)
    holed = ball[0].copy()
    holed[5, 1] = np.nan
    with pytest.raises(MeshError, match="row 5"):
        operation(holed, ball[1])
