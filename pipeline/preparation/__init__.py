"""From a mesh file to a probe ready for contact sensing: shell, alignment, simplification, regions."""
