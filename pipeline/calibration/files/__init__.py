"""Files of calibration: poses, calibrations, recordings to compensate or to find still poses in."""
