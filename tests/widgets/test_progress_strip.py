"""What goes on is told in the status bar."""

import time
from types import SimpleNamespace

import pytest
from PySide6.QtWidgets import QProgressBar

from contactbench.widgets.progress_strip import ProgressStrip


@pytest.fixture
def work():
    return SimpleNamespace(
        title="Reading", share=0.0, started=time.monotonic() - 12.5, stoppable=False, cancelled=lambda: False
    )


@pytest.fixture
def bar(qtbot, work):
    strip = ProgressStrip(lambda: (work,))
    qtbot.addWidget(strip)
    strip.show()
    strip.watch()
    found = strip.findChild(QProgressBar)
    qtbot.waitUntil(found.isVisible)
    yield found
    strip.close()


def test_work_that_does_not_tell_how_far_it_is_counts_seconds(bar):
    assert bar.text().removesuffix(" s").isdecimal()
    assert int(bar.text().removesuffix(" s")) >= 12
    assert bar.maximum() > bar.minimum(), (
        "without a range it moves, and has the whole window drawn all the time"
    )


def test_work_that_tells_is_shown_as_a_share(qtbot, bar, work):
    work.share = 0.5
    qtbot.waitUntil(lambda: bar.value() == bar.maximum() / 2)
    assert bar.text().startswith("50")
    work.share = 0.0
    qtbot.waitUntil(lambda: bar.text().endswith(" s"))
    assert bar.value() == bar.minimum()
