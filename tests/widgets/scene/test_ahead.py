"""What is computed of a probe beside the window."""

from __future__ import annotations

import threading

import numpy as np
from benchmarks.window.balls import ball
from PySide6.QtWidgets import QApplication

from contactbench.widgets.scene.ahead import MANY, Ahead, crease_ends, prepare


def test_the_creases_of_a_box_are_its_twelve_edges(make_box):
    box = make_box()
    ends = crease_ends(box.vertices, box.faces, box.normals).reshape(-1, 2, 3)
    assert len(ends) == 12
    along = np.abs(ends[:, 1] - ends[:, 0])
    assert (np.count_nonzero(along > 1e-9, axis=1) == 1).all()  # no diagonal


def test_an_open_edge_is_a_crease_and_a_smooth_one_is_not():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    faces = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    ends = crease_ends(vertices, faces, np.array([[0.0, 0, 1], [0, 0, 1]]))
    assert len(ends) == 2 * 4


def test_only_many_facets_have_a_likeness():
    assert prepare(ball(1_000)).likeness is None
    assert prepare(ball(2 * MANY)).likeness is not None


def test_only_the_newest_probe_is_handed_on(qtbot):
    taken = []
    ahead = Ahead(taken.append, None)
    old, new = ball(2_000), ball(3_000)
    ahead.begin(old)
    ahead.begin(new)
    assert ahead.busy
    qtbot.waitUntil(lambda: not ahead.busy, timeout=20_000)
    assert [prepared.probe for prepared in taken] == [new]
    ahead.begin(old)
    ahead.close()  # waits for what is under way
    QApplication.processEvents()
    assert len(taken) == 1


def test_a_probe_that_is_shown_again_is_not_prepared_again(qtbot, monkeypatch):
    taken, made = [], []
    monkeypatch.setattr(
        "contactbench.widgets.scene.ahead.prepare", lambda probe: made.append(probe) or prepare(probe)
    )
    ahead, probe = Ahead(taken.append, None), ball(2_000)
    ahead.begin(probe)
    qtbot.waitUntil(lambda: len(taken) == 1, timeout=20_000)
    ahead.begin(None)
    ahead.begin(probe)
    assert len(taken) == 2
    assert taken[0] is taken[1]
    assert len(made) == 1
    ahead.close()


def test_the_end_waits_for_what_is_under_way_and_drops_the_rest(qapp, monkeypatch):  # noqa: ARG001
    begun, going_on = threading.Event(), threading.Event()
    done, before = [], workers()

    def slow(probe):
        begun.set()
        going_on.wait(5)
        done.append(probe)
        return prepare(probe)

    monkeypatch.setattr("contactbench.widgets.scene.ahead.prepare", slow)
    ahead, probes = Ahead(lambda _: None, None), (ball(500), ball(700))
    ahead.begin(probes[0])
    assert begun.wait(5)
    ahead.begin(probes[1])
    threading.Timer(0.1, going_on.set).start()
    ahead.close()
    assert [id(probe) for probe in done] == [id(probes[0])]
    assert workers() <= before


def workers():
    return {thread for thread in threading.enumerate() if thread.name.startswith("ahead")}
