"""A calibration as one HTML page: what it is worth, what it says, and how that is known.

The page needs nothing beside itself: no script, no font, no other file. The same calibration gives the same
bytes.
"""

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from contactbench import __version__
from contactbench.pipeline.calibration.budget import BudgetSource, budget_table, calibration_budget
from contactbench.pipeline.calibration.calibrate import Calibration
from contactbench.pipeline.calibration.files.calibration_file import SourceFile
from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, FORCE_BIAS, GRAVITY, TORQUE_BIAS, UNKNOWN
from contactbench.pipeline.calibration.nuisance import DRIFT, NOISE, PLAIN, REZERO, taken_off
from contactbench.pipeline.calibration.observability import WEAK
from contactbench.pipeline.calibration.orientation import plain, signed, with_sigma
from contactbench.pipeline.calibration.payload import CAUTIONS, Payload
from contactbench.pipeline.calibration.poses import named
from contactbench.pipeline.calibration.suggest import describe
from contactbench.pipeline.calibration.verdict import FEWEST, Level, Limits, limit
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.page import moment, print_pdf, render
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.settings import RobotMaker

__all__ = ["report_html", "write_report"]

# A parameter known no better than this is shown as unknown: a tenth of what it could be if no pose said
# anything of it. 2 N, 2 N, 30 mm, 0.3 N·m.
_AS_GOOD_AS_UNKNOWN = 0.1 * UNKNOWN
# As large as a whole probe, m: a contact error that only says that something is undetermined.
_LOST = 0.05
# Noise of three axes is one number when they differ by no more than this.
_ALIKE = 1.1
# A direction of gravity that is less sure than this, rad, is none.
_ANY_TILT = 0.5

# Residuals fit to the noise that was given unless so few sets have larger ones, or smaller ones.
_FITS = 1e-3
# Causes that are less probable than this are not listed.
_HARDLY = 0.01
_HOUR = 3600.0

_UNKNOWN = "unknown"
_WORDS = {
    Level.GOOD: ("Good", "Use this calibration."),
    Level.USABLE: ("Usable", "You can work with this calibration; it could be better."),
    Level.REFUSE: ("Refused", "Do not use this calibration."),
}

# Whose controller, and where its line goes.
_MAKERS = {
    RobotMaker.UR: "Universal Robots (URScript)",
    RobotMaker.FRANKA: "Franka (SetLoad)",
    RobotMaker.KUKA: "KUKA ($config.dat)",
    RobotMaker.ABB: "ABB (RAPID)",
    RobotMaker.DOOSAN: "Doosan (tool weight)",
}


def write_report(
    calibration: Calibration,
    file: Path,
    *,
    title: str = "Gravity calibration",
    source: SourceFile | None = None,
    created: datetime | None = None,
    details: ReportDetails | None = None,
    payload: Payload | None = None,
) -> None:
    """Write a calibration's report as one HTML file that needs nothing beside itself, or as PDF.

    Parameters
    ----------
    file : path
        Appears as a whole; what was there stays until then. PDF if its name ends in ``.pdf``.
    title : str
        Heading of the page.
    source : SourceFile, optional
        The file of the poses, with its hash.
    created : datetime, optional
        When the calibration was made, with a time zone.
    details : ReportDetails, optional
        Who, and with which sensor.
    payload : Payload, optional
        What the robot carries: the lines that its controller takes.

    Raises
    ------
    InputError
        The file cannot be written, `created` has no time zone, or a PDF needs what is not installed.
    """
    page = report_html(
        calibration, title=title, source=source, created=created, details=details, payload=payload
    )
    write_file(file, print_pdf(page) if file.suffix.lower() == ".pdf" else page.encode())


