"""Where the probe's mesh lies in the sensor frame: typed, by points, by the flange, by its shape, by touches."""
