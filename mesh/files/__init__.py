"""Meshes in files: for other codes, and from them."""
