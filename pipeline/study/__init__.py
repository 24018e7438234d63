"""Speed against error, and stability on hard cases: commands that measure, not tests that assert times."""
