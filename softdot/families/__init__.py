"""Families of designs: presses that carry their derivatives, and a surrogate of them that answers with an interval."""