def report_html(
    calibration: Calibration,
    *,
    title: str = "Gravity calibration",
    source: SourceFile | None = None,
    created: datetime | None = None,
    details: ReportDetails | None = None,
    payload: Payload | None = None,
) -> str:
    """Return a calibration's report as an HTML page; parameters and errors as `write_report`."""
    when = moment(created)
    # It takes a while to import, and most runs write no report.
    from contactbench.pipeline.calibration.report.figures import CROWDED, EMPTY, STEEPEST, draw

    live, live_words = live_noise(calibration)
    lost = calibration.contact_error > _LOST
    figures = draw(calibration, None if lost else live, live_words)
    level = calibration.verdict.level
    return render(
        __package__,
        title=title,
        created=when,
        source=source,
        tool=f"contactbench {__version__}",
        level=level.value,
        word=_WORDS[level][0],
        meaning=_WORDS[level][1],
        reasons=calibration.verdict.reasons,
        details=(details or ReportDetails()).table(created, _about(calibration, source, when)),
        tiles=_tiles(calibration),
        budget=None if lost else budget_table(calibration_budget(calibration), _NO_PART),
        usable=f"{1e3 * Limits().usable_error:g}",
        shares=_shares(calibration),
        parameters=_parameters(calibration),
        down=_down(calibration),
        some_unknown=bool(_unknown(calibration).any()),
        poses=_poses(calibration),
        rejected=calibration.rejected,
        total=len(calibration.poses),
        crowded=len(calibration.poses) > CROWDED,
        used=int(calibration.kept.sum()),
        beyond=bool(calibration.deviates.max() > 2 * limit(len(calibration.poses))),
        residual_words=_residual_words(calibration),
        causes=_causes(calibration),
        drawn_beside={DRIFT: "the drift", REZERO: "the re-zero"}.get(taken_off(calibration.offsets), ""),
        sight=calibration.observability,
        condition=plain(calibration.condition) if np.isfinite(calibration.condition) else "",
        weak_from=f"{WEAK:g}",
        noise=_noise(calibration),
        live=live_words,
        figures=figures,
        empty=f"{EMPTY:g}",
        steepest=STEEPEST,
        payload=None if payload is None else _payload(calibration, payload),
    )


def unusable(calibration: Calibration, payload: Payload) -> str:
    """Return why there is no payload for a robot; empty: there is one."""
    if calibration.verdict.level is Level.REFUSE:
        return "No payload for the robot: the calibration is refused."
    if not payload.is_known:
        return "No payload for the robot: it is too unsure; calibrate with poses that tilt farther."
    return ""


def _payload(calibration: Calibration, payload: Payload) -> dict[str, Any]:
    """Return what the page says of the robot's payload."""
    if why := unusable(calibration, payload):
        return {"why": why}
    mass = with_sigma(payload.mass, payload.mass_sigma)
    pairs = zip((1e3 * payload.centre_E).tolist(), (1e3 * payload.centre_sigma_E).tolist(), strict=True)
    return {
        "why": "",
        "mass": f"{mass[0]} ± {mass[1]} kg",
        "centre": ", ".join(
            f"{axis} {' ± '.join(with_sigma(*pair))}" for axis, pair in zip("xyz", pairs, strict=True)
        ),
        "lines": [(name, payload.text(maker), CAUTIONS.get(maker, "")) for maker, name in _MAKERS.items()],
    }


_NO_PART = {BudgetSource.MOUNT: "taken as exact", BudgetSource.MODEL: "none found"}


def _about(calibration: Calibration, source: SourceFile | None, when: str | None) -> list[tuple[str, str]]:
    """Return what the head of the page says of the measurement."""
    sigma = with_sigma(calibration.mass, calibration.model.mass_sigma)
    known = not _unknown(calibration)[GRAVITY].any()
    return [
        ("Date", when or ""),
        ("Poses", f"{int(calibration.kept.sum())} used of {len(calibration.poses)}"),
        ("Mass of the load", f"{sigma[0]} ± {sigma[1]} kg" if known else _UNKNOWN),
        ("Poses from", "" if source is None else source.name),
        ("Software", f"contactbench {__version__}"),
    ]


