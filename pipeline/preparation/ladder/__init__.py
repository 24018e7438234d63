"""Quality against speed: what fewer facets cost in contact error, what they save in time, and how many to take."""
