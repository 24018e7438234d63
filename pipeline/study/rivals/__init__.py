"""Rivals measured, not quoted: other ways to locate a contact on the same inputs, in the same run."""
