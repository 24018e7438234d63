"""Benches without hardware, smallest first.

``touches`` is the smallest: points on a known surface, a force within the friction cone, a local torque
and sensor noise. It leaves out dynamics, deformation and the probe's weight; what it keeps is what contact
location sees.
"""

from contactbench.pipeline.simulation.touches import Touches, add_noise, draw_touches

__all__ = ["Touches", "add_noise", "draw_touches"]
