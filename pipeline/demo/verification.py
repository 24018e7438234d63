"""The demo's last step: markers that were pressed become a verification, its report, and a bundle that locates them."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from contactbench.pipeline.calibration.files.calibration_file import creation_time
from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig, UnverifiedError
from contactbench.pipeline.config.runtime.bench import export_from_files
from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.config.runtime.pack import KNOWN
from contactbench.pipeline.control.settings import ControlSettings, Foundation, controller_of
from contactbench.pipeline.demo.tape import OPERATOR, RATE_HZ, SENSOR_MODEL, DemoTool
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.recording.replay import Replay
from contactbench.pipeline.report.report_file import report
from contactbench.pipeline.runtime import Answer, Run, RunError
from contactbench.pipeline.runtime.run import check_runnable
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.verification import Marker, MarkerError, MarkerSet, Verification
from contactbench.pipeline.verification.result import VerificationParameters, verify_files

BUNDLE = "runtime"
WRITTEN = ("markers.csv", "verification.json", "report.html", "contacts.jsonl")

# Touches are pressed with 8 to 10 N: noise and what the calibration leaves must not put one out of the window.
WINDOW_N = (7.5, 10.5)
# Half a second is recorded once the tip rests: a tenth to see that, a quarter taken.
SAMPLES = 50
_AT_ONCE = 1_000
# The runtime's point is of filtered readings, the verification's of averaged ones: they differ by less than either
# may be off, and another frame, sign or mesh by many times that.
_APART = 1.0


@dataclass(frozen=True)
class CheckResult:
    """The verification of one probe, and its bundle."""

    # markers, touches: markers with an accepted touch, and accepted touches
    markers: int
    touches: int
    rejected: tuple[str, ...]  # touches that were not accepted, each with the reason
    # mean_mm, max_mm: errors of accepted touches; None: there is none
    mean_mm: float | None
    max_mm: float | None
    failed: tuple[str, ...]  # why the verification failed; empty if it passed
    # why the bundle was not exported or may not be run; None: it is sound and verified, or was not tried
    refused: str | None
    # samples, located: readings that went through the bundle, and those with a contact that is sure
    samples: int = 0
    located: int = 0
    # accepted touches for which the bundle had a sure contact at the moment of their decision
    compared: int = 0
    # apart_mm, sigma_mm: how far these contacts are from the verification's, on average, and how far the
    # bundle says it may be off
    apart_mm: float | None = None
    sigma_mm: float | None = None

    @property
    def agrees(self) -> bool:
        """Whether the bundle located most of the touches, where the verification has them."""
        if self.apart_mm is None or self.sigma_mm is None:
            return False
        return 2 * self.compared > self.touches and self.apart_mm <= _APART * self.sigma_mm

    @property
    def verified(self) -> bool:
        """Whether verification and bundle are as they should be."""
        return not self.failed and self.refused is None and self.agrees

    def sentence(self, probe: str) -> str:
        """Say it in words."""
        return f"{probe}: {self._judged()}; {self._run()}."

    def _judged(self) -> str:
        listed = f"; rejected: {', '.join(self.rejected)}" if self.rejected else ""
        size = "" if self.mean_mm is None else f": mean {self.mean_mm:.2f} mm, max {self.max_mm:.2f} mm"
        on = f"{self.markers} markers{size}"
        if self.failed:
            return f"verification FAILED on {on}: {'; '.join(self.failed)}{listed}"
        return f"verified on {on}, passed ({self.touches} touches{listed})"

    def _run(self) -> str:
        if self.failed:
            return "no bundle was made"
        if self.refused is not None:
            return f"FAILED, the bundle was refused: {self.refused.rstrip('.')}"
        found = f"the bundle is intact; it located {self.located:,} of {self.samples:,} samples"
        if self.apart_mm is None or self.sigma_mm is None:
            return f"{found}, FAILED: none of the touches"
        apart = f"on average {self.apart_mm:.2f} mm from the verified points, with {self.sigma_mm:.2f} mm expected"
        if self.agrees:
            return f"{found}, {apart}"
        return f"{found}, {self.compared} of {self.touches} touches, {apart}, FAILED: they do not agree"


def clear(folder: Path) -> None:
    """
    Remove what `check` wrote before: it would not belong to the files that are made now.

    Raises
    ------
    InputError
        Something cannot be removed.
    """
    bundle = folder / BUNDLE
    try:
        for file in (*(folder / name for name in WRITTEN), *(bundle / name for name in KNOWN)):
            if file.parent.is_dir():
                file.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(
            f"{error.filename}: it cannot be removed ({error}): choose another folder."
        ) from error


def check(folder: Path, name: str, tool: DemoTool) -> CheckResult:
    """
    Verify the touches of markers, report on them, export a bundle, load it, and run the same touches through it.

    Takes touches.mcap, calibration.json and probe.ply, as ``contactbench verify touches``, ``verify report``,
    ``bundle export`` and ``run`` would. Writes markers.csv, verification.json, report.html, the bundle runtime/ and
    contacts.jsonl. The time of day is in report.html and, as ``provenance.created``, in runtime/contactbench.json, and
    so in their hashes; all else is the same for the same seed, and these too where SOURCE_DATE_EPOCH is set.

    Parameters
    ----------
    name : str
        One of assets.PROBE_NAMES.

    Raises
    ------
    InputError
        A file cannot be read or written.
    """
    clear(folder)
    try:
        found = verify(folder, markers(name))
    except MarkerError as error:  # the mesh is somewhere else: that is a finding too
        return CheckResult(0, 0, (), None, None, (str(error).rstrip("."),), None)
    # One time for report and bundle.
    created = creation_time()
    made = {role: folder / file for role, file in _INPUTS.items() if role in ("probe", "calibration")}
    inputs = {"verification": folder / "verification.json", **made}
    page = report(
        inputs, {"name": "report.html", "operator": OPERATOR, "sensor": SENSOR_MODEL}, created.isoformat()
    )
    write_file(folder / "report.html", page["report.html"])
    judged = _judged(found)
    if judged.failed:
        return judged
    try:
        exported = export_from_files(
            made["calibration"], made["probe"], inputs["verification"], folder / "report.html",
            export_settings(tool, made["probe"]), created=created,
        )  # fmt: skip
    except UnverifiedError as error:
        return replace(judged, refused=" ".join(error.reasons))
    exported.write(folder / BUNDLE)
    try:
        config = RuntimeConfig.load(folder / BUNDLE)
        check_runnable(config)
    except (ConfigError, RunError) as error:
        return replace(judged, refused=str(error))
    return _through(config, folder, found, judged)


_INPUTS = {
    "recording": "touches.mcap",
    "probe": "probe.ply",
    "calibration": "calibration.json",
    "markers": "markers.csv",
}


def write_markers(folder: Path, places: Floats) -> None:
    """Write markers.csv, the points (n, 3) that are pressed, S, m, named as in truth.csv."""
    unknown = np.full(3, np.nan)
    rows = tuple(Marker(str(number), point, unknown) for number, point in enumerate(places, 1))
    write_file(folder / "markers.csv", MarkerSet(rows).to_bytes())


def verify(folder: Path, places: Floats, *, follow: bool = False) -> Verification:
    """Verify touches.mcap by the markers at those places (n, 3), S, m; write markers.csv and verification.json."""
    write_markers(folder, places)
    given = VerificationParameters(
        name="verification.json", windows=(WINDOW_N,), samples=SAMPLES, follow=follow
    )
    found = verify_files({role: folder / file for role, file in _INPUTS.items()}, given)
    write_file(folder / given.name, found.to_bytes())
    return found


def _judged(found: Verification) -> CheckResult:
    overall = found.overall
    return CheckResult(
        len(found.per_marker),
        sum(touch.accepted for touch in found.touches),
        tuple(f"touch {touch.number} ({touch.reason})" for touch in found.touches if not touch.accepted),
        None if overall is None else overall.mean_mm,
        None if overall is None else overall.max_mm,
        found.verdict.reasons,
        None,
    )


def export_settings(tool: DemoTool, probe: Path) -> ExportOptions:
    """Return how a bundle of the tool is exported."""
    usual = ControlSettings.for_probe(Foundation(load_probe_file(probe).probe))
    fx, fy, fz, mx, my, mz = tool.settings.limit.tolist()
    return ExportOptions(
        sensor=SENSOR_MODEL,
        rate=RATE_HZ,
        saturation=(fx, fy, fz, mx, my, mz),
        controller=controller_of(usual),
        operator=OPERATOR,
        mount=(0.0, 0.0, 0.0),
    ).having({}, noise=tool.noise())


# ---- the bundle at work ------------------------------------------------------------------------


def _through(config: RuntimeConfig, folder: Path, found: Verification, judged: CheckResult) -> CheckResult:
    """Run the touches through the bundle, and compare its contacts with those that were verified."""
    answers = answers_of(config, folder / "touches.mcap")
    write_file(folder / "contacts.jsonl", b"".join(answer.line for answer in answers))
    sure = [answer for answer in answers if answer.contact is not None and answer.contact.accepted]
    judged = replace(judged, samples=len(answers), located=len(sure))
    at = {round(answer.time * RATE_HZ): answer for answer in sure}
    apart, sigmas = [], []
    for touch in found.touches:
        answer = at.get(round(touch.time_s * RATE_HZ))
        if not touch.accepted or touch.point_mm is None or answer is None or answer.contact is None:
            continue
        point, covariance = answer.contact.point, answer.contact.covariance
        if point is not None and covariance is not None:
            apart.append(float(np.linalg.norm(1e3 * point - touch.point_mm)))
            sigmas.append(1e3 * float(np.sqrt(np.trace(covariance))))
    if not apart:
        return judged
    return replace(
        judged, compared=len(apart), apart_mm=float(np.mean(apart)), sigma_mm=float(np.mean(sigmas))
    )


def answers_of(config: RuntimeConfig, recording: Path) -> list[Answer]:
    """Return what a bundle says of each sample of a recording."""
    answers: list[Answer] = []

    def keep(_: WrenchSample, answer: Answer) -> None:
        answers.append(answer)

    with Run(config, on_answer=keep) as run, Replay(recording, run.wrenches, run.poses) as replay:
        while replay.step(_AT_ONCE):
            pass
    if replay.error is not None:
        raise replay.error
    return answers