def _tiles(calibration: Calibration) -> list[tuple[str, str, bool]]:
    """Return the main numbers: what, in words, and whether it is beyond its limit."""
    limits, shares = Limits(), _shares(calibration)
    words = "What this calibration adds to the error of a contact: "
    words += (
        f"more than {shares['lost']} mm, which is no number to work with."
        if shares["lost"]
        else f"1 sigma, worst case; {1e3 * limits.good_error:g} mm is good, over {1e3 * limits.usable_error:g} mm is"
        " refused."
    )
    if shares["model"]:
        words += f" {shares['model']} of that is what the model leaves out: see the explanations below."
    found = [(str(shares["share"]), words, calibration.contact_error > limits.usable_error)]
    if shares["single"]:
        words = f"What the noise of a single sample ({shares['single']} per axis) adds: a contact located from one."
        found.append((str(shares["single_error"]), words, False))
    words = (
        f"What the noise of a pose's mean ({shares['mean']} per axis) adds: a contact located from a reading averaged"
        " as long as a pose."
    )
    return [*found, (str(shares["mean_error"]), words, False)]


# ---- numbers -----------------------------------------------------------------------------------


def _length(error: float) -> str:
    """Return a contact error, given in m, as the page says it."""
    return _UNKNOWN if error > _LOST else f"{plain(1e3 * error)} mm"


def _sizes(sigmas: NDArray[np.float64]) -> str:
    """Say how large a noise of sigmas (6,) is: one number where the axes are alike."""
    parts = []
    for part, unit in ((sigmas[:3], "N"), (1e3 * sigmas[3:], "mN·m")):
        if part.max() <= _ALIKE * part.min():
            parts.append(f"{plain(float(part.mean()))} {unit}")
        else:
            parts.append(f"{' / '.join(map(plain, part.tolist()))} {unit} (x / y / z)")
    return " and ".join(parts)


# ---- verdict -----------------------------------------------------------------------------------


def sample_noise(calibration: Calibration) -> NDArray[np.float64] | None:
    """Return how much single samples scatter (6,), N and N·m: the median over the poses that tell."""
    known = [
        np.concatenate([pose.force_sd, pose.torque_sd])
        for pose in calibration.poses
        if pose.force_sd is not None and pose.torque_sd is not None and pose.count > 1
    ]
    return np.median(known, axis=0) if known else None


def live_noise(calibration: Calibration) -> tuple[NDArray[np.float64], str]:
    """Return the noise (6,) to expect in a wrench that is to be located, N and N·m, and what it is.

    A pose's mean is averaged over seconds; a contact is mostly located from one sample. Where the poses do
    not tell how much single samples scatter, there is only the noise of the mean.
    """
    single = sample_noise(calibration)
    if single is None:
        return calibration.noise.sigmas, "noise of a pose's mean"
    return single, "noise of a single sample"


def _shares(calibration: Calibration) -> dict[str, Any]:
    """Return the one number, what the sensor's own noise does, and for which touches."""
    task, mean, single = calibration.task, calibration.noise.sigmas, sample_noise(calibration)
    mapped = task.calibration_error(calibration.model.vector, calibration.covariance)
    return {
        "share": _length(calibration.contact_error),
        "lost": f"{1e3 * _LOST:g}" if calibration.contact_error > _LOST else "",
        "mean": _sizes(mean),
        "mean_error": _length(task.sensor_error(mean)),
        "single": "" if single is None else _sizes(single),
        "single_error": "" if single is None else _length(task.sensor_error(single)),
        "force": f"{task.force:g}",
        "point": ", ".join(signed(f"{1e3 * value:.0f}") for value in task.point),
        "friction": round(float(np.degrees(task.friction))),
        "tilt": round(float(np.degrees(task.tilt))),
        "model": _length(calibration.model_error) if calibration.model_error else "",
        # Not so where the mounting was estimated too, or the model leaves something out: the number holds that as well.
        "mapped": bool(np.isclose(mapped, calibration.contact_error, rtol=0.01)),
    }


# ---- parameters --------------------------------------------------------------------------------


def _unknown(calibration: Calibration) -> NDArray[np.bool_]:
    """Tell which of the twelve parameters the poses say next to nothing of."""
    return np.sqrt(np.diag(calibration.covariance)) >= _AS_GOOD_AS_UNKNOWN


