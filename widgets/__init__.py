"""Reusable Qt widgets that know the types of :mod:`pipeline` and nothing of :mod:`app`."""
