"""``contactbench heatmap ...``: where on the probe it was touched."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from contactbench.pipeline.commands.options import refuse_overwriting, shown
from contactbench.pipeline.console import Bar, Noun, answer, say, warn
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.settings import HeatmapSettings, ReadingSettings, metres

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.files import File
    from contactbench.pipeline.heatmap import Heatmap
    from contactbench.pipeline.heatmap.contacts import Contacts
    from contactbench.pipeline.heatmap.selection import Selection
    from contactbench.pipeline.mesh.sidecar import ProbeFile


_HEAD = 4096  # bytes that tell a verification from a table


@dataclass(frozen=True)
class HeatmapFiles:
    """What a heatmap is made from; `mount` as a session says, degrees about x, y, z."""

    contacts: File
    probe: File
    calibration: File | None
    mount: tuple[float, float, float] | None = None


@contextmanager
def chosen(
    contacts: Path, probe: Path | None, calibration: Path | None, *, judged: bool
) -> Iterator[HeatmapFiles]:
    """
    Give the files; a session's newest ones where `contacts` is its folder.

    Parameters
    ----------
    judged : bool
        Of a session its verification, not its recording: for errors.
    """
    if not contacts.is_dir():
        if probe is None:
            raise typer.BadParameter("give the touched probe: --probe PROBE.ply.")
        yield HeatmapFiles(contacts, probe, calibration)
        return
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.recompute import inputs_of, mount_of, newest_inputs

    with Session.open(contacts, write=False) as session:
        roles = newest_inputs(session.state, "report" if judged else "heatmap")
        found = inputs_of(session.folder, session.state, roles)
        said = ", ".join(f"{role} {file.name}" for role, file in found.items())
        say(f"from the session: {said}")
        main = found["verification" if judged else "recording"]
        own = None if judged else found["calibration"]
        yield HeatmapFiles(main, probe or found["probe"], calibration or own, mount_of(session.state))


def found_contacts(
    files: HeatmapFiles, content: ProbeFile, wrenches: Path | None, given: ReadingSettings
) -> Contacts:
    """Return the contacts, located if they are a recording's."""
    from contactbench.pipeline.calibration.files.capture_file import is_recording
    from contactbench.pipeline.workbench.heatmap_sources import contacts_of

    kind = "verification" if _is_json(files.contacts) else "table"
    if is_recording(files.contacts):
        kind = "recording"
        if wrenches is not None:
            raise typer.BadParameter("--wrenches is for a CSV file of contacts; a recording contains them.")
        if files.calibration is None:
            raise typer.BadParameter(
                "a recording needs --calibration because its readings include the weight of the probe."
            )
    elif files.calibration is not None:
        raise typer.BadParameter("--calibration is for a recording; these contacts are already located.")
    elif kind == "verification" and wrenches is not None:
        raise typer.BadParameter(
            "--wrenches is for a CSV file of contacts; a verification contains the forces."
        )
    how = given.model_copy(update={"mount": given.mount or files.mount})
    with Bar("reading") as bar:
        return contacts_of(files.contacts, kind, files.probe, content, files.calibration, wrenches, how, bar)


def _is_json(file: File) -> bool:
    """Tell whether a file is an object in JSON; what cannot be read is refused where it is read."""
    if file.suffix.lower() == ".json":
        return True
    try:
        with file.open("rb") as stream:
            return stream.read(_HEAD).lstrip().startswith(b"{")
    except (OSError, ValueError):
        return False


heatmap_app = Noun("Show where the probe was touched: as a picture, a mesh or a film, or in a window.")

_SUFFIXES = (".png", ".ply", ".glb")
_PAGES = (".html", ".pdf")
_FILMS = (".mp4", ".gif")


