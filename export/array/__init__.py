"""Files and pictures of arrays of segments."""
