"""What came of making a shell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pipeline.mesh.shell.patch import Closing

if TYPE_CHECKING:
    from pipeline.mesh.probe import Probe
    from pipeline.mesh.regions import RegionReport
    from pipeline.mesh.shell.fit import ShellFit
    from pipeline.mesh.shell.openings import Opening

UNCHANGED, REPAIRED, WRAPPED = "unchanged", "repaired", "wrapped"


@dataclass(frozen=True, eq=False)
class ClosedOpening:
    """
    An opening, and what was done about it.

    Attributes
    ----------
    opening : Opening
    closing : Closing
        FAIR, RULED, HULL, or OPEN where it was left as it is.
    """

    opening: Opening
    closing: Closing

    @property
    def sentence(self) -> str:
        """What was done, in words."""
        how = {
            Closing.FAIR: "closed by a fair surface",
            Closing.RULED: "closed by straight lines between its long rims",
            Closing.HULL: "closed by the hull of its rim",
            Closing.OPEN: "left open",
        }[self.closing]
        return f"{self.opening.sentence}: {how}."

    def to_json(self) -> dict[str, Any]:
        """Give the opening as plain values, millimetres."""
        o = self.opening
        return {
            "centre_mm": [round(1e3 * float(x), 3) for x in o.centre],
            "outwards": [round(float(x), 5) for x in o.axes[2]],
            "length_mm": round(1e3 * o.length, 3),
            "width_mm": round(1e3 * o.width, 3),
            "depth_mm": round(1e3 * o.depth, 3),
            "perimeter_mm": round(1e3 * o.perimeter, 3),
            "closing": self.closing.value,
        }


@dataclass(frozen=True, eq=False)
class Shell:
    """
    A probe's outer surface.

    Attributes
    ----------
    probe : Probe
        The shell; ``probe.invented`` marks facets that close openings or bridge gaps. Its regions are those of
        the original.
    how : str
        "unchanged" (the same object as given), "repaired" (vertices as they were) or "wrapped".
    openings : tuple of ClosedOpening
        Largest first.
    fit : ShellFit or None
        How far shell and original lie apart; None where nothing was moved.
    alpha : float or None
        Size of the wrap's facets, metres.
    turned, dropped : int
        Facets turned over or left out by a repair; of a wrap, those of specks beside the part.
    crossing : int
        Facets of a wrap that cut through others; 0 nearly always.
    gap : float or None
        What counted as a gap, metres.
    carried : tuple of RegionReport
        What a wrap did to the area of each region.
    """

    probe: Probe
    how: str
    openings: tuple[ClosedOpening, ...]
    fit: ShellFit | None = None
    alpha: float | None = None
    turned: int = 0
    dropped: int = 0
    crossing: int = 0
    gap: float | None = None
    carried: tuple[RegionReport, ...] = ()

    @property
    def invented_area(self) -> float:
        """Area of the invented facets, m²."""
        return float(self.probe.areas[self.probe.invented].sum())

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was done, in words."""
        out = [_HOW[self.how].format(turned=self.turned, dropped=self.dropped)]
        if self.how == WRAPPED and self.dropped:
            out.append(f"Specks beside the part were left out (facets: {self.dropped}).")
        if self.crossing:
            out.append(
                f"{self.crossing} facets cut through others: try another alpha, or look at the mesh there."
            )
        out += [f"Found {opening.sentence}" for opening in self.openings]
        if self.invented_area > 0:
            share = self.invented_area / self.probe.areas.sum()
            out.append(
                f"{1e6 * self.invented_area:.0f} mm² ({100 * share:.1f} %) of the shell is invented: a touch there"
                " rests on a guess. Measure the part, or ask for its drawing, if it will be touched."
            )
        if self.fit is not None:
            out.append(self.fit.sentence)
        return (*out, *(report.sentence for report in self.carried))

    def to_json(self) -> dict[str, Any]:
        """Give the result as plain values, without the mesh."""
        return {
            "how": self.how,
            "facets": len(self.probe.faces),
            "turned": self.turned,
            "dropped": self.dropped,
            "openings": [opening.to_json() for opening in self.openings],
            "invented_mm2": round(1e6 * self.invented_area, 2),
            "invented_share": round(self.invented_area / float(self.probe.areas.sum()), 6),
            "crossing": self.crossing,
            "gap_mm": None if self.gap is None else round(1e3 * self.gap, 4),
            "alpha_mm": None if self.alpha is None else round(1e3 * self.alpha, 4),
            "fit": None if self.fit is None else self.fit.to_json(),
            "regions": [report.to_json() for report in self.carried],
        }


_HOW = {
    UNCHANGED: "The mesh is its own outer shell: nothing was changed.",
    REPAIRED: "Facets turned: {turned}, left out: {dropped}; every vertex is where it was.",
    WRAPPED: "The outside was wrapped in a closed surface; inner walls and parts are gone.",
}