@heatmap_app.command(
    example=("heatmap draw scan.mcap --probe p.ply --calibration c.json --quantity force --out map.png")
)
def draw(
    contacts: Path,
    /,
    out: Path,
    given: HeatmapSettings,
    probe: Path | None = None,
    calibration: Path | None = None,
    wrenches: Path | None = None,
    markers: Path | None = None,
    speed: float = 1.0,
    last: float | None = None,
) -> None:
    """Show where the probe was touched: how often, how hard, how certain and how accurate.

    CONTACTS is a recording (.mcap; with --calibration), the output of contactbench locate (.csv) or of
    contactbench verify touches (.json), or the folder of a session: its newest recording or, for errors,
    verification. Errors are those of accepted touches, or of samples whose force is steady. Each contact
    is spread by a Gaussian of the distance along the surface; beyond three bandwidths there is no data.
    The integral of a density over the surface is the number of contacts, their seconds, or contacts per
    second. The peak is the largest force within one bandwidth. A film, .mp4 or .gif, shows it over
    time.

    Parameters
    ----------
    contacts
        Recording, CSV of contacts, verification, or folder of a session.
    out
        File to write: .png; a page .html or .pdf; .ply or .glb with the value at each vertex; or a film: .mp4
        or .gif.
    probe
        Probe that contactbench prepared, .ply [in a session: its newest].
    calibration
        For a recording: what contactbench calibrate fit wrote.
    wrenches
        For a CSV of contacts: the wrenches they were located from, for forces.
    markers
        For the error: CSV with x_mm,y_mm,z_mm of the touched points.
    speed
        Film: seconds of contacts per second of film, 0.1 to 50.
    last
        Film: show only the last seconds [touched places stay], s.
    """
    kind = out.suffix.lower()
    if kind not in (*_SUFFIXES, *_PAGES, *_FILMS):
        raise typer.BadParameter(
            f"--out {out}: name a file that ends in .png, .html, .pdf, .ply, .glb, .mp4 or .gif."
        )
    if last is not None and kind not in _FILMS:
        raise typer.BadParameter(
            "--last is for a film: name a file that ends in .mp4 or .gif, or give --from."
        )
    judged = given.quantity == "error" and markers is None
    read = [file for file in (contacts, probe, calibration, wrenches, markers) if file is not None]
    refuse_overwriting(out, read)
    from contactbench.pipeline.heatmap.selection import Selection, windowed
    from contactbench.pipeline.workbench.heatmap_sources import aligned_probe

    what = given.model_dump(include={each.name for each in fields(Selection)})
    selection = Selection(**{**what, "bandwidth": metres(given.bandwidth)})
    with chosen(contacts, probe, calibration, judged=judged) as files:
        content = aligned_probe(files.probe)
        warn(content.notes)
        found = found_contacts(files, content, wrenches, given)
        _check_weight(files.contacts, found, selection)
        part = windowed(found, selection)
        made, left_out, notes = _made(part, content, selection, markers, given.marker_distance)
    warn(notes)
    if kind in _FILMS:
        _write_film(found, content, selection, markers, given.marker_distance, out, speed, last)
    elif kind in _PAGES:
        _write_page(made, out, left_out, notes)
    else:
        _write(made, out)
    _say(made, out, left_out)
    facts = {"out": str(out), **made.facts(), "left_out": left_out, "warnings": notes}
    answer({**facts, "noise": _noise(found)})


def _check_weight(file: File, found: Contacts, selection: Selection) -> None:
    """Refuse, with the file's name, a weight that the contacts do not have."""
    from contactbench.pipeline.heatmap import HeatmapError
    from contactbench.pipeline.heatmap.selection import weights_of

    try:
        weights_of(found, selection)
    except HeatmapError as error:
        raise HeatmapError(f"{file}: {error}") from error


def _noise(found: Contacts) -> dict[str, list[float]] | None:
    """Return what uncertainties follow from, the calibration's share too; None: the contacts came with theirs."""
    if found.noise is None:
        return None
    sigma = found.noise.covariance.diagonal() ** 0.5
    return {"force_N": sigma[:3].tolist(), "torque_Nm": sigma[3:].tolist()}


def _say(made: Heatmap, out: Path, left_out: dict[str, int]) -> None:
    say(
        f"{out}: {made.title}, {made.contacts:,} {made.counted}, largest {made.largest:.3g} {made.unit}, bandwidth"
        f" {1e3 * made.bandwidth:.3g} mm"
    )
    if left_out:
        said = ", ".join(f"{why} ({count:,})" for why, count in left_out.items())
        say(f"left out of {made.contacts + sum(left_out.values()):,} {made.counted}: {said}")


