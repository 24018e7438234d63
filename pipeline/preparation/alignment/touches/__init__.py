"""The mount from touches of marked points."""
