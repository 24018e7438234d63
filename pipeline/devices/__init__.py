"""Force/torque sensors and robots: from the bytes on a line to samples."""