def _made(
    found: Contacts, content: ProbeFile, selection: Selection, markers: Path | None, marker_distance: float
) -> tuple[Heatmap, dict[str, int], list[str]]:
    """Return the heatmap, how many were left out for which reason, and what is to be said of it."""
    from contactbench.pipeline.heatmap.selection import drawn, shown

    left_out, notes = dict(found.left_out), list(found.notes)
    if selection.quantity in ("force", "peak") and found.forces is None:
        raise typer.BadParameter(f"--quantity {selection.quantity} needs the forces: give --wrenches.")
    values: NDArray[np.float64] | None
    if selection.quantity == "error":
        values, use = _errors(found, markers, marker_distance, left_out, notes)
    else:
        values, use = shown(found, selection)
        _count(left_out, "uncertainty unknown", ~use)
    made = drawn(content.probe, found, selection, values, use)
    return made, left_out, [*notes, *made.notes]


def _write_film(
    found: Contacts,
    content: ProbeFile,
    selection: Selection,
    markers: Path | None,
    marker_distance: float,
    out: Path,
    speed: float,
    last: float | None,
) -> None:
    from dataclasses import replace

    import numpy as np

    from contactbench.pipeline.heatmap.picture import FilmSettings, write_film
    from contactbench.pipeline.heatmap.selection import Playback, in_order

    if selection.quantity == "error":
        errors, use = _errors(found, markers, marker_distance, {}, [])
        found = replace(found, known_errors=np.where(use, errors, np.nan))
    playback = Playback(content.probe, in_order(found), selection.bandwidth)
    with Bar("drawing") as bar:
        write_film(out, playback, selection, FilmSettings(speed, last), monitor=shown(bar))


def _errors(
    found: Contacts, markers: Path | None, most: float, left_out: dict[str, int], notes: list[str]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the errors (n,), m, and which of them (n,) count: those of touches, or of settled samples at a marker."""
    import numpy as np

    from contactbench.pipeline.heatmap import HeatmapError
    from contactbench.pipeline.heatmap.contacts import read_points

    if found.known_errors is not None:
        if markers is not None:
            raise typer.BadParameter("--markers is not for a verification, which knows the touched markers.")
        return found.known_errors, np.ones(len(found.points), dtype=bool)
    if markers is None:
        raise typer.BadParameter(
            "--quantity error needs the touched points: give --markers, or a verification instead"
            " of the contacts."
        )
    errors, near = found.errors(read_points(markers), most / 1000)
    if found.settled is None:
        notes.append("The forces are unknown, so unsettled samples are counted too: give --wrenches.")
        steady = np.ones(len(near), dtype=bool)
    else:
        steady = found.settled
    _count(left_out, "not settled", ~steady)
    _count(left_out, f"farther than {most:g} mm from every marker", steady & ~near)
    if far := int((steady & ~near).sum()):
        notes.append(
            f"{far:,} of {int(steady.sum()):,} samples are farther than {most:g} mm from every"
            " marker and not in the map: they may be the worst. A verification knows which marker"
            " was touched."
        )
    if not (steady & near).any():
        raise HeatmapError(
            f"no settled sample is within {most:g} mm of a marker: check --markers (mm, sensor"
            " frame S), or give the file written by `contactbench verify touches`."
        )
    return errors, steady & near


def _count(left_out: dict[str, int], why: str, which: NDArray[np.bool_]) -> None:
    if count := int(which.sum()):
        left_out[why] = left_out.get(why, 0) + count


def _write_page(made: Heatmap, out: Path, left_out: dict[str, int], notes: list[str]) -> None:
    from contactbench.pipeline.calibration.files.calibration_file import creation_time
    from contactbench.pipeline.heatmap.page import heatmap_html
    from contactbench.pipeline.page import print_pdf

    page = heatmap_html(made, left_out, notes, created=creation_time())
    write_file(out, print_pdf(page) if out.suffix.lower() == ".pdf" else page.encode())


def _write(made: Heatmap, out: Path) -> None:
    from contactbench.pipeline.heatmap.files import encode_glb, encode_ply

    kind = out.suffix.lower()
    if kind == ".png":
        from contactbench.pipeline.heatmap.picture import encode_png

        data = encode_png(made)
    else:
        data = encode_glb(made) if kind == ".glb" else encode_ply(made)
    write_file(out, data)
