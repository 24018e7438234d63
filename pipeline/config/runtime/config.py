"""
A runtime config: one folder or zip file that a robot's controller loads.

========================  ==========================================================================================
``contactbench.json``     the whole configuration, see `contactbench.pipeline.config.runtime.model`
``contactbench.sha256``   the hash of that file, for ``sha256sum --check``; it contains the hashes of the others
``probe.ply``             the mesh in S, m, with the region of every facet
``planes.csv``            its facets as planes in priority order
``ros2.yaml``             for ros2_control: offsets and gravity compensation
``ft_calib.yaml``         for force_torque_tools; not for a sensor that carries no weight
``self_test.csv``         samples, and the answers that every runtime must give, see docs/bundle.md
``report.html``           the verification report, if there is one
========================  ==========================================================================================
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.config.runtime.canonical import decode_json, encode_json
from contactbench.pipeline.config.runtime.check import check_config, decode_mesh
from contactbench.pipeline.config.runtime.model import VERSION, RuntimeModel
from contactbench.pipeline.config.runtime.pack import (
    CHECKSUM,
    CONFIG,
    KNOWN,
    PROBE,
    check_names,
    check_size,
    encode_zip,
    read_bundle,
)
from contactbench.pipeline.config.runtime.swap import write_folder
from contactbench.pipeline.config.runtime.values import gravity_of
from contactbench.pipeline.durable import make_folder, write_durably
from contactbench.pipeline.errors import ConfigError, arg, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.shown import Shown

_AGAIN = message("copy or export the bundle again.")


@dataclass(frozen=True, eq=False, repr=False)
class RuntimeConfig(Shown):
    """
    A checked runtime config.

    Make one with `load` or `build_config`: they check; the bare constructor does not.

    Attributes
    ----------
    model : RuntimeModel
    probe : Probe
        In S, with its regions.
    files : mapping of str to bytes
        The bundle's other files, ``probe.ply`` among them.
    notes : tuple of str
        What to know that is in none of them: which regions are not what was painted.
    """

    model: RuntimeModel
    probe: Probe
    files: Mapping[str, bytes]
    notes: tuple[str, ...] = ()

    def facts(self) -> dict[str, str]:
        """As `Shown.facts`."""
        part = self.model.verification
        return {
            "verified": "no" if part is None or not self.model.verified else f"on {part.markers} markers",
            "sensor": f"{self.model.sensor.model} {self.model.sensor.serial}, {self.model.sensor.rate_Hz:g} Hz",
            "probe": f"{len(self.probe.faces):,} facets",
            "files": ", ".join(self.files),
        }

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> RuntimeConfig:
        """
        Load a bundle and check everything in it.

        Parameters
        ----------
        path : str or path
            A folder or a zip file.

        Raises
        ------
        ConfigError
            It is damaged, was changed, has a newer version, contradicts itself, or has impossible values; the
            message names the file and the field.
        """
        return cls.from_files(read_bundle(Path(path)), str(path))

    @classmethod
    def from_files(cls, files: Mapping[str, bytes], name: str = "bundle") -> RuntimeConfig:
        """
        Check the files of a bundle.

        Parameters
        ----------
        files : mapping
            File name -> content.
        name : str
            Name of the bundle in messages.

        Raises
        ------
        ConfigError
            As `load`.
        """
        check_names(list(files), name)
        for file, content in files.items():
            check_size(file, len(content), name)
        if files[CHECKSUM] != checksum(files[CONFIG]):
            raise ConfigError(
                f"{arg(name)}: {arg(CONFIG)} was changed: its hash does not match {arg(CHECKSUM)}: {arg(_AGAIN)}"
            )
        model, version = decode_json(files[CONFIG], f"{name}: {CONFIG}")
        others = {file: content for file, content in files.items() if file not in (CONFIG, CHECKSUM)}
        _check_hashes(model, others, name)
        probe = decode_mesh(others[PROBE], model, f"{name}: {PROBE}")
        check_config(model, probe, others, name, version=version)
        older = message(
            f"{arg(name)}: of version {arg(version)}, read as version {arg(VERSION)}. Its test vectors, if any, tell"
            " in `bundle check` how far contacts moved since its export."
        )
        return cls(model, probe, MappingProxyType(others), () if version == VERSION else (older,))

    def write(self, path: str | os.PathLike[str]) -> None:
        """
        Write the bundle in one step: there is the old one or this one, also after a power cut.

        Parameters
        ----------
        path : str or path
            A name that ends in .zip is a zip file, any other a folder: new, empty, or an older bundle.

        Raises
        ------
        ConfigError
            It cannot be written there. What was there stays.
        """
        target = Path(path)
        files = self.encoded()
        for file, content in files.items():
            check_size(file, len(content), str(target))
        try:
            make_folder(target.absolute().parent)
            if target.suffix.lower() == ".zip":
                write_durably(target, encode_zip(files))
            else:
                write_folder(target, files, KNOWN)
        except (OSError, ValueError) as error:
            if isinstance(error, ConfigError):
                raise
            raise ConfigError(
                f"{arg(target)}: the bundle cannot be written ({arg(error)}): choose a location that is"
                " writable and has space."
            ) from error

    def encoded(self) -> dict[str, bytes]:
        """Return all files of the bundle; the same config gives the same bytes."""
        config = encode_json(self.model.to_json())
        return {CONFIG: config, CHECKSUM: checksum(config), **dict(sorted(self.files.items()))}

    @property
    def gravity(self) -> GravityModel:
        """What to take off a reading."""
        return gravity_of(self.model)


def checksum(config: bytes) -> bytes:
    """Return the content of ``contactbench.sha256``."""
    return f"{hashlib.sha256(config).hexdigest()}  {CONFIG}\n".encode("ascii")


def _check_hashes(model: RuntimeModel, files: Mapping[str, bytes], name: str) -> None:
    listed = model.provenance.files
    if strangers := sorted(set(listed) ^ set(files)):
        where = (
            message("listed in provenance.files but missing")
            if strangers[0] in listed
            else message("not listed in provenance.files")
        )
        raise ConfigError(f"{arg(name)}: {arg(strangers[0])} is {arg(where)}: {arg(_AGAIN)}")
    for file, content in files.items():
        if hashlib.sha256(content).hexdigest() != listed[file]:
            raise ConfigError(
                f"{arg(name)}: {arg(file)} was changed: its hash does not match provenance.files: {arg(_AGAIN)}"
            )
