"""The heatmap viewer in a real window."""

import numpy as np
import pytest
from driving.hand import drop_files
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QGuiApplication, QShortcut
from PySide6.QtWidgets import QFileDialog
from terminal import invoke
from weighing_files import weighed

from contactbench.app.heatmap_viewer import HeatmapViewer
from contactbench.app.heatmap_viewer.controls import number_with_unit
from contactbench.assets import make
from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import save_calibration
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.mesh import Probe, save_probe
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench.heatmap_sources import open_files, sorted_files
from contactbench.widgets.scene import Pick

N = 400
LONG = 20_000  # ms


def record(file, probe, model, along, hardest, wait=0):
    """Write a stroke over the head, ever harder, with the weight in it, after so many samples without a touch."""
    centroids = probe.vertices[probe.faces].mean(axis=1)
    top = np.flatnonzero((probe.normals[:, 2] > 0.9) & (centroids[:, 2] > 0.1))
    order = top[np.argsort(centroids[top, along])]
    chosen = order[np.arange(N) * len(order) // N]
    force = -np.linspace(3, hardest, N)[:, None] * probe.normals[chosen]
    idle = np.random.default_rng(1).normal(
        0.0, 1e-3, (wait, 3)
    )  # readings that are all the same are taken as frozen
    force, chosen = np.vstack([idle, force]), np.append(np.full(wait, chosen[0]), chosen)
    raw = np.hstack([force, np.cross(centroids[chosen], force)]) + model.predict(np.eye(3))
    devices = (
        DeviceInfo("wrench", "/wrench", "sri://x", "M", "1", 100.0),
        DeviceInfo("flange", "/flange", "elfin://y"),
    )
    with RecordingWriter(file, RecordingInfo(0, 100.0, devices)) as writer:
        for t, w in zip((100 + 0.01 * np.arange(wait + N)).tolist(), raw.tolist(), strict=True):
            writer.wrench(WrenchSample(t, tuple(w[:3]), tuple(w[3:])))
            writer.flange(FlangeSample(t, np.eye(3), np.zeros(3)))


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("viewer")
    probe = Probe.from_arrays(*make("linear", 1_500), name="linear")
    # The line of a press on the head meets the flange as well: the region says where it is touched.
    head = (probe.normals[:, 2] > 0.5) & (probe.vertices[probe.faces].mean(axis=1)[:, 2] > 0.1)
    probe = probe.with_region(head.astype(np.int32))
    save_probe(probe, folder / "p.ply")
    calibration = calibrate(weighed().poses)
    save_calibration(calibration, folder / "c.json")
    record(folder / "one.mcap", probe, calibration.model, 0, 8.0)
    record(folder / "two.mcap", probe, calibration.model, 1, 5.0)
    record(folder / "late.mcap", probe, calibration.model, 0, 8.0, wait=150)
    return folder


@pytest.fixture
def viewer(qtbot):
    viewer = HeatmapViewer()
    viewer.resize(1280, 800)
    viewer.show()
    qtbot.waitExposed(viewer)
    yield viewer
    viewer.close()
    qtbot.waitUntil(lambda: not viewer.jobs.running, timeout=LONG)
    viewer.deleteLater()


def opened(qtbot, viewer, files, *names):
    viewer.open([files / name for name in names])
    qtbot.waitUntil(lambda: settled(viewer), timeout=LONG)
    return viewer


def settled(viewer):
    sides = viewer.sides[: viewer.visible()]
    quiet = not viewer.jobs.running and not viewer._redraw.isActive()
    return quiet and all(side.playback is not None for side in sides)


def test_a_recording_is_shown_and_narrowed(qtbot, viewer, files):
    assert not viewer.time.isEnabled()
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    side = viewer.sides[0]
    qtbot.waitUntil(lambda: side.frame is not None, timeout=LONG)
    contacts = viewer.sources[0].contacts
    sure = N - sum(contacts.left_out.values())
    assert sure > 0.9 * N
    assert side.frame.contacts == sure
    assert f"Samples: {sure} of {sure}" in side.words.text()
    viewer.time.slider.setFocus()
    qtbot.keyClick(viewer.time.slider, Qt.Key.Key_Space)  # the upper handle
    for _ in range(100):
        qtbot.keyClick(viewer.time.slider, Qt.Key.Key_Left)
    early = int((contacts.moments <= 2.0).sum())
    qtbot.waitUntil(lambda: side.frame.contacts == pytest.approx(early, abs=3), timeout=LONG)
    low, high = viewer.time.slider.values()
    assert (low, high) == (0.0, pytest.approx(2.0, abs=0.01))
    viewer.controls.force.setFocus()
    qtbot.keyClick(viewer.controls.force, Qt.Key.Key_End)  # the lower handle: nothing is that hard
    qtbot.waitUntil(lambda: side.frame.contacts == 0, timeout=LONG)
    assert "No contacts in this time window and force range" in side.words.text()


def test_a_quantity_that_is_not_there_is_said(qtbot, viewer, files):
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    viewer.controls.quantity.setCurrentIndex(viewer.controls.quantity.findData("error"))
    qtbot.waitUntil(lambda: "touched points" in viewer.sides[0].words.text(), timeout=LONG)
    viewer.controls.quantity.setCurrentIndex(viewer.controls.quantity.findData("peak"))
    qtbot.waitUntil(lambda: viewer.sides[0].frame is not None, timeout=LONG)
    assert np.nanmax(viewer.sides[0].frame.values) == pytest.approx(8.0, abs=0.1)


def test_contacts_are_weighed_where_their_confidence_is_known(qtbot, viewer, files, tmp_path):
    box, quantity = viewer.controls.by_confidence, viewer.controls.quantity
    assert not box.isEnabled()
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    assert box.isEnabled()
    assert not viewer.selection().by_confidence
    qtbot.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(10, box.height() // 2))
    assert viewer.selection().by_confidence
    qtbot.waitUntil(lambda: viewer.sides[0].frame is not None, timeout=LONG)
    quantity.setCurrentIndex(quantity.findData("peak"))  # the largest is the largest
    assert not box.isEnabled()
    assert not viewer.selection().by_confidence
    quantity.setCurrentIndex(quantity.findData("density"))
    old = tmp_path / "old.csv"
    old.write_text(
        "t,x,y,z,k,face,reason,candidates,sigma_max_mm\n0,0,0,0.2,0,1,ok,1,0.5\n1,0,0,0.2,0,1,ok,1,0.5\n",
        encoding="utf-8",
    )
    viewer.open([old])
    qtbot.waitUntil(lambda: len(viewer.sources) == 2 and settled(viewer), timeout=LONG)
    assert not box.isEnabled()
    assert not viewer.selection().by_confidence


def test_it_plays_to_the_end_of_the_window(qtbot, viewer, files):
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    time, side = viewer.time, viewer.sides[0]
    time.speed.setCurrentIndex(time.speed.findData(2.0))
    time.last.setCurrentIndex(time.last.findData(0.5))
    seen = []
    time.changed.connect(lambda: seen.append(time.chosen()))
    qtbot.mouseClick(time.play, Qt.MouseButton.LeftButton)
    assert time.playing()
    assert time.play.text() == "Pause"
    qtbot.waitUntil(lambda: not time.playing(), timeout=LONG)
    assert seen[-1] == (pytest.approx(3.5, abs=0.02), pytest.approx(4.0, abs=0.02))
    assert len({end for _, end in seen}) > 3
    moments = viewer.sources[0].contacts.moments
    late = int((moments >= 3.5).sum())
    qtbot.waitUntil(lambda: side.frame.contacts == pytest.approx(late, abs=3), timeout=LONG)
    qtbot.mouseClick(time.whole, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: side.frame.contacts == len(moments), timeout=LONG)


def test_two_have_one_camera_and_one_scale(qtbot, viewer, files):
    opened(qtbot, viewer, files, "one.mcap", "two.mcap", "p.ply", "c.json")
    viewer.controls.quantity.setCurrentIndex(viewer.controls.quantity.findData("peak"))
    viewer.controls.compare.setChecked(True)
    qtbot.waitUntil(lambda: settled(viewer) and viewer.sides[1].frame is not None, timeout=LONG)
    first, second = viewer.sides
    assert (first.source.currentText(), second.source.currentText()) == ("one.mcap", "two.mcap")
    tops = []
    for side in (first, second):
        side.show_selection = lambda selection, scale, old=side.show_selection: (
            tops.append(scale.top),
            old(selection, scale),
        )
    viewer._show()
    assert tops == [pytest.approx(8.0, abs=0.4)] * 2
    second.scene.look("top")
    assert np.allclose(np.concatenate(first.scene.camera()), np.concatenate(second.scene.camera()))
    before = first.scene.camera()
    first.scene.look("side")
    assert first.scene.camera() != before
    probe = first.playback.probe
    face = int(np.argmax(np.nan_to_num(first.frame.values)[probe.faces].min(axis=1)))
    first.scene.hovered.emit(Pick(face, probe.vertices[probe.faces[face]].mean(axis=0)))
    assert "mm" in first.place.text() == second.place.text()
    assert first.value.text() != second.value.text()
    assert np.allclose(np.concatenate(first.scene.camera()), np.concatenate(second.scene.camera()))


def test_two_are_on_one_clock_from_their_first_contact(qtbot, viewer, files, tmp_path, monkeypatch):
    opened(qtbot, viewer, files, "one.mcap", "late.mcap", "p.ply", "c.json")
    viewer.controls.compare.setChecked(True)
    qtbot.waitUntil(lambda: settled(viewer) and viewer.sides[1].frame is not None, timeout=LONG)
    assert viewer.controls.clock.isVisible()
    late = viewer.sources[1].contacts
    assert late.onset == pytest.approx(1.5, abs=0.05)

    def counts():
        viewer._show()
        return [side.frame.contacts for side in viewer.sides]

    viewer.time.slider.set_values(0.0, 1.0)
    first, second = counts()
    assert first > 80
    assert second == pytest.approx(first, abs=3)
    viewer.controls.later.setValue(0.5)
    assert counts() == [pytest.approx(first, abs=3), pytest.approx(first - 50, abs=5)]
    viewer.controls.later.setValue(-0.5)  # earlier than the first: both begin with it
    assert counts() == [pytest.approx(first - 50, abs=5), pytest.approx(first, abs=3)]
    viewer.controls.later.setValue(0.0)
    # what is saved is what is seen, each on its own clock
    file = tmp_path / "pair.ply"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    viewer.controls.asked_save.emit("mesh")
    qtbot.waitUntil(lambda: "Saved" in viewer.controls.message.text(), timeout=LONG)
    selection = viewer.selection(1)
    assert (selection.start, selection.end) == (
        late.onset - viewer.sources[0].contacts.onset,
        pytest.approx(2.5, abs=0.05),
    )
    command(
        files / "late.mcap", "--probe", files / "p.ply", "--calibration", files / "c.json",
        "--bandwidth", 1e3 * selection.bandwidth, "--from", selection.start, "--to", selection.end,
        "--out", tmp_path / "theirs.ply",
    )  # fmt: skip
    assert (tmp_path / "pair-right.ply").read_bytes() == (tmp_path / "theirs.ply").read_bytes()
    viewer.controls.clock.setCurrentIndex(1)
    assert counts() == [pytest.approx(first, abs=3), 0]
    viewer.controls.compare.setChecked(False)
    assert viewer.shift(0) == 0.0


def test_nothing_is_disabled_without_a_reason(qtbot, viewer, files):
    controls = viewer.controls
    assert all("open files" in button.toolTip() for button in controls._saving)
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    assert not any("open files" in button.toolTip() for button in controls._saving)
    controls.quantity.setCurrentIndex(controls.quantity.findData("peak"))
    assert "nothing is weighed" in controls.by_confidence.toolTip()


def test_only_films_that_can_be_made_are_offered(viewer, monkeypatch):
    monkeypatch.setattr("contactbench.app.heatmap_viewer.viewer.find_spec", lambda _name: None)
    assert viewer._saving._films() == ("Animated GIF (*.gif)",)


def test_the_picture_is_copied_with_a_key(qtbot, viewer, files):
    QGuiApplication.clipboard().clear()
    viewer._copy()
    assert "Nothing is shown yet" in viewer.controls.message.text()
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    keys = {each.key().toString(): each for each in viewer.findChildren(QShortcut)}
    keys["Ctrl+Shift+C"].activated.emit()  # a key reaches it only where a window manager gives the focus
    assert QGuiApplication.clipboard().image().width() >= viewer.sides[0].width()
    assert viewer.sides[0].scene.buttons.isVisible()


def test_a_place_under_the_cursor_is_read(qtbot, viewer, files):
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    viewer.controls.quantity.setCurrentIndex(viewer.controls.quantity.findData("force"))
    side = viewer.sides[0]
    qtbot.waitUntil(lambda: side.frame is not None and side.frame.unit == "N", timeout=LONG)
    probe = side.playback.probe
    face = int(np.argmax(np.nan_to_num(side.frame.values)[probe.faces].min(axis=1)))
    side.scene.hovered.emit(Pick(face, probe.vertices[probe.faces[face]].mean(axis=0)))
    assert " ± " in side.value.text()
    assert side.value.text().endswith(" N")
    assert "mm" in side.place.text()
    side.scene.hovered.emit(None)
    assert side.value.text() == ""


@pytest.mark.parametrize("suffix", ["png", "ply", "glb", "gif"])
def test_what_is_saved_is_what_the_command_writes(qtbot, viewer, files, tmp_path, suffix, monkeypatch):
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    controls = viewer.controls
    controls.quantity.setCurrentIndex(controls.quantity.findData("force"))
    controls.bandwidth.setValue(3.0)
    controls.logarithmic.click()
    controls.force.set_values(2.5, controls.force.limits()[1])
    viewer.time.slider.set_values(0.5, 3.25)
    viewer.time.speed.setCurrentIndex(viewer.time.speed.findData(20.0))
    mine, theirs = tmp_path / f"mine.{suffix}", tmp_path / f"theirs.{suffix}"
    what = {"png": "picture", "gif": "film"}.get(suffix, "mesh")
    chosen = (str(mine.with_suffix("") if suffix == "png" else mine), "Picture (*.png)")
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: chosen)
    controls.asked_save.emit(what)
    qtbot.waitUntil(lambda: "Saved" in controls.message.text(), timeout=LONG)
    arguments = [files / "one.mcap", "--probe", files / "p.ply", "--calibration", files / "c.json"]
    arguments += ["--quantity", "force", "--bandwidth", 3, "--from", 0.5, "--to", 3.25, "--force-from", 2.5]
    arguments += ["--speed", 20, "--logarithmic", "--out", theirs]
    done = invoke("heatmap", "draw", *arguments)
    assert done.exit_code == 0, done.output
    assert mine.read_bytes() == theirs.read_bytes()


def test_dropped_files_and_what_is_missing(qtbot, viewer, files):
    def drop(*names):
        drop_files(viewer, *(files / name for name in names))

    message = viewer.controls.message
    drop("one.mcap")
    qtbot.waitUntil(lambda: "give the probe that was touched" in message.text(), timeout=LONG)
    drop("p.ply")
    qtbot.waitUntil(lambda: "give its calibration.json" in message.text(), timeout=LONG)
    drop("c.json")
    qtbot.waitUntil(lambda: settled(viewer), timeout=LONG)
    assert [source.name for source in viewer.sources] == ["one.mcap"]


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("x.txt", b"hello", "nothing that can be shown"),
        ("x.json", b"{", "not JSON"),
        ("none.csv", None, "no such file"),
        ("x.csv", b"t,x,y,z,k,face,reason,candidates,sigma_max_mm\n", "probe"),
    ],
)
def test_a_bad_file_is_said(qtbot, viewer, tmp_path, name, content, words):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    viewer.open([tmp_path / name])
    qtbot.waitUntil(lambda: words in viewer.controls.message.text(), timeout=LONG)
    assert viewer.sources == []


