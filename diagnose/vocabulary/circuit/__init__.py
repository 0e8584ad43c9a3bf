"""Candidates behind the film, and charge that the press does not make: exact without new presses."""
