"""Tests wait for what they wait for: a fixed time is too long on a fast machine and too short on a busy one."""

import re
from pathlib import Path

FIXED = re.compile(r"time\.sleep\(|from time import [a-z, ]*sleep|qtbot\.wait\(|\.qWait\(")


def test_no_test_waits_for_a_fixed_time():
    tests = Path(__file__).parent
    found = [
        f"{file.relative_to(tests)}:{number}: {line.strip()}"
        for file in sorted(tests.rglob("*.py"))
        if "benchmarks" not in file.parts
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1)
        if FIXED.search(line)
    ]
    assert found == [], "use waiting.until, qtbot.waitUntil or qtbot.waitSignal"
