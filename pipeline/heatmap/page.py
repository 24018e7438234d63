"""A heatmap as a page for people, in the design of the reports."""

import base64
from collections.abc import Mapping, Sequence
from datetime import datetime

from contactbench import __version__
from contactbench.pipeline.heatmap.heatmap import Heatmap
from contactbench.pipeline.page import moment, render

_PIXELS = 600  # of each look at the probe


def heatmap_html(
    heatmap: Heatmap,
    left_out: Mapping[str, int],
    notes: Sequence[str],
    *,
    created: datetime | None = None,
    pixels: int = _PIXELS,
) -> str:
    """
    Return a heatmap as one HTML page that needs nothing beside itself.

    Parameters
    ----------
    heatmap : Heatmap
    left_out : mapping of str to int
        How many contacts were left out, by reason.
    notes : sequence of str
        What limits it, in sentences.
    created : datetime, optional
        When it was made, with a time zone; InputError without one.
    pixels : int
        Width of each of the two looks.
    """
    from contactbench.pipeline.heatmap.picture import encode_png  # takes a while to import

    picture = encode_png(heatmap, pixels=pixels, legend=False)
    title = heatmap.title[:1].upper() + heatmap.title[1:]
    rows = [
        ("Made", moment(created) or ""),
        ("Probe", heatmap.probe.name),
        (heatmap.counted.capitalize(), f"{heatmap.contacts:,} used, {sum(left_out.values()):,} left out"),
        ("Spread", f"Gaussian along the surface, {1e3 * heatmap.bandwidth:.3g} mm"),
        ("Software", f"contactbench {__version__}"),
    ]
    tiles = [(f"{heatmap.largest:.3g} {heatmap.unit}", f"largest {heatmap.title}", False)]
    if heatmap.quantity != "density":
        tiles.append((f"{heatmap.total:.3g} {heatmap.unit}", f"over all {heatmap.counted}", False))
    return render(
        __package__,
        title=title,
        probe=heatmap.probe.name,
        details={"rows": rows, "missing": [], "overdue": ""},
        tiles=tiles,
        picture=base64.b64encode(picture).decode(),
        notes=notes,
        left_out=dict(left_out),
        counted=heatmap.counted,
    )
