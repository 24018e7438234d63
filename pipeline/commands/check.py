"""``contactbench calibrate check ...``: a known weight and a known point, before contacts are trusted."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from contactbench.pipeline.commands.options import CalibrationOption, ProbeOption, refuse_overwriting, written
from contactbench.pipeline.console import Noun, answer, say, warn
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.settings import TouchSettings, WeightSettings

_STYLES = {"passed": "green", "undecided": "yellow", "failed": "red"}

check_app = Noun(
    "Check a calibration on still poses, a known weight and a known point, for errors that its"
    " residuals cannot show."
)

OutOption = Annotated[
    Path | None,
    typer.Option(help="Also write the result to this file, JSON, for bundle export and a session."),
]


@check_app.command(
    example=(
        "calibrate check weight --calibration calibration.json --unloaded empty.csv --loaded hung.csv --mass 1.0 "
        "--mass-sigma 0.0005 --certificate DKD-1234 --out known_weight.json"
    )
)
def weight(
    calibration: CalibrationOption, unloaded: Path, loaded: Path, said: WeightSettings, out: OutOption = None
) -> None:
    """Hang a known weight on the tool, and compare it with the sensor's readings.

    UNLOADED and LOADED are still readings without and with the weight: recordings, or tables of poses
    as for calibrate fit. Take both in the same orientation; more orientations test more channels. This finds
    forces in kgf, lbf or mN, a wrong scale or sign, swapped channels, and torques in N·mm.

    Exit code 1: the weight is wrong, or the uncertainty is too large to decide.

    Parameters
    ----------
    unloaded
        Readings without the weight: .csv or .mcap.
    loaded
        Readings with the weight: .csv or .mcap.
    """
    inputs = {"calibration": calibration, "unloaded": unloaded, "loaded": loaded}
    refuse_overwriting(out, list(inputs.values()))
    written(said)
    from contactbench.pipeline.verification.known_weight import WeightParameters, weight_content

    name = "known_weight.json" if out is None else out.name
    given = WeightParameters.checked({**said.model_dump(), "name": name})
    _finish(weight_content(inputs, given, _now()), out)


@check_app.command(
    example=(
        "calibrate check touch --probe probe.ply --calibration calibration.json --point 20,0,185 press.mcap --out "
        "known_touch.json"
    )
)
def touch(
    recording: Path,
    /,
    probe: ProbeOption,
    calibration: CalibrationOption,
    said: TouchSettings,
    point: tuple[float, float, float] | None = None,
    markers: Path | None = None,
    marker: str | None = None,
    out: OutOption = None,
) -> None:
    """Press one known point of the probe, and compare it with the located contact.

    RECORDING is an .mcap file with one sensor and one robot, or a CSV file with t,fx,fy,fz,mx,my,mz (raw
    readings) and orientations; every steady press in it must be on this point. Press with a finger,
    5 to 15 N, on the side of the probe, 15 mm or more off the sensor's axis. This finds torques of the
    wrong sign or unit, forces in kgf, and a probe that is turned on the sensor.

    Exit code 1: the contact is elsewhere, or the press is inconclusive.

    Parameters
    ----------
    recording
        The press: .mcap or .csv.
    point : X,Y,Z
        Pressed point, mm in the sensor frame, as the probe's mesh.
    markers
        Instead: table of markers; give --marker too.
    marker : NAME
        Name of the pressed marker.
    """
    inputs = {"calibration": calibration, "probe": probe, "touch": recording}
    refuse_overwriting(out, list(inputs.values()))
    written(said)
    from contactbench.pipeline.verification.known_touch import TouchParameters, touch_content

    name = "known_touch.json" if out is None else out.name
    given = TouchParameters.checked(
        {**said.model_dump(), "name": name, "point": _point(point, markers, marker)}
    )
    _finish(touch_content(inputs, given, _now()), out)


def _point(point: Sequence[float] | None, markers: Path | None, marker: str | None) -> list[float]:
    if (markers is None) != (marker is None) or (point is None) == (marker is None):
        raise typer.BadParameter(
            "give the pressed point: --point X,Y,Z, or --markers FILE with --marker NAME."
        )
    if point is not None:
        return list(point)
    from contactbench.pipeline.verification import load_markers

    assert markers is not None  # noqa: S101 - for the type checker; seen to above
    known = load_markers(markers)
    if marker not in known.names:
        known_names = ", ".join(known.names[:20])
        raise typer.BadParameter(f"{markers}: there is no marker {marker}; the file has {known_names}.")
    found: list[float] = (1e3 * known[known.names.index(marker)].point_S).tolist()
    return found


def _now() -> str:
    from contactbench.pipeline.calibration.files.calibration_file import creation_time

    return creation_time().strftime("%Y-%m-%dT%H:%M:%SZ")


def _finish(content: Mapping[str, Any], out: Path | None) -> None:
    """Write, show, and end with the exit code."""
    from contactbench.pipeline.verification.known_check import to_bytes

    if out is not None:
        write_file(out, to_bytes(content))
    warn(content["warnings"])
    say(f"{content['outcome'].upper()}: {content['sentence']}", _STYLES[content["outcome"]])
    answer({**content, "out": None if out is None else str(out)}, good=content["passed"])
