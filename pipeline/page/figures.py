"""
How pictures look on every page: one palette, one style, and SVG that takes its colours and its font from the page.

Matplotlib draws with fixed colours; some of these stand for roles (ink, grid, force, ...) and are replaced by the
page's CSS variables, so that one picture serves light, dark and paper. Text stays text: it can be searched and copied.

Importing this module imports Matplotlib, which takes a while: import it when a page is made.
"""

from __future__ import annotations

import re
import warnings
from contextlib import contextmanager
from io import StringIO
from typing import TYPE_CHECKING, Any

import matplotlib as mpl

from contactbench.pipeline.page.palette import BLUE, VERMILION

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure

WIDTH = 6.9  # inches: the width of the text on an A4 page
# Stand-ins for the page's variables; no picture has these colours otherwise.
INK, FAINT, GRID, PAPER = "#010101", "#020202", "#030303", "#fdfefd"
_ROLES = {
    INK: "currentColor",
    FAINT: "var(--faint)",
    GRID: "var(--grid)",
    PAPER: "var(--paper)",
    BLUE: "var(--force)",
    VERMILION: "var(--torque)",
}
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "contactbench",
    "font.family": ["DejaVu Sans"],  # comes with Matplotlib: the layout is the same on every machine
    "font.size": 9.0,
    "text.parse_math": False,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.minor.size": 0,
    "ytick.minor.size": 0,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
}


@contextmanager
def page_style(**more: Any) -> Iterator[None]:
    """
    Draw with Matplotlib's own defaults and the pages' style, whatever the user's settings are.

    How SVG is written is set for the whole process only; it is put back at the end.
    """
    with mpl.rc_context(), warnings.catch_warnings():
        # The text stays text in the SVG: whoever shows it has the letters, whatever the font here lacks.
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        mpl.rcdefaults()
        settings: Any = mpl.rcParams  # which types its keys
        settings.update({**_STYLE, **more})
        yield


def to_svg(figure: Figure, prefix: str, label: str) -> str:
    """Return a figure as an element to put into HTML: with ids of its own, without namespace or fixed size."""
    file = StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None})
    _, _, text = file.getvalue().partition("<svg")
    head, _, body = text.partition(">")
    body = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>|<!--.*?-->", "", body, flags=re.DOTALL)
    used = dict.fromkeys(re.findall(r'(?:url\(|href=")#([^)"]+)', body))
    names = {name: f"{prefix}{number}" for number, name in enumerate(used)}
    # Only tags are changed: what stands between them may be a name that somebody gave.
    body = re.sub(r"<[^>]+>", lambda tag: _on_page(tag[0], names), body)
    view = re.findall(r'viewBox="[^"]*"', head)[0]
    body = re.sub(r">\n\s*", ">\n", body).strip()
    return f'<svg {view} role="img" aria-label="{label}">{body}'


def _on_page(tag: str, names: dict[str, str]) -> str:
    tag = tag.replace("xlink:href", "href")
    tag = re.sub(r' id="([^"]*)"', lambda m: f' id="{names[m[1]]}"' if m[1] in names else "", tag)
    tag = re.sub(r'(url\(|href=")#([^)"]+)', lambda m: f"{m[1]}#{names[m[2]]}", tag)
    tag = re.sub(r' (?:d|x|y|transform)="[^"]*"', _rounded, tag)
    tag = re.sub(r"font: ([\d.]+px) [^;\"]*", r"font-size: \1", tag)
    tag = re.sub(r' ?font-family: [^;"]*;?', "", tag)
    for colour, role in _ROLES.items():
        tag = tag.replace(colour, role)
    return tag


def _rounded(match: re.Match[str]) -> str:
    """Keep a hundredth of a point, and no space that a letter replaces: half the size."""
    short = re.sub(r"-?\d+\.\d{3,}", lambda n: f"{float(n[0]):.2f}".rstrip("0").rstrip("."), match[0])
    return re.sub(r"\s*([MLCQz])\s*", r"\1", short)
