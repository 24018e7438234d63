"""What reading several sensors at once costs and loses: emulated sensors on real lines, each in its own process."""
