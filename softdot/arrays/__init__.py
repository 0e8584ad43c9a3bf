"""Studies of arrays of segments."""
