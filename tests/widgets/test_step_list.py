import pytest
from PySide6.QtCore import Qt

from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.widgets.step_list import StepList


@pytest.fixture
def steps(seen):
    return seen(StepList())


def test_each_step_says_how_it_stands_in_a_word(steps):
    states = list(StepState)
    steps.show_statuses({step: StepStatus(states[n], f"why {n}") for n, step in enumerate(Step)})
    names = [steps.row(step).accessibleName() for step in Step]
    assert names[0] == "1 Devices: locked"
    assert {name.rpartition(" ")[2] for name in names} == {state.value for state in StepState}
    assert steps.row(Step.EXPORT).toolTip().endswith(": why 5")


def test_click_and_key_choose(qtbot, steps):
    chosen = []
    steps.chosen.connect(chosen.append)
    qtbot.mouseClick(steps.row(Step.VERIFY), Qt.MouseButton.LeftButton)
    steps.row(Step.PROBE).setFocus()
    qtbot.keyClick(steps.row(Step.PROBE), Qt.Key.Key_Space)
    assert chosen == [Step.VERIFY, Step.PROBE]
    steps.show_step(Step.GRAVITY)
    assert [step for step in Step if steps.row(step).isChecked()] == [Step.GRAVITY]


def test_the_tabulator_key_comes_to_the_shown_step_and_arrows_go_on(qtbot, steps):
    def stops():
        return [step for step in Step if steps.row(step).focusPolicy() & Qt.FocusPolicy.TabFocus]

    with qtbot.waitActive(steps):
        steps.activateWindow()
    steps.row(Step.DEVICES).setFocus(Qt.FocusReason.TabFocusReason)
    steps.show_step(Step.PROBE)  # by a button elsewhere
    assert stops() == [Step.PROBE]
    steps.row(Step.PROBE).setFocus(Qt.FocusReason.TabFocusReason)
    chosen = []
    steps.chosen.connect(chosen.append)
    qtbot.keyClick(steps.row(Step.PROBE), Qt.Key.Key_Down)
    assert chosen == [Step.REGIONS]
    steps.show_step(Step.REGIONS)
    assert stops() == [Step.REGIONS]


def test_the_shown_step_looks_different(steps):
    steps.show_step(Step.GRAVITY)
    one = steps.row(Step.GRAVITY).grab().toImage()
    steps.show_step(Step.PROBE)
    assert steps.row(Step.GRAVITY).grab().toImage() != one


def test_a_screen_reader_chooses_by_toggling(steps):
    chosen = []
    steps.chosen.connect(chosen.append)
    steps.row(Step.VERIFY).toggle()
    assert chosen == [Step.VERIFY]
    steps.show_step(Step.PROBE)  # is no choice
    assert chosen == [Step.VERIFY]
    steps.row(Step.PROBE).click()  # once more
    assert chosen == [Step.VERIFY, Step.PROBE]
