"""Measurements of speed; each program says how to run it."""
