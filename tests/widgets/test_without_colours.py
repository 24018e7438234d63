"""No meaning by colour alone: with all colours of the theme the same, every two states still look different."""

from dataclasses import replace
from itertools import combinations

import pytest
from PySide6.QtWidgets import QApplication

from contactbench.pipeline.session.why import CheckItem, CheckState
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.pipeline.workbench.gravity_fit import PoseState
from contactbench.pipeline.workbench.verify_touches import MarkerRow
from contactbench.widgets import theme
from contactbench.widgets.checklist import Checklist
from contactbench.widgets.marker_table import MarkerTable
from contactbench.widgets.message_list import MessageList
from contactbench.widgets.residual_table import ResidualTable
from contactbench.widgets.scene import marker_layer
from contactbench.widgets.step_list import StepList
from contactbench.widgets.touch_state import TouchState
from contactbench.widgets.verdict_box import GOOD, LOCKED, REFUSE, USABLE, VerdictBox


@pytest.fixture(autouse=True)
def _one_colour(monkeypatch):
    text = theme._LIGHT.text
    states = dict.fromkeys(("muted", "accent", "good", "warning", "bad", "stale"), text)
    monkeypatch.setattr(theme, "_LIGHT", replace(theme._LIGHT, **states, series=(text,) * 6))


def differ(pictures):
    """Check that every two pictures are different."""
    for (one, first), (other, second) in combinations(pictures.items(), 2):
        assert first != second, f"{one} looks as {other} does"


def shown(qtbot, widget, states, show):
    """Return a picture of a widget in each state."""
    qtbot.addWidget(widget)
    widget.resize(320, max(widget.sizeHint().height(), 60))
    widget.show()
    qtbot.waitExposed(widget)
    pictures = {}
    for state in states:
        show(state)
        pictures[str(state)] = widget.grab().toImage()
    return pictures


def test_a_step(qtbot):
    steps = StepList()
    for size in (StepList().sizeHint().height(), 6 * 30):  # in a low window a row has no room for its word
        steps.setMinimumHeight(size)
        pictures = shown(
            qtbot, steps, StepState, lambda state: steps.show_statuses({Step.PROBE: StepStatus(state, "")})
        )
        del pictures[str(StepState.LOCKED)]  # as all others are, here
        differ(pictures)


def test_a_verdict(qtbot):
    box = VerdictBox()
    # Without its word, which a page may give: the sign alone tells them apart.
    differ(
        shown(qtbot, box, (GOOD, USABLE, REFUSE, LOCKED), lambda level: box.show_verdict(level, [], "So far"))
    )


def test_how_a_touch_goes(qtbot):
    touch = TouchState()
    states = ("idle", "armed", "touching", "settled", "accepted", "rejected")
    differ(shown(qtbot, touch, states, lambda state: touch.show_state(state, force=9.0)))
    differ(shown(qtbot, touch, ("sure", "not sure"), lambda sure: touch.show_contact("95 %", sure == "sure")))


def test_a_line_of_the_checklist(qtbot):
    checklist = Checklist()
    differ(
        shown(
            qtbot,
            checklist,
            CheckState,
            lambda state: (
                checklist.show_items([CheckItem("Probe", state, "", Step.PROBE)]),
                QApplication.processEvents(),  # it is laid out later
            ),
        )
    )


def test_a_message(qtbot):
    messages = MessageList()
    weights = ("info", "good", "warning", "error")
    pictures = shown(qtbot, messages, weights, lambda weight: (messages.clear(), messages.add(weight, "x")))
    differ(pictures)


def test_a_marker_in_its_table_and_in_the_view(qtbot):
    table = MarkerTable()
    states = ("open", "done", "failed", "skipped")
    differ(
        shown(
            qtbot,
            table,
            states,
            lambda state: table.show_rows([MarkerRow("M1", (0.0, 0.0, 0.0), state=state)]),
        )
    )
    assert len({*marker_layer._SIGNS.values()}) == len(marker_layer._SIGNS)


def test_a_pose(qtbot):
    table = ResidualTable()
    qtbot.addWidget(table)
    words = {word for word, *_ in table.model()._looks().values()}
    assert len(words) == len(PoseState)
