"""Physics beyond the baseline: every mechanism in a module of its own, found by being there.

A configuration names mechanisms in [[mechanisms]]: Mechanism checks such a table, and with_mechanisms switches it on in
a model.
"""

from solve.mechanisms.base import MECHANISMS, Traits, register
from solve.mechanisms.mechanism import Mechanism, refuse_repeated, with_mechanisms
from solve.mechanisms.registry import traits_of

__all__ = ["MECHANISMS", "Mechanism", "Traits", "refuse_repeated", "register", "traits_of", "with_mechanisms"]
