"""
Motion control by touch: a probe that keeps its force and stays upright on tissue that moves.

The reference for runtime controllers that load a bundle: admittance along and about the contact (the paper's Eq. 7-9),
inverse kinematics (Eq. 10), a variant that estimates how the tissue moves, and a state machine that is safe by itself.
Nothing here sends motion to a real robot.
"""
