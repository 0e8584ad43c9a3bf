"""How long work says how far it is."""

from collections.abc import Callable

Report = Callable[[str, int, int], None]
"""Told of long work: what, done, of how many."""
