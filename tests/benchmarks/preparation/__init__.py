"""Is probe preparation as good as it says? Simplification, regions, alignment, shells."""
