"""Arrays of segments: their layout, the layers that run through, and the solids. Imports nothing by itself."""
