"""The virtual bench as a device: a probe on a wrist, a sensor with its faults, and a clock of its own."""
