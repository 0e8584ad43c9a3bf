"""What may be off in a segment as it is made, in its materials and its mesh, and what that does to its answers."""
