"""A touch beside a ray query."""
