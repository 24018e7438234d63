"""Many sessions in one table: what drifts, what is due, and what stands out."""
