"""A newcomer without hardware: from the first start to a bundle that a runtime loads, by clicks and keys only."""

import json
import subprocess

import pytest
from driving.hand import Hand, rest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QWidget
from terminal import command

from contactbench.widgets.theme import use_theme

LONG = 180.0  # s: on a machine with other work
_MOST_ACTIONS = 40  # clicks, keys and fields, with what is tried on the way


@pytest.mark.window
@pytest.mark.timeout(540)
def test_from_the_first_start_to_a_checked_bundle(make_window, tmp_path):
    use_theme("light")
    window = make_window()
    hand = Hand(window, tmp_path / "pictures")
    begin(hand)
    weigh(hand)
    check_a_pose(hand)
    prepare_the_probe(hand)
    paint_a_region(hand)
    verify(hand)
    bundle = tmp_path / "by-hand.zip"
    export(hand, bundle)
    window.close()
    hand.until(lambda: not window.isVisible(), "the window to close", LONG)
    assert not (tmp_path / "pictures").exists(), "nothing was in the way"
    assert len(hand.log) <= _MOST_ACTIONS, hand.log

    (session,) = (tmp_path / "home" / "sessions").iterdir()
    checked = json.loads(contactbench("bundle", "check", bundle, "--json"))
    assert checked["verified"], checked
    contactbench("bundle", "export", session, "--out", tmp_path / "headless.zip")
    assert (tmp_path / "headless.zip").read_bytes() == bundle.read_bytes()
    assert "differ" not in contactbench("session", "replay", session)


def begin(hand):
    hand.press("Try the virtual bench")
    hand.read("Hold the tool still", LONG)
    hand.press("Devices")
    hand.read("Connected: the virtual bench", LONG)
    hand.press("Gravity")


def weigh(hand):
    """Let the virtual bench turn; the first pose by the space bar, the others by themselves."""
    hand.press("Capture automatically when still")
    hand.press("Start")
    hand.press("Move virtual tool there", LONG)
    hand.read("In position", LONG)
    hand.read("Press SPACE", LONG)
    hand.key(Qt.Key.Key_Space)
    hand.read("pose 2 of", LONG)
    hand.press("Capture automatically when still")
    for _ in range(12):
        if enough(hand):
            break
        poses = count(hand)
        hand.press("Move virtual tool there", LONG)
        hand.until(lambda poses=poses: count(hand) != poses or enough(hand), "another pose", LONG)
    hand.press("Finish")
    hand.read("The calibration adds up to", LONG)


def count(hand):
    return [line for line in hand.words().splitlines() if line.startswith("pose ")]


def enough(hand):
    return "you can finish" in hand.words()


def check_a_pose(hand):
    hand.press("Check with another pose", LONG)
    checked = "Checked with a new pose"  # it may be on its way to one
    hand.until(lambda: hand.enabled("Move virtual tool there") or checked in hand.words(), "a pose", LONG)
    if hand.enabled("Move virtual tool there"):
        hand.press("Move virtual tool there")
    hand.read(checked, LONG)


def prepare_the_probe(hand):
    hand.press("Next: Probe")
    hand.press("Use virtual bench housing")
    hand.until(lambda: hand.enabled("Use this probe"), "the probe to be prepared", LONG)
    advised = hand.reading("facets: contacts shift")
    chart = hand.find("Contact error against facet count", QWidget)
    hand.click(chart, QPoint(chart.width() // 2, chart.height() // 2))
    hand.key(Qt.Key.Key_Right)
    hand.until(lambda: hand.reading("facets: contacts shift") != advised, "another choice")
    rest(600)
    hand.press("Use this probe", LONG)


def paint_a_region(hand):
    hand.press("Next: Regions", LONG)
    hand.press("Add a region", LONG)
    scene = hand.find("3D view of the probe", QWidget)
    for _ in range(5):  # a person sees that nothing is painted yet, and drags once more
        rest(1_000)
        view = hand.window.scene  # a person sees where the probe is, which makes room for legends
        middle = view.projection().project(view.probe_layer.probe.vertices.mean(axis=0))[0]
        x, y = round(middle[0]), round(middle[1])
        hand.drag(scene, [QPoint(x, y - 10 * step) for step in range(9)])
        if hand.enabled("Apply regions"):
            break
    hand.press("Apply regions", LONG)
    hand.read("The probe has these regions", LONG)


def verify(hand):
    hand.press("Next: Verify")
    hand.until(lambda: hand.enabled("Distribute evenly"), "the probe to be loaded", LONG)
    hand.choose("Area for markers", "whole probe")
    hand.type("Number of markers", "6")
    hand.press("Distribute evenly", LONG)
    hand.press("Start touching", LONG)
    hand.press("Touch all", LONG)
    hand.read("All markers touched", LONG)
    hand.press("Finish")
    hand.read("mean error of 6 touches", LONG)
    hand.read("Passed")


def export(hand, bundle):
    hand.press("Next: Export")
    hand.read("Verified and ready to export", LONG)
    hand.name_file("Export file", bundle)
    hand.until(bundle.exists, "the bundle", LONG)
    hand.read(bundle.name, LONG)


def contactbench(*words):
    """Run a command without a screen; what it prints."""
    done = subprocess.run(command(*words), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
