"""Which convention do poses follow? Every reading of them is weighed against the data."""
