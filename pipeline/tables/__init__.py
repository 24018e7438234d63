"""Tables of numbers from CSV files, as a stream of blocks or at once."""

from contactbench.pipeline.tables.files import open_table, read_table
from contactbench.pipeline.tables.reader import BLOCK_BYTES, TableError, TableReader, TableRows, Wording

__all__ = ["BLOCK_BYTES", "TableError", "TableReader", "TableRows", "Wording", "open_table", "read_table"]
