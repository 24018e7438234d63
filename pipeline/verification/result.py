"""A verification from files: what the command and a session share, so that both write the same bytes."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Annotated, Any

from pydantic import Field

from contactbench.pipeline.calibration.orientation import convention_of
from contactbench.pipeline.calibration.parameters import Parameters, check_roles, sha256_of
from contactbench.pipeline.errors import ALIGN, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.knobs import Positive
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.settings import VerificationSettings
from contactbench.pipeline.verification.figures import Times, Verification, VerificationLimits
from contactbench.pipeline.verification.markers import load_markers
from contactbench.pipeline.verification.protocol import ProtocolSettings
from contactbench.pipeline.verification.source import read_reference, read_touch_recording
from contactbench.pipeline.verification.verify import VerifySettings, verify

ROLES = ("probe", "calibration", "markers", "recording")
REFERENCE = "reference"
_TOUCH_N, _RELEASE_N = 2.0, 1.0

_Words = Annotated[str, Field(min_length=1, max_length=200)]


class VerificationParameters(VerificationSettings, Parameters):
    """
    As the options of ``contactbench verify touches``; lengths in mm, angles in degrees, times in s.

    ``times`` are figures of solves measured before: (count, median, p99). They are given, not measured here, because
    the same parameters must give the same bytes. Forces at which a touch begins and ends: 2 and 1 N if left out, less
    for windows below. ``left_out`` has markers that need not be touched, each with why.
    """

    windows: Annotated[tuple[tuple[Positive, Positive], ...], Field(max_length=100)] = ((8.0, 10.0),)
    order: Annotated[tuple[str, ...], Field(max_length=10_000)] = ()
    p99_limit_s: Positive = 0.001
    resamples: int = 2000
    times: tuple[int, Positive, Positive] | None = None
    left_out: dict[_Words, _Words] = Field(default_factory=dict, max_length=10_000)

    def settings(self) -> VerifySettings:
        """Return them as the settings of a verification; InputError if one is out of its range."""
        # A window below the usual 2 N is for a light hand: its touches then begin and end below it.
        lowest = min((low for low, _ in self.windows), default=_TOUCH_N)
        touch = self.touch_force or (_TOUCH_N if lowest > _TOUCH_N else 0.8 * lowest)
        release = self.release_force or min(_RELEASE_N, 0.5 * touch)
        protocol = ProtocolSettings(
            self.windows, self.samples, self.repeats, touch, release, order=self.order
        )
        limits = VerificationLimits(self.mean_limit_mm / 1e3, self.max_limit_mm / 1e3, self.p99_limit_s)
        return VerifySettings(
            protocol,
            limits,
            self.noise_force,
            self.noise_torque,
            self.resamples,
            self.seed,
            self.mount,
            dict(sorted(self.left_out.items())),
            self.follow,
        )


def verification(
    inputs: Mapping[str, File], parameters: Mapping[str, Any], _created: str | None
) -> dict[str, bytes]:
    """
    Verify ``recording`` with ``probe``, ``calibration`` and ``markers``; ``reference`` may be left out.

    Returns
    -------
    dict of str to bytes
        The file ``name``; the same for the same inputs and parameters.

    Raises
    ------
    InputError
        An input or a parameter cannot be used.
    """
    given = VerificationParameters.checked(parameters)
    return {given.name: verify_files(inputs, given).to_bytes()}


def verify_files(
    inputs: Mapping[str, File], given: VerificationParameters, *, timed: bool = False
) -> Verification:
    """
    Read the inputs and verify.

    Parameters
    ----------
    inputs : mapping of role to path
    given : VerificationParameters
    timed : bool
        Measure the times of solves here.

    Raises
    ------
    InputError
        An input is missing or cannot be used.
    """
    from contactbench.pipeline.calibration import Level
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration

    check_roles(inputs, ROLES, (REFERENCE,))
    settings, R_ES = given.settings(), given.R_ES
    markers = load_markers(inputs["markers"])
    calibration = load_calibration(inputs["calibration"])
    probe, said, aligned, deviation = _load_probe(inputs["probe"])
    faults = []
    if not aligned:
        faults.append(message(f"the probe was never aligned with the sensor: {arg(ALIGN)}"))
    if calibration.verdict.level is Level.REFUSE:
        faults.append(message("the calibration was refused: recalibrate"))
    recording = read_touch_recording(inputs["recording"], convention_of(given), R_ES)
    return verify(
        probe,
        calibration.model,
        markers,
        replace(recording, warnings=(*said, *recording.warnings)),
        settings,
        reference=read_reference(inputs[REFERENCE]) if REFERENCE in inputs else None,
        times=None if given.times is None else Times(*given.times),
        timed=timed,
        sources={role: sha256_of(path) for role, path in inputs.items()},
        faults=tuple(faults),
        mesh_deviation=deviation,
    )


def load_surface(file: File) -> Probe:
    """
    Load a probe, in the unit that its file says, or that its size suggests.

    Raises
    ------
    MeshError
        It cannot be used.
    """
    return _load_probe(file)[0]


def _load_probe(file: File) -> tuple[Probe, list[str], bool, float | None]:
    from contactbench.pipeline.config.runtime import ConfigError
    from contactbench.pipeline.config.runtime.bench import mesh_deviation
    from contactbench.pipeline.mesh.load import probe_of, read_mesh
    from contactbench.pipeline.mesh.sidecar import load_probe_file

    read, aligned, deviation = read_mesh(file), True, None
    probe = probe_of(file, read)
    said = [*read.notes, *probe.health.sentences]
    if read.guess is not None and not read.guess.certain:
        said.append(
            message("run `contactbench probe prepare --units` to make a probe with a confirmed unit.")
        )
    if read.raw.settled:
        known = load_probe_file(file)
        said += known.notes
        aligned = not known.history or known.frame == "S"
        with suppress(ConfigError):  # its history does not say
            deviation = mesh_deviation(known) if known.history else None
    return probe, said, aligned, deviation
