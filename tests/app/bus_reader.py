"""
Reads a window through the accessibility bus, as a screen reader does; run by the system's Python, which has pyatspi.

``bus_reader.py PID`` prints what is on the screen as JSON, [role, name, actions] each;
``bus_reader.py PID press NAME`` presses the button of a name.
"""

import json
import sys
from pathlib import Path

import pyatspi
from gi.repository import Atspi

sys.path.insert(0, str(Path(__file__).parents[1]))
from waiting import until  # the system's Python does not know where our tests are

_WHOLE = (  # what lies in them is no part of the page
    pyatspi.ROLE_TABLE, pyatspi.ROLE_LIST, pyatspi.ROLE_TREE_TABLE, pyatspi.ROLE_COMBO_BOX, pyatspi.ROLE_SPIN_BUTTON,
    pyatspi.ROLE_PUSH_BUTTON, pyatspi.ROLE_LABEL, pyatspi.ROLE_CHECK_BOX, pyatspi.ROLE_TOGGLE_BUTTON,
)  # fmt: skip
_LEFT_OUT = (pyatspi.ROLE_MENU_BAR, pyatspi.ROLE_SCROLL_BAR, pyatspi.ROLE_LABEL)
Atspi.set_timeout(60_000, 60_000)  # ms: a window that has other things to do answers later


def application(pid):
    """Return the application of a process, as soon as it is on the bus."""
    return until(
        lambda: next(
            (each for each in pyatspi.Registry.getDesktop(0) if each and each.get_process_id() == pid), None
        )
    )


def walk(node):
    """Yield what is shown, from the outside to the inside."""
    for each in node:
        if each is None or each.getRole() in _LEFT_OUT or not each.getState().contains(pyatspi.STATE_SHOWING):
            continue
        yield each
        if each.getRole() not in _WHOLE and each.childCount:
            yield from walk(each)


def actions(node):
    """Return what can be done with something."""
    try:
        found = node.queryAction()
    except NotImplementedError:
        return []
    return [found.getName(number) for number in range(found.nActions)]


def main(pid, *asked):
    """Do what is asked."""
    found = walk(application(int(pid)))
    if asked:
        _, name = asked
        for each in found:
            if each.name == name and actions(each):
                each.queryAction().doAction(0)
                return
        raise SystemExit(f"nothing that can be pressed is called {name!r}")
    rows = [(each.getRoleName(), each.name, each) for each in found]
    pressed = ("push button", "check box", "toggle button")
    rows = [[role, name, actions(each) if role in pressed else []] for role, name, each in rows]
    sys.stdout.write(json.dumps(rows))


if __name__ == "__main__":
    main(*sys.argv[1:])