def test_a_session_is_opened(qtbot, viewer, files, tmp_path):
    with Session.create(tmp_path / "s", by="ada") as session:
        for kind, name in (("recording", "one.mcap"), ("probe", "p.ply"), ("calibration", "c.json")):
            session.add_input(files / name, kind)
    viewer.open([tmp_path / "s"])
    qtbot.waitUntil(lambda: settled(viewer), timeout=LONG)
    assert [source.name for source in viewer.sources] == ["s: one.mcap"]


def test_a_recording_of_a_session_that_cannot_be_read_is_said_in_any_language(files, tmp_path):
    (tmp_path / "bad.mcap").write_bytes(b"no recording")
    with Session.create(tmp_path / "s", by="ada") as session:
        for kind, file in (
            ("recording", tmp_path / "bad.mcap"),
            ("probe", files / "p.ply"),
            ("calibration", files / "c.json"),
        ):
            session.add_input(file, kind)
    (problem,) = open_files(sorted_files([tmp_path / "s"])).problems
    assert problem == "s: bad.mcap: not an MCAP file: choose a recording or a ROS 2 bag."
    assert problem.translated(lambda text: text.replace("{0}: not an", "{0}: no")).startswith(
        "s: bad.mcap: no MCAP"
    )


def saved_mesh(qtbot, viewer, file, monkeypatch):
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    viewer.controls.asked_save.emit("mesh")
    qtbot.waitUntil(lambda: "Saved" in viewer.controls.message.text(), timeout=LONG)
    return file.read_bytes()


