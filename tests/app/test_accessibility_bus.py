"""What a screen reader finds of each page, through the accessibility bus that it uses."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks.window.screenshots_session import make_session

_LAUNCHER = Path("/usr/libexec/at-spi-bus-launcher")


def _missing():
    """Return what is not there; empty: nothing is."""
    if sys.platform != "linux":
        return "AT-SPI is the accessibility bus of Linux"
    for program in ("dbus-run-session", "/usr/bin/python3", str(_LAUNCHER)):
        if shutil.which(program) is None:
            return f"{program} is not installed (apt-get install dbus at-spi2-core)"
    look = "import gi; gi.require_version('Atspi', '2.0')"
    found = subprocess.run(["/usr/bin/python3", "-c", look], capture_output=True, check=False)
    return (
        "/usr/bin/python3 has no Atspi (apt-get install python3-gi gir1.2-atspi-2.0)"
        if found.returncode
        else ""
    )


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    if missing := _missing():
        pytest.skip(missing)
    folder = tmp_path_factory.mktemp("bus")
    make_session(folder / "s")
    surroundings = os.environ | {
        "CONTACTBENCH_HOME": str(folder / "home"),
        "QT_LINUX_ACCESSIBILITY_ALWAYS_ON": "1",
        "PYTHONPATH": str(Path(__file__).parent.parent),
    }
    window = Path(__file__).with_name("bus_window.py")
    words = ("dbus-run-session", "--", sys.executable, window, folder / "s")
    done = subprocess.run(words, env=surroundings, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout.splitlines()[-1])  # the bus itself has said something before


# Of each page: what somebody who sees nothing has to find, by role and the beginning of its name.
EXPECTED = {
    "start": [
        ("push button", "Try the virtual bench"),
        ("push button", "New session"),
        ("push button", "Open"),
    ],
    "devices": [("combo box", ""), ("push button", "Use these devices")],
    "gravity": [
        ("push button", "Next: Probe"),
        ("table", "Poses"),
        ("spin button", "Tilt limit of the tool"),
    ],
    "probe": [("push button", "Next: Regions")],
    "regions": [("push button", "Add")],
    "verify": [("push button", "Distribute evenly"), ("table", "Markers")],
    "export": [("push button", "Export file")],
}


@pytest.mark.window
@pytest.mark.parametrize("page", list(EXPECTED))
def test_every_control_is_found_through_the_bus_by_name_and_role(pages, page):
    read = pages[page]["read"]
    for role, name in EXPECTED[page]:
        assert any(each[0] == role and each[1].startswith(name) for each in read), (role, name, read)
    heard = {each[1] for each in read}
    missing = [name for name, _ in pages[page]["there"] if name not in heard]
    assert not missing, "on the screen, and not on the bus"
    for role, name, can, actions in read:
        if role in ("push button", "check box", "combo box", "spin button", "text", "slider", "radio button"):
            assert name.strip(), f"a {role} without a name"
        if can and role in ("push button", "check box"):
            assert actions, f"{role} {name!r} cannot be pressed through the bus"
