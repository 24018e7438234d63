"""Commands, one module a subject; :mod:`contactbench.pipeline.cli` puts them together. Nothing here computes.

These modules import nothing heavy at their top, so that ``--help`` answers at once.
"""
