"""What the heatmap viewer can show: contacts with their probe, out of the files and sessions that were given."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from contactbench.pipeline.calibration.files.calibration_file import load_calibration
from contactbench.pipeline.calibration.files.capture_file import is_recording
from contactbench.pipeline.calibration.parameters import sha256_of
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File, read_bytes
from contactbench.pipeline.heatmap import HeatmapError
from contactbench.pipeline.heatmap.contacts import (
    Contacts,
    locate_recording,
    read_contacts,
    read_points,
    touches_of,
)
from contactbench.pipeline.heatmap.selection import in_order
from contactbench.pipeline.mesh.engines import NOBODY, Monitor
from contactbench.pipeline.mesh.formats import SUFFIXES
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file
from contactbench.pipeline.report.report_file import check_sources, read_verification
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.recompute import inputs_of, mount_of, newest_inputs
from contactbench.pipeline.settings import HeatmapSettings, ReadingSettings, mount_rotation
from contactbench.pipeline.verification.figures import SCHEMA as VERIFICATION

_HEAD = 65_536  # bytes that tell what a JSON file is
_OF_SESSION = (("heatmap", "recording"), ("report", "verification"))
_MARKER_DISTANCE = HeatmapSettings().marker_distance / 1000  # m
_USUAL = ReadingSettings()
_CONTACTS = ("recording", "table", "verification", "session")


@dataclass(frozen=True, eq=False)
class HeatmapSource:
    """Contacts on a probe."""

    name: str  # For people
    probe: ProbeFile
    contacts: Contacts  # In order of time
    notes: tuple[str, ...] = ()  # Sentences
    # What it was read from, with what it was read with: to be read again in another way
    origin: HeatmapInputs | None = None


@dataclass(frozen=True)
class HeatmapInputs:
    """Files by what they are."""

    # What holds contacts: "recording", "table", "verification" or "session", and where it is
    contacts: tuple[tuple[str, Path], ...] = ()
    # probe, calibration, wrenches, markers: What the others are shown with; the newest that was given
    probe: Path | None = None
    calibration: Path | None = None
    wrenches: Path | None = None
    markers: Path | None = None


@dataclass(frozen=True, eq=False)
class OpenedFiles:
    """What came of files."""

    sources: tuple[HeatmapSource, ...]
    problems: tuple[str, ...]  # What could not be opened, in sentences
    # To be given again with the next ones, so that a probe may come after its recording
    files: HeatmapInputs = field(default_factory=HeatmapInputs)


def sorted_files(paths: Iterable[Path], before: HeatmapInputs | None = None) -> HeatmapInputs:
    """
    Return files by what they are.

    Parameters
    ----------
    paths : iterable of Path
    before : HeatmapInputs, optional
        What was given before: its probe, calibration, wrenches and markers still hold.

    Raises
    ------
    InputError
        Something else is among them, or one cannot be read.
    """
    found: dict[str, list[Path]] = {}
    for path in paths:
        found.setdefault(_kind(path), []).append(path)
    old = before or HeatmapInputs()

    def one(kind: str, known: Path | None) -> Path | None:
        return found[kind][-1] if kind in found else known

    return HeatmapInputs(
        tuple((kind, path) for kind in _CONTACTS for path in found.get(kind, ())),
        probe=one("probe", old.probe),
        calibration=one("calibration", old.calibration),
        wrenches=one("wrenches", old.wrenches),
        markers=one("markers", old.markers),
    )


def _kind(path: Path) -> str:
    """Return what a path is, as `HeatmapInputs` has it."""
    if path.is_dir():
        return "session"
    suffix = path.suffix.lower()
    if suffix in SUFFIXES:
        return "probe"
    head = read_bytes(path, _HEAD, HeatmapError)
    if is_recording(path):
        return "recording"
    if suffix == ".json" or head.lstrip().startswith(b"{"):
        return _kind_of_json(path)
    names = {name.strip() for name in head.split(b"\n", 1)[0].decode("utf-8", "replace").split(",")}
    if "x_mm" in names:
        return "markers"
    if {"x", "y", "z", "reason"} <= names:
        return "table"
    if {"fx", "fy", "fz"} <= names:
        return "wrenches"
    raise HeatmapError(
        f"{arg(path.name)}: this is nothing that can be shown: give a recording (.mcap) with its calibration and probe,"
        " contacts (.csv), a verification (.json), or the folder of a session."
    )


def _kind_of_json(path: Path) -> str:
    try:
        content = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError) as error:
        raise HeatmapError(
            f"{arg(path.name)}: this is not JSON ({arg(error)}): choose another file."
        ) from error
    verified = isinstance(content, dict) and content.get("schema") == VERIFICATION
    return "verification" if verified else "calibration"


def open_files(files: HeatmapInputs, how: ReadingSettings = _USUAL, monitor: Monitor = NOBODY) -> OpenedFiles:
    """
    Read all contacts, each with its probe; one that cannot be read is a problem of its own.

    Parameters
    ----------
    files : HeatmapInputs
    how : ReadingSettings
    monitor : Monitor

    Raises
    ------
    Cancelled
        The caller cancelled.
    """
    sources: list[HeatmapSource] = []
    problems: list[str] = []
    count = max(len(files.contacts), 1)

    for number, (kind, path) in enumerate(files.contacts):

        def told(done: int, whole: int, number: int = number) -> None:
            monitor.tell((number + done / max(whole, 1)) / count)

        told(0, 1)
        try:
            if kind == "session":
                found = _of_session(path, files, how, told, problems)
            else:
                read = _Read(path, kind, files.probe, files.calibration)
                found = [_of_file(read, files, how, told)]
            origin = replace(files, contacts=((kind, path),))
            sources += [replace(source, origin=origin) for source in found]
        except InputError as error:
            problems.append(str(error))
        told(1, 1)
    return OpenedFiles(tuple(sources), tuple(problems), files)


def read_again(
    sources: Iterable[HeatmapSource], how: ReadingSettings, monitor: Monitor = NOBODY
) -> OpenedFiles:
    """Read those that come from recordings once more, in another way; as `open_files`."""
    origins = {
        source.origin.contacts: source.origin
        for source in sources
        if source.origin is not None and source.origin.contacts[0][0] in ("recording", "session")
    }
    found: list[HeatmapSource] = []
    problems: list[str] = []
    for number, origin in enumerate(origins.values()):
        part = monitor.part(number / len(origins), (number + 1) / len(origins))
        opened = open_files(origin, how, part)
        found += opened.sources
        problems += opened.problems
    return OpenedFiles(tuple(found), tuple(problems))


@dataclass(frozen=True)
class _Read:
    """A file that holds contacts, and what it is read with."""

    file: File
    kind: str
    probe: File | None
    calibration: File | None


def _of_file(
    read: _Read, files: HeatmapInputs, how: ReadingSettings, told: Callable[[int, int], None], name: str = ""
) -> HeatmapSource:
    file = read.file
    if read.probe is None:
        raise HeatmapError(
            f"{arg(file.name)}: give the probe that was touched, too: the .ply that was prepared."
        )
    probe = aligned_probe(read.probe)
    used = (read.probe, probe, read.calibration, files.wrenches)
    contacts = contacts_of(file, read.kind, *used, how, told)
    if not len(contacts.points):
        raise HeatmapError(f"{arg(file.name)}: nothing touched the probe in it: touch it while recording.")
    if files.markers is not None and contacts.known_errors is None:
        contacts = _with_errors(contacts, files.markers)
    return HeatmapSource(name or file.name, probe, in_order(contacts), (*probe.notes, *contacts.notes))


def aligned_probe(file: File) -> ProbeFile:
    """Return the probe of a file; HeatmapError if it was never aligned with the sensor."""
    probe = load_probe_file(file)
    if probe.history and probe.frame != "S":
        raise HeatmapError(
            f"{arg(file.name)}: the probe is not aligned with the sensor, contacts would be drawn at"
            " wrong places: align it first."
        )
    return probe


def contacts_of(
    file: File,
    kind: str,
    probe_file: File,
    probe: ProbeFile,
    calibration: File | None,
    wrenches: Path | None,
    how: ReadingSettings,
    told: Callable[[int, int], None],
) -> Contacts:
    """
    Return the contacts in a file, located if they are a recording's.

    Parameters
    ----------
    kind : str
        "recording", "table" or "verification".
    probe_file, probe
        The probe that was touched.
    calibration : path, optional
        Of a recording.
    wrenches : path, optional
        That a table was located from.

    Raises
    ------
    InputError
        Something is missing, or cannot be read.
    """
    if kind == "table":
        return read_contacts(file, wrenches)
    if kind == "verification":
        verification = read_verification(file)
        used = {"verification": file, "probe": probe_file}
        check_sources(verification.sources, {"probe": sha256_of(probe_file)}, used)
        return touches_of(verification)
    if calibration is None:
        raise HeatmapError(
            f"{arg(file.name)}: give its calibration.json, too: the weight of the probe is in its readings."
        )
    model, R_ES = load_calibration(calibration).model, mount_rotation(how.mount)
    return locate_recording(
        file, probe.probe, model, gates=how.gates, R_ES=R_ES, delay=how.delay, progress=told
    )


def _with_errors(contacts: Contacts, markers: Path) -> Contacts:
    """Return contacts whose errors are the distances to the nearest marker, where the force is steady."""
    errors, near = contacts.errors(read_points(markers), _MARKER_DISTANCE)
    steady = near if contacts.settled is None else near & contacts.settled
    return replace(contacts, known_errors=np.where(steady, errors, np.nan))


def _of_session(
    folder: Path,
    given: HeatmapInputs,
    how: ReadingSettings,
    told: Callable[[int, int], None],
    problems: list[str],
) -> list[HeatmapSource]:
    """Return the newest recording of a session, and the touches of its verification."""
    found: list[HeatmapSource] = []
    reasons: list[str] = []
    with Session.open(folder, write=False) as session:
        how = how.model_copy(update={"mount": how.mount or mount_of(session.state)})
        for kind, main in _OF_SESSION:
            try:
                roles = newest_inputs(session.state, kind)
            except InputError as error:
                reasons.append(str(error))
                continue
            laid = inputs_of(session.folder, session.state, roles)
            given_with = _Read(laid[main], main, laid["probe"], laid.get("calibration"))
            try:
                found.append(_of_file(given_with, given, how, told, f"{folder.name}: {laid[main].name}"))
            except InputError as error:
                problems.append(message(f"{arg(folder.name)}: {arg(error)}"))
    if not found and len(reasons) == len(_OF_SESSION):
        raise HeatmapError(f"{arg(folder.name)}: {arg(reasons[0])}")
    return found
