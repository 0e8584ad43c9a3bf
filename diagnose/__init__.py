"""Recordings of a real segment, and what they say about the physics that a model leaves out."""
