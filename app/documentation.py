"""Where the built documentation is, if it came with this installation."""

from __future__ import annotations

from pathlib import Path

import contactbench


def start_page() -> Path | None:
    """Return the first page of the documentation; None where `packaging/run docs` never built it."""
    page = Path(contactbench.__file__).parent / "documentation" / "index.html"
    return page if page.is_file() else None
