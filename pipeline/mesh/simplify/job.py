"""One simplification under way: reach a count by one recipe or the next, check what came out, remember it."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from pipeline.mesh import engines
from pipeline.mesh.errors import MeshError
from pipeline.mesh.probe import Probe
from pipeline.mesh.simplify.canonical import make_canonical
from pipeline.mesh.simplify.faults import OVER, find_faults
from pipeline.mesh.simplify.split import inside_count, simplify_apart

if TYPE_CHECKING:
    import numpy.typing as npt

    from pipeline.mesh.deviation import Comparison, Deviation, Reference
    from pipeline.mesh.simplify.recipe import Mesh, Recipe


@dataclass(frozen=True, eq=False)
class Attempt:
    """
    A simplified probe that passed the checks.

    Attributes
    ----------
    probe : Probe
        The result, with the regions of the nearest original facets.
    comparison : Comparison
        With the original.
    deviation : Deviation
        Over the whole surface.
    engine : str
        The recipe that made it.
    """

    probe: Probe
    comparison: Comparison
    deviation: Deviation
    engine: str


class Job:
    """
    The simplifications of one probe.

    Parameters
    ----------
    probe : Probe
        The original.
    reference : Future[Reference]
        The original made ready for comparing, when it is.
    recipes : tuple of Recipe
        In the order in which to try them.
    pick_best : bool
        Try all recipes and keep the smallest Hausdorff distance, instead of the first that passes.
    ratio : float
        Facets per area in the regions over that in the rest.
    control : Control
        For the engines.
    """

    def __init__(
        self,
        probe: Probe,
        reference: Future[Reference],
        recipes: tuple[Recipe, ...],
        *,
        pick_best: bool,
        ratio: float,
        control: engines.Control,
    ) -> None:
        self.probe = probe
        self.steps: list[str] = []
        self._reference = reference
        self._recipes = recipes
        self._pick_best = pick_best
        self._ratio = ratio
        self._control = control
        self._mesh = make_canonical(probe)
        self._made: dict[int, Attempt | MeshError] = {}
        self._over: list[Attempt] = []  # sound, but with a few facets more than asked for

    @property
    def reference(self) -> Reference:
        """The original, ready to be compared with; waits for it."""
        return self._reference.result()

    def unchanged(self) -> Attempt:
        """Return the original as an attempt."""
        return self._compared(self.probe, "none")

    def reach(self, count: int) -> Attempt:
        """
        Simplify to a count, or return what was made for it before.

        Parameters
        ----------
        count : int
            Facets, fewer than the original has.

        Returns
        -------
        Attempt

        Raises
        ------
        MeshError
            No recipe gave a usable mesh; says why each did not.
        Cancelled
            The caller cancelled.
        """
        if count not in self._made:
            try:
                self._made[count] = self._reach(count)
            except MeshError as error:
                self._made[count] = error
        made = self._made[count]
        if isinstance(made, MeshError):
            raise made
        return made

    def _reach(self, count: int) -> Attempt:
        made: list[Attempt] = []
        failed: list[str] = []
        self._over = []
        for recipe in self._recipes:
            attempt = self._try(recipe, count)
            if isinstance(attempt, str):
                failed.append(attempt)
                self.steps.append(attempt)
                continue
            made.append(attempt)
            self.steps.append(
                f"{recipe.name}: {len(attempt.probe.faces)} facets, within"
                f" {attempt.deviation.hausdorff * 1e3:.4g} mm of the original."
            )
            if not self._pick_best:
                break
        if not made and self._over:
            made = [min(self._over, key=lambda attempt: len(attempt.probe.faces))]
            self.steps.append(
                f"{made[0].engine}: {len(made[0].probe.faces)} facets, the nearest to {count} that is sound."
            )
        if not made:
            raise MeshError(
                f"the surface cannot be simplified to {count} facets: {' '.join(failed)} Ask for more facets, or"
                " repair the mesh first."
            )
        return min(made, key=lambda attempt: attempt.deviation.hausdorff)

    def _try(self, recipe: Recipe, count: int) -> Attempt | str:
        """Make an attempt, or say why it failed."""
        try:
            vertices, faces = self._simplified(recipe, count)
            made = Probe.from_arrays(self._mesh.back(vertices), faces, name=self.probe.name, check_size=False)
        except engines.EngineError as error:
            return f"{error}"
        except MeshError as error:
            return f"{recipe.name} made a mesh that is none ({error})"
        attempt = self._compared(made, recipe.name)
        faults = find_faults(self.probe, made, count, attempt.comparison)
        if not faults:
            return attempt
        if len(faults) == 1 and count < len(made.faces) <= OVER * count:
            self._over.append(attempt)
        return f"{recipe.name} {' and '.join(faults)} (asked for {count})."

    def _simplified(self, recipe: Recipe, count: int) -> Mesh:
        mesh = self._mesh
        if count >= len(mesh.faces):
            return mesh.vertices, mesh.faces
        inside = inside_count(count, self._ratio, self._region_share)
        if self._ratio == 1 or not 0 < inside < count:
            return recipe.simplify(mesh.vertices, mesh.faces, count, **self._control)
        return simplify_apart(recipe, mesh, count, inside, self._in_region, **self._control)

    def _compared(self, made: Probe, engine: str) -> Attempt:
        if made is not self.probe and (self.probe.region.any() or self.probe.invented.any()):
            nearest = self._nearest_facet(made.vertices, made.faces)
            made = made.with_region(self.probe.region[nearest], self.probe.untouchable)
            made = made.with_invented(self.probe.invented[nearest])
        comparison = self.reference.compare(made)
        deviation = comparison.deviation()
        if deviation is None:
            raise AssertionError("a surface without a mask always has samples")
        return Attempt(made, comparison, deviation, engine)

    @cached_property
    def _region_share(self) -> float:
        return float(self.probe.areas[self.probe.preferred].sum() / self.probe.areas.sum())

    def _in_region(
        self, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32]
    ) -> npt.NDArray[np.bool_]:
        return self.probe.preferred[self._nearest_facet(self._mesh.back(vertices), faces)]

    def _nearest_facet(
        self, vertices_m: npt.NDArray[np.float64], faces: npt.NDArray[np.int32]
    ) -> npt.NDArray[np.int32]:
        """For each facet the original one that its centre is nearest to: it takes over what that one is."""
        return self.reference.nearest_facet(vertices_m[faces].mean(axis=1))


def check_ratio(ratio: float) -> None:
    """
    Refuse a region ratio that is none.

    Raises
    ------
    MeshError
        Under 1 or over 100.
    """
    # not <=, so that NaN is refused too.
    if not 1 <= ratio <= 100:
        raise MeshError(
            f"the region ratio is {ratio:g}: give 1 for facets spread evenly, up to 100 for more in the regions."
        )
