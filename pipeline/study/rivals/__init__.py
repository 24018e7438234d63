"""
Rivals measured, not quoted: other people's code on the same inputs, in the same run, on the same machine.

Contact location, location on a plane, simplification of meshes, gravity calibration. What is not installed is said, and
the rest is measured.
"""
