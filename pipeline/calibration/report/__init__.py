"""A calibration as a page for people."""
