"""How long a person waits for long work: a heatmap of many contacts, a prepared mesh, a converted recording."""

import json
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter, process_time

import numpy as np
from mcap.reader import NonSeekingReader

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.contact.contact_csv import HEADER, ContactRows
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.heatmap.contacts import read_contacts
from contactbench.pipeline.heatmap.picture import encode_png
from contactbench.pipeline.heatmap.selection import Selection, selected_heatmap
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.engines import alpha_wrap
from contactbench.pipeline.mesh.sidecar import encode_probe_file
from contactbench.pipeline.preparation.cache import VARIABLE
from contactbench.pipeline.preparation.prepare import import_mesh, prepared
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter, read_recording
from contactbench.pipeline.recording.convert import write_csv
from contactbench.pipeline.settings import ProbeSettings
from contactbench.pipeline.simulation.touches import draw_touches
from contactbench.pipeline.study.report import Figure, StudyReport

HEATMAP_S = 2.0
AGAIN_S = 0.5  # a mesh that was prepared before, without the program's start
AS_WRAP = 2.0  # times as long as an alpha wrap called bare
AS_PARSER = 1.0  # times as long as the mcap library and Python's json take for the same messages
_SAMPLES = 250  # of a touch
_BLOCK = 50_000


def run(
    mesh: Path | None = None,
    *,
    contacts: int = 1_000_000,
    samples: int = 500_000,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Time three kinds of work, each beside what it cannot do without; processor time where nothing else counts."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        figures = [*_heatmap(folder, contacts, progress)]
        if mesh is not None:
            figures += _preparation(folder, mesh, progress)
        figures += _conversion(folder, samples, progress)
    setup = {"contacts": contacts, "mesh": "" if mesh is None else mesh.name, "samples": samples}
    return StudyReport("Waiting", setup, tuple(figures))


def _heatmap(folder: Path, count: int, progress: Callable[[str], None]) -> list[Figure]:
    progress(f"a heatmap of {count:,} contacts")
    probe = Probe.from_arrays(*assets.make("linear", 2_000), name="linear")
    file = folder / "contacts.csv"
    rng = np.random.default_rng(0)
    touches = draw_touches(assets.surface("linear"), max(1, count // _SAMPLES), rng).wrenches
    solver, rows = ContactSolver(probe), ContactRows()
    with file.open("wb") as stream:
        stream.write(HEADER)
        for begin in range(0, count, _BLOCK):
            number = np.arange(begin, min(begin + _BLOCK, count))
            wrenches = touches[number // _SAMPLES % len(touches)] + rng.normal(size=(len(number), 6)) * [
                *(3 * [0.05]),
                *(3 * [0.002]),
            ]
            found = solver.locate_batch(np.ascontiguousarray(wrenches), threads=0)
            times = np.array([f"{0.001 * n:.3f}".encode() for n in number.tolist()])
            marks = np.zeros(len(number), dtype=np.uint8)
            stream.write(rows.encode(times, found, 1e3 * found.sigma_max, marks))
    begun, used = perf_counter(), process_time()
    read = read_contacts(file)
    read_used = process_time() - used
    made = selected_heatmap(probe, read, Selection())
    spread_used = process_time() - used - read_used
    encode_png(made)
    subject = f"heatmap of {count:,} contacts"
    return [
        Figure(subject, "wall time", perf_counter() - begun, "s", most=HEATMAP_S),
        Figure(subject, "reading, processor", read_used, "s"),
        Figure(subject, "spreading, processor", spread_used, "s"),
        Figure(subject, "drawing, processor", process_time() - used - read_used - spread_used, "s"),
    ]


def _preparation(folder: Path, mesh: Path, progress: Callable[[str], None]) -> list[Figure]:
    progress(f"{mesh.name}: an alpha wrap")
    before = os.environ.get(VARIABLE)
    given = ProbeSettings(facets=2_000)
    probe = import_mesh(mesh).probe
    alone = probe.vertices[probe.faces].reshape(-1, 3)
    facets = np.arange(len(alone), dtype=np.int32).reshape(-1, 3)
    alpha = probe.size / 190
    alpha_wrap(alone[:300], facets[:100], probe.size, 0.1 * probe.size)  # the library's process starts
    begun = perf_counter()
    alpha_wrap(alone, facets, alpha, 0.1 * alpha)
    wrap = perf_counter() - begun
    progress(f"{mesh.name}: prepared")
    took, files = [], []
    try:
        os.environ[VARIABLE] = str(folder / "kept")
        for _ in range(2):
            begun = perf_counter()
            done = prepared({"mesh": mesh}, given, remember=True)
            took.append(perf_counter() - begun)
            files.append(encode_probe_file(done.content, "probe.ply"))
            _forget()
    finally:
        os.environ.pop(VARIABLE)
        if before is not None:
            os.environ[VARIABLE] = before
    subject = f"{mesh.name} prepared"
    return [
        Figure(subject, "first time, over an alpha wrap", took[0] / wrap, most=AS_WRAP),
        Figure(subject, "an alpha wrap", wrap, "s"),
        Figure(subject, "again", took[1], "s", most=AGAIN_S),
        Figure(subject, "again it is the same to the byte", float(files[0] == files[1]), least=1.0),
    ]


def _forget() -> None:
    """Let go of what this process remembers: the next call is like another process's."""
    from contactbench.pipeline.preparation import cache

    cache._held.clear()


def _conversion(folder: Path, count: int, progress: Callable[[str], None]) -> list[Figure]:
    progress(f"a recording of {count:,} samples")
    file = folder / "recording.mcap"
    record(file, count)
    begun = process_time()
    with file.open("rb") as stream:
        for _, _, message in NonSeekingReader(stream).iter_messages(log_time_order=False):
            json.loads(message.data)
    parser = process_time() - begun
    begun = process_time()
    read_recording(file)
    read = process_time() - begun
    begun = process_time()
    write_csv(folder / "recording.csv", file)
    whole = process_time() - begun
    subject = f"recording of {count:,} samples"
    size = file.stat().st_size
    return [
        Figure(subject, "read, over the mcap library and json", read / parser, most=AS_PARSER),
        Figure(subject, "converted, over the mcap library and json", whole / parser, most=AS_PARSER),
        Figure(subject, "converted", size / whole / 1e6, "MB/s"),
    ]


def record(file: Path, count: int) -> None:
    """Write a recording of wrenches at 1 kHz and poses at 125 Hz."""
    rng = np.random.default_rng(0)
    devices = (
        DeviceInfo("wrench", "/wrench", "sri+tcp://192.168.0.108:4008", "M8128", "1", 1000.0),
        DeviceInfo("flange", "/flange", "elfin+tcp://10.0.0.2"),
    )
    with RecordingWriter(file, RecordingInfo(0, 1000.0, devices)) as writer:
        for number, row in enumerate(rng.normal(size=(count, 6)).tolist()):
            moment = 1000.0 + number / 1000
            force, torque = (row[0], row[1], row[2]), (row[3], row[4], row[5])
            writer.wrench(WrenchSample(moment, force, torque, number))
            if number % 8 == 0:
                writer.flange(FlangeSample(moment, np.eye(3), np.array(row[:3]), np.array(row)))
