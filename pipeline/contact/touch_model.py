"""The model of a touch beside the sensor's noise: torsion, mesh deviation and model error."""

from dataclasses import dataclass, field
from math import isfinite

from contactbench.pipeline.contact.noise import WrenchNoise
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM, TORSION_ARM_M, Scene


@dataclass(frozen=True, eq=False)
class TouchModel:
    """The model of one touch: ``M - p x F = k n`` with a small k, on a surface that is nearly the mesh.

    Parameters
    ----------
    torsion_arm : float
        One sigma of the local torque k over the force, m. Default 1 mm: a hard tip has 0.3, soft tissue 1 to 5.
        Infinity gives the closed form for any k, 0 the wrench axis.
    model_error : WrenchNoise
        Error that drift, cable, hysteresis and mount leave in the wrench. Default 0.05 N and 1 mN·m: with an
        unmodelled pull of 0.2 N on a 7 N press, fewer than one in a thousand answers is then confident and wrong.
        Verification measures it.
    mesh_deviation : float
        Root mean square between mesh and surface, beyond the effect of its curvature, m.
    mesh_curved : bool
        Facets that turn by less than 40 degrees to their neighbours represent a curved surface, so their normals and
        positions have the corresponding error. Off for a body that truly has flat facets.
    torsion_learned : bool
        While a touch is followed, the arm grows to what the wrenches show of it; `torsion_arm` is then where it begins
        and the least it becomes. It needs the time of each wrench; one that is located alone has `torsion_arm`.
    scene : str, optional
        What is touched: ``dry`` skin, ``gel`` or ``bone``; told in a bundle, and without effect.

    Raises
    ------
    InputError
        A length is negative, not finite, or longer than a kilometre.
    """

    torsion_arm: float = TORSION_ARM_M
    model_error: WrenchNoise = field(default_factory=lambda: WrenchNoise(DEFAULT_FORCE_N, DEFAULT_TORQUE_NM))
    mesh_deviation: float = 0.0
    mesh_curved: bool = True
    torsion_learned: bool = True
    scene: Scene | None = None

    def __post_init__(self) -> None:
        for name in ("torsion_arm", "mesh_deviation"):
            value = getattr(self, name)
            if not (isfinite(value) and 0 <= value <= 1000):
                raise InputError(f"TouchModel.{arg(name)} must be between 0 and 1000 m, not {arg(value)}")
