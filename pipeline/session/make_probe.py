"""How a session computes a probe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench.pipeline.calibration.parameters import Parameters, check_roles
from contactbench.pipeline.settings import ProbeSettings

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.pipeline.files import File

    Progress = Callable[[float], None] | None
    Cancel = Callable[[], bool] | None


class ProbeParameters(ProbeSettings, Parameters):
    """As the options of ``contactbench probe prepare``."""

    endings = (".ply",)


def probe(
    inputs: Mapping[str, File],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    progress: Progress = None,
    cancelled: Cancel = None,
    remember: bool = False,
) -> dict[str, bytes]:
    """
    Prepare a probe from ``mesh``: the bytes that ``contactbench probe prepare`` writes.

    ``alignment`` and ``regions`` may be left out. See `contactbench.pipeline.preparation.prepare.prepared`.
    """
    from contactbench.pipeline.mesh.sidecar import encode_probe_file
    from contactbench.pipeline.preparation.prepare import prepared

    check_roles(inputs, ("mesh",), ("alignment", "regions"))
    given = ProbeParameters.checked(parameters)
    done = prepared(inputs, given, progress=progress, cancelled=cancelled, remember=remember)
    return encode_probe_file(done.content, given.name)
