"""Ultrasound probes of true size whose surfaces are known exactly.

Each probe is a smooth closed surface with analytic points, normals and curvatures, meshed on demand with any
number of facets, so that an error measured on a mesh can be told from an error of the mesh. Lengths are in
metres in frame S: origin on the flange plane, +z from the flange to the probe's tip.
"""

from contactbench.assets.probes import PROBE_NAMES, contact_region, make, surface
from contactbench.assets.surface import Station, Surface
from contactbench.assets.triangulation import tessellate

__all__ = ["PROBE_NAMES", "Station", "Surface", "contact_region", "make", "surface", "tessellate"]