def _parameters(calibration: Calibration) -> list[dict[str, Any]]:
    """Return the rows of the table: what, the frame, cells of value and sigma, the unit."""
    model, blind = calibration.model, _unknown(calibration)
    weightless = bool(blind[GRAVITY].any())
    mass = None if weightless else (model.mass, model.mass_sigma)
    tilt = None if weightless else tilt_of(calibration)
    if tilt and tilt[1] > _ANY_TILT:
        tilt = None
    then = " at the end of the session" if taken_off(calibration.offsets) else ""
    rows = [
        _row("Mass of the load", "", [mass], "kg"),
        _row("", "", [mass], "g", 1e3),
        _vector(calibration, "Gravity vector (weight)", "W", GRAVITY, "N"),
        _row("Tilt from the vertical", "W", [tilt], "°", float(np.degrees(1.0))),
        _vector(calibration, f"Force bias{then}", "S", FORCE_BIAS, "N"),
        _vector(calibration, "Centre of mass", "S", CENTRE_OF_MASS, "mm", 1e3),
        _vector(calibration, f"Torque bias{then}", "S", TORQUE_BIAS, "mN·m", 1e3),
        _vector(calibration, "", "S", TORQUE_BIAS, "N·m"),
        *_drift(calibration),
    ]
    return [row for row in rows if row["name"] or any(row["cells"])]  # "unknown" is not said twice


def _drift(calibration: Calibration) -> list[dict[str, Any]]:
    """Return the rows of a drift per hour; none where no drift was found, or the poses have no times."""
    rate, sigma = calibration.drift_rate, calibration.drift_rate_sigma
    if rate is None or sigma is None:
        return []
    pairs = list(zip(rate.tolist(), sigma.tolist(), strict=True))
    return [
        _row("Drift of the force bias", "S", pairs[:3], "N/h", _HOUR),
        _row("Drift of the torque bias", "S", pairs[3:], "mN·m/h", 1e3 * _HOUR),
    ]


def _vector(
    calibration: Calibration, name: str, frame: str, part: slice, unit: str, scale: float = 1.0
) -> dict[str, Any]:
    values, sigmas = calibration.model.vector[part], np.sqrt(np.diag(calibration.covariance)[part])
    rows = zip(values.tolist(), sigmas.tolist(), _unknown(calibration)[part].tolist(), strict=True)
    cells = [None if blind else (value, sigma) for value, sigma, blind in rows]
    return _row(name, frame, cells, unit, scale)


def _row(
    name: str, frame: str, cells: Sequence[tuple[float, float] | None], unit: str, scale: float = 1.0
) -> dict[str, Any]:
    shown = [None if cell is None else with_sigma(scale * cell[0], scale * cell[1]) for cell in cells]
    return {"name": name, "frame": frame, "cells": shown, "unit": unit}


def tilt_of(calibration: Calibration) -> tuple[float, float]:
    """Return the angle between gravity and where it was said to point, and its standard deviation, rad."""
    g, down = calibration.gravity_W, calibration.down_W
    along = float(g @ down)
    sideways = g - along * down
    across = float(np.linalg.norm(sideways))
    square = along * along + across * across
    C = calibration.covariance[GRAVITY, GRAVITY]
    if across * across > 1e-12 * square:
        gradient = (along * sideways / across - across * down) / square
        variance = float(gradient @ C @ gradient)
    else:  # upright to a millionth: every direction is the direction of the tilt
        level = np.linalg.svd(down[None])[2][1:]
        variance = float(np.linalg.eigvalsh(level @ C @ level.T)[-1]) / square if square else 0.0
    return float(np.arctan2(across, along)), float(np.sqrt(variance))


def _down(calibration: Calibration) -> str:
    """Return where gravity was said to point, if that is not down along z."""
    if np.allclose(calibration.down_W, [0, 0, -1]):
        return ""
    return ", ".join(signed(f"{value:.3g}") for value in calibration.down_W.tolist())


# ---- poses -------------------------------------------------------------------------------------


def _poses(calibration: Calibration) -> list[dict[str, Any]]:
    why = {rejection.index: rejection.reason for rejection in calibration.rejected}
    allowed = limit(len(calibration.poses))
    force, torque = (np.linalg.norm(half, axis=1) for half in np.split(calibration.residuals, 2, axis=1))
    noise = calibration.noise.sigmas
    return [
        {
            "number": index + 1,
            "name": named(calibration.poses, index),
            "stands": describe(pose.R_WS, calibration.down_W),
            "force": with_sigma(force[index], noise[0])[0],
            "torque": with_sigma(1e3 * torque[index], 1e3 * noise[3])[0],
            "deviates": [
                (f"{value:.{int(value < 9.95)}f}", value >= allowed and len(force) >= FEWEST)
                for value in calibration.deviates[index].tolist()
            ],
            "why": why.get(index),
        }
        for index, pose in enumerate(calibration.poses)
    ]


