"""Random numbers with few digits, so that a failing configuration can be read."""

from math import log10

from hypothesis import strategies as st


def between(low, high):
    """Numbers from low to high."""
    return st.integers(0, 1000).map(lambda n: float(f"{low + (high - low) * n / 1000:.4g}"))


def log_between(low, high):
    """Numbers from low to high, their logarithms even."""
    return st.integers(0, 1000).map(lambda n: float(f"{10 ** (log10(low) + log10(high / low) * n / 1000):.4g}"))
