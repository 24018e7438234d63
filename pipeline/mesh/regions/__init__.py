"""
Priority regions of a probe: named, ordered sets of facets, edited with undo, kept in files, carried along.

A `RegionSet` is a value: names and colours in the order of priority, and a rank per facet, which is what
`Probe.region` holds. A `RegionModel` edits one; a `FacetGraph` knows the mesh. Nothing here draws anything.
"""
