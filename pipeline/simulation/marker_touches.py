"""The bundled probes as they really are, and as contacts are located on them."""

from collections.abc import Iterable
from functools import cache

from contactbench import assets
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.scenes.physics import TrueSurface

TRUE_FACETS = 20_000


@cache
def truth_of(name: str) -> TrueSurface:
    """Return a bundled probe as it really is."""
    return TrueSurface(Probe.from_arrays(*assets.make(name, TRUE_FACETS), name=name))


def check_bundled(names: Iterable[str]) -> list[str]:
    """
    Return names of bundled probes, each once.

    Raises
    ------
    InputError
        One of them is none of assets.PROBE_NAMES, or there is no name.
    """
    found = list(dict.fromkeys(names))
    unknown = [name for name in found if name not in assets.PROBE_NAMES]
    if unknown or not found:
        raise InputError(
            f"there is no probe {arg(', '.join(unknown))!r}: choose one of {arg(', '.join(assets.PROBE_NAMES))}."
        )
    return found


@cache
def model_of(name: str, facets: int) -> Probe:
    """Return the probe's mesh that is located on, its acoustic face as first region."""
    vertices, faces = assets.make(name, facets)
    return Probe.from_arrays(vertices, faces, assets.contact_region(name, vertices, faces), name=name)
