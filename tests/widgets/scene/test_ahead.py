"""What is computed of a probe beside the window."""

import threading

import numpy as np
from benchmarks.window.balls import ball
from PySide6.QtWidgets import QApplication

from contactbench.pipeline.mesh import Probe
from contactbench.widgets.scene.smooth import MANY, Ahead, crease_edges, long_creases, prepare


def test_the_creases_of_a_box_are_its_twelve_edges(make_box):
    box = make_box()
    edges, drawn = crease_edges(box.faces, box.normals, len(box.vertices))
    assert len(edges) == 12
    assert drawn.all()
    along = np.abs(box.vertices[edges[:, 1]] - box.vertices[edges[:, 0]])
    assert (np.count_nonzero(along > 1e-9, axis=1) == 1).all()  # no diagonal


def test_an_open_edge_is_a_crease_and_a_smooth_one_is_not():
    faces = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    edges, drawn = crease_edges(faces, np.array([[0.0, 0, 1], [0, 0, 1]]), 4)
    assert len(edges) == 4
    assert drawn.all()
    bent = np.array([[0.0, 0, 1], [0, np.sin(0.8), np.cos(0.8)]])  # 46 degrees: shaded sharp, but no line
    edges, drawn = crease_edges(faces, bent, 4)
    assert len(edges) == 5
    assert drawn.sum() == 4


def test_a_short_crease_alone_is_not_drawn_and_one_of_many_pieces_is():
    line = np.column_stack([np.linspace(0, 0.05, 11), np.zeros(11), np.zeros(11)])
    alone = np.array([[0.1, 0, 0], [0.105, 0, 0]])
    edges = np.concatenate([np.column_stack([np.arange(10), np.arange(1, 11)]), [[11, 12]]])
    meant = long_creases(edges, np.concatenate([line, alone]), 0.1)
    assert meant.tolist() == [True] * 10 + [False]


def test_a_ball_is_round_and_a_box_stays_sharp(make_box):
    round_one = ball(2_000)
    smooth = prepare(round_one).smooth
    outward = round_one.vertices / np.linalg.norm(round_one.vertices, axis=1, keepdims=True)
    assert np.array_equal(smooth.faces, round_one.faces)
    assert (np.einsum("ij,ij->i", smooth.normals, outward) > 0.999).all()
    box = make_box()
    smooth = prepare(box).smooth
    assert np.array_equal(smooth.of[smooth.faces], box.faces)
    flat = smooth.normals[smooth.faces]
    np.testing.assert_allclose(flat, np.repeat(box.normals[:, None], 3, axis=1), atol=1e-12)


def test_a_seam_is_pale_and_a_lid_is_hatched():
    turns = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rings = [(0.05, 0.0), (0.05, 0.001), (0.05, 0.1)]
    vertices = np.array(
        [(r * np.cos(t), r * np.sin(t), z) for r, z in rings for t in turns] + [(0, 0, 0.1), (0, 0, 0)]
    )
    here, after = np.arange(48), (np.arange(48) + 1) % 48
    walls = [
        triangle
        for low in (0, 48)
        for triangle in (
            np.column_stack([low + here, low + after, low + 48 + after]),
            np.column_stack([low + here, low + 48 + after, low + 48 + here]),
        )
    ]
    lid = np.column_stack([96 + here, 96 + after, np.full(48, 144)])
    floor = np.column_stack([after, here, np.full(48, 145)])
    faces = np.concatenate([*walls, lid, floor]).astype(np.int32)
    probe = Probe.from_arrays(vertices, faces)
    seam = np.arange(len(faces)) < 96
    top = (np.arange(len(faces)) >= 192) & (np.arange(len(faces)) < 240)
    prepared = prepare(probe.with_invented(seam | top))
    assert np.array_equal(prepared.narrow, seam)
    assert len(prepared.hatched) > 100
    assert (prepared.hatched[:, 2] > 0.0999).all()  # on the lid alone


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
        "contactbench.widgets.scene.smooth.prepare", lambda probe: made.append(probe) or prepare(probe)
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

    monkeypatch.setattr("contactbench.widgets.scene.smooth.prepare", slow)
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
