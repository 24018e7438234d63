"""Speed against error, stability and confidence: commands that measure, not tests that assert times."""
