"""What differs between two configs, and what that means for who runs them."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.errors import message

_ABSENT = "(absent)"
# The longest that fits first; fields that are not here mean what they say.
_MEANINGS = {
    "gravity.covariance": message("how certain the calibration is"),
    "gravity": message("the correction of every reading: every contact moves"),
    "noise": message("the stated uncertainty of a contact, and which rivals count"),
    "touch": message("the model error: torsion, drift, the mesh"),
    "filters.wrench": message("lag and noise of the wrench"),
    "filters.location": message("lag and noise of the contact point"),
    "gates": message("which touches get an answer"),
    "frames.quaternion_ES": message("how the sensor sits on the flange: every contact moves"),
    "world": message("how the robot is mounted: where down is"),
    "zero": message("how old the bias is, and how fast it drifted"),
    "checks": message("whether sign, units and scale were checked with a known weight or touch"),
    "sensor": message("another sensor: the calibration belongs to one only"),
    "probe": message("another surface"),
    "regions": message("the preference among candidates"),
    "planes": message("the planes for controllers with their own loop"),
    "controller": message("how the robot answers a touch"),
    "limits": message("the limits of the robot"),
    "verification": message("the results on markers"),
    "verified": message("whether contacts were verified"),
    "provenance": message("its origin"),
}


@dataclass(frozen=True)
class ConfigDifference:
    """A field with two values: its path, the values (JSON), and what it means."""

    field: str
    one: Any
    other: Any
    meaning: str


@dataclass(frozen=True)
class Differences:
    """All that differs."""

    fields: tuple[ConfigDifference, ...]  # Empty: the two are the same, file hashes included
    files: tuple[str, ...]  # Files whose content differs, or that only one has
    # ``facets`` of both and how far the surfaces are apart, mm; None where ``probe.ply`` is the same
    mesh: dict[str, Any] | None

    @property
    def same(self) -> bool:
        """Nothing differs."""
        return not self.fields and not self.files

    def to_json(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "same": self.same,
            "fields": [vars(each) for each in self.fields],
            "files": list(self.files),
            "mesh": self.mesh,
        }


def differences(one: RuntimeConfig, other: RuntimeConfig) -> Differences:
    """Compare two configs field by field, and their surfaces by distance."""
    first, second = (dict(_flat("", config.model.to_json())) for config in (one, other))
    fields = tuple(
        ConfigDifference(path, first.get(path, _ABSENT), second.get(path, _ABSENT), _meaning(path))
        for path in sorted(first.keys() | second.keys())
        if first.get(path, _ABSENT) != second.get(path, _ABSENT)
    )
    names = sorted(one.files.keys() | other.files.keys())
    files = tuple(name for name in names if one.files.get(name) != other.files.get(name))
    return Differences(fields, files, _meshes(one, other))


def _meshes(one: RuntimeConfig, other: RuntimeConfig) -> dict[str, Any] | None:
    if one.files[one.model.probe.file] == other.files[other.model.probe.file]:
        return None
    from contactbench.pipeline.mesh.deviation import measure_deviation

    found = measure_deviation(one.probe, other.probe)
    return {"facets": [len(one.probe.faces), len(other.probe.faces)], **found.to_json()}


def _flat(path: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Give the fields of nested objects; lists of numbers stay whole."""
    if isinstance(value, dict) and value:
        for key, each in value.items():
            yield from _flat(f"{path}.{key}" if path else key, each)
    elif isinstance(value, list) and any(isinstance(each, dict) for each in value):
        for index, each in enumerate(value):
            yield from _flat(f"{path}.{index}", each)
    else:
        yield path, value


def _meaning(path: str) -> str:
    fitting = [known for known in _MEANINGS if path == known or path.startswith(known + ".")]
    return _MEANINGS[max(fitting, key=len)] if fitting else ""
