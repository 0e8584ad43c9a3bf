"""Constitutive laws of the media and of the film, and the library of materials."""