def _residual_words(calibration: Calibration) -> list[str]:
    n, out = len(calibration.poses), len(calibration.rejected)
    if n < FEWEST:
        return [f"With {n} poses none can be checked against the others, and the deviates say little."]
    far = int((calibration.deviates[calibration.kept].max(axis=1) >= limit(n)).sum())
    words = [f"{_of(out, n)} left out."] if out else []
    if far:
        why = "chance explains that nearly as well as a touch"
        if calibration.verdict.level is Level.REFUSE:
            why = "the poses contradict one another too much to say which are right"
        words.append(f"{_of(far, n)} used although beyond the limit: {why}.")
    else:
        words.append(_agreement(calibration, "the others" if out else f"all {n} poses"))
    words.append(
        f"The limit is {limit(n):.1f} sigma: the worst of {n} undisturbed poses passes it once in a hundred sets."
    )
    return words


def _agreement(calibration: Calibration, them: str) -> str:
    """Say whether the poses that were used fit together, which needs more than that none of them stands out."""
    without = {DRIFT: "With the drift", REZERO: "With the re-zero"}.get(taken_off(calibration.offsets))
    if without:
        return f"{without} taken off, {them} agree with one another."
    if calibration.causes[0].key not in {PLAIN, NOISE}:
        return "No pose stands out, but together they do not fit the model: see what may explain it below."
    if max(calibration.noise_factor) > 1:
        return "No pose stands out, but together the poses scatter more than the noise that was given."
    return f"{them[0].upper()}{them[1:]} agree with one another."


def _causes(calibration: Calibration) -> list[dict[str, str]]:
    """Return what may explain the residuals, the most probable first."""
    return [
        {"odds": _percent(cause.odds), "sentence": cause.sentence}
        for cause in calibration.causes
        if cause.odds >= _HARDLY
    ]


def _percent(probability: float) -> str:
    return "over 99 %" if probability > 0.99 else f"{100 * probability:.0f} %"


def _of(some: int, all_of_them: int) -> str:
    return f"{some} of {all_of_them} poses {'is' if some == 1 else 'are'}"


# ---- noise -------------------------------------------------------------------------------------


def _noise(calibration: Calibration) -> dict[str, Any]:
    """Return where the noise comes from, and whether the residuals fit to it."""
    noise, factors = calibration.noise, calibration.noise_factor
    estimated = noise.freedom if np.isfinite(noise.freedom).all() else ()
    return {
        "orientation": plain(float(np.degrees(noise.orientation))) if noise.orientation else "",
        "given": "" if calibration.plausible else _sizes(noise.sigmas / np.repeat(factors, 3)),
        "factors": [plain(factor) for factor in factors],
        "estimated": noise.estimated,
        "freedom": [f"{freedom:.0f}" for freedom in estimated],
        "percent": [f"{100 / np.sqrt(2 * freedom):.0f}" for freedom in noise.freedom],
        "least": bool((np.isclose(noise.sigmas, noise.least) & (noise.least > 0)).any()),
        "chance": _chance(calibration),
    }


def _chance(calibration: Calibration) -> str:
    """Say how large the residuals are beside the noise that was given."""
    freedom = max(6 * int(calibration.kept.sum()) - calibration.rank, 1)
    square = calibration.scatter * freedom
    chance = float(chdtrc(freedom, square))
    odds = "fewer than 1" if chance < 0.01 else "more than 99" if chance > 0.99 else f"{100 * chance:.0f}"
    return (
        f"The residuals are {plain(float(np.sqrt(calibration.scatter)))} times as large as that explains (chi-square"
        f" {square:.0f} at {freedom:.0f} degrees of freedom); chance alone gives as much in {odds} of 100"
        f" undisturbed sets.{' That fits.' if _FITS < chance < 1 - _FITS else ''}"
    )
