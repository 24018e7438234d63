"""A closed loop on the virtual bench, watched while it runs: phantom, probe, force, and what the controller does."""

from contactbench.app.motion.window import MotionWindow

__all__ = ["MotionWindow"]
