"""Hostile mesh files: made by the thousand, read in child processes, judged."""
