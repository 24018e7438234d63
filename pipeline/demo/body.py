"""Render probes, in a process of its own: without a graphics driver VTK ends its process.

The child runs this module with the name of a file; it takes the views as JSON on standard input and leaves the
images in that file. What VTK has to say about missing displays stays in the child.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict, dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.installation import module_command

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.mesh.arrays import Floats

_FACETS = 20_000
_SMOOTHING = 2  # rendered this much larger and averaged
_PATIENCE_S = 120
_BODY, _REGION = "#e2e2e2", "#a9dccd"  # light grey; Okabe-Ito's bluish green, pale

# From the camera: left and above, a weaker one on the right against the dark.
_LIGHTS = (((-0.8, 0.7, 1.6), 0.70), ((1.2, -0.8, 1.4), 0.35))

Image = NDArray[np.uint8]


@dataclass(frozen=True)
class PaperView:
    """A look at the probe with +z of S upwards on paper."""

    focal: tuple[float, float, float]  # (x, y, z) point of S in the middle of the paper, m
    # azimuth, elevation: where the camera is, degrees: azimuth from -y towards +x, elevation above the
    # flange plane
    azimuth: float
    elevation: float
    # width, height: what the paper shows, mm
    width: float
    height: float

    @cached_property
    def toward(self) -> Floats:
        """Unit vector (3,) of S from the focal point to the camera."""
        a, e = np.radians([self.azimuth, self.elevation])
        return np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])

    @cached_property
    def right(self) -> Floats:
        """Unit vector (3,) of S that points to the right on paper."""
        a = np.radians(self.azimuth)
        return np.array([np.cos(a), np.sin(a), 0.0])

    @cached_property
    def up(self) -> Floats:
        """Unit vector (3,) of S that points upwards on paper."""
        return np.cross(self.toward, self.right)

    def project(self, points: ArrayLike) -> Floats:
        """Return where points (..., 3) of S, m, lie on paper: (..., 2), mm from the middle."""
        offset = np.asarray(points, dtype=np.float64) - self.focal
        return np.asarray(offset @ np.column_stack([self.right, self.up]) * 1e3)


@dataclass(frozen=True)
class BodyOrder:
    """One image to render."""

    probe: str  # one of assets.PROBE_NAMES
    view: PaperView  # how to look at it
    pixels: int  # width of the image; the height follows from the view


class PictureError(InputError):
    """No picture can be drawn on this machine; the message says what to install."""


def render_bodies(bodies: Sequence[BodyOrder]) -> list[Image]:
    """Render bundled probes on white, their contact regions tinted.

    Parameters
    ----------
    bodies : sequence of BodyOrder
        What to render.

    Returns
    -------
    list of (height, width, 3) uint8 arrays

    Raises
    ------
    PictureError
        PyVista is missing, or there is nothing to render with.
    """
    if find_spec("pyvista") is None:
        raise PictureError("it needs PyVista: pip install 'contactbench[gui]'.")
    orders = json.dumps([asdict(body) for body in bodies])
    with TemporaryDirectory() as folder:
        file = Path(folder, "bodies.npz")
        command = module_command("contactbench.pipeline.demo.body", str(file))
        try:
            subprocess.run(  # noqa: S603  (this interpreter and this module)
                command, input=orders.encode(), capture_output=True, check=True, timeout=_PATIENCE_S
            )
            with np.load(file) as images:
                return [np.asarray(images[f"arr_{i}"], dtype=np.uint8) for i in range(len(bodies))]
        except (OSError, ValueError, subprocess.SubprocessError) as error:
            raise PictureError(
                "this machine cannot render off-screen. On Debian and Ubuntu: apt-get install libegl1 libgl1-mesa-dri."
            ) from error


def _render(body: BodyOrder) -> Image:
    import pyvista as pv

    view = body.view
    vertices, faces = assets.make(body.probe, _FACETS)
    region = assets.contact_region(body.probe, vertices, faces)
    mesh = pv.PolyData.from_regular_faces(vertices, faces)
    mesh.cell_data["colour"] = np.array([_rgb(_BODY), _rgb(_REGION)], dtype=np.uint8)[region]
    height = round(body.pixels * view.height / view.width)
    size = (_SMOOTHING * body.pixels, _SMOOTHING * height)
    plotter = pv.Plotter(off_screen=True, window_size=size, lighting="none")
    plotter.set_background("white")
    look = {"ambient": 0.46, "diffuse": 0.62, "specular": 0.08, "specular_power": 10}
    plotter.add_mesh(mesh, scalars="colour", rgb=True, smooth_shading=True, **look)
    for place, strength in _LIGHTS:
        plotter.add_light(pv.Light(position=place, intensity=strength, light_type="camera light"))
    camera = plotter.camera
    camera.focal_point, camera.up = view.focal, tuple(view.up)
    camera.position = tuple(np.array(view.focal) + view.toward)
    camera.parallel_projection, camera.parallel_scale = True, view.height / 2000
    camera.clipping_range = (0.5, 1.5)
    image = np.asarray(plotter.screenshot(return_img=True))[..., :3]
    plotter.close()
    blocks = image.reshape(height, _SMOOTHING, body.pixels, _SMOOTHING, 3)
    return np.asarray(np.rint(blocks.mean(axis=(1, 3))), dtype=np.uint8)


def _rgb(colour: str) -> list[int]:
    return [int(colour[i : i + 2], 16) for i in (1, 3, 5)]


def _main() -> None:
    orders = json.load(sys.stdin)
    images = [
        _render(BodyOrder(order["probe"], PaperView(**order["view"]), order["pixels"])) for order in orders
    ]
    np.savez(sys.argv[1], *images)


if __name__ == "__main__":
    _main()
