"""
How steady the solver is: rounding, single precision, units, thin facets, cancellation, and the same bits everywhere.

The hard cases of :mod:`contactbench.pipeline.study.hard_cases` ask whether answers are right; here is measured
by how much they
are off, against a truth in long double or exact rational numbers, and what first-order theory predicts.
"""
