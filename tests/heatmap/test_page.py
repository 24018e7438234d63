"""A heatmap's page has the design of the reports and says what is in it."""

import re

import numpy as np
import pytest

from contactbench.assets import make
from contactbench.pipeline.heatmap import heatmap
from contactbench.pipeline.heatmap.page import heatmap_html
from contactbench.pipeline.mesh import Probe


@pytest.fixture(scope="module")
def made():
    probe = Probe.from_arrays(*make("convex", 900), name="<convex>")
    points = probe.vertices[probe.vertices[:, 2].argsort()[-40:]]
    return heatmap(probe, points, None, "force", 4e-3, values=np.linspace(1, 9, len(points)))


def test_a_page_holds_picture_numbers_and_what_was_left_out(made):
    page = heatmap_html(made, {"not settled": 1234}, ["Few touches <here>."], pixels=60)
    text = " ".join(re.sub(r"<style.*?</style>|<[^>]+>", " ", page, flags=re.DOTALL).split())
    assert "Mean force: &lt;convex&gt;" in text
    assert f"{made.largest:.3g} N largest mean force" in text
    assert "40 used, 1,234 left out" in text
    assert "not settled 1,234 contacts" in text
    assert "Few touches &lt;here&gt;." in text
    assert page.count("data:image/png;base64,") == 1
    assert "<script" not in page
    assert heatmap_html(made, {}, [], pixels=60) == heatmap_html(made, {}, [], pixels=60)


def test_colours_can_end_at_a_limit(made):
    from contactbench.pipeline.heatmap.picture import encode_png

    pictures = [
        encode_png(made, pixels=60, limit=limit) for limit in (None, made.scale.top, 4 * made.scale.top)
    ]
    assert pictures[0] == pictures[1]
    assert pictures[2] != pictures[0]
