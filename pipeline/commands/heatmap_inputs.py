"""Where ``contactbench heatmap`` gets its contacts from: a recording, a table, a verification, or a session."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from contactbench.pipeline.commands.options import mount_rotation
from contactbench.pipeline.console import Bar, say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contactbench.pipeline.heatmap.contacts import Contacts
    from contactbench.pipeline.mesh.sidecar import ProbeFile

_HEAD = 4096  # bytes that tell a verification from a table


@dataclass(frozen=True)
class Files:
    """What a heatmap is made from; `mount` as a session says, degrees about x, y, z."""

    contacts: Path
    probe: Path
    calibration: Path | None
    mount: tuple[float, float, float] | None = None


@contextmanager
def chosen(contacts: Path, probe: Path | None, calibration: Path | None, *, judged: bool) -> Iterator[Files]:
    """
    Give the files; a session's newest ones where `contacts` is its folder.

    Parameters
    ----------
    judged : bool
        Of a session its verification, not its recording: for errors.
    """
    if not contacts.is_dir():
        if probe is None:
            raise typer.BadParameter("give the probe that was touched: --probe PROBE.ply.")
        yield Files(contacts, probe, calibration)
        return
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.making import mount_of
    from contactbench.pipeline.session.recompute import lay_out, newest_inputs

    with Session.open(contacts, write=False) as session, tempfile.TemporaryDirectory() as scratch:
        roles = newest_inputs(session.state, "report" if judged else "heatmap")
        found = lay_out(session.folder, session.state, roles, Path(scratch))
        said = ", ".join(f"{role} {file.name}" for role, file in found.items())
        say(f"from the session: {said}")
        main = found["verification" if judged else "recording"]
        own = None if judged else found["calibration"]
        yield Files(main, probe or found["probe"], calibration or own, mount_of(session.state))


def probe_in_sensor_frame(file: Path) -> ProbeFile:
    """Return a probe; HeatmapError if it was never aligned with the sensor."""
    from contactbench.pipeline.heatmap import HeatmapError
    from contactbench.pipeline.mesh.sidecar import load_probe_file

    content = load_probe_file(file)
    for sentence in content.notes:
        say(f"warning: {sentence}", "yellow")
    if content.history and content.frame != "S":
        raise HeatmapError(
            f"{file}: the probe is not aligned with the sensor, contacts would be drawn at wrong places: run"
            " `contactbench probe align`."
        )
    return content


def found_contacts(
    files: Files,
    content: ProbeFile,
    wrenches: Path | None,
    mount: str | None,
    delay: float,
    min_force: float,
) -> Contacts:
    """Return the contacts, located if they are a recording's."""
    from contactbench.pipeline.calibration.files.capture_file import is_recording
    from contactbench.pipeline.heatmap.contacts import read_contacts

    if is_recording(files.contacts):
        if wrenches is not None:
            raise typer.BadParameter("--wrenches is for a CSV file of contacts; a recording has them itself.")
        return _located(files, content, mount, delay, min_force)
    if files.calibration is not None:
        raise typer.BadParameter("--calibration is for a recording; here contacts are located already.")
    if not _is_json(files.contacts):
        return read_contacts(files.contacts, wrenches)
    if wrenches is not None:
        raise typer.BadParameter("--wrenches is for a CSV file of contacts; a verification has forces.")
    from contactbench.pipeline.heatmap.touched import touches_of
    from contactbench.pipeline.report.making import check_sources, sha256_of
    from contactbench.pipeline.report.reading import read_verification

    verification = read_verification(files.contacts)
    used = {"verification": files.contacts, "probe": files.probe}
    check_sources(verification.sources, {"probe": sha256_of(files.probe)}, used)
    return touches_of(verification)


def _located(files: Files, content: ProbeFile, mount: str | None, delay: float, min_force: float) -> Contacts:
    if files.calibration is None:
        raise typer.BadParameter(
            "a recording needs --calibration: the weight of the probe is in its readings."
        )
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.contact import Gates
    from contactbench.pipeline.heatmap.contacts import locate_recording
    from contactbench.pipeline.session.making import mount_rotation as of_degrees

    model = load_calibration(files.calibration).model
    R_ES = mount_rotation(mount) if mount is not None else of_degrees(files.mount)
    with Bar("reading") as bar:
        return locate_recording(
            files.contacts,
            content.probe,
            model,
            gates=Gates(min_force=min_force),
            R_ES=R_ES,
            delay=delay,
            progress=bar,
        )


def _is_json(file: Path) -> bool:
    """Tell whether a file is an object in JSON; what cannot be read is refused where it is read."""
    if file.suffix.lower() == ".json":
        return True
    try:
        with file.open("rb") as stream:
            return stream.read(_HEAD).lstrip().startswith(b"{")
    except (OSError, ValueError):
        return False
