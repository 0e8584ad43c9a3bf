"""Files of meshes: written for other codes, and read from them."""
