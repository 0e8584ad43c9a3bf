"""Tolerances of a segment as it is made, of its materials and its mesh, and their effect on its answers."""
