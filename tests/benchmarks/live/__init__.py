"""What a live run needs: emulated sensors on real lines, each in its own process, and what they noted."""