def command(*arguments):
    done = invoke("heatmap", "draw", *arguments)
    assert done.exit_code == 0, done.output


def test_how_a_recording_is_read_is_chosen_as_on_the_command_line(
    qtbot, viewer, files, tmp_path, monkeypatch
):
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    box, first = viewer.controls.reading, viewer.sources[0]
    assert not box.mount[2].isEnabled()
    box.own_mount.setChecked(True)
    box.mount[2].setValue(90.0)
    box.delay.setValue(20.0)
    box.limits["min_force"].field.setValue(2.0)
    qtbot.waitUntil(lambda: viewer.sources[0] is not first and settled(viewer), timeout=LONG)
    viewer.controls.bandwidth.setValue(3.0)
    mine = saved_mesh(qtbot, viewer, tmp_path / "mine.ply", monkeypatch)
    arguments = [files / "one.mcap", "--probe", files / "p.ply", "--calibration", files / "c.json"]
    arguments += ["--mount", "0,0,90", "--delay", 0.02, "--min-force", 2, "--bandwidth", 3]
    command(*arguments, "--out", tmp_path / "theirs.ply")
    assert mine == (tmp_path / "theirs.ply").read_bytes()
    command(*arguments[:5], "--bandwidth", 3, "--out", tmp_path / "plain.ply")
    assert mine != (tmp_path / "plain.ply").read_bytes()


