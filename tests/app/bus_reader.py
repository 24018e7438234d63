"""
Reads a window through the accessibility bus, as a screen reader does; run by the system's Python, which has Atspi.

``bus_reader.py PID`` prints what can be used on the screen as JSON, [role, name, whether now, actions] each;
``bus_reader.py PID press NAME`` presses the button of a name.
"""

import json
import sys
from pathlib import Path

import gi

gi.require_version("Atspi", "2.0")
from gi.repository import Atspi  # noqa: E402

sys.path.insert(0, str(Path(__file__).parents[1]))
from waiting import until  # noqa: E402 - the system's Python does not know where our tests are

_ROLE = Atspi.Role
_PRESSED = (_ROLE.PUSH_BUTTON, _ROLE.CHECK_BOX, _ROLE.TOGGLE_BUTTON, _ROLE.RADIO_BUTTON)
_USED = (
    *_PRESSED, _ROLE.COMBO_BOX, _ROLE.SPIN_BUTTON, _ROLE.TEXT, _ROLE.SLIDER,
    _ROLE.TABLE, _ROLE.LIST, _ROLE.TREE_TABLE,
)  # fmt: skip
_INSIDE = (_ROLE.COMBO_BOX, _ROLE.SPIN_BUTTON)  # what lies in them is no control of its own
Atspi.set_timeout(60_000, 60_000)  # ms: a window that has other things to do answers later


def application(pid):
    """Return the application of a process, as soon as it is on the bus."""

    def found():
        desktop = Atspi.get_desktop(0)
        there = (desktop.get_child_at_index(number) for number in range(desktop.get_child_count()))
        return next((each for each in there if each and each.get_process_id() == pid), None)

    return until(found)


def used(window):
    """Return what can be used now, in one question: each answer takes a turn of the window's event loop."""
    both = Atspi.CollectionMatchType
    rule = Atspi.MatchRule.new(
        Atspi.StateSet.new([Atspi.StateType.SHOWING]),
        both.ALL,
        {},
        both.ALL,
        list(_USED),
        both.ANY,
        [],
        both.ALL,
        False,
    )
    found = Atspi.Collection.get_matches(window, rule, Atspi.CollectionSortOrder.CANONICAL, 0, True)
    return [each for each in found if each.get_parent().get_role() not in _INSIDE]


def actions(node):
    """Return what can be done with something."""
    try:
        return [Atspi.Action.get_action_name(node, each) for each in range(Atspi.Action.get_n_actions(node))]
    except Exception:  # noqa: BLE001 - it has none: GLib raises one kind of error for everything
        return []


def main(pid, *asked):
    """Do what is asked."""
    found = application(int(pid))
    window = next(filter(None, map(found.get_child_at_index, range(found.get_child_count()))))
    if asked:
        _, name = asked
        for each in used(window):
            if each.get_name() == name and actions(each):
                Atspi.Action.do_action(each, 0)
                return
        raise SystemExit(f"nothing that can be pressed is called {name!r}")
    rows = [
        [
            each.get_role_name(),
            each.get_name(),
            each.get_state_set().contains(Atspi.StateType.ENABLED),
            actions(each) if each.get_role() in _PRESSED else [],
        ]
        for each in used(window)
    ]
    sys.stdout.write(json.dumps(rows))


if __name__ == "__main__":
    main(*sys.argv[1:])
