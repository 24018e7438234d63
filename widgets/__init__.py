"""Reusable Qt widgets that know the types of :mod:`contactbench.pipeline` and nothing of :mod:`contactbench.app`."""
