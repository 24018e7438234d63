"""Ray tracers that can be asked where the wrench axis enters a probe: Open3D's and point-cloud-utils'."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.contact.wrench_axis import EmbreeAxis, WrenchAxis
from contactbench.pipeline.study.rivals.rows import Contender

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.contact import ContactSolver

_NONE = np.iinfo(np.uint32).max


class Open3DAxis(WrenchAxis):
    """The wrench axis traced by Open3D's RaycastingScene; ImportError where it cannot be had."""

    def __init__(self, solver: ContactSolver) -> None:
        self._open3d: Any = import_module("open3d")
        super().__init__(solver)
        vertices, faces = self._single
        core = self._open3d.core
        self.scene = self._open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(core.Tensor(vertices), core.Tensor(faces.astype(np.uint32)))

    def prepared(self, origins: NDArray[np.float32], directions: NDArray[np.float32]) -> Any:
        """Return rays as the library wants them."""
        return self._open3d.core.Tensor(np.hstack([origins, directions]))

    def trace(self, origins: NDArray[np.float32], directions: NDArray[np.float32]) -> NDArray[np.int32]:
        """Return the first facet that each ray enters; see `WrenchAxis`."""
        hits = self.scene.cast_rays(self.prepared(origins, directions))["primitive_ids"].numpy()
        return np.where(hits == _NONE, -1, hits.astype(np.int64)).astype(np.int32)


class PointCloudUtilsAxis(WrenchAxis):
    """The wrench axis traced by point-cloud-utils; ImportError where it cannot be had."""

    def __init__(self, solver: ContactSolver) -> None:
        library: Any = import_module("point_cloud_utils")
        super().__init__(solver)
        self.scene = library.RayMeshIntersector(*self._single)

    def trace(self, origins: NDArray[np.float32], directions: NDArray[np.float32]) -> NDArray[np.int32]:
        """Return the first facet that each ray enters; see `WrenchAxis`."""
        faces, _, far = self.scene.intersect_rays(origins, directions)
        return np.where(np.isfinite(far), faces, -1).astype(np.int32)


EMBREE, OPEN3D, PCU = (
    Contender("wrench axis, embreex", "embreex"),
    Contender("wrench axis, Open3D", "open3d-cpu"),
    Contender("wrench axis, point-cloud-utils", "point-cloud-utils"),
)
TRACERS: dict[Contender, Callable[[ContactSolver], WrenchAxis]] = {
    EMBREE: EmbreeAxis,
    OPEN3D: Open3DAxis,
    PCU: PointCloudUtilsAxis,
}


def bare_ray(axis: WrenchAxis) -> tuple[Callable[[Any], object], Callable[[Any, Any], Any]]:
    """Return the library's own call for one ray, and what makes its argument of an origin and a direction (1, 3)."""
    if isinstance(axis, EmbreeAxis):
        scene = axis.scene
        return lambda ray: scene.run(ray[0], ray[1], query="INTERSECT"), lambda origin, along: (origin, along)
    if isinstance(axis, Open3DAxis):
        return axis.scene.cast_rays, axis.prepared
    intersect = axis.scene.intersect_rays  # type: ignore[attr-defined]
    return lambda ray: intersect(ray[0], ray[1]), lambda origin, along: (origin, along)