def test_the_mount_that_a_session_knows_counts_by_itself(qtbot, viewer, files, tmp_path, monkeypatch):
    with Session.create(tmp_path / "s", by="ada") as session:
        for kind, name in (("recording", "one.mcap"), ("probe", "p.ply"), ("calibration", "c.json")):
            session.add_input(files / name, kind)
        session.set_parameter("devices.mount", [0.0, 0.0, 90.0])
    viewer.open([tmp_path / "s"])
    qtbot.waitUntil(lambda: settled(viewer), timeout=LONG)
    viewer.controls.bandwidth.setValue(3.0)
    mine = saved_mesh(qtbot, viewer, tmp_path / "mine.ply", monkeypatch)
    command(tmp_path / "s", "--bandwidth", 3, "--out", tmp_path / "session.ply")
    arguments = [files / "one.mcap", "--probe", files / "p.ply", "--calibration", files / "c.json"]
    command(*arguments, "--mount", "0,0,90", "--bandwidth", 3, "--out", tmp_path / "mount.ply")
    assert mine == (tmp_path / "session.ply").read_bytes() == (tmp_path / "mount.ply").read_bytes()


def test_work_is_shown_and_can_be_stopped(qtbot, viewer, files, tmp_path, monkeypatch):
    opened(qtbot, viewer, files, "one.mcap", "p.ply", "c.json")
    viewer.time.speed.setCurrentIndex(viewer.time.speed.findData(0.1))
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "a.gif"), ""))
    viewer.controls.asked_save.emit("film")
    assert viewer.controls.bar.isVisible()
    qtbot.mouseClick(viewer.controls.stop, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "Stopped" in viewer.controls.message.text(), timeout=LONG)
    qtbot.waitUntil(lambda: not viewer.controls.bar.isVisible(), timeout=LONG)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("value", "sigma", "text"),
    [
        (0.7312345, 0.123, "0.73 ± 0.12 N"),
        (12.3456, 2.3, "12.3 ± 2.3 N"),
        (1234.5, 30.0, "1234 ± 30 N"),
        (2.345678, float("nan"), "2.35 N"),
        (1.0, 0.0, "1 N"),
    ],
)
def test_numbers_have_no_more_digits_than_they_are_sure(value, sigma, text):
    assert number_with_unit(value, sigma, "N") == text
