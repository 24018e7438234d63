"""
Sweeps of speed against error: a plan of cells, computed on however many machines, kept in one Parquet file.

Every cell draws its touches from a seed of its own, so that its errors are the same whoever computes it, and in
whatever order.
"""
