"""What came of making a shell."""

from dataclasses import dataclass
from typing import Any

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.transfer import RegionReport
from contactbench.pipeline.mesh.shell.rim import Closing, Opening
from contactbench.pipeline.mesh.shell.wrap import ShellFit
from contactbench.pipeline.mesh.soundness import Soundness

UNCHANGED, HULL, WRAPPED = "unchanged", "hull", "wrapped"


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
            Closing.FAIR: message("closed by a smooth surface"),
            Closing.RULED: message("closed by straight lines between its long rims"),
            Closing.HULL: message("closed by the hull of its rim"),
            Closing.OPEN: message("left open"),
        }[self.closing]
        return message(f"{arg(self.opening.sentence)}: {arg(how)}.")

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
        "unchanged" (the same object as given), "hull" (the mesh's own facets, where they border the outside) or
        "wrapped" (new facets all over, where its own do not enclose a space).
    openings : tuple of ClosedOpening
        Largest first.
    fit : ShellFit or None
        How far shell and original lie apart; None where nothing was moved.
    alpha : float or None
        Size of the wrap's facets, metres.
    turned, dropped : int
        Facets turned over, and left out because they do not border the outside; of a wrap, those of specks beside it.
    cut : int
        Facets cut along the lines where others crossed them.
    sheets : int
        Facets left out because they had the outside on both sides.
    small_holes : int
        Holes closed that are too narrow to be listed.
    parted : int
        Vertices doubled because bodies only met in them.
    why : str
        Why the mesh had to be wrapped or how its bodies were joined, in words; else empty.
    soundness : Soundness or None
        What is wrong with the shell all the same; nothing nearly always. None before it was looked at.
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
    cut: int = 0
    sheets: int = 0
    small_holes: int = 0
    parted: int = 0
    soundness: Soundness | None = None
    why: str = ""
    gap: float | None = None
    carried: tuple[RegionReport, ...] = ()

    @property
    def invented_area(self) -> float:
        """Area of the invented facets, m²."""
        return float(self.probe.areas[self.probe.invented].sum())

    @property
    def faults(self) -> tuple[str, ...]:
        """What makes the shell unfit, in words; empty when it is sound."""
        return () if self.soundness is None else self.soundness.faults

    @property
    def _way(self) -> str:
        """What was done, and why no less."""
        match self.how:
            case "unchanged":
                return message("Untouched: the mesh is closed and sound.")
            case "wrapped":
                return message(f"Wrapped at {arg(1e3 * (self.alpha or 0)):.2g} mm. {arg(self.why)}")
        return self.why or message(
            "Mended in place: the outer hull was made from the facets of the file; none was moved."
        )

    @property
    def left_open(self) -> str:
        """What to know of openings that were left open, in words; empty where there are none."""
        left = sum(opening.closing is Closing.OPEN for opening in self.openings)
        return left_open(left) if left else ""

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was done, in words."""
        out = [self._way]
        if self.how == HULL:
            done = (
                (self.turned, message(f"Facets turned to face outwards: {arg(self.turned):,}.")),
                (self.cut, message(f"Facets cut where others crossed or touched them: {arg(self.cut):,}.")),
                (
                    self.dropped,
                    message(f"Unreachable facets left out (inner walls and repeats): {arg(self.dropped):,}."),
                ),
                (
                    self.sheets,
                    message(
                        f"Facets left out because they were sheets without thickness: {arg(self.sheets):,}."
                    ),
                ),
                (self.small_holes, message(f"Small holes and open seams closed: {arg(self.small_holes):,}.")),
                (
                    self.parted,
                    message(f"Vertices separated where bodies only met in a point: {arg(self.parted):,}."),
                ),
            )
            out += [text for count, text in done if count]
        if self.how == WRAPPED and self.dropped:
            out.append(message(f"Specks next to the part were left out (facets: {arg(self.dropped)})."))
        out += self.faults
        out += [message(f"Found {arg(opening.sentence)}") for opening in self.openings]
        out += [self.left_open] if self.left_open else []
        if self.invented_area > 0:
            share = self.invented_area / self.probe.areas.sum()
            out.append(
                message(
                    f"{arg(1e6 * self.invented_area):.0f} mm² ({arg(100 * share):.1f} %) of the shell is"
                    " invented: contacts there rest on a guess. If that area will be touched, measure"
                    " the part or get its drawing."
                )
            )
        if self.fit is not None:
            out.append(self.fit.sentence)
        return (*out, *(report.sentence for report in self.carried))

    def to_json(self) -> dict[str, Any]:
        """Give the result as plain values, without the mesh."""
        return {
            "how": self.how,
            "why": self.why,
            "facets": len(self.probe.faces),
            "turned": self.turned,
            "dropped": self.dropped,
            "cut": self.cut,
            "sheets": self.sheets,
            "small_holes": self.small_holes,
            "parted": self.parted,
            "openings": [opening.to_json() for opening in self.openings],
            "invented_mm2": round(1e6 * self.invented_area, 2),
            "invented_share": round(self.invented_area / float(self.probe.areas.sum()), 6),
            "soundness": None if self.soundness is None else self.soundness.to_json(),
            "gap_mm": None if self.gap is None else round(1e3 * self.gap, 4),
            "alpha_mm": None if self.alpha is None else round(1e3 * self.alpha, 4),
            "fit": None if self.fit is None else self.fit.to_json(),
            "regions": [report.to_json() for report in self.carried],
        }


NO_SPACE = message(
    "The mesh's own facets enclose no space, even with the holes closed: too many are loose, torn"
    " or without thickness."
)
LEAKS = message(
    "The mesh's own facets could not be used: the patches do not meet the rims of the openings everywhere."
)
APART = message(
    "The mesh's own facets could not be used: its bodies are less than the gap apart, and what fills the space between"
    " them gave no valid surface."
)
UNSOUND = message(
    "The mesh's own facets could not be used: cut where they cross, they gave no valid surface."
)


def left_open(openings: int) -> str:
    """Say what openings into a hollow mean, and how they are closed."""
    return message(
        f"Openings left open: {arg(openings)}. A contact can be found on the walls behind them. If nothing can"
        ' enter there, close them (--close auto; in the window: "Close openings").'
    )
