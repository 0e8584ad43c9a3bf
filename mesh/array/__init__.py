"""Meshes of arrays of segments: the footprint of all of them, extruded layer by layer."""
