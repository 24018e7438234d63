"""A calibration in the words of those who use it: each consumer's names, units, frames and signs."""
