"""Pins: what the product gives today, kept in `pins/`; `--record` writes them anew and prints what has changed."""

import difflib
import platform
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
PINS, OLD = HERE / "pins", HERE / "old"


def pytest_addoption(parser):
    parser.addoption("--record", action="store_true", help="Write the pins anew, and print what has changed.")


@pytest.fixture
def pin(request, capsys):
    """Compare a text with its pin, or record it."""
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        pytest.skip("the pins are of Linux on x86-64: elsewhere the last digits differ")

    def compare(name, text):
        file = PINS / f"{name}.txt"
        before = file.read_text(encoding="utf-8") if file.exists() else ""
        if before == text:
            return
        lines = difflib.unified_diff(
            before.splitlines(), text.splitlines(), "pinned", "now", n=1, lineterm=""
        )
        changed = "\n".join(line[:400] for line in lines)
        if not request.config.getoption("record", default=False):
            pytest.fail(
                f"{name} is not as pinned. If it is meant so, say why in the commit, and record it:\n"
                f"python -m pytest tests/golden --record\n{changed}",
                pytrace=False,
            )
        PINS.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
        with capsys.disabled():
            sys.stdout.write(f"\n{name} recorded\n{changed}\n")

    return compare
