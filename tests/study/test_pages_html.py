"""The results page as HTML: in the design of the reports, with its pictures inside, and no markup from names."""

import base64

import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.pages import study_html, table

PICTURE = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


def test_a_page_is_one_file_with_tables_and_pictures(tmp_path):
    (tmp_path / "p.png").write_bytes(PICTURE)
    rows = table(("mesh", "error"), [("<img src=x onerror=1>", "0.12 mm"), ("b", "0.3 mm")])
    text = f"## Sweep: a & b\n\n{rows}\n\n![The plot](p.png)\n\n<details><summary>All</summary>\n\nx\n\n</details>"
    page = study_html(text, tmp_path)
    assert "<title>Sweep: a &amp; b</title>" in page
    assert '<td class="number">0.12\u00a0mm</td>' in page
    assert '<img src="data:image/png;base64,' in page
    assert "<img src=x" not in page
    assert "<h3>All</h3>" in page
    assert "grid-template-columns" in page  # of the shared style sheet


def test_a_picture_that_is_gone_is_named(tmp_path):
    with pytest.raises(InputError, match=r"gone\.png"):
        study_html("## T\n\n![x](gone.png)", tmp_path)
